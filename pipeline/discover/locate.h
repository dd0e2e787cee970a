#pragma once

#include <Eigen/Core>
#include <cstdint>
#include <string>
#include <vector>

#include "pipeline/discover/coupon_campaign.h"
#include "pipeline/discover/map_fit.h"
#include "pipeline/discover/signature.h"

namespace heddle::discover {

/// A direction in the space of observations that a reader can name: a factor, a product of two or one of its
/// levels, over the whole pull, its start, its end or along it.
struct Contrast {
  std::string factor;   ///< "tool_temperature", "tool_temperature x velocity", "tool_temperature = 21 degC"
  std::string segment;  ///< "whole pull", "start", "steady", "trend"
  Eigen::VectorXd direction;  ///< unit length, whitened, beside the baseline
};

struct Location {
  std::string factor, segment;
  double statistic = 0.0;  ///< standard normal where nothing is missing
  double p_value = 1.0;    ///< family-wise: that the largest of all contrasts of noise alone is as large
};

/// Main effects, levels and products of the factors that vary, each over every segment of the pull. What the
/// baseline already takes up (a direction that it shortens below a fifth) is left out.
std::vector<Contrast> contrasts_of(const std::vector<CouponCell>& cells, const Whitened& data,
                                   const BesideBaseline& beside);

/// How large the largest statistic of noise alone is: `draws` draws, sorted. One family for the contrasts and
/// the signatures, by which the gate decides too. The gap of noise is white, so the draws are products with
/// white numbers.
std::vector<double> largest_of_noise(const std::vector<Contrast>& contrasts,
                                     const std::vector<Signature>& signatures, Eigen::Index size, int draws,
                                     std::uint64_t seed);

/// That noise alone gives a statistic as large, (1 + draws as large)/(1 + draws).
double family_wise_p(const std::vector<double>& largest, double statistic);

/// The strongest of each factor, most significant first.
std::vector<Location> locate(const std::vector<Contrast>& contrasts, const Eigen::VectorXd& gap,
                             const std::vector<double>& largest);

}  // namespace heddle::discover
