#include "pipeline/discover_report.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <numbers>
#include <set>

#include "core/units.h"
#include "pipeline/discover_report_parts.h"
#include "pipeline/page.h"

namespace heddle::pipeline {

namespace {

using discover::Answer;
using discover::CouponFindings;
using discover::Scored;

std::string join_ids(const std::vector<std::string>& ids) {
  std::string text;
  for (std::size_t k = 0; k < ids.size(); ++k)
    text += fmt::format("{}{}", k == 0 ? "" : k + 1 == ids.size() ? " or " : ", ", spaced(ids[k]));
  return text;
}

std::string probability_words(double probability) {
  return probability > 0.9995 ? "more than 0.999"
                              : fmt::format("{:.{}f}", probability, probability > 0.99 ? 3 : 2);
}

bool of_rig(const DiscoveryPage& page) {
  const discover::Hypothesis& named = page.found.decision.named;
  return !named.empty() && std::ranges::all_of(named, [&](std::size_t effect) {
    return page.found.forward.candidates[effect].kind != discover::Kind::physics;
  });
}

std::string named_sentence(const DiscoveryPage& page) {
  const std::string name = page.name_of(*page.best());
  const std::string probability = probability_words(page.found.decision.probability);
  std::string text = of_rig(page)
                         ? fmt::format("The measurement is at fault, not the model: {}, with probability {}",
                                       name, probability)
                         : fmt::format("The model lacks {}, with probability {}", name, probability);
  if (page.found.decision.answer != Answer::named_incomplete) return text + ".";
  const auto& rest = page.found.evidence.rest_shapes;
  return text + (rest.empty() ? "; something more is missing."
                              : fmt::format("; something more is missing, which shows over {}.",
                                            spaced(rest.front().over)));
}

std::string unknown_sentence(const DiscoveryPage& page) {
  const auto& shapes = page.found.evidence.gap_shapes;
  if (shapes.empty()) return "The model lacks something, and no effect of the library explains it.";
  return fmt::format("The model lacks something that no effect of the library explains; it shows over {}.",
                     spaced(shapes.front().over));
}

std::string one_of_sentence(const DiscoveryPage& page) {
  const std::string& group = page.found.decision.group;
  if (page.found.decision.candidate_set.size() < 2)
    return fmt::format("The model lacks something, probably {}; the data do not bear out one name.",
                       page.name_of(*page.best()));
  return fmt::format("The model lacks {}; these data cannot say which.", group.empty() ? "an effect" : group);
}

/// What the sentence leaves open.
std::string detail_sentence(const DiscoveryPage& page) {
  const discover::Decision& decision = page.found.decision;
  if (decision.answer != Answer::one_of || page.best() == nullptr) return "";
  const std::string likeliest =
      fmt::format("The likeliest is {}, with probability {}.", page.name_of(*page.best()),
                  probability_words(decision.probability));
  if (decision.candidate_set.size() < 2) return likeliest;
  return fmt::format("It is {}. {}", join_ids(decision.candidate_set), likeliest);
}

/// What was measured: "48 conditions, 240 pulls, 6 days".
std::string extent(const CouponFindings& found) {
  int samples = 0;
  for (const discover::CouponCell& cell : found.campaign.cells) samples += cell.samples;
  std::string text = fmt::format("{} conditions, {} pulls", found.campaign.condition_names.size(), samples);
  if (found.campaign.days.size() > 1) text += fmt::format(" on {} days", found.campaign.days.size());
  return text;
}

std::string paragraph(const std::string& text) {
  return text.empty() ? "" : fmt::format("<p class=\"lead\">{}</p>\n", escape(text));
}

std::string header(const DiscoveryPage& page) {
  const DiscoveryRecord& record = page.record;
  std::string source = fmt::format("{}: {}, {}.", record.name, record.data_file, extent(page.found));
  if (!record.rig.empty()) source += fmt::format(" Rig: {}.", spaced(record.rig));
  if (!record.provenance.empty()) source += fmt::format(" Provenance: {}.", record.provenance);
  return fmt::format("<header>\n<p class=\"kind\">heddle · Discovery · {}</p>\n<h1>{}</h1>\n{}{}</header>\n",
                     in_words(page.found.decision.answer), escape(verdict_sentence(page)),
                     paragraph(detail_sentence(page)), paragraph(source));
}

/// The number that the answer stands on.
std::string main_tile(const DiscoveryPage& page) {
  const CouponFindings& found = page.found;
  const double probability = found.decision.probability;
  switch (found.decision.answer) {
    case Answer::no_gap: {
      const Scored* none = found.result.find({});
      return none == nullptr
                 ? ""
                 : result("Nothing missing, probability", fmt::format("{:.2f}", none->probability), "");
    }
    case Answer::unknown:
      return result(
          fmt::format("ln Bayes factor of a smooth shape; best name {:.1f}", found.result.best_gain()),
          found.evidence.gap_shapes.empty()
              ? "–"
              : fmt::format("{:.1f}", found.evidence.gap_shapes.front().log_evidence),
          "");
    default:
      return result(page.named() ? "Probability of the name" : "Probability of the likeliest",
                    probability > 0.9995 ? "> 0.999" : fmt::format("{:.3f}", probability), "");
  }
}

std::string tiles(const DiscoveryPage& page) {
  const CouponFindings& found = page.found;
  std::string out =
      main_tile(page) + result("Noise alone gives as much, p", p_text(found.evidence.gate_p), "");
  if (found.gap)
    return results(
        out +
        result("Off the force before, held out", fmt::format("{:.1f}", 100.0 * found.gap->before), "%") +
        result(fmt::format("After; noise alone {:.1f} %", 100.0 * found.gap->floor),
               fmt::format("{:.1f}", 100.0 * found.gap->after), "%"));
  return results(out +
                 result("Scatter of samples", fmt::format("{:.1f}", 100.0 * found.noise.sample_sd()), "%") +
                 result("Scatter of days", fmt::format("{:.1f}", 100.0 * found.noise.day), "%"));
}

/// Which rules decided, and by what.
std::vector<Verdict> basis(const DiscoveryPage& page) {
  std::vector<Verdict> verdicts;
  const CouponFindings& found = page.found;
  const bool gap = found.evidence.gate_p < page.record.question.verdict.gate;
  verdicts.push_back(
      {Tone::note, fmt::format("What stands out most of {} places and {} signatures: {}, {:.1f} standard "
                               "deviations. Noise alone makes the "
                               "largest as large with probability {}{}.",
                               found.contrasts.size(), found.result.signatures.size(),
                               spaced(found.gate_from), found.gate_statistic, p_text(found.evidence.gate_p),
                               gap ? "" : ", so there is no gap to explain")});
  if (!gap) return verdicts;  // the decision's reason says the same
  for (const std::string& reason : found.decision.reasons) verdicts.push_back({Tone::note, reason});
  return verdicts;
}

}  // namespace

std::string condition_words(const DiscoveryPage& page, const discover::CouponCell& cell) {
  const auto varies = [&](std::string_view name) {
    return std::ranges::count(page.levels, name, &Levels::name) > 0;
  };
  std::string text = fmt::format("{} mm/s, {} N, tool {} °C", plain_number(1e3 * cell.pull.velocity, 3),
                                 plain_number(cell.pull.normal_force, 3),
                                 plain_number(cell.pull.tool_temperature - zero_celsius, 4));
  if (varies("fabric temperature"))
    text += fmt::format(", fabric {} °C", plain_number(cell.pull.fabric_temperature - zero_celsius, 4));
  if (varies("orientation"))
    text += fmt::format(", {}°", plain_number(cell.pull.orientation * 180.0 / std::numbers::pi, 3));
  if (varies("dwell")) text += fmt::format(", dwell {} s", plain_number(cell.dwell, 3));
  return text;
}

std::string p_text(double p) {
  return p < 0.0015 ? "≤ 0.001" : p < 0.01 ? fmt::format("{:.3f}", p) : fmt::format("{:.2f}", p);
}

bool DiscoveryPage::named() const {
  return found.decision.answer == Answer::named || found.decision.answer == Answer::named_incomplete;
}

DiscoveryPage discovery_page(const DiscoveryRecord& record) {
  DiscoveryPage page{record, record.findings, gap_table(record.findings), {}, {}};
  page.levels = all_levels(page.gap, 8);
  std::set<std::vector<std::string>> seen;
  const CouponFindings& found = record.findings;
  const auto add = [&](const Scored& one) {
    if (one.fit.hypothesis.empty() || page.rivals.size() == 3) return;
    std::vector<std::string> ids;
    for (const std::size_t effect : one.fit.hypothesis) ids.push_back(found.forward.candidates[effect].id);
    if (seen.insert(ids).second) page.rivals.push_back(&one);
  };
  if (!found.decision.named.empty())
    if (const Scored* named = found.result.find(found.decision.named)) add(*named);
  for (const Scored& one : found.result.scored) {
    // Pairs that hold the best name are the same explanation with something added.
    const bool holds_best = !page.rivals.empty() && page.rivals[0]->fit.hypothesis.size() == 1 &&
                            std::ranges::count(one.fit.hypothesis, page.rivals[0]->fit.hypothesis[0]) > 0;
    if (!holds_best) add(one);
  }
  return page;
}

std::string verdict_sentence(const DiscoveryPage& page) {
  switch (page.found.decision.answer) {
    case Answer::no_gap:
      return "Nothing is missing that these data could show.";
    case Answer::named:
    case Answer::named_incomplete:
      return named_sentence(page);
    case Answer::one_of:
      return one_of_sentence(page);
    case Answer::unknown:
      break;
  }
  return unknown_sentence(page);
}

std::string discover_html(const DiscoveryRecord& record) {
  const DiscoveryPage page = discovery_page(record);
  return page_head(fmt::format("{} · discovery", record.name)) + header(page) + tiles(page) +
         verdict_list(basis(page)) + where_section(page) + what_section(page) + proof_section(page) +
         doubts_section(page) + next_section(page) +
         page_foot(fmt::format(
             "Written by heddle, seed {}. Numbers: report.json, gap.csv and shape.csv in the same folder.",
             record.seed));
}

}  // namespace heddle::pipeline
