#include "pipeline/config_reader.h"

#include <algorithm>
#include <catch2/catch.hpp>
#include <cmath>
#include <cstring>
#include <filesystem>
#include <fstream>
#include <set>
#include <sstream>

#include "core/units.h"
#include "pipeline/case.h"
#include "pipeline/config_reference.h"
#include "pipeline/friction_keys.h"
#include "tests/source_dir.h"

using namespace heddle;
using pipeline::Case;
using pipeline::read_case;
using pipeline::read_case_text;

namespace {

const std::filesystem::path source = heddle::test::source_dir;
const std::filesystem::path configs = source / "configs";

std::string text_of(const std::filesystem::path& file) {
  std::ifstream stream(file, std::ios::binary);
  REQUIRE(stream);
  std::ostringstream text;
  text << stream.rdbuf();
  return text.str();
}

const std::string small_cell =
    "heddle: 1\nname: small\n"
    "weave: {pattern: plain, tow_width: 4.64 mm, gap: 0.75 mm, tow_thickness: 0.75 mm, fabric_thickness: 1.5 "
    "mm,\n"
    "        linear_density: 1872 tex, fibre_mass_fraction: 60 %}\n";

const std::string small_stamping =
    small_cell +
    "friction: {law: coulomb, coefficient: 0.3}\n"
    "process: {punch: {stroke: 70 mm, time: 0.43 s}, binder_force: 650 N, tool_temperature: 85 degC,\n"
    "          blank_temperature: 180 degC}\n"
    "blank: {size: [320 mm, 320 mm], spacing: 4.5 mm}\n"
    "tools: {punch: {shape: hemisphere, radius: 70 mm}, die: {shape: ring, opening_radius: 72 mm, fillet: 20 "
    "mm},\n"
    "        binder: {shape: ring, inner_radius: 92 mm, mass: 20 kg}}\n";

Problems problems_of(const std::string& text, const std::vector<std::string>& assignments = {}) {
  try {
    read_case_text(text, "x.yaml", configs, assignments);
    return {};
  } catch (const InputError& error) {
    return error.problems();
  }
}

/// Every value of two configurations, bit for bit.
void check_same_settings(const pipeline::Settings& a, const pipeline::Settings& b) {
  CHECK(a.stages == b.stages);
  for (const pipeline::Key& key : pipeline::schema()) {
    INFO(key.path);
    const pipeline::Setting* left = a.find(key.path);
    const pipeline::Setting* right = b.find(key.path);
    REQUIRE((left == nullptr) == (right == nullptr));
    if (left == nullptr) continue;
    CHECK(std::memcmp(left->values.data(), right->values.data(), sizeof left->values) == 0);
    if (key.type != pipeline::KeyType::file) {
      CHECK(left->text == right->text);
    } else {
      CHECK(text_of(left->folder / left->text) == text_of(right->folder / right->text));
    }
  }
}

/// A folder of its own, gone at the end of the test.
class TemporaryFolder {
 public:
  explicit TemporaryFolder(const std::string& name) : path_(std::filesystem::temp_directory_path() / name) {
    std::filesystem::remove_all(path_);
    std::filesystem::create_directories(path_);
  }
  ~TemporaryFolder() { std::filesystem::remove_all(path_); }
  TemporaryFolder(const TemporaryFolder&) = delete;
  TemporaryFolder& operator=(const TemporaryFolder&) = delete;
  const std::filesystem::path& path() const { return path_; }

 private:
  std::filesystem::path path_;
};

}  // namespace

TEST_CASE("every shipped configuration is free of problems", "[pipeline][config]") {
  int count = 0;
  for (const auto& entry : std::filesystem::directory_iterator(configs)) {
    if (entry.path().extension() != ".yaml") continue;
    INFO(entry.path().filename());
    const Case read = read_case(entry.path());
    CHECK(read.name == entry.path().stem().string());
    ++count;
  }
  CHECK(count >= 3);
}

