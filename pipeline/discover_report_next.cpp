#include <fmt/format.h>

#include <algorithm>
#include <cmath>

#include "pipeline/discover_report_parts.h"
#include "pipeline/page.h"

namespace heddle::pipeline {

namespace {

using discover::Answer;

std::string pair_words(const discover::Proposal& proposal, const discover::RivalPair& pair) {
  return fmt::format("{} from {}", spaced(proposal.rivals[pair.first].name),
                     spaced(proposal.rivals[pair.second].name));
}

/// The conditions to pull next, with what they are expected to bring.
std::string proposed_table(const DiscoveryPage& page) {
  const discover::Proposal& proposal = page.record.proposal;
  if (proposal.pulls.empty()) return "";
  std::vector<std::vector<std::string>> rows;
  for (const discover::ProposedPull& pull : proposal.pulls) {
    std::string separates;
    for (const discover::RivalPair& pair : pull.separates)
      separates += fmt::format("{}{}", separates.empty() ? "" : "; ", pair_words(proposal, pair));
    rows.push_back({condition_words(page, pull.cell), fmt::format("{:.2f}", pull.right), separates});
  }
  std::string out = fmt::format(
      "<h3>Pull these next</h3>\n<p>Expected probability of the right answer: {:.2f} now, {:.2f} after all "
      "of them, from simulated "
      "outcomes.</p>\n",
      proposal.right_before, proposal.right_after);
  out += table({"Condition", "Right answer after it", "Tells apart"}, rows);
  for (const discover::RivalPair& pair : proposal.inseparable)
    out += fmt::format("<p>No such conditions within the campaign's levels tell {}.</p>\n",
                       escape(pair_words(proposal, pair)));
  return out;
}

/// Among the conditions already pulled, those at which more pulls tell the two best explanations apart.
std::string repeats_table(const DiscoveryPage& page) {
  if (page.rivals.size() < 2 || page.found.decision.answer == Answer::no_gap) return "";
  const Eigen::VectorXd difference =
      added_by(page.gap, *page.rivals[0]) - added_by(page.gap, *page.rivals[1]);
  struct Place {
    std::size_t cell;
    WeightedMean mean;
  };
  std::vector<Place> places;
  for (std::size_t c = 0; c < page.found.training.size(); ++c) {
    const Eigen::VectorXd weights =
        weights_of(page.gap, "whole pull", [&](std::size_t i) { return page.gap.cell[i] == c; });
    places.push_back({c, mean_of(page.gap, difference, weights)});
  }
  std::ranges::stable_sort(places, std::greater{}, [](const Place& p) { return std::abs(p.mean.value); });
  places.resize(std::min<std::size_t>(places.size(), 3));
  std::vector<std::vector<std::string>> rows;
  for (const Place& place : places)
    rows.push_back({condition_words(page, page.found.training[place.cell]),
                    fmt::format("{:.1f} %", 100.0 * std::abs(place.mean.value)),
                    fmt::format("{:.1f} %", 100.0 * place.mean.noise)});
  return fmt::format(
             "<h3>Where {} and {} differ most</h3>\n<p>Of the conditions that were pulled. More pulls there, "
             "on "
             "other days, and pulls beyond them, tell the two apart first.</p>\n",
             escape(page.name_of(*page.rivals[0])), escape(page.name_of(*page.rivals[1]))) +
         table({"Condition", "They differ by", "Noise of its mean"}, rows);
}

std::vector<std::string> advice(const DiscoveryPage& page) {
  switch (page.found.decision.answer) {
    case Answer::no_gap:
      return {
          "If an effect matters to you that the table under Doubts calls unseen, measure where it acts; "
          "otherwise use the "
          "model as it is."};
    case Answer::named:
      return {
          "Run patched.yaml, and look at the effect's numbers: are they what you would expect of the "
          "material?",
          "Pull one condition that was never measured, where the effect is strong, and compare it with "
          "patched.yaml."};
    case Answer::named_incomplete:
      return {"Run patched.yaml: it is nearer than the base, and not yet right.",
              "Look at the shape that is left over. If you know what makes it, write an effect file and run "
              "again with --effect."};
    case Answer::one_of:
      return {
          "Do not choose by taste: the names predict differently beyond the data. Measure where they differ, "
          "add the rows "
          "to the table, and run again."};
    case Answer::unknown:
      break;
  }
  return {"Look at the shape: over which factor, at its start or throughout? Check the rig there first.",
          "If you know what makes such a shape, write an effect file and run again with --effect."};
}

bool changes_physics(const DiscoveryPage& page) {
  const discover::Hypothesis& named = page.found.decision.named;
  return page.named() && std::ranges::any_of(named, [&](std::size_t effect) {
           return page.found.forward.candidates[effect].kind == discover::Kind::physics;
         });
}

std::string patched(const DiscoveryPage& page) {
  std::string holds;
  if (changes_physics(page))
    holds = fmt::format("It holds the case with the baseline as fitted and {} in it.",
                        page.name_of(*page.best()));
  else if (page.named())
    holds =
        "It holds the case with the baseline as fitted and no effect: the fault is the rig's, and the model "
        "stays as it is.";
  else
    holds = "It holds the case with the baseline as fitted and no effect: no one name was given.";
  return fmt::format(
      "<h3>patched.yaml</h3>\n<p>{} It runs as any case:</p>\n<p><code>heddle friction "
      "discover/patched.yaml</code></p>\n",
      escape(holds));
}

}  // namespace

std::string next_section(const DiscoveryPage& page) {
  return section("Next", list(advice(page)) + proposed_table(page) + repeats_table(page) + patched(page));
}

}  // namespace heddle::pipeline
