#include "friction/model.h"

#include <array>
#include <bit>
#include <catch2/catch.hpp>
#include <cmath>
#include <cstdint>
#include <limits>
#include <random>
#include <stdexcept>
#include <string>
#include <vector>

#include "friction/hersey.h"
#include "tests/derivative_check.h"

using namespace heddle::friction;
using heddle::test::derivative_gap;

namespace {

using Form = ToolTemperatureShift::Form;

const CalibrationBox box{.hersey_low = 0.18, .hersey_high = 0.51};

const std::array<Law, 3> laws{Coulomb{0.3}, HerseyPower{.scale = 0.325, .exponent = 0.136},
                              HerseyLinear{.offset = 0.237, .slope = 0.044, .reference = 0.362}};

Model shifted(const Law& law, Form form) {
  const double slope = form == Form::term ? -9.7e-4 : -3.4e-3;
  return {.law = law,
          .film = {},
          .effects = {.tool_temperature_shift = ToolTemperatureShift{.slope = slope, .form = form}},
          .box = box};
}

/// A contact whose area fraction follows its pressure, phi = 0.1 (p_f / 100 kPa)^0.6.
Context contact(double speed, double pressure, double fabric, double tool) {
  const FlooredPressure pf = floored(pressure);
  const double phi = 0.1 * std::pow(pf.value / 1e5, 0.6);
  return {.slip_speed = speed,
          .pressure = pressure,
          .fabric_temperature = fabric,
          .tool_temperature = tool,
          .area_fraction = phi,
          .area_slope = 0.6 * phi / pf.value * pf.slope};
}

/// All numbers of a result as bits, so that "equal" means equal.
std::vector<std::uint64_t> bits(const Friction& f) {
  std::vector<std::uint64_t> all;
  for (const double x : {f.mu, f.dmu_dspeed, f.dmu_dpressure, f.dmu_dfabric_temperature,
                         f.dmu_dtool_temperature, f.hersey, f.film_viscosity, f.state.slip, f.state.dwell,
                         f.state.work_per_area, f.state.slip_resistance, f.state.film_temperature}) {
    all.push_back(std::bit_cast<std::uint64_t>(x));
  }
  all.push_back(f.convex ? 1 : 0);
  return all;
}

std::vector<Context> random_contacts(std::size_t count) {
  std::mt19937 generator(17);
  std::uniform_real_distribution<double> share(0.0, 1.0);
  std::vector<Context> contexts;
  for (std::size_t i = 0; i < count; ++i) {
    contexts.push_back(contact(0.3 * share(generator), 4e5 * share(generator),
                               433.0 + 40.0 * share(generator), 294.0 + 119.0 * share(generator)));
  }
  return contexts;
}

/// Zero slopes are compared with zero: differences of a constant are zero as well.
void check_slope(const std::function<double(double)>& f, double x, double scale, double slope) {
  CHECK(derivative_gap(f, x, scale, slope) < 2e-6);
  CHECK(derivative_gap(f, x, scale, 1.01 * slope + 1e-3 * f(x) / scale) > 1e-4);  // the check can fail
}

}  // namespace

TEST_CASE("every slope of every law with every form of shift agrees with central differences",
          "[friction][derivative]") {
  const std::size_t which = GENERATE(0u, 1u, 2u);
  const Form form = GENERATE(Form::term, Form::factor);
  const double speed = GENERATE(0.0, 5e-5, 1e-3, 0.2);
  const double pressure = GENERATE(0.0, 0.7, 8e3, 3e5);
  const double fabric = 450.0, tool = 400.0;
  const Model model = shifted(laws[which], form);
  CAPTURE(which, static_cast<int>(form), speed, pressure);

  const Friction here = evaluate(model, contact(speed, pressure, fabric, tool), {});
  const auto mu = [&](double u, double p, double f, double t) {
    return evaluate(model, contact(u, p, f, t), {}).mu;
  };
  check_slope([&](double u) { return mu(u, pressure, fabric, tool); }, speed, std::max(speed, 7e-5),
              here.dmu_dspeed);
  check_slope([&](double p) { return mu(speed, p, fabric, tool); }, pressure, std::max(pressure, 1.0),
              here.dmu_dpressure);
  check_slope([&](double f) { return mu(speed, pressure, f, tool); }, fabric, 100.0,
              here.dmu_dfabric_temperature);
  check_slope([&](double t) { return mu(speed, pressure, fabric, t); }, tool, 100.0,
              here.dmu_dtool_temperature);
}

