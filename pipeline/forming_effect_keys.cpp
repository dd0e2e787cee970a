#include "pipeline/forming_effect_keys.h"

namespace heddle::pipeline {
namespace {

void take(const Settings& settings, const std::string& path, double& value) {
  if (settings.has(path)) value = settings.number(path);
}

Key amplitude(const std::string& effect, const char* name, const char* unit, const char* range,
              const char* help) {
  return {.path = "effects." + effect + "." + name,
          .type = KeyType::quantity,
          .unit = unit,
          .presence = Presence::required,
          .range = range,
          .stage = Stage::stamping,
          .used_when = "effects." + effect,
          .help = help};
}

Key number(const std::string& effect, const char* name, const char* unit, const char* usual,
           const char* range, const char* help) {
  Key key = amplitude(effect, name, unit, range, help);
  key.presence = Presence::defaulted;
  key.default_text = usual;
  return key;
}

}  // namespace

// A table reads better in rows than one field a line.
// clang-format off
std::vector<Key> forming_effect_keys() {
  Key force = amplitude("binder_force_level", "error", "", "[-0.9, 10]",
                        "Of the force on the binder, over process.binder_force; 0 is off.");
  force.used_when += " tools.binder.control=force";
  return {
      amplitude("shear_locking", "amplitude", "N/m", "[0 N/m, 1e9 N/m]",
                "Shear resistance dPsi/dgamma added 10 degrees beyond the locking angle; 0 N/m is off."),
      number("shear_locking", "angle", "deg", "40 deg", "[0 deg, 89 deg]",
             "Trellis angle at which tows lie side by side; prior (`heddle weave` prints where the gaps close)."),
      number("shear_locking", "exponent", "", "2", "[2, 10]", "Power with which it rises beyond; prior."),
      amplitude("tension_shear_coupling", "amplitude", "", "[0, 1000]",
                "Rise of the shear resistance where both tows carry the reference tension; 0 is off."),
      number("tension_shear_coupling", "reference", "N/m", "1000 N/m", "(0 N/m, 1e9 N/m]",
             "Tension per width of fabric at which the amplitude holds; prior."),
      amplitude("bending", "factor", "", "(0, 1000]", "On the bending stiffness of both tows; 1 is off."),
      amplitude("tow_rate_stiffening", "viscosity", "N s/m", "[0 N s/m, 1e9 N s/m]",
                "Tension that a tow adds per width of fabric and rate of its stretch; 0 N s/m is off."),
      amplitude("crimp_straightening", "stretch", "", "[-0.9, 10]",
                "Of the strain at which crimp is pulled out: 0.1 makes the toe of both tension curves a tenth longer; 0 is off."),
      amplitude("shear_thermal_softening", "rate", "1/K", "[-0.1 1/K, 0.1 1/K]",
                "b of exp(-b (T - reference)), a factor on the rate-free shear resistance; 0 1/K is off."),
      number("shear_thermal_softening", "reference", "degC", "180 degC", "[-100 degC, 500 degC]",
             "Temperature at which that resistance is what the weave says."),
      amplitude("blank_cooling", "rate", "1/s", "[0 1/s, 1000 1/s]",
                "At which the blank's temperature goes to the tools' from process.blank_temperature on, in a run without `thermal`; 0 1/s is off."),
      amplitude("inertia", "factor", "", "[1e-6, 1e9]",
                "On the areal density of the blank: mass and weight; 1 is off (artefact.mass_scaling is no mass that a blank could have)."),
      std::move(force),
      amplitude("initial_orientation", "angle", "deg", "[-180 deg, 180 deg]",
                "By which the whole blank, outline and tows, is laid down turned; 0 deg is off."),
  };
}
// clang-format on

void take_forming_effects(const Settings& settings, macroscale::StampingSpec& stamping) {
  macroscale::FabricEffects& effects = stamping.effects;
  take(settings, "effects.shear_locking.amplitude", effects.shear_locking.amplitude);
  take(settings, "effects.shear_locking.angle", effects.shear_locking.angle);
  take(settings, "effects.shear_locking.exponent", effects.shear_locking.exponent);
  take(settings, "effects.tension_shear_coupling.amplitude", effects.tension_coupling.amplitude);
  take(settings, "effects.tension_shear_coupling.reference", effects.tension_coupling.reference);
  take(settings, "effects.bending.factor", effects.bending);
  take(settings, "effects.tow_rate_stiffening.viscosity", effects.tow_viscosity);
  take(settings, "effects.crimp_straightening.stretch", effects.crimp_stretch);
  take(settings, "effects.shear_thermal_softening.rate", effects.softening.rate);
  take(settings, "effects.shear_thermal_softening.reference", effects.softening.reference);
  take(settings, "effects.inertia.factor", effects.inertia);
  take(settings, "effects.blank_cooling.rate", stamping.process.cooling_rate);
  take(settings, "effects.binder_force_level.error", stamping.process.press.binder_force_error);
  take(settings, "effects.initial_orientation.angle", stamping.blank.turned);
}

}  // namespace heddle::pipeline
