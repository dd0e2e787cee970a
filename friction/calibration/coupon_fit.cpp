#include "friction/calibration/coupon_fit.h"

#include <boost/math/distributions/normal.hpp>
#include <boost/math/distributions/students_t.hpp>

#include <algorithm>
#include <cmath>

#include "friction/calibrate.h"
#include "friction/calibration/confusions.h"
#include "friction/calibration/information.h"
#include "friction/calibration/model_numbers.h"

namespace heddle::friction {

namespace {

/// Rows first .. first + count of one sample.
struct SampleRows {
  std::size_t first, count, day;
};

double median(std::vector<double> values) {
  const auto middle = values.begin() + static_cast<std::ptrdiff_t>(values.size() / 2);
  std::nth_element(values.begin(), middle, values.end());
  if (values.size() % 2 == 1) return *middle;
  return 0.5 * (*middle + *std::max_element(values.begin(), middle));
}

class Fit {
 public:
  Fit(const Fit&) = delete;  // numbers_ point into its own model
  Fit& operator=(const Fit&) = delete;
  Fit(const Model& start, const CouponData& data, const FrictionRig& rig, const AreaFunction& area,
      const CouponFitSpec& spec)
      : model_(start), data_(data), spec_(spec) {
    model_.box = {};  // the rows are inside by definition
    for (const CouponRow& row : data.rows) {
      readings_.push_back({.context = contact_of(row.pull, rig, area),
                           .slip = row.slip.value_or(rig.pull_length),
                           .dwell = row.dwell > 0.0 ? row.dwell : rig.dwell_before});
      if (samples_.empty() || data.rows[samples_.back().first].sample != row.sample)
        samples_.push_back({readings_.size() - 1, 0, row.day});
      ++samples_.back().count;
    }
    for (const FreeNumber& number : spec.numbers) {
      keys_.push_back(number.key);
      numbers_.push_back(&number_in(model_, number.key));
    }
    choose_variables();
  }

  CouponFit run() {
    set_scatter();
    search();
    if (noise_.sample.source == Scatter::Source::unknown && left_over() > 0) scatter_from_residuals();
    CouponFit result = describe();
    state_uncertainty(result);
    return result;
  }

 private:
  std::size_t count() const { return keys_.size(); }
  bool day_effect() const { return noise_.day.sd > 0.0; }
  int priors() const {
    return static_cast<int>(std::ranges::count_if(
        spec_.numbers, [](const FreeNumber& number) { return number.prior.has_value(); }));
  }
  /// Samples and priors beyond one for each number, or combination of numbers, that they fix.
  int left_over() const {
    Eigen::MatrixXd rows(slopes_.rows() + priors(), slopes_.cols());
    rows.setZero();
    rows.topRows(slopes_.rows()) = slopes_;
    Eigen::Index at = slopes_.rows();
    for (Eigen::Index k = 0; k < slopes_.cols(); ++k)
      if (const auto& prior = spec_.numbers[static_cast<std::size_t>(k)].prior)
        rows(at++, k) = 1.0 / prior->sd;
    const auto rank = static_cast<int>(rank_of(rows));
    return static_cast<int>(samples_.size()) + priors() - rank;
  }

  void choose_variables() {
    const std::vector<ModelNumber> numbers = numbers_of(model_);
    for (const FreeNumber& wish : spec_.numbers) {
      const ModelNumber& number = *std::ranges::find(numbers, wish.key, &ModelNumber::key);
      FitVariable variable{.start = number.value, .low = number.range.low, .high = number.range.high};
      variable.size = size_of(number);
      // An open end is kept by stopping just inside.
      if (number.range.low_open) variable.low += 1e-9 * variable.size;
      if (number.range.high_open) variable.high -= 1e-9 * variable.size;
      if (wish.bounds) {
        variable.low = std::max(variable.low, (*wish.bounds)[0]);
        variable.high = std::min(variable.high, (*wish.bounds)[1]);
      }
      variable.start = std::clamp(variable.start, variable.low, variable.high);
      variables_.push_back(variable);
    }
  }

  /// The number itself; of one that starts at 0, what moves mu by a tenth.
  double size_of(const ModelNumber& number) const {
    if (number.value != 0.0) return std::abs(number.value);
    double largest = 0.0;
    for (const PullReading& reading : readings_)
      largest = std::max(largest, std::abs(number_slopes(model_, reading, {number.key})[0].value) /
                                      coefficient_of(model_, reading));
    return largest > 0.0 ? 0.1 / largest : 1.0;
  }