TEST_CASE("the thermostamping file reads into the paper's numbers in SI", "[pipeline][config]") {
  const Case read = read_case(configs / "thermostamping.yaml");
  REQUIRE(read.cell);
  REQUIRE(read.friction);
  REQUIRE(read.stamping);
  CHECK_FALSE(read.friction_test);
  CHECK(read.cell->weave.tow_width == 4.64e-3);
  CHECK(read.cell->weave.linear_density == 1872e-6);
  CHECK(read.cell->weave.fibre_mass_fraction == 0.6);
  CHECK(read.cell->resin.film_thickness == 0.07e-3);
  CHECK(read.friction->model.film.consistency == 6790.0);
  CHECK(read.friction->model.film.activation_energy == 42e3);
  CHECK(std::holds_alternative<friction::HerseyPower>(read.friction->model.law));
  CHECK(read.friction->calibrated());
  CHECK_FALSE(read.friction->fit_temperature_slope);
  REQUIRE(read.friction->model.effects.tool_temperature_shift);
  CHECK(read.friction->model.effects.tool_temperature_shift->slope == -9.27e-4);
  CHECK(read.friction->model.effects.tool_temperature_shift->reference == 358.15);
  CHECK(read.friction->rig.plate_area == 0.01);
  CHECK(read.friction->rig.plate_area_band == std::array<double, 2>{0.005, 0.02});
  CHECK(read.stamping->process.stroke == 0.07);
  CHECK(read.stamping->process.time == 0.43);
  CHECK(read.stamping->process.binder_force == 650.0);
  CHECK(read.stamping->process.tool_temperature == 358.15);
  CHECK(read.stamping->process.blank_temperature == 453.15);
  CHECK(read.stamping->blank.size == std::array<double, 2>{0.32, 0.32});
  CHECK(read.stamping->die.fillet == 0.02);
  CHECK(read.stamping->artefact.mass_scaling == 1.0);
}

TEST_CASE("defaults of the schema are the defaults of the specifications", "[pipeline][config]") {
  const Case read = read_case_text(small_stamping, "x.yaml", "");
  const mesoscale::CellSpec cell;
  CHECK(read.cell->weave.fibre_density == cell.weave.fibre_density);
  CHECK(read.cell->weave.resin_density == cell.weave.resin_density);
  CHECK(read.cell->weave.fibre_modulus == cell.weave.fibre_modulus);
  CHECK(read.cell->weave.fibre_diameter == cell.weave.fibre_diameter);
  CHECK(read.cell->state == cell.state);
  CHECK(read.cell->resin.consistency == cell.resin.consistency);
  CHECK(read.cell->resin.power_index == cell.resin.power_index);
  CHECK(read.cell->resin.film_thickness == cell.resin.film_thickness);
  CHECK(read.cell->resin.activation_energy == cell.resin.activation_energy);
  CHECK(read.cell->resin.reference_temperature == cell.resin.reference_temperature);
  CHECK(read.cell->forming.compaction_modulus == cell.forming.compaction_modulus);
  CHECK(read.cell->forming.compaction_exponent == cell.forming.compaction_exponent);
  CHECK(read.cell->forming.tow_friction == cell.forming.tow_friction);
  CHECK(read.cell->forming.reference_tension == cell.forming.reference_tension);
  CHECK(read.cell->forming.in_tow_shear_share == cell.forming.in_tow_shear_share);
  CHECK(read.cell->forming.bonding == cell.forming.bonding);
  CHECK(read.cell->forming.compression_ratio == cell.forming.compression_ratio);
  CHECK(read.friction->model.film.rate_floor == friction::PowerLawFilm{}.rate_floor);

  const macroscale::StampingSpec stamping;
  CHECK(read.stamping->process.slow_down == stamping.process.slow_down);
  CHECK(read.stamping->process.speed_scale == stamping.process.speed_scale);
  CHECK(read.stamping->process.steps == stamping.process.steps);
  CHECK(read.stamping->blank.orientation == stamping.blank.orientation);
  CHECK(read.stamping->blank.plies == stamping.blank.plies);
  CHECK(read.stamping->binder.edge_fillet == stamping.binder.edge_fillet);
  CHECK(read.stamping->artefact.mass_scaling == stamping.artefact.mass_scaling);
  CHECK(read.stamping->artefact.stabilisation == stamping.artefact.stabilisation);
  CHECK(read.stamping->shear_rate == stamping.shear_rate);
  CHECK(read.stamping->contact_pressure == stamping.contact_pressure);
}

