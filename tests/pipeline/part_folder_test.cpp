// The formed part out of the folder of a run.
#include <algorithm>
#include <catch2/catch.hpp>
#include <filesystem>
#include <fstream>
#include <string>
#include <utility>
#include <vector>

#include "core/problem.h"
#include "pipeline/commands.h"
#include "pipeline/outputs.h"
#include "scratch.h"

using namespace heddle;
using namespace heddle::test;

namespace {

const std::string coarse_solid = "solid={per_pitch: 8, layers: 8, shear_angles: [0 deg, 30 deg, 50 deg]}";

// Constant mu: nothing to fit, and the law goes out without a weave.
std::vector<std::string> small_case() {
  return with(with(small_stamping(), "friction={law: coulomb, coefficient: 0.3}"), "blank.grid_error=off");
}

void stamp(const Scratch& scratch, const std::string& name, std::vector<std::string> settings) {
  pipeline::RunOptions options = options_for(scratch / name, std::move(settings));
  options.cache = scratch / "cache";
  if (!fs::exists(options.cache)) warm(options.cache);
  REQUIRE(pipeline::run_case(options) == pipeline::exit_done);
}

pipeline::ExportOptions export_of(const fs::path& folder, const std::string& target) {
  pipeline::ExportOptions options;
  options.run.file = folder;
  options.run.print = false;
  options.target = target;
  return options;
}

/// Names of the rules that an export breaks, in order.
std::vector<std::string> refused(const pipeline::ExportOptions& options) {
  try {
    pipeline::export_case(options);
  } catch (const InputError& error) {
    std::vector<std::string> rules;
    for (const Problem& problem : error.problems()) rules.push_back(problem.id.text());
    return rules;
  }
  return {};
}

using Rules = std::vector<std::string>;

}  // namespace

TEST_CASE("the part goes out of the folder of a stamping, as a deck, a table of cells and a picture",
          "[pipeline][export][run]") {
  const Scratch scratch;
  stamp(scratch, "a", with(small_case(), coarse_solid));
  pipeline::ExportOptions options = export_of(scratch / "a", "ccx");
  options.room = "20 degC";
  REQUIRE(pipeline::export_case(options) == pipeline::exit_done);
  const fs::path to = scratch / "a" / "export";
  const std::string deck = pipeline::read_file(to / "part_ccx.inp");
  CHECK(deck.find(
            "Free of stress at 118.0 degC (assumed: the default of thermal.freezing_temperature), cooled to "
            "20.0 degC (--room)") != std::string::npos);
  CHECK(deck.find("*TEMPERATURE\nPART, 20\n") != std::string::npos);
  CHECK(deck.find("C3D20R") != std::string::npos);
  const std::string cells = pipeline::read_file(to / "part_stiffness.csv");
  CHECK(std::count(cells.begin(), cells.end(), '\n') == 101);  // 10 x 10 cells
  CHECK(cells.find("weft_x,weft_y,weft_z,tow_fibre_volume_fraction") != std::string::npos);
  CHECK(pipeline::read_file(to / "part.vtu").find("Name=\"weft\"") != std::string::npos);
  CHECK(refused(options).empty());  // and again, to the same bytes
  CHECK((pipeline::read_file(to / "part_ccx.inp") == deck));
  REQUIRE(pipeline::export_case(export_of(scratch / "a", "abaqus")) == pipeline::exit_done);
  CHECK(fs::exists(to / "part_abaqus.inp"));
  CHECK(fs::exists(to / "heddle_friction.f"));
}

