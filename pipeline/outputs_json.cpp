#include <fmt/format.h>

#include <cmath>
#include <nlohmann/json.hpp>
#include <set>

#include "core/units.h"
#include "pipeline/json_text.h"
#include "pipeline/outputs.h"

namespace heddle::pipeline {

namespace {

using Json = nlohmann::ordered_json;

// ---- writing
// -----------------------------------------------------------------------------------------------------

Json cell_json(const mesoscale::CellSummary& cell, const std::optional<double>& fraction_under_binder) {
  Json out{{"areal_density_kg_m2", cell.areal_density},
           {"crimp_warp", cell.crimp[0]},
           {"crimp_weft", cell.crimp[1]},
           {"crimp_angle_warp_deg", degrees * cell.crimp_angle[0]},
           {"crimp_angle_weft_deg", degrees * cell.crimp_angle[1]},
           {"gap_closure_angle_deg", degrees * cell.gap_closure_angle},
           {"locking_angle_deg", degrees * cell.locking_angle},
           {"tow_fibre_volume_fraction", cell.tow_fibre_volume_fraction},
           {"tow_solid_volume_fraction", cell.tow_solid_volume_fraction},
           {"contact_area_fraction", cell.contact_area_fraction},
           {"tow_section_area_mm2", 1e6 * cell.tow_section_area},
           {"consolidated_thickness_mm", 1e3 * cell.consolidated_thickness},
           {"thickness_mm", 1e3 * cell.thickness},
           {"tow_share", cell.tow_share},
           {"glass_share", cell.glass_share},
           {"void_share", cell.void_share}};
  if (fraction_under_binder) out["contact_area_fraction_binder"] = *fraction_under_binder;
  return out;
}

Json stack_json(const mesoscale::StackSummary& stack) {
  return {{"plies", stack.plies},
          {"thickness_mm", 1e3 * stack.thickness},
          {"thickness_apart_mm", 1e3 * stack.apart},
          {"tow_swelling", stack.swelling},
          {"tow_share", stack.shares.tows},
          {"glass_share", stack.shares.glass},
          {"void_share", stack.shares.voids}};
}

Json plies_json(const macroscale::StackSummary& stack) {
  Json plies = Json::array(), interfaces = Json::array();
  for (const macroscale::PlySummary& ply : stack.plies)
    plies.push_back({{"orientation_deg", degrees * ply.orientation},
                     {"shear_angle_max_deg", degrees * ply.shear_angle_max},
                     {"draw_in_max_mm", 1e3 * ply.draw_in_max}});
  for (const macroscale::InterfaceSummary& between : stack.interfaces)
    interfaces.push_back(
        {{"slip_max_mm", 1e3 * between.slip_max}, {"slip_mean_mm", 1e3 * between.slip_mean}});
  return {{"bottom_first", plies},
          {"interfaces", interfaces},
          {"matrix_patterns", stack.patterns},
          {"pairing_share", stack.pairing_share}};
}

Json heat_json(const macroscale::HeatSummary& heat) {
  Json out{{"temperature_mean_C", heat.last.mean_temperature - zero_celsius},
           {"face_temperature_min_C", heat.last.coldest_face - zero_celsius},
           {"crystallised_share", heat.last.crystallised},
           {"frozen_faces_share", heat.last.frozen_faces},
           {"frozen_through_share", heat.last.frozen_through},
           {"heat_through_bottom_J", heat.last.through_bottom},
           {"heat_through_top_J", heat.last.through_top},
           {"heat_of_friction_J", heat.last.of_friction},
           {"heat_residual_max", heat.residual_share}};
  if (heat.first_face) out["first_face_frozen_s"] = *heat.first_face;
  if (heat.solid) out["solid_s"] = *heat.solid;
  if (heat.held > 0.0) out["held_s"] = heat.held;
  return out;
}

Json release_json(const macroscale::Release& release) {
  return {{"draw_in_max_mm", 1e3 * release.row.draw_in_max},
          {"shear_angle_max_deg", degrees * release.row.shear_angle_max},
          {"moved_max_mm", 1e3 * release.moved},
          {"ledger_residual_J", release.row.ledger_residual}};
}

Json stamping_json(const macroscale::StampingSummary& summary) {
  Json rays = Json::array();
  for (const double draw_in : summary.draw_in_rays) rays.push_back(1e3 * draw_in);
  Json out{{"completed", summary.completed},
           {"peak_punch_force_N", summary.peak_punch_force},
           {"shear_angle_max_deg", degrees * summary.shear_angle_max},
           {"draw_in_max_mm", 1e3 * summary.draw_in_max},
           {"draw_in_rays_mm", rays},
           {"energy_residual_max", summary.energy_residual_max},
           {"force_balance_residual_max", summary.force_balance_residual_max},
           {"numerical_dissipation_share", summary.numerical_dissipation_share},
           {"twist_share", summary.twist_share}};
  // A blank whose grid has not got the eight symmetries of the square has none to miss.
  if (summary.symmetry_gap_shear >= 0.0) out["symmetry_gap_shear"] = summary.symmetry_gap_shear;
  if (summary.symmetry_gap_draw_in >= 0.0) out["symmetry_gap_draw_in"] = summary.symmetry_gap_draw_in;
  out["friction_work_outside_calibration"] = summary.friction_work_outside;
  out["contact_pressure_max_kPa"] = 1e-3 * summary.pressure_max;
  out["crush_share"] = summary.crush_share;
  out["friction_swing"] = summary.friction_swing;
  out["falling_branch"] = summary.falling_branch;
  out["nodes"] = summary.nodes;
  out["spacing_mm"] = {1e3 * summary.spacing[0], 1e3 * summary.spacing[1]};
  out["steps"] = summary.steps;
  out["rejected_steps"] = summary.rejected_steps;
  out["newton_iterations"] = summary.newton_iterations;
  out["factorisations"] = summary.factorisations;
  if (summary.stack) out["plies"] = plies_json(*summary.stack);
  if (summary.heat) out["heat"] = heat_json(*summary.heat);
  if (summary.release) out["release"] = release_json(*summary.release);
  if (!summary.failure.empty()) out["failure"] = summary.failure;
  return out;
}

Json grid_error_json(const macroscale::GridError& error) {
  if (!error.known) return {{"not_known", error.reason}};
  return {{"punch_force_N", error.force},
          {"punch_force_share", error.force_share},
          {"shear_angle_deg", degrees * error.shear_angle},
          {"draw_in_mm", 1e3 * error.draw_in},
          {"companion_spacing_mm", {1e3 * error.spacing[0], 1e3 * error.spacing[1]}},
          {"companion_nodes", error.nodes},
          {"companion_peak_punch_force_N", error.companion_force},
          {"extrapolated_peak_punch_force_N", error.extrapolated_force}};
}

Json failure_json(const macroscale::StampingFailure& failure, const std::string& advice) {
  Json worst = Json::array(), energies = Json::object();
  for (const auto& unknown : failure.worst)
    worst.push_back(
        {{"name", unknown.name},
         {"residual_N", unknown.residual},
         {"position_mm", {1e3 * unknown.position[0], 1e3 * unknown.position[1], 1e3 * unknown.position[2]}}});
  for (const auto& [name, value] : failure.energies) energies[name + "_J"] = value;
  return {{"reason", failure.reason},
          {"advice", advice},
          {"step", failure.step},
          {"time_s", failure.time},
          {"time_step_s", failure.time_step},
          {"worst", std::move(worst)},
          {"energies", std::move(energies)},
          {"not_finite", failure.not_finite}};
}

/// Names of one table of the fabric file: the key of its abscissa and of its ordinate.
struct CurveKeys {
  const char* x;
  const char* y;
};
constexpr CurveKeys shear_stress_keys{"sine_of_shear_angle", "stress_N_m"};
constexpr CurveKeys bending_keys{"temperature_K", "stiffness_N_m"};
constexpr CurveKeys compaction_keys{"approach_m", "pressure_Pa"};
constexpr CurveKeys contact_keys{"log_pressure_Pa", "log_area_fraction"};
constexpr CurveKeys drag_keys{"log_pressure_Pa", "share"};

Json curve_json(const Curve& curve, CurveKeys keys) {
  return {{keys.x, curve.x()}, {keys.y, curve.y()}};
}

Json family_json(const CurveFamily& family, CurveKeys keys) {
  Json curves = Json::array();
  for (const Curve& curve : family.curves()) curves.push_back(curve_json(curve, keys));
  return {{"shear_angle_rad", family.parameter()}, {"curves", std::move(curves)}};
}

Json surface_json(const Surface& surface) {
  return {{"warp_strain_first", surface.x0()}, {"warp_strain_step", surface.dx()},
          {"warp_strain_count", surface.nx()}, {"weft_strain_first", surface.y0()},
          {"weft_strain_step", surface.dy()},  {"weft_strain_count", surface.ny()},
          {"energy_J_m2", surface.values()}};
}

// ---- reading
// -----------------------------------------------------------------------------------------------------

/// Walks a file, and gathers every problem on the way instead of stopping at the first.
class Reader {
 public:
  Reader(std::string file, Problems& problems) : file_(std::move(file)), problems_(problems) {}

