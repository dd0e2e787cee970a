#include "pipeline/discover/discovery.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>

#include "core/problem.h"
#include "pipeline/discover/coordinates.h"
#include "pipeline/discover/foresight.h"
#include "pipeline/discover/stability.h"

namespace heddle::discover {

namespace {

/// Different seeds for different draws, from the one of the case.
enum class Draw : std::uint64_t { split = 1, noise, stability, bootstrap, isolability, outcomes, folds };
std::uint64_t seed_of(std::uint64_t seed, Draw draw) {
  return seed * 1000003u + static_cast<std::uint64_t>(draw);
}

Observations observations_of(const std::vector<CouponCell>& cells, const CouponNoise& noise,
                             const std::vector<double>& hersey) {
  Observations observations;
  std::vector<double> values;
  for (const CouponCell& cell : cells)
    for (const CouponPoint& point : cell.points) values.push_back(point.log_force);
  observations.value = Eigen::Map<const Eigen::VectorXd>(values.data(), std::ssize(values));
  observations.covariance = covariance_of(noise, cells, hersey);
  return observations;
}

/// R6: the cell that lies furthest from the baseline, and the conditions whose forces it may carry: the three
/// whose predicted force is nearest to what was measured under the label, one way and exchanged.
void add_mislabelled(CouponFindings& findings, const CouponQuestion& question, const MapFit& baseline) {
  const auto library = std::ranges::find(question.effects, "mislabelled_condition", &EffectFile::id);
  const std::vector<CouponCell>& training = findings.training;
  if (library == question.effects.end() || training.size() < 6) return;
  std::vector<CouponCell> all = training;
  const std::vector<CouponCell> held_out = pick(findings.campaign.cells, findings.split.held_out);
  all.insert(all.end(), held_out.begin(), held_out.end());
  const Eigen::VectorXd predicted =
      coupon_forward(question.base, question.rig, all, question.baseline, {}, findings.campaign.days.size())
          .predict(baseline.trial);
  std::vector<double> off, mean;
  Eigen::Index row = 0;
  for (const CouponCell& cell : all) {
    const auto count = static_cast<double>(cell.points.size());
    off.push_back(0.0);
    mean.push_back(0.0);
    for (const CouponPoint& point : cell.points) {
      off.back() += (point.log_force - predicted[row]) / count;
      mean.back() += predicted[row++] / count;
    }
  }
  off.resize(training.size());
  const auto worst = static_cast<std::size_t>(
      std::ranges::max_element(off, {}, [](double x) { return std::abs(x); }) - off.begin());
  std::vector<std::size_t> order;
  for (std::size_t c = 0; c < all.size(); ++c)
    if (all[c].condition != training[worst].condition) order.push_back(c);
  std::ranges::stable_sort(order, {},
                           [&](std::size_t c) { return std::abs(mean[c] - mean[worst] - off[worst]); });
  order.resize(std::min<std::size_t>(order.size(), 3));
  for (const std::size_t truly : order) {
    const std::string under =
        fmt::format("{} measured under the label of {}", all[truly].pull.name, training[worst].pull.name);
    const auto add = [&](const WrongLabel& label, const std::string& words) {
      findings.forward.candidates.push_back(
          mislabelled(library->candidate(), label, words, findings.campaign.condition_names.size()));
    };
    // Numbered as the forward model does: training cells, then all conditions.
    add({.cell = worst, .truly = training.size() + truly}, under);
    if (truly < training.size())
      add({.cell = worst, .truly = training.size() + truly, .partner = truly},
          under + ", and the other way round");
  }
}

/// What a trial predicts of other cells. A wrong label belongs to the cell that carries it.
Eigen::VectorXd predict_elsewhere(const CouponQuestion& question, const CouponFindings& findings,
                                  const std::vector<CouponCell>& cells, Trial trial,
                                  std::size_t library_size) {
  const ForwardModel elsewhere =
      coupon_forward(question.base, question.rig, cells, question.baseline,
                     usable_effects(question.base, question.effects), findings.campaign.days.size());
  std::erase_if(trial.effects, [&](const auto& effect) { return effect.first >= library_size; });
  return elsewhere.predict(trial);
}

/// What the training pulls of each day say of the day's shift of ln F where a trial holds: its mean given
/// their residuals, and its variance. A held-out cell shares the shift of its day.
/// @param data  with the covariance of their residuals
struct DayShifts {
  std::vector<double> mean, variance;
};

DayShifts shifts_of(const CouponFindings& findings, const Trial& trial, const Whitened& data) {
  const std::size_t days = findings.campaign.days.size();
  const Eigen::VectorXd residual = data.residual(findings.forward.predict(trial));
  Eigen::MatrixXd share = Eigen::MatrixXd::Zero(residual.size(), static_cast<Eigen::Index>(days));
  Eigen::Index row = 0;
  for (const CouponCell& cell : findings.training)
    for (std::size_t k = 0; k < cell.points.size(); ++k)
      share(row++, static_cast<Eigen::Index>(cell.day)) = 1.0;
  const double square = findings.noise.day * findings.noise.day;
  const Eigen::MatrixXd whitened = data(share);
  DayShifts shifts;
  for (Eigen::Index day = 0; day < share.cols(); ++day) {
    shifts.mean.push_back(-square * whitened.col(day).dot(residual));  // measured less model
    shifts.variance.push_back(square - square * square * whitened.col(day).squaredNorm());
  }
  return shifts;
}

std::vector<HeldOut> validate(const CouponQuestion& question, const CouponFindings& findings,
                              const Scored& named, std::size_t library_size) {
  const std::vector<CouponCell> cells = pick(findings.campaign.cells, findings.split.held_out);
  const MapFit& before = findings.result.baseline;
  const Trial& after = named.numbers.trial;
  const Eigen::VectorXd base = predict_elsewhere(question, findings, cells, before.trial, library_size);
  const Eigen::VectorXd with = predict_elsewhere(question, findings, cells, after, library_size);
  const DayShifts days_before = shifts_of(findings, before.trial, *before.data),
                  days_after = shifts_of(findings, after, *named.fit.data);
  std::vector<HeldOut> held_out;
  Eigen::Index row = 0;
  for (std::size_t c = 0; c < cells.size(); ++c) {
    HeldOut one{.cell = findings.split.held_out[c]};
    const auto count = static_cast<double>(cells[c].points.size());
    double noise = 0.0;
    for (const CouponPoint& point : cells[c].points) {
      const double b = base[row] + days_before.mean[cells[c].day] - point.log_force,
                   a = with[row] + days_after.mean[cells[c].day] - point.log_force;
      one.before += b * b / count;
      one.after += a * a / count;
      noise += (findings.noise.sample(point.stretch, point.stretch) / cells[c].samples +
                days_after.variance[cells[c].day]) /
               count;
      ++row;
    }
    one.before = std::sqrt(one.before);
    one.after = std::sqrt(one.after);
    one.noise = std::sqrt(noise);
    held_out.push_back(one);
  }
  return held_out;
}

const MapFit* best_with_effects(const SearchResult& result) {
  for (const Scored& one : result.scored)
    if (!one.fit.hypothesis.empty()) return &one.fit;
  return nullptr;
}

void pass_gate(CouponFindings& findings) {
  for (const Contrast& contrast : findings.contrasts) {
    const double statistic = std::abs(contrast.direction.dot(findings.result.gap));
    if (statistic <= findings.gate_statistic) continue;
    findings.gate_statistic = statistic;
    findings.gate_from = fmt::format("{}, {}", contrast.factor, contrast.segment);
  }
  for (const Signature& signature : findings.result.signatures) {
    if (std::abs(signature.score) <= findings.gate_statistic) continue;
    findings.gate_statistic = std::abs(signature.score);
    findings.gate_from = fmt::format("signature of {}", findings.forward.candidates[signature.effect].id);
  }
  findings.evidence.gate_p = family_wise_p(findings.largest, findings.gate_statistic);
}

}  // namespace

friction::Model CouponFindings::patched(const friction::Model& base) const {
  const Scored* named = decision.named.empty() ? nullptr : result.find(decision.named);
  const MapFit& fit = named != nullptr ? named->numbers : result.baseline;
  return patched_model(base, forward, fit.trial);
}

Prior usual_prior(const friction::ModelNumber& number) {
  Prior prior{.kind = Prior::Kind::normal, .centre = number.value, .scale = 0.1};
  if (number.key == "resin.power_index")
    prior.scale = 0.04;
  else if (number.key == "resin.activation_energy")
    prior.scale = 0.1 * number.value;
  else if (number.range.low >= 0.0 && number.value > 0.0)
    prior = {.kind = Prior::Kind::log_normal, .centre = number.value, .scale = 2.0};
  else
    prior.scale = std::max(std::abs(number.value), 0.1);
  // An open end is none of the values that the number may have.
  prior.low = number.range.low_open ? std::nextafter(number.range.low, INFINITY) : number.range.low;
  prior.high = number.range.high_open ? std::nextafter(number.range.high, -INFINITY) : number.range.high;
  return prior;
}

void judge(CouponFindings& findings, const Observations& observations, const CouponQuestion& question) {
  findings.result = search(findings.forward, observations, question.search);
  const Whitened& whitened = *findings.result.baseline.data;
  const BesideBaseline beside(findings.result.baseline.jacobian);
  findings.contrasts = contrasts_of(findings.training, whitened, beside);
  findings.largest = largest_of_noise(findings.contrasts, findings.result.signatures, whitened.size(), 999,
                                      seed_of(question.seed, Draw::noise));
  findings.locations = locate(findings.contrasts, findings.result.gap, findings.largest);
  pass_gate(findings);

  const MapFit* best = best_with_effects(findings.result);
  findings.evidence.scatter_known = findings.noise.sample_source != friction::Scatter::Source::assumed;
  findings.evidence.gap_shapes = shapes_of(findings.training, findings.result.baseline, question.tow_pitch);
  if (best != nullptr) {
    findings.evidence.rest_shapes = shapes_of(findings.training, *best, question.tow_pitch);
    findings.evidence.stability =
        stability_of(findings.result, findings.training, seed_of(question.seed, Draw::stability));
    findings.evidence.priors = under_other_priors(findings.result);
  }
  findings.decision = decide(findings.forward, findings.result, findings.evidence, question.verdict);
  if (Scored* named = findings.result.find(findings.decision.named);
      named != nullptr && !findings.decision.named.empty())
    named->numbers = best_in_foresight(findings.forward, observations, findings.training, named->numbers,
                                       seed_of(question.seed, Draw::folds));
}

CouponFindings discover_in_coupons(const CouponQuestion& question, const friction::CouponData& data) {
  CouponFindings findings;
  int stretches = 1;
  for (const friction::CouponRow& row : data.rows) stretches = std::max(stretches, row.stretch + 1);
  findings.campaign = campaign_of(data, stretches);
  findings.notes = findings.campaign.notes;
  findings.split =
      split_conditions(findings.campaign, question.held_out, seed_of(question.seed, Draw::split));
  findings.training = pick(findings.campaign.cells, findings.split.training);
  findings.noise = noise_of(findings.campaign, data, question.noise, question.rig.faces);
  findings.notes.insert(findings.notes.end(), findings.noise.notes.begin(), findings.noise.notes.end());

  const std::vector<EffectFile> usable = usable_effects(question.base, question.effects, &findings.refused);
  std::vector<CouponCell> conditions = findings.training;
  const std::vector<CouponCell> unseen = pick(findings.campaign.cells, findings.split.held_out);
  conditions.insert(conditions.end(), unseen.begin(), unseen.end());
  findings.forward = coupon_forward(question.base, question.rig, findings.training, question.baseline, usable,
                                    findings.campaign.days.size(), conditions);
  const std::size_t library_size = findings.forward.candidates.size();

  // The form of the law wanders over ln Hs, which only a fitted law knows: fit, then weigh, then fit again.
  Observations observations = observations_of(findings.training, findings.noise, {});
  const Eigen::VectorXd start = Eigen::VectorXd::Zero(std::ssize(free_numbers(findings.forward, {})));
  const MapFit first =
      map_fit(findings.forward, std::make_shared<const Whitened>(observations.value, observations.covariance),
              {}, start);
  if (!std::isfinite(first.log_evidence))
    throw NumericalError("discover: the baseline model has no finite force for every condition of the data");
  const friction::Model fitted = patched_model(question.base, findings.forward, first.trial);
  observations = observations_of(findings.training, findings.noise,
                                 hersey_numbers(fitted, question.rig, findings.training));
  observations.form = question.noise.effect_form;
  observations.coordinates = form_coordinates(findings.training, question.noise.effect_form_length);
  add_mislabelled(findings, question, first);

  judge(findings, observations, question);
  findings.isolability =
      isolability_of(findings.forward, findings.result.baseline, observations,
                     {.seed = seed_of(question.seed, Draw::isolability), .prior = question.search});

  const auto numbers = static_cast<std::size_t>(
      findings.decision.named.empty() ? start.size()
                                      : findings.result.find(findings.decision.named)->fit.z.size());
  findings.saturated = findings.training.size() <= numbers;
  if (!findings.split.held_out.empty() && !findings.decision.named.empty()) {
    findings.held_out =
        validate(question, findings, *findings.result.find(findings.decision.named), library_size);
    findings.gap = gap_of(findings.held_out, seed_of(question.seed, Draw::bootstrap));
  }
  return findings;
}

}  // namespace heddle::discover