TEST_CASE("every default of the schema obeys its own rule", "[pipeline][config]") {
  for (const pipeline::Key& key : pipeline::schema()) {
    if (key.presence != pipeline::Presence::defaulted) continue;
    INFO(key.path << ": " << key.default_text);
    std::vector<std::string> assignments{key.path + "=" + key.default_text};
    if (key.path.starts_with("effects.")) {
      const std::string block = key.path.substr(0, key.path.rfind('.') + 1);
      for (const pipeline::Key& other : pipeline::schema())
        if (other.path.starts_with(block) && other.presence == pipeline::Presence::required)
          assignments.insert(assignments.begin(), other.path + "=0 " + other.unit);
    }
    if (key.path.starts_with("friction_test."))
      assignments.push_back("friction_test.data=" + (configs / "data/friction_table4.csv").string());
    // A cell of voxels stands alone.
    const std::string voxels =
        "heddle: 1\nname: voxels\ncell:\n  voxels: {file: " +
        (configs.parent_path() / "tests/mesoscale/data/weave_64.raw").string() +
        ", shape: [64, 64, 64], size: [10 mm, 10 mm, 1 mm], order: x-fastest}\n  boundary: periodic\n"
        "  phases:\n    0: {bulk_modulus: 1667 MPa, shear_modulus: 557 MPa}\n"
        "    1: {bulk_modulus: 8000 MPa, shear_modulus: 4000 MPa}\n"
        "    2: {bulk_modulus: 8000 MPa, shear_modulus: 4000 MPa}\n"
        "    3: {bulk_modulus: 8000 MPa, shear_modulus: 4000 MPa}\n"
        "    4: {bulk_modulus: 8000 MPa, shear_modulus: 4000 MPa}\n";
    CHECK(format(problems_of(key.path.starts_with("cell.voxels.") ? voxels : small_stamping, assignments)) ==
          "");
  }
}

TEST_CASE(
    "the rig stands as its structs say until a key says otherwise, and runs only where its block is given",
    "[pipeline][config]") {
  const std::string data = "friction_test.data=" + (configs / "data/friction_table4.csv").string();
  CHECK_FALSE(read_case_text(small_stamping, "x.yaml", "", {data}).friction_machine);
  const Case read = read_case_text(small_stamping, "x.yaml", "", {data, "friction_test.rig.normal=cam"});
  REQUIRE(read.friction_machine);
  const friction::Machine &m = read.friction_machine->machine, defaults;
  for (const auto& field : friction::About<friction::Drive>::fields)
    CHECK(m.drive.*(field.member) == defaults.drive.*(field.member));
  for (const auto& field : friction::About<friction::Sample>::fields)
    CHECK(m.sample.*(field.member) == defaults.sample.*(field.member));
  REQUIRE(m.cam);
  for (const auto& field : friction::About<friction::CamGap>::fields)
    CHECK((*m.cam).*(field.member) == friction::CamGap{}.*(field.member));
  CHECK(m.sampling_rate == defaults.sampling_rate);
  CHECK(read.friction_machine->bend.radius == friction::SCurve{}.radius);
  CHECK(read.friction_machine->bend.angle == Approx(friction::SCurve{}.angle));
  CHECK(read.friction->rig.pull_length == friction::FrictionRig{}.pull_length);
  CHECK(read.friction->rig.dwell_before == friction::FrictionRig{}.dwell_before);

  const Case other = read_case_text(small_stamping, "x.yaml", "",
                                    {data, "friction_test.rig.drive.backlash=2 mm",
                                     "friction_test.rig.dwell=4 s", "friction_test.rig.sample.slack=3 mm"});
  CHECK(other.friction_machine->machine.drive.backlash == 2e-3);
  CHECK(other.friction_machine->machine.sample.slack == 3e-3);
  CHECK(other.friction->rig.dwell_before == 4.0);
  CHECK_FALSE(other.friction_machine->machine.cam);
}

