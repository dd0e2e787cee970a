// Runs that are killed, stopped or broken, as the user meets them: through the built program.
#include <catch2/catch.hpp>

#include <fcntl.h>
#include <signal.h>
#include <sys/wait.h>

#include <chrono>
#include <fstream>
#include <random>
#include <thread>

#include "core/problem.h"
#include "pipeline/stage_keys.h"
#include "pipeline/stamping_record.h"
#include "tests/pipeline/scratch.h"
#include "tests/source_dir.h"

using namespace heddle;
using namespace heddle::test;

namespace {

/// How a program of ours ended, and what it said.
struct Ended {
  int exit_code = -1;  ///< -1: by a signal
  double seconds = 0.0;
  std::string said;  ///< standard error
};

/// A run of the built program, with a checkpoint after each step.
class Program {
 public:
  Program(const Scratch& scratch, const std::string& folder, std::vector<std::string> more = {},
          const std::vector<std::string>& settings = small_stamping())
      : errors_(scratch / (folder + ".stderr")), start_(std::chrono::steady_clock::now()) {
    std::vector<std::string> words{HEDDLE_PROGRAM,
                                   "run",
                                   std::string(source_dir) + "/configs/thermostamping.yaml",
                                   "-o",
                                   (scratch / folder).string(),
                                   "--quiet"};
    for (const std::string& setting : settings) words.insert(words.end(), {"--set", setting});
    words.insert(words.end(), more.begin(), more.end());
    std::vector<std::string> variables{"HEDDLE_CACHE=" + (scratch / "cache").string(),
                                       "HEDDLE_CHECKPOINT_SECONDS=0", "OPENBLAS_NUM_THREADS=1"};
    for (char** variable = environ; *variable != nullptr; ++variable)
      if (std::string(*variable).rfind("HEDDLE_", 0) != 0) variables.emplace_back(*variable);
    std::vector<char*> arguments, environment;
    for (std::string& word : words) arguments.push_back(word.data());
    for (std::string& variable : variables) environment.push_back(variable.data());
    arguments.push_back(nullptr);
    environment.push_back(nullptr);
    process_ = fork();
    if (process_ == 0) {
      const int nothing = open("/dev/null", O_WRONLY),
                errors = open(errors_.c_str(), O_WRONLY | O_CREAT | O_TRUNC, 0644);
      dup2(nothing, 1);
      dup2(errors, 2);
      execve(arguments[0], arguments.data(), environment.data());
      _exit(127);
    }
  }

  void send(int signal) const { kill(process_, signal); }
  bool running() { return !reaped_ && !(reaped_ = waitpid(process_, &status_, WNOHANG) == process_); }
  Ended wait() {
    if (!reaped_) waitpid(process_, &status_, 0);
    reaped_ = true;
    Ended ended;
    ended.exit_code = WIFEXITED(status_) ? WEXITSTATUS(status_) : -1;
    ended.seconds = std::chrono::duration<double>(std::chrono::steady_clock::now() - start_).count();
    ended.said = pipeline::read_file(errors_);
    return ended;
  }

 private:
  fs::path errors_;
  std::chrono::steady_clock::time_point start_;
  pid_t process_ = -1;
  int status_ = 0;
  bool reaped_ = false;
};

void pause_for(double seconds) {
  std::this_thread::sleep_for(std::chrono::duration<double>(seconds));
}

/// Waits until a run has left its first checkpoint, or has ended.
void wait_for_checkpoint(Program& program, const fs::path& folder) {
  while (program.running() && !fs::exists(folder / pipeline::checkpoint_name)) pause_for(0.002);
}

/// Of a run in this process, with the unit cell there already.
pipeline::RunOptions warm_options(const Scratch& scratch, std::vector<std::string> settings) {
  pipeline::RunOptions options = options_for(scratch / "run", std::move(settings));
  options.cache = scratch / "cache";
  warm(options.cache);
  return options;
}

void remove_stamping_of(const Scratch& scratch, const std::string& key) {
  fs::remove(scratch / "cache" / key);
}

std::string stamping_key(const std::vector<std::string>& settings) {
  return pipeline::inputs_of(pipeline::ChainStage::macroscale,
                             pipeline::read_case(options_for("", settings).file, settings))
      .key();
}

/// Kills a run again and again at random moments, each time going on, until one comes to its end.
void kill_and_resume(int kills, unsigned seed, const std::vector<std::string>& more = {}) {
  const Scratch scratch;
  auto settings = with(small_stamping(), "process.steps=12");
  settings.insert(settings.end(), more.begin(), more.end());
  warm(scratch / "cache");
  // The undisturbed run also leaves cell and friction in the cache: what is killed below is the stamping.
  const Ended whole = Program(scratch, "whole", {}, settings).wait();
  REQUIRE(whole.exit_code == 0);
  const auto wanted = contents(scratch / "whole");
  const std::string key = stamping_key(settings);
  remove_stamping_of(scratch, key);
  const Ended again = Program(scratch, "again", {}, settings).wait();
  REQUIRE(again.exit_code == 0);
  CHECK(first_difference(wanted, contents(scratch / "again")) == "");
  std::mt19937 random(seed);
  std::uniform_real_distribution<double> moment(0.0, again.seconds);
  int killed = 0, resumed_in_the_middle = 0;
  while (killed < kills) {
    remove_stamping_of(scratch, key);
    fs::remove_all(scratch / "run");
    for (bool ended = false; !ended;) {
      Program program(scratch, "run", {"--resume"}, settings);
      // Any moment of the run, and for every other kill one after its first checkpoint.
      if (killed < kills) {
        if (killed % 2 == 0) wait_for_checkpoint(program, scratch / "run");
        pause_for(killed % 2 == 0 ? 0.3 * moment(random) : moment(random));
        if (program.running()) program.send(SIGKILL), ++killed;
      }
      const Ended end = program.wait();
      ended = end.exit_code >= 0;
      if (ended) REQUIRE(end.exit_code == 0);
      resumed_in_the_middle += end.said.find("going on from step") != std::string::npos;
    }
    CHECK(first_difference(wanted, contents(scratch / "run")) == "");
  }
  CHECK(resumed_in_the_middle > 0);
}

}  // namespace

