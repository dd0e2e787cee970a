#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <set>

#include "pipeline/calibration_record.h"
#include "pipeline/discover_report_parts.h"
#include "pipeline/isolability_picture.h"
#include "pipeline/page.h"

namespace heddle::pipeline {

namespace {

using discover::Answer;
using friction::Scatter;

std::string percent(double share) {
  return fmt::format("{:.3g} %", 100.0 * share);
}

Verdict sample_verdict(const discover::CouponNoise& noise) {
  const std::string size = percent(noise.sample_sd());
  switch (noise.sample_source) {
    case Scatter::Source::replicates:
      return {Tone::holds, fmt::format("Samples scatter by {}, from replicates ({} degrees of freedom).",
                                       size, noise.sample_freedom)};
    case Scatter::Source::given:
      return {Tone::note, fmt::format("The scatter of samples was given: {}.", size)};
    default:
      return {Tone::attention,
              fmt::format("How samples scatter is assumed, {}: no condition was pulled twice on one day. "
                          "So no single name is given, whatever its probability.",
                          size)};
  }
}

Verdict day_verdict(const discover::CouponNoise& noise) {
  const std::string size = percent(noise.day);
  switch (noise.day_source) {
    case Scatter::Source::anchors:
      return {Tone::holds, fmt::format("Days differ by {}, from a condition repeated on {} days.", size,
                                       noise.day_freedom + 1)};
    case Scatter::Source::given:
      return {Tone::note, fmt::format("The scatter of days was given: {}.", size)};
    default:
      return {Tone::attention,
              fmt::format("How much days differ is assumed, {}: no condition was repeated on three days. "
                          "Replicates of one day do not see it.",
                          size)};
  }
}

std::vector<Verdict> caution_verdicts(const DiscoveryPage& page) {
  const discover::CouponFindings& found = page.found;
  std::vector<Verdict> verdicts{sample_verdict(found.noise), day_verdict(found.noise)};
  if (found.decision.answer == Answer::no_gap) return verdicts;
  const double wanted = page.record.question.verdict.stability;
  verdicts.push_back(
      {found.evidence.stability >= wanted ? Tone::holds : Tone::attention,
       fmt::format(
           "The best explanation stays the best in {:.0f} % of random halves of the conditions ({:.0f} % "
           "are asked of a name).",
           100.0 * found.evidence.stability, 100.0 * wanted)});
  for (const discover::UnderPrior& under : found.evidence.priors) {
    const std::string best = under.best.empty() ? "no effect" : in_words(found.forward, under.best);
    const bool same = best == in_words(found.forward, found.decision.named);
    verdicts.push_back(
        {same ? Tone::holds : Tone::attention,
         fmt::format("Were the priors of the effects {:g} times as wide, {}: {} ({:.2f}).", under.width,
                     same ? "the same would be best" : "another would be best", best, under.probability)});
  }
  const bool fits = found.decision.lack_of_fit_p >= page.record.question.verdict.lack_of_fit;
  verdicts.push_back(
      {fits ? Tone::holds : Tone::attention,
       fmt::format(
           "It removes {:.0f} % of what the baseline leaves beyond noise; what is left over has p {:.2g}{}.",
           100.0 * found.decision.excess_removed, found.decision.lack_of_fit_p,
           fits ? ", as noise has" : ": more than noise")});
  return verdicts;
}

const discover::Scored* alone(const discover::CouponFindings& found, const std::string& id) {
  for (const discover::Scored& one : found.result.scored)
    if (one.fit.hypothesis.size() == 1 && found.forward.candidates[one.fit.hypothesis[0]].id == id)
      return &one;
  return nullptr;
}

/// Names that the best one is often taken for, and how they fare here.
std::string look_alike_table(const DiscoveryPage& page) {
  const discover::Scored* best = page.best();
  if (best == nullptr || page.found.decision.answer == Answer::no_gap) return "";
  std::set<std::string> ids;
  for (const std::size_t effect : best->fit.hypothesis) {
    const auto& look_alikes = page.found.forward.candidates[effect].look_alikes;
    ids.insert(look_alikes.begin(), look_alikes.end());
  }
  for (const std::string& id : page.found.decision.candidate_set) ids.insert(id);
  for (const std::size_t effect : best->fit.hypothesis) ids.erase(page.found.forward.candidates[effect].id);
  std::vector<std::vector<std::string>> rows;
  for (const std::string& id : ids) {
    const discover::Scored* one = alone(page.found, id);
    const bool open = std::ranges::count(page.found.decision.candidate_set, id) > 0;
    rows.push_back({spaced(id),
                    one == nullptr ? "not tried"
                                   : fmt::format("{:+.1f}", one->fit.log_evidence - best->fit.log_evidence),
                    one == nullptr ? "–" : fmt::format("{:.3f}", one->probability),
                    open ? "open" : "ruled out"});
    if (one == nullptr && !open) rows.back()[3] = "–";
  }
  if (rows.empty()) return "";
  return fmt::format("<h3>What {} could be taken for</h3>\n", escape(page.name_of(*best))) +
         table({"Look-alike", "Alone, ln Bayes factor against it", "Probability", "Here"}, rows);
}

/// The amplitude that stands out by three standard deviations, and how often the usual one would get its own
/// name.
std::string detectable_table(const DiscoveryPage& page) {
  std::vector<std::vector<std::string>> rows;
  for (const discover::EffectSight& sight : page.found.isolability.effects) {
    const discover::Candidate& candidate = page.found.forward.candidates[sight.effect];
    rows.push_back(
        {spaced(candidate.id),
         sight.detectable ? quantity_text(*sight.detectable, candidate.numbers.front().unit, 2) : "none",
         fmt::format("{:.1f}", sight.length), sight.seen ? "yes" : "no",
         fmt::format("{:.0f} %", 100.0 * sight.right)});
  }
  if (rows.empty()) return "";
  return "<h3>What this campaign can see</h3>\n<p>The smallest amplitude of each effect that would stand out "
         "by 3 standard "
         "deviations if it alone were missing, beside what the baseline's numbers take up; by how many its "
         "usual amplitude (one "
         "standard deviation of its prior) would stand out; and how often that would get its right name. "
         "Smaller ones stay "
         "unseen, and “nothing missing” says nothing of them.</p>\n" +
         table({"Effect", "Smallest amplitude seen", "Usual one stands out by", "Seen", "Named right"}, rows);
}

/// Who is taken for whom, and the groups that this campaign sees and cannot tell apart.
std::string isolability_part(const DiscoveryPage& page) {
  const discover::Isolability& sights = page.found.isolability;
  if (sights.effects.empty()) return "";
  std::vector<std::string> groups;
  for (const std::vector<std::size_t>& group : sights.groups) {
    std::string text = "Not told apart:";
    for (const std::size_t k : group)  // positions in `effects`
      text += fmt::format("{} {}", k == group.front() ? "" : ",",
                          spaced(page.found.forward.candidates[sights.effects[k].effect].id));
    groups.push_back(std::move(text));
  }
  return "<h3>What this campaign can tell apart</h3>\n" +
         figure(draw(page.found.forward, sights),
                "Each row is the truth at its usual amplitude, each column what it may be taken for; figures "
                "are how often, in per "
                "cent, if only the two were asked.") +
         (groups.empty()
              ? "<p>Every effect that it sees lies 3 standard deviations or more from each other one.</p>\n"
              : list(groups));
}

std::string blind_spots(const DiscoveryPage& page) {
  std::vector<std::string> texts;
  for (const std::string& factor : constant_factors(page.found))
    texts.push_back(fmt::format("Everything was pulled at {}: no effect of it can show.", factor));
  if (page.found.campaign.stretches < 2)
    texts.push_back("One line a pull: static peaks, wear and other histories show only in their mean.");
  if (page.found.campaign.days.size() < 2)
    texts.push_back("One day only, or no day_id: a drift of the rig cannot be told from an effect.");
  texts.push_back(
      "Effects that no file of the library describes have no name here; they can show only as a smooth "
      "shape.");
  return "<h3>What this design could never see</h3>\n" + list(texts);
}

std::string not_tried_table(const DiscoveryPage& page) {
  std::vector<std::string> texts;
  for (const auto& [id, why] : page.found.refused) texts.push_back(fmt::format("{}: {}", spaced(id), why));
  return texts.empty() ? "" : "<h3>Not tried</h3>\n" + list(texts);
}

std::string tolerances(const DiscoveryPage& page) {
  const discover::CouponNoise& noise = page.found.noise;
  const discover::NoiseWish& wish = page.record.question.noise;
  return "<h3>What is let off</h3>\n<p>Priors: sizes of error that count as no effect. Nature's laws are not "
         "the "
         "library's.</p>\n" +
         facts_table({{"Form of the law over ln Hs",
                       fmt::format("{}, over {:g}", percent(noise.form), noise.form_length)},
                      {"Unevenness along the slip, alike in all conditions", percent(noise.history)},
                      {"Form of an effect, of what it does",
                       fmt::format("{}, over {:g} of each range", percent(wish.effect_form),
                                   wish.effect_form_length)},
                      {"Reading, where replicates do not tell", percent(wish.reading)}});
}

/// Parts of the method that the case switched off or moved: a verdict without them is not the program's usual
/// one.
std::string changed_method(const DiscoveryPage& page) {
  const discover::SearchOptions& search = page.record.question.search;
  const discover::VerdictOptions& verdict = page.record.question.verdict;
  const discover::SearchOptions usual_search;
  const discover::VerdictOptions usual_verdict;
  std::vector<std::string> texts;
  if (search.akaike) texts.push_back("Hypotheses are weighed by Akaike's criterion, not by evidence.");
  if (search.pairs_of != usual_search.pairs_of)
    texts.push_back(fmt::format("Pairs are tried of the best {} single effects.", search.pairs_of));
  if (verdict.gate != usual_verdict.gate)
    texts.push_back(fmt::format("The gate opens in {} of campaigns without a gap.", percent(verdict.gate)));
  if (verdict.stability != usual_verdict.stability)
    texts.push_back(fmt::format("A name must win in {} of half-samples.", percent(verdict.stability)));
  if (!verdict.unknown) texts.push_back("The answer UNKNOWN is switched off.");
  return texts.empty() ? "" : "<h3>Not the usual method</h3>\n" + list(texts);
}

std::string notes(const DiscoveryPage& page) {
  return page.record.notes.empty() ? "" : "<h3>Notes of the data</h3>\n" + list(page.record.notes);
}

}  // namespace

std::string doubts_section(const DiscoveryPage& page) {
  return section("Doubts", verdict_list(caution_verdicts(page)) + look_alike_table(page) +
                               isolability_part(page) + detectable_table(page) +
                               "<div class=\"columns\"><div>\n" + blind_spots(page) + not_tried_table(page) +
                               "</div><div>\n" + tolerances(page) + changed_method(page) + notes(page) +
                               "</div></div>\n");
}

}  // namespace heddle::pipeline
