#include "friction/export/fric_coef.h"

#include <fmt/format.h>

#include <cmath>
#include <limits>
#include <tuple>
#include <type_traits>

#include "friction/export/fortran_text.h"
#include "friction/hersey.h"

namespace heddle::friction {

namespace {

/// Statements of the routine and the constants they name, as they come up.
struct Code {
  std::string constants, tables, statements;
  bool curves = false;

  void say(const std::string& comment) { statements += "c     " + comment + "\n"; }
  void run(const std::string& statement) { statements += "      " + statement + "\n"; }
  /// Declares NAME = value and returns its name.
  std::string constant(const std::string& name, double value) {
    constants +=
        fmt::format("      double precision, parameter :: {} =\n     & {}\n", name, fortran_number(value));
    return name;
  }
  /// Points of a curve with its slopes there.
  void table(const std::string& name, const Curve& curve) {
    curves = true;
    const std::size_t count = curve.x().size();
    tables += fmt::format("      integer, parameter :: n_{0} = {1}\n", name, count);
    for (const char* part : {"x", "y", "s"})
      tables += fmt::format("      double precision, save :: {}_{}(n_{})\n", part, name, name);
    for (std::size_t i = 0; i < count; ++i) {
      const double x = curve.x()[i];
      for (const auto& [part, value] :
           {std::pair{"x", x}, std::pair{"y", curve.y()[i]}, std::pair{"s", curve.evaluate(x).slope}}) {
        const std::string number = fortran_number(value);
        // A data statement takes a sign, no brackets.
        tables += fmt::format("      data {}_{}({}) /{}/\n", part, name, i + 1,
                              number.front() == '(' ? number.substr(1, number.size() - 2) : number);
      }
    }
  }
};

// ---- film

void write(const PowerLaw&, const PowerLawFilm& film, Code& code) {
  code.constant("c_m", film.consistency);
  code.constant("c_n", film.index);
  code.run("eta = c_m * exp(lna) * gf**(c_n - 1.0D0)");
}

void write_yield(double yield, double sharpness, Code& code) {
  code.constant("c_yield", yield);
  code.constant("c_sharp", sharpness);
  code.run("eta = eta + c_yield * (1.0D0 - exp((-c_sharp) * gf)) / gf");
}

void write(const Bingham& law, const PowerLawFilm&, Code& code) {
  code.constant("c_mup", law.viscosity);
  code.run("eta = c_mup * exp(lna)");
  write_yield(law.yield_stress, law.sharpness, code);
}

void write(const HerschelBulkley& law, const PowerLawFilm&, Code& code) {
  code.constant("c_k", law.consistency);
  code.constant("c_n", law.power_index);
  code.run("eta = c_k * exp(lna) * gf**(c_n - 1.0D0)");
  write_yield(law.yield_stress, law.sharpness, code);
}

void write(const CarreauYasuda& law, const PowerLawFilm&, Code& code) {
  code.constant("c_eta0", law.zero_viscosity);
  code.constant("c_etai", law.infinite_viscosity);
  code.constant("c_lam", law.relaxation_time);
  code.constant("c_b", law.transition);
  code.constant("c_n", law.power_index);
  code.run("eta = (1.0D0 + (c_lam * exp(lna) * gf)**c_b)");
  code.run("eta = eta**((c_n - 1.0D0) / c_b)");
  code.run("eta = exp(lna) * (c_etai + (c_eta0 - c_etai) * eta)");
}

void write(const Cross& law, const PowerLawFilm&, Code& code) {
  code.constant("c_eta0", law.zero_viscosity);
  code.constant("c_lam", law.relaxation_time);
  code.constant("c_n", law.power_index);
  code.run("eta = (c_lam * exp(lna) * gf)**(1.0D0 - c_n)");
  code.run("eta = exp(lna) * c_eta0 / (1.0D0 + eta)");
}

/// ln a, and soft = -d ln a/dT for the self-heating.
void write(const Arrhenius&, const PowerLawFilm& film, Code& code) {
  constexpr double gas_constant = 8.31446261815324;  // [J/(mol K)]
  code.constant("c_er", film.activation_energy / gas_constant);
  code.constant("c_tref", film.reference_temperature);
  code.run("lna = c_er * (1.0D0 / t - 1.0D0 / c_tref)");
  code.run("soft = c_er / (t * t)");
}

void write(const Wlf& law, const PowerLawFilm& film, Code& code) {
  code.constant("c_c1", law.c1);
  code.constant("c_c2", law.c2);
  code.constant("c_tref", film.reference_temperature);
  code.run("lna = (-c_c1) * (t - c_tref) / (c_c2 - c_tref + t)");
  code.run("soft = c_c1 * c_c2 / ((c_c2 - c_tref + t) * (c_c2 - c_tref + t))");
}

void write_area(const ExportedLaw& law, Code& code) {
  code.say("contact: pressure with its floor of 1 Pa, real over nominal area");
  code.run("pf = sqrt(p * p + 1.0D0)");
  if (law.log_area) {
    code.table("area", *law.log_area);
    code.run("phi = exp(curve(n_area, x_area, y_area, s_area, log(pf)))");
    code.run("if (phi%v .ge. 1.0D0) phi = mapped(p, 1.0D0, 0.0D0)");
  } else {
    code.run("phi = mapped(p, 1.0D0, 0.0D0)");
  }
  if (!is_on(law.model.effects.pressure_dependent_area)) return;
  code.constant("c_q", law.model.effects.pressure_dependent_area->exponent);
  code.constant("c_pref", law.model.effects.pressure_dependent_area->reference_pressure);
  code.run("phi = phi * (pf / c_pref)**c_q");
}

void write_self_heating(const ShearHeating& effect, Code& code) {
  code.say("self-heating: eta asinh(sqrt x) / sqrt(x (1 + x))");
  code.constant("c_na", effect.amplitude / (8.0 * effect.conductivity));
  code.run("x = c_na * soft * eta * u * u");
  code.run("if (x%v .lt. 1.0D-4) then");
  code.run("  f = 1.0D0 - x%v * (2.0D0/3.0D0 - x%v * (8.0D0/15.0D0");
  code.statements += "     &      - x%v * 16.0D0/35.0D0))\n";
  code.run("  df = -2.0D0/3.0D0 + x%v * (16.0D0/15.0D0");
  code.statements += "     &      - x%v * 48.0D0/35.0D0)\n";
  code.run("else");
  code.run("  f = asinh(sqrt(x%v)) / sqrt(x%v * (1.0D0 + x%v))");
  code.run("  df = (0.5D0 - (0.5D0 + x%v) * f) / (x%v * (1.0D0 + x%v))");
  code.run("end if");
  code.run("eta = eta * mapped(x, f, df)");
}

void write_hersey_number(const ExportedLaw& law, Code& code) {
  const Model& model = law.model;
  code.say("film: temperature, shear rate, viscosity, Hersey number");
  code.run("t = tf");
  if (is_on(model.effects.tool_temperature_film)) {
    code.constant("c_weight", model.effects.tool_temperature_film->weight);
    code.run("t = tf + c_weight * (tt - tf)");
  }
  code.constant("c_h", model.film.thickness);
  code.constant("c_g0", model.film.rate_floor);
  code.run("gf = u / c_h");
  code.run("gf = sqrt(gf * gf + c_g0 * c_g0)");
  std::visit([&](const auto& temperature) { write(temperature, model.film, code); },
             model.rheology.temperature);
  std::visit([&](const auto& flow) { write(flow, model.film, code); }, model.rheology.flow);
  if (is_on(model.effects.viscosity_plateau)) {
    code.constant("c_fluid", model.effects.viscosity_plateau->fluidity);
    code.run("eta = eta / (1.0D0 + c_fluid * eta / exp(lna))");
  }
  if (is_on(model.effects.shear_heating)) write_self_heating(*model.effects.shear_heating, code);
  code.run("hs = eta * gf * phi / pf");
}

// ---- laws

/// Beyond the box: mu of the edge times (hs/edge)^k, k the log slope there.
void write_held(const LawValue& at, double edge, const char* where, const char* name, Code& code) {
  const double log_slope = at.mu > 0.0 ? at.dmu_dlog_hersey / at.mu : 0.0;
  code.constant(fmt::format("c_{}_edge", name), edge);
  code.constant(fmt::format("c_{}_mu", name), at.mu);
  code.constant(fmt::format("c_{}_k", name), log_slope);
  code.run(fmt::format("if (hs%v .{}. c_{}_edge)", where, name));
  code.statements += fmt::format("     &  m = c_{0}_mu * (hs / c_{0}_edge)**c_{0}_k\n", name);
}

void write_box(const auto& law, const CalibrationBox& box, Code& code) {
  CalibrationBox open = box;
  if (box.hersey_low > 0.0) {
    open.hersey_low = open.hersey_high = box.hersey_low;
    write_held(law_value(law, box.hersey_low, open), box.hersey_low, "lt", "low", code);
  }
  if (box.hersey_high < 1e299) {
    open.hersey_low = open.hersey_high = box.hersey_high;
    write_held(law_value(law, box.hersey_high, open), box.hersey_high, "gt", "high", code);
  }
}

void write_law(const Coulomb& law, const Model&, Code& code) {
  code.constant("c_mu", law.coefficient);
  code.run("m = mapped(p, c_mu, 0.0D0)");
}

void write_law(const HerseyPower& law, const Model&, Code& code) {
  code.constant("c_scale", law.scale);
  code.constant("c_exponent", law.exponent);
  code.run("m = c_scale * hs**c_exponent");
}

void write_law(const HerseyLinear& law, const Model& model, Code& code) {
  code.constant("c_offset", law.offset);
  code.constant("c_slope", law.slope / law.reference);
  code.run("m = c_offset + c_slope * hs");
  write_box(law, model.box, code);
}

void write_law(const StribeckCurve& law, const Model& model, Code& code) {
  code.constant("c_bound", law.boundary);
  code.constant("c_hc", law.transition);
  code.constant("c_sharpness", law.sharpness);
  code.constant("c_offset", law.offset);
  code.constant("c_slope", law.slope / law.reference);
  code.run("m = c_offset + c_slope * hs");
  code.run("share = (hs / c_hc)**c_sharpness");
  code.say("far beyond the transition the share is nothing");
  code.run("if (share%v .lt. 700.0D0)");
  code.statements += "     &  m = m + (c_bound - m) * exp((-1.0D0) * share)\n";
  write_box(law, model.box, code);
}

void write_law(const FilmSolid& law, const Model& model, Code& code) {
  code.constant("c_solid", law.solid);
  code.constant("c_wet", law.wetted_share);
  code.run("m = c_solid + c_wet * hs");
  write_box(law, model.box, code);
}

void write_law(const HerseyTable& law, const Model&, Code& code) {
  code.table("law", law.curve);
  code.run("m = curve(n_law, x_law, y_law, s_law, log(hs))");
  // The table is its own box.
  write_box(law, {.hersey_low = law.hersey.front(), .hersey_high = law.hersey.back()}, code);
}

void write_law(const ExponentialDecay& law, const Model&, Code& code) {
  code.constant("c_kin", law.kinetic_coefficient);
  code.constant("c_peak", law.static_coefficient - law.kinetic_coefficient);
  code.constant("c_uc", law.decay_speed);
  code.run("m = c_kin + c_peak * exp((-1.0D0) * u / c_uc)");
}

void write_law(const Darmstadt& law, const Model&, Code& code) {
  code.constant("c_base", law.base);
  code.constant("c_1", law.square);
  code.constant("c_2", law.square_rate);
  code.constant("c_3", law.linear);
  code.constant("c_4", law.linear_rate);
  code.constant("c_5", law.constant);
  code.constant("c_6", law.constant_rate);
  code.run("m = c_base + c_1 * exp(c_2 * u) * p * p");
  code.run("m = m + c_3 * exp(c_4 * u) * p + c_5 * exp(c_6 * u)");
}

void write_law(const Renard& law, const Model&, Code& code) {
  code.constant("c_mus", law.static_coefficient);
  code.constant("c_mud", law.dynamic_coefficient);
  code.constant("c_max", law.maximum);
  code.constant("c_min", law.minimum);
  code.constant("c_u1", law.first_speed);
  code.constant("c_u2", law.second_speed);
  code.constant("c_ur", law.recovery_speed);
  code.run("if (u%v .le. c_u1) then");
  code.run("  x = u / c_u1");
  code.run("  m = c_mus + (c_max - c_mus) * x * (2.0D0 - x)");
  code.run("else if (u%v .le. c_u2) then");
  code.run("  x = (u - c_u1) / (c_u2 - c_u1)");
  code.run("  m = c_max + (c_min - c_max) * x * x * (3.0D0 - 2.0D0 * x)");
  code.run("else");
  code.run("  x = (u - c_u2) / c_ur");
  code.run("  m = c_mud - (c_mud - c_min)");
  code.statements += "     &      / (1.0D0 + (c_mud - c_min) * x * x)\n";
  code.run("end if");
}

// Refused by check_export.
void write_law(const StaticKinetic&, const Model&, Code&) {}
void write_law(const SlipResistance&, const Model&, Code&) {}

void write_effects(const Effects& effects, Code& code) {
  if (is_on(effects.tool_temperature_shift)) {
    const ToolTemperatureShift& shift = *effects.tool_temperature_shift;
    code.say("tool temperature shift");
    code.constant("c_shift", shift.slope);
    code.constant("c_tshift", shift.reference);
    code.run(shift.form == ToolTemperatureShift::Form::term ? "m = m + c_shift * (tt - c_tshift)"
                                                            : "m = m * (1.0D0 + c_shift * (tt - c_tshift))");
  }
  if (is_on(effects.stick_slip)) {
    code.say("weakening with speed");
    code.constant("c_weak", effects.stick_slip->amplitude);
    code.constant("c_uw", effects.stick_slip->speed);
    code.run("m = m * (1.0D0 + c_weak * exp((-1.0D0) * u / c_uw))");
  }
  if (is_on(effects.adhesion)) {
    code.say("adhesion");
    code.constant("c_adhesion", effects.adhesion->stress);
    code.run("m = m + c_adhesion * phi / pf");
  }
  if (is_on(effects.boundary_lubrication)) {
    code.say("boundary lubrication");
    code.constant("c_bl", effects.boundary_lubrication->amplitude);
    code.constant("c_blhc", effects.boundary_lubrication->transition);
    code.run("m = m + c_bl * exp((-1.0D0) * hs / c_blhc)");
  }
}

std::string head(const ExportedLaw& law) {
  std::string text = fmt::format("c     Friction of the case {}: the {} law, written by heddle.\n", law.name,
                                 id_of(law.model.law));
  const CalibrationBox& box = law.model.box;
  if (box.pressure_high < 1e299)
    text += fmt::format("c     Fitted between {:.4g} and {:.4g} kPa and {:.4g} and {:.4g} mm/s.\n",
                        1e-3 * box.pressure_low, 1e-3 * box.pressure_high, 1e3 * box.speed_low,
                        1e3 * box.speed_high);
  return text + R"(c
c     *FRICTION, USER=COEFFICIENT, PROPERTIES=5
c       1  length unit of the model in m         (mm: 1.D-3)
c       2  pressure unit in Pa                   (MPa: 1.D6)
c       3  zero of its temperature in K          (degC: 273.15)
c       4  temperature of the tool
c       5  temperature of the fabric, for a model without temperature
c     Time is in seconds. In a model with temperature the fabric's is
c     2 x tempAvg - tool, tempAvg being the mean of both surfaces.
c     Slip and pressure alone: no direction, no history.
)" + (law.log_area ? "c     The contact area is that of the unsheared weave.\n" : "") +
         "c\n";
}

constexpr const char* routine = R"(
      subroutine fric_coef (
c     Write only -
     *   fCoef, fCoefDeriv,
c     Read only -
     *   nBlock, nProps, nTemp, nFields,
     *   jFlags, rData,
     *   surfInt, surfSlv, surfMst,
     *   props, slipRate, pressure,
     *   tempAvg, fieldAvg )
      use heddle_law, only : heddle_mu
      include 'aba_param.inc'
      dimension fCoef(nBlock), fCoefDeriv(nBlock,3),
     *   props(nProps), slipRate(nBlock), pressure(nBlock),
     *   tempAvg(nBlock), fieldAvg(nBlock,*)
      dimension jFlags(*), rData(*)
      character*80 surfInt, surfSlv, surfMst
      double precision u, p, tf, tt, mu, dmu(4)
      integer k
      do k = 1, nBlock
        u = slipRate(k) * props(1)
        p = pressure(k) * props(2)
        tt = props(4) + props(3)
        if (nTemp .gt. 0) then
          tf = 2.0D0 * (tempAvg(k) + props(3)) - tt
        else
          tf = props(5) + props(3)
        end if
        call heddle_mu(u, p, tf, tt, mu, dmu)
        fCoef(k) = mu
        fCoefDeriv(k,1) = dmu(1) * props(1)
        fCoefDeriv(k,2) = dmu(2) * props(2)
        fCoefDeriv(k,3) = 0.0D0
        if (nTemp .gt. 0) fCoefDeriv(k,3) = 2.0D0 * dmu(3)
      end do
      return
      end
)";

}  // namespace

