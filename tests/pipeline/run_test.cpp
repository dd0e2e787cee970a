// Whole runs: every shipped configuration at small size, through the same functions as the command line.
#include <algorithm>
#include <catch2/catch.hpp>

#include <cmath>
#include <filesystem>
#include <fstream>
#include <map>
#include <sstream>

#include "core/problem.h"
#include "pipeline/commands.h"
#include "pipeline/outputs.h"
#include "pipeline/stages.h"
#include "scratch.h"
#include "tests/source_dir.h"

using namespace heddle;
using namespace heddle::test;
namespace fs = std::filesystem;

namespace {

const std::vector<std::string> small = {"blank.spacing=20 mm", "process.steps=12",
                                        "process.punch={stroke: 30 mm, time: 0.18 s, slow_down: 0.01 s}",
                                        "blank.grid_error=off", tools_by_shape};

pipeline::RunOptions options_for(const std::string& config, const fs::path& output,
                                 std::vector<std::string> settings) {
  pipeline::RunOptions options;
  options.file = fs::path(source_dir) / "configs" / config;
  options.output = output;
  options.assignments = std::move(settings);
  options.quiet = true;
  return options;
}

// One number of summary.json, by its key.
double number(const fs::path& folder, const std::string& key) {
  const std::string text = pipeline::read_file(folder / "summary.json");
  const auto at = text.find('"' + key + "\": ");
  REQUIRE(at != std::string::npos);
  return std::stod(text.substr(at + key.size() + 4));
}

// A stamping of its own; the unit cell of the shipped weave, which takes longer than a small stamping, may
// come out of a cache.
double stamped(const Scratch& scratch, const std::string& name, const std::vector<std::string>& settings,
               const std::string& key) {
  auto options = options_for("thermostamping.yaml", scratch / name, settings);
  options.cache = scratch / (name + "-cache");
  warm(options.cache);
  REQUIRE(pipeline::run_case(options) == pipeline::exit_done);
  return number(scratch / name, key);
}

}  // namespace

TEST_CASE("the shipped stamping runs small, writes what it promises, and twice the same bytes",
          "[pipeline][run]") {
  const Scratch scratch;
  for (const char* name : {"a", "b"})
    REQUIRE(pipeline::run_case(options_for("thermostamping.yaml", scratch / name, small)) ==
            pipeline::exit_done);
  const auto a = contents(scratch / "a"), b = contents(scratch / "b");
  for (const char* name :
       {"resolved.yaml", "summary.json", "report.html", "mesoscale/fabric.json", "mesoscale/contact.csv",
        "mesoscale/tows.stl", "mesoscale/tows.vtu", "mesoscale/cell.vti", "mesoscale/cell.h5",
        "friction/friction_test.csv", "friction/curve.csv", "macroscale/history.csv", "macroscale/blank.pvd",
        "macroscale/blank_0012.vtu"})
    CHECK(a.count(name) == 1);
  REQUIRE(a.size() == b.size());
  for (const auto& [name, bytes] : a) {
    INFO(name);
    CHECK((bytes == b.at(name)));
  }
  CHECK(fs::exists(scratch / "a" / "manifest.json"));
  CHECK(fs::exists(scratch / "a" / "log.txt"));
  CHECK(number(scratch / "a", "energy_residual_max") < 0.01);
  CHECK(number(scratch / "a", "force_balance_residual_max") < 1e-3);

  // What was resolved is a configuration of its own, with the same outcome.
  pipeline::RunOptions again = options_for("", scratch / "c", {});
  again.file = scratch / "a" / "resolved.yaml";
  REQUIRE(pipeline::run_case(again) == pipeline::exit_done);
  CHECK((pipeline::read_file(scratch / "c" / "macroscale/history.csv") == a.at("macroscale/history.csv")));
}

