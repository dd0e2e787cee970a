#include "store.h"

#include <fmt/format.h>

#include <nlohmann/json.hpp>
#include <stdexcept>

#include "core/sha256.h"
#include "pipeline/outputs.h"

namespace heddle::blind {

namespace {

using nlohmann::ordered_json;
using pipeline::read_file;
using pipeline::write_file;

std::string text(const Manifest& manifest) {
  std::vector<std::string> kinds;
  for (const blindgen::Kind kind : manifest.selection.kinds) kinds.emplace_back(blindgen::name_of(kind));
  const ordered_json object{{"campaign", manifest.campaign},
                            {"seed", manifest.selection.seed},
                            {"kinds", kinds},
                            {"limit", manifest.selection.limit},
                            {"program_sha256", manifest.program_sha256},
                            {"config_sha256", manifest.config_sha256},
                            {"commit", manifest.commit},
                            {"discover_tree", manifest.discover_tree},
                            {"friction_tree", manifest.friction_tree}};
  return object.dump(1) + "\n";
}

std::string text(const Record& record) {
  const ordered_json object{{"number", record.number},
                            {"exit_code", record.exit_code},
                            {"timed_out", record.timed_out},
                            {"wall_s", record.wall_time},
                            {"cpu_s", record.cpu_time},
                            {"peak_memory_MB", record.peak_memory},
                            {"rows", record.rows},
                            {"data_sha256", record.data_sha256},
                            {"report_sha256", record.report_sha256}};
  return object.dump(1) + "\n";
}

Record read_record(const std::string& json) {
  const ordered_json object = ordered_json::parse(json);
  return {.number = object.at("number"),
          .exit_code = object.at("exit_code"),
          .timed_out = object.at("timed_out"),
          .wall_time = object.at("wall_s"),
          .cpu_time = object.at("cpu_s"),
          .peak_memory = object.at("peak_memory_MB"),
          .rows = object.at("rows"),
          .data_sha256 = object.at("data_sha256"),
          .report_sha256 = object.at("report_sha256")};
}

blindgen::Kind kind_of(const std::string& name) {
  const auto kind = blindgen::kind_named(name);
  if (!kind) throw std::runtime_error("campaign.json names an unknown kind " + name);
  return *kind;
}

}  // namespace

void Store::open(const Manifest& wanted) const {
  const auto file = folder_ / "campaign.json";
  if (std::filesystem::exists(file)) {
    Manifest stored = this->manifest();
    stored.commit = wanted.commit;  // a commit that leaves the program alone changes no answer
    if (text(stored) == text(wanted)) return;
    throw std::runtime_error(
        folder_.string() +
        " holds another campaign, or answers of another version of the program: choose another "
        "folder with -o, or remove it");
  }
  if (std::filesystem::exists(folder_) && !std::filesystem::is_empty(folder_)) {
    throw std::runtime_error(folder_.string() +
                             " holds files that are no campaign: choose another folder with -o");
  }
  std::filesystem::create_directories(folder_);
  write_file(file, text(wanted));
}

Manifest Store::manifest() const {
  const auto file = folder_ / "campaign.json";
  if (!std::filesystem::exists(file)) throw std::runtime_error(folder_.string() + " holds no campaign");
  const ordered_json object = ordered_json::parse(read_file(file));
  Manifest manifest{.campaign = object.at("campaign"),
                    .selection = {.seed = object.at("seed"), .limit = object.at("limit")},
                    .program_sha256 = object.at("program_sha256"),
                    .config_sha256 = object.at("config_sha256"),
                    .discover_tree = object.at("discover_tree"),
                    .friction_tree = object.at("friction_tree"),
                    .commit = object.at("commit")};
  for (const std::string name : object.at("kinds")) manifest.selection.kinds.push_back(kind_of(name));
  return manifest;
}

std::filesystem::path Store::folder_of(int number) const {
  return folder_ / "cases" / fmt::format("{:04}", number);
}

std::optional<Record> Store::finished(int number) const {
  const auto file = folder_of(number) / "record.json";
  if (!std::filesystem::exists(file)) return std::nullopt;
  const Record record = read_record(read_file(file));
  const std::string stored = report(number);
  const bool whole = stored.empty() ? record.report_sha256.empty() : sha256(stored) == record.report_sha256;
  if (!whole)
    throw std::runtime_error(file.string() + ": the report beside it is not the one that was stored");
  return record;
}

void Store::keep(const Record& record, const std::string& report) const {
  const auto folder = folder_of(record.number);
  if (!report.empty()) write_file(folder / "report.json", report);
  write_file(folder / "record.json", text(record));  // last: a case is finished once this is there
}

std::string Store::report(int number) const {
  const auto file = folder_of(number) / "report.json";
  return std::filesystem::exists(file) ? read_file(file) : std::string();
}

}  // namespace heddle::blind
