#include "friction/calibrate.h"

#include <catch2/catch.hpp>
#include <cmath>
#include <random>
#include <vector>

#include "tests/derivative_check.h"

using namespace heddle;
using namespace heddle::friction;
using heddle::test::derivative_gap;

namespace {

using Form = ToolTemperatureShift::Form;

FrictionTestRow pull(double velocity, double normal_force, double tool_temperature,
                     double fabric_temperature = 453.15) {
  FrictionTestRow row;
  row.name = "pull";
  row.velocity = velocity;
  row.normal_force = normal_force;
  row.tool_temperature = tool_temperature;
  row.fabric_temperature = fabric_temperature;
  return row;
}

/// Velocity, load and tool temperature each varied about a baseline.
std::vector<FrictionTestRow> star_design() {
  std::vector<FrictionTestRow> rows{pull(16.67e-3, 1500.0, 358.15)};
  for (const double velocity : {1.66e-3, 8.33e-3, 83.3e-3}) rows.push_back(pull(velocity, 1500.0, 358.15));
  for (const double force : {218.0, 1000.0, 4000.0}) rows.push_back(pull(16.67e-3, force, 358.15));
  for (const double temperature : {294.15, 373.15, 413.15})
    rows.push_back(pull(16.67e-3, 1500.0, temperature));
  return rows;
}

/// Pulls "measured" with a known law.
std::vector<FrictionTestRow> measured_with(const Model& truth, std::vector<FrictionTestRow> rows,
                                           const AreaFunction& area = {}, double scatter = 0.0,
                                           unsigned seed = 1) {
  std::mt19937 generator(seed);
  std::normal_distribution<double> normal;
  for (FrictionTestRow& row : rows) {
    row.measured_force =
        run_friction_test(truth, row, {}, area).pull_force * (1.0 + scatter * normal(generator));
  }
  return rows;
}

Model with_shift(const Law& law, double slope, Form form) {
  return {.law = law,
          .film = {},
          .effects = {.tool_temperature_shift = ToolTemperatureShift{.slope = slope, .form = form}},
          .box = {}};
}

/// The form to be fitted, without its numbers.
Model blank(const Law& law, Form form) {
  return with_shift(law, 0.0, form);
}

std::string problem_of(const Model& start, const std::vector<FrictionTestRow>& rows) {
  try {
    calibrate(start, rows, {});
  } catch (const InputError& error) {
    return error.problems().front().id;
  }
  return "";
}

}  // namespace

TEST_CASE("slopes of mu in the fitted parameters agree with central differences", "[friction][derivative]") {
  const Law law = GENERATE(Law{Coulomb{0.3}}, Law{HerseyPower{.scale = 0.325, .exponent = 0.136}},
                           Law{HerseyLinear{.offset = 0.237, .slope = 0.044, .reference = 0.362}});
  const Form form = GENERATE(Form::term, Form::factor);
  const double speed = GENERATE(1e-5, 0.02, 0.5);  // below, inside and above the box of the linear law
  Model model = with_shift(law, -9e-4, form);
  model.box = {.hersey_low = 0.18, .hersey_high = 0.8};
  const Context context{.slip_speed = speed, .pressure = 1.2e5, .tool_temperature = 400.0};
  const std::vector<Parameter> parameters = parameters_of(model);
  const ParameterSlopes slopes = parameter_slopes(model, context);
  REQUIRE(slopes.dmu_dparameter.size() == parameters.size());
  CHECK(slopes.mu == Approx(evaluate(model, context, {}).mu).epsilon(1e-14));

  for (std::size_t j = 0; j < parameters.size(); ++j) {
    CAPTURE(parameters[j].key, speed);
    const auto mu = [&](double value) {
      std::vector<double> values;
      for (const Parameter& parameter : parameters) values.push_back(parameter.value);
      values[j] = value;
      Model changed = model;
      set_parameters(changed, values);
      return parameter_slopes(changed, context).mu;
    };
    const double value = parameters[j].value, slope = slopes.dmu_dparameter[j];
    CHECK(derivative_gap(mu, value, std::abs(value), slope) < 1e-7);
    CHECK(derivative_gap(mu, value, std::abs(value), 1.01 * slope) > 1e-4);  // the check can fail
  }
}

