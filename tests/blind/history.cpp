#include "history.h"

#include <fmt/format.h>

#include <algorithm>
#include <utility>

namespace heddle::blind {

namespace {

using Columns = std::vector<std::pair<std::string, std::string>>;

std::string share(const Rate& rate) {
  return rate.of > 0 ? fmt::format("{:.4f}", rate.value()) : "";
}

void add_rate(Columns& columns, const std::string& name, const Rate& rate) {
  columns.emplace_back(name, share(rate));
  columns.emplace_back(name + "_of", std::to_string(rate.of));
}

std::string passes(const Scores& scores) {
  std::string letters;
  for (const Requirement& r : requirements(scores)) letters += !r.holds ? '-' : *r.holds ? 'y' : 'n';
  return letters;
}

std::string follow_up_name(FollowUp follow_up) {
  if (follow_up == FollowUp::proposed) return "three proposed";
  return follow_up == FollowUp::random ? "three random" : "none";
}

std::string campaign_name(const Manifest& m, const Setting& setting) {
  if (setting.ablation == 0) return m.campaign;
  return fmt::format("{} without {}", m.campaign, ablations().at(setting.ablation).without);
}

Columns identity(const Manifest& m, const Setting& setting, const std::string& date) {
  return {{"date", date},
          {"commit", m.commit},
          {"campaign", campaign_name(m, setting)},
          {"seed", std::to_string(m.selection.seed)},
          {"discover_tree", m.discover_tree.substr(0, 8)},
          {"friction_tree", m.friction_tree.substr(0, 8)},
          {"design", std::string(blindgen::name_of(setting.design))},
          {"sample_scatter", fmt::format("{:g}", setting.sample_scatter)},
          {"day_scatter", fmt::format("{:g}", setting.day_scatter)},
          {"amplitude", fmt::format("{:g}", setting.amplitude)},
          {"cells_more", follow_up_name(setting.follow_up)}};
}

void add_figures(Columns& columns, const Scores& s) {
  columns.emplace_back("cases", std::to_string(s.cases));
  columns.emplace_back("without_report", std::to_string(s.failed));
  add_rate(columns, "top1", s.top1);
  columns.emplace_back("top1_low", s.top1.of > 0 ? fmt::format("{:.4f}", wilson(s.top1).low) : "");
  add_rate(columns, "precision", s.precision);
  add_rate(columns, "candidate_set", s.candidate_set);
  add_rate(columns, "null_named", s.null_named);
  columns.emplace_back("null_named_high",
                       s.null_named.of > 0 ? fmt::format("{:.4f}", wilson(s.null_named).high) : "");
  add_rate(columns, "null_exact_named", s.null_exact_named);
  add_rate(columns, "pair_exact", s.pair_exact);
  add_rate(columns, "outside_clean", s.outside_clean);
  add_rate(columns, "rig_physics", s.rig_physics);
  const std::optional<double> shrink = median(s.shrinks);
  columns.emplace_back("shrink_median", shrink ? fmt::format("{:.4f}", *shrink) : "");
  add_rate(columns, "improved", s.improved);
  columns.emplace_back("calibration_error",
                       s.forecasts.empty() ? "" : fmt::format("{:.4f}", calibration_error(s.forecasts)));
  columns.emplace_back("wall_median_s", fmt::format("{:.2f}", median(s.wall_times).value_or(0.0)));
  columns.emplace_back("wall_max_s",
                       fmt::format("{:.2f}", s.wall_times.empty() ? 0.0 : std::ranges::max(s.wall_times)));
  columns.emplace_back("cpu_max_s",
                       fmt::format("{:.2f}", s.cpu_times.empty() ? 0.0 : std::ranges::max(s.cpu_times)));
  columns.emplace_back("passes", passes(s));
}

Columns line(const Manifest& manifest, const Setting& setting, const std::vector<Judged>& cases,
             const std::string& date) {
  Columns columns = identity(manifest, setting, date);
  add_figures(columns, score(cases));
  return columns;
}

std::string joined(const Columns& columns, std::string Columns::value_type::*part) {
  std::string text;
  for (const auto& column : columns) text += (text.empty() ? "" : ",") + column.*part;
  return text + "\n";
}

}  // namespace

std::string history_header() {
  return joined(line({}, {}, {}, ""), &Columns::value_type::first);
}

std::string history_lines(const Scored& campaign, const std::string& date) {
  std::string text;
  for (const auto& [setting, cases] : by_setting(campaign.cases)) {
    text += joined(line(campaign.manifest, setting, cases, date), &Columns::value_type::second);
  }
  return text;
}

}  // namespace heddle::blind
