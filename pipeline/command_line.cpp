#include "pipeline/command_line.h"

#include <CLI/CLI.hpp>
#include <algorithm>
#include <cstdlib>
#include <iostream>

#include "core/problem.h"

#ifndef HEDDLE_VERSION
#error "HEDDLE_VERSION comes from the build (project version)"
#endif

namespace heddle::pipeline {
namespace {

void add_file(CLI::App& command, std::filesystem::path& file) {
  command.add_option("file", file, "Configuration file (YAML)")->required();
}

/// One assignment a --set: an assignment may hold blanks, commas and brackets, which stay as they are.
void add_assignments(CLI::App& command, std::vector<std::string>& assignments) {
  command
      .add_option("--set", assignments,
                  "Change one key for this run: PATH=VALUE, as in --set weave.gap='1.5 mm'. May be repeated")
      ->expected(1)
      ->multi_option_policy(CLI::MultiOptionPolicy::TakeAll)
      ->type_name("PATH=VALUE");
}

CLI::App* add_run(CLI::App& program, const char* name, const char* help, RunOptions& options) {
  CLI::App* command = program.add_subcommand(name, help);
  add_file(*command, options.file);
  command->add_option("-o,--output", options.output, "Folder of the results (default: out/NAME)");
  command->add_option("-j,--threads", options.threads, "Number of threads (default: all)")
      ->check(CLI::Range(1, 4096));
  add_assignments(*command, options.assignments);
  command->add_flag("--force", options.force, "Write into a folder that holds another case");
  command->add_flag("--quiet", options.quiet, "No progress on standard error");
  return command;
}

CLI::App* add_check(CLI::App& program, CheckOptions& options) {
  CLI::App* command = program.add_subcommand("check", "Find every problem of a file, or say what would run");
  CLI::Option* reference =
      command->add_flag("--reference", options.reference, "Print the page of all configuration keys");
  CLI::Option* file = command->add_option("file", options.file, "Configuration file (YAML)");
  file->excludes(reference);
  add_assignments(*command, options.assignments);
  command->callback([&options] {
    if (options.file.empty() && !options.reference) throw CLI::RequiredError("file");
  });
  return command;
}

void add_export(CLI::App& program, ExportOptions& options) {
  CLI::App* command = program.add_subcommand(
      "export", "The formed part, the friction law, or the solid cell, as another program takes it");
  command
      ->add_option("file", options.run.file,
                   "Configuration file (YAML), or the folder of a run or calibration")
      ->required();
  command
      ->add_option(
          "--to", options.target,
          "ccx: the part of a stamping's folder as a CalculiX deck, of a file the solid cell; abaqus: user "
          "subroutine FRIC_COEF, and of a folder the part; csv: table of mu")
      ->required()
      ->check(CLI::IsMember({"abaqus", "csv", "ccx"}));
  command->add_option("-o,--output", options.run.output,
                      "Folder of the file (default: DIR/export, out/export/NAME)");
  command->add_option(
      "--stress-free", options.stress_free,
      "Of a part: temperature without stress, as '118 degC' (default: thermal.freezing_temperature)");
  command->add_option(
      "--room", options.room,
      "Of a part: temperature it cools down to, as '25 degC' (default: thermal.air.temperature)");
  add_assignments(*command, options.run.assignments);
}

void add_discover(CLI::App& program, DiscoverOptions& options) {
  CLI::App* command = add_run(program, "discover",
                              "What the model misses in measured coupons or stampings, by name", options.run);
  command->add_flag("--resume", options.run.resume,
                    "Go on where an earlier start ended; stampings that the cache holds are never run again");
  CLI::Option* file = command->get_option("file")->required(false);
  CLI::Option* data =
      command
          ->add_option(
              "--data", options.data,
              "Table of coupons, or of stampings where it has punch_force_N (CSV); FILE.yaml beside it "
              "tells of the rig")
          ->check(CLI::ExistingFile);
  CLI::Option* plan = command
                          ->add_option("--plan", options.run.file,
                                       "Configuration file (YAML) of coupons that nobody has pulled yet")
                          ->excludes(file)
                          ->excludes(data);
  CLI::Option* design =
      command
          ->add_option("--design", options.design, "Planned coupons (CSV): factors, or one row a condition")
          ->check(CLI::ExistingFile)
          ->needs(plan);
  plan->needs(design);
  command->callback([file, data, plan] {
    if (plan->count() > 0) return;
    if (file->count() == 0) throw CLI::RequiredError("file");
    if (data->count() == 0) throw CLI::RequiredError("--data");
  });
  command->add_option("--effect", options.own_effects, "Effect file beside the library. May be repeated")
      ->expected(1)
      ->multi_option_policy(CLI::MultiOptionPolicy::TakeAll)
      ->check(CLI::ExistingFile);
  command->add_option("--seed", options.seed, "Of every draw (default: discover.seed)")
      ->check(CLI::Range(0, 2000000000));
}

/// HEDDLE_CACHE names the folder of the cache; `off` switches it off.
std::filesystem::path cache_folder() {
  const char* asked = std::getenv("HEDDLE_CACHE");
  if (asked == nullptr || *asked == '\0') return "out/.cache";
  return std::string(asked) == "off" ? std::filesystem::path() : std::filesystem::path(asked);
}

/// HEDDLE_CHECKPOINT_SECONDS: wall time between two checkpoints.
double checkpoint_interval(double usual) {
  const char* asked = std::getenv("HEDDLE_CHECKPOINT_SECONDS");
  if (asked == nullptr || *asked == '\0') return usual;
  char* end = nullptr;
  const double seconds = std::strtod(asked, &end);
  if (*end != '\0' || !(seconds >= 0.0))
    throw InputError({{"environment.checkpoint_seconds"_rule, "HEDDLE_CHECKPOINT_SECONDS", asked,
                       "must be a number of seconds, 0 or more", "Leave it out for the usual 10."}});
  return seconds;
}

}  // namespace

int dispatch(const std::vector<std::string>& arguments, const Commands& commands) {
  CLI::App program("From the tows of a woven composite to a stamped part.", "heddle");
  program.set_version_flag("--version", std::string("heddle ") + HEDDLE_VERSION);
  program.require_subcommand(1);
  program.footer("`heddle test [ctest arguments]` builds and runs the tests.");

  RunOptions run_options;
  RunOptions weave_options;
  RunOptions friction_options;
  RunOptions study_options;
  CheckOptions check_options;
  CalibrateOptions calibrate_options;
  DiscoverOptions discover_options;
  ExportOptions export_options;
  const CLI::App* run =
      add_run(program, "run", "The whole chain: weave, friction, stamped part", run_options);
  program.get_subcommand("run")->add_flag("--resume", run_options.resume, "Go on from the last checkpoint");
  const CLI::App* check = add_check(program, check_options);
  const CLI::App* weave = add_run(program, "weave", "Unit cell only", weave_options);
  const CLI::App* friction = add_run(program, "friction", "Friction test only", friction_options);
  add_run(program, "calibrate", "Numbers of the friction law from measured coupons", calibrate_options.run)
      ->add_option("--data", calibrate_options.data, "Table of coupons (CSV)")
      ->required()
      ->check(CLI::ExistingFile);
  add_run(program, "study", "What changes do to the unit cell, or to the stamped part", study_options)
      ->footer(
          "What the cache holds is not computed again: the same command goes on after an "
          "interruption.");
  add_discover(program, discover_options);
  add_export(program, export_options);

  try {
    // CLI11 takes a vector from its end.
    std::vector<std::string> reversed(arguments.rbegin(), arguments.rend());
    program.parse(std::move(reversed));
  } catch (const CLI::Success& success) {
    return program.exit(success, std::cout, std::cerr);
  } catch (const CLI::ParseError& error) {
    program.exit(error, std::cout, std::cerr);
    return exit_bad_input;
  }
  for (RunOptions* options : {&run_options, &weave_options, &friction_options, &study_options,
                              &calibrate_options.run, &discover_options.run}) {
    options->cache = cache_folder();
    options->checkpoint_interval = checkpoint_interval(options->checkpoint_interval);
  }
  if (run->parsed()) return commands.run(run_options);
  if (check->parsed()) return commands.check(check_options);
  if (weave->parsed()) return commands.weave(weave_options);
  if (friction->parsed()) return commands.friction(friction_options);
  if (program.got_subcommand("study")) return commands.study(study_options);
  if (program.got_subcommand("export")) return commands.export_law(export_options);
  if (program.got_subcommand("discover")) return commands.discover(discover_options);
  return commands.calibrate(calibrate_options);
}

}  // namespace heddle::pipeline
