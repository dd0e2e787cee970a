// Three runs prove an effect: without it, at its off value (equal bytes), and tiny (it acts, and linearly).
#include <catch2/catch.hpp>

#include <algorithm>
#include <cmath>
#include <filesystem>
#include <string>
#include <type_traits>
#include <vector>

#include "macroscale/stamping.h"
#include "pipeline/case.h"
#include "pipeline/outputs.h"
#include "tests/friction/every_model.h"
#include "tests/macroscale/sample_fabric.h"

using namespace heddle;

namespace {

const std::string stamping =
    "heddle: 1\nname: small\n"
    "weave: {pattern: plain, tow_width: 4.64 mm, gap: 0.75 mm, tow_thickness: 0.75 mm, fabric_thickness: 1.5 "
    "mm, linear_density: 1872 tex, fibre_mass_fraction: 60 %}\n"
    "friction: {law: stribeck, scale: 0.325, exponent: 0.136, calibration: {plate_area: 0.01 m^2}}\n"
    "process: {punch: {stroke: 25 mm, time: 0.15 s}, steps: 5, binder_force: 650 N,\n"
    "          tool_temperature: 100 degC, blank_temperature: 180 degC}\n"
    "blank: {size: [320 mm, 320 mm], spacing: 32 mm, grid_error: off}\n"
    "tools: {punch: {shape: hemisphere, radius: 70 mm}, die: {shape: ring, opening_radius: 72 mm, fillet: 20 "
    "mm}, binder: {shape: ring, inner_radius: 92 mm, mass: 20 kg}}\n";

struct Run {
  std::string history;  ///< history.csv
  double force;         ///< of the punch at the end [N]
  macroscale::HistoryRow last;
  double turn = 0.0;  ///< of the blank about the punch's axis, mean of its nodes [rad]
};

/// Tows that stiffen as they are stretched: else crimp is nothing that could be pulled out later.
Surface tension_with_a_toe() {
  constexpr int n = 41;
  std::vector<double> w;
  const auto own = [](double e) { return 2e5 * e * e + 2e10 * e * e * e * e; };
  for (int i = 0; i < n; ++i)
    for (int j = 0; j < n; ++j) w.push_back(own(0.001 * (i - 20)) + own(0.001 * (j - 20)));
  return {-0.02, 0.001, n, -0.02, 0.001, n, w};
}

/// The keys `effects: {id: ...}` of a file, through the solver, to the bytes of history.csv.
Run run(const std::string& effects, const std::vector<std::string>& assignments = {}, bool crimped = false) {
  const pipeline::Case a_case =
      pipeline::read_case_text(stamping + effects, "small.yaml", std::filesystem::path(), assignments);
  // Half the face touches, and more under load: effects on the area need an area to act on.
  mesoscale::FabricProperties fabric = test::make_fabric({.rate_consistency = 5.0});
  if (crimped) fabric.tension_energy = tension_with_a_toe();
  fabric.contact.log_fraction = CurveFamily({0.0}, {Curve({0.0, 20.0}, {-2.0, -0.2})});
  const auto result = macroscale::run_stamping(*a_case.stamping, fabric, a_case.friction->model);
  REQUIRE(result.summary.completed);
  double turned = 0.0, size = 0.0;
  for (std::size_t k = 0; k < result.final_state.position.size(); ++k) {
    const auto& now = result.final_state.position[k];
    const double x = 32e-3 * (result.final_state.grid[k][0] - 5.0),
                 y = 32e-3 * (result.final_state.grid[k][1] - 5.0);
    turned += x * now[1] - y * now[0];
    size += x * x + y * y;
  }
  return {pipeline::history_csv(result.history), result.history.back().punch_force, result.history.back(),
          turned / size};
}

/// The amplitude, which is the first number of each effect. Hersey numbers here lie far beyond the boundary
/// branch at its default, where a tiny part of nothing is lost in rounding: its branch is drawn out.
template <class Effect>
std::string effect_keys(double amplitude) {
  const auto& field = friction::About<Effect>::fields[0];
  const std::string more = std::is_same_v<Effect, friction::BoundaryLubrication> ? ", transition: 0.3" : "";
  return std::string("effects: {") + friction::About<Effect>::id + ": {" + field.name + ": " +
         pipeline::shortest(amplitude) + " " + field.unit + more + "}}\n";
}

}  // namespace

TEST_CASE("every friction effect is off at its off value to the byte, and linear when tiny",
          "[pipeline][effect][long]") {
  const Run without = run("");
  const auto usual = test::every_effect();
  std::size_t at = 0;
  const friction::Effects every;
  friction::for_each_effect(every, [&]<class Effect>(const std::optional<Effect>&) {
    const auto& named = usual.at(at++);
    REQUIRE(named.id == friction::About<Effect>::id);
    CAPTURE(named.id);
    CHECK((run(std::string("effects: {") + friction::About<Effect>::id + ": off}\n").history ==
           without.history));
    CHECK((run(effect_keys<Effect>(0.0)).history == without.history));
    // 1e-6, in units of what an engineer would care about where that is a stress in Pa.
    const double tiny = 1e-6 * std::max(1.0, std::abs(named.usual));
    const Run one = run(effect_keys<Effect>(tiny)), two = run(effect_keys<Effect>(2.0 * tiny));
    const double once = one.force - without.force, twice = two.force - without.force;
    CAPTURE(once, twice);
    CHECK((one.history != without.history));
    CHECK(once != 0.0);
    CHECK(twice == Approx(2.0 * once).epsilon(0.01));
  });
  CHECK(at == usual.size());
}

