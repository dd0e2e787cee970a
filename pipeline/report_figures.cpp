#include "pipeline/report_figures.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <stdexcept>

#include "core/units.h"
#include "pipeline/export_vtu.h"

namespace heddle::pipeline {

namespace {

using macroscale::HistoryRow;
using Rows = std::vector<HistoryRow>;

template <class Value>
std::vector<double> column(const Rows& rows, double factor, Value value) {
  std::vector<double> out;
  for (const HistoryRow& row : rows) out.push_back(factor * static_cast<double>(row.*value));
  return out;
}

std::vector<double> stroke(const Rows& rows) {
  return column(rows, 1e3, &HistoryRow::punch_displacement);
}

const Axis stroke_axis{"Punch displacement", "mm", Scale::linear, 0.0, {}};

}  // namespace

Canvas force_chart(const Rows& history) {
  const std::vector<double> x = stroke(history);
  LineChart chart;
  chart.label = "Forces of punch, die and binder against punch displacement";
  chart.x = stroke_axis;
  chart.y = {"Force", "N"};
  chart.series = {{"Punch", x, column(history, 1.0, &HistoryRow::punch_force)},
                  {"Die", x, column(history, 1.0, &HistoryRow::die_force)},
                  {"Binder", x, column(history, 1.0, &HistoryRow::binder_force)}};
  chart.width = full_width;
  chart.height = 380.0;
  chart.label_room = 90.0;
  return draw(chart);
}

namespace {

LineChart small_chart(std::string label, Axis y, const Rows& history, std::vector<double> values) {
  LineChart chart;
  chart.label = std::move(label);
  chart.x = stroke_axis;
  chart.y = std::move(y);
  chart.series = {{"", stroke(history), std::move(values)}};
  chart.width = half_width;
  chart.height = 280.0;
  return chart;
}

}  // namespace

Canvas draw_in_chart(const Rows& history) {
  return draw(small_chart("Largest draw-in against punch displacement", {"Largest draw-in", "mm"}, history,
                          column(history, 1e3, &HistoryRow::draw_in_max)));
}

Canvas shear_chart(const Rows& history) {
  return draw(small_chart("Largest shear angle against punch displacement", {"Largest shear angle", "°"},
                          history, column(history, degrees, &HistoryRow::shear_angle_max)));
}

Canvas iteration_chart(const Rows& history) {
  Axis axis{"Newton iterations a step", ""};
  axis.low = 0.0;
  return draw(small_chart("Newton iterations of each step against punch displacement", axis, history,
                          column(history, 1.0, &HistoryRow::newton_iterations)));
}

std::vector<double> residual_shares(const Rows& history) {
  std::vector<double> shares;
  if (history.empty()) return shares;
  const double floor = 0.01 * std::abs(history.back().work_punch);
  for (const HistoryRow& row : history) {
    const double work = std::max(row.work_punch, floor);
    shares.push_back(work > 0.0 ? row.ledger_residual / work : 0.0);
  }
  return shares;
}

Canvas residual_chart(const Rows& history) {
  std::vector<double> percent = residual_shares(history);
  for (double& share : percent) share *= 100.0;
  return draw(small_chart("Residual of the energy ledger against punch displacement",
                          {"Ledger residual", "% of punch work"}, history, std::move(percent)));
}

Canvas ledger_chart(const Rows& history) {
  struct Entry {
    const char* name;
    double HistoryRow::*value;
    int style;
  };
  // Bottom to top; stored energy blue, friction orange, other losses green and grey.
  static constexpr std::array<Entry, 14> entries{
      {{"Tow stretch", &HistoryRow::energy_tow, 0},
       {"Fabric shear", &HistoryRow::energy_shear, 1},
       {"Bending", &HistoryRow::energy_bending, 2},
       {"Compaction", &HistoryRow::energy_compaction, 3},
       {"Kinetic", &HistoryRow::energy_kinetic, 4},
       {"Twist control", &HistoryRow::energy_twist, 5},
       {"Friction, die", &HistoryRow::friction_die, 6},
       {"Friction, binder", &HistoryRow::friction_binder, 7},
       {"Friction, punch", &HistoryRow::friction_punch, 8},
       {"Resin shear rate", &HistoryRow::dissipation_shear_rate, 9},
       {"Friction of tows", &HistoryRow::dissipation_shear_hysteresis, 6},
       {"Tow stretch rate", &HistoryRow::dissipation_tow_rate, 0},
       {"Time stepping", &HistoryRow::dissipation_numerical, 10},
       {"Artefacts", &HistoryRow::dissipation_artefact, 11}}};
  StackedChart chart;
  chart.label = "Where the work of the tools goes, against punch displacement";
  chart.x = stroke_axis;
  chart.y = {"Energy", "J"};
  chart.at = stroke(history);
  const auto add = [&](const Entry& entry) {
    chart.bands.push_back({entry.name, {}, column(history, 1.0, entry.value)});
    chart.band_style.push_back(entry.style);
  };
  const bool plies_rub = std::any_of(history.begin(), history.end(),
                                     [](const HistoryRow& row) { return row.friction_plies != 0.0; });
  const bool tows_rub = !history.empty() && history.back().dissipation_shear_hysteresis > 0.0;
  const bool tows_flow = !history.empty() && history.back().dissipation_tow_rate > 0.0;
  for (const Entry& entry : entries) {
    if (entry.value == &HistoryRow::dissipation_shear_hysteresis && !tows_rub) continue;  // switched off
    if (entry.value == &HistoryRow::dissipation_tow_rate && !tows_flow) continue;
    add(entry);
    if (plies_rub && entry.value == &HistoryRow::friction_punch)
      add({"Friction, plies", &HistoryRow::friction_plies, 7});
  }
  const auto in_press = [](const HistoryRow& row) { return row.energy_press != 0.0; };
  if (std::any_of(history.begin(), history.end(), in_press)) {
    chart.bands.push_back({"Press and springs", {}, column(history, 1.0, &HistoryRow::energy_press)});
    chart.band_style.push_back(4);  // of the kinetic energy, which is not to be seen beside it
  }
  Series work{"Work of the tools", {}, column(history, 1.0, &HistoryRow::work_punch)};
  for (std::size_t i = 0; i < history.size(); ++i)
    work.y[i] += history[i].work_binder + history[i].work_gravity;
  chart.lines = {std::move(work)};
  chart.width = full_width;
  chart.height = 400.0;
  return draw(chart);
}

namespace {

/// Range of the values, never empty.
std::pair<double, double> range(const std::vector<double>& values) {
  const auto [low, high] = std::minmax_element(values.begin(), values.end());
  return *high > *low ? std::pair{*low, *high} : std::pair{*low, *low + 1.0};
}

}  // namespace

Canvas height_picture(const HeightField& height) {
  GridPicture picture;
  picture.label = "Height of the upper face of the weave, seen from above";
  picture.nx = height.nx;
  picture.ny = height.ny;
  picture.spacing_x = height.spacing_x;
  picture.spacing_y = height.spacing_y;
  for (const double value : height.height) picture.value.push_back(1e3 * value);
  if (picture.value.empty()) throw std::invalid_argument("height field: no values");
  const auto [low, high] = range(picture.value);
  picture.colours = {low, high, "Height", "mm", ColourMap::height};
  picture.width = half_width;
  return draw(picture);
}

Canvas section_picture(const std::vector<SectionLine>& section) {
  SectionPicture picture;
  picture.label = "Section through one cell with its tows";
  picture.along = "Along the warp";
  picture.lines = section;
  picture.width = full_width;
  return draw(picture);
}

Canvas touched_picture(const mesoscale::TouchedFace& face) {
  constexpr double lowest = -2.0, highest = 2.0;  // powers of ten, kPa
  MeshPicture picture;
  picture.label = fmt::format("Patches of the upper face that touch a flat tool, sheared by {:.0f} degrees",
                              degrees * face.shear_angle);
  for (int j = 0; j < face.n; ++j)
    for (int i = 0; i < face.n; ++i) {
      const double along = (i + 0.5) / face.n, across = (j + 0.5) / face.n;
      picture.points.push_back({along * face.along_warp[0] + across * face.along_weft[0],
                                along * face.along_warp[1] + across * face.along_weft[1], 0.0});
      const double pressure = face.pressure[static_cast<std::size_t>(j) * face.n + i];
      picture.value.push_back(pressure > 0.0 ? std::clamp(std::log10(1e-3 * pressure), lowest, highest)
                                             : lowest);
      if (i + 1 < face.n && j + 1 < face.n) {
        const int at = j * face.n + i;
        picture.quads.push_back({at, at + 1, at + 1 + face.n, at + face.n});
      }
    }
  picture.colours = {lowest, highest, "Touched from 10^x", "kPa", ColourMap::angle};
  picture.width = half_width;
  picture.height = 360.0;
  return draw(picture);
}

Canvas contact_chart(const mesoscale::ContactArea& contact) {
  LineChart chart;
  chart.label = "Contact fraction against pressure for several shear angles";
  chart.x = {"Nominal pressure", "kPa", Scale::logarithmic};
  chart.y = {"Contact fraction", "%", Scale::logarithmic};
  const auto& angles = contact.log_fraction.parameter();
  const auto& table = contact.log_fraction.curves();
  // First, middle and last angle tell the trend; more lines than that lie on top of one another.
  std::vector<std::size_t> shown{0, angles.size() / 2, angles.size() - 1};
  shown.erase(std::unique(shown.begin(), shown.end()), shown.end());
  for (const std::size_t k : shown) {
    Series series{fmt::format("γ = {:.0f}°", degrees * angles[k]), {}, {}};
    constexpr int points = 60;
    const double low = table[k].x().front(), high = table[k].x().back();
    for (int i = 0; i <= points; ++i) {
      const double pressure = std::exp(low + (high - low) * i / points);
      series.x.push_back(1e-3 * pressure);
      series.y.push_back(100.0 * contact.evaluate(pressure, angles[k]).fraction);
    }
    chart.series.push_back(std::move(series));
  }
  chart.width = full_width;
  chart.height = 340.0;
  chart.label_room = 82.0;
  return draw(chart);
}

namespace {

bool same_curve(const FrictionCurveRow& a, const FrictionCurveRow& b) {
  return a.pressure == b.pressure && a.tool_temperature == b.tool_temperature &&
         a.fabric_temperature == b.fabric_temperature;
}

std::string curve_name(const FrictionCurveRow& row) {
  return fmt::format("{:.4g} kPa, {:.0f} °C", 1e-3 * row.pressure, row.tool_temperature - zero_celsius);
}

}  // namespace

Canvas friction_chart(const std::vector<FrictionCurveRow>& rows, FrictionAbscissa abscissa) {
  const bool by_hersey = abscissa == FrictionAbscissa::hersey;
  LineChart chart;
  chart.label =
      by_hersey ? "Friction coefficient against Hersey number" : "Friction coefficient against slip speed";
  chart.x = by_hersey ? Axis{"Hersey number", "", Scale::logarithmic}
                      : Axis{"Slip speed", "mm/s", Scale::logarithmic};
  chart.y = {"Friction coefficient", ""};
  chart.y.low = 0.0;
  for (std::size_t i = 0; i < rows.size(); ++i) {
    if (i == 0 || !same_curve(rows[i - 1], rows[i])) chart.series.push_back({curve_name(rows[i]), {}, {}});
    chart.series.back().x.push_back(by_hersey ? rows[i].hersey : 1e3 * rows[i].slip_speed);
    chart.series.back().y.push_back(rows[i].friction_coefficient);
  }
  chart.width = half_width;
  chart.height = 320.0;
  chart.label_room = 118.0;
  return draw(chart);
}

namespace {

void require_complete(const macroscale::BlankState& blank) {
  const std::size_t nodes = blank.position.size();
  if (blank.nu < 1 || blank.nv < 1 || nodes == 0 || blank.grid.size() != nodes ||
      blank.shear_angle.size() != nodes || blank.reference.size() != nodes) {
    throw std::invalid_argument(fmt::format(
        "blank of {} x {} cells: {} positions, {} grid places, {} references and {} shear angles do not fit",
        blank.nu, blank.nv, blank.position.size(), blank.grid.size(), blank.reference.size(),
        blank.shear_angle.size()));
  }
}

/// Builds the mesh of a picture: whole cells, blocks of them where the blank is fine, and the pieces of cells
/// that the outline cuts.
class PictureMesh {
 public:
  /// @param value  of each node
  PictureMesh(const macroscale::BlankState& blank, std::vector<double> value, MeshPicture& picture)
      : blank_(blank), picture_(picture), value_(std::move(value)), point_of_(blank.position.size(), -1) {
    node_at_.assign(static_cast<std::size_t>(blank.nu + 1) * static_cast<std::size_t>(blank.nv + 1), -1);
    cell_.assign(static_cast<std::size_t>(blank.nu) * static_cast<std::size_t>(blank.nv), Cell::absent);
    for (std::size_t n = 0; n < blank.grid.size(); ++n)
      node_at_.at(line(blank.grid[n][0], blank.grid[n][1])) = static_cast<int>(n);
    for (const auto& quad : blank.quads) cell_.at(cell_of(quad)) = Cell::whole;
    for (const auto& piece : blank.pieces)
      cell_.at(cell_of(blank.quads.at(static_cast<std::size_t>(piece.quad)))) = Cell::cut;
  }

