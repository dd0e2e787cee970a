// Stages done before: what is taken again, what is not, and that it makes no difference to the results.
#include <catch2/catch.hpp>

#include <algorithm>
#include <fstream>
#include <set>

#include "core/sha256.h"
#include "pipeline/cache.h"
#include "pipeline/stage_keys.h"
#include "pipeline/stage_store.h"
#include "pipeline/stamping_record.h"
#include "tests/pipeline/scratch.h"
#include "tests/source_dir.h"

using namespace heddle;
using namespace heddle::test;
using pipeline::ChainStage;

namespace {

pipeline::RunOptions cached(const Scratch& scratch, const std::string& name,
                            std::vector<std::string> settings) {
  pipeline::RunOptions options = options_for(scratch / name, std::move(settings));
  options.cache = scratch / "cache";
  return options;
}

const std::vector<std::string> coulomb = with(small_stamping(), "friction={law: coulomb, coefficient: 0.3}");

/// A valid assignment that gives a key another value than the shipped case has, or "" where there is only one
/// value.
std::string other_value(const pipeline::Key& key, const pipeline::Settings& settings) {
  const pipeline::Setting* now = settings.find(key.path);
  if (now == nullptr || key.type == pipeline::KeyType::file || key.type == pipeline::KeyType::pair) return "";
  if (!key.choices.empty()) {
    for (const std::string& choice : key.choices)
      if (choice != now->text) return choice;
    return "";
  }
  return key.type == pipeline::KeyType::text ? "twill 2/2" : "";
}

}  // namespace

TEST_CASE(
    "a changed weave runs every stage again, a changed binder force the stamping alone, a touched file "
    "nothing",
    "[pipeline][cache][long]") {
  const Scratch scratch;
  warm(scratch / "cache");
  // A copy of the shipped files, which the test may touch.
  fs::copy(fs::path(source_dir) / "configs", scratch / "configs", fs::copy_options::recursive);
  const fs::path config = scratch / "configs/thermostamping.yaml",
                 table = scratch / "configs/data/friction_table4.csv";
  const auto run = [&](const std::string& name, const std::vector<std::string>& settings) {
    pipeline::RunOptions options = cached(scratch, name, settings);
    options.file = config;
    REQUIRE(pipeline::run_case(options) == pipeline::exit_done);
    return reused(scratch / name);
  };
  CHECK(run("first", small_stamping()) == "mesoscale");
  const auto later = fs::file_time_type::clock::now() + std::chrono::hours(1);
  std::ofstream(config, std::ios::app) << "\n# a remark changes nothing\n";
  fs::last_write_time(config, later);
  fs::last_write_time(table, later);
  CHECK(run("touched", small_stamping()) == "mesoscale friction macroscale");
  CHECK(first_difference(contents(scratch / "first"), contents(scratch / "touched")) == "");
  CHECK(run("binder", with(small_stamping(), "process.binder_force=700 N")) == "mesoscale friction");
  CHECK(run("name", with(small_stamping(), "name=other")) == "mesoscale friction macroscale");
  // The friction table is read by its contents: another measured force is another fit.
  std::string text = pipeline::read_file(table);
  const auto digit = text.find_last_of("0123456789");
  text[digit] = text[digit] == '5' ? '6' : '5';
  std::ofstream(table, std::ios::binary) << text;
  CHECK(run("table", small_stamping()) == "mesoscale");
  // Constant mu has nothing to fit, and depends on the weave all the same.
  CHECK(run("coulomb", coulomb) == "mesoscale");
  CHECK(run("weave", with(coulomb, "weave.gap=0.8 mm")) == "");
}

TEST_CASE("stages out of the cache give the same bytes as stages that are run", "[pipeline][cache]") {
  const Scratch scratch;
  REQUIRE(pipeline::run_case(options_for(scratch / "plain", small_stamping())) == pipeline::exit_done);
  warm(scratch / "cache");
  for (const char* name : {"fill", "take"})
    REQUIRE(pipeline::run_case(cached(scratch, name, small_stamping())) == pipeline::exit_done);
  CHECK(reused(scratch / "plain") == "");
  CHECK(reused(scratch / "fill") == "mesoscale");
  CHECK(reused(scratch / "take") == "mesoscale friction macroscale");
  const auto plain = contents(scratch / "plain");
  CHECK(plain.count("macroscale/checkpoint.h5") == 1);
  CHECK(first_difference(plain, contents(scratch / "fill")) == "");
  CHECK(first_difference(plain, contents(scratch / "take")) == "");
}

