#include "pipeline/discover/verdict.h"

#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <limits>
#include <set>

namespace heddle::discover {

namespace {

/// Families by what the reader would call them; a set within one gets its name.
struct Family {
  const char* name;
  std::vector<const char*> ids;
};
const std::vector<Family>& families() {
  static const std::vector<Family> all{
      {"a tool-temperature effect", {"tool_temperature_film", "tool_temperature_shift", "solidification"}},
      {"a load effect",
       {"pressure_dependent_area", "adhesion", "boundary_lubrication", "load_cell_offset",
        "nonuniform_pressure"}},
      {"an effect at the start of the pull",
       {"static_peak", "dwell_ageing", "drive_backlash", "sliding_evolution", "wear"}},
      {"a time or slip history effect",
       {"sliding_evolution", "wear", "film_squeeze_out", "dwell_ageing", "static_peak",
        "normal_force_relaxation"}},
      {"a speed effect",
       {"stick_slip", "shear_heating", "viscosity_plateau", "boundary_lubrication", "shear_rate", "inertia",
        "tow_rate_stiffening"}},
      {"an effect of the fabric's shape",
       {"shear_locking", "tension_shear_coupling", "bending", "crimp_straightening",
        "shear_thermal_softening"}}};
  return all;
}

std::string family_of(const std::vector<std::string>& ids) {
  if (ids.size() < 2) return "";
  for (const Family& family : families())
    if (std::ranges::all_of(ids, [&](const std::string& id) {
          return std::ranges::find(family.ids, id) != family.ids.end();
        }))
      return family.name;
  return "";
}

/// Ids of the fewest hypotheses with effects whose share of the probability reaches `wanted`.
std::vector<std::string> set_of(const ForwardModel& model, const SearchResult& result, double wanted) {
  double total = 0.0;
  for (const Scored& one : result.scored)
    if (!one.fit.hypothesis.empty()) total += one.probability;
  std::vector<std::string> ids;
  double sum = 0.0;
  for (const Scored& one : result.scored) {
    if (one.fit.hypothesis.empty()) continue;
    for (const std::size_t effect : one.fit.hypothesis) {
      const std::string& id = model.candidates[effect].id;
      if (std::ranges::find(ids, id) == ids.end()) ids.push_back(id);
    }
    sum += one.probability;
    if (sum >= wanted * total) break;
  }
  return ids;
}

double squared_gap(const MapFit& fit) {
  return BesideBaseline(fit.jacobian).gap_of(fit).squaredNorm();
}

double top_evidence(const std::vector<Shape>& shapes) {
  return shapes.empty() ? 0.0 : shapes.front().log_evidence;
}

/// A free shape and its ln Bayes factor against none with its prior, as a name has both. Before the data an
/// unknown function of one factor is as likely as one effect, one of two factors as two effects; those of
/// each kind share that.
struct FreeShape {
  const Shape* shape = nullptr;
  double log_odds = -std::numeric_limits<double>::infinity();
};

FreeShape most_likely(const std::vector<Shape>& shapes, const SearchResult& result, int factors_max) {
  FreeShape best;
  for (const Shape& shape : shapes) {
    if (shape.factors > factors_max) continue;
    const auto alike = static_cast<double>(std::ranges::count(shapes, shape.factors, &Shape::factors));
    const double log_prior = shape.factors == 1 ? result.log_prior_one : result.log_prior_two;
    const double log_odds = shape.log_evidence + log_prior - std::log(alike);
    if (log_odds > best.log_odds) best = {&shape, log_odds};
  }
  return best;
}

std::string names(const ForwardModel& model, const Hypothesis& hypothesis) {
  std::vector<std::string> ids;
  for (const std::size_t effect : hypothesis) ids.push_back(model.candidates[effect].id);
  return fmt::format("{}", fmt::join(ids, " and "));
}

}  // namespace

const char* in_words(Answer answer) {
  constexpr std::array words{"NO_GAP", "NAMED", "ONE_OF", "NAMED_INCOMPLETE", "UNKNOWN"};
  return words[static_cast<std::size_t>(answer)];
}

double chi_square_tail(double chi2, double freedom) {
  const double scale = 2.0 / (9.0 * freedom);
  return normal_probability(-(std::cbrt(chi2 / freedom) - (1.0 - scale)) / std::sqrt(scale));
}

Decision decide(const ForwardModel& model, const SearchResult& result, const Evidence& evidence,
                const VerdictOptions& options) {
  Decision decision;
  const std::vector<Shape> none;
  const std::vector<Shape>& gap_shapes = options.unknown ? evidence.gap_shapes : none;
  const double gain = result.best_gain(), shape = top_evidence(gap_shapes);
  if (evidence.gate_p >= options.gate) {
    decision.reasons.push_back(fmt::format(
        "The largest of all contrasts and signatures is what noise alone gives in {:.2g} of campaigns.",
        evidence.gate_p));
    return decision;
  }
  if (gain <= options.bayes_factor && shape <= options.bayes_factor) {
    decision.reasons.push_back(fmt::format(
        "No effect (ln Bayes factor {:.1f}) and no smooth shape ({:.1f}) is {:g} better than none.", gain,
        shape, options.bayes_factor));
    return decision;
  }
  const auto best_of =
      std::ranges::find_if(result.scored, [](const Scored& one) { return !one.fit.hypothesis.empty(); });
  const Scored& best = *best_of;
  const auto size = static_cast<double>(best.fit.residual.size());
  const double before = result.gap.squaredNorm(), after = squared_gap(best.fit);
  decision.named = best.fit.hypothesis;
  decision.probability = best.probability;
  decision.lack_of_fit_p = chi_square_tail(after, size);
  decision.excess_removed = before > size ? std::min((before - after) / (before - size), 1.0) : 1.0;
  decision.candidate_set = set_of(model, result, options.set);
  decision.group = family_of(decision.candidate_set);
  const std::string name = names(model, best.fit.hypothesis);

  const double rest = top_evidence(evidence.rest_shapes);
  const bool something_left = decision.lack_of_fit_p < options.lack_of_fit || rest > options.bayes_factor;
  // What a free shape says of the gap is the measure of what a name may miss.
  const double captured = shape > options.bayes_factor ? gain / shape : 1.0;
  const double log_odds =
      gain + (best.fit.hypothesis.size() == 1 ? result.log_prior_one : result.log_prior_two);
  const FreeShape any = most_likely(gap_shapes, result, 2);
  const bool says_more = any.log_odds - log_odds > options.bayes_factor;
  if (gain <= options.bayes_factor ||
      (something_left && says_more &&
       (captured < options.captured || decision.excess_removed < options.excess))) {
    decision.answer = Answer::unknown;
    const Shape& said = says_more ? *any.shape : gap_shapes.front();
    decision.reasons.push_back(
        fmt::format("A smooth gap over {} (ln Bayes factor {:.1f}) says more than the best name, {} ({:.1f}, "
                    "which removes {:.0f} % of the excess).",
                    said.over, said.log_evidence, name, gain, 100.0 * decision.excess_removed));
    return decision;
  }
  // The numbers of two effects bend to any function of a factor both depend on: the pair must be likelier.
  const FreeShape one = most_likely(gap_shapes, result, 1);
  if (best.fit.hypothesis.size() == 2 && one.log_odds - log_odds > options.bayes_factor) {
    decision.answer = Answer::unknown;
    decision.reasons.push_back(
        fmt::format("One unknown function of {} (ln Bayes factor {:.1f}) is more likely than two names at "
                    "once, {} ({:.1f}).",
                    one.shape->over, one.shape->log_evidence, name, gain));
    return decision;
  }
  const bool alone = best.probability >= options.probability;
  const auto other = std::ranges::find_if(
      evidence.priors, [&](const UnderPrior& under) { return names(model, under.best) != name; });
  const bool flips = other != evidence.priors.end();
  if (alone && evidence.scatter_known && evidence.stability >= options.stability && !flips) {
    const bool incomplete = something_left || decision.excess_removed < options.excess;
    decision.answer = incomplete ? Answer::named_incomplete : Answer::named;
    decision.reasons.push_back(
        fmt::format("{} has the probability {:.3f}, ln Bayes factor {:.1f} against none, and "
                    "wins in {:.0f} % of half-samples.",
                    name, best.probability, gain, 100.0 * evidence.stability));
    if (incomplete)
      decision.reasons.push_back(fmt::format(
          "Something is left over: {:.0f} % of the excess is removed, p {:.2g}, smooth gap over {} {:.1f}.",
          100.0 * decision.excess_removed, decision.lack_of_fit_p,
          evidence.rest_shapes.empty() ? "nothing" : evidence.rest_shapes.front().over, rest));
    return decision;
  }
  decision.answer = Answer::one_of;
  if (alone) {
    // What demoted it leaves its look-alikes open.
    const auto open_up = [&](const std::string& id) {
      if (std::ranges::find(decision.candidate_set, id) == decision.candidate_set.end() &&
          std::ranges::any_of(model.candidates, [&](const Candidate& c) { return c.id == id; }))
        decision.candidate_set.push_back(id);
    };
    for (const std::size_t effect : best.fit.hypothesis)
      for (const std::string& id : model.candidates[effect].look_alikes) open_up(id);
    std::string but = "the scatter is assumed: no one name is given, its look-alikes stay open.";
    if (evidence.scatter_known && evidence.stability < options.stability)
      but = fmt::format("it wins in only {:.0f} % of half-samples; its look-alikes stay open.",
                        100.0 * evidence.stability);
    else if (evidence.scatter_known) {
      for (const std::size_t effect : other->best) open_up(model.candidates[effect].id);
      but = fmt::format("with priors of the effects {:g} times as wide it is {}.", other->width,
                        other->best.empty() ? "no effect" : names(model, other->best));
    }
    decision.group = family_of(decision.candidate_set);
    decision.reasons.push_back(
        fmt::format("{} is most probable ({:.2f}), but {}", name, best.probability, but));
  } else {
    decision.reasons.push_back(
        fmt::format("The best name, {}, has the probability {:.2f} only.", name, best.probability));
  }
  return decision;
}

}  // namespace heddle::discover