  void build() {
    // Beyond this number quads only make the file large.
    constexpr int most_cells = 72, threads = 18;
    const int stride_u = stride(blank_.nu, most_cells), stride_v = stride(blank_.nv, most_cells);
    const int every_u = std::max(1, (blank_.nu / stride_u) / threads),
              every_v = std::max(1, (blank_.nv / stride_v) / threads);
    for (int i = 0; i < blank_.nu; i += stride_u)
      for (int j = 0; j < blank_.nv; j += stride_v) {
        const bool along_u = (j / stride_v) % every_v == every_v / 2,
                   along_v = (i / stride_u) % every_u == every_u / 2;
        const int i1 = std::min(i + stride_u, blank_.nu), j1 = std::min(j + stride_v, blank_.nv);
        if (all_whole(i, i1, j, j1)) {
          add_block(i, i1, j, j1, along_u, along_v);
          continue;
        }
        for (int a = i; a < i1; ++a)
          for (int b = j; b < j1; ++b)
            if (cell_[cell(a, b)] == Cell::whole)
              add_block(a, a + 1, b, b + 1, along_u && b == (j + j1 - 1) / 2,
                        along_v && a == (i + i1 - 1) / 2);
      }
    for (const auto& piece : blank_.pieces) add_piece(piece);
  }