  void set_scatter() {
    const NoiseSpec& noise = spec_.noise;
    noise_.reading = noise.reading;
    if (noise.sample)
      noise_.sample = {*noise.sample, Scatter::Source::given, 0};
    else
      noise_.sample = scatter_of_samples(data_, spec_.faces, noise.reading).value_or(Scatter{0.05});
    if (noise.day)
      noise_.day = {*noise.day, Scatter::Source::given, 0};
    else
      noise_.day = scatter_of_days(data_, spec_.faces, noise_.sample.sd)
                       .value_or(Scatter{noise.day_assumed, Scatter::Source::assumed, 0});
    // Samples that agree to the last digit leave no scale to weigh them by.
    noise_.sample.sd = std::max(noise_.sample.sd, 1e-9);
  }

  void set(const Eigen::VectorXd& x) {
    for (std::size_t k = 0; k < count(); ++k) *numbers_[k] = x[static_cast<Eigen::Index>(k)];
  }

  /// ln F_model - ln F of one row, and its slopes in the numbers.
  bool log_error(std::size_t row, double& error, Eigen::Ref<Eigen::RowVectorXd>* slopes) const {
    const double mu = coefficient_of(model_, readings_[row]);
    if (!(mu > 0.0) || !std::isfinite(mu)) return false;
    error = std::log(mu / measured_coefficient(data_.rows[row], spec_.faces));
    if (slopes == nullptr) return true;
    const std::vector<NumberSlope> at = number_slopes(model_, readings_[row], keys_);
    for (std::size_t k = 0; k < at.size(); ++k) {
      (*slopes)[static_cast<Eigen::Index>(k)] = at[k].value / mu;
      worst_difference_ = std::max(worst_difference_, at[k].error);
    }
    return true;
  }

  ResidualBlock block_of(const SampleRows& sample) {
    const auto rows = static_cast<Eigen::Index>(sample.count);
    return {
        .rows = rows,
        .robust = true,
        .evaluate = [this, &sample](const Eigen::VectorXd& x, Eigen::VectorXd& r, Eigen::MatrixXd* slopes) {
          set(x);
          const Eigen::Index day = static_cast<Eigen::Index>(count() + sample.day);
          if (slopes != nullptr) slopes->setZero();
          for (std::size_t i = 0; i < sample.count; ++i) {
            const auto at = static_cast<Eigen::Index>(i);
            Eigen::RowVectorXd row_slopes(static_cast<Eigen::Index>(count()));
            Eigen::Ref<Eigen::RowVectorXd> reference(row_slopes);
            if (!log_error(sample.first + i, r[at], slopes != nullptr ? &reference : nullptr)) return false;
            if (slopes != nullptr) slopes->row(at).head(row_slopes.size()) = row_slopes;
            if (!day_effect()) continue;
            r[at] += x[day];
            if (slopes != nullptr) (*slopes)(at, day) = 1.0;
          }
          Eigen::MatrixXd column = r;
          whiten(column, noise_.sample.sd, noise_.reading);
          r = column;
          if (slopes != nullptr) whiten(*slopes, noise_.sample.sd, noise_.reading);
          return true;
        }};
  }

  /// (x[variable] - mean) / sd
  static ResidualBlock pull_towards(std::size_t variable, const Prior& prior) {
    return {
        .rows = 1,
        .robust = false,
        .evaluate = [variable, prior](const Eigen::VectorXd& x, Eigen::VectorXd& r, Eigen::MatrixXd* slopes) {
          const auto k = static_cast<Eigen::Index>(variable);
          r[0] = (x[k] - prior.mean) / prior.sd;
          if (slopes != nullptr) {
            slopes->setZero();
            (*slopes)(0, k) = 1.0 / prior.sd;
          }
          return true;
        }};
  }

