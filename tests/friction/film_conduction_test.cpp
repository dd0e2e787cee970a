#include <algorithm>
#include <catch2/catch.hpp>
#include <cmath>
#include <numbers>
#include <vector>

#include <fmt/format.h>

#include "friction/effects/film_effects.h"
#include "friction/film/film_conduction.h"
#include "friction/friction_test.h"
#include "friction/model.h"
#include "tests/derivative_check.h"
#include "tests/friction/every_model.h"
#include "tests/friction/heated_film.h"

using namespace heddle::friction;
using namespace heddle::test;

namespace {

constexpr double h = 0.07e-3;
constexpr double huge = 1e8;  // of conductivity and heat capacity: a wall that keeps its temperature

double at(const heddle::Curve& curve, double time) {
  return curve(std::log(time));
}

/// Share of the tool in the film's mean temperature.
double mean_at(const FilmConduction& film, double time) {
  double mean = 0.0;
  for (std::size_t i = 0; i < film_points; ++i) mean += film_point_weight[i] * at(film.share[i], time);
  return mean;
}

Model with_conduction(FilmConductionSpec spec = {}) {
  Model model{.law = HerseyPower{.scale = 0.325, .exponent = 0.136}, .film = {}, .effects = {}, .box = {}};
  model.conduction = film_conduction(spec, h);
  return model;
}

}  // namespace

TEST_CASE("a film on a half-space of its own material takes on the effusivity share of the tool",
          "[friction][conduction][analytic]") {
  FilmConductionSpec spec;
  spec.ply_conductivity = spec.film_conductivity;
  spec.ply_heat_capacity = spec.film_heat_capacity;
  spec.ply_thickness = 50e-3;  // no end within 200 s
  const FilmConduction film = film_conduction(spec, h);
  const double tool = std::sqrt(spec.tool_conductivity * spec.tool_heat_capacity),
               melt = std::sqrt(spec.film_conductivity * spec.film_heat_capacity);
  const double w = tool / (tool + melt);
  CHECK(w == Approx(0.945).epsilon(1e-3));
  for (const double share : {1e-3, 0.03, 0.4, 3.0, 100.0, 2000.0}) {
    const double time = share * film.settling();
    CAPTURE(share);
    CHECK(at(film.face, time) == Approx(w).epsilon(2e-3));
    CHECK(mean_at(film, time) == Approx(w * settled_share(share).value).margin(share < 0.01 ? 0.02 : 1e-3));
  }
}

TEST_CASE("a film between a held tool and an insulating ply follows its Fourier series",
          "[friction][conduction][analytic]") {
  FilmConductionSpec spec{.tool_conductivity = huge,
                          .tool_heat_capacity = huge,
                          .ply_conductivity = 1e-9,
                          .ply_heat_capacity = 1e-3};
  const FilmConduction film = film_conduction(spec, h);
  const double k2 = std::numbers::pi * std::numbers::pi / 4.0;
  for (const double share : {0.02, 0.1, 0.5, 2.0, 20.0}) {
    double mean = 1.0, rise = 1.0 / 3.0;
    for (int m = 0; m < 200; ++m) {
      const double odd = (2 * m + 1) * (2 * m + 1), fade = std::exp(-odd * k2 * share);
      mean -= 2.0 / (odd * k2) * fade;
      rise -= 2.0 / (odd * odd * k2 * k2) * fade;
    }
    CAPTURE(share);
    CHECK(mean_at(film, share * film.settling()) == Approx(mean).margin(5e-4));
    CHECK(at(film.rise, share * film.settling()) == Approx(rise).margin(3e-4));
  }
}

TEST_CASE("a source in the film warms it by 1/12 between held walls and by 1/3 with one adiabatic",
          "[friction][conduction][analytic]") {
  FilmConductionSpec held{.tool_conductivity = huge,
                          .tool_heat_capacity = huge,
                          .ply_conductivity = huge,
                          .ply_heat_capacity = 1e4 * huge};
  const auto settled = [](const FilmConductionSpec& spec) {
    const FilmConduction film = film_conduction(spec, h);
    return at(film.rise, 10.0 * film.settling());
  };
  CHECK(settled(held) == Approx(1.0 / 12.0).epsilon(2e-3));
  FilmConductionSpec adiabatic{.tool_conductivity = huge,
                               .tool_heat_capacity = huge,
                               .ply_conductivity = 1e-9,
                               .ply_heat_capacity = 1e-3};
  CHECK(settled(adiabatic) == Approx(1.0 / 3.0).epsilon(1e-3));
}

