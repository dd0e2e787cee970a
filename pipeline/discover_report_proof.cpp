#include <fmt/format.h>

#include <algorithm>

#include "pipeline/discover_report_parts.h"
#include "pipeline/discover_report_pictures.h"
#include "pipeline/page.h"
#include "pipeline/report_figures.h"

namespace heddle::pipeline {

namespace {

using discover::Answer;

std::string held_out_name(const DiscoveryPage& page, const discover::CouponCell& cell) {
  return fmt::format("{}: {}", page.found.campaign.condition_names[cell.condition],
                     condition_words(page, cell));
}

Verdict shrink_verdict(const DiscoveryPage& page) {
  const discover::Gap& gap = *page.found.gap;
  const std::string numbers = fmt::format(
      "On {} conditions that no fit saw the model is {:.1f} % of the force off before and {:.1f} % after; "
      "noise alone "
      "leaves {:.1f} %. The gap shrinks by {:.0f} % (95 % interval {:.0f} to {:.0f} %)",
      gap.conditions, 100.0 * gap.before, 100.0 * gap.after, 100.0 * gap.floor, 100.0 * gap.shrink,
      100.0 * gap.shrink_low, 100.0 * gap.shrink_high);
  const std::string closed = gap.closed >= 1.0 ? std::string(": all of what could be closed.")
                             : gap.closed > 0.0
                                 ? fmt::format(": {:.0f} % of what could be closed.", 100.0 * gap.closed)
                                 : ".";
  if (gap.shrink_low > 0.0) return {Tone::holds, numbers + closed};
  if (gap.shrink > 0.0)
    return {Tone::attention, numbers + closed + " The interval holds zero: so few conditions prove nothing."};
  return {Tone::fails,
          numbers + ". It does not shrink: what was fitted does not carry over to other conditions."};
}

/// Why there is no proof, or how far the one there is carries.
std::vector<Verdict> proof_verdicts(const DiscoveryPage& page) {
  const discover::CouponFindings& found = page.found;
  std::vector<Verdict> verdicts;
  if (found.gap) verdicts.push_back(shrink_verdict(page));
  if (found.gap && !page.named() && page.best() != nullptr)
    verdicts.push_back(
        {Tone::note,
         fmt::format("Measured with the best name, {}, although the answer is not that name alone.",
                     page.name_of(*page.best()))});
  if (found.split.held_out.empty())
    verdicts.push_back(
        {Tone::attention,
         found.campaign.condition_names.size() < 8
             ? fmt::format("Nothing could be held out: {} conditions are too few, eight are needed. Nothing "
                           "is claimed of conditions that were not measured.",
                           found.campaign.condition_names.size())
             : "Nothing was held out: nothing is claimed of conditions that were not measured."});
  else if (found.decision.answer == Answer::no_gap)
    verdicts.push_back(
        {Tone::note, fmt::format("No effect was added, so no gap can shrink. {} conditions were held out and "
                                 "not looked at.",
                                 found.split.held_out.size())});
  if (found.saturated)
    verdicts.push_back(
        {Tone::attention,
         fmt::format("The fit is saturated: as many numbers as conditions ({}). Such a fit meets every "
                     "measurement whatever its form, so that its gap closes there proves nothing, and no "
                     "shrink is claimed of it.",
                     found.training.size())});
  return verdicts;
}

std::string held_out_figure(const DiscoveryPage& page) {
  if (page.found.held_out.empty()) return "";
  BeforeAfterPicture picture;
  picture.label = "Error of the model on every held-out condition, before and after the effect was added";
  picture.width = full_width;
  for (const discover::HeldOut& one : page.found.held_out)
    picture.rows.push_back(
        {held_out_name(page, page.found.campaign.cells[one.cell]), one.before, one.after, one.noise});
  std::ranges::stable_sort(picture.rows, std::greater{}, &BeforeAfter::before);
  return figure(draw(picture),
                "Every condition that no fit saw, worst first. A full mark left of its hollow one: the "
                "effect brought the "
                "model nearer. Inside the shade there is nothing left to explain. gap.csv has the numbers.");
}

}  // namespace

std::string proof_section(const DiscoveryPage& page) {
  return section("The proof", verdict_list(proof_verdicts(page)) + held_out_figure(page));
}

}  // namespace heddle::pipeline