  void search() {
    std::vector<ResidualBlock> blocks;
    for (const SampleRows& sample : samples_) blocks.push_back(block_of(sample));
    std::vector<FitVariable> variables = variables_;
    if (day_effect())
      for (std::size_t d = 0; d < data_.days.size(); ++d) {
        blocks.push_back(pull_towards(variables.size(), {0.0, noise_.day.sd}));
        variables.push_back({.start = 0.0, .size = noise_.day.sd});
      }
    for (std::size_t k = 0; k < count(); ++k)
      if (const auto& prior = spec_.numbers[k].prior) blocks.push_back(pull_towards(k, *prior));
    worst_difference_ = 0.0;
    fit_ = robust_fit(
        blocks, variables,
        {.loss = spec_.loss, .loss_scale = spec_.loss_scale, .iterations_max = spec_.iterations_max});
    if (fit_.residuals.size() == 0)
      throw NumericalError(
          "friction::fit_coupons: mu is negative or not finite for a pull at the values to "
          "start from; start from others");
    set(fit_.x);
    read_slopes();
  }

  /// Slopes of ln F at the solution, one row a reading.
  void read_slopes() {
    slopes_.resize(static_cast<Eigen::Index>(readings_.size()), static_cast<Eigen::Index>(count()));
    errors_.resize(slopes_.rows());
    for (std::size_t i = 0; i < readings_.size(); ++i) {
      const auto at = static_cast<Eigen::Index>(i);
      Eigen::RowVectorXd row(slopes_.cols());
      Eigen::Ref<Eigen::RowVectorXd> reference(row);
      log_error(i, errors_[at], &reference);
      slopes_.row(at) = row;
    }
  }

  /// Weighted, whitened slopes of all rows in the free numbers and the days; a number at its bound has none.
  Eigen::MatrixXd information_rows(double sample_sd, double day_sd) const {
    const auto days = static_cast<Eigen::Index>(day_effect() ? data_.days.size() : 0);
    const Eigen::Index readings = slopes_.rows(), numbers = slopes_.cols();
    Eigen::MatrixXd rows = Eigen::MatrixXd::Zero(readings + days + priors(), numbers + days);
    rows.topLeftCorner(readings, numbers) = slopes_;
    for (const SampleRows& sample : samples_) {
      const auto first = static_cast<Eigen::Index>(sample.first),
                 length = static_cast<Eigen::Index>(sample.count);
      if (days > 0) rows.block(first, numbers + static_cast<Eigen::Index>(sample.day), length, 1).setOnes();
      whiten(rows.middleRows(first, length), sample_sd, noise_.reading);
      rows.middleRows(first, length) *= std::sqrt(fit_.weights[first]);
    }
    for (Eigen::Index d = 0; d < days; ++d) rows(readings + d, numbers + d) = 1.0 / day_sd;
    Eigen::Index at = readings + days;
    for (Eigen::Index k = 0; k < numbers; ++k)
      if (const auto& prior = spec_.numbers[static_cast<std::size_t>(k)].prior)
        rows(at++, k) = 1.0 / prior->sd;
    for (Eigen::Index k = 0; k < numbers; ++k)
      if (fit_.at_bound[static_cast<std::size_t>(k)]) rows.col(k).setZero();
    return rows;
  }

  /// Mean over the rows of each sample of ln F_model - ln F, with the shift of its day.
  std::vector<double> sample_errors() const {
    std::vector<double> errors;
    for (const SampleRows& sample : samples_) {
      const auto first = static_cast<Eigen::Index>(sample.first),
                 length = static_cast<Eigen::Index>(sample.count);
      errors.push_back(errors_.segment(first, length).mean() + (day_effect() ? day_shift(sample.day) : 0.0));
    }
    return errors;
  }
  double day_shift(std::size_t day) const { return fit_.x[static_cast<Eigen::Index>(count() + day)]; }

  /// What the samples leave over, per degree of freedom that numbers and days leave them; the scatter weighs
  /// samples against days and priors, so both are found together.
  void scatter_from_residuals() {
    double freedom = 0.0;
    for (int round = 0; round < 50; ++round) {
      const Eigen::MatrixXd rows = information_rows(noise_.sample.sd, noise_.day.sd);
      const Eigen::MatrixXd covariance = uncertainty_of(rows).covariance;
      const Eigen::MatrixXd of_samples = rows.topRows(slopes_.rows());
      const double used = (of_samples * covariance * of_samples.transpose()).trace();
      freedom = static_cast<double>(samples_.size()) - used;
      if (freedom < 0.5) return;
      const double before = noise_.sample.sd;
      noise_.sample.sd = std::max(estimate(freedom), 1e-9);
      search();
      if (std::abs(noise_.sample.sd - before) < 1e-8 * before) break;
    }
    noise_.sample.source = Scatter::Source::residuals;
    noise_.sample.degrees_of_freedom = static_cast<int>(std::lround(freedom));
  }

