#include <bit>
#include <catch2/catch.hpp>
#include <cmath>
#include <cstdint>

#include "friction/combinations.h"
#include "tests/derivative_check.h"
#include "tests/friction/every_model.h"

using namespace heddle::friction;
using namespace heddle::test;

namespace {

const CalibrationBox box{.hersey_low = 0.03, .hersey_high = 1.5};

struct Point {
  double speed, pressure, fabric, tool;
  ContactState state;
};

Friction at(const Model& model, const Point& point) {
  return evaluate_unchecked(model, contact_at(point.speed, point.pressure, point.fabric, point.tool),
                            point.state);
}

/// Largest relative gap of all nine slopes against central differences. A variable the model does not see has
/// slope 0 and difference 0. `fault` scales every slope first.
double worst_gap(const Model& model, const Point& point, double fault = 1.0) {
  const Friction here = at(model, point);
  double worst = 0.0;
  const auto compare = [&](double slope, double Point::*field, double scale) {
    const auto mu = [&](double x) {
      Point moved = point;
      moved.*field = x;
      return at(model, moved).mu;
    };
    // Slopes below the noise of mu over the scale are nothing.
    const double change = std::abs(slope) * scale;
    if (change < 1e-7 && std::abs(mu(point.*field + 1e-3 * scale) - here.mu) < 1e-9) return;
    worst = std::max(worst, derivative_gap(mu, point.*field, scale, fault * slope));
  };
  compare(here.dmu_dspeed, &Point::speed, std::max(point.speed, 1e-4));
  compare(here.dmu_dpressure, &Point::pressure, std::max(point.pressure, 1.0));
  compare(here.dmu_dfabric_temperature, &Point::fabric, 20.0);
  compare(here.dmu_dtool_temperature, &Point::tool, 20.0);
  const auto compare_state = [&](double slope, double ContactState::*field, double scale) {
    const auto mu = [&](double x) {
      Point moved = point;
      moved.state.*field = x;
      return at(model, moved).mu;
    };
    if (slope == 0.0 && mu(point.state.*field + 1e-3 * scale) == here.mu) return;
    worst = std::max(worst, derivative_gap(mu, point.state.*field, scale, fault * slope));
  };
  compare_state(here.history.dmu_dslip, &ContactState::slip, 1e-3);
  compare_state(here.history.dmu_ddwell, &ContactState::dwell, 0.05);
  compare_state(here.history.dmu_dage, &ContactState::age, 0.5);
  compare_state(here.history.dmu_dload_slip, &ContactState::load_slip, 3e3);
  compare_state(here.history.dmu_dslip_resistance, &ContactState::slip_resistance, 0.02);
  return worst;
}

bool flat(const Friction& f) {
  return f.dmu_dspeed == 0.0 && f.dmu_dpressure == 0.0 && f.history.dmu_dslip == 0.0 &&
         f.history.dmu_dslip_resistance == 0.0;
}

std::vector<Point> random_points(std::size_t count) {
  std::mt19937 generator(29);
  std::uniform_real_distribution<double> share(0.0, 1.0);
  std::vector<Point> points;
  for (std::size_t i = 0; i < count; ++i) {
    Point point{.speed = 1e-4 * std::pow(3e3, share(generator)),
                .pressure = 2e3 * std::pow(200.0, share(generator)),
                .fabric = 433.0 + 40.0 * share(generator),
                .tool = 350.0 + 60.0 * share(generator),
                .state = used_contact()};
    point.state.slip *= share(generator);
    point.state.dwell *= 0.1 + share(generator);
    points.push_back(point);
  }
  return points;
}

Model model_of(const Law& law, const Rheology& rheology = {}) {
  return {.law = law, .film = {}, .effects = {}, .box = box, .rheology = rheology};
}

bool allowed(const Model& model) {
  return check_combinations(model).empty();
}

std::vector<std::uint64_t> bits(const Friction& f) {
  std::vector<std::uint64_t> all;
  for (const double x :
       {f.mu, f.dmu_dspeed, f.dmu_dpressure, f.dmu_dfabric_temperature, f.dmu_dtool_temperature, f.hersey,
        f.film_viscosity, f.state.slip, f.state.dwell, f.state.work_per_area, f.state.slip_resistance,
        f.state.film_temperature, f.state.age, f.state.load_slip, f.history.dmu_dslip, f.history.dmu_ddwell,
        f.history.dmu_dage, f.history.dmu_dload_slip, f.history.dmu_dslip_resistance})
    all.push_back(std::bit_cast<std::uint64_t>(x));
  all.push_back(f.convex);
  return all;
}

}  // namespace