TEST_CASE("a quarter out of the cache shows the whole blank again", "[pipeline][cache][long]") {
  const Scratch scratch;
  const auto settings = with(small_stamping(), "blank.symmetry=quarter");
  for (const char* name : {"fill", "take"})
    REQUIRE(pipeline::run_case(cached(scratch, name, settings)) == pipeline::exit_done);
  REQUIRE(pipeline::run_case(options_for(scratch / "whole", small_stamping())) == pipeline::exit_done);
  CHECK(reused(scratch / "take") == "mesoscale friction macroscale");
  CHECK(first_difference(contents(scratch / "fill"), contents(scratch / "take")) == "");
  const auto cells = [&](const char* name) {
    const std::string vtu = pipeline::read_file(scratch / name / "macroscale/blank_0000.vtu");
    const auto from = vtu.find("NumberOfPoints");
    return vtu.substr(from, vtu.find('>', from) - from);
  };
  CHECK(cells("take") == cells("whole"));
}

TEST_CASE("an entry that is cut short, changed, foreign or unreadable is said in the log and not used",
          "[pipeline][cache][wrong input]") {
  const Scratch scratch;
  const auto settings = with(coulomb, "blank.grid_error=off");
  warm(scratch / "cache");
  REQUIRE(pipeline::run_case(cached(scratch, "first", settings)) == pipeline::exit_done);
  const auto wanted = contents(scratch / "first");
  std::vector<fs::path> entries;
  for (const auto& entry : fs::directory_iterator(scratch / "cache")) entries.push_back(entry.path());
  REQUIRE(entries.size() == 3);
  std::sort(entries.begin(), entries.end(),
            [](const fs::path& a, const fs::path& b) { return fs::file_size(a) < fs::file_size(b); });
  // Smallest first: the friction stage is cut, a bit of the stamping turns over, the cell becomes someone
  // else's.
  fs::resize_file(entries[0], fs::file_size(entries[0]) - 7);
  std::string bytes = pipeline::read_file(entries[1]);
  bytes[bytes.size() / 2] = static_cast<char>(bytes[bytes.size() / 2] ^ 4);
  std::ofstream(entries[1], std::ios::binary) << bytes;
  fs::remove(entries[2]);
  fs::copy_file(entries[0], entries[2]);
  REQUIRE(pipeline::run_case(cached(scratch, "second", settings)) == pipeline::exit_done);
  CHECK(reused(scratch / "second") == "");
  CHECK(first_difference(wanted, contents(scratch / "second")) == "");
  const std::string log = pipeline::read_file(scratch / "second/log.txt");
  std::size_t refusals = 0;
  for (std::size_t at = log.find("is not used"); at != std::string::npos;
       at = log.find("is not used", at + 1))
    ++refusals;
  CHECK(refusals == 3);
  // The entries were written anew.
  REQUIRE(pipeline::run_case(cached(scratch, "third", settings)) == pipeline::exit_done);
  CHECK(reused(scratch / "third") == "mesoscale friction macroscale");
}

TEST_CASE("an entry under the name of another key is not taken for it", "[pipeline][cache][wrong input]") {
  const Scratch scratch;
  std::string said;
  const pipeline::Cache cache(scratch / "cache", [&](const std::string& line) { said += line; });
  Hdf5Writer file;
  file.write("/key", "one");
  cache.store("two", file.finish());
  const auto read = [](const Hdf5Reader& f) { return f.text("/key"); };
  CHECK_FALSE(cache.find("two", read));
  CHECK_THAT(said, Catch::Contains("another key"));
  CHECK_FALSE(cache.find("three", read));
  const pipeline::Cache off({}, [](const std::string&) {});
  off.store("one", "anything");
  CHECK_FALSE(off.find("one", read));
}

