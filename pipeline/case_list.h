#pragma once

#include <filesystem>
#include <string>
#include <utility>
#include <vector>

#include "pipeline/commands.h"

namespace heddle::pipeline {

/// One case of a list: a configuration with changes.
struct ListedCase {
  std::string id;  ///< letters, digits, _ and -; unique in its list: its folder is cases/ID
  std::filesystem::path file;
  std::vector<std::string> assignments = {};  ///< as of --set
};

enum class CaseStatus {
  done,
  failed,       ///< the run stopped; its folder keeps what it reached
  bad_input,    ///< the configuration cannot be run
  interrupted,  ///< by a signal: the list ends here, and the next call goes on in the middle of this case
};

/// As records and tables have it: "done", "bad_input".
std::string name_of(CaseStatus status);

/// What is known of one case: FOLDER/cases/ID.json. No times: those are in cases/ID/manifest.json.
struct CaseRecord {
  std::string id;
  CaseStatus status = CaseStatus::done;
  std::string hash;     ///< of everything the case asks for (case_hash); "" for bad input
  std::string message;  ///< why it is not done; "" where it is
  std::vector<std::pair<std::string, double>>
      results;              ///< numbers of summary.json, "macroscale.peak_punch_force_N"
  bool run_before = false;  ///< found done with the same hash and not run again; not in the file
};

struct CaseListOptions {
  std::filesystem::path folder;       ///< of the list; cases go below
  std::filesystem::path cache = {};   ///< as RunOptions::cache
  int threads = 0;                    ///< as RunOptions::threads
  double checkpoint_interval = 10.0;  ///< as RunOptions::checkpoint_interval [s]
  bool quiet = false;                 ///< no progress on standard error
};

/// Runs the cases one after the other. A case that is done with the same hash is not run again; one that was
/// interrupted goes on from its checkpoint; one that failed or was bad input is tried again, and does not
/// stop the list.
/// @return  one record a case, in the order of the list, up to one that was interrupted
/// @throws InputError  if ids are repeated or cannot name a folder, with every such case
std::vector<CaseRecord> run_case_list(const std::vector<ListedCase>& cases, const CaseListOptions& options);

/// Text of cases/ID.json, and back.
std::string record_json(const CaseRecord& record);
/// @throws InputError  if the text is no record
CaseRecord read_record(const std::string& text, const std::string& file);

}  // namespace heddle::pipeline