namespace {

std::vector<std::vector<std::string>> cells_of(const fs::path& file) {
  std::vector<std::vector<std::string>> rows;
  std::istringstream lines(pipeline::read_file(file));
  for (std::string line; std::getline(lines, line);) {
    rows.emplace_back();
    std::istringstream cells(line);
    for (std::string cell; std::getline(cells, cell, ',');) rows.back().push_back(cell);
  }
  return rows;
}

/// Histories stand beside the test, and their steady forces are those of the law.
void check_rig(const fs::path& folder) {
  const auto test = cells_of(folder / "friction/friction_test.csv"),
             rig = cells_of(folder / "friction/friction_rig.csv"),
             history = cells_of(folder / "friction/friction_history.csv");
  CHECK(history.front() == std::vector<std::string>{"case", "time_s", "displacement_mm", "pull_force_N",
                                                    "normal_force_N", "friction_coefficient",
                                                    "film_temperature_C"});
  REQUIRE(rig.size() == test.size() + 1);  // and the S-curve plates
  CHECK(rig.back()[0] == "S-curve plates");
  CHECK(rig.back()[1] == "s_curve");
  for (std::size_t k = 1; k < test.size(); ++k) {
    CAPTURE(rig[k][0]);
    CHECK(std::stod(rig[k][7]) == std::stod(test[k][7]));                         // law
    CHECK(std::stod(rig[k][10]) == Approx(std::stod(test[k][7])).epsilon(1e-3));  // machine
  }
  CHECK(std::stod(rig.back()[7]) == Approx(std::stod(rig[5][7])).epsilon(0.02));  // "relatively no effect"
  // At rest under load first, then up to the pull's length.
  CHECK(history[1][0] == "baseline");
  CHECK(std::stod(history[5][1]) > 0.0);
  CHECK(std::stod(history[5][3]) == 0.0);
  CHECK(std::stod(history.back()[2]) == Approx(50.0).epsilon(0.03));
}

}  // namespace

TEST_CASE("the shipped friction test and unit cell run", "[pipeline][run][long]") {
  const Scratch scratch;
  // Its finite elements are tested where they live; here one pull of each kind is enough.
  const auto friction =
      options_for("friction_test.yaml", scratch / "friction",
                  {"friction_test.rig.finite_elements=off", "friction_test.rig.dwell=0.1 s"});
  REQUIRE(pipeline::friction_case(friction) == pipeline::exit_done);
  check_rig(scratch / "friction");
  CHECK(pipeline::weave_case(options_for("unit_cell.yaml", scratch / "weave", {})) == pipeline::exit_done);
  CHECK(number(scratch / "weave", "areal_density_kg_m2") == Approx(0.703).epsilon(0.005));
  CHECK_FALSE(fs::exists(scratch / "weave" / "friction"));
}

TEST_CASE("a folder that holds another case is left alone without --force", "[pipeline][run][wrong input]") {
  const Scratch scratch;
  auto unit_cell = options_for("unit_cell.yaml", scratch / "x", {});
  unit_cell.cache = HEDDLE_TEST_CACHE;
  REQUIRE(pipeline::weave_case(unit_cell) == pipeline::exit_done);
  const auto before = contents(scratch / "x");
  auto other =
      options_for("friction_test.yaml", scratch / "x", {"friction_test={data: data/friction_table4.csv}"});
  CHECK_THROWS_WITH(pipeline::friction_case(other),
                    Catch::Contains("holds another case: unit_cell") && Catch::Contains("--force"));
  CHECK((contents(scratch / "x") == before));
  CHECK(pipeline::weave_case(unit_cell) == pipeline::exit_done);  // the same case goes in again
  other.force = true;
  CHECK(pipeline::friction_case(other) == pipeline::exit_done);

  std::ofstream(scratch / "letter.txt") << "mine";
  fs::create_directories(scratch / "home");
  std::ofstream(scratch / "home" / "letter.txt") << "mine";
  CHECK_THROWS_WITH(pipeline::weave_case(options_for("unit_cell.yaml", scratch / "home", {})),
                    Catch::Contains("not a run of heddle"));
}

TEST_CASE("what only a command can break is refused under its rule", "[pipeline][run][wrong input]") {
  const Scratch scratch;
  const auto rule_broken_by = [](const auto& command) -> std::string {
    try {
      command();
    } catch (const InputError& error) {
      return error.problems().front().id;
    }
    return "";
  };
  const auto weave_into = [&](const fs::path& folder) {
    return rule_broken_by([&] { pipeline::weave_case(options_for("unit_cell.yaml", folder, {})); });
  };
  std::ofstream(scratch / "letter.txt") << "mine";
  fs::create_directories(scratch / "home");
  std::ofstream(scratch / "home" / "letter.txt") << "mine";
  fs::create_directories(scratch / "stamped" / "macroscale");
  std::ofstream(scratch / "stamped" / "resolved.yaml") << "heddle: 1\nname: unit_cell\n";
  CHECK(weave_into(scratch / "letter.txt") == "output.folder.file");
  CHECK(weave_into(scratch / "letter.txt" / "below") == "output.folder.create");
  CHECK(weave_into(scratch / "home") == "output.folder.other");
  CHECK(weave_into(scratch / "stamped") == "output.folder.stamped");
  CHECK(rule_broken_by([&] { pipeline::friction_case(options_for("unit_cell.yaml", scratch / "x", {})); }) ==
        "case.part");
  // A configuration with real contact pressure has a cell; one put together by hand may have none.
  pipeline::Case by_hand = pipeline::read_case(fs::path(source_dir) / "configs/friction_test.yaml");
  by_hand.cell.reset();
  by_hand.friction->contact_pressure = macroscale::ContactPressure::real;
  CHECK(rule_broken_by([&] { pipeline::run_friction_stage(by_hand, nullptr); }) ==
        "friction.contact_pressure.weave");
}