TEST_CASE("of a quarter the whole part goes out", "[pipeline][export][run]") {
  const Scratch scratch;
  const auto lines_of = [&](const char* name, std::vector<std::string> settings) {
    stamp(scratch, name, with(std::move(settings), coarse_solid));
    REQUIRE(pipeline::export_case(export_of(scratch / name, "ccx")) == pipeline::exit_done);
    const std::string cells = pipeline::read_file(scratch / name / "export/part_stiffness.csv"),
                      deck = pipeline::read_file(scratch / name / "export/part_ccx.inp");
    return std::pair{std::count(cells.begin(), cells.end(), '\n'),
                     std::count(deck.begin(), deck.end(), '\n')};
  };
  const auto whole = lines_of("whole", small_case());
  CHECK(whole.first == 101);
  CHECK(lines_of("quarter", with(small_case(), "blank.symmetry=quarter")) == whole);
}

TEST_CASE("a part that cannot go out is refused with what is missing and the command that makes it",
          "[pipeline][export][run][wrong input]") {
  const Scratch scratch;
  stamp(scratch, "a", with(small_case(), coarse_solid));
  stamp(scratch, "bare", small_case());
  CHECK(refused(export_of(scratch / "bare", "ccx")) == Rules{"export.part.solid"});
  REQUIRE(pipeline::export_case(export_of(scratch / "bare", "abaqus")) == pipeline::exit_done);  // the law
  CHECK_FALSE(fs::exists(scratch / "bare" / "export" / "part_abaqus.inp"));
  pipeline::ExportOptions plies = export_of(scratch / "bare", "ccx");
  plies.run.assignments = {"blank.plies=2", "tools.die.opening_radius=76 mm"};
  CHECK(refused(plies) == Rules{"export.part.plies", "export.part.solid"});
  pipeline::ExportOptions cold = export_of(scratch / "a", "ccx");
  cold.stress_free = "118 mm";
  CHECK(refused(cold) == Rules{"export.temperature"});

  const fs::path checkpoint = scratch / "a" / "macroscale/checkpoint.h5",
                 manifest = scratch / "a" / "manifest.json";
  const std::string bytes = pipeline::read_file(checkpoint), listed = pipeline::read_file(manifest);
  pipeline::write_file(checkpoint, bytes.substr(0, bytes.size() / 2));
  CHECK(refused(export_of(scratch / "a", "ccx")) == Rules{"export.part.damaged"});
  pipeline::write_file(checkpoint, bytes);
  fs::remove(manifest);  // the last file of a run
  CHECK(refused(export_of(scratch / "a", "ccx")) == Rules{"export.part.stamping"});
  pipeline::write_file(manifest, listed);
  pipeline::write_file(scratch / "a" / "mesoscale/stiffness.json", "{\"sheared\": [{}]}\n");
  CHECK(refused(export_of(scratch / "a", "ccx")) == Rules{"stiffness.file"});
}

TEST_CASE("plies at trellis angles come back from stiffness.json", "[pipeline][export]") {
  mesoscale::solid::SolidSpec spec;
  spec.grid = {.per_pitch = 6, .layers = 4};
  spec.shear_angles = {0.0, 0.5};
  const auto result = mesoscale::solid::analyse(mesoscale::WeaveSpec{}, spec);
  const auto read = pipeline::read_sheared_json(pipeline::stiffness_json(result), "stiffness.json");
  REQUIRE(read.size() == 2);
  for (std::size_t k = 0; k < 2; ++k) {
    const auto &a = read[k], &b = result.sheared[k];
    CHECK(a.shear_angle == Approx(b.shear_angle).epsilon(1e-14));
    CHECK(a.thickness == Approx(b.thickness).epsilon(1e-14));
    CHECK(a.fibre_fraction == b.fibre_fraction);
    CHECK(a.converged == b.converged);
    CHECK((a.plate - b.plate).norm() <= 1e-14 * b.plate.norm());
    CHECK((a.stack - b.stack).norm() <= 1e-14 * b.stack.norm());
    for (std::size_t cause = 0; cause < 2; ++cause) {
      CHECK((a.plate_held[cause] - b.plate_held[cause]).norm() <= 1e-14 * b.plate_held[cause].norm());
      CHECK((a.stack_held[cause] - b.stack_held[cause]).norm() <= 1e-14 * b.stack_held[cause].norm());
    }
  }
}