Context context_of(const ExportedLaw& law, double speed, double pressure, double fabric_temperature,
                   double tool_temperature) {
  Context context{.slip_speed = speed,
                  .pressure = pressure,
                  .fabric_temperature = fabric_temperature,
                  .tool_temperature = tool_temperature};
  if (!law.log_area) return context;
  const FlooredPressure p = floored(pressure);
  const Curve::Value log = law.log_area->evaluate(std::log(p.value));
  const double fraction = std::exp(log.y);
  if (fraction >= 1.0) return context;  // an area cannot exceed the plate
  context.area_fraction = fraction;
  context.area_slope = fraction * log.slope / p.value * p.slope;
  return context;
}

std::string fric_coef_fortran(const ExportedLaw& law) {
  if (Problems problems = check_export(law.model); !problems.empty()) throw InputError(std::move(problems));
  Code code;
  write_area(law, code);
  if (reads_hersey_number(law.model.law)) write_hersey_number(law, code);
  code.say(fmt::format("law: {}", id_of(law.model.law)));
  std::visit([&](const auto& any) { write_law(any, law.model, code); }, law.model.law);
  write_effects(law.model.effects, code);
  return head(law) + fortran_modules +
         "c     mu and its slopes in SI: m/s, Pa, K, K.\n      module heddle_law\n      use heddle_sens\n" +
         (code.curves ? "      use heddle_curve\n" : "") + "      implicit none\n      private\n" +
         "      public :: heddle_mu\n" + code.constants + code.tables +
         "      contains\n"
         "      subroutine heddle_mu(speed, press, tfab, ttool, mu, dmu)\n"
         "      double precision, intent(in) :: speed, press, tfab, ttool\n"
         "      double precision, intent(out) :: mu, dmu(4)\n"
         "      type(sens) :: u, p, tf, tt, pf, phi, t, gf, lna, soft, eta\n"
         "      type(sens) :: hs, m, x, share\n"
         "      double precision :: f, df\n"
         "      u = var(1, speed)\n      p = var(2, press)\n      tf = var(3, tfab)\n      tt = var(4, "
         "ttool)\n" +
         code.statements +
         "      mu = m%v\n      dmu = m%d\n      end subroutine heddle_mu\n      end module heddle_law\n" +
         routine;
}

}  // namespace heddle::friction