TEST_CASE("traction slopes agree with central differences down to no load", "[friction][derivative]") {
  const std::size_t which = GENERATE(0u, 1u, 2u);
  const double pressure = GENERATE(0.0, 0.7, 8e3, 3e5);
  const Model model = shifted(laws[which], Form::term);
  CAPTURE(which, pressure);

  const Traction here = traction(model, contact(0.03, pressure, 450.0, 400.0), {});
  const auto tau = [&](double u, double p) { return traction(model, contact(u, p, 450.0, 400.0), {}).value; };
  const double scale = std::max(pressure, 1.0);
  const auto in_pressure = [&](double p) { return tau(0.03, p); };
  CHECK(derivative_gap(in_pressure, pressure, scale, here.dtau_dpressure) < 1e-6);
  CHECK(derivative_gap(in_pressure, pressure, scale, 1.01 * here.dtau_dpressure) > 1e-4);
  const auto in_speed = [&](double u) { return tau(u, pressure); };
  CHECK(derivative_gap(in_speed, 0.03, 0.03, here.dtau_dspeed) < 1e-6);
  if (here.dtau_dspeed != 0.0) CHECK(derivative_gap(in_speed, 0.03, 0.03, 1.01 * here.dtau_dspeed) > 1e-4);
}

TEST_CASE("mu, traction and their slopes are finite at rest and without load", "[friction][bound]") {
  const std::size_t which = GENERATE(0u, 1u, 2u);
  const double speed = GENERATE(0.0, 0.1);
  const double pressure = GENERATE(0.0, 1e-300, 1e-3, 1e5);
  const Traction t =
      traction(shifted(laws[which], Form::term), {.slip_speed = speed, .pressure = pressure}, {});
  CAPTURE(which, speed, pressure);
  for (const double x : {t.value, t.dtau_dspeed, t.dtau_dpressure, t.friction.mu, t.friction.dmu_dspeed,
                         t.friction.dmu_dpressure, t.friction.dmu_dfabric_temperature}) {
    CHECK(std::isfinite(x));
  }
  CHECK(t.friction.mu > 0.0);
}

TEST_CASE("traction vanishes without load and its slope there is mu", "[friction][analytic]") {
  const Traction t = traction(shifted(laws[1], Form::term), {.slip_speed = 0.1, .pressure = 0.0}, {});
  CHECK(t.value == 0.0);
  CHECK(t.dtau_dpressure == t.friction.mu);
}

TEST_CASE("the pressure floor is not felt at forming pressures", "[friction][bound]") {
  // Without the floor mu = C (eta U / (p h))^s exactly; 5 kPa is the lowest pressure of interest.
  const Model model{.law = laws[1], .film = {}, .effects = {}, .box = {}};
  const Context context{.slip_speed = 0.1, .pressure = 5e3};
  const Friction f = evaluate(model, context, {});
  const PowerLawFilm film;
  const double rest = film.thickness * film.rate_floor;
  const double bare = f.film_viscosity * std::sqrt(0.1 * 0.1 + rest * rest) / (5e3 * film.thickness);
  CHECK(f.mu == Approx(0.325 * std::pow(bare, 0.136)).epsilon(1e-8));
}

