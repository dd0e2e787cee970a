#include "score.h"

#include <fmt/format.h>

#include <algorithm>

namespace heddle::blind {

using blindgen::Kind;

namespace {

std::vector<std::string> ids(const std::vector<Weighted>& items) {
  std::vector<std::string> list;
  for (const Weighted& item : items) list.push_back(item.id);
  return list;
}

bool contains(const std::vector<std::string>& list, const std::string& id) {
  return std::ranges::find(list, id) != list.end();
}

std::vector<std::string> truth_ids(const Judged& judged) {
  std::vector<std::string> list;
  for (const blindgen::Hidden& hidden : judged.truth) list.push_back(hidden.id);
  std::ranges::sort(list);
  return list;
}

std::vector<std::string> named_ids(const Judged& judged) {
  std::vector<std::string> list;
  if (judged.answer) list = ids(judged.answer->named);
  std::ranges::sort(list);
  return list;
}

bool names_exactly(const Judged& judged) {
  return judged.answer && judged.answer->gives_name() && named_ids(judged) == truth_ids(judged);
}

/// "a+b" as its two ids.
std::vector<std::string> split_set(const std::string& name) {
  std::vector<std::string> list;
  std::size_t at = 0;
  for (std::size_t plus; (plus = name.find('+', at)) != std::string::npos; at = plus + 1)
    list.push_back(name.substr(at, plus - at));
  list.push_back(name.substr(at));
  return list;
}

/// The first of the ranking that is one effect and not a set; empty if there is none.
std::string first_effect(const Answer& answer) {
  const auto found = std::ranges::find_if(
      answer.ranking, [](const Weighted& w) { return w.id.find('+') == std::string::npos; });
  return found == answer.ranking.end() ? "" : found->id;
}

/// The effect that stands first: the name given, or the head of a ONE_OF.
std::string first_name(const Judged& judged) {
  if (!judged.answer) return "";
  const Answer& answer = *judged.answer;
  if (answer.gives_name()) return answer.named.front().id;
  return answer.verdict == "ONE_OF" ? first_effect(answer) : "";
}

/// The most probable set of a ONE_OF.
std::vector<std::string> head_of(const Judged& judged) {
  if (!judged.answer || judged.answer->verdict != "ONE_OF" || judged.answer->ranking.empty()) return {};
  std::vector<std::string> set = split_set(judged.answer->ranking.front().id);
  std::ranges::sort(set);
  return set;
}

/// It is the truth, effect for effect.
bool heads_exactly(const Judged& judged) {
  return head_of(judged) == truth_ids(judged);
}

bool is_top1(const Judged& judged) {
  const bool head_of_set =
      judged.answer && judged.answer->verdict == "ONE_OF" && first_name(judged) == truth_ids(judged).front();
  return names_exactly(judged) || head_of_set;
}

/// A name or a set of names: what a null must never get.
bool gives_any_name(const Answer& answer) {
  return answer.gives_name() || answer.verdict == "ONE_OF";
}

bool is_confident_single(const Judged& judged) {
  return judged.answer && judged.answer->gives_name() && judged.answer->named.size() == 1 &&
         judged.answer->named.front().probability >= 0.9;
}

bool calls_it_physics(const Answer& answer) {
  if (!gives_any_name(answer)) return false;
  const std::vector<std::string> list = answer.gives_name() ? ids(answer.named) : answer.candidates;
  return answer.gives_name() ? !std::ranges::all_of(list, is_rig_effect)
                             : std::ranges::none_of(list, is_rig_effect);
}

bool finds_one(const Judged& judged) {
  const std::vector<std::string> truth = truth_ids(judged);
  const auto holds_one = [&](const std::vector<std::string>& list) {
    return std::ranges::any_of(list, [&](const std::string& id) { return contains(truth, id); });
  };
  return contains(truth, first_name(judged)) || holds_one(named_ids(judged)) || holds_one(head_of(judged));
}

void count_single(Scores& s, const Judged& judged) {
  const std::string truth = truth_ids(judged).front();
  s.top1.count(is_top1(judged));
  s.top1_of[truth].count(is_top1(judged));
  s.size_of[truth].push_back(judged.truth.front().size);
  s.named_alone.count(names_exactly(judged));
  const Answer* answer = judged.answer ? &*judged.answer : nullptr;
  s.first_ranked.count(answer && first_effect(*answer) == truth);
  s.candidate_set.count(answer && contains(answer->candidates, truth));
  if (is_confident_single(judged)) s.precision.count(names_exactly(judged));
  if (!answer) return;
  s.set_sizes.push_back(static_cast<double>(answer->candidates.size()));
  if (!answer->ranking.empty())
    s.forecasts.push_back({answer->ranking.front().probability, answer->ranking.front().id == truth});
  if (!answer->gives_name() || answer->saturated) return;
  // A name without a proof on held-out conditions is one that did not improve.
  s.improved.count(answer->held_out_before && answer->held_out_after &&
                   *answer->held_out_after < *answer->held_out_before);
  s.shrinks.push_back(answer->shrink.value_or(0.0));
}

void count_null(Scores& s, const Judged& judged) {
  const bool named = !judged.answer || gives_any_name(*judged.answer);
  s.null_named.count(named);
  if (judged.planned.spec.kind == Kind::null_exact) s.null_exact_named.count(named);
  s.null_name.count(!judged.answer || judged.answer->gives_name());
  s.null_gap.count(!judged.answer || judged.answer->verdict != "NO_GAP");
}

void count_pair(Scores& s, const Judged& judged) {
  const std::vector<std::string> truth = truth_ids(judged);
  s.pair_exact.count(names_exactly(judged) || heads_exactly(judged));
  s.pair_named.count(names_exactly(judged));
  s.pair_one.count(finds_one(judged));
  s.pair_false.count(!judged.answer || std::ranges::any_of(named_ids(judged), [&](const std::string& id) {
    return !contains(truth, id);
  }));
}

void count_outside(Scores& s, const Judged& judged) {
  const std::string verdict = judged.answer ? judged.answer->verdict : "";
  s.outside_clean.count(!judged.answer || verdict == "NAMED");
  s.outside_unknown.count(verdict == "UNKNOWN" || verdict == "NAMED_INCOMPLETE");
  s.outside_set.count(verdict == "ONE_OF");
  s.outside_unseen.count(verdict == "NO_GAP");
}

void count_rig(Scores& s, const Judged& judged) {
  s.rig_physics.count(!judged.answer || calls_it_physics(*judged.answer));
  s.rig_named.count(names_exactly(judged));
}

void count(Scores& s, const Judged& judged) {
  ++s.cases;
  if (!judged.answer) ++s.failed;
  s.wall_times.push_back(judged.wall_time);
  s.cpu_times.push_back(judged.cpu_time);
  ++s.confusion[truth_name(judged)][answer_name(judged)];
  if (is_confident_single(judged)) s.any_precision.count(names_exactly(judged));
  if (!went_well(judged)) s.failures.push_back(&judged);
  switch (judged.planned.spec.kind) {
    case Kind::single:
      return count_single(s, judged);
    case Kind::null:
    case Kind::null_exact:
      return count_null(s, judged);
    case Kind::pair:
      return count_pair(s, judged);
    case Kind::outside:
      return count_outside(s, judged);
    case Kind::rig:
      return count_rig(s, judged);
  }
}

std::string joined(const std::vector<std::string>& list) {
  return fmt::format("{}", fmt::join(list, "+"));
}

Requirement at_least(const std::string& what, const Rate& rate, double limit) {
  const double low = wilson(rate).low;
  return {what, fmt::format("{} of {}: {:.1f} %", rate.hits, rate.of, 100.0 * rate.value()),
          fmt::format("lower bound {:.1f} >= {:.0f} %", 100.0 * low, 100.0 * limit),
          rate.of > 0 ? std::optional(low >= limit) : std::nullopt};
}

Requirement at_most(const std::string& what, const Rate& rate, double limit) {
  const double high = wilson(rate).high;
  return {what, fmt::format("{} of {}: {:.1f} %", rate.hits, rate.of, 100.0 * rate.value()),
          fmt::format("upper bound {:.1f} <= {:.0f} %", 100.0 * high, 100.0 * limit),
          rate.of > 0 ? std::optional(high <= limit) : std::nullopt};
}

}  // namespace

bool is_rig_effect(const std::string& id) {
  const blindgen::Term* term = blindgen::term_named(id);
  return term != nullptr && term->origin == blindgen::Origin::rig;
}

std::string truth_name(const Judged& judged) {
  return judged.truth.empty() ? "nothing" : joined(truth_ids(judged));
}

std::string answer_name(const Judged& judged) {
  if (!judged.answer) return "no report";
  if (!judged.answer->gives_name()) return judged.answer->verdict;
  return joined(named_ids(judged)) + (judged.answer->verdict == "NAMED_INCOMPLETE" ? "*" : "");
}

bool went_well(const Judged& judged) {
  if (!judged.answer) return false;
  switch (judged.planned.spec.kind) {
    case Kind::single:
      return is_top1(judged);
    case Kind::null:
    case Kind::null_exact:
      return !gives_any_name(*judged.answer);
    case Kind::pair:
      return names_exactly(judged) || heads_exactly(judged);
    case Kind::outside:
      return judged.answer->verdict != "NAMED";
    case Kind::rig:
      return !calls_it_physics(*judged.answer);
  }
  return false;
}

Scores score(std::span<const Judged> cases) {
  Scores scores;
  for (const Judged& judged : cases) count(scores, judged);
  return scores;
}

std::vector<Requirement> requirements(const Scores& s) {
  const std::optional<double> shrink = median(s.shrinks);
  const double error = calibration_error(s.forecasts);
  // On an idle machine a case takes no longer than this; the wall clock of a campaign counts its neighbours
  // in.
  const double slowest = s.cpu_times.empty() ? 0.0 : std::ranges::max(s.cpu_times);
  return {at_least("one effect: top-1 name", s.top1, 0.94),
          at_least("one effect: single names at P >= 0.9 that are right", s.precision, 0.96),
          at_most("nothing hidden: named all the same", s.null_named, 0.07),
          at_most("outside the library: given a clean name", s.outside_clean, 0.06),
          at_least("two effects: exact set", s.pair_exact, 0.70),
          {"held-out gap: median shrink", shrink ? fmt::format("{:.1f} %", 100.0 * *shrink) : "none",
           "median >= 50 %", shrink ? std::optional(*shrink >= 0.50) : std::nullopt},
          at_least("held-out gap: improved", s.improved, 0.94),
          {"calibration error over 5 bins", fmt::format("{:.3f}", error), "error <= 0.05",
           s.forecasts.empty() ? std::nullopt : std::optional(error <= 0.05)},
          at_most("rig's own faults: called physics", s.rig_physics, 0.10),
          {"slowest case, processor time", fmt::format("{:.2f} s", slowest), "time < 5 s",
           s.cpu_times.empty() ? std::nullopt : std::optional(slowest < 5.0)}};
}

}  // namespace heddle::blind