TEST_CASE("every slope of every law with every rheology agrees with central differences",
          "[friction][derivative]") {
  for (const Law& law : every_law())
    for (const Rheology& rheology : every_rheology()) {
      if (!reads_hersey_number(law) && !rheology.of_the_film()) continue;  // sees no film
      for (const Point& point : random_points(8)) {
        const Model model = model_of(law, rheology);
        CAPTURE(id_of(law), law.index(), rheology.flow.index(), rheology.temperature.index(), point.speed,
                point.pressure);
        CHECK(worst_gap(model, point) < 1e-6);
        if (!flat(at(model, point))) CHECK(worst_gap(model, point, 1.01) > 1e-4);  // the check can fail
      }
    }
}

TEST_CASE("every slope of every law with every effect agrees with central differences",
          "[friction][derivative]") {
  for (const Law& law : every_law())
    for (const NamedEffect& effect : every_effect()) {
      Model model = model_of(law);
      effect.set(model.effects, effect.usual);
      if (!allowed(model)) continue;
      for (const Point& point : random_points(6)) {
        CAPTURE(id_of(law), law.index(), effect.id, point.speed, point.pressure, point.tool);
        CHECK(worst_gap(model, point) < 1e-6);
        // The check can fail, wherever a slope is more than rounding.
        if (worst_gap(model, point, 2.0) > 0.0) CHECK(worst_gap(model, point, 1.01) > 1e-4);
      }
    }
}

TEST_CASE("slopes of all effects together on every rheology agree with central differences",
          "[friction][derivative]") {
  for (const Rheology& rheology : every_rheology()) {
    Model model = model_of(HerseyPower{.scale = 0.325, .exponent = 0.136}, rheology);
    for (const NamedEffect& effect : every_effect()) {
      Model with = model;
      effect.set(with.effects, effect.usual);
      if (allowed(with)) model = with;
    }
    for (const Point& point : random_points(10)) {
      CAPTURE(rheology.flow.index(), rheology.temperature.index(), point.speed, point.pressure);
      CHECK(worst_gap(model, point) < 1e-6);
      CHECK(worst_gap(model, point, 1.01) > 1e-4);  // the check can fail
    }
  }
}