TEST_CASE("equal Hersey number and equal tool temperature give equal mu", "[friction][invariant]") {
  // Paper, section 2. A hotter fabric at higher speed, and half the area at half the pressure.
  const Model model = shifted(laws[GENERATE(1u, 2u)], Form::term);
  const PowerLawFilm& film = model.film;
  const Context reference{.slip_speed = 0.02, .pressure = 1e5, .tool_temperature = 380.0};
  Context hotter = reference;
  hotter.fabric_temperature = 470.0;
  hotter.slip_speed *= std::pow(film.consistency_at(453.15) / film.consistency_at(470.0), 1.0 / film.index);
  Context smaller = reference;
  smaller.pressure *= 0.5;
  smaller.area_fraction = 0.5;

  const double mu = evaluate(model, reference, {}).mu;
  CHECK(evaluate(model, hotter, {}).hersey == Approx(evaluate(model, reference, {}).hersey).epsilon(1e-5));
  CHECK(evaluate(model, hotter, {}).mu == Approx(mu).epsilon(1e-6));
  CHECK(evaluate(model, smaller, {}).mu == Approx(mu).epsilon(1e-9));

  Context hotter_tool = reference;
  hotter_tool.tool_temperature += 20.0;
  CHECK(evaluate(model, hotter_tool, {}).mu < 0.95 * mu);  // the tool temperature is what Hs does not hold
}

TEST_CASE("mu rises with speed, falls with load and falls with tool temperature", "[friction][paper]") {
  const Model model = shifted(laws[GENERATE(1u, 2u)], GENERATE(Form::term, Form::factor));
  const Friction f = evaluate(model, {.slip_speed = 16.67e-3, .pressure = 150e3}, {});
  CHECK(f.dmu_dspeed > 0.0);
  CHECK(f.dmu_dpressure < 0.0);
  CHECK(f.dmu_dtool_temperature < 0.0);
  CHECK(f.convex);
}

TEST_CASE("constant mu has no Hersey number, no viscosity and no slopes", "[friction][analytic]") {
  const Friction f = evaluate({.law = Coulomb{0.3}, .film = {}, .effects = {}, .box = {}},
                              {.slip_speed = 0.1, .pressure = 1e5}, {});
  CHECK(f.mu == 0.3);
  CHECK(f.dmu_dspeed == 0.0);
  CHECK(f.dmu_dpressure == 0.0);
  CHECK(f.hersey == 0.0);
  CHECK(f.film_viscosity == 0.0);
  CHECK(f.convex);
}

TEST_CASE("a law that falls with the Hersey number is flagged not convex, at rest as well",
          "[friction][invariant]") {
  const double speed = GENERATE(0.0, 0.1);
  const Context context{.slip_speed = speed, .pressure = 1e5};
  const auto convex = [&](const Law& law) {
    return evaluate({.law = law, .film = {}, .effects = {}, .box = box}, context, {}).convex;
  };
  CHECK_FALSE(convex(HerseyPower{.scale = 0.3, .exponent = -0.1}));
  CHECK_FALSE(convex(HerseyLinear{.offset = 0.3, .slope = -0.02, .reference = 0.36}));
  CHECK(convex(HerseyPower{.scale = 0.3, .exponent = 0.1}));
  CHECK(convex(HerseyPower{.scale = 0.3, .exponent = 0.0}));
}

TEST_CASE("a batch gives the same bits as its points one by one", "[friction][invariant]") {
  const Model model = shifted(laws[GENERATE(0u, 1u, 2u)], GENERATE(Form::term, Form::factor));
  const std::vector<Context> contexts = random_contacts(200);
  std::vector<ContactState> states(contexts.size());
  for (std::size_t i = 0; i < states.size(); ++i) states[i].slip = 1e-3 * static_cast<double>(i);
  std::vector<Friction> out(contexts.size());
  evaluate(model, contexts, states, out);
  std::size_t different = 0;
  for (std::size_t i = 0; i < contexts.size(); ++i) {
    if (bits(out[i]) != bits(evaluate(model, contexts[i], states[i]))) ++different;
  }
  CHECK(different == 0);
}

TEST_CASE("a batch of unequal lengths is refused", "[friction]") {
  const std::vector<Context> contexts(3);
  const std::vector<ContactState> states(3);
  std::vector<Friction> out(2);
  CHECK_THROWS_AS(evaluate(Model{}, contexts, states, out), std::invalid_argument);
}