  double estimate(double freedom) const {
    std::vector<double> errors = sample_errors();
    const auto samples = static_cast<double>(errors.size());
    if (spec_.loss == Loss::none) {
      double squares = 0.0;
      for (const double error : errors) squares += error * error;
      return std::sqrt(squares / freedom);
    }
    // A sample far off must not widen the scale by which it is judged: 1.4826 median|e| is the standard
    // deviation of normal errors.
    for (double& error : errors) error = std::abs(error);
    return 1.4826 * median(std::move(errors)) * std::sqrt(samples / freedom);
  }

  CouponFit describe() {
    CouponFit result;
    result.model = model_;
    result.keys = keys_;
    result.noise = noise_;
    result.summary = fit_.summary;
    result.worst_difference = worst_difference_;
    result.degrees_of_freedom = left_over();
    result.from_priors = priors();
    if (day_effect())
      for (std::size_t d = 0; d < data_.days.size(); ++d) result.day_shifts.push_back(day_shift(d));
    describe_numbers(result);
    describe_rows(result);
    result.confusions = total_confusions(slopes_, keys_, fit_.x.head(slopes_.cols()));
    for (const Confusion& confusion : result.confusions)
      for (FittedNumber& number : result.numbers)
        if (std::ranges::count(confusion.keys, number.key) > 0) number.told_apart = false;
    return result;
  }

  void describe_numbers(CouponFit& result) const {
    const std::vector<ModelNumber> numbers = numbers_of(model_);
    const std::vector<NumberSlope> slopes = number_slopes(model_, readings_.front(), keys_);
    for (std::size_t k = 0; k < count(); ++k)
      result.numbers.push_back({.key = keys_[k],
                                .unit = std::ranges::find(numbers, keys_[k], &ModelNumber::key)->unit,
                                .value = fit_.x[static_cast<Eigen::Index>(k)],
                                .at_bound = fit_.at_bound[k],
                                .prior = spec_.numbers[k].prior,
                                .exact_slope = slopes[k].exact});
  }

  void describe_rows(CouponFit& result) const {
    std::vector<FrictionTestResult> pulls;
    const bool known = noise_.sample.source != Scatter::Source::unknown;
    double squares = 0.0;
    for (const SampleRows& sample : samples_)
      for (std::size_t i = sample.first; i < sample.first + sample.count; ++i) {
        const PullReading& reading = readings_[i];
        FrictionRig rig;
        rig.pull_length = reading.slip;
        rig.dwell_before = reading.dwell;
        const Friction at =
            evaluate_unchecked(model_, reading.context, state_after_pull(model_, reading.context, rig));
        const double error = errors_[static_cast<Eigen::Index>(i)];
        const double sd = sample.count == 1 ? noise_.sample.sd : std::hypot(noise_.sample.sd, noise_.reading);
        const double shift = day_effect() ? day_shift(sample.day) : 0.0;
        result.rows.push_back({.mu = at.mu,
                               .pull_force = spec_.faces * at.mu * data_.rows[i].pull.normal_force,
                               .hersey = at.hersey,
                               .log_error = error,
                               .standardised = known ? (error + shift) / sd : 0.0,
                               .weight = fit_.weights[static_cast<Eigen::Index>(sample.first)],
                               .context = reading.context});
        FrictionTestResult pull;
        pull.context = reading.context;
        pull.hersey = at.hersey;
        pulls.push_back(std::move(pull));
        squares += std::expm1(error) * std::expm1(error);
      }
    result.rms_error = std::sqrt(squares / static_cast<double>(readings_.size()));
    result.model.box = box_of(pulls);
  }