TEST_CASE("curves of the film lie within 1e-3 of those on a grid and in steps four times as fine",
          "[friction][conduction][convergence]") {
  for (const double resistance : {0.0, 5e-4}) {
    const FilmConductionSpec spec{.contact_resistance = resistance};
    const FilmConduction film = film_conduction(spec, h);
    const FilmConduction fine = film_conduction(
        spec, h, {.points_per_fold = 31, .steps_per_point = 4, .first_width = 2.5e-5, .growth = 1.03});
    double share = 0.0, face = 0.0, rise = 0.0;
    for (double t = 1e-4 * film.settling(); t < 1000.0; t *= 1.07) {
      for (std::size_t i = 0; i < film_points; ++i)
        share = std::max(share, std::abs(at(film.share[i], t) - at(fine.share[i], t)));
      face = std::max(face, std::abs(at(film.face, t) - at(fine.face, t)));
      rise = std::max(rise, std::abs(at(film.rise, t) / at(fine.rise, t) - 1.0));
    }
    CAPTURE(resistance, share, face, rise);
    CHECK(share < 1e-3);
    CHECK(face < 1e-3);
    CHECK(rise < 1e-3);   // of itself
    CHECK(share > 1e-9);  // there is something to see
  }
}

TEST_CASE("a slow pull and a stamping stroke see different films, more so through a contact that resists",
          "[friction][conduction]") {
  for (const double resistance : {0.0, 5e-4}) {
    Model model = with_conduction({.contact_resistance = resistance});
    model.effects.tool_temperature_film = ToolTemperatureFilm{.weight = 1.0, .settling = 0.0};
    const Context context{.slip_speed = 0.02, .pressure = 1e5};
    const auto film_at = [&](double dwell) {
      return evaluate(model, context, {.dwell = dwell}).state.film_temperature - 273.15;
    };
    CAPTURE(resistance, film_at(0.02), film_at(0.43), film_at(3.0));
    fmt::print("film, contact resistance {} m2 K/W: {:.0f}, {:.0f}, {:.0f} degC after 0.02, 0.43, 3 s\n",
               resistance, film_at(0.02), film_at(0.43), film_at(3.0));
    CHECK(film_at(0.02) > film_at(0.43) + 5.0);
    CHECK(film_at(0.43) > film_at(3.0) + 5.0);
    CHECK(film_at(3.0) > 85.0);
    CHECK(film_at(0.02) < 180.0);
  }
}

TEST_CASE("the effects that draw on the film's conduction have exact slopes", "[friction][derivative]") {
  for (const char* id : {"tool_temperature_film", "solidification", "shear_heating"})
    for (const double dwell : {0.003, 0.051, 0.4, 2.7})
      for (const double speed : {2e-4, 0.02, 0.3}) {
        Model model = with_conduction({.contact_resistance = 2e-4});
        for (const NamedEffect& effect : every_effect())
          if (effect.id == id) effect.set(model.effects, effect.id == "solidification" ? 0.8 : 1.0);
        const Context context = contact_at(speed, 5e4, 450.0, 385.0);
        const ContactState state{.slip = 0.7 * dwell * 0.02, .dwell = dwell};
        const Friction here = evaluate(model, context, state);
        CAPTURE(id, dwell, speed);
        const auto slope_is_exact = [&](const auto& mu, double x, double scale, double slope) {
          if (std::abs(slope) * scale < 1e-7) return;  // below the noise of mu
          CHECK(derivative_gap(mu, x, scale, slope) < 1e-6);
          CHECK(derivative_gap(mu, x, scale, 1.01 * slope) > 1e-4);  // the check can fail
        };
        const auto moved = [&](auto change) {
          return [&, change](double x) {
            Context c = context;
            ContactState s = state;
            change(c, s, x);
            return evaluate(model, c, s).mu;
          };
        };
        slope_is_exact(moved([](Context&, ContactState& s, double x) { s.dwell = x; }), dwell, 0.01 * dwell,
                       here.history.dmu_ddwell);
        slope_is_exact(moved([](Context&, ContactState& s, double x) { s.slip = x; }), state.slip,
                       0.01 * state.slip, here.history.dmu_dslip);
        slope_is_exact(moved([](Context& c, ContactState&, double x) { c.slip_speed = x; }), speed, speed,
                       here.dmu_dspeed);
        slope_is_exact(moved([](Context& c, ContactState&, double x) { c.tool_temperature = x; }), 385.0,
                       20.0, here.dmu_dtool_temperature);
        slope_is_exact(moved([](Context& c, ContactState&, double x) { c.fabric_temperature = x; }), 450.0,
                       20.0, here.dmu_dfabric_temperature);
      }
}

