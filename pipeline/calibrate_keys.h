#pragma once

#include <map>
#include <string>
#include <vector>

#include "core/problem.h"
#include "friction/calibration/coupon_fit.h"
#include "pipeline/config_reader.h"
#include "pipeline/config_schema.h"

namespace heddle::pipeline {

/// What the block `calibrate` asks for. Numbers, bounds and priors are matched to a model only when the data
/// are read.
struct CalibrateSpec {
  std::vector<std::string> numbers;  ///< keys; empty: the constants that a run would fit
  std::map<std::string, std::array<double, 2>> bounds;
  std::map<std::string, friction::Prior> priors;
  friction::Loss loss = friction::Loss::none;
  double loss_scale = 2.0;
  friction::NoiseSpec noise;
  double confidence = 0.95;
  friction::CouponReduction reduction;
};

std::vector<Key> calibrate_keys();
CalibrateSpec calibrate_of(const Settings& settings);
/// Bounds and priors of numbers that are not to be fitted.
Problems check_calibrate(const CalibrateSpec& spec, const Settings& settings);

/// The wish as the fit takes it. The range that the configuration allows a number bounds it as well, so that
/// what is found can be written into a case.
friction::CouponFitSpec fit_spec_of(const CalibrateSpec& spec, const std::vector<std::string>& numbers);

}  // namespace heddle::pipeline
