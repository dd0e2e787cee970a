#include <fmt/format.h>

#include <CLI/CLI.hpp>
#include <algorithm>
#include <array>
#include <cstdio>
#include <exception>
#include <iostream>
#include <memory>
#include <stdexcept>

#include "core/progress.h"
#include "core/sha256.h"
#include "pipeline/interrupt.h"
#include "pipeline/outputs.h"
#include "run.h"

/// Runs a campaign of the blind test: makes the data of each case, has `heddle discover` answer, keeps the
/// report.
namespace {

namespace fs = std::filesystem;
using namespace heddle;

struct Options {
  std::string campaign;
  fs::path folder, repository = fs::current_path();
  blind::Selection selection;
  std::vector<std::string> kinds;
  blind::RunOptions run;
};

/// First line that a git command prints, or nothing if it fails.
std::optional<std::string> git(const fs::path& repository, const std::string& arguments) {
  const std::string command = "git -C '" + repository.string() + "' " + arguments + " 2>/dev/null";
  const std::unique_ptr<FILE, int (*)(FILE*)> pipe(popen(command.c_str(), "r"), pclose);
  if (!pipe) return std::nullopt;
  std::string output;
  std::array<char, 256> buffer{};
  while (std::fgets(buffer.data(), buffer.size(), pipe.get())) output += buffer.data();
  const std::string line = output.substr(0, output.find('\n'));
  return line.empty() ? std::nullopt : std::optional(line);
}

blind::Manifest manifest_of(Options& options) {
  blind::Manifest manifest;
  manifest.campaign = options.campaign;
  manifest.discover_tree =
      git(options.repository, "rev-parse -q --verify HEAD:pipeline/discover").value_or("none");
  manifest.friction_tree = git(options.repository, "rev-parse -q --verify HEAD:friction").value_or("none");
  const bool changed = git(options.repository, "status --porcelain -uno").has_value();
  manifest.commit =
      git(options.repository, "rev-parse --short=12 HEAD").value_or("none") + (changed ? "-dirty" : "");
  if (options.campaign == "acceptance") {
    if (git(options.repository, "status --porcelain -- pipeline friction core configs")) {
      throw std::runtime_error("acceptance wants the committed program: git status shows changes in it");
    }
    options.selection.seed = blind::acceptance_seed(manifest.discover_tree, manifest.friction_tree);
  }
  manifest.selection = options.selection;
  manifest.program_sha256 = sha256(pipeline::read_file(options.run.program));
  manifest.config_sha256 = sha256(pipeline::read_file(options.run.config));
  return manifest;
}

void describe(CLI::App& app, Options& options) {
  std::vector<std::string> names;
  std::string list = "one of";
  for (const auto& [name, purpose] : blind::campaigns()) {
    names.emplace_back(name);
    list += fmt::format("\n  {}: {}", name, purpose);
  }
  options.run.config = "configs/discover/friction.yaml";
  app.add_option("campaign", options.campaign, list)->required()->check(CLI::IsMember(names));
  app.add_option("-o", options.folder, "folder of the campaign; one that is there already goes on")
      ->required();
  app.add_option("--program", options.run.program, "heddle")->required()->check(CLI::ExistingFile);
  app.add_option("--config", options.run.config, "case given to discover")->check(CLI::ExistingFile);
  app.add_option("-j", options.run.processes, "cases at a time")->check(CLI::PositiveNumber);
  app.add_option("--seed", options.selection.seed, "1 to 999; acceptance takes its own from git");
  app.add_option("--limit", options.selection.limit, "first cases only")->check(CLI::PositiveNumber);
  app.add_option("--kinds", options.kinds, "single, null, null_exact, pair, outside, rig")->delimiter(',');
  app.add_option("--time-limit", options.run.time_limit, "of one case [s]")->check(CLI::PositiveNumber);
  app.add_flag("--keep-data", options.run.keep_data, "leave data and all outputs of each case");
}

void check(Options& options) {
  for (const std::string& name : options.kinds) {
    const auto kind = blindgen::kind_named(name);
    if (!kind) throw std::invalid_argument("--kinds knows no \"" + name + "\"");
    options.selection.kinds.push_back(*kind);
  }
  const bool seed_is_free = options.campaign == "acceptance";
  if (!seed_is_free && (options.selection.seed < 1 || options.selection.seed > 999)) {
    throw std::invalid_argument("--seed is 1 to 999; larger ones belong to acceptance");
  }
  options.run.program = fs::absolute(options.run.program);
  options.run.config = fs::absolute(options.run.config);
  options.folder = fs::absolute(options.folder);
}

int run(Options& options) {
  check(options);
  const blind::Store store(options.folder);
  const blind::Manifest manifest = manifest_of(options);
  store.open(manifest);
  const auto cases = blind::plan(options.campaign, manifest.selection);
  const auto left = static_cast<int>(
      std::ranges::count_if(cases, [&](const auto& planned) { return !store.finished(planned.number); }));
  const pipeline::InterruptGuard guard;
  blind::RunSummary summary;
  if (left > 0) {
    Progress progress(options.campaign, left, progress_style_of_standard_error(false), std::cerr);
    summary = blind::run_cases(
        store, cases, options.run, pipeline::InterruptGuard::interrupted, [&](const blind::RunSummary& now) {
          progress.update(now.finished, fmt::format("{} without report", now.without_report));
        });
  }
  std::cerr << fmt::format("{}: {} of {} cases have their answer, {} of this run without a report\n",
                           options.campaign, static_cast<int>(cases.size()) - left + summary.finished,
                           cases.size(), summary.without_report);
  if (!summary.stopped) return 0;
  std::cerr << "stopped; the same command goes on from here\n";
  return 1;
}

}  // namespace

int main(int count, char** values) {
  CLI::App app("Runs a campaign of the blind test of heddle discover");
  Options options;
  describe(app, options);
  try {
    app.parse(count, values);
  } catch (const CLI::ParseError& error) {
    return app.exit(error) == 0 ? 0 : 2;  // CLI11 has codes of its own
  }
  try {
    return run(options);
  } catch (const std::invalid_argument& error) {
    std::cerr << "blind_campaign: " << error.what() << "\n";
    return 2;
  } catch (const std::exception& error) {
    std::cerr << "blind_campaign: " << error.what() << "\n";
    return 1;
  }
}