TEST_CASE("a run killed at random moments goes on to the bytes of an undisturbed one", "[pipeline][resume]") {
  kill_and_resume(2, 7);
}

TEST_CASE("a run whose friction remembers its slip, killed, goes on to the bytes of an undisturbed one",
          "[pipeline][resume][friction]") {
  kill_and_resume(1, 11,
                  {"friction={law: slip_resistance, slip_resistance: {length: 2 mm, rate_exponent: 0.05}}",
                   "effects={dwell_ageing: {amplitude: 0.1}, wear: {amplitude: 0.2}}"});
}

TEST_CASE("a run killed at ten random moments goes on to the bytes of an undisturbed one",
          "[pipeline][resume][slow]") {
  kill_and_resume(10, 20261124);
}

TEST_CASE("SIGTERM and SIGINT leave a checkpoint and say how to go on", "[pipeline][resume]") {
  const Scratch scratch;
  const auto settings = with(small_stamping(), "process.steps=12");
  warm(scratch / "cache");
  REQUIRE(Program(scratch, "whole", {}, settings).wait().exit_code == 0);
  for (const int signal : {SIGTERM, SIGINT}) {
    remove_stamping_of(scratch, stamping_key(settings));
    fs::remove_all(scratch / "run");
    Program program(scratch, "run", {}, settings);
    wait_for_checkpoint(program, scratch / "run");
    program.send(signal);
    const Ended stopped = program.wait();
    CHECK(stopped.exit_code == 1);
    CHECK_THAT(stopped.said, Catch::Contains("interrupted at step") && Catch::Contains("of 12") &&
                                 Catch::Contains("go on with: heddle run") && Catch::Contains("--resume") &&
                                 Catch::Contains("--set 'blank.spacing=32 mm'"));
    CHECK(fs::exists(scratch / "run/macroscale/checkpoint.h5"));
    CHECK(fs::exists(scratch / "run/macroscale/history.csv"));
    CHECK_FALSE(fs::exists(scratch / "run/summary.json"));
    const Ended resumed = Program(scratch, "run", {"--resume"}, settings).wait();
    CHECK(resumed.exit_code == 0);
    CHECK_THAT(resumed.said, Catch::Contains("going on from step"));
    CHECK(first_difference(contents(scratch / "whole"), contents(scratch / "run")) == "");
  }
  // Without --resume it starts over, and says that it need not have.
  remove_stamping_of(scratch, stamping_key(settings));
  fs::remove_all(scratch / "run");
  Program program(scratch, "run", {}, settings);
  wait_for_checkpoint(program, scratch / "run");
  program.send(SIGINT);
  CHECK(program.wait().exit_code == 1);
  const Ended over = Program(scratch, "run", {}, settings).wait();
  CHECK(over.exit_code == 0);
  CHECK_THAT(over.said,
             Catch::Contains("starts from the beginning") && Catch::Contains("--resume would have gone on"));
}