TEST_CASE("slopes agree with differences at the knees of the laws", "[friction][derivative]") {
  const Point base{
      .speed = 0.02, .pressure = 1.5e5, .fabric = 453.15, .tool = 370.0, .state = used_contact()};
  SECTION("Renard at its two speeds: value and slope go through") {
    const Renard law;
    for (const double knee : {law.first_speed, law.second_speed}) {
      Point below = base, above = base;
      below.speed = knee * (1.0 - 1e-9);
      above.speed = knee * (1.0 + 1e-9);
      CHECK(at(model_of(law), below).mu == Approx(at(model_of(law), above).mu).epsilon(1e-9));
      CHECK(at(model_of(law), below).dmu_dspeed == Approx(0.0).margin(1e-5));
      CHECK(at(model_of(law), above).dmu_dspeed == Approx(0.0).margin(1e-5));
    }
  }
  SECTION("the static coefficient ends smoothly at its slip") {
    const StaticKinetic law;
    Point end = base;
    end.state.slip = law.breakaway_slip;
    CHECK(at(model_of(law), end).mu == law.kinetic_coefficient);
    CHECK(at(model_of(law), end).history.dmu_dslip == 0.0);
    end.state.slip *= 1.0 - 1e-7;
    CHECK(at(model_of(law), end).history.dmu_dslip == Approx(0.0).margin(1e-4));
    end.state.slip = 0.0;
    CHECK(at(model_of(law), end).mu == law.static_coefficient);
  }
  SECTION("Hersey curves at both edges of the box") {
    for (const Law& law : {Law{StribeckCurve{.boundary = 0.45, .transition = 0.1}}, Law{FilmSolid{}}})
      for (const double edge : {box.hersey_low, box.hersey_high}) {
        const auto value = [&](double hersey) {
          return std::holds_alternative<FilmSolid>(law)
                     ? law_value(std::get<FilmSolid>(law), hersey, box)
                     : law_value(std::get<StribeckCurve>(law), hersey, box);
        };
        CHECK(value(edge * (1 - 1e-9)).mu == Approx(value(edge * (1 + 1e-9)).mu).epsilon(1e-8));
        CHECK(value(edge * (1 - 1e-9)).dmu_dlog_hersey ==
              Approx(value(edge * (1 + 1e-9)).dmu_dlog_hersey).epsilon(1e-7));
      }
  }
  SECTION("Stribeck through all three regimes") {
    const StribeckCurve law{.boundary = 0.45, .transition = 0.1, .sharpness = 2.0};
    CHECK(regime(law, 0.02) == Regime::boundary);
    CHECK(regime(law, 0.1) == Regime::mixed);
    CHECK(regime(law, 0.3) == Regime::hydrodynamic);
    for (const double hersey : {1e-6, 0.02, 0.1, 0.2, 0.3, 1e3}) {
      const auto mu = [&](double log_hersey) { return curve_value(law, std::exp(log_hersey)).mu; };
      const double slope = curve_value(law, hersey).dmu_dlog_hersey;
      if (std::abs(slope) > 1e-8) CHECK(derivative_gap(mu, std::log(hersey), 1.0, slope) < 1e-6);
    }
    CHECK(curve_value(law, 1e-9).mu == Approx(0.45));
    CHECK(curve_value(law, 0.1).dmu_dlog_hersey < 0.0);
    CHECK(curve_value(law, 1.0).dmu_dlog_hersey > 0.0);
    CHECK(std::isfinite(curve_value(law, 1e200).dmu_dlog_hersey));
  }
  SECTION("rheologies at rest, at the rate floor, at the bend of thinning and where the melt yields") {
    for (const Rheology& rheology : every_rheology())
      for (const double rate : {1e-3, 1.0, 1.0 / 0.268, 1.0 / 0.05, 1e3}) {
        Model model = model_of(HerseyPower{.scale = 0.325, .exponent = 0.136}, rheology);
        model.film.rate_floor = 1e-2;  // below the bends, or they would lie under it
        if (auto* melt = std::get_if<Bingham>(&model.rheology.flow)) melt->sharpness = 1.0;
        if (auto* melt = std::get_if<HerschelBulkley>(&model.rheology.flow)) melt->sharpness = 1.0;
        Point knee = base;
        knee.speed = rate * model.film.thickness;
        CAPTURE(rheology.flow.index(), rheology.temperature.index(), rate);
        CHECK(worst_gap(model, knee) < 1e-6);
        CHECK(worst_gap(model, knee, 1.01) > 1e-4);  // the check can fail
        knee.speed = 0.0;
        CHECK(at(model, knee).dmu_dspeed == 0.0);  // even in the speed
      }
  }
  SECTION("shear heating where its series hands over to the closed form") {
    Model model = model_of(HerseyPower{.scale = 0.325, .exponent = 0.136});
    for (const double amplitude : {1e-6, 1e-4, 1e-3, 1e-2, 1.0, 1e3}) {
      model.effects.shear_heating = ShearHeating{.amplitude = amplitude};
      CHECK(worst_gap(model, base) < 1e-6);
      CHECK(worst_gap(model, base, 1.01) > 1e-4);  // the check can fail
    }
  }
  SECTION("solid contact through a film that drains") {
    Model model = model_of(HerseyPower{.scale = 0.325, .exponent = 0.136});
    for (const double contact : {-0.5, 0.3, 2.0}) {
      model.effects.film_squeeze_out = FilmSqueezeOut{.rate = 1e-4, .contact = contact};
      CAPTURE(contact);
      CHECK(worst_gap(model, base) < 1e-6);
      CHECK(worst_gap(model, base, 1.01) > 1e-4);  // the check can fail
    }
  }
  SECTION("shear heating while the walls warm") {
    Model model = model_of(HerseyPower{.scale = 0.325, .exponent = 0.136});
    for (const double settling : {1e-4, 0.05, 5.0}) {
      model.effects.shear_heating = ShearHeating{.amplitude = 100.0, .settling = settling};
      CAPTURE(settling);
      CHECK(worst_gap(model, base) < 1e-6);
      CHECK(worst_gap(model, base, 1.01) > 1e-4);  // the check can fail
    }
  }
  SECTION("at rest and without load") {
    for (const Law& law : every_law()) {
      Point still = base;
      still.speed = 0.0;
      still.pressure = 0.0;
      const Friction f = at(model_of(law), still);
      CAPTURE(id_of(law));
      CHECK(std::isfinite(f.mu + f.dmu_dspeed + f.dmu_dpressure + f.dmu_dfabric_temperature));
    }
  }
}

