#include "friction/calibrate.h"

#include <fmt/format.h>

#include <Eigen/QR>
#include <algorithm>
#include <cmath>

#include "friction/hersey.h"

namespace heddle::friction {

namespace {

/// What the rows have in common, for starting values.
struct Overview {
  double mean_mu;
  double mean_log_hersey;
  double first_hersey;
  bool hersey_varies;  ///< otherwise exponent and slope stay as they came
};

// A gentle rise with Hs, from which the search finds either sign.
void set_start(Coulomb& law, const Overview& overview) {
  law.coefficient = overview.mean_mu;
}
void set_start(HerseyPower& law, const Overview& overview) {
  if (overview.hersey_varies) law.exponent = 0.1;
  law.scale = overview.mean_mu * std::exp(-law.exponent * overview.mean_log_hersey);
}
void set_start(HerseyLinear& law, const Overview& overview) {
  if (overview.hersey_varies) {
    law.reference = overview.first_hersey;
    law.slope = 0.1 * overview.mean_mu;
  }
  law.offset = overview.mean_mu - law.slope * overview.first_hersey / law.reference;
}
// The numbers that came are the start.
template <class AnyLaw>
void set_start(AnyLaw&, const Overview&) {}

double spread(const std::vector<double>& values) {
  const auto [low, high] = std::minmax_element(values.begin(), values.end());
  return *high - *low;
}

/// Keeps the model and the list of its parameters together; the contact area exponent is one more, last, on
/// demand.
class Fit {
 public:
  Fit(const Model& start, std::span<const FrictionTestRow> rows, const FrictionRig& rig,
      const AreaFunction& area, bool hold_slope, bool with_area_exponent)
      : model_(start), rows_(rows), hold_slope_(hold_slope), with_area_exponent_(with_area_exponent) {
    model_.box = {};  // the rows are inside by definition
    for (const FrictionTestRow& row : rows) {
      contexts_.push_back(contact_of(row, rig, area));
      states_.push_back(state_after_pull(model_, contexts_.back(), rig));
    }
    nominal_contexts_ = contexts_;
    choose_start();
    list_parameters();
  }

  LeastSquaresResult solve(const LeastSquaresOptions& options) {
    demand_enough_rows();
    const auto residuals = [this](const Eigen::VectorXd& free, Eigen::VectorXd& r, Eigen::MatrixXd& slopes) {
      set(free);
      fill(r, slopes);
    };
    LeastSquaresResult result =
        minimise_squares(residuals, start_of_free(), static_cast<Eigen::Index>(rows_.size()), options);
    set(result.parameters);
    demand_separable(result.jacobian);
    set_standard_errors(result);
    return result;
  }

  const Model& model() const { return model_; }
  const std::vector<FittedParameter>& parameters() const { return parameters_; }
  int degrees_of_freedom() const { return static_cast<int>(rows_.size()) - static_cast<int>(free_.size()); }

 private:
  void choose_start() {
    const auto count = static_cast<double>(rows_.size());
    std::vector<double> log_hersey;
    Overview overview{};
    for (std::size_t i = 0; i < rows_.size(); ++i) {
      log_hersey.push_back(std::log(hersey_number(model_.film, contexts_[i]).value));
      overview.mean_mu += measured_mu(i) / count;
      overview.mean_log_hersey += log_hersey.back() / count;
    }
    overview.first_hersey = std::exp(log_hersey.front());
    overview.hersey_varies = spread(log_hersey) > 1e-9;
    hersey_varies_ = overview.hersey_varies;
    std::visit([&](auto& law) { set_start(law, overview); }, model_.law);
  }

  void list_parameters() {
    std::vector<double> tool_temperature;
    for (const Context& context : contexts_) tool_temperature.push_back(context.tool_temperature);
    const bool tool_temperature_varies = spread(tool_temperature) > 1e-6;
    for (const Parameter& p : parameters_of(model_)) {
      const bool told = (!p.acts_through_hersey || hersey_varies_) &&
                        (!p.acts_through_tool_temperature || (tool_temperature_varies && !hold_slope_));
      parameters_.push_back({.key = p.key, .unit = p.unit, .value = p.value, .fitted = told});
    }
    if (with_area_exponent_) parameters_.push_back({.key = "area_exponent", .unit = "", .value = 0.0});
    for (std::size_t j = 0; j < parameters_.size(); ++j) {
      if (parameters_[j].fitted) free_.push_back(j);
    }
  }

