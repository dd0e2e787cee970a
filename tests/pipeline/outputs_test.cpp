#include "pipeline/outputs.h"

#include <unistd.h>

#include <catch2/catch.hpp>
#include <cmath>
#include <cstring>
#include <filesystem>
#include <limits>
#include <nlohmann/json.hpp>
#include <sstream>

#include "sample_run.h"

using namespace heddle;
using namespace heddle::pipeline;
using Catch::Matchers::Contains;
namespace fs = std::filesystem;

namespace {

std::vector<std::string> split(const std::string& text, char separator) {
  std::vector<std::string> parts;
  std::stringstream stream(text);
  for (std::string part; std::getline(stream, part, separator);) parts.push_back(part);
  return parts;
}

bool same_bits(double a, double b) {
  return std::memcmp(&a, &b, sizeof a) == 0;
}
bool same_bits(const std::vector<double>& a, const std::vector<double>& b) {
  return a.size() == b.size() &&
         (a.empty() || std::memcmp(a.data(), b.data(), a.size() * sizeof(double)) == 0);
}
bool same_bits(const Curve& a, const Curve& b) {
  return same_bits(a.x(), b.x()) && same_bits(a.y(), b.y());
}
bool same_bits(const CurveFamily& a, const CurveFamily& b) {
  if (!same_bits(a.parameter(), b.parameter()) || a.curves().size() != b.curves().size()) return false;
  for (std::size_t i = 0; i < a.curves().size(); ++i) {
    if (!same_bits(a.curves()[i], b.curves()[i])) return false;
  }
  return true;
}
bool same_bits(const Surface& a, const Surface& b) {
  return same_bits(a.x0(), b.x0()) && same_bits(a.dx(), b.dx()) && a.nx() == b.nx() &&
         same_bits(a.y0(), b.y0()) && same_bits(a.dy(), b.dy()) && a.ny() == b.ny() &&
         same_bits(a.values(), b.values());
}

bool same_bits(const mesoscale::FabricProperties& a, const mesoscale::FabricProperties& b) {
  return same_bits(a.areal_density, b.areal_density) && same_bits(a.pitch[0], b.pitch[0]) &&
         same_bits(a.pitch[1], b.pitch[1]) && same_bits(a.thickness, b.thickness) &&
         same_bits(a.tension_energy, b.tension_energy) && same_bits(a.shear_stress, b.shear_stress) &&
         same_bits(a.shear_rate.consistency, b.shear_rate.consistency) &&
         same_bits(a.shear_rate.index, b.shear_rate.index) &&
         same_bits(a.shear_rate.activation_temperature, b.shear_rate.activation_temperature) &&
         same_bits(a.shear_rate.reference_temperature, b.shear_rate.reference_temperature) &&
         same_bits(a.bending[0], b.bending[0]) && same_bits(a.bending[1], b.bending[1]) &&
         same_bits(a.compaction, b.compaction) && same_bits(a.contact.log_fraction, b.contact.log_fraction) &&
         a.provenance.specification == b.provenance.specification &&
         a.provenance.unverified == b.provenance.unverified &&
         same_bits(a.provenance.grid_error, b.provenance.grid_error);
}

/// A folder of this process's own, removed at the end: several tests may run at once.
struct Folder {
  fs::path path = fs::temp_directory_path() / ("heddle_outputs_test_" + std::to_string(::getpid()));
  Folder() { fs::remove_all(path); }
  ~Folder() { fs::remove_all(path); }
};

Problems problems_of(const std::string& text) {
  try {
    read_fabric_json(text, "fabric.json");
  } catch (const InputError& error) {
    return error.problems();
  }
  return {};
}

std::string replaced(std::string text, const std::string& from, const std::string& to) {
  const std::size_t at = text.find(from);
  REQUIRE(at != std::string::npos);
  return text.replace(at, from.size(), to);
}

}  // namespace