TEST_CASE("an effect at its off value is the law without it, bit for bit", "[friction][effects][invariant]") {
  for (const Law& law : every_law())
    for (const NamedEffect& effect : every_effect())
      for (const double off : {0.0, -0.0}) {
        const Model without = model_of(law);
        Model with = without;
        effect.set(with.effects, off);
        std::size_t different = 0;
        for (const Point& point : random_points(20))
          if (bits(at(without, point)) != bits(at(with, point))) ++different;
        Point rest = random_points(1)[0];
        rest.speed = 0.0;
        if (bits(at(without, rest)) != bits(at(with, rest))) ++different;
        CAPTURE(id_of(law), effect.id);
        CHECK(different == 0);
      }
}

TEST_CASE("a tiny effect is seen, and twice of it does twice as much", "[friction][effects][invariant]") {
  Point point = random_points(1)[0];
  point.speed = 0.02;
  point.pressure = 2.5e5;
  point.tool = 400.0;
  for (const NamedEffect& effect : every_effect()) {
    const Model without = model_of(HerseyPower{.scale = 0.325, .exponent = 0.136});
    const auto change = [&](double amplitude) {
      Model with = without;
      effect.set(with.effects, amplitude);
      return at(with, point).mu - at(without, point).mu;
    };
    // In the effect's own size: 1e-6 of a stress in Pa would be lost in the rounding of mu.
    const double tiny = 1e-6 * std::max(std::abs(effect.usual), effect.id == "adhesion" ? 1e3 : 0.0);
    CAPTURE(effect.id, change(tiny));
    CHECK(std::abs(change(tiny)) > 1e-14);
    CHECK(change(2.0 * tiny) == Approx(2.0 * change(tiny)).epsilon(0.01));
    CHECK(std::abs(change(effect.usual)) > 1e-5);
  }
}

TEST_CASE("the order in which effects are given does not matter", "[friction][effects][invariant]") {
  const auto effects = every_effect();
  Model forwards = model_of(HerseyPower{.scale = 0.325, .exponent = 0.136}), backwards = forwards;
  for (std::size_t i = 0; i < effects.size(); ++i) {
    effects[i].set(forwards.effects, effects[i].usual);
    effects[effects.size() - 1 - i].set(backwards.effects, effects[effects.size() - 1 - i].usual);
  }
  for (const Point& point : random_points(20)) CHECK(bits(at(forwards, point)) == bits(at(backwards, point)));
}

TEST_CASE("equal Hersey number at equal tool temperature gives equal mu over Table 2, and effects break it",
          "[friction][invariant][paper]") {
  const Model paper = [] {
    Model model = model_of(HerseyPower{.scale = 0.325, .exponent = 0.136});
    model.effects.tool_temperature_shift = ToolTemperatureShift{.slope = -9.27e-4};
    return model;
  }();
  // Same Hs by half the load at a lower speed: m (U/h)^n / p alike (floors below 1e-5).
  const auto pair_gap = [&](const Model& model) {
    double worst = 0.0;
    for (const double velocity : {8.33e-3, 16.6e-3, 41.6e-3, 83.3e-3})
      for (const double force : {343.0, 1000.0, 1500.0, 3000.0, 4000.0})
        for (const double fabric : {433.15, 453.15, 473.15})
          for (const double tool : {294.15, 343.15, 358.15, 373.15, 393.15, 413.15}) {
            Context one;
            one.slip_speed = velocity;
            one.pressure = force / 0.01;
            one.fabric_temperature = fabric;
            one.tool_temperature = tool;
            Context other = one;
            other.pressure *= 0.5;
            other.slip_speed *= std::pow(0.5, 1.0 / model.film.index);
            ContactState state;
            state.slip = 5e-3;
            const double a = evaluate(model, one, state).mu, b = evaluate(model, other, state).mu;
            worst = std::max(worst, std::abs(a / b - 1.0));
          }
    return worst;
  };
  CHECK(pair_gap(paper) < 2e-4);  // the rate floor at 1.3 mm/s
  for (const NamedEffect& effect : every_effect()) {
    Model model = paper;
    effect.set(model.effects, effect.usual);
    // Those that see speed or load beside Hs break it; the others act alike on both pulls.
    const bool breaks = effect.id == "stick_slip" || effect.id == "pressure_dependent_area" ||
                        effect.id == "adhesion" || effect.id == "shear_heating" ||
                        effect.id == "viscosity_plateau";
    CAPTURE(effect.id);
    if (breaks) CHECK(pair_gap(model) > 1e-3);
    if (effect.id == "static_peak" || effect.id == "sliding_evolution" || effect.id == "orientation" ||
        effect.id == "tool_temperature_film" || effect.id == "boundary_lubrication")
      CHECK(pair_gap(model) < 2e-4);
  }
}