TEST_CASE("slope of mu in the logarithm of the Hersey number agrees with central differences",
          "[friction][derivative]") {
  const Law law = GENERATE(Law{HerseyPower{.scale = 0.325, .exponent = 0.136}},
                           Law{HerseyLinear{.offset = 0.237, .slope = 0.044, .reference = 0.362}});
  const Model model = with_shift(law, -3e-3, Form::factor);
  const auto mu = [&](double log_area) {
    Context context{.slip_speed = 0.02, .pressure = 1.2e5, .tool_temperature = 400.0};
    context.area_fraction = std::exp(log_area);
    return parameter_slopes(model, context);
  };
  const double slope = mu(-0.5).dmu_dlog_hersey;
  const auto value = [&](double log_area) { return mu(log_area).mu; };
  CHECK(derivative_gap(value, -0.5, 1.0, slope) < 1e-7);
  CHECK(derivative_gap(value, -0.5, 1.0, 1.01 * slope) > 1e-4);
}

TEST_CASE("calibration gives back the law that made the forces", "[friction][analytic]") {
  const Form form = GENERATE(Form::term, Form::factor);
  const double slope = form == Form::term ? -8e-4 : -3e-3;
  const auto area_of = [](double p) {
    return std::pair{0.2 * std::pow(p / 1e5, 0.6), 0.12e-5 * std::pow(p / 1e5, -0.4)};
  };
  const AreaFunction area = GENERATE_COPY(AreaFunction{}, AreaFunction{area_of});
  const Law truth = GENERATE(Law{Coulomb{0.27}}, Law{HerseyPower{.scale = 0.4, .exponent = 0.2}},
                             Law{HerseyPower{.scale = 0.3, .exponent = -0.1}},
                             Law{HerseyLinear{.offset = 0.2, .slope = 0.05, .reference = 0.362}});
  Law form_only = truth;
  if (auto* power = std::get_if<HerseyPower>(&form_only)) *power = {};
  if (auto* linear = std::get_if<HerseyLinear>(&form_only)) *linear = {};
  const Model made_with = with_shift(truth, slope, form);
  const auto rows = measured_with(made_with, star_design(), area);

  const Calibration found = calibrate(blank(form_only, form), rows, {}, area);
  CHECK(found.summary.converged);
  CHECK(found.rms_error < 1e-10);
  for (std::size_t i = 0; i < rows.size(); ++i)
    CHECK(found.rows[i].pull_force == Approx(*rows[i].measured_force));
  CHECK(found.model.effects.tool_temperature_shift->slope == Approx(slope).epsilon(1e-8));
  if (const auto* power = std::get_if<HerseyPower>(&truth)) {
    CHECK(std::get<HerseyPower>(found.model.law).scale == Approx(power->scale).epsilon(1e-8));
    CHECK(std::get<HerseyPower>(found.model.law).exponent == Approx(power->exponent).epsilon(1e-8));
  }
}

TEST_CASE("calibration keeps the box of its rows", "[friction]") {
  const auto rows = measured_with(with_shift(HerseyPower{0.4, 0.2}, -8e-4, Form::term), star_design());
  const Calibration found = calibrate(blank(HerseyPower{}, Form::term), rows, {});
  CHECK(found.model.box.speed_low == 1.66e-3);
  CHECK(found.model.box.speed_high == 83.3e-3);
  CHECK(found.model.box.pressure_low == 21.8e3);
  CHECK(found.model.box.pressure_high == 400e3);
  CHECK(found.model.box.hersey_low > 0.0);
  for (const FrictionTestResult& row : found.rows) CHECK(row.calibrated);
}

TEST_CASE("standard errors tell how far repeated tests move the parameters", "[friction][analytic]") {
  // 300 repetitions with 3 % scatter: the spread of the fitted exponents against the mean of the stated
  // errors. With 10 rows both are known to about 5 %.
  const Model truth = with_shift(HerseyPower{0.33, 0.14}, -9e-4, Form::term);
  double sum = 0.0, square = 0.0, stated = 0.0;
  constexpr int repetitions = 300;
  for (unsigned seed = 1; seed <= repetitions; ++seed) {
    const auto rows = measured_with(truth, star_design(), {}, 0.03, seed);
    const Calibration found = calibrate(blank(HerseyPower{}, Form::term), rows, {});
    const FittedParameter& exponent = found.parameters[1];
    sum += exponent.value;
    square += exponent.value * exponent.value;
    stated += *exponent.standard_error * *exponent.standard_error / repetitions;
  }
  const double mean = sum / repetitions;
  const double spread = std::sqrt((square / repetitions - mean * mean) * repetitions / (repetitions - 1));
  CHECK(spread == Approx(std::sqrt(stated)).epsilon(0.15));
  CHECK(mean == Approx(0.14).margin(3.0 * spread / std::sqrt(repetitions)));
}