TEST_CASE("the history table has the columns other programs rely on", "[outputs]") {
  const std::string csv = history_csv(sample::history(3));
  const std::vector<std::string> lines = split(csv, '\n');
  REQUIRE(lines.size() == 4);
  const std::vector<std::string> names = {
      "time_s", "punch_displacement_mm", "punch_force_N", "die_force_N", "binder_force_N", "draw_in_max_mm",
      "shear_angle_max_deg", "tow_strain_max", "newton_iterations", "lag_iterations",
      // The ledger.
      "work_punch_J", "work_binder_J", "work_gravity_J", "energy_tow_J", "energy_shear_J", "energy_bending_J",
      "energy_twist_J", "energy_compaction_J", "energy_kinetic_J", "energy_press_J", "friction_punch_J",
      "friction_die_J", "friction_binder_J", "friction_plies_J", "dissipation_shear_rate_J",
      "dissipation_shear_hysteresis_J", "dissipation_tow_rate_J", "dissipation_artefact_J",
      "dissipation_numerical_J", "ledger_residual_J",
      // Not of the ledger.
      "force_balance_N", "folded_nodes", "near_nodes", "self_crossings",
      "friction_work_outside_calibration_J", "punch_deflection_mm", "binder_tilt_deg"};
  CHECK(split(lines[0], ',') == names);
  for (const std::string& line : lines) CHECK(split(line, ',').size() == names.size());
}

TEST_CASE("every history column holds its own quantity in its own unit", "[outputs]") {
  using Row = macroscale::HistoryRow;
  constexpr double Row::*in_joule_and_newton[] = {&Row::work_punch,
                                                  &Row::work_binder,
                                                  &Row::work_gravity,
                                                  &Row::energy_tow,
                                                  &Row::energy_shear,
                                                  &Row::energy_bending,
                                                  &Row::energy_twist,
                                                  &Row::energy_compaction,
                                                  &Row::energy_kinetic,
                                                  &Row::energy_press,
                                                  &Row::friction_punch,
                                                  &Row::friction_die,
                                                  &Row::friction_binder,
                                                  &Row::friction_plies,
                                                  &Row::dissipation_shear_rate,
                                                  &Row::dissipation_shear_hysteresis,
                                                  &Row::dissipation_tow_rate,
                                                  &Row::dissipation_artefact,
                                                  &Row::dissipation_numerical,
                                                  &Row::ledger_residual,
                                                  &Row::force_balance};
  Row row;
  row.time = 0.43, row.punch_displacement = 0.0625, row.punch_force = 103, row.die_force = 104;
  row.binder_force = 105;
  row.draw_in_max = 0.0078125, row.shear_angle_max = std::acos(-1.0) / 6.0, row.tow_strain_max = 8e-4;
  row.newton_iterations = 109, row.lag_iterations = 110;
  std::size_t column = 10;
  for (double Row::*member : in_joule_and_newton) row.*member = static_cast<double>(101 + column++);
  for (int Row::*member : {&Row::folded_nodes, &Row::near_nodes, &Row::self_crossings})
    row.*member = static_cast<int>(101 + column++);
  row.friction_work_outside = static_cast<double>(101 + column++);
  row.punch_deflection = 1e-3 * static_cast<double>(101 + column++);
  row.binder_tilt = std::acos(-1.0) / 180.0 * static_cast<double>(101 + column++);
  const std::vector<std::string> cells = split(split(history_csv(std::vector{row}), '\n')[1], ',');
  REQUIRE(cells.size() == column);
  CHECK(cells[0] == "0.43");
  CHECK(cells[1] == "62.5");
  CHECK(cells[5] == "7.8125");
  CHECK(std::stod(cells[6]) == Approx(30.0).epsilon(1e-15));
  CHECK(cells[7] == "0.0008");
  for (std::size_t c : {2, 3, 4}) CHECK(cells[c] == std::to_string(101 + c));
  for (std::size_t c = 8; c < cells.size(); ++c) CHECK(cells[c] == std::to_string(101 + c));
}

TEST_CASE("a value that is not finite is named and not written", "[outputs]") {
  auto rows = sample::history(3);
  rows[1].energy_shear = std::numeric_limits<double>::quiet_NaN();
  CHECK_THROWS_WITH(history_csv(rows), Contains("energy_shear_J in row 2"));
  auto fabric = sample::fabric();
  fabric.shear_rate.index = std::numeric_limits<double>::infinity();
  CHECK_THROWS_WITH(fabric_json(fabric), Contains("shear_rate.index is inf"));
}