  double measured_mu(std::size_t row) const {
    return effective_coefficient(*rows_[row].measured_force, rows_[row].normal_force);
  }

  Eigen::VectorXd start_of_free() const {
    Eigen::VectorXd start(static_cast<Eigen::Index>(free_.size()));
    for (Eigen::Index k = 0; k < start.size(); ++k)
      start[k] = parameters_[free_[static_cast<std::size_t>(k)]].value;
    return start;
  }

  /// Writes the values into the list and into the model.
  void set(const Eigen::VectorXd& free) {
    for (Eigen::Index k = 0; k < free.size(); ++k)
      parameters_[free_[static_cast<std::size_t>(k)]].value = free[k];
    std::vector<double> values;
    for (const FittedParameter& parameter : parameters_) values.push_back(parameter.value);
    set_parameters(model_, values);
    if (with_area_exponent_) set_area(values.back());
  }

  /// phi = (p / p_first)^a: a constant factor of phi is no matter, the scale C takes it up.
  void set_area(double exponent) {
    for (std::size_t i = 0; i < contexts_.size(); ++i) {
      contexts_[i].area_fraction = nominal_contexts_[i].area_fraction * std::exp(exponent * log_load(i));
    }
  }
  double log_load(std::size_t row) const { return std::log(contexts_[row].pressure / contexts_[0].pressure); }

  void fill(Eigen::VectorXd& residuals, Eigen::MatrixXd& slopes) const {
    for (std::size_t i = 0; i < rows_.size(); ++i) {
      ParameterSlopes at = parameter_slopes(model_, contexts_[i], states_[i]);
      if (with_area_exponent_) at.dmu_dparameter.push_back(at.dmu_dlog_hersey * log_load(i));
      const auto row = static_cast<Eigen::Index>(i);
      residuals[row] = at.mu / measured_mu(i) - 1.0;
      for (std::size_t k = 0; k < free_.size(); ++k) {
        slopes(row, static_cast<Eigen::Index>(k)) = at.dmu_dparameter[free_[k]] / measured_mu(i);
      }
    }
  }

  void demand_enough_rows() const {
    if (degrees_of_freedom() >= 0) return;
    throw InputError(
        {{.id = "friction.calibration.rows"_rule,
          .key = "data",
          .value = fmt::format("{} rows", rows_.size()),
          .rule = fmt::format("must hold at least {} rows, one for each parameter", free_.size()),
          .way_out = "Add friction tests, or fit a law with fewer parameters."}});
  }

  /// Columns of unit length whose smallest pivot is below 1e-8 of the largest: two parameters act alike on
  /// every row.
  void demand_separable(const Eigen::MatrixXd& jacobian) const {
    Eigen::ColPivHouseholderQR<Eigen::MatrixXd> qr(jacobian.rows(), jacobian.cols());
    qr.setThreshold(1e-8);
    qr.compute(jacobian.colwise().normalized());
    if (qr.rank() == jacobian.cols()) return;
    throw InputError(
        {{.id = "friction.calibration.rank"_rule,
          .key = "data",
          .value = fmt::format("{} rows", rows_.size()),
          .rule = fmt::format("must tell {} parameters apart, but two act alike on every row", free_.size()),
          .way_out = "Vary velocity, normal force and tool temperature one at a time."}});
  }

  /// s^2 (J^T J)^-1 with s^2 = |r|^2 / degrees of freedom.
  void set_standard_errors(const LeastSquaresResult& result) {
    if (degrees_of_freedom() == 0) return;
    const double variance = result.residuals.squaredNorm() / degrees_of_freedom();
    const Eigen::VectorXd norms = result.jacobian.colwise().norm();
    const Eigen::MatrixXd scaled = result.jacobian * norms.cwiseInverse().asDiagonal();
    const Eigen::MatrixXd inverse = scaled.completeOrthogonalDecomposition().pseudoInverse();
    for (std::size_t k = 0; k < free_.size(); ++k) {
      const auto row = static_cast<Eigen::Index>(k);
      parameters_[free_[k]].standard_error = std::sqrt(variance) * inverse.row(row).norm() / norms[row];
    }
  }

