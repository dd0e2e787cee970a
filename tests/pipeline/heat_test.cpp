// What a run with temperatures writes, and the stiffness it hands over.
#include <catch2/catch.hpp>

#include <cmath>
#include <filesystem>
#include <nlohmann/json.hpp>
#include <numbers>
#include <sstream>
#include <string>
#include <vector>

#include "pipeline/commands.h"
#include "pipeline/outputs.h"
#include "pipeline/part_stiffness.h"
#include "scratch.h"
#include "tests/source_dir.h"

using namespace heddle;
using namespace heddle::test;
namespace fs = std::filesystem;

namespace {

std::string first_line(const std::string& text) {
  return text.substr(0, text.find('\n'));
}

/// One cell of unit size in the x-y plane whose weft leans by an angle, turned about x.
macroscale::BlankState one_cell(double shear, double turn) {
  macroscale::BlankState blank;
  blank.nu = blank.nv = 1;
  blank.grid = {{0, 0}, {0, 1}, {1, 0}, {1, 1}};
  blank.quads = {{0, 2, 3, 1}};
  const double s = std::sin(shear), c = std::cos(shear);
  for (const auto& [a, b] : {std::pair{0.0, 0.0}, {0.0, 1.0}, {1.0, 0.0}, {1.0, 1.0}}) {
    const double x = a + s * b, y = c * b;
    blank.position.push_back({x, y * std::cos(turn), y * std::sin(turn)});
  }
  return blank;
}

std::vector<mesoscale::solid::ShearedSolid> table() {
  std::vector<mesoscale::solid::ShearedSolid> rows(3);
  for (std::size_t k = 0; k < 3; ++k) {
    rows[k].shear_angle = 0.3 * static_cast<double>(k);
    rows[k].thickness = 0.4e-3 * (1.0 + 0.1 * static_cast<double>(k));
    for (int i = 0; i < 6; ++i)
      for (int j = 0; j < 6; ++j) rows[k].plate(i, j) = 1.0 + i + j + 10.0 * static_cast<double>(k);
    for (int i = 0; i < 6; ++i) rows[k].plate_held[0][i] = 1.0 + i + static_cast<double>(k);
    rows[k].fibre_fraction = 0.6 - 0.05 * static_cast<double>(k);
    rows[k].stack = rows[k].plate;
    rows[k].stack_held[0] = rows[k].plate_held[0];
  }
  return rows;
}

}  // namespace

TEST_CASE("a cell of the part has the stiffness of its trellis angle, in axes along its warp",
          "[pipeline][heat]") {
  const double turn = 0.4;
  const auto cells = pipeline::part_stiffness(one_cell(0.3, turn), table());
  REQUIRE(cells.size() == 1);
  const pipeline::CellStiffness& cell = cells[0];
  CHECK(cell.shear_angle == Approx(0.3));
  CHECK_FALSE(cell.beyond_table);
  CHECK(cell.thickness == Approx(0.44e-3));
  CHECK((cell.plate - table()[1].plate).cwiseAbs().maxCoeff() < 1e-9);
  CHECK(cell.warp[0] == Approx(1.0));
  CHECK(cell.weft[0] == Approx(std::sin(0.3)));
  CHECK(cell.weft[1] == Approx(std::cos(0.3) * std::cos(turn)));
  CHECK(cell.tow_fibre_fraction == Approx(0.55));
  CHECK(cell.normal[1] == Approx(-std::sin(turn)));
  CHECK(cell.normal[2] == Approx(std::cos(turn)));
}

TEST_CASE("a cell sheared the other way is the mirror image: what couples shear changes sign",
          "[pipeline][heat]") {
  const auto cell = pipeline::part_stiffness(one_cell(-0.3, 0.0), table())[0];
  const mesoscale::solid::Matrix6 of = table()[1].plate;
  CHECK(cell.shear_angle == Approx(-0.3));
  for (int i = 0; i < 6; ++i)
    for (int j = 0; j < 6; ++j) {
      const bool odd = (i % 3 == 2) != (j % 3 == 2);
      CHECK(cell.plate(i, j) == Approx(odd ? -of(i, j) : of(i, j)));
    }
  // Of the solid, in the order 11, 22, 33, 23, 13, 12, whatever has the axis 2 once.
  for (int i = 0; i < 6; ++i)
    for (int j = 0; j < 6; ++j) {
      const bool odd = (i == 3 || i == 5) != (j == 3 || j == 5);
      CHECK(cell.stack(i, j) == Approx(odd ? -of(i, j) : of(i, j)));
    }
  CHECK(cell.stack_held[3] == Approx(-table()[1].stack_held[0][3]));
  CHECK(cell.expansion[2] == Approx(-table()[1].plate_held[0][2]));
  CHECK(cell.expansion[1] == Approx(table()[1].plate_held[0][1]));
}