TEST_CASE("a film conduction that no effect draws on is noted", "[pipeline][config]") {
  const auto notes = [](const std::vector<std::string>& assignments) {
    std::string all;
    for (const std::string& note : read_case_text(small_stamping, "x.yaml", "", assignments).notes)
      all += note + "\n";
    return all;
  };
  const std::string idle = "changes nothing by itself";
  CHECK_THAT(notes({"friction.film_temperature=conduction"}), Catch::Contains(idle));
  CHECK_THAT(notes({}), !Catch::Contains(idle));
  CHECK_THAT(notes({"friction.film_temperature=conduction", "effects.solidification={amplitude: 0.5}"}),
             !Catch::Contains(idle));
}

TEST_CASE("a value set on the command line counts as if it stood in the file", "[pipeline][config]") {
  const Case read = read_case_text(small_stamping, "x.yaml", "",
                                   {"weave.gap=1.5 mm", "blank.size=[400 mm, 0.3 m]", "fabric.shear_rate=off",
                                    "weave.gap=1.6 mm", "process.punch={stroke: 50 mm, time: 1 s}"});
  CHECK(read.cell->weave.gap == 1.6e-3);  // the last one counts
  CHECK(read.stamping->blank.size == std::array<double, 2>{0.4, 0.3});
  CHECK_FALSE(read.stamping->shear_rate);
  CHECK(read.stamping->process.stroke == 0.05);
}

TEST_CASE("blanks of any outline and lists of angles are read, and written back bit for bit",
          "[pipeline][config]") {
  const std::vector<std::string> shaped = {
      "blank={shape: polygon, points: [[-160 mm, -0.15 m], [160 mm, -160 mm], [0 mm, 300 mm]], holes: [[0 "
      "mm, 10 "
      "mm, 5 mm]], orientation: 15 deg, spacing: 10 mm}",
      "orientation_study={blanks: [0 deg, 45 deg], friction: [90 deg]}"};
  const Case read = read_case_text(small_stamping, "x.yaml", "", shaped);
  const macroscale::BlankSpec& blank = read.stamping->blank;
  CHECK(blank.shape == macroscale::BlankShape::polygon);
  REQUIRE(blank.polygon.outer.size() == 3);
  CHECK(blank.polygon.outer[0] == macroscale::Point2{-0.16, -0.15});
  REQUIRE(blank.holes.size() == 1);
  CHECK(blank.holes[0].centre == macroscale::Point2{0.0, 0.01});
  CHECK(blank.holes[0].radius == 0.005);
  REQUIRE(read.orientation_study);
  REQUIRE(read.orientation_study->blanks.size() == 2);
  CHECK(read.orientation_study->blanks[1] == Approx(3.0 * blank.orientation));
  const std::string resolved = pipeline::resolved_yaml(read.settings);
  const Case again = read_case_text(resolved, "y.yaml", "");
  CHECK(pipeline::resolved_yaml(again.settings) == resolved);
  CHECK(again.stamping->blank.polygon.outer == blank.polygon.outer);

  const auto ids = [&](const std::string& assignment) {
    const Problems problems = problems_of(small_stamping, {assignment});
    std::vector<std::string> found;
    for (const auto& problem : problems) found.push_back(problem.id);
    return found;
  };
  CHECK(ids("blank.shape=circle") == std::vector<std::string>{"blank.radius.required"});
  CHECK(ids("blank.holes=[[0 mm, 1 mm]]") == std::vector<std::string>{"blank.holes.rows"});
  CHECK(ids("orientation_study={blanks: 0 deg, friction: [0 deg]}") ==
        std::vector<std::string>{"orientation_study.blanks.list"});
  CHECK(ids("orientation_study={blanks: [0 deg, 15 deg, 0 deg], friction: [0 deg]}") ==
        std::vector<std::string>{"orientation_study.blanks.distinct"});
}