TEST_CASE(
    "a complete run that is resumed changes nothing, and without a checkpoint it starts from the beginning",
    "[pipeline][resume]") {
  const Scratch scratch;
  auto options = warm_options(scratch, small_stamping());
  options.resume = true;
  REQUIRE(pipeline::run_case(options) == pipeline::exit_done);  // an empty folder
  const auto before = contents(scratch / "run");
  const std::string manifest = pipeline::read_file(scratch / "run/manifest.json");
  const auto time = fs::last_write_time(scratch / "run/report.html");
  CHECK(pipeline::run_case(options) == pipeline::exit_done);
  CHECK(first_difference(before, contents(scratch / "run")) == "");
  CHECK(pipeline::read_file(scratch / "run/manifest.json") == manifest);
  CHECK(fs::last_write_time(scratch / "run/report.html") == time);
  // A report that is gone is written again, out of the checkpoint.
  fs::remove(scratch / "run/report.html");
  CHECK(pipeline::run_case(options) == pipeline::exit_done);
  CHECK(first_difference(before, contents(scratch / "run")) == "");
}

namespace {

std::string rule_broken_by(const pipeline::RunOptions& options) {
  try {
    pipeline::run_case(options);
  } catch (const InputError& error) {
    return error.problems().front().id;
  }
  return "";
}

}  // namespace

TEST_CASE("going on with other inputs is refused and names what changed, and a damaged checkpoint too",
          "[pipeline][resume][wrong input]") {
  const Scratch scratch;
  const auto settings = with(small_stamping(), "process.steps=2");
  REQUIRE(pipeline::run_case(warm_options(scratch, settings)) == pipeline::exit_done);
  const auto before = contents(scratch / "run");
  auto changed = warm_options(scratch, with(settings, "process.binder_force=700 N"));
  changed.resume = true;
  CHECK_THROWS_WITH(
      pipeline::run_case(changed),
      Catch::Contains("process.binder_force was 650 N, is 700 N") && Catch::Contains("without --resume"));
  CHECK(rule_broken_by(changed) == "run.resume.changed");
  CHECK(first_difference(before, contents(scratch / "run")) == "");  // nothing was touched

  auto same = warm_options(scratch, settings);
  same.resume = true;
  const fs::path checkpoint = scratch / "run" / pipeline::checkpoint_name;
  std::string bytes = pipeline::read_file(checkpoint);
  bytes[bytes.size() / 3] = static_cast<char>(bytes[bytes.size() / 3] ^ 1);
  std::ofstream(checkpoint, std::ios::binary) << bytes;
  CHECK_THROWS_WITH(pipeline::run_case(same),
                    Catch::Contains("checkpoint.h5") && Catch::Contains("do not match their hash"));
  fs::resize_file(checkpoint, 100);
  CHECK_THROWS_WITH(pipeline::run_case(same),
                    Catch::Contains("cut short") && Catch::Contains("without --resume"));
  CHECK(rule_broken_by(same) == "run.resume.damaged");
  same.resume = false;
  CHECK(pipeline::run_case(same) == pipeline::exit_done);
  CHECK(first_difference(before, contents(scratch / "run")) == "");
}

TEST_CASE("a run that fails keeps its state, its worst nodes, its energies and a picture of the last iterate",
          "[pipeline][resume]") {
  const Scratch scratch;
  auto options = warm_options(scratch, with(small_stamping(), softest_fabric(scratch / "softest.csv")));
  REQUIRE(pipeline::run_case(options) == pipeline::exit_failed);
  const std::string summary = pipeline::read_file(scratch / "run/summary.json");
  for (const char* key : {"\"failure\": {", "\"reason\"", "\"advice\"", "\"worst\"", "\"residual_N\"",
                          "\"energies\"", "\"compaction_J\"", "\"time_step_s\""})
    CHECK_THAT(summary, Catch::Contains(key));
  CHECK(fs::exists(scratch / "run/macroscale/blank_last.vtu"));
  CHECK_THAT(pipeline::read_file(scratch / "run/macroscale/blank_failed.vtu"), Catch::Contains("residual_N"));
}

TEST_CASE("a faulty interval between checkpoints is bad input", "[pipeline][resume][wrong input]") {
  const Scratch scratch;
  const std::string command = std::string("HEDDLE_CACHE=off HEDDLE_CHECKPOINT_SECONDS=soon ") +
                              HEDDLE_PROGRAM + " run " + source_dir + "/configs/thermostamping.yaml -o " +
                              (scratch / "run").string() + " 2>" + (scratch / "said").string();
  const int status = std::system(command.c_str());
  CHECK(WEXITSTATUS(status) == pipeline::exit_bad_input);
  CHECK_THAT(pipeline::read_file(scratch / "said"), Catch::Contains("HEDDLE_CHECKPOINT_SECONDS = soon"));
  CHECK_FALSE(fs::exists(scratch / "run"));
}
