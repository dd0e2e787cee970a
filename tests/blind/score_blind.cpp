#include <CLI/CLI.hpp>
#include <algorithm>
#include <exception>
#include <filesystem>
#include <iostream>

#include "amplitude_chart.h"
#include "case_list.h"
#include "history.h"
#include "judge.h"
#include "pipeline/outputs.h"

/// Scores campaigns of the blind test: figures on standard output, the page docs/blind.md, a line in
/// docs/blind.csv.
namespace {

namespace fs = std::filesystem;
using namespace heddle;

struct Options {
  std::vector<fs::path> folders;
  fs::path page, record, cases;
  std::string date;
  bool need_reports = false;
};

/// Lines are only ever added.
void append(const fs::path& file, const std::string& line) {
  const std::string before = fs::exists(file) ? pipeline::read_file(file) : blind::history_header();
  pipeline::write_file(file, before + line);
}

/// Names of the pages blind-*.md in the folder of this one, without it.
std::vector<std::string> pages_beside(const fs::path& page) {
  std::vector<std::string> names;
  const fs::path folder = page.has_parent_path() ? page.parent_path() : fs::path(".");
  if (!fs::is_directory(folder)) return names;
  for (const auto& entry : fs::directory_iterator(folder)) {
    const std::string name = entry.path().stem().string();
    const bool is_page = entry.path().extension() == ".md" && name.starts_with("blind-");
    if (is_page && entry.path().filename() != page.filename()) names.push_back(name);
  }
  std::ranges::sort(names);
  return names;
}

void write_page(const std::vector<blind::Scored>& campaigns, const fs::path& page) {
  for (const blind::Scored& campaign : campaigns) {
    if (campaign.manifest.campaign != "amplitudes") continue;
    pipeline::write_file(page.parent_path() / blind::amplitude_picture,
                         blind::amplitude_chart(campaign.cases));
  }
  pipeline::write_file(page, blind::page(campaigns, pages_beside(page)));
}

int run(const Options& options) {
  std::vector<blind::Scored> campaigns;
  for (const fs::path& folder : options.folders) campaigns.push_back(blind::judge(blind::Store(folder)));
  for (const blind::Scored& campaign : campaigns) {
    std::cout << blind::summary(campaign);
    if (!options.record.empty()) append(options.record, blind::history_lines(campaign, options.date));
  }
  if (!options.cases.empty()) pipeline::write_file(options.cases, blind::case_list(campaigns));
  if (!options.page.empty()) write_page(campaigns, options.page);
  const bool complete = std::ranges::all_of(
      campaigns, [](const blind::Scored& campaign) { return blind::score(campaign.cases).failed == 0; });
  return options.need_reports && !complete ? 1 : 0;
}

}  // namespace

int main(int count, char** values) {
  CLI::App app("Scores campaigns of the blind test of heddle discover");
  Options options;
  app.add_option("folders", options.folders, "of finished campaigns")
      ->required()
      ->check(CLI::ExistingDirectory);
  app.add_option("--page", options.page, "writes the whole page, for instance docs/blind.md");
  app.add_option("--cases", options.cases, "writes truth and answer of every case as CSV");
  auto* record =
      app.add_option("--record", options.record, "appends a line a campaign, for instance to docs/blind.csv");
  auto* date = app.add_option("--date", options.date, "of the commit: git show -s --format=%cs");
  record->needs(date);
  app.add_flag("--need-reports", options.need_reports, "fail if a case has no report that can be read");
  try {
    app.parse(count, values);
  } catch (const CLI::ParseError& error) {
    return app.exit(error) == 0 ? 0 : 2;  // CLI11 has codes of its own
  }
  try {
    return run(options);
  } catch (const std::exception& error) {
    std::cerr << "score_blind: " << error.what() << "\n";
    return 1;
  }
}