TEST_CASE("a map set on the command line replaces the whole map", "[pipeline][config]") {
  const Problems problems = problems_of(small_stamping, {"process.punch={stroke: 50 mm}"});
  REQUIRE(problems.size() == 1);
  CHECK(problems[0].id == "process.punch.time.required");
  CHECK(problems[0].file == "--set #1");
}

TEST_CASE("a problem set on the command line is named by its number", "[pipeline][config]") {
  const Problems problems = problems_of(
      small_cell, {"weave.gap=1 mm", "weave.gap=-1 mm", "weave.gpa=1 mm", "nonsense", "name.first=x",
                   "resin={power_index: &a 0.4}", "weave[0]=1", "resin.power_index=: :"});
  std::vector<std::pair<std::string, std::string>> found;
  for (const Problem& problem : problems) {
    found.emplace_back(problem.file, problem.id);
    CHECK(problem.line == 0);
  }
  CHECK(found == std::vector<std::pair<std::string, std::string>>{{"--set #2", "weave.gap.range"},
                                                                  {"--set #3", "weave.gpa.unknown"},
                                                                  {"--set #4", "set.syntax"},
                                                                  {"--set #5", "name.first.set"},
                                                                  {"--set #6", "resin.power_index.anchor"},
                                                                  {"--set #7", "set.syntax"},
                                                                  {"--set #8", "yaml.syntax"}});
}

TEST_CASE("an effect that is written as off is as good as absent", "[pipeline][config][effect]") {
  const std::string without = pipeline::resolved_yaml(read_case_text(small_stamping, "x.yaml", "").settings);
  const auto resolved = [&](const std::string& effects, const std::vector<std::string>& assignments = {}) {
    const Case read =
        read_case_text(small_stamping + "effects: " + effects + "\n", "x.yaml", "", assignments);
    CHECK(read.notes.empty());
    CHECK_FALSE(read.friction->model.effects.tool_temperature_shift);
    return pipeline::resolved_yaml(read.settings);
  };
  CHECK(resolved("{tool_temperature_shift: off}") == without);
  CHECK(resolved("{tool_temperature_shift: off, static_peak: 'off'}") == without);  // of a later version too
  CHECK(resolved("{tool_temperature_shift: {slope: -9e-4 1/K}}", {"effects.tool_temperature_shift=off"}) ==
        without);
  CHECK(pipeline::resolved_yaml(read_case_text(small_stamping + "effects: {tool_temperature_shift: {slope: 0 "
                                                                "1/K}}\n",
                                               "x.yaml", "")
                                    .settings) != without);  // the comparison can fail

  const auto ids = [](const std::string& effects) {
    std::vector<std::string> found;
    for (const Problem& problem : problems_of(small_stamping + "effects: " + effects + "\n"))
      found.push_back(problem.id);
    return found;
  };
  CHECK(ids("{tool_temperature_shift: on}") ==
        std::vector<std::string>{"effects.tool_temperature_shift.map"});
  CHECK(ids("{tool_temperature_shifd: off}") ==
        std::vector<std::string>{"effects.tool_temperature_shifd.unknown"});
  CHECK(ids("{tool_temperature_shift: {slope: off}}") ==
        std::vector<std::string>{"effects.tool_temperature_shift.slope.unit"});
}

