// `heddle study` of stampings, from the command to the files it leaves, and the numbers it draws from them.
#include "pipeline/stamping_study.h"
#include "pipeline/study_command.h"

#include <algorithm>
#include <catch2/catch.hpp>
#include <cmath>
#include <filesystem>
#include <fstream>

#include "core/csv.h"
#include "core/hdf5_file.h"
#include "core/problem.h"
#include "pipeline/outputs.h"
#include "scratch.h"

using namespace heddle;
using heddle::test::Scratch;
namespace fs = std::filesystem;

namespace {

pipeline::StudiedStamping stamping(double binder_force, double speed_scale, double force) {
  pipeline::StudiedStamping s{"id", "given", binder_force, speed_scale};
  s.steps = {{.stroke = 0.01, .force = 0.5 * force},
             {.stroke = 0.02, .force = force},
             {.stroke = 0.03, .force = 0.9 * force}};
  return s;
}

// Peak forces over three speeds.
pipeline::StampingStudyFindings over_speed_of(double (*force)(double speed)) {
  pipeline::StampingStudyFindings findings;
  findings.spec.models = {{"given", {}}};
  findings.binder_force = 650.0;
  for (const double scale : {2.0, 0.5, 1.0})
    findings.stampings.push_back(stamping(650.0, scale, force(scale)));
  return findings;
}

// A stamping so small that a study of it takes seconds; its binder holds constant mu.
pipeline::RunOptions small_study(const fs::path& output, const std::string& models) {
  auto options = heddle::test::options_for(output, heddle::test::small_stamping());
  options.assignments.push_back("blank.grid_error=off");
  options.assignments.push_back("friction={law: coulomb, coefficient: 0.3}");
  options.assignments.push_back(
      "stamping_study={binder_force: [650 N, 1300 N, 2600 N], speed_scale: [0.5, 1, 2]" + models + "}");
  return options;
}

}  // namespace

TEST_CASE("the signature of a resistance that grows as the n-th power of speed is two to the n",
          "[pipeline][study]") {
  const auto ratio = [](double (*force)(double)) {
    const auto signatures = pipeline::speed_signatures(over_speed_of(force));
    REQUIRE(signatures.size() == 1);
    CHECK(signatures[0].speed == 1.0);
    return signatures[0].ratio();
  };
  CHECK(ratio([](double v) { return 300.0 + 20.0 * v * v; }).value() == Approx(4.0));
  CHECK(ratio([](double v) { return 300.0 + 20.0 * v; }).value() == Approx(2.0));
  CHECK(ratio([](double v) { return 300.0 + 20.0 * std::pow(v, 0.38); }).value() ==
        Approx(std::pow(2.0, 0.38)));
  CHECK(ratio([](double v) { return 300.0 + 20.0 * std::log(v); }).value() == Approx(1.0));
  // A rise of 0.05 % is no rise that a ratio could be made of.
  CHECK_FALSE(ratio([](double v) { return 300.0 + 0.1 * v; }).has_value());
}

TEST_CASE("a stamping that failed, or has another binder force, is left out of the speeds",
          "[pipeline][study]") {
  auto findings = over_speed_of([](double v) { return 300.0 + v; });
  findings.stampings.push_back(stamping(3000.0, 4.0, 900.0));
  CHECK(pipeline::over_speed(findings, "given").size() == 3);
  findings.stampings[0].status = pipeline::CaseStatus::failed;
  const auto left = pipeline::over_speed(findings, "given");
  REQUIRE(left.size() == 2);
  CHECK(left[0]->speed_scale == 0.5);
  CHECK(left[0]->peak()->stroke == 0.02);
  CHECK(pipeline::speed_signatures(findings).empty());
}

TEST_CASE("the line through peak forces is that of the points, and says how far one lies off",
          "[pipeline][study]") {
  pipeline::StampingStudyFindings findings;
  findings.spec.models = {{"given", {}}};
  for (const double force : {3000.0, 650.0, 1400.0, 2200.0})
    findings.stampings.push_back(stamping(force, 1.0, 100.0 + 0.5 * force));
  const auto straight = pipeline::binder_line(findings).value();
  CHECK(straight.slope == Approx(0.5));
  CHECK(straight.intercept == Approx(100.0));
  CHECK(straight.r_squared == Approx(1.0));
  CHECK(straight.largest_miss < 1e-12);
  for (auto& s : findings.stampings) s.steps[1].force = 10.0 * std::pow(s.binder_force, 0.88);
  CHECK(pipeline::binder_line(findings)->largest_miss > 0.005);
  findings.stampings.resize(2);
  CHECK_FALSE(pipeline::binder_line(findings));
}