  void report(RuleFamily id, const std::string& key, const std::string& value, const std::string& rule) {
    problems_.push_back(
        {id.of(key), key, value, rule, "Write the file anew with `heddle weave CASE.yaml`.", file_, 0});
  }

  /// The node under `key`, or nullptr with a problem noted.
  const Json* member(const Json& parent, const std::string& place, const std::string& key) {
    const auto found = parent.is_object() ? parent.find(key) : parent.end();
    if (parent.is_object() && found != parent.end()) return &*found;
    report("fabric.json.*.missing"_family, path(place, key), "", "is missing");
    return nullptr;
  }

  template <class T>
  void get(T& out, const Json& parent, const std::string& place, const std::string& key) {
    const Json* node = member(parent, place, key);
    if (!node) return;
    try {
      out = node->get<T>();
    } catch (const Json::exception&) {
      report("fabric.json.*.type"_family, path(place, key), shortened(node->dump()),
             fmt::format("must be {}", kind_of(out)));
    }
  }

  void only(const Json& parent, const std::string& place, const std::set<std::string>& known) {
    if (!parent.is_object()) return;
    for (const auto& [key, value] : parent.items()) {
      if (!known.contains(key))
        report("fabric.json.*.unknown"_family, path(place, key), shortened(value.dump()),
               "is not a key of this file");
    }
  }

