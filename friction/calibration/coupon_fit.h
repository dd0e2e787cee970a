#pragma once

#include <Eigen/Core>
#include <array>
#include <optional>
#include <span>
#include <string>
#include <vector>

#include "friction/calibration/coupon_data.h"
#include "friction/calibration/robust_fit.h"
#include "friction/calibration/scatter.h"
#include "friction/friction_test.h"
#include "friction/model.h"

namespace heddle::friction {

/// Normal belief about a number from elsewhere.
struct Prior {
  double mean = 0.0, sd = 0.0;
};

/// One number that the fit moves, started where the model has it.
struct FreeNumber {
  std::string key;                                   ///< one of numbers_of(model)
  std::optional<std::array<double, 2>> bounds = {};  ///< closed, within the number's own range; {low, high}
  std::optional<Prior> prior = {};
};

/// Standard deviations of ln F, where the user gives them.
struct NoiseSpec {
  std::optional<double> sample = {};  ///< empty: estimated from replicates, else from the residuals
  std::optional<double> day = {};     ///< empty: estimated from anchors, else `day_assumed`
  double day_assumed = 0.02;          ///< rig to rig and day to day; prior
  double reading = 0.01;              ///< of a stretch of a pull; prior
};

struct CouponFitSpec {
  std::vector<FreeNumber> numbers;
  Loss loss = Loss::none;
  double loss_scale = 2.0;  ///< in standard deviations of a sample
  NoiseSpec noise;
  int faces = 2;  ///< F = faces mu N
  double confidence = 0.95;
  int iterations_max = 300;
};

struct FittedNumber {
  std::string key, unit;
  double value = 0.0;
  /// Standard deviation and the ends of the interval. Empty where the data do not fix the number alone, where
  /// it ended at a bound, or where no scatter is known (saturated).
  std::optional<double> sd = {};
  std::optional<std::array<double, 2>> interval = {};
  double degrees_of_freedom = 0.0;  ///< behind the interval (Satterthwaite); 0 = normal
  bool at_bound = false;
  bool told_apart = true;  ///< false: the data fix it only together with others, see CouponFit::confusions
  std::optional<Prior> prior = {};
  bool exact_slope = true;  ///< its column of the Jacobian holds no differences
};

/// Numbers that the data cannot tell apart, or hardly.
struct Confusion {
  std::vector<std::string> keys;
  std::vector<double> change;  ///< relative changes that together move no force, largest 1; one a key
  bool total = true;           ///< false: the correlation of a pair is high, not complete
  std::string words = {};      ///< one sentence
};

/// One row of the data beside the fit.
struct CouponResidual {
  double mu = 0.0;            ///< of the fitted model, without the shift of the day
  double pull_force = 0.0;    ///< of the fitted model [N]
  double hersey = 0.0;        ///< [-], 0 where the law has none
  double log_error = 0.0;     ///< ln(F_model / F_measured) [-]
  double standardised = 0.0;  ///< with its day's shift, in standard deviations; 0 where none is known
  double weight = 1.0;        ///< of its sample under the loss
  Context context;
};

/// A model fitted to coupons, and how far it is known.
struct CouponFit {
  Model model;  ///< with the fitted numbers, and the box of the rows
  std::vector<FittedNumber> numbers;
  std::vector<std::string> keys;  ///< of the rows and columns of the matrices below
  Eigen::MatrixXd covariance;     ///< of the numbers, SI; of size 0 where no scatter is known
  Eigen::MatrixXd correlation;    ///< of the numbers; rows of those not told apart are 0
  NoiseModel noise;
  std::vector<double> day_shifts;  ///< of ln F, one a day; empty without a day effect
  std::vector<CouponResidual> rows;
  std::vector<Confusion> confusions;
  int degrees_of_freedom = 0;   ///< samples + priors - numbers, those not told apart counted once
  int from_priors = 0;          ///< how many of them are priors
  double rms_error = 0.0;       ///< of F_model / F_measured - 1
  double worst_difference = 0;  ///< largest NumberSlope::error met
  LeastSquaresSummary summary;

  /// As many numbers as samples and priors: the rows are met exactly and state no scatter.
  bool saturated() const { return degrees_of_freedom == 0; }
};

/// Fits numbers of a model to coupons by ln F, the model's residual of sample i being
///
///     r = ln(faces mu N) - ln F + d_day(i),   r ~ scatter of the sample,   d_day ~ scatter of the day,
///
/// so that the shift of a day is found along with the numbers, and their covariance carries it. Priors are
/// residuals (value - mean)/sd; a sample far off counts as the loss says.
/// @param area  contact area fraction against nominal pressure; empty = nominal pressure
/// @throws InputError  from check_fit, or if there are fewer samples and priors than numbers
CouponFit fit_coupons(const Model& start, const CouponData& data, const FrictionRig& rig,
                      const AreaFunction& area, const CouponFitSpec& spec);

/// What is wrong with the wish before any fit: numbers the model does not have, bounds and priors against
/// their range, conditions that are all alike. Keys: calibrate.*, data.
Problems check_fit(const Model& start, const CouponData& data, const CouponFitSpec& spec);

/// The fit at the ends of the plate area band, and which numbers it moves by more than a thousandth.
struct PlateAreaEffect {
  CouponFit low, high;
  std::vector<bool> moves = {};  ///< one a number
};
PlateAreaEffect plate_area_effect(const Model& start, const CouponData& data, const FrictionRig& rig,
                                  const AreaFunction& area, const CouponFitSpec& spec,
                                  const CouponFit& assumed);

}  // namespace heddle::friction