TEST_CASE("friction tests without a measurement leave its cells empty", "[outputs]") {
  const std::vector<std::string> lines = split(friction_test_csv(sample::friction_test()), '\n');
  CHECK(lines[0] ==
        "case,velocity_mm_s,normal_force_N,tool_temperature_C,fabric_temperature_C,orientation_deg,"
        "friction_coefficient,pull_force_N,measured_force_N,paper_force_N,error,paper_error");
  CHECK_THAT(lines[1], Catch::StartsWith("baseline,16.67,1500,85,180,0,0.2795,838.5,843,804,"));
  CHECK_THAT(lines[3], Catch::StartsWith("\"normal force, doubled\","));
  CHECK_THAT(lines[4], Catch::EndsWith(",1546,,,,"));
  CHECK(std::stod(split(lines[1], ',')[10]) == Approx(838.5 / 843.0 - 1.0));
  CHECK(std::stod(split(lines[1], ',')[11]) == Approx(804.0 / 843.0 - 1.0));
}

TEST_CASE("what a pull of the rig has not got leaves its cells empty", "[outputs]") {
  const auto rows = sample::friction_rig();
  const std::vector<std::string> lines = split(friction_rig_csv(rows), '\n');
  CHECK(lines[0] ==
        "case,plates,velocity_mm_s,normal_force_N,tool_temperature_C,fabric_temperature_C,orientation_deg,"
        "law_force_N,"
        "peak_force_N,peak_displacement_mm,steady_force_N,friction_coefficient,normal_force_loss,film_"
        "temperature_C,"
        "finite_element_force_N,measured_force_N,paper_force_N");
  CHECK_THAT(lines[1],
             Catch::StartsWith("speed 0,flat,16.67,1500,85,180,0,838.5,,,") && Catch::EndsWith(",843,"));
  CHECK_THAT(lines.at(rows.size()), Catch::StartsWith("S-curve plates,s_curve,"));
  CHECK(split(lines[1], ',')[10] == shortest(0.95 * 838.5));
  const auto history = split(friction_history_csv(sample::friction_history()), '\n');
  CHECK(history[0] ==
        "case,time_s,displacement_mm,pull_force_N,normal_force_N,friction_coefficient,film_temperature_C");
  CHECK_THAT(history[1], Catch::StartsWith("speed 0,0,0,0,1500,0,"));
  REQUIRE(history.size() >= 52);
}

TEST_CASE("the contact table holds the law at each pressure and angle", "[outputs]") {
  const auto contact = sample::fabric().contact;
  const std::vector<double> pressures{1e3, 1e4}, angles{0.0, 0.3};
  const std::vector<std::string> lines = split(contact_csv(contact, pressures, angles), '\n');
  REQUIRE(lines.size() == 5);
  CHECK(lines[0] == "shear_angle_deg,pressure_Pa,contact_area_fraction,slope_1_Pa");
  const std::vector<std::string> last = split(lines[4], ',');
  CHECK(std::stod(last[1]) == 1e4);
  CHECK(same_bits(std::stod(last[2]), contact.evaluate(1e4, 0.3).fraction));
  CHECK(same_bits(std::stod(last[3]), contact.evaluate(1e4, 0.3).slope));
}

TEST_CASE("the friction curve table carries temperature in degrees Celsius and speed in millimetres",
          "[outputs]") {
  const std::vector<FrictionCurveRow> rows{{358.15, 453.15, 25e3, 0.0625, 120.0, 1e-3, 0.3}};
  CHECK(
      curve_csv(rows) ==
      "tool_temperature_C,fabric_temperature_C,pressure_Pa,slip_speed_mm_s,film_viscosity_Pa_s,hersey_number,"
      "friction_coefficient\n85,180,25000,62.5,120,0.001,0.3\n");
}

TEST_CASE("fabric properties come back from their file bit for bit", "[outputs]") {
  const auto fabric = sample::fabric();
  const auto back = read_fabric_json(fabric_json(fabric), "fabric.json");
  CHECK(same_bits(fabric, back));
  CHECK(fabric_json(back) == fabric_json(fabric));
  // The derived spline is the same too, since it is made from the same numbers.
  CHECK(same_bits(fabric.tension_energy.evaluate(0.001, 0.002).fxy,
                  back.tension_energy.evaluate(0.001, 0.002).fxy));

  auto more = fabric;  // tables that only some fabrics have
  more.contact.drag = {fabric.contact.log_fraction, fabric.compaction};
  more.facing = {1.2e-3 / 3.0, fabric.compaction.curves().front()};
  const auto again = read_fabric_json(fabric_json(more), "fabric.json");
  CHECK(same_bits(again.contact.drag.cosine, more.contact.drag.cosine));
  CHECK(same_bits(again.contact.drag.sine, more.contact.drag.sine));
  CHECK(same_bits(again.facing.rest, more.facing.rest));
  CHECK(same_bits(again.facing.compaction, more.facing.compaction));
  CHECK(back.contact.drag.empty());
  CHECK(back.facing.empty());

  auto nudged = fabric;  // the comparison can fail, in one bit of one number
  nudged.pitch[1] = std::nextafter(nudged.pitch[1], 1.0);
  CHECK_FALSE(same_bits(nudged, back));
}