  void state_uncertainty(CouponFit& result) const {
    if (noise_.sample.source == Scatter::Source::unknown) return;
    const double sample = noise_.sample.sd, day = noise_.day.sd;
    const auto numbers = slopes_.cols();
    const Uncertainty at = uncertainty_of(information_rows(sample, day));
    result.covariance = at.covariance.topLeftCorner(numbers, numbers);
    result.correlation = Eigen::MatrixXd::Zero(numbers, numbers);
    // How much of each variance is whose: the part that grows with the square of one scatter.
    constexpr double h = 1e-3;
    const double square = (1.0 + h) * (1.0 + h) - 1.0;
    const Eigen::VectorXd variance = at.covariance.diagonal();
    const Eigen::VectorXd of_sample =
        (uncertainty_of(information_rows((1.0 + h) * sample, day)).covariance.diagonal() - variance) / square;
    const Eigen::VectorXd of_day =
        (uncertainty_of(information_rows(sample, (1.0 + h) * day)).covariance.diagonal() - variance) / square;
    for (Eigen::Index k = 0; k < numbers; ++k) {
      FittedNumber& number = result.numbers[static_cast<std::size_t>(k)];
      if (number.at_bound || !at.fixed[static_cast<std::size_t>(k)]) continue;
      number.sd = std::sqrt(variance[k]);
      number.degrees_of_freedom = freedom_of(variance[k], of_sample[k], of_day[k]);
      const double reach = quantile(number.degrees_of_freedom) * *number.sd;
      number.interval = {number.value - reach, number.value + reach};
      for (Eigen::Index j = 0; j <= k; ++j)
        if (result.numbers[static_cast<std::size_t>(j)].sd)
          result.correlation(k, j) = result.correlation(j, k) =
              result.covariance(k, j) / std::sqrt(variance[k] * variance[j]);
    }
    for (Confusion& pair : high_correlations(result.correlation, keys_))
      result.confusions.push_back(std::move(pair));
  }

  /// Satterthwaite's degrees of freedom of a sum of estimated variances; 0 where none is estimated.
  double freedom_of(double variance, double of_sample, double of_day) const {
    double inverse = 0.0;
    const auto add = [&](const Scatter& scatter, double part) {
      if (scatter.estimated() && scatter.degrees_of_freedom > 0)
        inverse += part * part / scatter.degrees_of_freedom;
    };
    add(noise_.sample, of_sample);
    add(noise_.day, of_day);
    return inverse > 0.0 ? variance * variance / inverse : 0.0;
  }

  double quantile(double freedom) const {
    const double share = 0.5 * (1.0 + spec_.confidence);
    // Beyond 1e6 the two agree to the last digit written.
    if (freedom == 0.0 || freedom > 1e6) return boost::math::quantile(boost::math::normal(), share);
    return boost::math::quantile(boost::math::students_t(freedom), share);
  }

  Model model_;
  const CouponData& data_;
  const CouponFitSpec& spec_;
  std::vector<PullReading> readings_;
  std::vector<SampleRows> samples_;
  std::vector<std::string> keys_;
  std::vector<double*> numbers_;  ///< in model_, one a key
  std::vector<FitVariable> variables_;
  NoiseModel noise_;
  RobustFit fit_;
  Eigen::MatrixXd slopes_;  ///< of ln F at the solution
  Eigen::VectorXd errors_;  ///< ln F_model - ln F there
  mutable double worst_difference_ = 0.0;
};

FrictionRig with_plate_area(FrictionRig rig, double area) {
  rig.plate_area = area;
  return rig;
}

}  // namespace

CouponFit fit_coupons(const Model& start, const CouponData& data, const FrictionRig& rig,
                      const AreaFunction& area, const CouponFitSpec& spec) {
  if (Problems problems = check_fit(start, data, spec); !problems.empty())
    throw InputError(std::move(problems));
  return Fit(start, data, rig, area, spec).run();
}

PlateAreaEffect plate_area_effect(const Model& start, const CouponData& data, const FrictionRig& rig,
                                  const AreaFunction& area, const CouponFitSpec& spec,
                                  const CouponFit& assumed) {
  PlateAreaEffect effect{
      .low = fit_coupons(start, data, with_plate_area(rig, rig.plate_area_band[0]), area, spec),
      .high = fit_coupons(start, data, with_plate_area(rig, rig.plate_area_band[1]), area, spec)};
  for (std::size_t k = 0; k < assumed.numbers.size(); ++k) {
    const double value = assumed.numbers[k].value;
    const double change = std::max(std::abs(effect.low.numbers[k].value - value),
                                   std::abs(effect.high.numbers[k].value - value));
    effect.moves.push_back(change > 1e-3 * std::abs(value));
  }
  return effect;
}

}  // namespace heddle::friction