TEST_CASE("an effect at its off value restores the baseline byte for byte, and acts linearly when small",
          "[pipeline][run][effect][long]") {
  const Scratch scratch;
  const auto base = with(small, "process.tool_temperature=140 degC");
  const auto history = [&](const std::string& name, const std::string& effects) {
    stamped(scratch, name, with(base, effects), "peak_punch_force_N");
    return pipeline::read_file(scratch / name / "macroscale/history.csv");
  };
  const std::string off = history("absent", "effects={}");
  CHECK((history("off", "effects={tool_temperature_shift: {slope: 0 1/K, reference: 85 degC}}") == off));
  CHECK((history("written", "effects={tool_temperature_shift: off, static_peak: off}") == off));

  const auto work = [&](const std::string& name, const std::string& slope) {
    stamped(scratch, name,
            with(base, "effects={tool_temperature_shift: {slope: " + slope + " 1/K, reference: 85 degC}}"),
            "peak_punch_force_N");
    return number(scratch / name, "peak_punch_force_N");
  };
  const double none = number(scratch / "absent", "peak_punch_force_N");
  const double once = work("once", "-1e-6") - none, twice = work("twice", "-2e-6") - none;
  CAPTURE(none, once, twice);
  CHECK(once != 0.0);
  CHECK(twice == Approx(2.0 * once).epsilon(0.01));
}

TEST_CASE("the weave acts on friction: a wider gap lowers the contact area, mu and the punch force",
          "[pipeline][run][long]") {
  const Scratch scratch;
  // To the full stroke: early on the punch force is mostly tow straightening, which a wider gap changes as
  // well.
  const std::vector<std::string> deep = {"blank.spacing=16 mm", "process.steps=35", "blank.grid_error=off",
                                         tools_by_shape};
  const double narrow = stamped(scratch, "narrow", deep, "peak_punch_force_N");
  const double wide = stamped(scratch, "wide", with(deep, "weave.gap=1.5 mm"), "peak_punch_force_N");
  CHECK(number(scratch / "wide", "contact_area_fraction_binder") <
        0.95 * number(scratch / "narrow", "contact_area_fraction_binder"));
  CHECK(wide < 0.99 * narrow);

  // Friction test at binder pressure (8.6 kPa on the plate of the rig): mu follows the area, and with nominal
  // pressure it does not move.
  const auto mu = [&](const std::string& name, const std::string& gap, const std::string& pressure) {
    const auto options = options_for(
        "friction_test.yaml", scratch / name,
        {"weave.gap=" + gap, "friction.contact_pressure=" + pressure,
         "friction.calibration={plate_area: 0.01 m^2}", "friction.scale=0.33", "friction.exponent=0.135",
         "effects={}", "friction_test={data: data/friction_binder_pressure.csv}"});
    REQUIRE(pipeline::friction_case(options) == pipeline::exit_done);
    std::stringstream table(pipeline::read_file(scratch / name / "friction/friction_test.csv"));
    std::string header, row, cell;
    std::getline(table, header);
    std::getline(table, row);
    std::stringstream cells(row);
    for (int k = 0; k < 7; ++k) std::getline(cells, cell, ',');
    return std::stod(cell);
  };
  CHECK(mu("r1", "1.5 mm", "real") < 0.99 * mu("r0", "0.75 mm", "real"));
  CHECK(mu("n1", "1.5 mm", "nominal") == mu("n0", "0.75 mm", "nominal"));
}

TEST_CASE(
    "at full size: constant mu without resin rate is blind to punch speed, mass scaling is not, resin rate "
    "is",
    "[pipeline][run][slow]") {
  const Scratch scratch;
  const std::vector<std::string> coulomb = {"friction={law: coulomb, coefficient: 0.3}", tools_by_shape};
  const auto peak = [&](const std::string& name, const std::string& rate, const std::string& speed,
                        const std::string& mass) {
    return stamped(
        scratch, name,
        with(with(with(coulomb, "fabric.shear_rate=" + rate), "process.punch.speed_scale=" + speed),
             "artefact.mass_scaling=" + mass),
        "peak_punch_force_N");
  };
  const double base = peak("v1", "off", "1", "1");
  CHECK(peak("v05", "off", "0.5", "1") == Approx(base).epsilon(0.002));
  CHECK(peak("v2", "off", "2", "1") == Approx(base).epsilon(0.002));
  CHECK(std::abs(peak("v2m", "off", "2", "1000") / base - 1.0) > 0.1);
  const double slow = peak("r05", "on", "0.5", "1"), middle = peak("r1", "on", "1", "1"),
               fast = peak("r2", "on", "2", "1");
  const double signature = (fast - middle) / (middle - slow);
  CAPTURE(slow, middle, fast);
  CHECK(signature > 1.0);
  CHECK(signature < 2.5);
}