TEST_CASE("odd numbers survive the fabric file: minus zero, tiny, huge and whole", "[outputs]") {
  for (const double value : {-0.0, 5e-324, 1.7976931348623157e308, 1.0, 1e21, 123456789012345680.0, 0.1}) {
    auto fabric = sample::fabric();
    fabric.thickness = value;
    CAPTURE(value);
    CHECK(same_bits(read_fabric_json(fabric_json(fabric), "fabric.json").thickness, value));
  }
}

TEST_CASE("fabric properties that are not filled in come back not filled in", "[outputs]") {
  const mesoscale::FabricProperties empty;
  const auto back = read_fabric_json(fabric_json(empty), "fabric.json");
  CHECK(same_bits(empty.areal_density, back.areal_density));
  CHECK(back.tension_energy.empty());
  CHECK(back.shear_stress.empty());
  CHECK(back.compaction.empty());
}

TEST_CASE("a damaged fabric file is refused with every fault named", "[outputs]") {
  const std::string good = fabric_json(sample::fabric());
  CHECK(problems_of(good).empty());

  std::string bad = replaced(good, "\"thickness_m\"", "\"thikness_m\"");
  bad = replaced(bad, "\"grid_error\": 0.0123", "\"grid_error\": \"small\"");
  const Problems found = problems_of(bad);
  REQUIRE(found.size() == 3);
  CHECK(found[0].key == "thickness_m");
  CHECK(found[0].rule == "is missing");
  CHECK(found[0].id == "fabric.json.thickness_m.missing");
  CHECK(found[1].key == "provenance.grid_error");
  CHECK(found[1].rule == "must be a number");
  CHECK(found[1].id == "fabric.json.provenance.grid_error.type");
  CHECK(found[2].key == "thikness_m");
  CHECK(found[2].file == "fabric.json");
  CHECK(found[2].id == "fabric.json.thikness_m.unknown");

  const Problems turned = problems_of(
      replaced(good, "\"temperature_K\": [293.15, 453.15]", "\"temperature_K\": [453.15, 293.15]"));
  REQUIRE(turned.size() == 1);
  CHECK(turned[0].key == "bending.warp");
  CHECK(turned[0].id == "fabric.json.bending.warp.table");

  REQUIRE(problems_of(good.substr(0, good.size() / 2)).size() == 1);
  CHECK_THAT(problems_of(good.substr(0, good.size() / 2))[0].rule, Contains("must be JSON"));
  CHECK(problems_of(good.substr(0, good.size() / 2))[0].id == "fabric.json.syntax");
  CHECK_FALSE(problems_of("[]").empty());
  CHECK_FALSE(problems_of("{\"thickness_m\": 1e999}").empty());
}

