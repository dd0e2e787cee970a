#include <algorithm>
#include <catch2/catch.hpp>
#include <filesystem>
#include <set>
#include <string>
#include <utility>
#include <vector>

#include "bad_files.h"
#include "core/text_file.h"
#include "pipeline/case.h"
#include "tests/source_dir.h"

using namespace heddle;

namespace {

using Place = std::pair<std::string, int>;  ///< rule and line

struct BadFile {
  const char* name;
  std::vector<Place> problems;  ///< all that are found, in the order printed
};

const std::vector<BadFile> bad_files{
    {"alias", {{"resin.power_index.anchor", 4}, {"forming.bonding.alias", 5}}},
    {"alias_for_a_required_key", {{"name.anchor", 2}, {"weave.pattern.alias", 3}}},
    {"anchor", {{"name.anchor", 2}}},
    {"angle_is_no_list", {{"orientation_study.blanks.list", 8}}},
    {"angle_twice", {{"orientation_study.blanks.distinct", 8}}},
    {"binder_that_crushes_the_fabric", {{"process.binder_force.crush", 5}}},
    {"binder_smaller_than_the_punch", {{"tools.binder.inner_radius.clearance", 6}}},
    {"binder_without_a_flat_face", {{"tools.binder.passage", 6}, {"tools.binder.hold", 6}}},
    {"blank_crosses_itself", {{"blank.points.simple", 7}}},
    {"blank_is_a_line", {{"blank.points.area", 7}}},
    {"blank_outside_the_die", {{"blank.size.reach", 7}}},
    {"block_is_a_value", {{"resin.map", 4}}},
    {"celsius_difference", {{"effects.tool_temperature_shift.slope.unit", 5}}},
    {"box_upside_down", {{"friction.calibration.box_order", 8}}},
    {"calibrate_parameters_are_no_list", {{"calibrate.parameters.list", 5}}},
    {"calibrate_prior_of_a_held_number",
     {{"calibrate.prior.resin.power_index.not_fitted", 7},
      {"calibrate.bounds.friction.exponent.not_fitted", 9}}},
    {"discover_priors_of_other_numbers", {{"discover.prior.spread", 8}, {"discover.prior.not_moved", 9}}},
    {"calibrate_unknown_numbers", {{"calibrate.parameters.name", 5}}},
    {"choice", {{"fabric.shear_rate.choice", 4}}},
    {"compacted_both_ways", {{"cell.state.compacted", 4}}},
    {"compacted_thinner_than_its_glass_and_resin", {{"cell.thickness.room", 4}}},
    {"compacted_until_no_void_is_left", {{"cell.pressure.room", 4}}},
    {"plies_that_nest_twice", {{"blank.nesting.facing", 8}}},
    {"plies_turned_at_one_shift", {{"cell.facing.layup", 4}}},
    {"plies_with_temperatures", {{"blank.plies.thermal", 8}}},
    {"quarter_of_what_is_not_symmetric",
     {{"blank.symmetry.orientation", 10},
      {"blank.symmetry.plies", 11},
      {"blank.symmetry.outline", 13},
      {"blank.symmetry.sectors", 6},
      {"blank.symmetry.offset", 15},
      {"blank.symmetry.tilt", 16},
      {"blank.symmetry.turned", 17}}},
    {"film_direction_without_a_film",
     {{"effects.orientation.form.film", 7}, {"effects.orientation.film", 8}}},
    {"film_out_of_range", {{"film.samples.range", 5}, {"film.fill.range", 6}, {"film.speed.range", 7}}},
    {"film_of_a_twill", {{"film.rheology", 6}, {"film.weave", 6}}},
    {"facing_beside_what_was_measured", {{"cell.facing.compaction", 4}}},
    {"facing_of_the_solid_part", {{"cell.facing.state", 4}}},
    {"free_tilt_of_a_binder_that_cannot",
     {{"tools.binder.tilt.sectors", 9},
      {"tools.binder.tilt.angle", 9},
      {"tools.binder.tilt.symmetry", 9},
      {"blank.symmetry.sectors", 9},
      {"blank.symmetry.tilt", 12}}},
    {"quarters_of_turned_blanks", {{"orientation_study.blanks.symmetry", 8}}},
    {"half_of_a_lopsided_tool", {{"tools.punch.mirrored", 6}}},
    {"plies_without_their_angles", {{"blank.layup.plies", 7}, {"blank.nesting.thickness", 7}}},
    {"plies_with_too_few_shifts", {{"cell.shift_warp.plies", 4}}},
    {"warp_takes_too_much_crimp", {{"weave.warp_crimp.room", 3}}},
    {"hybrid_section_that_cannot_be",
     {{"weave.upper_share.range", 12},
      {"weave.upper.section_power.range", 13},
      {"weave.lower.section.choice", 14}}},
    {"consistency_without_n", {{"resin.consistency.unit", 4}}},
    {"constants_beside_data", {{"friction.scale.beside_data", 6}}},
    {"corner_twice", {{"blank.points.repeated_point", 7}}},
    {"coulomb_out_of_range", {{"friction.coefficient.range", 4}}},
    {"curve_to_be_fitted", {{"friction.calibration.law", 0}}},
    {"design_with_wrong_rows",
     {{"friction.design.unit", 2},
      {"friction.design.number", 3},
      {"friction.design.parameter", 4},
      {"friction.design.bending", 5}}},
    {"design_without_baseline",
     {{"friction.design.missing", 0},
      {"friction.design.missing", 0},
      {"friction.design.missing", 0},
      {"friction.design.missing", 0}}},
    {"design_without_header", {{"friction.design.header", 1}}},
    {"die_smaller_than_the_punch", {{"tools.die.opening_radius.clearance", 6}}},
    {"drawing_binary", {{"blank.drawing.file.binary", 1}}},
    {"drawing_branches", {{"blank.drawing.file.branch", 36}}},
    {"drawing_circle_of_no_size", {{"blank.drawing.file.radius", 38}}},
    {"drawing_circle_without_radius", {{"blank.drawing.file.group", 16}}},
    {"drawing_empty", {{"blank.drawing.file.no_border", 0}}},
    {"drawing_hole_across_the_edge", {{"blank.drawing.apart", 0}}},
    {"drawing_hole_in_a_hole", {{"blank.drawing.hole_in_hole", 0}}},
    {"drawing_hole_outside", {{"blank.drawing.hole_inside", 0}}},
    {"drawing_inches", {{"blank.drawing.length_unit.stated", 7}}},
    {"drawing_is_a_mesh", {{"blank.drawing.file.type", 7}}},
    {"drawing_is_a_solid", {{"blank.drawing.file.cad", 0}}},
    {"drawing_mesh", {{"blank.drawing.file.polyline", 16}}},
    {"drawing_open", {{"blank.drawing.file.open", 16}}},
    {"drawing_spline", {{"blank.drawing.file.entity", 38}}},
    {"drawing_upright", {{"blank.drawing.file.plane", 16}}},
    {"duplicate_key", {{"name.duplicate", 4}}},
    {"effect_neither_on_nor_off", {{"effects.tool_temperature_shift.map", 5}}},
    {"effect_that_the_law_has",
     {{"friction.combination.shear_heating.no_hersey_number", 7},
      {"friction.combination.static_peak.static_kinetic", 6}}},
    {"fabric_thinner_than_its_tows", {{"weave.fabric_thickness.consistent", 3}}},
    {"fabric_compacted_and_solid", {{"fabric.compaction.file.state", 4}}},
    {"fabric_shear_columns",
     {{"fabric.file.column.twice", 1}, {"fabric.file.column.unknown", 1}, {"fabric.file.column.missing", 1}}},
    {"fabric_shear_short", {{"fabric.file.rows", 2}}},
    {"fabric_shear_words", {{"fabric.file.number", 3}}},
    {"fabric_numbers_out_of_range", {{"fabric.shear_scale.range", 5}, {"fabric.bending.warp.range", 6}}},
    {"fabric_tables_of_no_fabric",
     {{"fabric.file.start", 2},
      {"fabric.file.order", 4},
      {"fabric.file.monotone", 5},
      {"fabric.file.last", 6},
      {"fabric.file.nothing", 4},
      {"fabric.file.start", 2},
      {"fabric.file.order", 4}}},
    {"fibres_packed_too_densely", {{"weave.fibre_mass_fraction.packing", 3}}},
    {"fitted_to_nothing", {{"effects.tool_temperature_shift.slope.fitted", 5}}},
    {"gap_wider_than_the_tow", {{"weave.gap.proportion", 3}}},
    {"grid_too_coarse", {{"blank.spacing.coarse", 7}}},
    {"grid_too_fine", {{"blank.spacing.nodes", 7}}},
    {"hersey_table_falling", {{"friction.hersey_table.hersey.order", 0}}},
    {"hersey_table_of_one_pair", {{"friction.hersey_table.size", 0}}},
    {"hersey_table_out_of_range",
     {{"friction.hersey_table.coefficient.range", 0}, {"friction.hersey_table.hersey.range", 0}}},
    {"hersey_table_with_nan", {{"friction.hersey_table.number", 3}, {"friction.hersey_table.number", 4}}},
    {"hersey_table_with_other_columns", {{"friction.hersey_table.column", 1}}},
    {"hersey_table_with_words", {{"friction.hersey_table.number", 3}}},
    {"hole_across_the_edge", {{"blank.holes.inside", 7}}},
    {"hole_without_radius", {{"blank.holes.rows", 7}}},
    {"key_is_a_list", {{"key", 4}}},
    {"key_of_another_block", {{"cell.fibre_density.unknown", 4}}},
    {"later_effect", {{"effects.inter_tow_slip.later", 5}}},
    {"leading_zero", {{"forming.compaction_exponent.unit", 8}}},
    {"linear_form_not_positive", {{"friction.offset.positive", 4}}},
    {"linear_form_out_of_range", {{"friction.reference_hersey.range", 4}}},
    {"many_at_once",
     {{"weave.tow_width.unit", 3},
      {"weave.gap.range", 3},
      {"friction.law.choice", 4},
      {"process.stepz.unknown", 5},
      {"process.binder_force.required", 5},
      {"tools.die.fillet.range", 8},
      {"blank.size.pair", 10},
      {"blank.plies.range", 10}}},
    {"melt_that_thickens", {{"resin.carreau_yasuda.order", 8}}},
    {"merge_key", {{"resin.<<.merge", 4}}},
    {"missing_by_law", {{"friction.coefficient.required", 4}}},
    {"missing_constant", {{"friction.scale.required", 4}}},
    {"missing_file", {{"friction.calibration.data.file", 4}}},
    {"missing_key", {{"weave.tow_width.required", 3}}},
    {"missing_plate_area", {{"friction.calibration.plate_area.required", 4}}},
    {"name_with_blank", {{"name.word", 2}}},
    {"no_unit", {{"resin.film_thickness.unit", 4}}},
    {"no_value", {{"name.value", 2}}},
    {"no_version", {{"heddle.required", 1}}},
    {"not_a_map", {{"yaml.map", 1}}},
    {"not_a_number", {{"resin.power_index.unit", 4}}},
    {"not_whole", {{"process.steps.integer", 5}}},
    {"other_version", {{"heddle.choice", 1}}},
    {"out_of_range", {{"resin.power_index.range", 4}}},
    {"pair", {{"blank.size.pair", 7}}},
    {"percent_of_a_number", {{"resin.power_index.unit", 4}}},
    {"plate_area_outside_its_band", {{"friction.calibration.plate_area_band.order", 4}}},
    {"power_form_out_of_range",
     {{"friction.scale.range", 6},
      {"friction.exponent.range", 7},
      {"effects.tool_temperature_shift.slope.range", 11},
      {"effects.tool_temperature_shift.reference.range", 12}}},
    {"pulled_weave_thinner_than_its_tows", {{"friction.calibration.weave.fabric_thickness.consistent", 4}}},
    {"punch_motion_columns",
     {{"process.punch.file.column.twice", 1},
      {"process.punch.file.column.unknown", 1},
      {"process.punch.file.column.missing", 1}}},
    {"punch_motion_goes_back", {{"process.punch.file.number", 6}}},
    {"punch_motion_late",
     {{"process.punch.file.start", 2}, {"process.punch.file.time", 4}, {"process.punch.file.travel", 5}}},
    {"punch_motion_of_one_row", {{"process.punch.file.rows", 2}}},
    {"punch_motion_too_deep", {{"process.punch.stroke.reach", 5}}},
    {"punch_faster_than_sound", {{"process.punch.time.speed", 5}}},
    {"punch_lower_than_the_stroke", {{"tools.punch.height", 6}}},
    {"punch_too_large_for_the_fabric", {{"tools.die.opening_radius.fabric", 6}}},
    {"renard_speeds_swapped", {{"friction.renard.order", 8}}},
    {"resin_out_of_range",
     {{"resin.consistency.range", 5},
      {"resin.power_index.range", 6},
      {"resin.film_thickness.range", 7},
      {"resin.activation_energy.range", 8},
      {"resin.reference_temperature.range", 9},
      {"resin.rate_floor.range", 10}}},
    {"rig_bend_longer_than_the_plates", {{"friction_test.rig.bend.length", 7}}},
    {"rig_elements_without_weave", {{"friction_test.rig.finite_elements.weave", 7}}},
    {"round_blank_inside_the_die", {{"blank.radius.reach", 7}}},
    {"study_gap_too_wide", {{"study.gap.weave", 5}}},
    {"study_gap_twice", {{"study.gap.distinct", 5}}},
    {"study_of_too_many_cells", {{"study.design.cells", 5}}},
    {"study_pattern_no_weave", {{"study.pattern.weave", 5}}},
    {"study_step_too_long", {{"study.step.weave", 5}}},
    {"study_width_hidden", {{"study.tow_width.hidden", 5}}},
    {"rules_between_keys_beside_wrong_keys",
     {{"weave.gap.range", 3},
      {"weave.fabric_thickness.consistent", 3},
      {"friction.exponent.unit", 4},
      {"friction.calibration.plate_area_band.order", 4},
      {"process.binder_force.unit", 5},
      {"process.punch.stroke.reach", 5},
      {"tools.die.fillet.unit", 6},
      {"tools.die.opening_radius.clearance", 6}}},
    {"set_below_a_value", {{"name.first.set", 0}}},
    {"set_without_a_path", {{"set.syntax", 0}}},
    {"punch_runs_into_the_die", {{"effects.punch_misalignment.offset.clearance", 9}}},
    {"die_with_a_floor_too_high", {{"tools.die.depth.bowl", 13}, {"tools.die.depth.stroke", 13}}},
    {"press_out_of_range",
     {{"process.bottoming_force.range", 9},
      {"process.gravity.choice", 10},
      {"process.dwell.range", 11},
      {"process.release.choice", 12},
      {"tools.die.bottom.choice", 15},
      {"tools.die.depth.required", 15},
      {"tools.binder.gap.range", 21},
      {"tools.binder.sectors.range", 22},
      {"effects.press_compliance.compliance.range", 25},
      {"effects.binder_tilt.angle.range", 26}}},
    {"forming_effects_out_of_range",
     {{"effects.shear_locking.amplitude.range", 10},
      {"effects.shear_locking.angle.range", 11},
      {"effects.shear_locking.exponent.range", 12},
      {"effects.tension_shear_coupling.amplitude.range", 14},
      {"effects.tension_shear_coupling.reference.range", 15},
      {"effects.bending.factor.range", 16},
      {"effects.tow_rate_stiffening.viscosity.range", 17},
      {"effects.crimp_straightening.stretch.range", 18},
      {"effects.shear_thermal_softening.rate.range", 19},
      {"effects.blank_cooling.rate.range", 20},
      {"effects.inertia.factor.range", 21},
      {"effects.binder_force_level.error.range", 22},
      {"effects.initial_orientation.angle.range", 23}}},
    {"coupling_beside_hysteresis", {{"effects.tension_shear_coupling.amplitude.hysteresis", 9}}},
    {"cooling_beside_temperatures", {{"effects.blank_cooling.rate.thermal", 9}}},
    {"shape_misspelt", {{"blank.shape.choice", 7}}},
    {"slow_down_longer_than_the_stroke", {{"process.punch.slow_down.shorter", 5}}},
    {"shear_hysteresis_out_of_range",
     {{"fabric.shear_hysteresis.share.range", 4}, {"fabric.shear_hysteresis.stiffness.range", 4}}},
    {"shear_rate_negative", {{"effects.shear_rate.factor.range", 8}}},
    {"solid_out_of_range",
     {{"solid.per_pitch.range", 5}, {"solid.resin_poisson.range", 6}, {"solid.tow_model.choice", 7}}},
    {"speed_scale_zero", {{"process.punch.speed_scale.range", 5}}},
    {"stamping_out_of_range",
     {{"process.punch.stroke.range", 7},
      {"process.punch.time.range", 8},
      {"process.punch.slow_down.range", 9},
      {"process.punch.speed_scale.range", 10},
      {"process.steps.range", 11},
      {"process.binder_force.range", 12},
      {"tools.punch.radius.range", 16},
      {"tools.die.fillet.range", 17},
      {"tools.binder.edge_fillet.range", 21},
      {"tools.binder.mass.range", 22},
      {"blank.spacing.range", 25},
      {"blank.plies.range", 26},
      {"blank.nesting.range", 27},
      {"artefact.mass_scaling.range", 29},
      {"artefact.stabilisation.range", 30}}},
    {"step_file_cut_off", {{"tools.punch.file.cut_off", 3}}},
    {"step_file_in_another_unit", {{"tools.punch.length_unit.stated", 6}}},
    {"step_file_meshed_too_coarsely", {{"tools.punch.mesh_size.cad", 6}}},
    {"step_file_of_another_kind", {{"tools.punch.file.format", 1}}},
    {"step_file_without_unit", {{"tools.punch.file.unit", 0}}},
    {"stampings_of_a_nameless_model",
     {{"stamping_study.speed_scale.distinct", 9},
      {"stamping_study.models.distinct", 10},
      {"stamping_study.models.form", 10},
      {"stamping_study.models.form", 10}}},
    {"stampings_of_nothing", {{"stamping_study.varies", 8}}},
    {"stampings_varied_wrongly",
     {{"stamping_study.vary.form", 10},
      {"stamping_study.vary.key", 11},
      {"stamping_study.vary.key", 12},
      {"stamping_study.vary.many", 13},
      {"stamping_study.vary.distinct", 14},
      {"tools.punch.friction_coefficient.range", 15},
      {"process.binder_force.unit", 16},
      {"stamping_study.vary.distinct", 18}}},
    {"stroke_pulls_the_blank_out", {{"process.punch.stroke.reach", 5}}},
    {"syntax", {{"yaml.syntax", 4}}},
    {"tab", {{"yaml.tab", 4}}},
    {"table_binary", {{"csv.encoding", 0}}},
    {"table_of_one_change", {{"friction.calibration.rank", 0}}},
    {"table_too_short", {{"friction.calibration.rows", 0}}},
    {"table_with_a_short_row", {{"csv.cells", 3}}},
    {"table_with_impossible_rows",
     {{"friction.test.velocity.range", 0}, {"friction.test.measured_force.missing", 0}}},
    {"table_with_nan", {{"friction.table.number", 3}}},
    {"table_with_other_columns",
     {{"friction.table.column.unknown", 1},
      {"friction.table.column.twice", 1},
      {"friction.table.column.missing", 1}}},
    {"table_with_semicolons", {{"csv.separator", 1}}},
    {"table_without_content", {{"csv.empty", 0}}},
    {"table_without_rows", {{"friction.test.empty", 0}}},
    {"tag", {{"resin.power_index.tag", 4}}},
    {"thermal_layers_that_cannot_be",
     {{"thermal.film.density.mass", 10}, {"thermal.contact.full.order", 13}}},
    {"thermal_that_cools_twice",
     {{"friction.film_temperature.thermal", 10},
      {"effects.tool_temperature_film.thermal", 16},
      {"effects.tool_temperature_shift.thermal", 17},
      {"effects.shear_heating.thermal", 18}}},
    {"thermal_with_a_law_fitted_cold", {{"friction.calibration.thermal", 8}}},
    {"tool_friction_out_of_range",
     {{"tools.punch.friction_coefficient.range", 7},
      {"tools.die.friction_coefficient.unit", 8},
      {"tools.binder.friction_coefficient.range", 9}}},
    {"tool_beside_a_wrong_key", {{"friction.coefficient.unit", 4}, {"tools.punch.length_unit.size", 6}}},
    {"tool_corner_not_a_number", {{"tools.punch.file.number", 2}}},
    {"tool_crosses_itself", {{"tools.punch.self_intersection", 0}}},
    {"tool_face_not_convex", {{"tools.punch.file.convex", 5}}},
    {"tool_face_of_two_corners", {{"tools.punch.file.face", 3}}},
    {"tool_facet_of_four_corners", {{"tools.punch.file.facet", 9}}},
    {"tool_file_cut_off", {{"tools.punch.file.cut_off", 3}}},
    {"tool_file_garbage", {{"tools.punch.file.format", 1}}},
    {"tool_file_missing", {{"tools.punch.file.file", 6}, {"tools.punch.length_unit.required", 6}}},
    {"tool_file_of_another_kind", {{"tools.punch.file.type", 6}}},
    {"tool_file_of_no_bytes", {{"tools.punch.file.empty", 6}}},
    {"tool_free_form", {{"tools.punch.file.free_form", 2}}},
    {"tool_sheet_upside_down", {{"tools.punch.sheet.side", 0}}},
    {"tool_inside_out", {{"tools.punch.outward", 0}}},
    {"texgen_deck", {{"cell.tow.stable", 7}, {"cell.voxels.file.deck", 4}}},
    {"tool_names_a_missing_corner", {{"tools.punch.file.index", 4}}},
    {"tool_not_closed", {{"tools.punch.closed", 0}}},
    {"tool_passage", {{"tools.die.passage", 6}, {"tools.binder.passage", 6}}},
    {"tool_too_thin", {{"tools.punch.thin", 6}}},
    {"tool_touches_itself_in_a_point", {{"tools.punch.vertex_manifold", 0}}},
    {"tool_triangle_twice", {{"tools.punch.repeated", 0}, {"tools.punch.edge_manifold", 0}}},
    {"tool_triangle_without_area", {{"tools.punch.degenerate", 0}}},
    {"tool_turned_triangle", {{"tools.punch.oriented", 0}}},
    {"tool_unit", {{"tools.punch.length_unit.size", 6}}},
    {"tool_voxel_too_fine", {{"tools.punch.voxel.memory", 6}}},
    {"tool_voxel_zero", {{"tools.punch.voxel.range", 6}}},
    {"tool_with_a_fin", {{"tools.punch.closed", 0}, {"tools.punch.edge_manifold", 0}}},
    {"tool_without_triangles", {{"tools.punch.file.no_triangles", 0}}},
    {"tow_too_flat", {{"weave.tow_width.proportion", 3}}},
    {"tow_without_room_for_its_material", {{"weave.tow_thickness.holds_material", 3}}},
    {"trellis_amplitude_too_large", {{"effects.orientation.trellis", 8}}},
    {"two_documents", {{"yaml.documents", 0}}},
    {"unit_in_the_weave_and_blank_beside_the_binder", {{"weave.tow_width.unit", 3}, {"blank.size.reach", 7}}},
    {"unit_on_a_number", {{"resin.power_index.unit", 4}}},
    {"unknown_key", {{"weave.tow_widht.unknown", 3}}},
    {"unknown_pattern", {{"weave.pattern.unknown", 3}}},
    {"value_is_a_map", {{"name.value", 2}}},
    {"voxels_all_void", {{"cell.phases.solid", 6}}},
    {"voxels_beside_a_weave", {{"cell.voxels.alone", 5}}},
    {"voxels_of_another_shape", {{"cell.voxels.file.size", 4}}},
    {"voxels_of_two_axes", {{"cell.voxels.shape.range", 4}, {"cell.voxels.size.range", 4}}},
    {"voxels_without_a_phase", {{"cell.phases.missing", 6}}},
    {"voxels_without_shear", {{"cell.phases.0.void", 7}}},
    {"weave_falls_apart", {{"weave.pattern.falls_apart", 3}}},
    {"weave_matrix_of_words", {{"weave.matrix.bits", 3}}},
    {"weft_far_thinner_than_the_warp", {{"weave.tow_thickness.balance", 3}}},
    {"wrong_unit", {{"resin.film_thickness.unit", 4}}},
    {"zero_plate_area", {{"friction.calibration.plate_area.range", 4}}},
};

/// One line a problem, sorted: a difference then reads well.
std::string listed(std::vector<Place> problems) {
  std::sort(problems.begin(), problems.end());
  std::string text;
  for (const auto& [id, line] : problems) text += id + " in line " + std::to_string(line) + "\n";
  return text;
}

std::string problems_of(const std::string& name) {
  std::vector<Place> found;
  for (const Problem& problem : test::problems_of_bad_file(name)) {
    INFO(problem.id);
    CHECK_FALSE(problem.id.text().empty());
    CHECK_FALSE(problem.rule.empty());
    CHECK_FALSE(problem.way_out.empty());
    CHECK_FALSE(problem.file.empty());
    found.emplace_back(problem.id, problem.line);
  }
  return listed(found);
}

}  // namespace

