#pragma once

#include <filesystem>
#include <optional>
#include <string>
#include <vector>

namespace heddle::pipeline {

/// Exit codes of the program.
constexpr int exit_done = 0;
constexpr int exit_failed = 1;
constexpr int exit_bad_input = 2;

/// What the command line says of a case to run.
struct RunOptions {
  std::filesystem::path file;
  std::filesystem::path output = {};          ///< empty: out/NAME
  int threads = 0;                            ///< 0: as many as the machine has
  std::vector<std::string> assignments = {};  ///< of --set, in order
  bool resume = false;                        ///< go on from the last checkpoint
  bool force = false;                         ///< write into a folder that holds another case
  bool quiet = false;                         ///< no progress
  std::filesystem::path cache = {};           ///< folder of stages done before; empty: every stage is run
  double checkpoint_interval = 10.0;  ///< wall time between two checkpoints of a stamping [s]; 0: each step
  bool print = true;                  ///< results on standard output
};

struct CheckOptions {
  std::filesystem::path file;
  std::vector<std::string> assignments = {};
  bool reference = false;  ///< print the page of all keys instead
};

struct CalibrateOptions {
  RunOptions run;
  std::filesystem::path data;  ///< measured coupons
};

struct DiscoverOptions {
  RunOptions run;
  std::filesystem::path data;                      ///< measured coupons
  std::filesystem::path design = {};               ///< planned coupons, in place of measured ones
  std::vector<std::filesystem::path> own_effects;  ///< effect files beside the library
  std::optional<int> seed;
};

struct ExportOptions {
  RunOptions run;      ///< file: a configuration, or the folder of a run or a calibration
  std::string target;  ///< "abaqus", "csv" or "ccx"
  /// Of a formed part: where it is free of stress, and what it cools down to, with unit; empty: by the case.
  std::string stress_free = {}, room = {};
};

/// How a run ended.
struct RunEnding {
  int exit_code = exit_done;
  bool interrupted = false;  ///< by SIGINT or SIGTERM; exit_code is exit_failed
  std::string reason = {};   ///< why it did not come to its end; "" if it did
};
/// The whole chain. @throws InputError  for bad input
RunEnding run_chain(const RunOptions& options);

/// Folder of the results: as asked for, else out/NAME.
std::filesystem::path output_folder(const RunOptions& options, const std::string& name);

/// Each returns an exit code, and throws InputError for bad input.
int run_case(const RunOptions& options);              ///< the whole chain
int weave_case(const RunOptions& options);            ///< unit cell only
int friction_case(const RunOptions& options);         ///< friction test only
int calibrate_case(const CalibrateOptions& options);  ///< numbers of the law from measured coupons
int discover_case(const DiscoverOptions& options);    ///< what the model misses in measured coupons
int plan_coupons(const DiscoverOptions& options);     ///< what planned coupons could tell
int export_case(
    const ExportOptions& options);  ///< friction law, solid cell or formed part as other programs take it
int check_file(const CheckOptions& options);  ///< every problem, or the stages and notes

}  // namespace heddle::pipeline
