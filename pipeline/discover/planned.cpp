#include "pipeline/discover/planned.h"

#include <algorithm>
#include <cmath>

#include "pipeline/discover/coordinates.h"

namespace heddle::discover {

namespace {

/// Slip of the first reading; the log-spaced bins of a pull start about there. Assumed.
constexpr double first_slip = 0.3e-3;

/// What noise_of takes where nothing is measured: all of it is as given or assumed.
CouponNoise assumed_noise(const NoiseWish& wish, int stretches, int faces) {
  CouponCampaign nothing;
  nothing.stretches = stretches;
  friction::CouponData no_data;
  no_data.days = {""};
  CouponNoise noise = noise_of(nothing, no_data, wish, faces);
  noise.notes.clear();  // advice for a table that was measured
  return noise;
}

}  // namespace

std::vector<double> planned_slips(int stretches, double pull_length) {
  const double low = std::min(first_slip, 0.1 * pull_length);
  std::vector<double> slips;
  for (int k = 0; k < stretches; ++k)
    slips.push_back(low * std::pow(pull_length / low, (k + 0.5) / stretches));
  return slips;
}

PlannedCampaign planned_campaign(const CouponQuestion& question, std::vector<CouponCell> cells, int stretches,
                                 std::size_t days) {
  PlannedCampaign campaign;
  const std::vector<double> slips = planned_slips(stretches, question.rig.rig.pull_length);
  for (CouponCell& cell : cells) {
    days = std::max(days, cell.day + 1);
    cell.points.clear();
    for (int k = 0; k < stretches; ++k)
      cell.points.push_back({.stretch = k,
                             .steady = stretches == 1,
                             .slip = stretches == 1 ? 0.0 : slips[static_cast<std::size_t>(k)],
                             .normal_force = cell.pull.normal_force});
  }
  campaign.cells = std::move(cells);
  campaign.noise = assumed_noise(question.noise, stretches, question.rig.faces);
  campaign.forward = coupon_forward(question.base, question.rig, campaign.cells, question.baseline,
                                    usable_effects(question.base, question.effects), days);
  campaign.observations.covariance = covariance_of(
      campaign.noise, campaign.cells, hersey_numbers(question.base, question.rig, campaign.cells));
  campaign.observations.form = question.noise.effect_form;
  campaign.observations.coordinates = form_coordinates(campaign.cells, question.noise.effect_form_length);
  campaign.baseline = planned_baseline(campaign.forward, campaign.observations.covariance);
  campaign.observations.value = campaign.baseline.data->value();
  return campaign;
}

Isolability isolability_of(const CouponQuestion& question, const PlannedCampaign& campaign) {
  return isolability_of(campaign.forward, campaign.baseline, campaign.observations,
                        {.seed = question.seed, .prior = question.search});
}

}  // namespace heddle::discover