TEST_CASE("laws without memory return the state unchanged", "[friction][invariant]") {
  const ContactState state{
      .slip = 0.01, .dwell = 0.2, .work_per_area = 300.0, .slip_resistance = 0.4, .film_temperature = 400.0};
  const Model model = shifted(laws[GENERATE(0u, 1u, 2u)], Form::term);
  const Context context{.slip_speed = 0.1, .pressure = 1e5};
  const Friction f = evaluate(model, context, state);
  Friction expected = evaluate(model, context, {});
  expected.state = state;
  CHECK(bits(f) == bits(expected));
}

TEST_CASE("tool temperature shift at its off value restores the baseline bit for bit",
          "[friction][invariant]") {
  const Law law = laws[GENERATE(0u, 1u, 2u)];
  const Form form = GENERATE(Form::term, Form::factor);
  const double off = GENERATE(0.0, -0.0);
  const Model without{.law = law, .film = {}, .effects = {}, .box = box};
  Model with = without;
  with.effects.tool_temperature_shift = ToolTemperatureShift{.slope = off, .form = form};
  std::size_t different = 0;
  for (const Context& context : random_contacts(200)) {
    if (bits(evaluate(without, context, {})) != bits(evaluate(with, context, {}))) ++different;
  }
  CHECK(different == 0);
}

TEST_CASE("a tiny tool temperature shift is seen, and twice the shift does twice as much",
          "[friction][invariant]") {
  const Form form = GENERATE(Form::term, Form::factor);
  const Context context{.slip_speed = 0.1, .pressure = 1e5, .tool_temperature = 413.15};
  const auto change = [&](double slope) {
    Model model{.law = laws[1], .film = {}, .effects = {}, .box = box};
    const double baseline = evaluate(model, context, {}).mu;
    model.effects.tool_temperature_shift = ToolTemperatureShift{.slope = slope, .form = form};
    return evaluate(model, context, {}).mu - baseline;
  };
  CHECK(change(1e-6) > 0.0);
  CHECK(change(2e-6) == Approx(2.0 * change(1e-6)).epsilon(0.01));
}

TEST_CASE("both forms of the shift are nothing at the reference and differ where mu is large",
          "[friction][analytic]") {
  // One law, one tool 55 K hotter. The term takes 0.0533 off at every load, the factor 18.7 % of mu.
  const Context at_reference{.slip_speed = 0.1, .pressure = 5e3, .tool_temperature = 358.15};
  Context hot = at_reference;
  hot.tool_temperature += 55.0;
  const Model term = shifted(laws[1], Form::term), factor = shifted(laws[1], Form::factor);
  const double mu = evaluate(term, at_reference, {}).mu;
  CHECK(evaluate(factor, at_reference, {}).mu == mu);
  CHECK(evaluate(term, hot, {}).mu == Approx(mu - 55.0 * 9.7e-4).epsilon(1e-12));
  CHECK(evaluate(factor, hot, {}).mu == Approx(mu * (1.0 - 55.0 * 3.4e-3)).epsilon(1e-12));
  CHECK(evaluate(factor, hot, {}).mu < evaluate(term, hot, {}).mu);
}

TEST_CASE("what is not finite, or negative, is an error that names point and quantity",
          "[friction][wrong input]") {
  const Model model = shifted(laws[1], Form::term);
  std::vector<Context> contexts(4, {.slip_speed = 0.1, .pressure = 1e5});
  const std::vector<ContactState> states(4);
  std::vector<Friction> out(4);

  contexts[2].pressure = std::numeric_limits<double>::quiet_NaN();
  CHECK_THROWS_WITH(evaluate(model, contexts, states, out),
                    Catch::Contains("point 2") && Catch::Contains("nan"));

  contexts[2].pressure = 1e5;
  contexts[3].area_slope = std::numeric_limits<double>::infinity();
  CHECK_THROWS_WITH(evaluate(model, contexts, states, out),
                    Catch::Contains("point 3") && Catch::Contains("dmu/dp"));

  contexts[3].area_slope = 0.0;
  contexts[1].tool_temperature = 900.0;
  CHECK_THROWS_WITH(evaluate(model, contexts, states, out),
                    Catch::Contains("point 1") && Catch::Contains("negative"));
  CHECK_THROWS_AS(evaluate(model, contexts[1], {}), heddle::NumericalError);
}