TEST_CASE("with its effects off a film conduction leaves the law to the bit", "[friction][invariant]") {
  const Model plain{
      .law = HerseyPower{.scale = 0.325, .exponent = 0.136}, .film = {}, .effects = {}, .box = {}};
  Model model = with_conduction();
  const Context context = contact_at(0.02, 5e4, 450.0, 385.0);
  const ContactState state{.slip = 0.01, .dwell = 0.4};
  CHECK(evaluate(model, context, state).mu == evaluate(plain, context, state).mu);
  model.effects.tool_temperature_film = ToolTemperatureFilm{.weight = 0.0};
  model.effects.shear_heating = ShearHeating{.amplitude = 0.0};
  model.effects.solidification = Solidification{.amplitude = 0.0};
  CHECK(evaluate(model, context, state).mu == evaluate(plain, context, state).mu);
  CHECK_FALSE(has_memory(model));
}

TEST_CASE("the reduced film meets the whole conduction with local heating", "[friction][conduction]") {
  // Full: power law in every cell of the film, one stress, heat where it is made. Reduced: five points
  // through the film; or, for comparison, its mean temperature.
  const PowerLawFilm film;
  Model model = with_conduction();
  model.effects.tool_temperature_film = ToolTemperatureFilm{.weight = 1.0, .settling = 0.0};
  model.effects.shear_heating = ShearHeating{.amplitude = 1.0};
  const FilmConductionSpec spec = model.conduction->spec;
  struct Gap {
    double points = 0.0, mean = 0.0;
  };
  const auto worst_gap = [&](double speed, double tool) {
    const double from = 1e-3 * model.conduction->settling();
    HeatedFilm full{.ends = {}, .index = film.index, .speed = speed};
    const double last = 3.0;
    std::vector<double> in_tool = growing_widths(8.0 * std::sqrt(8e-6 * last), 1e-6, 1.12);
    std::reverse(in_tool.begin(), in_tool.end());
    append_layer(full.grid, {spec.tool_conductivity, spec.tool_heat_capacity}, in_tool);
    full.first = full.grid.size();
    append_layer(full.grid, {spec.film_conductivity, spec.film_heat_capacity},
                 widths_from_both_faces(h, 2e-3 * h, 1.12));
    full.count = full.grid.size() - full.first;
    append_layer(full.grid, {spec.ply_conductivity, spec.ply_heat_capacity},
                 growing_widths(spec.ply_thickness, 2e-7, 1.12));
    full.consistency = [&](double t) { return film.consistency_at(t); };
    full.temperature.assign(full.grid.size(), 453.15);
    std::fill_n(full.temperature.begin(), full.first, tool);
    double now = 0.0;
    Gap worst;
    for (double end = 1e-6; now < last; end = std::min(1.03 * end, last)) {
      full.step(end - now);
      now = end;
      if (now < from) continue;
      const Context context{.slip_speed = speed, .pressure = 1e5, .tool_temperature = tool};
      const Friction law = evaluate(model, context, {.slip = speed * now, .dwell = now});
      const double stress = law.film_viscosity * speed / h;
      worst.points = std::max(worst.points, std::abs(stress / full.stress() - 1.0));
      const double mean = 453.15 + mean_at(*model.conduction, now) * (tool - 453.15);
      const double stress_of_mean = film.consistency_at(mean) * std::pow(speed / h, film.index);
      worst.mean = std::max(worst.mean, std::abs(stress_of_mean / full.stress() - 1.0));
    }
    return worst;
  };
  // At stamping speed over a cold tool the shear, and with it the heat, gathers where the film meets the ply;
  // the rise is that of a film heated evenly, and the stress 12 % too high (mu: 2 %).
  struct Row {
    double speed, tool, limit;
  };
  for (const auto& [speed, tool, limit] :
       {Row{1.66e-3, 358.15, 0.015}, Row{1.66e-3, 413.15, 0.01}, Row{16.67e-3, 358.15, 0.02},
        Row{16.67e-3, 413.15, 0.01}, Row{163e-3, 358.15, 0.15}, Row{163e-3, 413.15, 0.03}}) {
    const auto [points, mean] = worst_gap(speed, tool);
    CAPTURE(speed, tool, points, mean);
    fmt::print(
        "film at {:.2f} mm/s over a tool of {:.0f} degC: stress off by at most {:.1f} % (five points), "
        "{:.0f} % (mean)\n",
        1e3 * speed, tool - 273.15, 100.0 * points, 100.0 * mean);
    CHECK(points < limit);
    CHECK(mean > 3.0 * points);  // what the points are for
  }
}