TEST_CASE("the summary has the agreed keys and leaves out what was not computed", "[outputs]") {
  SummaryRecord record;
  CHECK(summary_json(record) == "{}\n");
  record.cell = sample::cell();
  record.stamping = sample::stamping();
  record.contact_area_fraction_binder = 0.12;
  const auto json = nlohmann::json::parse(summary_json(record));
  for (const char* key :
       {"areal_density_kg_m2", "crimp_warp", "crimp_weft", "gap_closure_angle_deg", "locking_angle_deg",
        "tow_fibre_volume_fraction", "contact_area_fraction", "contact_area_fraction_binder"}) {
    CHECK(json["mesoscale"].contains(key));
  }
  for (const char* key : {"peak_punch_force_N", "shear_angle_max_deg", "draw_in_max_mm",
                          "energy_residual_max", "force_balance_residual_max", "steps", "rejected_steps",
                          "newton_iterations", "friction_work_outside_calibration"}) {
    CHECK(json["macroscale"].contains(key));
  }
  CHECK(json["mesoscale"]["contact_area_fraction"] == 0.0816);  // a fraction, not a percentage
  CHECK(json["mesoscale"]["gap_closure_angle_deg"].get<double>() == Approx(30.590).margin(1e-3));
  CHECK(json["macroscale"]["draw_in_max_mm"] == 24.0);
  CHECK(json["macroscale"]["symmetry_gap_shear"] == 2.4e-4);
  CHECK_FALSE(json["macroscale"].contains("failure"));

  record.stamping->symmetry_gap_shear = -1.0;
  record.stamping->failure = "stopped";
  const auto other = nlohmann::json::parse(summary_json(record));
  CHECK_FALSE(other["macroscale"].contains("symmetry_gap_shear"));
  CHECK(other["macroscale"]["failure"] == "stopped");
}

TEST_CASE("the manifest holds versions, hashes, machine and the cost of each stage", "[outputs]") {
  Manifest manifest{"case", {{"heddle", "0.1.0"}}, {{"resolved.yaml", "3f2a"}}, {{"cores", "2"}}, {}};
  manifest.stages = {{"mesoscale", 1.5, 1.25, 64e6, true}};
  const auto json = nlohmann::json::parse(manifest_json(manifest));
  CHECK(json["versions"]["heddle"] == "0.1.0");
  CHECK(json["stages"]["mesoscale"]["wall_s"] == 1.5);
  CHECK(json["stages"]["mesoscale"]["peak_memory_MB"].get<double>() == Approx(64.0));
  CHECK(json["stages"]["mesoscale"]["reused"] == true);
}

TEST_CASE("tows are written as binary STL in millimetres with outward normals", "[outputs]") {
  TriangleMesh mesh{{{0, 0, 0}, {1e-3, 0, 0}, {0, 2e-3, 0}}, {{0, 1, 2}}};
  const std::string stl = tows_stl(mesh);
  REQUIRE(stl.size() == 80 + 4 + 50);
  CHECK(stl.substr(0, 5) != "solid");  // readers take that for the text form
  std::uint32_t count = 0;
  std::memcpy(&count, stl.data() + 80, 4);
  CHECK(count == 1);
  float numbers[12];
  std::memcpy(numbers, stl.data() + 84, sizeof numbers);
  CHECK(numbers[2] == 1.0f);
  CHECK(numbers[6] == 1.0f);
  CHECK(numbers[10] == 2.0f);
  mesh.vertices[1][0] = NAN;
  CHECK_THROWS_WITH(tows_stl(mesh), Catch::Contains("triangle 0 has a corner at nan"));
}

TEST_CASE("a file is whole or not there, and its folder is made", "[outputs]") {
  const Folder folder;
  const fs::path path = folder.path / "a" / "b" / "table.csv";
  write_file(path, "first\n");
  write_file(path, std::string("second\0\n", 8));
  CHECK(read_file(path) == std::string("second\0\n", 8));
  CHECK(std::distance(fs::directory_iterator(path.parent_path()), fs::directory_iterator()) ==
        1);  // no leftovers
}

TEST_CASE("a file that cannot be written says which and why, and leaves nothing behind", "[outputs]") {
  const Folder folder;
  write_file(folder.path / "file", "text");
  CHECK_THROWS_AS(write_file(folder.path / "file" / "table.csv", "x"), OutputError);
  fs::create_directories(folder.path / "taken" / "full");
  CHECK_THROWS_WITH(write_file(folder.path / "taken", "x"),
                    Contains("taken") && Contains("cannot put it in place"));
  CHECK_FALSE(fs::exists(folder.path / "taken.part"));
  CHECK_THROWS_WITH(read_file(folder.path / "absent.csv"),
                    Contains("absent.csv") && Contains("No such file"));
  if (fs::exists("/dev/full")) {
    // A device that is always full stands for a disk that is: the bytes fit the buffer and fail when it is
    // emptied.
    fs::create_symlink("/dev/full", folder.path / "disk.csv.part");
    CHECK_THROWS_WITH(write_file(folder.path / "disk.csv", "x"), Contains("No space left"));
    CHECK_FALSE(fs::exists(folder.path / "disk.csv"));
  }
}