namespace {

/// Values about the ends of a range, as a file holds them; none where there is no end.
struct Ends {
  std::vector<std::string> inside, outside;
};

Ends ends_of(const pipeline::Key& key) {
  const pipeline::Interval range = pipeline::interval_of(key.range, key.unit);
  const bool bounded = std::isfinite(range.low) && std::isfinite(range.high);
  const bool whole = key.type == pipeline::KeyType::integer;
  const double little = whole ? 1.0 : 1e-9 * (bounded ? range.high - range.low : 1.0);
  const auto written = [&](double value) { return write_quantity(value, key.unit); };
  Ends ends;
  if (std::isfinite(range.low)) {
    ends.inside.push_back(written(range.low_open ? range.low + little : range.low));
    ends.outside.push_back(written(range.low_open ? range.low : range.low - little));
  }
  if (std::isfinite(range.high)) {
    ends.inside.push_back(written(range.high_open ? range.high - little : range.high));
    ends.outside.push_back(written(range.high_open ? range.high : range.high + little));
  }
  return ends;
}

bool is_out_of_range(const std::string& path, const std::string& value,
                     std::vector<std::string> assignments) {
  assignments.push_back(path + "=" + value);
  const Problems problems = problems_of(small_stamping, assignments);
  return std::any_of(problems.begin(), problems.end(),
                     [&](const Problem& problem) { return problem.id == path + ".range"; });
}

}  // namespace

// The schema and the room behind it state the same range under the same id: a room that asks for more would
// contradict the reference page.
TEST_CASE("every range is refused beyond its ends, and no room finds a value within them out of range",
          "[pipeline][config]") {
  const std::string law = "friction={law: stribeck, calibration: {plate_area: 0.01 m^2}, ";
  const std::string power = law + "scale: 0.5, exponent: 0.14}";
  std::vector<std::vector<std::string>> cases{
      {"effects={tool_temperature_shift: {slope: 0 1/K}}"},
      {power},
      {law + "form: linear, offset: 0.1, slope: 0.1, reference_hersey: 1}"},
      {power, "resin.temperature_law=wlf"}};
  for (const std::string& id : pipeline::further_laws()) cases.push_back({"friction={law: " + id + "}"});
  for (const std::string& id : pipeline::further_forms())
    if (id != "table") cases.push_back({law + "form: " + id + "}"});
  for (const std::string& id : pipeline::find_key("resin.rheology")->choices)
    cases.push_back({power, "resin.rheology=" + id});
  for (const pipeline::Key& key : pipeline::friction_effect_keys())
    if (key.presence == pipeline::Presence::required) cases.push_back({power, key.path + "=0 " + key.unit});
  std::set<std::string> tried;
  for (const auto& assignments : cases) {
    const Case base = read_case_text(small_stamping, "x.yaml", configs, assignments);
    for (const pipeline::Key& key : pipeline::schema()) {
      const bool number = key.type == pipeline::KeyType::quantity || key.type == pipeline::KeyType::integer;
      if (!number || key.range.empty() || !base.settings.has(key.path) || !tried.insert(key.path).second)
        continue;
      const Ends ends = ends_of(key);
      for (const std::string& value : ends.inside) {
        INFO(key.path << " = " << value);
        CHECK_FALSE(is_out_of_range(key.path, value, assignments));
      }
      for (const std::string& value : ends.outside) {
        INFO(key.path << " = " << value);
        CHECK(is_out_of_range(key.path, value, assignments));
      }
    }
  }
  CHECK(tried.size() > 110);
}

TEST_CASE("keys of a law that is not the chosen one are allowed and noted", "[pipeline][config]") {
  const Case read = read_case_text(
      small_cell + "friction: {law: coulomb, coefficient: 0.3, exponent: 0.14, form: linear}\n", "x.yaml",
      "");
  REQUIRE(read.notes.size() == 2);
  CHECK(read.notes[0].find("friction.form (line 5) is not used: it counts when friction.law is stribeck") ==
        0);
  CHECK(read.notes[1].find("friction.exponent (line 5) is not used") == 0);
  CHECK(std::get<friction::Coulomb>(read.friction->model.law).coefficient == 0.3);

  // They still obey their own rules.
  const Problems problems =
      problems_of(small_cell + "friction: {law: coulomb, coefficient: 0.3, exponent: 3 mm}\n");
  REQUIRE(problems.size() == 1);
  CHECK(problems[0].id == "friction.exponent.unit");
}