TEST_CASE("a study of stampings runs every model at every speed once, and again out of what it left",
          "[pipeline][study][long]") {
  const Scratch scratch;
  auto options = small_study(scratch / "study", ", models: ['rate-free: fabric.shear_rate=off']");
  options.cache = scratch / "cache";
  heddle::test::warm(options.cache);
  REQUIRE(pipeline::study_case(options) == pipeline::exit_done);
  const CsvTable table = read_csv(scratch / "study/table.csv");
  REQUIRE(table.problems.empty());
  REQUIRE(table.rows.size() == 2 * 3 + 2);  // 650 N at V is among the speeds
  const auto peak = [&](const std::string& id) {
    const auto row =
        std::find_if(table.rows.begin(), table.rows.end(), [&](const CsvRow& r) { return r.cells[0] == id; });
    REQUIRE(row != table.rows.end());
    CHECK(row->cells[4] == "done");
    return std::stod(row->cells[5]);
  };
  // Constant mu without a rate of shear knows no speed but that of its true mass; with it force rises.
  const double free_rise = peak("rate-free_650N_2V") / peak("rate-free_650N_0p5V") - 1.0;
  const double rise = peak("given_650N_2V") / peak("given_650N_0p5V") - 1.0;
  CAPTURE(free_rise, rise);
  CHECK(std::abs(free_rise) < 0.2 * rise);
  CHECK(peak("given_650N_2V") > peak("given_650N_1V"));
  CHECK(peak("given_650N_1V") > peak("given_650N_0p5V"));
  CHECK(peak("given_2600N_1V") > peak("given_1300N_1V"));
  CHECK(Hdf5Reader(pipeline::read_file(scratch / "study/table.h5"))
            .doubles("/results/peak_punch_force_N")
            .at(0) == std::stod(table.rows[0].cells[5]));
  const std::string page = pipeline::read_file(scratch / "study/report.html");
  for (const char* part :
       {"Binder force", "Punch speed", "Models against each other", "fabric.shear_rate=off"})
    CHECK_THAT(page, Catch::Contains(part));

  // Each stamping is a run like any other, indicators included.
  const fs::path one = scratch / "study/cases/given_650N_1V";
  CHECK_THAT(pipeline::read_file(one / "summary.json"), Catch::Contains("\"wrinkle_height_max_mm\""));
  CHECK_THAT(pipeline::read_file(one / "macroscale/blank_0005.vtu"),
             Catch::Contains("\"tow_load_warp_weft\""));
  CHECK(fs::exists(one / "macroscale/indicators.csv"));

  const auto first = heddle::test::contents(scratch / "study");
  REQUIRE(pipeline::study_case(options) == pipeline::exit_done);
  CHECK(heddle::test::first_difference(first, heddle::test::contents(scratch / "study")) == "");
  CHECK_THAT(pipeline::read_file(scratch / "study/manifest.json"), Catch::Contains("\"reused\": true"));
}

TEST_CASE("a wrong key of one model is named with the model, before anything is stamped",
          "[pipeline][study][wrong input]") {
  const Scratch scratch;
  auto options = small_study(scratch / "study", ", models: ['thick: weave.tow_thicknes=1 mm']");
  try {
    pipeline::study_case(options);
    FAIL("the study began");
  } catch (const InputError& error) {
    REQUIRE(error.problems().size() == 1);
    CHECK(error.problems()[0].id == "weave.tow_thicknes.unknown");
    CHECK_THAT(error.problems()[0].file, Catch::Contains("thick"));
  }
  CHECK_FALSE(fs::exists(scratch / "study"));
}

TEST_CASE("a file that holds a study of cells and one of stampings is refused",
          "[pipeline][study][wrong input]") {
  const Scratch scratch;
  auto options = small_study(scratch / "study", "");
  options.assignments.push_back("study={gap: [1 mm]}");
  try {
    pipeline::study_case(options);
    FAIL("the study began");
  } catch (const InputError& error) {
    CHECK(error.problems()[0].id == "study.both");
  }
}

