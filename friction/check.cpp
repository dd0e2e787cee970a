#include <fmt/format.h>

#include <cmath>
#include <limits>
#include <string>

#include "core/units.h"
#include "friction/combinations.h"
#include "friction/model.h"

namespace heddle::friction {

namespace {

/// Adds the problem unless the rule holds. Written so that NaN, which satisfies no comparison, breaks every
/// rule.
void require(Problems& problems, bool holds, Problem problem) {
  if (!holds) problems.push_back(std::move(problem));
}

bool positive(double x) {
  return x > 0.0 && std::isfinite(x);
}

void check_film(const PowerLawFilm& film, Problems& problems) {
  require(problems, positive(film.consistency),
          {.id = "resin.consistency.range"_rule,
           .key = "resin.consistency",
           .value = fmt::format("{} Pa s^n", film.consistency),
           .rule = "must satisfy 0 < m",
           .way_out = "Polypropylene at 180 degC: 6790 Pa s^n."});
  require(problems, film.index > 0.0 && film.index <= 1.0,
          {.id = "resin.power_index.range"_rule,
           .key = "resin.power_index",
           .value = fmt::format("{}", film.index),
           .rule = "must satisfy 0 < n <= 1",
           .way_out = "The resin thins with rate (Gorczyca et al., Eq. 4); polypropylene: 0.37 to 0.41."});
  require(problems, film.thickness > 0.0 && film.thickness < 0.01,
          {.id = "resin.film_thickness.range"_rule,
           .key = "resin.film_thickness",
           .value = fmt::format("{} m", film.thickness),
           .rule = "must satisfy 0 < h < 0.01 m",
           .way_out = "The paper uses 0.07 mm; write 0.07 mm."});
  require(problems, film.activation_energy >= 0.0 && film.activation_energy <= 1e6,
          {.id = "resin.activation_energy.range"_rule,
           .key = "resin.activation_energy",
           .value = fmt::format("{} J/mol", film.activation_energy),
           .rule = "must satisfy 0 <= E <= 1000 kJ/mol",
           .way_out = "Polypropylene melts: 38 to 46 kJ/mol; 0 makes the film insensitive to temperature."});
  require(
      problems, positive(film.reference_temperature),
      {.id = "resin.reference_temperature.range"_rule,
       .key = "resin.reference_temperature",
       .value = fmt::format("{} K", film.reference_temperature),
       .rule = "must lie above absolute zero",
       .way_out = "It is the temperature at which resin.consistency was measured, for instance 180 degC."});
  require(problems, positive(film.rate_floor),
          {.id = "resin.rate_floor.range"_rule,
           .key = "resin.rate_floor",
           .value = fmt::format("{} 1/s", film.rate_floor),
           .rule = "must satisfy 0 < g0",
           .way_out = "Without a floor the viscosity is infinite at rest; 1 1/s lies below every test."});
}

void check_law(const Coulomb& law, const CalibrationBox&, Problems& problems) {
  require(problems, law.coefficient >= 0.0 && law.coefficient < 10.0,
          {.id = "friction.coefficient.range"_rule,
           .key = "friction.coefficient",
           .value = fmt::format("{}", law.coefficient),
           .rule = "must satisfy 0 <= mu < 10",
           .way_out = "The paper compares with 0.3."});
}

void check_law(const HerseyPower& law, const CalibrationBox&, Problems& problems) {
  require(problems, positive(law.scale),
          {.id = "friction.scale.range"_rule,
           .key = "friction.scale",
           .value = fmt::format("{}", law.scale),
           .rule = "must satisfy 0 < C",
           .way_out = "Let `heddle calibrate` find it from friction tests."});
  require(problems, std::abs(law.exponent) < 1.0,
          {.id = "friction.exponent.range"_rule,
           .key = "friction.exponent",
           .value = fmt::format("{}", law.exponent),
           .rule = "must satisfy -1 < s < 1",
           .way_out =
               "From s = 1 on the friction force no longer rises with the load; Table 4 gives about 0.14."});
}

void check_law(const HerseyLinear& law, const CalibrationBox& box, Problems& problems) {
  require(problems, positive(law.reference),
          {.id = "friction.reference_hersey.range"_rule,
           .key = "friction.reference_hersey",
           .value = fmt::format("{}", law.reference),
           .rule = "must satisfy 0 < Hs0",
           .way_out = "It is the Hersey number of the baseline test."});
  // mu is a power of Hs beyond the box, so it is positive everywhere if it is positive within; a straight
  // line is positive within if it is at both ends. A box without an upper end asks for b >= 0.
  const double low = law.offset + law.slope * box.hersey_low / law.reference;
  const double high = law.offset + law.slope * box.hersey_high / law.reference;
  require(problems, low > 0.0 && high > 0.0,
          {.id = "friction.offset.positive"_rule,
           .key = "friction.offset",
           .value = fmt::format("{} (slope {})", law.offset, law.slope),
           .rule = box.hersey_high < std::numeric_limits<double>::max() / 1e10
                       ? fmt::format("must give mu > 0 from Hs = {} to {}", box.hersey_low, box.hersey_high)
                       : fmt::format("must give mu > 0 from Hs = {} on", box.hersey_low),
           .way_out = "Raise the offset, or calibrate the power form, which cannot turn negative.",
           .others = {"friction.slope", "friction.reference_hersey"}});
}

std::string describe(const Bounds& range, const char* unit) {
  const auto end = [&](double value) { return std::isinf(value) ? "" : write_quantity(value, unit); };
  return fmt::format("{}{}, {}{}", range.low_open ? '(' : '[', end(range.low), end(range.high),
                     range.high_open ? ')' : ']');
}

/// Every number of a term against its range. `path` is the key above the numbers.
template <class Term>
void check_fields(const Term& term, const std::string& path, Problems& problems) {
  for (const Field<Term>& field : About<Term>::fields) {
    const double value = term.*(field.member);
    const std::string key = fmt::format("{}.{}", path, field.name);
    require(problems, field.range.contains(value) && std::isfinite(value),
            {.id = "*.range"_family.of(key),
             .key = key,
             .value = std::isfinite(value) ? write_quantity(value, field.unit) : fmt::format("{}", value),
             .rule = fmt::format("must lie in {}", describe(field.range, field.unit)),
             .way_out = field.help});
  }
}

template <class AnyLaw>
void check_law(const AnyLaw& law, const CalibrationBox&, Problems& problems) {
  check_fields(law, fmt::format("friction.{}", About<AnyLaw>::id), problems);
}

void check_law(const Renard& law, const CalibrationBox&, Problems& problems) {
  check_fields(law, "friction.renard", problems);
  require(problems, law.first_speed < law.second_speed,
          {.id = "friction.renard.order"_rule,
           .key = "friction.renard.second_speed",
           .value = fmt::format("{} m/s", law.second_speed),
           .rule = fmt::format("must lie above the first speed, {} m/s", law.first_speed),
           .way_out = "mu rises up to the first speed and falls up to the second."});
}

void check_law(const HerseyTable& law, const CalibrationBox&, Problems& problems) {
  require(problems, !law.curve.empty(),
          {.id = "friction.hersey_table.empty"_rule,
           .key = "friction.table",
           .value = "",
           .rule = "must hold pairs of Hersey number and coefficient",
           .way_out = "Read it with columns hersey_number and friction_coefficient."});
}

void check_rheology(const Rheology& rheology, Problems& problems) {
  std::visit(
      [&]<class F>(const F& flow) {
        check_fields(flow, fmt::format("resin.{}", About<F>::id), problems);
        if constexpr (std::is_same_v<F, CarreauYasuda>)
          require(problems, flow.infinite_viscosity < flow.zero_viscosity,
                  {.id = "resin.carreau_yasuda.order"_rule,
                   .key = "resin.carreau_yasuda.infinite_viscosity",
                   .value = fmt::format("{} Pa s", flow.infinite_viscosity),
                   .rule = fmt::format("must lie below the zero viscosity, {} Pa s", flow.zero_viscosity),
                   .way_out = "A melt thins with rate; 0 Pa s is usual."});
      },
      rheology.flow);
  std::visit(
      [&]<class T>(const T& law) { check_fields(law, fmt::format("resin.{}", About<T>::id), problems); },
      rheology.temperature);
}

void check_box(const CalibrationBox& box, Problems& problems) {
  const auto ordered = [](double low, double high) { return 0.0 <= low && low <= high; };
  require(problems,
          ordered(box.hersey_low, box.hersey_high) && ordered(box.pressure_low, box.pressure_high) &&
              ordered(box.speed_low, box.speed_high),
          {.id = "friction.calibration.box_order"_rule,
           .key = "friction.box",
           .value = fmt::format("Hs {}..{}, p {}..{} Pa, U {}..{} m/s", box.hersey_low, box.hersey_high,
                                box.pressure_low, box.pressure_high, box.speed_low, box.speed_high),
           .rule = "must satisfy 0 <= low <= high for each",
           .way_out = "The box is the range of the friction tests behind the law."});
}

template <class Effect>
void check_effect(const Effect& effect, Problems& problems) {
  check_fields(effect, fmt::format("effects.{}", About<Effect>::id), problems);
}

void check_effect(const Orientation& effect, Problems& problems) {
  check_fields(effect, "effects.orientation", problems);
  require(
      problems, effect.form != Orientation::Form::trellis || effect.amplitude < 1.0,
      {.id = "effects.orientation.trellis"_rule,
       .key = "effects.orientation.amplitude",
       .value = fmt::format("{}", effect.amplitude),
       .rule = "must satisfy A < 1 in the form trellis",
       .way_out = "Friction across the long diagonal would turn negative; the film of Table 1's weave gives "
                  "up to 0.5."});
  require(problems, effect.form != Orientation::Form::film || effect.amplitude <= 1.0,
          {.id = "effects.orientation.film"_rule,
           .key = "effects.orientation.amplitude",
           .value = fmt::format("{}", effect.amplitude),
           .rule = "must satisfy A <= 1 in the form film",
           .way_out = "1 is what the film of the unit cell gives."});
}

void check_effect(const ToolTemperatureShift& effect, Problems& problems) {
  require(problems, std::abs(effect.slope) <= 0.1,
          {.id = "effects.tool_temperature_shift.slope.range"_rule,
           .key = "effects.tool_temperature_shift.slope",
           .value = fmt::format("{} 1/K", effect.slope),
           .rule = "must satisfy |slope| <= 0.1 1/K",
           .way_out = "Table 4 gives -9.3e-4 1/K for the term; 0 switches the effect off."});
  require(problems, positive(effect.reference),
          {.id = "effects.tool_temperature_shift.reference.range"_rule,
           .key = "effects.tool_temperature_shift.reference",
           .value = fmt::format("{} K", effect.reference),
           .rule = "must lie above absolute zero",
           .way_out = "The baseline tool temperature is 85 degC."});
}

}  // namespace

Problems check(const Model& model) {
  Problems problems;
  if (reads_hersey_number(model.law)) {
    check_film(model.film, problems);
    check_rheology(model.rheology, problems);
  }
  std::visit([&](const auto& law) { check_law(law, model.box, problems); }, model.law);
  check_box(model.box, problems);
  if (model.conduction) check_fields(model.conduction->spec, "friction.conduction", problems);
  for_each_effect(model.effects, [&](const auto& effect) {
    if (effect) check_effect(*effect, problems);
  });
  const Problems refused = check_combinations(model);
  problems.insert(problems.end(), refused.begin(), refused.end());
  return problems;
}

}  // namespace heddle::friction