TEST_CASE("a full cache loses what was longest out of use", "[pipeline][cache]") {
  const Scratch scratch;
  const auto entry = [](const std::string& key) {
    Hdf5Writer file;
    file.write("/key", key);
    file.write("/values", std::vector<double>(1000, 1.0));
    return file.finish();
  };
  const auto size = entry("a").size();
  const pipeline::Cache cache(
      scratch / "cache", [](const std::string&) {}, 3 * size);
  const auto now = fs::file_time_type::clock::now();
  int age = 10;
  for (const char* key : {"a", "b", "c"}) {
    cache.store(key, entry(key));
    fs::last_write_time(scratch / "cache" / key, now - std::chrono::hours(age--));
  }
  const auto read = [](const Hdf5Reader& f) { return f.text("/key"); };
  CHECK(cache.find("a", read) == "a");  // in use again: b is now the oldest
  cache.store("d", entry("d"));
  CHECK(cache.find("a", read));
  CHECK_FALSE(cache.find("b", read));
  CHECK(cache.find("c", read));
  CHECK(cache.find("d", read));
}

TEST_CASE("a cache that cannot be written to costs a line in the log and no run",
          "[pipeline][cache][wrong input]") {
  const Scratch scratch;
  std::ofstream(scratch / "cache") << "a file where the folder should be";
  std::string said;
  const pipeline::Cache cache(scratch / "cache", [&](const std::string& line) { said += line; });
  CHECK_NOTHROW(cache.store("key", "bytes"));
  CHECK_THAT(said, Catch::Contains("cache: nothing was kept"));
  CHECK_FALSE(cache.find("key", [](const Hdf5Reader& f) { return f.text("/key"); }));
}

TEST_CASE("every key of the configuration is in the key of a stage, but for those that change no result",
          "[pipeline][cache]") {
  const auto& idle = pipeline::keys_without_effect();
  const std::vector<ChainStage> stages{ChainStage::mesoscale,  ChainStage::solid,
                                       ChainStage::friction,   ChainStage::friction_rig,
                                       ChainStage::macroscale, ChainStage::grid_error};
  for (const pipeline::Key& key : pipeline::schema()) {
    INFO(key.path);
    const bool read =
        std::any_of(stages.begin(), stages.end(), [&](ChainStage s) { return pipeline::reads(s, key); });
    if (key.stage == pipeline::Stage::calibrate || key.stage == pipeline::Stage::discover ||
        key.stage == pipeline::Stage::study) {  // no cache stands before
      CHECK_FALSE(read);
      continue;
    }
    CHECK(read != (std::find(idle.begin(), idle.end(), key.path) != idle.end()));
  }
  CHECK(idle == std::vector<std::string>{"heddle", "name", "orientation_study.blanks",
                                         "orientation_study.friction", "stamping_study.binder_force",
                                         "stamping_study.speed_scale", "stamping_study.models",
                                         "stamping_study.vary"});
}

TEST_CASE("the key of a stage moves with what it reads and with nothing else", "[pipeline][cache]") {
  const fs::path file = fs::path(source_dir) / "configs/thermostamping.yaml";
  const auto keys = [&](const std::vector<std::string>& settings) {
    const pipeline::Case a_case = pipeline::read_case(file, settings);
    return std::array{pipeline::inputs_of(ChainStage::mesoscale, a_case).key(),
                      pipeline::inputs_of(ChainStage::friction, a_case).key(),
                      pipeline::inputs_of(ChainStage::macroscale, a_case).key(),
                      pipeline::inputs_of(ChainStage::grid_error, a_case).key()};
  };
  const auto base = keys({});
  const auto moved = [&](const std::string& setting) {
    const auto now = keys({setting});
    std::string text;
    for (std::size_t k = 0; k < base.size(); ++k) text += now[k] == base[k] ? '.' : 'X';
    return text;
  };
  CHECK(moved("name=other") == "....");
  CHECK(moved("calibrate={loss: huber, prior: {resin: {power_index: [0.38, 0.02]}}}") == "....");
  CHECK(moved("weave.gap=0.75 mm") == "....");
  CHECK(moved("weave.gap=750 um") == "....");  // the same number
  CHECK(moved("weave.gap=0.7500000000000001 mm") == "XXXX");
  CHECK(moved("resin.power_index=0.39") == "XXXX");
  CHECK(moved("cell={state: compacted, thickness: 1 mm}") == "XXXX");
  CHECK(moved("friction.form=linear") == ".XXX");
  CHECK(moved("effects.tool_temperature_shift.reference=86 degC") == ".XXX");
  CHECK(moved("process.binder_force=651 N") == "..XX");
  CHECK(moved("artefact.mass_scaling=2") == "..XX");
  CHECK(moved("blank.size=[320 mm, 321 mm]") == "..XX");
  CHECK(moved("tools.binder.mass=21 kg") == "..XX");
  CHECK(moved("tools.binder={shape: ring, inner_radius: 92 mm, control: gap, gap: 1.4 mm}") == "..XX");
  CHECK(moved("blank={shape: circle, radius: 160 mm, spacing: 4.5 mm}") == "..XX");
  CHECK(moved("blank.grid_error=off") == "...X");
  CHECK(moved("blank.holes=[[0 mm, 120 mm, 8 mm]]") == "..XX");
  // Every key with another legal choice.
  const pipeline::Case a_case = pipeline::read_case(file, {});
  for (const pipeline::Key& key : pipeline::schema()) {
    const std::string other = other_value(key, a_case.settings);
    if (other.empty() || key.path == "friction.law" || key.path == "effects.tool_temperature_shift.slope" ||
        key.path == "blank.shape" || key.path == "cell.state" ||
        key.path == "tools.binder.control")  // choices that ask for other keys beside them
      continue;
    INFO(key.path << "=" << other);
    CHECK(moved(key.path + "=" + other).back() == 'X');
  }
}

