#pragma once

#include <filesystem>
#include <optional>
#include <string>
#include <vector>

#include "plan.h"

namespace heddle::blind {

/// What is kept of one run of `heddle discover`, apart from its report.
struct Record {
  int number = 0;
  int exit_code = 0;  ///< 128 + signal if one ended it
  bool timed_out = false;
  double wall_time = 0;    ///< [s]
  double cpu_time = 0;     ///< [s]
  double peak_memory = 0;  ///< [MB]
  int rows = 0;            ///< of the data
  std::string data_sha256;
  std::string report_sha256;  ///< empty: there was no report
};

/// What a campaign folder is about. The truth of its cases is nowhere in it.
struct Manifest {
  std::string campaign;
  Selection selection;
  std::string program_sha256, config_sha256;  ///< of the program that answers and of the case it is given
  std::string discover_tree, friction_tree;   ///< git trees of its search and its laws, "none" without
  std::string commit;                         ///< "-dirty" behind it if files were changed
};

/// A folder with campaign.json and, for each finished case, cases/NNNN/{record.json, report.json,
/// discover.log}.
class Store {
 public:
  explicit Store(std::filesystem::path folder) : folder_(std::move(folder)) {}

  /// Makes the folder, or goes on in it.
  /// @throws std::runtime_error  it holds another campaign, or answers of another program
  void open(const Manifest& manifest) const;
  /// @throws std::runtime_error  no campaign there
  Manifest manifest() const;

  std::filesystem::path folder_of(int number) const;
  std::filesystem::path folder() const { return folder_; }
  /// The record of a finished case, if its report has the bytes that were stored.
  std::optional<Record> finished(int number) const;
  /// @param report  text of report.json, empty if there is none
  void keep(const Record& record, const std::string& report) const;
  /// @return  empty if the case left none
  std::string report(int number) const;

 private:
  std::filesystem::path folder_;
};

}  // namespace heddle::blind
