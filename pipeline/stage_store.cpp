#include "pipeline/stage_store.h"

#include <algorithm>
#include <array>
#include <limits>
#include <optional>
#include <tuple>
#include <vector>

#include <fmt/format.h>

#include "pipeline/friction_store.h"
#include "pipeline/outputs.h"

namespace heddle::pipeline {

namespace {

// A struct of numbers is kept as one row: the same list of members writes and reads it. The sizes tell when a
// member was added and must be named here too.

static_assert(sizeof(mesoscale::CellSummary) == 16 * sizeof(double));
template <class Summary>
auto members(Summary& s) {
  return std::tie(s.areal_density, s.crimp[0], s.crimp[1], s.crimp_angle[0], s.crimp_angle[1],
                  s.gap_closure_angle, s.locking_angle, s.tow_fibre_volume_fraction,
                  s.tow_solid_volume_fraction, s.contact_area_fraction, s.tow_section_area,
                  s.consolidated_thickness, s.thickness, s.tow_share, s.glass_share, s.void_share);
}

static_assert(sizeof(mesoscale::TowBodies) == 6 * sizeof(double));
template <class Bodies>
auto body_members(Bodies& b) {
  return std::tie(b.voxel, b.volume_error, b.overlap_share, b.overlap_depth, b.height_depth, b.height_volume);
}

static_assert(sizeof(FrictionCurveRow) == 7 * sizeof(double));
template <class Row>
auto curve_members(Row& r) {
  return std::tie(r.tool_temperature, r.fabric_temperature, r.pressure, r.slip_speed, r.film_viscosity,
                  r.hersey, r.friction_coefficient);
}

static_assert(sizeof(FrictionTestRow) ==
              sizeof(std::string) + 7 * sizeof(double) + 2 * sizeof(std::optional<double>));
template <class Row>
auto test_members(Row& r) {
  return std::tie(r.velocity, r.normal_force, r.tool_temperature, r.fabric_temperature, r.orientation,
                  r.friction_coefficient, r.pull_force);
}

template <class Tie>
std::vector<double> values_of(const Tie& tie) {
  return std::apply([](const auto&... member) { return std::vector<double>{member...}; }, tie);
}

template <class Tie>
void fill(Tie tie, const std::vector<double>& values, std::size_t row, const std::string& path) {
  constexpr std::size_t n = std::tuple_size_v<Tie>;
  if (values.size() < n * (row + 1)) throw Hdf5Error(path + " is too short");
  std::size_t k = n * row;
  std::apply([&](auto&... member) { ((member = values[k++]), ...); }, tie);
}

template <class Tie>
void write_row(Hdf5Writer& file, const std::string& path, const Tie& tie) {
  file.write(path, values_of(tie));
}

template <class Tie>
void read_row(const Hdf5Reader& file, const std::string& path, Tie tie) {
  fill(tie, file.doubles(path), 0, path);
}

void append(std::vector<double>& out, const std::vector<double>& more) {
  out.insert(out.end(), more.begin(), more.end());
}

void begin(Hdf5Writer& file, const std::string& key, const char* kind) {
  file.write("/key", key);
  file.write("/kind", kind);
}

void demand_kind(const Hdf5Reader& file, const char* kind) {
  if (file.text("/kind") != kind) throw Hdf5Error(fmt::format("is no result of the stage {}", kind));
}

void write_texts(Hdf5Writer& file, const std::string& group, const std::vector<std::string>& texts) {
  file.write(group + "/count", static_cast<int>(texts.size()));
  for (std::size_t k = 0; k < texts.size(); ++k) file.write(fmt::format("{}/{:06d}", group, k), texts[k]);
}

std::vector<std::string> read_texts(const Hdf5Reader& file, const std::string& group) {
  std::vector<std::string> texts(static_cast<std::size_t>(file.integer(group + "/count")));
  for (std::size_t k = 0; k < texts.size(); ++k) texts[k] = file.text(fmt::format("{}/{:06d}", group, k));
  return texts;
}

// ---- pictures of the weave

void write_pictures(Hdf5Writer& file, const WeavePictures& pictures) {
  const auto& h = pictures.height;
  file.write("/height/n", h.n);
  file.write("/height/along_warp", std::span<const double>(h.along_warp));
  file.write("/height/along_weft", std::span<const double>(h.along_weft));
  file.write("/height/top", h.top);
  file.write("/section/count", static_cast<int>(pictures.section.size()));
  for (std::size_t k = 0; k < pictures.section.size(); ++k) {
    const auto& outline = pictures.section[k];
    std::vector<double> flat;
    for (const auto& point : outline.points) flat.insert(flat.end(), point.begin(), point.end());
    file.write(fmt::format("/section/{:06d}/points", k), std::span<const double>(flat),
               {outline.points.size(), 2});
    file.write(fmt::format("/section/{:06d}/warp", k), outline.tow == mesoscale::TowDirection::warp ? 1 : 0);
  }
  write_row(file, "/bodies", body_members(pictures.bodies));
}

WeavePictures read_pictures(const Hdf5Reader& file) {
  WeavePictures pictures;
  auto& h = pictures.height;
  h.n = file.integer("/height/n");
  fill(std::tie(h.along_warp[0], h.along_warp[1]), file.doubles("/height/along_warp"), 0,
       "/height/along_warp");
  fill(std::tie(h.along_weft[0], h.along_weft[1]), file.doubles("/height/along_weft"), 0,
       "/height/along_weft");
  h.top = file.doubles("/height/top");
  pictures.section.resize(static_cast<std::size_t>(file.integer("/section/count")));
  for (std::size_t k = 0; k < pictures.section.size(); ++k) {
    auto& outline = pictures.section[k];
    const std::string path = fmt::format("/section/{:06d}/points", k);
    const std::vector<double> flat = file.doubles(path);
    outline.points.resize(flat.size() / 2);
    for (std::size_t i = 0; i < outline.points.size(); ++i)
      fill(std::tie(outline.points[i][0], outline.points[i][1]), flat, i, path);
    outline.tow = file.integer(fmt::format("/section/{:06d}/warp", k)) != 0 ? mesoscale::TowDirection::warp
                                                                            : mesoscale::TowDirection::weft;
  }
  read_row(file, "/bodies", body_members(pictures.bodies));
  return pictures;
}

// ---- rows

/// What was not measured is kept as no number.
double or_nothing(const std::optional<double>& value) {
  return value.value_or(std::numeric_limits<double>::quiet_NaN());
}
std::optional<double> from_nothing(double value) {
  return value == value ? std::optional(value) : std::nullopt;
}

void write_test(Hdf5Writer& file, const std::vector<FrictionTestRow>& rows) {
  std::vector<std::string> names;
  std::vector<double> values, measured;
  for (const FrictionTestRow& row : rows) {
    names.push_back(row.name);
    append(values, values_of(test_members(row)));
    append(measured, {or_nothing(row.measured_force), or_nothing(row.paper_force)});
  }
  write_texts(file, "/test/names", names);
  file.write("/test/values", values);
  file.write("/test/measured", measured);
}

std::vector<FrictionTestRow> read_test(const Hdf5Reader& file) {
  const auto names = read_texts(file, "/test/names");
  const auto values = file.doubles("/test/values"), measured = file.doubles("/test/measured");
  std::vector<FrictionTestRow> rows(names.size());
  for (std::size_t k = 0; k < rows.size(); ++k) {
    rows[k].name = names[k];
    fill(test_members(rows[k]), values, k, "/test/values");
    double force = 0.0, paper = 0.0;
    fill(std::tie(force, paper), measured, k, "/test/measured");
    rows[k].measured_force = from_nothing(force);
    rows[k].paper_force = from_nothing(paper);
  }
  return rows;
}

}  // namespace

std::string bytes_of(const CellStage& stage, const std::string& key) {
  Hdf5Writer file;
  begin(file, key, "mesoscale");
  write_row(file, "/summary", members(stage.result.summary));
  file.write("/fabric", fabric_json(stage.result.fabric));
  write_pictures(file, stage.pictures);
  return file.finish();
}

CellStage read_cell_stage(const Hdf5Reader& file) {
  demand_kind(file, "mesoscale");
  CellStage stage;
  read_row(file, "/summary", members(stage.result.summary));
  stage.result.fabric = read_fabric_json(file.text("/fabric"), "the cache");
  stage.pictures = read_pictures(file);
  return stage;
}

std::string bytes_of(const FrictionStage& stage, const std::string& key) {
  Hdf5Writer file;
  begin(file, key, "friction");
  write_model(file, stage.model);
  write_test(file, stage.test);
  std::vector<double> curve;
  for (const FrictionCurveRow& row : stage.curve) append(curve, values_of(curve_members(row)));
  file.write("/curve", curve);
  write_texts(file, "/notes", stage.notes);
  return file.finish();
}

FrictionStage read_friction_stage(const Hdf5Reader& file) {
  demand_kind(file, "friction");
  FrictionStage stage;
  stage.model = read_model(file);
  stage.test = read_test(file);
  const std::vector<double> curve = file.doubles("/curve");
  stage.curve.resize(curve.size() / 7);
  for (std::size_t k = 0; k < stage.curve.size(); ++k)
    fill(curve_members(stage.curve[k]), curve, k, "/curve");
  stage.notes = read_texts(file, "/notes");
  return stage;
}

namespace {

static_assert(sizeof(FrictionRigRow) ==
                  sizeof(std::string) + 7 * sizeof(double) + 9 * sizeof(std::optional<double>),
              "a new member: keep it");
template <class Row>
auto rig_members(Row& r) {
  return std::tie(r.velocity, r.normal_force, r.tool_temperature, r.fabric_temperature, r.orientation,
                  r.law_force);
}
template <class Row>
auto rig_optionals(Row& r) {
  return std::tie(r.peak_force, r.peak_displacement, r.steady_force, r.steady_coefficient,
                  r.normal_force_loss, r.film_temperature, r.element_force, r.measured_force, r.paper_force);
}

static_assert(sizeof(FrictionHistoryRow) == sizeof(std::string) + 6 * sizeof(double),
              "a new member: keep it");
template <class Row>
auto history_members(Row& r) {
  return std::tie(r.time, r.displacement, r.pull_force, r.normal_force, r.coefficient, r.film_temperature);
}

constexpr std::size_t rig_optional_count = 9;

void write_rig_rows(Hdf5Writer& file, const std::vector<FrictionRigRow>& rows) {
  std::vector<std::string> names;
  std::vector<double> values, optionals;
  std::vector<int> curved;
  for (const FrictionRigRow& row : rows) {
    names.push_back(row.name);
    curved.push_back(row.curved ? 1 : 0);
    append(values, values_of(rig_members(row)));
    std::apply([&](const auto&... value) { (optionals.push_back(or_nothing(value)), ...); },
               rig_optionals(row));
  }
  write_texts(file, "/rig/names", names);
  file.write("/rig/curved", curved);
  file.write("/rig/values", values);
  file.write("/rig/optionals", optionals);
}

std::vector<FrictionRigRow> read_rig_rows(const Hdf5Reader& file) {
  const auto names = read_texts(file, "/rig/names");
  const auto curved = file.integers("/rig/curved");
  const auto values = file.doubles("/rig/values"), optionals = file.doubles("/rig/optionals");
  std::vector<FrictionRigRow> rows(names.size());
  if (curved.size() != rows.size() || optionals.size() != rig_optional_count * rows.size())
    throw Hdf5Error("/rig has parts of different lengths");
  for (std::size_t k = 0; k < rows.size(); ++k) {
    rows[k].name = names[k];
    rows[k].curved = curved[k] != 0;
    fill(rig_members(rows[k]), values, k, "/rig/values");
    std::size_t at = rig_optional_count * k;
    std::apply([&](auto&... value) { ((value = from_nothing(optionals[at++])), ...); },
               rig_optionals(rows[k]));
  }
  return rows;
}

/// A pull's name stands once, before its samples.
void write_history(Hdf5Writer& file, const std::vector<FrictionHistoryRow>& history) {
  std::vector<std::string> names;
  std::vector<int> counts;
  std::vector<double> values;
  for (const FrictionHistoryRow& row : history) {
    if (names.empty() || names.back() != row.name) {
      names.push_back(row.name);
      counts.push_back(0);
    }
    ++counts.back();
    append(values, values_of(history_members(row)));
  }
  write_texts(file, "/history/names", names);
  file.write("/history/counts", counts);
  file.write("/history/values", values);
}

std::vector<FrictionHistoryRow> read_history(const Hdf5Reader& file) {
  const auto names = read_texts(file, "/history/names");
  const auto counts = file.integers("/history/counts");
  const auto values = file.doubles("/history/values");
  if (counts.size() != names.size()) throw Hdf5Error("/history has parts of different lengths");
  std::vector<FrictionHistoryRow> history;
  for (std::size_t k = 0; k < names.size(); ++k)
    for (int i = 0; i < counts[k]; ++i) {
      FrictionHistoryRow row;
      row.name = names[k];
      fill(history_members(row), values, history.size(), "/history/values");
      history.push_back(std::move(row));
    }
  return history;
}

}  // namespace

std::string bytes_of(const FrictionRigStage& stage, const std::string& key) {
  Hdf5Writer file;
  begin(file, key, "friction_rig");
  write_rig_rows(file, stage.rows);
  write_history(file, stage.history);
  file.write("/plates/count", static_cast<int>(stage.plates.size()));
  for (std::size_t k = 0; k < stage.plates.size(); ++k) {
    const PlatePressure& plate = stage.plates[k];
    const std::string group = fmt::format("/plates/{:06d}", k);
    file.write(group + "/name", plate.name);
    file.write(group + "/count", std::vector<int>{plate.nx, plate.ny});
    file.write(group + "/spacing", std::vector<double>{plate.spacing_x, plate.spacing_y});
    file.write(group + "/lower", plate.lower);
    file.write(group + "/upper", plate.upper);
  }
  write_texts(file, "/notes", stage.notes);
  return file.finish();
}

FrictionRigStage read_friction_rig_stage(const Hdf5Reader& file) {
  demand_kind(file, "friction_rig");
  FrictionRigStage stage;
  stage.rows = read_rig_rows(file);
  stage.history = read_history(file);
  stage.plates.resize(static_cast<std::size_t>(file.integer("/plates/count")));
  for (std::size_t k = 0; k < stage.plates.size(); ++k) {
    PlatePressure& plate = stage.plates[k];
    const std::string group = fmt::format("/plates/{:06d}", k);
    plate.name = file.text(group + "/name");
    const auto count = file.integers(group + "/count");
    if (count.size() != 2) throw Hdf5Error(group + "/count has the wrong length");
    plate.nx = count[0];
    plate.ny = count[1];
    fill(std::tie(plate.spacing_x, plate.spacing_y), file.doubles(group + "/spacing"), 0, group + "/spacing");
    plate.lower = file.doubles(group + "/lower");
    plate.upper = file.doubles(group + "/upper");
  }
  stage.notes = read_texts(file, "/notes");
  return stage;
}

}  // namespace heddle::pipeline