TEST_CASE("a stamping says what its grid leaves, runs the companion once, and is the same without it",
          "[pipeline][run][grid_error][long]") {
  const Scratch scratch;
  const std::vector<std::string> fine = {"blank.spacing=16 mm", "process.steps=8",
                                         "process.punch={stroke: 30 mm, time: 0.18 s}", tools_by_shape};
  auto options = options_for("thermostamping.yaml", scratch / "on", fine);
  options.cache = scratch / "cache";
  warm(options.cache);
  REQUIRE(pipeline::run_case(options) == pipeline::exit_done);
  const fs::path macroscale = scratch / "on" / "macroscale";
  // First order: what is left is the change to the companion over (32 mm / 16 mm - 1); the change at the peak
  // is no larger than the largest over the stroke.
  const double peak = number(scratch / "on", "peak_punch_force_N"),
               companion = number(scratch / "on", "companion_peak_punch_force_N");
  const std::string summary = pipeline::read_file(scratch / "on" / "summary.json");
  const double error = std::stod(summary.substr(summary.find("\"punch_force_N\": ") + 17));
  CHECK(error > 0.0);
  CHECK(error >= Approx(std::abs(peak - companion)));
  CHECK(summary.find("\"companion_nodes\": 121") != std::string::npos);
  CHECK_THAT(pipeline::read_file(scratch / "on" / "report.html"), Catch::Contains("estimated grid error"));

  // From the cache, and from the folder where there is no cache: the same bytes, and nothing is run.
  const auto before = contents(scratch / "on");
  auto again = options;
  again.output = scratch / "again";
  REQUIRE(pipeline::run_case(again) == pipeline::exit_done);
  CHECK((contents(scratch / "again") == before));
  CHECK_THAT(pipeline::read_file(scratch / "again" / "manifest.json"), !Catch::Contains("\"reused\": false"));
  auto resumed = options;
  resumed.cache.clear();
  resumed.resume = true;
  fs::remove(scratch / "on" / "report.html");
  REQUIRE(pipeline::run_case(resumed) == pipeline::exit_done);
  CHECK((contents(scratch / "on") == before));

  // The stamping knows nothing of it.
  auto off = options_for("thermostamping.yaml", scratch / "off", with(fine, "blank.grid_error=off"));
  off.cache = scratch / "cache";
  REQUIRE(pipeline::run_case(off) == pipeline::exit_done);
  CHECK(pipeline::read_file(scratch / "off/macroscale/history.csv") ==
        pipeline::read_file(macroscale / "history.csv"));
  CHECK(pipeline::read_file(scratch / "off/summary.json").find("grid_error") == std::string::npos);
}

TEST_CASE("a blank drawn as DXF stamps as the same blank written as a circle with a hole",
          "[pipeline][run][tools][long]") {
  const Scratch scratch;
  std::ofstream(scratch / "blank.dxf") << "  0\nSECTION\n  2\nHEADER\n  9\n$INSUNITS\n 70\n4\n  0\nENDSEC\n"
                                          "  0\nSECTION\n  2\nENTITIES\n"
                                          "  0\nCIRCLE\n 10\n0\n 20\n0\n 40\n150\n"
                                          "  0\nCIRCLE\n 10\n0\n 20\n125\n 40\n10\n"
                                          "  0\nENDSEC\n  0\nEOF\n";
  const std::string orientation = ", orientation: 0 deg, spacing: 20 mm, grid_error: off}";
  const double circle = stamped(
      scratch, "circle",
      with(small, "blank={shape: circle, radius: 150 mm, holes: [[0 mm, 125 mm, 10 mm]]" + orientation),
      "peak_punch_force_N");
  const double drawn =
      stamped(scratch, "drawn",
              with(small, "blank={shape: drawing, drawing: {file: " + (scratch / "blank.dxf").string() +
                              ", length_unit: mm}" + orientation),
              "peak_punch_force_N");
  CHECK(drawn == Approx(circle).epsilon(1e-3));  // circles are polygons of other fineness
  CHECK(fs::exists(scratch / "drawn/inputs/blank.drawing.file.dxf"));
}