TEST_CASE("a cell sheared beyond the table says so and takes its end", "[pipeline][heat]") {
  const auto cell = pipeline::part_stiffness(one_cell(0.9, 0.0), table())[0];
  CHECK(cell.beyond_table);
  CHECK(cell.thickness == Approx(0.48e-3));
}

TEST_CASE("history.csv has its columns of heat behind all others, and none without temperatures",
          "[pipeline][heat][outputs]") {
  std::vector<macroscale::HistoryRow> rows(2);
  const std::string plain = pipeline::history_csv(rows);
  for (auto& row : rows)
    row.heat = macroscale::HeatRow{.time = 0.1, .mean_temperature = 400.0, .coldest_face = 373.15};
  const std::string with_heat = pipeline::history_csv(rows);
  CHECK(
      first_line(with_heat) ==
      first_line(plain) +
          ",temperature_mean_C,face_temperature_min_C,crystallised_share,frozen_faces_share,"
          "frozen_through_share,heat_through_bottom_J,heat_through_top_J,heat_of_friction_J,heat_residual_J");
  CHECK(with_heat.find(",126.8") != std::string::npos);
  const std::string hold = pipeline::hold_csv(std::vector{*rows[0].heat});
  CHECK(hold.starts_with("time_s,temperature_mean_C,"));
  CHECK(hold.find("\n0.1,126.8") != std::string::npos);
}

TEST_CASE("the shipped case with temperatures runs small and says what has frozen", "[pipeline][heat][run]") {
  const Scratch scratch;
  const auto run = [&](const std::string& name, std::vector<std::string> more) {
    pipeline::RunOptions options;
    options.file = fs::path(source_dir) / "configs/thermal.yaml";
    options.output = scratch / name;
    options.cache = scratch / (name + "-cache");
    warm(options.cache);
    options.assignments = {"blank.spacing=20 mm", "process.steps=8",
                           "process.punch={stroke: 30 mm, time: 0.18 s}", "process.hold=2 s"};
    options.assignments.insert(options.assignments.end(), more.begin(), more.end());
    options.quiet = true;
    options.print = false;
    REQUIRE(pipeline::run_case(options) == pipeline::exit_done);
    return contents(scratch / name);
  };
  const auto a = run("a", {}), b = run("b", {});
  for (const auto& [name, bytes] : a) {
    INFO(name);
    CHECK((bytes == b.at(name)));
  }
  REQUIRE(a.count("macroscale/hold.csv") == 1);
  REQUIRE(a.count("macroscale/blank_held.vtu") == 1);
  for (const char* field :
       {"temperature_bottom_C", "temperature_top_C", "temperature_mean_C", "crystallised_share"})
    CHECK(a.at("macroscale/blank_held.vtu").find(field) != std::string::npos);
  CHECK(a.at("report.html").find("Temperatures") != std::string::npos);
  const auto heat = nlohmann::json::parse(a.at("summary.json")).at("macroscale").at("heat");
  CHECK(heat.at("heat_residual_max").get<double>() < 1e-10);
  CHECK(heat.at("held_s").get<double>() == Approx(2.0));
  CHECK(heat.at("temperature_mean_C").get<double>() < 190.0);
  CHECK(heat.at("face_temperature_min_C").get<double>() > 25.0);
  CHECK(heat.at("heat_of_friction_J").get<double>() > 0.0);

  // Written out it is a case of its own with the same outcome.
  pipeline::RunOptions again;
  again.file = scratch / "a" / "resolved.yaml";
  again.output = scratch / "c";
  again.cache = scratch / "c-cache";
  warm(again.cache);
  again.quiet = true;
  again.print = false;
  REQUIRE(pipeline::run_case(again) == pipeline::exit_done);
  CHECK((pipeline::read_file(scratch / "c" / "macroscale/hold.csv") == a.at("macroscale/hold.csv")));
}