TEST_CASE("a small bad file breaks its rules at their lines, and no others", "[pipeline][config]") {
  for (const BadFile& bad : bad_files) {
    INFO(bad.name);
    CHECK(problems_of(bad.name) == listed(bad.problems));
  }
}

TEST_CASE("every small bad file stands in the table above", "[pipeline][config]") {
  std::set<std::string> in_table;
  for (const BadFile& bad : bad_files) in_table.insert(bad.name);
  const std::vector<std::string> names = test::bad_file_names();
  const std::set<std::string> present(names.begin(), names.end());
  CHECK(present == in_table);
}

// The words a newcomer meets first. A change of wording is a change of these files, to be read by a person.
TEST_CASE("the commonest mistakes are answered in the words of tests/pipeline/golden", "[pipeline][config]") {
  const std::filesystem::path golden =
      std::filesystem::path(heddle::test::source_dir) / "tests/pipeline/golden";
  int files = 0;
  for (const auto& entry : std::filesystem::directory_iterator(golden)) {
    if (entry.path().extension() != ".yaml") continue;
    ++files;
    const std::string name = entry.path().filename().string();
    INFO(name);
    std::string answer;
    try {
      pipeline::read_case_text(read_text_file(entry.path()), name, golden);
    } catch (const InputError& error) {
      answer = error.what();
    }
    CHECK(answer == read_text_file(std::filesystem::path(entry.path()).replace_extension(".txt")));
  }
  CHECK(files >= 10);
}

TEST_CASE("problems of one key name the place, the value, the rule and the way out", "[pipeline][config]") {
  try {
    pipeline::read_case_text(
        "heddle: 1\nname: x\nweave: {patern: plain, tow_width: 4.64 mm, gap: 0.75 m,\n  tow_thickness: "
        "0.75 mm, fabric_thickness: 1.5 mm, linear_density: 1872 tex, fibre_mass_fraction: 60 "
        "%}\n",
        "x.yaml", "");
    FAIL("no problem found");
  } catch (const InputError& error) {
    CHECK(std::string(error.what()) ==
          "x.yaml: 2 problem(s)\n"
          "  weave.patern (line 3) = plain   is not a known key\n"
          "    The nearest known key is weave.pattern.\n"
          "  weave.gap (line 3) = 0.75 m   must satisfy 0 mm <= gap < 100 mm\n"
          "    Clear distance between neighbouring tows (Table 1: 0.75 mm).\n");
  }
}