 private:
  enum class Cell : char { absent, whole, cut };

  static int stride(int cells, int most) { return std::max(1, (cells + most - 1) / most); }
  std::size_t line(int i, int j) const { return static_cast<std::size_t>(i * (blank_.nv + 1) + j); }
  std::size_t cell(int i, int j) const { return static_cast<std::size_t>(i * blank_.nv + j); }
  std::size_t cell_of(const std::array<int, 4>& quad) const {
    const auto [i, j] = blank_.grid.at(static_cast<std::size_t>(quad[0]));
    return cell(i, j);
  }
  bool all_whole(int i0, int i1, int j0, int j1) const {
    for (int i = i0; i < i1; ++i)
      for (int j = j0; j < j1; ++j)
        if (cell_[cell(i, j)] != Cell::whole) return false;
    return true;
  }

  int point(int i, int j) {
    const auto node = static_cast<std::size_t>(node_at_[line(i, j)]);
    if (point_of_[node] < 0) {
      point_of_[node] = static_cast<int>(picture_.points.size());
      picture_.points.push_back(blank_.position[node]);
      picture_.value.push_back(value_[node]);
    }
    return point_of_[node];
  }

  void add_block(int i0, int i1, int j0, int j1, bool along_u, bool along_v) {
    picture_.quads.push_back({point(i0, j0), point(i1, j0), point(i1, j1), point(i0, j1)});
    picture_.threads.push_back(static_cast<std::uint8_t>((along_u ? 1 : 0) | (along_v ? 2 : 0)));
  }

