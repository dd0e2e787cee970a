#include "pipeline/case_list.h"

#include <algorithm>
#include <cctype>
#include <iostream>
#include <optional>
#include <set>

#include <fmt/format.h>
#include <nlohmann/json.hpp>

#include "core/problem.h"
#include "core/progress.h"
#include "pipeline/case.h"
#include "pipeline/outputs.h"
#include "pipeline/stage_keys.h"
#include "pipeline/stamping_record.h"

namespace heddle::pipeline {

namespace {

namespace fs = std::filesystem;
using Json = nlohmann::ordered_json;

constexpr std::pair<CaseStatus, const char*> status_names[] = {{CaseStatus::done, "done"},
                                                               {CaseStatus::failed, "failed"},
                                                               {CaseStatus::bad_input, "bad_input"},
                                                               {CaseStatus::interrupted, "interrupted"}};

Problems check(const std::vector<ListedCase>& cases) {
  Problems problems;
  std::set<std::string> seen;
  for (const ListedCase& listed : cases) {
    const auto letter = [](unsigned char c) { return std::isalnum(c) != 0 || c == '_' || c == '-'; };
    if (listed.id.empty() || !std::all_of(listed.id.begin(), listed.id.end(), letter))
      problems.push_back({"cases.id.word"_rule, "cases", listed.id, "cannot name a folder",
                          "Use letters, digits, _ and - for the id of a case."});
    if (!seen.insert(listed.id).second)
      problems.push_back(
          {"cases.id.unique"_rule, "cases", listed.id, "names two cases", "Give each case its own id."});
  }
  return problems;
}

void add_numbers(const Json& node, const std::string& path,
                 std::vector<std::pair<std::string, double>>& out) {
  for (const auto& [key, value] : node.items()) {
    const std::string name = path.empty() ? key : path + "." + key;
    if (value.is_object()) add_numbers(value, name, out);
    if (value.is_number()) out.emplace_back(name, value.get<double>());
  }
}

// The numbers of the parts that were computed; those of a failure are no results.
std::vector<std::pair<std::string, double>> results_in(const fs::path& folder) {
  std::vector<std::pair<std::string, double>> results;
  if (!fs::exists(folder / "summary.json")) return results;
  Json summary = Json::parse(read_file(folder / "summary.json"));
  summary.erase("failure");
  add_numbers(summary, "", results);
  return results;
}

// The record of an earlier call; one that cannot be read counts as none, and its case is run.
std::optional<CaseRecord> record_in(const fs::path& path) {
  if (!fs::exists(path)) return std::nullopt;
  try {
    return read_record(read_file(path), path.string());
  } catch (const InputError& error) {
    std::cerr << error.what();
    return std::nullopt;
  }
}

// Whether a run of the same inputs stands in the folder, to go on with. One of other inputs makes room
// without a word, one that is damaged with one.
bool can_go_on(const Case& a_case, const fs::path& folder) {
  if (!a_case.stamping) return false;
  try {
    return checkpoint_in(folder, inputs_of(ChainStage::macroscale, a_case)).has_value();
  } catch (const InputError& error) {
    if (error.problems()[0].id != "run.resume.changed") std::cerr << error.what();
    return false;
  }
}

CaseRecord run_one(const ListedCase& listed, const CaseListOptions& options) {
  CaseRecord record{listed.id, CaseStatus::done, "", "", {}};
  const fs::path folder = options.folder / "cases" / listed.id;
  try {
    const Case a_case = read_case(listed.file, listed.assignments);
    record.hash = case_hash(a_case);
    const auto before = record_in(folder.string() + ".json");
    if (before && before->status == CaseStatus::done && before->hash == record.hash) {
      CaseRecord same = *before;
      same.run_before = true;
      return same;
    }
    // The folder is the list's own: what another case of this id left there makes room.
    const RunEnding ending = run_chain({.file = listed.file,
                                        .output = folder,
                                        .threads = options.threads,
                                        .assignments = listed.assignments,
                                        .resume = can_go_on(a_case, folder),
                                        .force = true,
                                        .quiet = true,
                                        .cache = options.cache,
                                        .checkpoint_interval = options.checkpoint_interval,
                                        .print = false});
    record.status = ending.interrupted              ? CaseStatus::interrupted
                    : ending.exit_code == exit_done ? CaseStatus::done
                                                    : CaseStatus::failed;
    record.message = ending.reason;
    record.results = results_in(folder);
  } catch (const InputError& error) {
    record.status = CaseStatus::bad_input;
    record.message = error.what();
  } catch (const std::exception& error) {  // one case must not end the list
    record.status = CaseStatus::failed;
    record.message = error.what();
  }
  return record;
}

}  // namespace

std::string name_of(CaseStatus status) {
  for (const auto& [value, name] : status_names)
    if (value == status) return name;
  throw std::logic_error("a status without a name");
}

std::string record_json(const CaseRecord& record) {
  Json results = Json::object();
  for (const auto& [name, value] : record.results) results[name] = value;
  const Json root{{"id", record.id},
                  {"status", name_of(record.status)},
                  {"hash", record.hash},
                  {"message", record.message},
                  {"results", std::move(results)}};
  return root.dump(1) + "\n";
}

CaseRecord read_record(const std::string& text, const std::string& file) {
  try {
    const Json root = Json::parse(text);
    CaseRecord record;
    record.id = root.at("id").get<std::string>();
    const std::string status = root.at("status").get<std::string>();
    const auto* found = std::find_if(std::begin(status_names), std::end(status_names),
                                     [&](const auto& entry) { return entry.second == status; });
    if (found == std::end(status_names)) throw std::runtime_error("there is no status " + status);
    record.status = found->first;
    record.hash = root.at("hash").get<std::string>();
    record.message = root.at("message").get<std::string>();
    for (const auto& [name, value] : root.at("results").items())
      record.results.emplace_back(name, value.get<double>());
    return record;
  } catch (const std::exception& error) {
    throw InputError({{"cases.record"_rule, "", "", fmt::format("is no record of a case: {}", error.what()),
                       "Remove it: the case is run again.", file}});
  }
}

std::vector<CaseRecord> run_case_list(const std::vector<ListedCase>& cases, const CaseListOptions& options) {
  if (Problems problems = check(cases); !problems.empty()) throw InputError(std::move(problems));
  std::vector<CaseRecord> records;
  Progress progress("cases", static_cast<int>(cases.size()), progress_style_of_standard_error(options.quiet),
                    std::cerr);
  for (const ListedCase& listed : cases) {
    records.push_back(run_one(listed, options));
    const CaseRecord& record = records.back();
    write_file(options.folder / "cases" / (record.id + ".json"), record_json(record));
    if (record.status == CaseStatus::interrupted) break;
    progress.update(
        static_cast<int>(records.size()),
        fmt::format("{} {}", record.id, record.run_before ? "was done before" : name_of(record.status)));
  }
  return records;
}

}  // namespace heddle::pipeline