TEST_CASE("as many parameters as rows is called saturated and states no errors", "[friction]") {
  auto rows = star_design();
  rows = {rows[0], rows[3], rows[9]};  // baseline, velocity, tool temperature
  rows = measured_with(with_shift(HerseyPower{0.4, 0.2}, -8e-4, Form::term), rows, {}, 0.05);
  const Calibration found = calibrate(blank(HerseyPower{}, Form::term), rows, {});
  CHECK(found.saturated());
  CHECK(found.rms_error < 1e-10);  // met whatever the scatter
  for (const FittedParameter& parameter : found.parameters) CHECK_FALSE(parameter.standard_error.has_value());
}

TEST_CASE("what the rows do not vary is held where it was", "[friction]") {
  const Model truth = with_shift(HerseyPower{0.4, 0.2}, -8e-4, Form::term);
  SECTION("one tool temperature") {
    auto rows = star_design();
    rows.resize(7);
    const Calibration found =
        calibrate(with_shift(HerseyPower{}, -5e-4, Form::term), measured_with(truth, rows), {});
    CHECK_FALSE(found.parameters[2].fitted);
    CHECK(found.parameters[2].value == -5e-4);
    CHECK(found.degrees_of_freedom == 5);
    CHECK(std::get<HerseyPower>(found.model.law).exponent == Approx(0.2));
  }
  SECTION("the slope is to be held, though the rows could tell it") {
    const auto rows = star_design();
    const Calibration found =
        calibrate(with_shift(HerseyPower{}, -5e-4, Form::term), measured_with(truth, rows), {}, {},
                  {.hold_tool_temperature_slope = true});
    CHECK_FALSE(found.parameters[2].fitted);
    CHECK(found.model.effects.tool_temperature_shift->slope == -5e-4);
    CHECK(found.rms_error > 1e-3);  // the truth has another slope
  }
  SECTION("one Hersey number, power law") {
    const auto all = star_design();
    const std::vector<FrictionTestRow> rows{all[0], all[7], all[8], all[9]};
    const Calibration found =
        calibrate(with_shift(HerseyPower{.scale = 1.0, .exponent = 0.15}, 0.0, Form::term),
                  measured_with(truth, rows), {});
    CHECK_FALSE(found.parameters[1].fitted);
    CHECK(found.parameters[1].value == 0.15);
    CHECK(found.rms_error < 1e-10);
  }
  SECTION("one Hersey number, linear law") {
    const auto all = star_design();
    const std::vector<FrictionTestRow> rows{all[0], all[7], all[8], all[9]};
    const HerseyLinear given{.offset = 0.0, .slope = 0.05, .reference = 0.4};
    const Calibration found = calibrate(with_shift(given, 0.0, Form::term), measured_with(truth, rows), {});
    CHECK_FALSE(found.parameters[1].fitted);
    CHECK(std::get<HerseyLinear>(found.model.law).slope == 0.05);
    CHECK(found.rms_error < 1e-10);
  }
}

TEST_CASE("calibration refuses what it cannot answer", "[friction][wrong input]") {
  const Model start = blank(HerseyPower{}, Form::term);
  const Model truth = with_shift(HerseyPower{0.4, 0.2}, -8e-4, Form::term);
  const auto rows = measured_with(truth, star_design());

  auto unmeasured = rows;
  unmeasured[4].measured_force.reset();
  CHECK(problem_of(start, unmeasured) == "friction.test.measured_force.missing");

  auto few = measured_with(truth, {star_design()[0], star_design()[9]});
  few[1].velocity *= 2.0;
  CHECK(problem_of(start, few) == "friction.calibration.rows");

  // Load and tool temperature changed together in one step, nothing else: exponent and slope act alike.
  const auto together = measured_with(truth, {pull(0.02, 1500.0, 358.15), pull(0.02, 3000.0, 413.15),
                                              pull(0.02, 1500.0, 358.15), pull(0.02, 3000.0, 413.15)});
  CHECK(problem_of(start, together) == "friction.calibration.rank");

  Model bad_film = start;
  bad_film.film.index = 2.0;
  CHECK(problem_of(bad_film, rows) == "resin.power_index.range");

  CHECK_THROWS_AS(calibrate(start, rows, {.plate_area = 0.0}), InputError);
}