TEST_CASE("what only the rig reads moves the key of the rig and not that of the law", "[pipeline][cache]") {
  const fs::path file = fs::path(source_dir) / "configs/friction_test.yaml";
  const auto keys = [&](const std::vector<std::string>& settings) {
    const pipeline::Case a_case = pipeline::read_case(file, settings);
    return std::array{pipeline::inputs_of(ChainStage::friction, a_case).key(),
                      pipeline::inputs_of(ChainStage::friction_rig, a_case).key()};
  };
  const auto base = keys({});
  for (const char* setting : {"drive.stiffness=2e6 N/m", "sample.slack=1 mm", "normal=cam",
                              "sampling_rate=50 1/s", "finite_elements=off", "bend.angle=10 deg"}) {
    INFO(setting);
    const auto now = keys({std::string("friction_test.rig.") + setting});
    CHECK(now[0] == base[0]);
    CHECK(now[1] != base[1]);
  }
  // The law's own test reads these as well, where it has a memory.
  for (const char* setting : {"pull_length=40 mm", "dwell=1 s"}) {
    const auto now = keys({std::string("friction_test.rig.") + setting});
    CHECK(now[0] != base[0]);
    CHECK(now[1] != base[1]);
  }
}

TEST_CASE("the build hashes the sources as they stand", "[pipeline][cache]") {
  const fs::path root = source_dir;
  std::vector<std::string> files;
  for (const auto& entry : fs::recursive_directory_iterator(root / "friction"))
    if (entry.path().extension() == ".h" || entry.path().extension() == ".cpp")
      files.push_back(fs::relative(entry.path(), root).string());
  std::sort(files.begin(), files.end());
  std::string text;
  for (const std::string& file : files) text += file + " " + sha256(pipeline::read_file(root / file)) + "\n";
  const auto& hashes = pipeline::source_hashes();
  const auto friction =
      std::find_if(hashes.begin(), hashes.end(), [](const auto& entry) { return entry.first == "friction"; });
  REQUIRE(friction != hashes.end());
  CHECK(friction->second == sha256(text));
  std::set<std::string> different;
  for (const auto& [name, hash] : hashes) different.insert(hash);
  CHECK(different.size() == hashes.size());
}

TEST_CASE("what differs between two sets of inputs is said in words", "[pipeline][cache]") {
  using pipeline::differences;
  CHECK(differences("a = 1\nb = 2\n", "a = 1\nb = 2\n").empty());
  const auto lines =
      differences("process.binder_force = 650 N\ndata = sha256 aa\nsources.core = 11\nold = 1\n",
                  "process.binder_force = 700 N\ndata = sha256 bb\nsources.core = 22\nnew = 1\n");
  CHECK(lines == std::vector<std::string>{"data holds other contents", "new is new",
                                          "process.binder_force was 650 N, is 700 N",
                                          "sources.core (this program) changed", "old = 1 is gone"});
}