TEST_CASE("a variation is every combination of its keys' values, each with a name", "[pipeline][study]") {
  const std::vector<pipeline::VariedKey> variation{{"tools.die.friction_coefficient", {"0", "0.125"}},
                                                   {"process.binder_force", {"22.8 N", "1e+3 N"}}};
  const auto all = pipeline::combinations(variation);
  REQUIRE(all.size() == 4);
  CHECK(all[1] == std::vector<std::string>{"0", "1e+3 N"});
  CHECK(all[2] == std::vector<std::string>{"0.125", "22.8 N"});
  CHECK(pipeline::id_of(variation, all[2]) ==
        "tools-die-friction_coefficient-0p125_process-binder_force-22p8N");
  pipeline::StampingStudySpec spec;
  spec.variations = {variation, {{"process.binder_force", {"1 N"}}, {"fabric.shear_scale", {"2"}}}};
  CHECK(pipeline::varied_keys(spec) == std::vector<std::string>{"tools.die.friction_coefficient",
                                                                "process.binder_force",
                                                                "fabric.shear_scale"});
}

TEST_CASE("the place of the largest shear is the innermost of those alike, and means are by depth",
          "[pipeline][study]") {
  macroscale::BlankState blank;
  blank.reference = {{0.03, -0.04}, {0.0, 0.06}, {0.03, 0.04}, {0.1, 0.0}};
  blank.position = {{0.02, -0.03, -0.03}, {0.0, 0.05, -0.02}, {0.02, 0.03, -0.03}, {0.09, 0.0, 0.0}};
  blank.shear_angle = {-0.5, 0.5, 0.4, 0.1};
  const auto place = pipeline::shear_place(blank, 0.05);
  CHECK(place.angle == 0.5);
  CHECK(place.flat_radius == Approx(0.05));
  CHECK(place.direction == Approx(std::atan2(4.0, 3.0)));
  CHECK(place.radius == Approx(std::hypot(0.02, 0.03)));
  CHECK(place.depth == 0.03);
  CHECK(place.deep_rms == Approx(std::sqrt((0.25 + 0.16) / 2.0)));
  CHECK(place.level_rms == Approx(0.1));
}

TEST_CASE("a study of a quarter says of shear what the whole says", "[pipeline][study]") {
  const Scratch scratch;
  auto options = heddle::test::options_for(scratch / "study", heddle::test::small_stamping());
  options.cache = scratch / "cache";
  heddle::test::warm(options.cache);
  options.assignments.insert(options.assignments.end(),
                             {"blank.grid_error=off", "stamping_study={vary: ['blank.symmetry: quarter']}"});
  REQUIRE(pipeline::study_case(options) == pipeline::exit_done);
  const CsvTable table = read_csv(scratch / "study/table.csv");
  REQUIRE(table.rows.size() == 2);
  for (const char* name : {"shear_place_radius_mm", "shear_level_rms_deg"}) {
    const auto found = std::find(table.header.cells.begin(), table.header.cells.end(), name);
    REQUIRE(found != table.header.cells.end());
    const auto column = static_cast<std::size_t>(found - table.header.cells.begin());
    const double whole = std::stod(table.rows[0].cells[column]);
    CHECK(whole > 0.0);
    CHECK(std::stod(table.rows[1].cells[column]) == Approx(whole).epsilon(1e-4));
  }
}