TEST_CASE("calibration does not look at the law's own numbers beforehand", "[friction]") {
  // They are what it is about to find: a blank power law has scale 0, which check() refuses.
  const auto rows = measured_with(with_shift(HerseyPower{0.4, 0.2}, -8e-4, Form::term), star_design());
  CHECK_FALSE(check(blank(HerseyPower{}, Form::term)).empty());
  CHECK(check(calibrate(blank(HerseyPower{}, Form::term), rows, {}).model).empty());
}

TEST_CASE("running out of iterations is a result with a reason", "[friction]") {
  const auto rows = measured_with(with_shift(HerseyPower{0.4, 0.2}, -8e-4, Form::term), star_design());
  const Calibration found =
      calibrate(blank(HerseyPower{}, Form::term), rows, {}, {}, {.search = {.iterations_max = 1}});
  CHECK_FALSE(found.summary.converged);
  CHECK(found.summary.reason == "the number of iterations ran out");
  CHECK(found.summary.iterations == 1);
}

TEST_CASE("the plate area moves the scale of the law and nothing on the rig", "[friction][analytic]") {
  const auto rows =
      measured_with(with_shift(HerseyPower{0.4, 0.2}, -8e-4, Form::term), star_design(), {}, 0.02);
  const CalibrationBand band = calibrate_band(blank(HerseyPower{}, Form::term), rows, {});
  const auto law = [](const Calibration& c) { return std::get<HerseyPower>(c.model.law); };
  const double s = law(band.assumed).exponent;
  CHECK(law(band.low).exponent == Approx(s).epsilon(1e-6));
  CHECK(law(band.high).exponent == Approx(s).epsilon(1e-6));
  // Twice the area is half the pressure: Hs doubles and C falls by 2^-s.
  CHECK(law(band.high).scale == Approx(law(band.assumed).scale * std::pow(2.0, -s)).epsilon(1e-6));
  CHECK(law(band.low).scale == Approx(law(band.assumed).scale * std::pow(2.0, s)).epsilon(1e-6));
  CHECK(band.low.rms_error == Approx(band.high.rms_error).epsilon(1e-6));
}

TEST_CASE("the area exponent that made the forces is found", "[friction][analytic]") {
  const double a = GENERATE(0.0, 0.3, 0.75);
  const AreaFunction area = [a](double p) {
    const double phi = 0.1 * std::pow(p / 1e5, a);
    return std::pair{phi, a * phi / p};
  };
  const Model truth = with_shift(HerseyPower{0.4, 0.2}, -8e-4, Form::term);
  const auto rows = measured_with(truth, star_design(), area);
  const AreaExponent found = area_exponent_that_fits({}, blank(HerseyPower{}, Form::term).effects, rows, {});
  CHECK(found.summary.converged);
  CHECK(found.value == Approx(a).margin(1e-7));
  CHECK(found.law_exponent == Approx(0.2).epsilon(1e-7));
  CHECK(found.standard_error.has_value());
}

TEST_CASE("least squares finds the minimum from far away", "[friction][analytic]") {
  // Rosenbrock's valley: the plain Gauss-Newton step from the usual start overshoots.
  const ResidualFunction valley = [](const Eigen::VectorXd& x, Eigen::VectorXd& r, Eigen::MatrixXd& slopes) {
    r << 10.0 * (x[1] - x[0] * x[0]), 1.0 - x[0];
    slopes << -20.0 * x[0], 10.0, -1.0, 0.0;
  };
  const LeastSquaresResult found = minimise_squares(valley, Eigen::Vector2d(-1.2, 1.0), 2);
  CHECK(found.summary.converged);
  CHECK(found.parameters[0] == Approx(1.0).epsilon(1e-12));
  CHECK(found.parameters[1] == Approx(1.0).epsilon(1e-12));
}

TEST_CASE("least squares says so when it cannot start", "[friction]") {
  const ResidualFunction broken = [](const Eigen::VectorXd& x, Eigen::VectorXd& r, Eigen::MatrixXd& slopes) {
    r[0] = std::sqrt(x[0]);
    slopes(0, 0) = 0.5 / r[0];
  };
  const LeastSquaresResult found = minimise_squares(broken, Eigen::VectorXd::Constant(1, -1.0), 1);
  CHECK_FALSE(found.summary.converged);
  CHECK(found.summary.reason == "the residuals are not finite at the starting values");
}