TEST_CASE("the orientation study stamps each blank, pulls each sample and reports both", "[pipeline][run]") {
  const Scratch scratch;
  std::vector<std::string> settings = with(small, "orientation_study.blanks=[0 deg, 45 deg]");
  settings = with(settings, "process.steps=5");
  auto options = options_for("orientation.yaml", scratch / "study", settings);
  options.cache = scratch / "cache";
  warm(options.cache);
  REQUIRE(pipeline::run_case(options) == pipeline::exit_done);
  const fs::path study = scratch / "study";
  for (const char* file : {"table.csv", "report.html", "friction/friction_test.csv",
                           "cases/0_deg/history.csv", "cases/45_deg/blank.vtu", "cases/45_deg/summary.json"})
    CHECK(fs::exists(study / file));
  const std::string table = pipeline::read_file(study / "table.csv");
  CHECK(std::count(table.begin(), table.end(), '\n') == 3);
  const std::string samples = pipeline::read_file(study / "friction/friction_test.csv");
  CHECK(std::count(samples.begin(), samples.end(), '\n') == 8);
  const auto first = contents(study);
  REQUIRE(pipeline::run_case(options) == pipeline::exit_done);  // out of the cache
  CHECK((contents(study) == first));
  const std::string manifest = pipeline::read_file(study / "manifest.json");
  const auto blank = manifest.find("blank_45_deg");
  REQUIRE(blank != std::string::npos);
  CHECK(manifest.find("\"reused\": true", blank) != std::string::npos);
  // Tows at 45 degrees turn the draw-in from the middles of the sides to the corners.
  CHECK(number(study / "cases/0_deg", "draw_in_max_mm") >
        1.2 * number(study / "cases/45_deg", "draw_in_max_mm"));
  CHECK_THAT(pipeline::read_file(study / "report.html"), Catch::Contains("at every angle by construction"));

  // With the effect the samples differ as it says, and the page no longer says that they cannot.
  settings = with(settings, "orientation_study.blanks=[0 deg]");
  options = options_for("orientation.yaml", scratch / "oriented",
                        with(with(settings, "orientation_study.friction=[0 deg, 45 deg]"),
                             "effects={orientation: {amplitude: 0.1}}"));
  options.cache = scratch / "cache";
  warm(options.cache);
  REQUIRE(pipeline::run_case(options) == pipeline::exit_done);
  const std::string page = pipeline::read_file(scratch / "oriented/report.html");
  CHECK(page.find("at every angle by construction") == std::string::npos);
  CHECK_THAT(page, Catch::Contains("0.1 sin^2(2 theta)"));
  std::vector<double> mu;
  std::istringstream rows(pipeline::read_file(scratch / "oriented/friction/friction_test.csv"));
  for (std::string line; std::getline(rows, line);) {
    std::istringstream cells(line);
    for (int k = 0; k < 7; ++k) std::getline(cells, line, ',');
    if (!line.starts_with("friction")) mu.push_back(std::stod(line));
  }
  REQUIRE(mu.size() == 2);
  CHECK(mu[1] == Approx(1.1 * mu[0]));
}

TEST_CASE("tools from the shipped STEP files stamp the same part as the shapes they were drawn from",
          "[pipeline][run][tools][long]") {
  const Scratch scratch;
  std::vector<std::string> settings = small;
  const double shapes = stamped(scratch, "shapes", settings, "peak_punch_force_N");
  const double shear = number(scratch / "shapes", "shear_angle_max_deg");
  settings.back() = tools_by_file;
  CHECK(stamped(scratch, "files", settings, "peak_punch_force_N") == Approx(shapes).epsilon(0.02));
  CHECK(number(scratch / "files", "shear_angle_max_deg") == Approx(shear).margin(0.5));
  CHECK(fs::exists(scratch / "files/inputs/tools.punch.file.step"));
}

TEST_CASE(
    "at full size STEP tools give the force of the shapes within 0.3 % and the shear within 0.1 degrees",
    "[pipeline][run][tools][slow]") {
  const Scratch scratch;
  const double files = stamped(scratch, "files", {}, "peak_punch_force_N");
  const double shapes = stamped(scratch, "shapes", {tools_by_shape}, "peak_punch_force_N");
  CHECK(files == Approx(shapes).epsilon(0.003));
  CHECK(number(scratch / "files", "shear_angle_max_deg") ==
        Approx(number(scratch / "shapes", "shear_angle_max_deg")).margin(0.1));
}
