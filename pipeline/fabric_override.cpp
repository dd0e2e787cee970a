#include "pipeline/fabric_override.h"

#include <algorithm>
#include <cmath>
#include <numbers>
#include <string>
#include <vector>

#include <fmt/format.h>

#include "core/measured_table.h"
#include "core/units.h"
#include "mesoscale/bending.h"

namespace heddle::pipeline {

namespace {

namespace fs = std::filesystem;

/// One row of any of the tables; a table of shear has one force, one of tension two.
struct Row {
  int line = 0;
  double at = 0.0;  ///< angle [rad], strain [-] or thickness [m]
  std::array<double, 2> value{};
  double first() const { return value[0]; }
};

struct ShearRow {
  int line = 0;
  double angle = 0.0;  ///< trellis angle [rad]
  double force = 0.0;  ///< normalised shear force per width [N/m]
};
constexpr std::array shear_columns{
    TableColumn<ShearRow>{"shear_angle_deg", "deg", &ShearRow::angle, true},
    TableColumn<ShearRow>{"shear_force_N_per_mm", "N/mm", &ShearRow::force, true}};

struct TensionRow {
  int line = 0;
  double strain = 0.0;            ///< of the fabric along the tow [-]
  double warp = 0.0, weft = 0.0;  ///< tension per width [N/m]
};
constexpr std::array tension_columns{
    TableColumn<TensionRow>{"strain", "", &TensionRow::strain, true},
    TableColumn<TensionRow>{"warp_tension_N_per_mm", "N/mm", &TensionRow::warp, true},
    TableColumn<TensionRow>{"weft_tension_N_per_mm", "N/mm", &TensionRow::weft, true}};

struct CompactionRow {
  int line = 0;
  double thickness = 0.0;  ///< [m]
  double pressure = 0.0;   ///< [Pa]
};
constexpr std::array compaction_columns{
    TableColumn<CompactionRow>{"thickness_mm", "mm", &CompactionRow::thickness, true},
    TableColumn<CompactionRow>{"pressure_kPa", "kPa", &CompactionRow::pressure, true}};

TableRules rules_of(std::string_view what) {
  return {.what = what,
          .unknown = "fabric.file.column.unknown"_rule,
          .missing = "fabric.file.column.missing"_rule,
          .twice = "fabric.file.column.twice"_rule,
          .number = "fabric.file.number"_rule};
}

/// What a column measures, for messages.
struct Quantity {
  std::string_view column;
  std::string_view unit;
  std::string_view name;
};

std::string with_unit(const Quantity& quantity, double value) {
  return write_quantity(value, std::string(quantity.unit));
}

/// Rules that all tables share: x runs away from where nothing resists, and the resistance never falls.
/// @param way  +1 where x rises from row to row, -1 where it falls
void check_rows(const std::vector<Row>& rows, const Quantity& x, const std::vector<Quantity>& y, double way,
                double start, TableProblems& problems) {
  if (rows.size() < 3) {
    problems.add("fabric.file.rows"_rule, x.column, fmt::format("{} rows", rows.size()),
                 "must have three rows or more", "Two points cannot show how a fabric stiffens.",
                 rows.empty() ? 1 : rows.front().line);
    return;
  }
  const auto nothing = [&](const Row& row) {
    return std::all_of(row.value.begin(), row.value.begin() + static_cast<std::ptrdiff_t>(y.size()),
                       [](double value) { return value == 0.0; });
  };
  if (std::abs(rows.front().at - start) > 1e-6 * std::max(std::abs(start), 1e-3) || !nothing(rows.front()))
    problems.add("fabric.file.start"_rule, x.column, with_unit(x, rows.front().at),
                 fmt::format("must begin with no {} at {}", y.front().name, with_unit(x, start)),
                 start == 0.0 ? "Take off the offset of the test, and add the row of zeros."
                              : "The table begins at the thickness that weave.fabric_thickness gives.",
                 rows.front().line);
  for (std::size_t k = 1; k < rows.size(); ++k) {
    if (!(way * rows[k].at > way * rows[k - 1].at))
      problems.add("fabric.file.order"_rule, x.column, with_unit(x, rows[k].at),
                   fmt::format("must be {} than in the row before ({})", way > 0.0 ? "larger" : "smaller",
                               with_unit(x, rows[k - 1].at)),
                   "Sort the rows, and leave out where the test goes back.", rows[k].line);
    for (std::size_t i = 0; i < y.size(); ++i)
      if (rows[k].value[i] < rows[k - 1].value[i])
        problems.add(
            "fabric.file.monotone"_rule, y[i].column, with_unit(y[i], rows[k].value[i]),
            fmt::format("must not fall; the row before has {}", with_unit(y[i], rows[k - 1].value[i])),
            "A fabric that gives way has no stable form: leave out what comes after the peak, and "
            "smooth the noise.",
            rows[k].line);
  }
  for (std::size_t i = 0; i < y.size(); ++i)
    if (!(rows.back().value[i] > 0.0))
      problems.add("fabric.file.nothing"_rule, y[i].column, with_unit(y[i], rows.back().value[i]),
                   fmt::format("must end with a {} above zero", y[i].name),
                   "The fabric would resist nothing at all.", rows.back().line);
}

constexpr Quantity angle{"shear_angle_deg", "deg", "shear angle"};
constexpr Quantity shear_force{"shear_force_N_per_mm", "N/mm", "shear force"};
constexpr Quantity strain{"strain", "", "strain"};
constexpr Quantity warp_tension{"warp_tension_N_per_mm", "N/mm", "tension"};
constexpr Quantity weft_tension{"weft_tension_N_per_mm", "N/mm", "tension"};
constexpr Quantity thickness_column{"thickness_mm", "mm", "thickness"};
constexpr Quantity pressure_column{"pressure_kPa", "kPa", "pressure"};

void check_last(const std::vector<Row>& rows, const Quantity& x, bool holds, std::string rule,
                std::string way_out, TableProblems& problems) {
  if (rows.empty() || holds) return;
  problems.add("fabric.file.last"_rule, x.column, with_unit(x, rows.back().at), std::move(rule),
               std::move(way_out), rows.back().line);
}

/// Angle and normalised force.
/// @throws InputError  with every problem of the table
std::vector<Row> shear_rows(const fs::path& file) {
  TableProblems problems{file.lexically_normal().string()};
  std::vector<Row> rows;
  for (const ShearRow& row :
       read_rows(read_csv(file), shear_columns, rules_of("a table of a fabric's shear"), problems))
    rows.push_back({row.line, row.angle, {row.force, 0.0}});
  problems.throw_if_any();
  check_rows(rows, angle, {shear_force}, 1.0, 0.0, problems);
  check_last(rows, angle, rows.empty() || rows.back().at < 0.5 * std::numbers::pi, "must end below 90 deg",
             "Tows that lie on one another cannot shear on.", problems);
  problems.throw_if_any();
  return rows;
}

/// Strain and the tensions of warp and weft.
/// @throws InputError  with every problem of the table
std::vector<Row> tension_rows(const fs::path& file) {
  TableProblems problems{file.lexically_normal().string()};
  std::vector<Row> rows;
  for (const TensionRow& row :
       read_rows(read_csv(file), tension_columns, rules_of("a table of a fabric's tension"), problems))
    rows.push_back({row.line, row.strain, {row.warp, row.weft}});
  problems.throw_if_any();
  check_rows(rows, strain, {warp_tension, weft_tension}, 1.0, 0.0, problems);
  check_last(rows, strain, rows.empty() || rows.back().at <= 1.0, "must end at a strain of 1 or less",
             "Strains are fractions: 0.02, not 2 %.", problems);
  problems.throw_if_any();
  return rows;
}

/// Thickness and pressure.
/// @throws InputError  with every problem of the table
std::vector<Row> compaction_rows(const fs::path& file, double thickness) {
  TableProblems problems{file.lexically_normal().string()};
  std::vector<Row> rows;
  for (const CompactionRow& row :
       read_rows(read_csv(file), compaction_columns, rules_of("a table of a fabric's compaction"), problems))
    rows.push_back({row.line, row.thickness, {row.pressure, 0.0}});
  problems.throw_if_any();
  check_rows(rows, thickness_column, {pressure_column}, -1.0, thickness, problems);
  check_last(rows, thickness_column, rows.empty() || rows.back().at > 0.0, "must end above 0 mm",
             "Leave out rows beyond where the fibres are packed.", problems);
  problems.throw_if_any();
  return rows;
}

Curve curve_of(const std::vector<Row>& rows, double (*abscissa)(double, double), double reference) {
  std::vector<double> x, y;
  for (const Row& row : rows) {
    x.push_back(abscissa(row.at, reference));
    y.push_back(row.first());
  }
  return Curve(std::move(x), std::move(y));
}

/// Energy of one tow's tension at i steps from the first, one step more on either side.
///
/// As for the weave's own table the samples become the spline's coefficients, which keeps it convex: the
/// tension is that of the table averaged over a step to either side. What this leaves at rest is taken off.
std::vector<double> energy_of_tow(const Curve& tension, const Surface& weave, std::size_t tow, double low,
                                  double step, int points) {
  const auto shortened = [&](double e) {
    const Surface::Value at = tow == 0 ? weave.evaluate(e, 0.0) : weave.evaluate(0.0, e);
    const Surface::Value rest = weave.evaluate(0.0, 0.0);
    return at.f - rest.f - e * (tow == 0 ? rest.fx : rest.fy);
  };
  std::vector<double> energy(static_cast<std::size_t>(points) + 2);
  for (std::size_t k = 0; k < energy.size(); ++k) {
    const double e = low + step * (static_cast<double>(k) - 1.0);
    energy[k] = e < 0.0 ? shortened(e) : tension.integral(e);
  }
  return energy;
}

Surface uncoupled(const std::vector<Row>& rows, const Surface& weave) {
  // Rest stands on a grid point, so that its tension can be taken off exactly.
  const int points = weave.nx();
  const double high = rows.back().at;
  const int below =
      std::max(2, static_cast<int>(std::lround((points - 1) * -weave.x0() / (high - weave.x0()))));
  const double step = high / (points - 1 - below), low = -below * step;
  std::array<std::vector<double>, 2> value;
  for (std::size_t tow = 0; tow < 2; ++tow) {
    std::vector<double> x, y;
    for (const Row& row : rows) {
      x.push_back(row.at);
      y.push_back(row.value[tow]);
    }
    const std::vector<double> energy = energy_of_tow(Curve(x, y), weave, tow, low, step, points);
    const auto rest = static_cast<std::size_t>(below) + 1;
    const double slope = (energy[rest + 1] - energy[rest - 1]) / (2.0 * step);
    for (std::size_t k = 1; k + 1 < energy.size(); ++k)
      value[tow].push_back((energy[k - 1] + 4.0 * energy[k] + energy[k + 1]) / 6.0 -
                           slope * (low + step * (static_cast<double>(k) - 1.0)));
  }
  std::vector<double> w;
  w.reserve(value[0].size() * value[1].size());
  for (const double warp : value[0])
    for (const double weft : value[1]) w.push_back(warp + weft);
  return {low, step, points, low, step, points, std::move(w)};
}

Surface scaled(const Surface& surface, double scale) {
  std::vector<double> values = surface.values();
  for (double& value : values) value *= scale;
  return {surface.x0(), surface.dx(), surface.nx(),     surface.y0(),
          surface.dy(), surface.ny(), std::move(values)};
}

Curve scaled(const Curve& curve, double scale) {
  std::vector<double> y = curve.y();
  for (double& value : y) value *= scale;
  return {curve.x(), std::move(y)};
}

/// Priors that only what was replaced has read.
void drop_priors(mesoscale::Provenance& provenance, std::initializer_list<std::string_view> names) {
  std::erase_if(provenance.unverified, [&](const std::string& name) {
    return std::find(names.begin(), names.end(), name) != names.end();
  });
}

}  // namespace

Problems check(const FabricOverride& given, double thickness) {
  Problems problems;
  const auto try_to_read = [&](const fs::path& file, const auto& read) {
    if (file.empty()) return;
    try {
      read(file);
    } catch (const InputError& error) {
      problems.insert(problems.end(), error.problems().begin(), error.problems().end());
    }
  };
  try_to_read(given.shear, shear_rows);
  try_to_read(given.tension, tension_rows);
  try_to_read(given.compaction, [&](const fs::path& file) { compaction_rows(file, thickness); });
  return problems;
}

std::vector<std::string> in_words(const FabricOverride& given) {
  std::vector<std::string> said;
  const auto table = [&](const char* what, const fs::path& file) {
    if (!file.empty()) said.push_back(fmt::format("{}: {}", what, file.filename().string()));
  };
  const auto factor = [&](const char* what, double scale) {
    if (scale != 1.0) said.push_back(fmt::format("{}: times {}", what, write_quantity(scale, "")));
  };
  table("shear", given.shear);
  table("tension", given.tension);
  table("compaction", given.compaction);
  for (std::size_t i = 0; i < 2; ++i)
    if (given.bending[i])
      said.push_back(fmt::format("bending along {}: {}", i == 0 ? "warp" : "weft",
                                 write_quantity(*given.bending[i], "N mm")));
  factor("shear", given.shear_scale);
  factor("tension", given.tension_scale);
  return said;
}

mesoscale::CellResult with_given(mesoscale::CellResult weave, const FabricOverride& given) {
  if (in_words(given).empty()) return weave;
  mesoscale::FabricProperties& fabric = weave.fabric;
  if (Problems problems = check(given, fabric.thickness); !problems.empty())
    throw InputError(std::move(problems));
  if (!given.shear.empty()) {
    fabric.shear_stress = curve_of(
        shear_rows(given.shear), [](double at, double) { return std::sin(at); }, 0.0);
    drop_priors(fabric.provenance, {"forming.tow_friction", "forming.reference_tension", "shear.ramp_angle"});
  }
  if (!given.tension.empty())
    fabric.tension_energy = uncoupled(tension_rows(given.tension), fabric.tension_energy);
  if (!given.compaction.empty()) {
    const std::vector<Row> rows = compaction_rows(given.compaction, fabric.thickness);
    fabric.compaction = CurveFamily(
        {0.0}, {curve_of(
                   rows, [](double at, double rest) { return 0.5 * (rest - at); }, rows.front().at)});
  }
  for (std::size_t i = 0; i < 2; ++i)
    if (given.bending[i]) fabric.bending[i] = mesoscale::constant_in_temperature(*given.bending[i]);
  if (given.shear_scale != 1.0) fabric.shear_stress = scaled(fabric.shear_stress, given.shear_scale);
  if (given.tension_scale != 1.0) fabric.tension_energy = scaled(fabric.tension_energy, given.tension_scale);
  if (Problems problems = mesoscale::check(fabric); !problems.empty())
    throw NumericalError("fabric: a given table breaks a rule of the fabric's laws\n" + format(problems));
  return weave;
}

mesoscale::CellResult analyse_cell(const mesoscale::CellSpec& cell, const FabricOverride& given) {
  return with_given(mesoscale::analyse(cell), given);
}

}  // namespace heddle::pipeline