TEST_CASE("a study varies the friction of one tool, and says what each stamping had", "[pipeline][study]") {
  const Scratch scratch;
  auto options = heddle::test::options_for(scratch / "study", heddle::test::small_stamping());
  options.cache = scratch / "cache";
  heddle::test::warm(options.cache);
  options.assignments.insert(options.assignments.end(),
                             {"blank.grid_error=off", "friction={law: coulomb, coefficient: 0.3}",
                              "stamping_study={vary: ['tools.die.friction_coefficient: 0; 0.5 & "
                              "tools.binder.friction_coefficient: 0', "
                              "'process.binder_force: 3000 N']}"});
  REQUIRE(pipeline::study_case(options) == pipeline::exit_done);
  const CsvTable table = read_csv(scratch / "study/table.csv");
  REQUIRE(table.problems.empty());
  REQUIRE(table.rows.size() == 4);
  const auto cell = [&](std::size_t row, const std::string& name) {
    const auto found = std::find(table.header.cells.begin(), table.header.cells.end(), name);
    REQUIRE(found != table.header.cells.end());
    return table.rows[row].cells[static_cast<std::size_t>(found - table.header.cells.begin())];
  };
  CHECK(cell(0, "case") == "given_650N_1V");
  CHECK(cell(0, "tools.die.friction_coefficient").empty());
  CHECK(cell(1, "tools.die.friction_coefficient") == "0");
  CHECK(cell(2, "tools.die.friction_coefficient") == "0.5");
  CHECK(cell(3, "process.binder_force") == "3000 N");
  CHECK(cell(3, "binder_force_N") == "3000");
  const auto force = [&](std::size_t row) { return std::stod(cell(row, "peak_punch_force_N")); };
  CHECK(force(2) > force(1));
  CHECK(force(3) > force(0));
  CHECK(std::stod(cell(2, "shear_place_flat_radius_mm")) > 0.0);
  CHECK(std::stod(cell(2, "energy_residual_max")) < 0.01);
  CHECK_THAT(pipeline::read_file(scratch / "study/report.html"),
             Catch::Contains("tools.die.friction_coefficient and tools.binder.friction_coefficient"));
  // One that differs only in a varied key is none of the speeds and forces of the case as given.
  CHECK_THAT(pipeline::read_file(scratch / "study/report.html"), !Catch::Contains("<h2>Binder force"));
}

TEST_CASE("a variation that breaks a rule between keys is named, before anything is stamped",
          "[pipeline][study][wrong input]") {
  const Scratch scratch;
  auto options = heddle::test::options_for(scratch / "study", heddle::test::small_stamping());
  options.assignments.push_back("stamping_study={vary: ['tools.punch.radius: 60 mm; 71.9 mm']}");
  try {
    pipeline::study_case(options);
    FAIL("the study began");
  } catch (const InputError& error) {
    REQUIRE(error.problems().size() == 1);
    CHECK(error.problems()[0].id == "tools.die.opening_radius.fabric");
  }
  CHECK_FALSE(fs::exists(scratch / "study"));
}

TEST_CASE("the study of Dong et al., coarser: every stamping comes to its end, and speed changes nothing",
          "[pipeline][study][slow]") {
  const Scratch scratch;
  pipeline::RunOptions options = heddle::test::options_for(scratch / "dong", {});
  options.file = fs::path(heddle::test::source_dir) / "configs/studies/dong.yaml";
  options.assignments = {"blank.spacing=20 mm", "process.steps=20"};
  options.cache = HEDDLE_TEST_CACHE;
  REQUIRE(pipeline::study_case(options) == pipeline::exit_done);
  const CsvTable table = read_csv(scratch / "dong/table.csv");
  REQUIRE(table.rows.size() == 1 + 10 + 4 + 4 + 3 + 3);
  const auto column = [&](const std::string& name) {
    return static_cast<std::size_t>(std::find(table.header.cells.begin(), table.header.cells.end(), name) -
                                    table.header.cells.begin());
  };
  double slowest = 0.0, fastest = 0.0;
  for (const CsvRow& row : table.rows) {
    CAPTURE(row.cells[0]);
    CHECK(row.cells[column("status")] == "done");
    CHECK(std::stod(row.cells[column("energy_residual_max")]) < 0.01);
    const double force = std::stod(row.cells[column("peak_punch_force_N")]);
    // Of the largest force there is: without friction at the die the punch needs less than a newton, and the
    // binder's force goes into the die.
    const double largest = std::max(force, std::stod(row.cells[column("binder_force_N")]));
    CHECK(std::stod(row.cells[column("force_balance_residual_max")]) * force < 1e-3 * largest);
    if (row.cells[0] == "process-punch-speed_scale-0p001") slowest = force;
    if (row.cells[0] == "process-punch-speed_scale-1") fastest = force;
  }
  REQUIRE(slowest > 0.0);
  CHECK(fastest == Approx(slowest).epsilon(0.01));
}