  /// All in the colour of their cell.
  void add_piece(const macroscale::CellPiece& piece) {
    const auto& quad = blank_.quads[static_cast<std::size_t>(piece.quad)];
    double value = 0.0;
    for (const int node : quad) value += 0.25 * value_[static_cast<std::size_t>(node)];
    const int first = static_cast<int>(picture_.points.size());
    for (const auto& corner : piece.corners) {
      picture_.points.push_back(position_in(blank_, quad, corner));
      picture_.value.push_back(value);
    }
    picture_.quads.push_back({first, first + 1, first + 2, first + 3});
    picture_.threads.push_back(0);
  }

  const macroscale::BlankState& blank_;
  MeshPicture& picture_;
  std::vector<double> value_;
  std::vector<int> node_at_, point_of_;
  std::vector<Cell> cell_;
};

/// The blank coloured by the size of its shear angle, with some of its tows drawn as threads.
MeshPicture mesh_picture(const macroscale::BlankState& blank) {
  require_complete(blank);
  MeshPicture picture;
  std::vector<double> angle = blank.shear_angle;
  for (double& value : angle) value = degrees * std::abs(value);
  PictureMesh(blank, std::move(angle), picture).build();
  const double largest = *std::max_element(picture.value.begin(), picture.value.end());
  picture.colours = {0.0, largest > 0.0 ? largest : 1.0, "Shear angle", "°", ColourMap::angle};
  picture.width = half_width;
  picture.height = 450.0;
  return picture;
}

/// The edge of the flat blank and of its holes, closed.
std::vector<std::vector<std::array<double, 3>>> flat_outlines(const macroscale::Outline& outline) {
  std::vector<std::vector<std::array<double, 3>>> lines;
  const auto add = [&](const std::vector<macroscale::Point2>& ring) {
    if (ring.empty()) return;
    lines.emplace_back();
    for (const auto& p : ring) lines.back().push_back({p[0], p[1], 0.0});
    lines.back().push_back({ring.front()[0], ring.front()[1], 0.0});
  };
  add(outline.outer);
  for (const auto& hole : outline.holes) add(hole);
  return lines;
}

}  // namespace

Canvas formed_picture(const macroscale::BlankState& blank) {
  MeshPicture picture = mesh_picture(blank);
  picture.label = "The formed blank in three dimensions, turned over, coloured by shear angle";
  picture.camera = {-62.0, 40.0, true};
  return draw(picture);
}

Canvas top_picture(const macroscale::BlankState& blank, double largest_angle) {
  MeshPicture picture = mesh_picture(blank);
  if (largest_angle > 0.0) picture.colours.high = degrees * largest_angle;
  picture.label = "The formed blank from above, coloured by shear angle, with its first outline";
  picture.outlines = flat_outlines(blank.outline);
  return draw(picture);
}

Canvas top_picture(const macroscale::BlankState& blank, std::vector<double> value, ColourScale colours,
                   std::string label) {
  require_complete(blank);
  if (value.size() != blank.position.size())
    throw std::invalid_argument(
        fmt::format("blank of {} nodes: {} values do not fit", blank.position.size(), value.size()));
  MeshPicture picture;
  PictureMesh(blank, std::move(value), picture).build();
  picture.colours = std::move(colours);
  picture.label = std::move(label);
  picture.outlines = flat_outlines(blank.outline);
  picture.width = half_width;
  picture.height = 450.0;
  return draw(picture);
}

}  // namespace heddle::pipeline