  Model model_;
  std::span<const FrictionTestRow> rows_;
  std::vector<Context> contexts_, nominal_contexts_;
  std::vector<ContactState> states_;  ///< when each force is read
  std::vector<FittedParameter> parameters_;
  std::vector<std::size_t> free_;  ///< indices of the fitted parameters
  bool hold_slope_;
  bool with_area_exponent_;
  bool hersey_varies_ = false;
};

/// Laws whose numbers steady pulls cannot tell.
void demand_fittable(const Law& law) {
  const bool table = std::holds_alternative<HerseyTable>(law);
  if (!table && !std::holds_alternative<StaticKinetic>(law) && !std::holds_alternative<SlipResistance>(law))
    return;
  throw InputError({{.id = "friction.calibration.law"_rule,
                     .key = "friction.calibration.data",
                     .value = id_of(law),
                     .rule = table ? "fits the numbers of a law, and a table has none"
                                   : "holds one force a pull, which cannot tell how mu changes along it",
                     .way_out = "Give the law's own numbers, or calibrate another law."}});
}

void demand_sound_input(const Model& start, std::span<const FrictionTestRow> rows, const FrictionRig& rig) {
  Problems problems = check(rig);
  const Problems of_rows = check(rows, true);
  problems.insert(problems.end(), of_rows.begin(), of_rows.end());
  for (const Problem& problem : check(start)) {
    // The law's own numbers are about to be found; film and effects are used as they are.
    if (problem.key.starts_with("resin.") || problem.key.starts_with("effects.")) problems.push_back(problem);
  }
  if (!problems.empty()) throw InputError(std::move(problems));
}

FrictionRig with_plate_area(FrictionRig rig, double area) {
  rig.plate_area = area;
  return rig;
}

}  // namespace

CalibrationBox box_of(std::span<const FrictionTestResult> results) {
  CalibrationBox box{.hersey_low = 1e300,
                     .hersey_high = 0.0,
                     .pressure_low = 1e300,
                     .pressure_high = 0.0,
                     .speed_low = 1e300,
                     .speed_high = 0.0};
  const auto widen = [](double& low, double& high, double value) {
    low = std::min(low, value);
    high = std::max(high, value);
  };
  for (const FrictionTestResult& result : results) {
    widen(box.hersey_low, box.hersey_high, result.hersey);
    widen(box.pressure_low, box.pressure_high, result.context.pressure);
    widen(box.speed_low, box.speed_high, result.context.slip_speed);
  }
  return box;
}

Calibration calibrate(const Model& start, std::span<const FrictionTestRow> rows, const FrictionRig& rig,
                      const AreaFunction& area, const CalibrationOptions& options) {
  demand_fittable(start.law);
  demand_sound_input(start, rows, rig);
  Fit fit(start, rows, rig, area, options.hold_tool_temperature_slope, false);
  Calibration result;
  result.summary = fit.solve(options.search).summary;
  result.model = fit.model();
  result.model.box = box_of(run_friction_tests(result.model, rows, rig, area));
  result.rows = run_friction_tests(result.model, rows, rig, area);
  result.parameters = fit.parameters();
  result.rms_error = rms_relative_error(result.rows).value();
  result.degrees_of_freedom = fit.degrees_of_freedom();
  return result;
}

CalibrationBand calibrate_band(const Model& start, std::span<const FrictionTestRow> rows,
                               const FrictionRig& rig, const AreaFunction& area,
                               const CalibrationOptions& options) {
  return {.low = calibrate(start, rows, with_plate_area(rig, rig.plate_area_band[0]), area, options),
          .assumed = calibrate(start, rows, rig, area, options),
          .high = calibrate(start, rows, with_plate_area(rig, rig.plate_area_band[1]), area, options)};
}

AreaExponent area_exponent_that_fits(const PowerLawFilm& film, const Effects& effects,
                                     std::span<const FrictionTestRow> rows, const FrictionRig& rig) {
  const Model start{.law = HerseyPower{}, .film = film, .effects = effects, .box = {}};
  demand_sound_input(start, rows, rig);
  Fit fit(start, rows, rig, {}, false, true);
  const LeastSquaresResult solution = fit.solve({});
  return {.value = fit.parameters().back().value,
          .standard_error = fit.parameters().back().standard_error,
          .law_exponent = std::get<HerseyPower>(fit.model().law).exponent,
          .rms_error = std::sqrt(solution.residuals.squaredNorm() / static_cast<double>(rows.size())),
          .summary = solution.summary};
}

}  // namespace heddle::friction