TEST_CASE("constants of a law can be given in the place of data", "[pipeline][config]") {
  const std::string start = small_cell + "friction: {law: stribeck, calibration: {plate_area: 100 cm^2}, ";
  const Case power = read_case_text(start + "scale: 0.5, exponent: 0.14}\n", "x.yaml", "");
  CHECK_FALSE(power.friction->calibrated());
  CHECK(std::get<friction::HerseyPower>(power.friction->model.law).scale == 0.5);
  CHECK(power.friction->rig.plate_area == 0.01);
  CHECK(power.friction->rig.plate_area_band == std::array<double, 2>{0.01, 0.01});

  const Case linear = read_case_text(
      start + "form: linear, offset: 0.236, slope: 0.045, reference_hersey: 1}\n", "x.yaml", "");
  CHECK(std::get<friction::HerseyLinear>(linear.friction->model.law).offset == 0.236);
}

TEST_CASE("an effect is on when its key is there", "[pipeline][config]") {
  const std::string friction = "friction: {law: coulomb, coefficient: 0.3}\n";
  CHECK_FALSE(
      read_case_text(small_cell + friction, "x.yaml", "").friction->model.effects.tool_temperature_shift);
  CHECK_FALSE(read_case_text(small_cell + friction + "effects: {}\n", "x.yaml", "")
                  .friction->model.effects.tool_temperature_shift);
  const Case on = read_case_text(
      small_cell + friction + "effects: {tool_temperature_shift: {slope: -1e-3 1/K, form: factor}}\n",
      "x.yaml", "");
  REQUIRE(on.friction->model.effects.tool_temperature_shift);
  CHECK(on.friction->model.effects.tool_temperature_shift->slope == -1e-3);
  CHECK(on.friction->model.effects.tool_temperature_shift->reference == 358.15);
  CHECK(on.friction->model.effects.tool_temperature_shift->form ==
        friction::ToolTemperatureShift::Form::factor);
}

TEST_CASE("stages run when their blocks are there", "[pipeline][config]") {
  CHECK(stage_lines(read_case_text(small_cell, "x.yaml", "")).size() == 1);
  CHECK(stage_lines(read_case_text(small_stamping, "x.yaml", "")).size() == 4);  // with its grid error
  const Case nominal = read_case_text(
      "heddle: 1\nname: x\nfriction: {law: coulomb, coefficient: 0.3, contact_pressure: nominal}\n", "x.yaml",
      "");
  CHECK_FALSE(nominal.cell);  // nothing asks for a weave
  CHECK(nominal.friction);
}

TEST_CASE("a resolved configuration reads back to the same case, bit for bit", "[pipeline][config]") {
  const std::string name = GENERATE("thermostamping", "friction_test", "unit_cell");
  const std::vector<std::string> assignments = {"weave.gap=0.7123456789012345 mm",
                                                "resin.activation_energy=41.9 kJ/mol"};
  const Case first = read_case(configs / (name + ".yaml"), assignments);
  const TemporaryFolder folder("heddle_resolved_" + name);
  write_resolved(first, folder.path());
  const std::string resolved = text_of(folder.path() / "resolved.yaml");
  INFO(resolved);
  CHECK(resolved.find(folder.path().string()) == std::string::npos);  // no absolute paths in results
  CHECK(resolved.find("gap: 0.7123456789012345 mm") != std::string::npos);

  const Case second = read_case(folder.path() / "resolved.yaml");
  check_same_settings(first.settings, second.settings);
  CHECK(first.name == second.name);
  CHECK(stage_lines(first) == stage_lines(second));

  const TemporaryFolder again("heddle_resolved_again_" + name);
  write_resolved(second, again.path());
  CHECK(text_of(again.path() / "resolved.yaml") == resolved);
}

TEST_CASE("the reference page is what the schema says", "[pipeline][config]") {
  // If this fails: heddle check --reference > docs/reference/config.md
  CHECK(text_of(source / "docs/reference/config.md") == pipeline::config_reference());
}
