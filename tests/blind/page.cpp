#include "page.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <map>

namespace heddle::blind {

namespace {

/// The parts of a setting in words.
std::vector<std::string> parts(const Setting& s) {
  const char* more = s.follow_up == FollowUp::proposed ? "three proposed cells more"
                     : s.follow_up == FollowUp::random ? "three random cells more"
                                                       : "no cells more";
  return {std::string(blindgen::name_of(s.design)),
          fmt::format("{:g} % a sample", 100.0 * s.sample_scatter),
          fmt::format("{:g} % a day", 100.0 * s.day_scatter),
          fmt::format("amplitude {:g}", s.amplitude),
          more,
          fmt::format("without {}", ablations().at(s.ablation).without)};
}

/// What tells a setting from the others, or all of it if there are no others.
std::string title(const Setting& setting, const Settings& all) {
  std::string text;
  const std::vector<std::string> words = parts(setting);
  for (std::size_t i = 0; i < words.size(); ++i) {
    const bool differs =
        std::ranges::any_of(all, [&](const auto& other) { return parts(other.first)[i] != words[i]; });
    if (differs || (all.size() == 1 && i + 1 < words.size())) text += (text.empty() ? "" : ", ") + words[i];
  }
  return text;
}

/// "97.3 % (95.0 to 98.6; 321 of 330)"
std::string cell(const Rate& rate) {
  if (rate.of == 0) return "none";
  const Interval interval = wilson(rate);
  return fmt::format("{:.1f} % ({:.1f} to {:.1f}; {} of {})", 100.0 * rate.value(), 100.0 * interval.low,
                     100.0 * interval.high, rate.hits, rate.of);
}

std::string short_cell(const Rate& rate) {
  return rate.of == 0 ? "" : fmt::format("{}/{}", rate.hits, rate.of);
}

std::string percent(const std::optional<double>& value) {
  return value ? fmt::format("{:.1f} %", 100.0 * *value) : "none";
}

double mean(const std::vector<double>& values) {
  double sum = 0.0;
  for (const double value : values) sum += value;
  return values.empty() ? 0.0 : sum / static_cast<double>(values.size());
}

double largest(const std::vector<double>& values) {
  return values.empty() ? 0.0 : std::ranges::max(values);
}

std::string must_hold(const Scores& s) {
  std::string text = "| what must hold | measured | bound that counts | holds |\n|---|---|---|---|\n";
  for (const Requirement& r : requirements(s)) {
    text += fmt::format("| {} | {} | {} | {} |\n", r.what, r.value, r.bound,
                        !r.holds   ? "no case"
                        : *r.holds ? "yes"
                                   : "**no**");
  }
  return text;
}

std::string all_figures(const Scores& s) {
  const std::vector<std::pair<std::string, std::string>> rows{
      {"one effect: top-1 (named alone and right, or first of a ONE_OF)", cell(s.top1)},
      {"one effect: named alone and right", cell(s.named_alone)},
      {"one effect: first single effect of the ranking, whatever the verdict", cell(s.first_ranked)},
      {"one effect: candidate set holds the truth",
       cell(s.candidate_set) + fmt::format("; mean size {:.2f}", mean(s.set_sizes))},
      {"single names at P >= 0.9 that are right, one effect hidden", cell(s.precision)},
      {"the same over cases of every kind", cell(s.any_precision)},
      {"nothing hidden: a name or a set of names", cell(s.null_named)},
      {"of these, where law and melt are exactly the program's", cell(s.null_exact_named)},
      {"nothing hidden: a name, not a set", cell(s.null_name)},
      {"nothing hidden: any verdict but NO_GAP", cell(s.null_gap)},
      {"two effects: exact set (named, or the most probable set of a ONE_OF)", cell(s.pair_exact)},
      {"two effects: named and exact", cell(s.pair_named)},
      {"two effects: at least one right", cell(s.pair_one)},
      {"two effects: a false name in the set", cell(s.pair_false)},
      {"outside the library: a clean name", cell(s.outside_clean)},
      {"outside the library: UNKNOWN or a name with a remainder", cell(s.outside_unknown)},
      {"outside the library: a set of names (ONE_OF)", cell(s.outside_set)},
      {"outside the library: not seen (NO_GAP)", cell(s.outside_unseen)},
      {"rig's own faults: called physics", cell(s.rig_physics)},
      {"rig's own faults: named as such", cell(s.rig_named)},
      {"held-out gap: median shrink where a name is given", percent(median(s.shrinks))},
      {"held-out gap: improved", cell(s.improved)},
      {"calibration error (ECE, 5 bins)", fmt::format("{:.3f}", calibration_error(s.forecasts))},
      {"time a case: median, worst",
       fmt::format("{:.2f} s, {:.2f} s (CPU {:.2f} s, {:.2f} s)", median(s.wall_times).value_or(0.0),
                   largest(s.wall_times), median(s.cpu_times).value_or(0.0), largest(s.cpu_times))},
      {"cases without a report", fmt::format("{} of {}", s.failed, s.cases)}};
  std::string text = "| figure | value (95 % interval; count) |\n|---|---|\n";
  for (const auto& [what, value] : rows) text += fmt::format("| {} | {} |\n", what, value);
  return text;
}

/// Ids of friction effects in the order F1 to F15.
std::vector<std::string> effect_order() {
  std::vector<std::string> order;
  for (const blindgen::Term* term : blindgen::terms_of(blindgen::Origin::friction))
    order.emplace_back(term->id);
  return order;
}

std::string per_effect(const Scores& s) {
  std::string text = "| effect hidden | mean size | top-1 | answered instead |\n|---|---|---|---|\n";
  for (const std::string& id : effect_order()) {
    const auto rate = s.top1_of.find(id);
    if (rate == s.top1_of.end()) continue;
    std::string others;
    for (const auto& [answer, count] : s.confusion.at(id)) {
      if (answer != id && answer != id + "*")
        others += fmt::format("{}{} {}", others.empty() ? "" : ", ", count, answer);
    }
    text += fmt::format("| `{}` | {:.0f} % | {} | {} |\n", id, 100.0 * std::expm1(mean(s.size_of.at(id))),
                        cell(rate->second), others);
  }
  return text;
}

std::string other_answers(const Scores& s) {
  std::string text = "| hidden | answered |\n|---|---|\n";
  for (const auto& [truth, answers] : s.confusion) {
    if (s.top1_of.contains(truth)) continue;
    std::string list;
    for (const auto& [answer, count] : answers)
      list += fmt::format("{}{} {}", list.empty() ? "" : ", ", count, answer);
    text += fmt::format("| {} | {} |\n", truth, list);
  }
  return text;
}

std::string calibration(const Scores& s) {
  std::string text = "| stated P | cases | mean stated | right |\n|---|---|---|---|\n";
  const std::vector<Bin> bins = reliability(s.forecasts);
  for (std::size_t i = 0; i < bins.size(); ++i) {
    if (bins[i].right.of == 0) continue;
    text += fmt::format("| {:.1f} to {:.1f} | {} | {:.3f} | {:.3f} |\n", 0.2 * static_cast<double>(i),
                        0.2 * static_cast<double>(i + 1), bins[i].right.of, bins[i].stated,
                        bins[i].right.value());
  }
  return text;
}

std::string failures(const std::vector<Judged>& cases) {
  std::string text = "| case | kind | hidden (size) | answer | candidate set |\n|---|---|---|---|---|\n";
  for (const Judged& judged : cases) {
    if (went_well(judged)) continue;
    std::string truth, set = judged.failure;
    for (const auto& hidden : judged.truth) {
      truth += fmt::format("{}{} ({:.0f} %)", truth.empty() ? "" : ", ", hidden.id,
                           100.0 * std::expm1(hidden.size));
    }
    if (judged.answer) set = fmt::format("{}", fmt::join(judged.answer->candidates, ", "));
    text += fmt::format("| {} | {} | {} | {} | {} |\n", judged.planned.number,
                        blindgen::name_of(judged.planned.spec.kind), truth.empty() ? "nothing" : truth,
                        answer_name(judged), set);
  }
  return text;
}

/// Settings side by side: the figures that a design, the scatter, the amplitude or a part left out moves.
std::string comparison(const Settings& settings) {
  std::string text =
      "| setting | top-1 | candidate set holds it | single names right | nulls named | two effects exact | "
      "outside named | median shrink | calibration error |\n|---|---|---|---|---|---|---|---|---|\n";
  for (const auto& [setting, cases] : settings) {
    const Scores s = score(cases);
    text += fmt::format("| {} | {} | {} | {} | {} | {} | {} | {} | {:.3f} |\n", title(setting, settings),
                        cell(s.top1), cell(s.candidate_set), cell(s.precision), cell(s.null_named),
                        cell(s.pair_exact), cell(s.outside_clean), percent(median(s.shrinks)),
                        calibration_error(s.forecasts));
  }
  return text;
}

std::string effects_by_setting(const Settings& settings) {
  std::string head = "| effect hidden, top-1 |", rule = "|---|", body;
  std::map<std::string, std::string> rows;
  for (const auto& [setting, cases] : settings) {
    head += " " + title(setting, settings) + " |";
    rule += "---|";
    const Scores s = score(cases);
    for (const std::string& id : effect_order()) {
      rows[id] += " " + (s.top1_of.contains(id) ? short_cell(s.top1_of.at(id)) : "") + " |";
    }
  }
  for (const std::string& id : effect_order()) body += "| `" + id + "` |" + rows[id] + "\n";
  return head + "\n" + rule + "\n" + body;
}

/// What must hold: three proposed cells beat three random ones by 8 points on the confusable group.
std::string gain_of_proposals(const std::vector<Judged>& cases) {
  std::map<FollowUp, Rate> top1;
  for (const Judged& judged : cases) top1[judged.planned.follow_up].count(went_well(judged));
  const double none = top1[FollowUp::none].value(), proposed = top1[FollowUp::proposed].value();
  const double gain = 100.0 * (proposed - top1[FollowUp::random].value());
  return fmt::format(
      "Three proposed cells: {:+.1f} points over none, {:+.1f} over three random ones (must hold: 8 or "
      "more): {}.\n\n",
      100.0 * (proposed - none), gain, gain >= 8.0 ? "holds" : "**does not hold**");
}

std::string command(const Manifest& m) {
  std::string kinds;
  for (const blindgen::Kind kind : m.selection.kinds) {
    kinds += (kinds.empty() ? " --kinds " : ",") + std::string(blindgen::name_of(kind));
  }
  return "tests/blind/run " + m.campaign +
         (m.campaign == "acceptance" ? "" : " --seed " + std::to_string(m.selection.seed)) + kinds +
         (m.selection.limit > 0 ? " --limit " + std::to_string(m.selection.limit) : "");
}

std::string chapter(const Scored& campaign) {
  const Manifest& m = campaign.manifest;
  const Settings settings = by_setting(campaign.cases);
  std::string text =
      fmt::format("## {}\n\n`{}`: {} cases, seed {}, commit {}, trees {} (search), {} (laws).\n\n",
                  m.campaign, command(m), campaign.cases.size(), m.selection.seed, m.commit,
                  m.discover_tree.substr(0, 8), m.friction_tree.substr(0, 8));
  if (m.campaign == "proposals") text += gain_of_proposals(campaign.cases);
  if (m.campaign == "amplitudes")
    text += fmt::format("![Share named against amplitude]({})\n\n", amplitude_picture);
  if (settings.size() > 1) {
    text += comparison(settings) + "\n" + effects_by_setting(settings) + "\n";
  } else {
    const Scores s = score(campaign.cases);
    text += title(settings.begin()->first, settings) + ".\n\n" + must_hold(s) + "\n" + all_figures(s) + "\n" +
            per_effect(s) + "\n" + other_answers(s) + "\n" + calibration(s) + "\n";
  }
  return text + "Every case that went wrong:\n\n" + failures(campaign.cases) + "\n";
}

constexpr const char* preface =
    "# Blind test of `heddle discover`\n\n"
    "Made by `score_blind`, whole; do not edit. A separate program with physics of its own makes pull-out "
    "campaigns with "
    "something hidden in them, or nothing; `heddle discover` answers; its report is stored with its hash; "
    "only then is "
    "the truth made again and compared. What both sides share: [decision](decisions/blind-test.md). Runs of "
    "the past: "
    "[blind.csv](blind.csv).\n\n"
    "How it counts. Every case counts; one without a report counts as wrong. A name is right if the set of "
    "names is "
    "exactly the truth, with or without a remainder (`*` = NAMED_INCOMPLETE). Top-1 also takes the first of "
    "a ONE_OF, "
    "and an exact set the most probable set of one, never of an UNKNOWN. For a null, a set of names is as "
    "bad as a name. A fault of the rig is called "
    "physics if a name "
    "is given that is friction's, or a set without any fault of the rig. Intervals are Wilson's at 95 %; "
    "rates pass by "
    "the bound of the interval. Sizes: largest departure of the force from the plain world. Times are of a "
    "machine that "
    "runs several cases at once.\n\n"
    "Not measured: shapes of unknown effects against the truth, shrink against an oracle's fit, recovery of "
    "parameters (the forms differ by design).\n\n";

}  // namespace

Setting setting_of(const PlannedCase& planned) {
  const blindgen::Spec& spec = planned.spec;
  return {spec.design,    spec.sample_scatter, spec.day_scatter,
          spec.amplitude, planned.follow_up,   planned.ablation};
}

Settings by_setting(const std::vector<Judged>& cases) {
  Settings settings;
  for (const Judged& judged : cases) settings[setting_of(judged.planned)].push_back(judged);
  return settings;
}

std::string page(const std::vector<Scored>& campaigns, const std::vector<std::string>& others) {
  std::string text = preface;
  for (const Scored& campaign : campaigns) text += chapter(campaign);
  if (!others.empty()) text += "## Other campaigns\n\nEach as it was last run:\n";
  for (const std::string& other : others) text += fmt::format(" [{}]({}.md)", other, other);
  return others.empty() ? text : text + "\n";
}

std::string summary(const Scored& campaign) {
  return chapter(campaign);
}

}  // namespace heddle::blind