TEST_CASE("friction along the trellis is off at its off value to the byte, and linear when tiny",
          "[pipeline][effect]") {
  const auto with = [](const std::string& amplitude) {
    return run("effects: {orientation: {amplitude: " + amplitude + ", form: trellis}}\n");
  };
  const Run without = run("");
  CHECK((with("0").history == without.history));
  const double once = with("1e-3").force - without.force, twice = with("2e-3").force - without.force;
  CAPTURE(once, twice);
  CHECK(once != 0.0);
  CHECK(twice == Approx(2.0 * once).epsilon(0.01));
}

TEST_CASE(
    "the factor on the rate of shear is 1 and 0 to the byte at the ends of its switch and linear when tiny",
    "[pipeline][effect]") {
  const auto with_factor = [](double factor) {
    return run("effects: {shear_rate: {factor: " + pipeline::shortest(factor) + "}}\n");
  };
  const std::vector<std::string> switched_off{"fabric.shear_rate=off"};
  const Run off = run("", switched_off);
  CHECK((with_factor(1.0).history == run("").history));
  CHECK((with_factor(0.0).history == off.history));
  CHECK((run("effects: {shear_rate: {factor: 2}}\n", switched_off).history == off.history));
  const double once = with_factor(1e-5).force - off.force, twice = with_factor(2e-5).force - off.force;
  CAPTURE(once, twice);
  CHECK(once != 0.0);
  CHECK(twice == Approx(2.0 * once).epsilon(0.01));
}

TEST_CASE("every effect of forming is off at its off value to the byte, and linear when tiny",
          "[pipeline][effect][long]") {
  struct Effect {
    const char* id;
    const char* amplitude;
    const char* unit;
    const char* more;  ///< other keys of the effect
    double off, tiny;
  };
  // 1e-6, or that share of what an engineer would care about; the viscosity acts by rates of 1e-3 1/s. Shear
  // reaches 12 degrees in this short stroke, and the reference of softening that is usual is the temperature
  // of this blank: it would do nothing.
  const std::vector<Effect> effects{
      {"shear_locking", "amplitude", "N/m", ", angle: 2 deg", 0.0, 1e-5},
      {"tension_shear_coupling", "amplitude", "", "", 0.0, 1e-6},
      {"bending", "factor", "", "", 1.0, 1e-5},
      {"tow_rate_stiffening", "viscosity", "N s/m", "", 0.0, 1.0},
      {"crimp_straightening", "stretch", "", "", 0.0, 1e-6},
      {"shear_thermal_softening", "rate", "1/K", ", reference: 120 degC", 0.0, 1e-6},
      {"blank_cooling", "rate", "1/s", "", 0.0, 1e-6},
      {"inertia", "factor", "", "", 1.0, 1e-4},
      {"binder_force_level", "error", "", "", 0.0, 1e-6},
      {"initial_orientation", "angle", "rad", "", 0.0, 1e-6}};
  const auto stamp = [](const std::string& keys) { return run(keys, {}, true); };
  const Run without = stamp("");
  for (const Effect& effect : effects) {
    CAPTURE(effect.id);
    const auto with = [&](double amplitude) {
      return stamp(std::string("effects: {") + effect.id + ": {" + effect.amplitude + ": " +
                   pipeline::shortest(amplitude) + " " + effect.unit + effect.more + "}}\n");
    };
    CHECK((stamp(std::string("effects: {") + effect.id + ": off}\n").history == without.history));
    const Run off = with(effect.off), one = with(effect.off + effect.tiny),
              two = with(effect.off + 2.0 * effect.tiny);
    CHECK((off.history == without.history));
    CHECK(off.turn == without.turn);
    // Round tools do not see how the blank lies; where its nodes are does.
    const bool turns = std::string(effect.id) == "initial_orientation";
    const auto read = [&](const Run& of) { return turns ? of.turn : of.force; };
    const double once = read(one) - read(without), twice = read(two) - read(without);
    CAPTURE(once, twice);
    CHECK((one.history != without.history));
    CHECK(once != 0.0);
    CHECK(twice == Approx(2.0 * once).epsilon(0.01));
  }
}

TEST_CASE("friction between tows is off at a share of 0 to the byte, and linear when tiny",
          "[pipeline][effect]") {
  const auto lost = [](const Run& one) { return one.last.dissipation_shear_hysteresis; };
  const auto with_share = [](double share) {
    return run("fabric: {shear_hysteresis: {share: " + pipeline::shortest(share) + "}}\n");
  };
  CHECK((with_share(0.0).history == run("").history));
  const double once = lost(with_share(1e-6)), twice = lost(with_share(2e-6));
  CHECK(once > 0.0);
  CHECK(twice == Approx(2.0 * once).epsilon(0.01));
}

TEST_CASE("effects that draw on the film's conduction are off to the byte and linear when tiny as well",
          "[pipeline][effect][long]") {
  const std::vector<std::string> conduction{"friction.film_temperature=conduction"};
  const Run without = run("");
  CHECK((run("", conduction).history == without.history));
  const auto check_effect = [&]<class Effect>(const Effect&) {
    CAPTURE(friction::About<Effect>::id);
    CHECK((run(effect_keys<Effect>(0.0), conduction).history == without.history));
    const Run one = run(effect_keys<Effect>(1e-6), conduction),
              two = run(effect_keys<Effect>(2e-6), conduction);
    const double once = one.force - without.force, twice = two.force - without.force;
    CAPTURE(once, twice);
    CHECK(once != 0.0);
    CHECK(twice == Approx(2.0 * once).epsilon(0.01));
    CHECK((one.history != run(effect_keys<Effect>(1e-6)).history));  // and it is not the closed form
  };
  check_effect(friction::ToolTemperatureFilm{});
  check_effect(friction::Solidification{});
  check_effect(friction::ShearHeating{});
}
