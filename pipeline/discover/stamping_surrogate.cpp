#include "pipeline/discover/stamping_surrogate.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <stdexcept>

#include "core/problem.h"

namespace heddle::discover {

namespace {

Eigen::VectorXd centres(const std::vector<Unknown>& numbers) {
  Eigen::VectorXd values(std::ssize(numbers));
  for (std::size_t k = 0; k < numbers.size(); ++k)
    values[static_cast<Eigen::Index>(k)] = numbers[k].prior.value_at(0.0);
  return values;
}

void demand_one_free_number(const Candidate& candidate) {
  const auto free =
      std::ranges::count_if(candidate.numbers, [](const Unknown& n) { return n.prior.is_free(); });
  if (free != 1 || !candidate.numbers.front().prior.is_free())
    throw std::logic_error(fmt::format(
        "affine surrogate: candidate {} has {} free numbers, not its amplitude alone", candidate.id, free));
}

/// Slopes at two step sizes, and how far they agree.
struct TwoSlopes {
  Eigen::VectorXd slope;  ///< of half the step
  double change = 0.0, disagreement = 0.0;
};
TwoSlopes two_slopes(const Eigen::VectorXd& here, const Eigen::VectorXd& at_step,
                     const Eigen::VectorXd& at_half, double step) {
  const Eigen::VectorXd full = (at_step - here) / step, half = (at_half - here) / (0.5 * step);
  const double length = half.norm();
  return {.slope = half,
          .change = (at_step - here).cwiseAbs().maxCoeff(),
          .disagreement = length > 0.0 ? (full - half).norm() / length : 0.0};
}

/// Moves one number of the baseline by one standard deviation of its prior and by half of that.
Eigen::VectorXd slope_of_number(const ForwardModel& dear, const Trial& centre, const Eigen::VectorXd& here,
                                std::size_t number, SlopeCheck& check) {
  const Unknown& unknown = dear.baseline[number];
  const auto k = static_cast<Eigen::Index>(number);
  check.key = unknown.key;
  check.step = unknown.prior.value_at(1.0) - unknown.prior.value_at(0.0);
  const auto predict = [&](double step) {
    Trial trial = centre;
    trial.baseline[k] += step;
    return dear.predict(trial);
  };
  const Eigen::VectorXd full = predict(check.step), half = predict(0.5 * check.step);
  if (!full.allFinite() || !half.allFinite())
    throw NumericalError(
        fmt::format("discover: no finite prediction where {} is moved by {:g}", unknown.key, check.step));
  const TwoSlopes slopes = two_slopes(here, full, half, check.step);
  check.change = slopes.change;
  check.disagreement = slopes.disagreement;
  return slopes.slope;
}

/// What one value of an amplitude changes.
struct Stamped {
  double value = 0.0;
  Eigen::VectorXd change;
};

/// Switches one effect on, further and further until it is clear and half as far says the same slope.
Eigen::VectorXd slope_of_effect(const ForwardModel& dear, const Trial& centre, const Eigen::VectorXd& here,
                                std::size_t effect, const SurrogateOptions& options, SlopeCheck& check,
                                std::vector<Stamped>& stamped) {
  const Candidate& candidate = dear.candidates[effect];
  const Unknown& amplitude = candidate.numbers.front();
  const double off = amplitude.prior.value_at(0.0);
  check.id = candidate.id;
  check.key = amplitude.key;
  check.detail = candidate.detail;
  const auto predict = [&](double value) {
    Trial trial = centre;
    Eigen::VectorXd values = centres(candidate.numbers);
    values[0] = value;
    trial.effects.emplace_back(effect, std::move(values));
    return dear.predict(trial);
  };
  for (double z = 1.0; z <= options.farthest; z += 1.0) {
    check.step = amplitude.prior.value_at(z) - off;
    const Eigen::VectorXd full = predict(off + check.step);
    if (!full.allFinite()) {
      check.refused = fmt::format("there is no prediction at {} = {:g}", amplitude.key, off + check.step);
      return {};
    }
    check.change = (full - here).cwiseAbs().maxCoeff();
    const bool last = z + 1.0 > options.farthest;
    if (check.change < options.smallest_change || (check.change < options.clear_change && !last)) continue;
    const Eigen::VectorXd half = predict(off + 0.5 * check.step);
    if (!half.allFinite()) {
      check.refused =
          fmt::format("there is no prediction at {} = {:g}", amplitude.key, off + 0.5 * check.step);
      return {};
    }
    const TwoSlopes slopes = two_slopes(here, full, half, check.step);
    check.disagreement = slopes.disagreement;
    stamped.push_back({off + 0.5 * check.step, half - here});
    stamped.push_back({off + check.step, full - here});
    if (check.disagreement <= options.disagreement) return slopes.slope;
  }
  check.refused =
      check.change < options.smallest_change
          ? fmt::format("changes the force by {:.2g} % at most, even at {} = {:g}: not to be seen here",
                        100.0 * check.change, amplitude.key, off + check.step)
          : fmt::format(
                "its slopes at two step sizes of {} ({:g} and half of it) differ by {:.0f} %, more than "
                "{:.0f} %",
                amplitude.key, check.step, 100.0 * check.disagreement, 100.0 * options.disagreement);
  return {};
}

double rms(const Eigen::VectorXd& values) {
  return values.norm() / std::sqrt(static_cast<double>(values.size()));
}

}  // namespace

Eigen::VectorXd AffineModel::operator()(const Trial& trial) const {
  Eigen::VectorXd on = off;
  for (const auto& [effect, values] : trial.effects) on[static_cast<Eigen::Index>(effect)] = values[0];
  return value + number_slopes * (trial.baseline - numbers) + effect_slopes * (on - amplitudes);
}

Trial Surrogate::for_dear(Trial trial) const {
  for (auto& [effect, values] : trial.effects) effect = dear[effect];
  return trial;
}

Surrogate affine_surrogate(const ForwardModel& dear, const SurrogateOptions& options) {
  for (const Candidate& candidate : dear.candidates) demand_one_free_number(candidate);
  Surrogate surrogate;
  const Trial centre{.baseline = centres(dear.baseline), .effects = {}};
  const Eigen::VectorXd here = dear.predict(centre);
  if (!here.allFinite()) throw NumericalError("discover: the baseline itself has no finite prediction");
  AffineModel& affine = surrogate.affine;
  affine.value = here;
  affine.numbers = centre.baseline;
  affine.number_slopes.resize(here.size(), std::ssize(dear.baseline));
  for (std::size_t k = 0; k < dear.baseline.size(); ++k)
    affine.number_slopes.col(static_cast<Eigen::Index>(k)) =
        dear.baseline[k].prior.is_free()
            ? slope_of_number(dear, centre, here, k, surrogate.checks.emplace_back())
            : Eigen::VectorXd::Zero(here.size());
  std::vector<Eigen::VectorXd> slopes;
  std::vector<double> off;
  surrogate.model.baseline = dear.baseline;
  for (std::size_t effect = 0; effect < dear.candidates.size(); ++effect) {
    SlopeCheck& check = surrogate.checks.emplace_back();
    std::vector<Stamped> stamped;
    Eigen::VectorXd slope = slope_of_effect(dear, centre, here, effect, options, check, stamped);
    const auto add = [&](Candidate candidate, Eigen::VectorXd column) {
      surrogate.model.candidates.push_back(std::move(candidate));
      surrogate.dear.push_back(effect);
      off.push_back(dear.candidates[effect].numbers.front().prior.value_at(0.0));
      slopes.push_back(std::move(column));
    };
    if (check.refused.empty()) {
      add(dear.candidates[effect], std::move(slope));
      continue;
    }
    // Without a slope it is a rival still: at each value that was run, where the change is exact.
    check.values = static_cast<int>(stamped.size());
    for (const Stamped& one : stamped) {
      Candidate choice = dear.candidates[effect];
      choice.numbers.front().prior = {.kind = Prior::Kind::fixed, .centre = one.value};
      choice.log_weight -= std::log(static_cast<double>(stamped.size()));
      choice.detail = fmt::format("{} = {:g}", check.key, one.value);
      add(std::move(choice),
          one.change / (one.value - dear.candidates[effect].numbers.front().prior.value_at(0.0)));
    }
  }
  const auto count = std::ssize(slopes);
  affine.effect_slopes.resize(here.size(), count);
  affine.off.resize(count);
  for (Eigen::Index e = 0; e < count; ++e) {
    const auto at = static_cast<std::size_t>(e);
    affine.effect_slopes.col(e) = slopes[at];
    affine.off[e] = off[at];
  }
  affine.amplitudes = affine.off;
  surrogate.model.predict = affine;
  return surrogate;
}

TrueRun true_run(const ForwardModel& dear, const Surrogate& surrogate, const Trial& trial) {
  TrueRun run;
  run.value = dear.predict(surrogate.for_dear(trial));
  run.finite = run.value.allFinite();
  if (!run.finite) return run;
  run.size = rms(run.value - surrogate.affine.value);
  run.difference = rms(run.value - surrogate.affine(trial));
  return run;
}

ForwardModel relinearised(const ForwardModel& dear, const Surrogate& surrogate, const Trial& trial,
                          const TrueRun& run) {
  AffineModel affine = surrogate.affine;
  affine.value = run.value;
  affine.numbers = trial.baseline;
  const auto slope = [&](const Trial& moved, double step, const std::string& key) {
    const Eigen::VectorXd value = dear.predict(surrogate.for_dear(moved));
    if (!value.allFinite())
      throw NumericalError(
          fmt::format("discover: no finite prediction where {} is moved by {:g}", key, step));
    return Eigen::VectorXd((value - run.value) / step);
  };
  for (std::size_t k = 0; k < dear.baseline.size(); ++k) {
    const Prior& prior = dear.baseline[k].prior;
    if (!prior.is_free()) continue;
    const double step = 0.5 * (prior.value_at(1.0) - prior.value_at(0.0));
    Trial moved = trial;
    moved.baseline[static_cast<Eigen::Index>(k)] += step;
    affine.number_slopes.col(static_cast<Eigen::Index>(k)) = slope(moved, step, dear.baseline[k].key);
  }
  for (std::size_t e = 0; e < trial.effects.size(); ++e) {
    const auto candidate = static_cast<Eigen::Index>(trial.effects[e].first);
    affine.amplitudes[candidate] = trial.effects[e].second[0];
    // A tenth of what it is: near enough, and far above what the solver leaves.
    const double step = 0.1 * (affine.amplitudes[candidate] - affine.off[candidate]);
    const Candidate& effect = surrogate.model.candidates[trial.effects[e].first];
    if (step == 0.0 || !effect.numbers.front().prior.is_free()) continue;
    Trial moved = trial;
    moved.effects[e].second[0] += step;
    affine.effect_slopes.col(candidate) =
        slope(moved, step, surrogate.model.candidates[trial.effects[e].first].numbers.front().key);
  }
  ForwardModel model = surrogate.model;
  model.predict = affine;
  return model;
}

}  // namespace heddle::discover