  /// Problems so far: a table is made only of parts that were all in order.
  std::size_t count() const { return problems_.size(); }

  static std::string path(const std::string& place, const std::string& key) {
    return place.empty() ? key : place + "." + key;
  }

 private:
  static std::string shortened(std::string text) {
    return text.size() > 40 ? text.substr(0, 37) + "..." : text;
  }
  static const char* kind_of(double) { return "a number"; }
  static const char* kind_of(int) { return "a whole number"; }
  static const char* kind_of(const std::string&) { return "a text"; }
  static const char* kind_of(const std::vector<double>&) { return "a list of numbers"; }
  static const char* kind_of(const std::vector<std::string>&) { return "a list of texts"; }
  static const char* kind_of(const std::array<double, 2>&) { return "a list of two numbers"; }
  std::string file_;
  Problems& problems_;
};

/// Makes a table if nothing was wrong with its parts since `before`. One that breaks the rules of its class
/// is a problem of the file, told in the class's own words.
template <class Make>
void construct(Reader& reader, const std::string& place, std::size_t before, const Make& make) {
  if (reader.count() > before) return;
  try {
    make();
  } catch (const std::invalid_argument& fault) {
    reader.report("fabric.json.*.table"_family, place, "", fault.what());
  }
}

Curve read_curve(Reader& reader, const Json& node, const std::string& place, CurveKeys keys) {
  const std::size_t before = reader.count();
  std::vector<double> x, y;
  reader.get(x, node, place, keys.x);
  reader.get(y, node, place, keys.y);
  reader.only(node, place, {keys.x, keys.y});
  Curve curve;
  if (x.empty() && y.empty()) return curve;
  construct(reader, place, before, [&] { curve = Curve(x, y); });
  return curve;
}

CurveFamily read_family(Reader& reader, const Json& node, const std::string& place, CurveKeys keys) {
  const std::size_t before = reader.count();
  std::vector<double> parameter;
  reader.get(parameter, node, place, "shear_angle_rad");
  reader.only(node, place, {"shear_angle_rad", "curves"});
  std::vector<Curve> curves;
  if (const Json* list = reader.member(node, place, "curves")) {
    if (!list->is_array())
      reader.report("fabric.json.*.type"_family, Reader::path(place, "curves"), "",
                    "must be a list of tables");
    std::size_t i = 0;
    for (const Json& entry : *list) {
      curves.push_back(read_curve(reader, entry, fmt::format("{}.curves[{}]", place, i++), keys));
    }
  }
  CurveFamily family;
  if (parameter.empty() && curves.empty()) return family;
  construct(reader, place, before, [&] { family = CurveFamily(parameter, curves); });
  return family;
}

Surface read_surface(Reader& reader, const Json& node, const std::string& place) {
  const std::size_t before = reader.count();
  double x0 = 0.0, dx = 0.0, y0 = 0.0, dy = 0.0;
  int nx = 0, ny = 0;
  std::vector<double> values;
  reader.get(x0, node, place, "warp_strain_first");
  reader.get(dx, node, place, "warp_strain_step");
  reader.get(nx, node, place, "warp_strain_count");
  reader.get(y0, node, place, "weft_strain_first");
  reader.get(dy, node, place, "weft_strain_step");
  reader.get(ny, node, place, "weft_strain_count");
  reader.get(values, node, place, "energy_J_m2");
  reader.only(node, place,
              {"warp_strain_first", "warp_strain_step", "warp_strain_count", "weft_strain_first",
               "weft_strain_step", "weft_strain_count", "energy_J_m2"});
  Surface surface;
  if (nx == 0 && ny == 0 && values.empty()) return surface;
  construct(reader, place, before, [&] { surface = Surface(x0, dx, nx, y0, dy, ny, values); });
  return surface;
}

mesoscale::ShearRate read_shear_rate(Reader& reader, const Json& node) {
  mesoscale::ShearRate rate;
  const std::string place = "shear_rate";
  reader.get(rate.consistency, node, place, "consistency_N_s_n_m");
  reader.get(rate.index, node, place, "index");
  reader.get(rate.activation_temperature, node, place, "activation_temperature_K");
  reader.get(rate.reference_temperature, node, place, "reference_temperature_K");
  reader.only(node, place,
              {"consistency_N_s_n_m", "index", "activation_temperature_K", "reference_temperature_K"});
  return rate;
}

mesoscale::Provenance read_provenance(Reader& reader, const Json& node) {
  mesoscale::Provenance provenance;
  const std::string place = "provenance";
  reader.get(provenance.specification, node, place, "specification");
  reader.get(provenance.unverified, node, place, "unverified");
  reader.get(provenance.grid_error, node, place, "grid_error");
  reader.only(node, place, {"specification", "unverified", "grid_error", "given"});
  return provenance;
}

mesoscale::FabricProperties read_fabric(Reader& reader, const Json& root) {
  mesoscale::FabricProperties fabric;
  reader.get(fabric.areal_density, root, "", "areal_density_kg_m2");
  reader.get(fabric.pitch, root, "", "pitch_m");
  reader.get(fabric.thickness, root, "", "thickness_m");
  if (const Json* node = reader.member(root, "", "tension_energy")) {
    fabric.tension_energy = read_surface(reader, *node, "tension_energy");
  }
  if (const Json* node = reader.member(root, "", "shear_stress")) {
    fabric.shear_stress = read_curve(reader, *node, "shear_stress", shear_stress_keys);
  }
  if (const Json* node = reader.member(root, "", "shear_rate"))
    fabric.shear_rate = read_shear_rate(reader, *node);
  if (const Json* node = reader.member(root, "", "bending")) {
    static constexpr std::array<const char*, 2> ways{"warp", "weft"};
    for (std::size_t way = 0; way < 2; ++way) {
      const Json* curve = reader.member(*node, "bending", ways[way]);
      if (curve)
        fabric.bending[way] = read_curve(reader, *curve, fmt::format("bending.{}", ways[way]), bending_keys);
    }
    reader.only(*node, "bending", {"warp", "weft"});
  }
  if (const Json* node = reader.member(root, "", "compaction")) {
    fabric.compaction = read_family(reader, *node, "compaction", compaction_keys);
  }
  if (const Json* node = reader.member(root, "", "contact")) {
    fabric.contact.log_fraction = read_family(reader, *node, "contact", contact_keys);
  }
  if (root.contains("ply_facing")) {
    const Json& node = root["ply_facing"];
    reader.get(fabric.facing.rest, node, "ply_facing", "rest_m");
    if (const Json* curve = reader.member(node, "ply_facing", "compaction"))
      fabric.facing.compaction = read_curve(reader, *curve, "ply_facing.compaction", compaction_keys);
    reader.only(node, "ply_facing", {"rest_m", "compaction"});
  }
  if (root.contains("drag_direction")) {  // where a film was asked for
    const Json& node = root["drag_direction"];
    const auto part = [&](const char* name) {
      const Json* family = reader.member(node, "drag_direction", name);
      return family ? read_family(reader, *family, fmt::format("drag_direction.{}", name), drag_keys)
                    : CurveFamily();
    };
    fabric.contact.drag = {part("cos_2_theta"), part("sin_2_theta")};
    reader.only(node, "drag_direction", {"cos_2_theta", "sin_2_theta"});
  }
  if (const Json* node = reader.member(root, "", "provenance"))
    fabric.provenance = read_provenance(reader, *node);
  reader.only(
      root, "",
      {"areal_density_kg_m2", "pitch_m", "thickness_m", "tension_energy", "shear_stress", "shear_rate",
       "bending", "compaction", "contact", "ply_facing", "drag_direction", "provenance"});
  return fabric;
}

constexpr std::size_t places_shown = 10;

Json folds_json(const macroscale::Folds& folds, const macroscale::StampingSummary& run) {
  Json places = Json::array();
  for (std::size_t k = 0; k < std::min(folds.place.size(), places_shown); ++k) {
    const macroscale::FoldPlace& place = folds.place[k];
    places.push_back({{"at_mm", {1e3 * place.at[0], 1e3 * place.at[1], 1e3 * place.at[2]}},
                      {"nodes", place.nodes},
                      {"turn_deg", degrees * place.turn},
                      {"distance_mm", 1e3 * place.distance}});
  }
  Json out{{"count", folds.place.size()},
           {"folded_nodes", folds.folded},
           {"near_nodes", folds.near},
           {"self_crossings", folds.crossings},
           {"places", places},
           {"self_crossings_in_any_step", run.self_crossings}};
  if (run.self_crossings > 0) out["first_self_crossing_mm"] = 1e3 * run.first_crossing;
  if (run.self_contact && run.self_contact->met) {
    out["matrix_patterns"] = run.self_contact->patterns;
    out["pairing_share"] = run.self_contact->pairing_share;
  }
  return out;
}

std::string name_with_unit(const macroscale::LargestIndicator& indicator) {
  return indicator.name + (indicator.unit.empty() ? "" : "_" + indicator.unit);
}

Json texts_json(const std::vector<std::pair<std::string, std::string>>& entries) {
  Json out = Json::object();
  for (const auto& [key, value] : entries) out[key] = value;
  return out;
}

}  // namespace

std::string summary_json(const SummaryRecord& record) {
  Json root = Json::object();
  if (record.cell) root["mesoscale"] = cell_json(*record.cell, record.contact_area_fraction_binder);
  if (record.cell && record.stack) root["mesoscale"]["stack"] = stack_json(*record.stack);
  if (record.cell && record.tow_bodies) {
    root["mesoscale"]["tow_volume_error"] = record.tow_bodies->volume_error;
    root["mesoscale"]["tow_overlap_share"] = record.tow_bodies->overlap_share;
    root["mesoscale"]["tow_overlap_depth_mm"] = 1e3 * record.tow_bodies->overlap_depth;
    root["mesoscale"]["height_overlap_depth_mm"] = 1e3 * record.tow_bodies->height_depth;
    root["mesoscale"]["height_overlap_volume_mm3"] = 1e9 * record.tow_bodies->height_volume;
  }
  if (record.stamping) root["macroscale"] = stamping_json(*record.stamping);
  if (record.stamping && record.grid_error)
    root["macroscale"]["grid_error"] = grid_error_json(*record.grid_error);
  for (const macroscale::LargestIndicator& indicator : record.indicators)
    root["macroscale"]["indicators"][name_with_unit(indicator)] = indicator.value;
  if (record.stamping && record.folds)
    root["macroscale"]["folds"] = folds_json(*record.folds, *record.stamping);
  if (record.failure) root["failure"] = failure_json(*record.failure, record.advice);
  return json_text(root);
}

std::string fabric_json(const mesoscale::FabricProperties& fabric, const std::vector<std::string>& given) {
  Json root{{"areal_density_kg_m2", fabric.areal_density},
            {"pitch_m", fabric.pitch},
            {"thickness_m", fabric.thickness},
            {"tension_energy", surface_json(fabric.tension_energy)},
            {"shear_stress", curve_json(fabric.shear_stress, shear_stress_keys)},
            {"shear_rate",
             {{"consistency_N_s_n_m", fabric.shear_rate.consistency},
              {"index", fabric.shear_rate.index},
              {"activation_temperature_K", fabric.shear_rate.activation_temperature},
              {"reference_temperature_K", fabric.shear_rate.reference_temperature}}},
            {"bending",
             {{"warp", curve_json(fabric.bending[0], bending_keys)},
              {"weft", curve_json(fabric.bending[1], bending_keys)}}},
            {"compaction", family_json(fabric.compaction, compaction_keys)},
            {"contact", family_json(fabric.contact.log_fraction, contact_keys)},
            {"provenance",
             {{"specification", fabric.provenance.specification},
              {"unverified", fabric.provenance.unverified},
              {"grid_error", fabric.provenance.grid_error}}}};
  if (const mesoscale::PlyFacing& facing = fabric.facing; !facing.empty())
    root["ply_facing"] = {{"rest_m", facing.rest},
                          {"compaction", curve_json(facing.compaction, compaction_keys)}};
  if (const mesoscale::DragDirection& drag = fabric.contact.drag; !drag.empty())
    root["drag_direction"] = {{"cos_2_theta", family_json(drag.cosine, drag_keys)},
                              {"sin_2_theta", family_json(drag.sine, drag_keys)}};
  if (!given.empty()) root["provenance"]["given"] = given;
  return json_text(root);
}

mesoscale::FabricProperties read_fabric_json(std::string_view text, const std::string& file) {
  Problems problems;
  mesoscale::FabricProperties fabric;
  try {
    const Json root = Json::parse(text);
    Reader reader(file, problems);
    fabric = read_fabric(reader, root);
  } catch (const Json::exception& error) {
    problems.push_back({"fabric.json.syntax"_rule, "", "", fmt::format("must be JSON; {}", error.what()),
                        "Write the file anew with `heddle weave CASE.yaml`.", file, 0});
  }
  if (!problems.empty()) throw InputError(std::move(problems));
  return fabric;
}

std::string manifest_json(const Manifest& manifest) {
  Json stages = Json::object();
  for (const StageRecord& stage : manifest.stages) {
    stages[stage.name] = {{"wall_s", stage.wall_time},
                          {"cpu_s", stage.cpu_time},
                          {"peak_memory_MB", 1e-6 * stage.peak_memory},
                          {"reused", stage.reused}};
  }
  const Json root{{"name", manifest.name},
                  {"versions", texts_json(manifest.versions)},
                  {"hashes", texts_json(manifest.hashes)},
                  {"machine", texts_json(manifest.machine)},
                  {"stages", std::move(stages)}};
  return json_text(root);
}

}  // namespace heddle::pipeline
