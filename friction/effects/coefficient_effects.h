#pragma once

#include <array>

#include "friction/sensitivity.h"
#include "friction/term.h"

namespace heddle::friction {

/// Effect F3: mu *= 1 + A exp(-s/s0) with the slip s at the start of the step (slip per step below s0/5).
struct StaticPeak {
  double amplitude = 0.0;  ///< A [-]; 0 = off
  double length = 2e-3;    ///< s0 [m], > 0
};

/// Effect F4: mu *= 1 + A (1 - exp(-s/L)), hardening (A > 0) or softening with the slip s.
struct SlidingEvolution {
  double amplitude = 0.0;  ///< A [-], > -1; 0 = off
  double length = 10e-3;   ///< L [m], > 0
};

/// Effect F5: mu *= 1 + A exp(-U/Uw), falling with speed for A > 0. This slope is what belongs to the law.
/// The sawtooth itself needs the rig: without its stiffness a point slides steadily at any slope
/// (friction/pull.h).
struct StickSlip {
  double amplitude = 0.0;  ///< A [-]; 0 = off
  double speed = 5e-3;     ///< Uw [m/s], > 0
};

/// Effect F7: friction that depends on the slip direction theta against the warp.
///     tows:     mu *= 1 + A sin^2(2 theta)
///     trellis:  mu *= 1 + A sin^2(gamma) cos 2(theta - theta_d),  theta_d = +-(90 deg - |gamma|)/2
///     film:     mu *= 1 + A (K_c cos 2 theta + K_s sin 2 theta),  K(p, gamma) of the unit cell's film
/// theta_d is the long diagonal of the trellis, on the side of gamma's sign: none without shear, the same
/// after warp and weft are exchanged, and mirrored with the fabric.
struct Orientation {
  enum class Form { tows, trellis, film };
  double amplitude = 0.0;  ///< A [-], > -1, and < 1 in the form trellis, <= 1 in the form film; 0 = off
  Form form = Form::tows;
};

/// Effect F8: tau += c phi, so mu += c phi/p_f.
struct Adhesion {
  double stress = 0.0;  ///< c [Pa]; 0 = off
};

/// Effect F10: mu *= 1 + A ln(1 + age/t0); the age grows with time and is wiped out by slip,
/// d age/dt = 1 - U age/D.
struct DwellAgeing {
  double amplitude = 0.0;    ///< A [-], >= 0; 0 = off
  double time = 1.0;         ///< t0 [s], > 0
  double reset_slip = 1e-3;  ///< D [m], > 0
};

/// Effect F11: mu *= 1 + A (1 - exp(-t/tau)) / (1 + exp((T_i - T_c)/w)), at the interface temperature
/// T_i = b T_tool + (1 - b) T_fabric of two half-spaces. With a film conduction T_i is the temperature of the
/// film's face towards the tool, and where heat is followed through the blank that of its face (Context);
/// then b is not used.
struct Solidification {
  double amplitude = 0.0;      ///< A [-], > -1; 0 = off
  double onset = 390.15;       ///< T_c [K], > 0
  double width = 4.0;          ///< w [K], > 0
  double time = 0.05;          ///< tau [s], > 0
  double tool_weight = 0.945;  ///< b [-], 0..1
};

/// Effect F13: mu *= 1 - A (1 - exp(-q/q0)), q = Int p ds of this contact.
struct Wear {
  double amplitude = 0.0;    ///< A [-], < 1; 0 = off
  double load_slip = 7.5e3;  ///< q0 [Pa m], > 0
};

/// Effect F15: mu += c0 exp(-Hs/Hc), the boundary branch where the film is thin.
struct BoundaryLubrication {
  double amplitude = 0.0;    ///< c0 [-]; 0 = off
  double transition = 0.05;  ///< Hc [-], > 0
};

Sensitive factor_of(const StaticPeak& effect, const Inputs& inputs);
Sensitive factor_of(const SlidingEvolution& effect, const Inputs& inputs);
Sensitive factor_of(const StickSlip& effect, const Inputs& inputs);
Sensitive factor_of(const Orientation& effect, const Inputs& inputs);
Sensitive factor_of(const DwellAgeing& effect, const Inputs& inputs);
Sensitive factor_of(const Solidification& effect, const Inputs& inputs);
Sensitive factor_of(const Wear& effect, const Inputs& inputs);
Sensitive term_of(const Adhesion& effect, const Inputs& inputs, const Sensitive& area);
Sensitive term_of(const BoundaryLubrication& effect, const Sensitive& hersey);

/// The age after the step, exactly integrated at constant speed [s].
double age_after(const DwellAgeing& effect, const Context& context, double age);

template <>
struct About<StaticPeak> {
  static constexpr const char* id = "static_peak";
  static constexpr const char* equation = "mu *= 1 + A exp(-s/s0)";
  static constexpr const char* source = "peak over steady 1.1 to 2.0, decay 1 to 10 mm (recalled)";
  static constexpr std::array fields{
      Field<StaticPeak>{"amplitude",
                        "",
                        &StaticPeak::amplitude,
                        {-1.0, 10.0, true, false},
                        "Peak over steady, less 1; 0 is off."},
      Field<StaticPeak>{"length", "m", &StaticPeak::length, positive_range, "Slip over which it decays."}};
};
template <>
struct About<SlidingEvolution> {
  static constexpr const char* id = "sliding_evolution";
  static constexpr const char* equation = "mu *= 1 + A (1 - exp(-s/L))";
  static constexpr const char* source =
      "after Gearing, Moon & Anand 2001; A +-0.1 to 0.3, L 1 to 10 mm (prior)";
  static constexpr std::array fields{
      Field<SlidingEvolution>{"amplitude",
                              "",
                              &SlidingEvolution::amplitude,
                              {-1.0, 10.0, true, false},
                              "Share by which mu changes with slip; 0 is off."},
      Field<SlidingEvolution>{"length", "m", &SlidingEvolution::length, positive_range,
                              "Slip over which it saturates."}};
};
template <>
struct About<StickSlip> {
  static constexpr const char* id = "stick_slip";
  static constexpr const char* equation = "mu *= 1 + A exp(-U/Uw)";
  static constexpr const char* source = "velocity weakening; A and Uw are priors";
  static constexpr std::array fields{
      Field<StickSlip>{"amplitude",
                       "",
                       &StickSlip::amplitude,
                       {-1.0, 10.0, true, false},
                       "Excess of mu at rest; 0 is off."},
      Field<StickSlip>{"speed", "m/s", &StickSlip::speed, positive_range, "Speed over which it is lost."}};
};
template <>
struct About<Orientation> {
  static constexpr const char* id = "orientation";
  static constexpr const char* equation =
      "mu *= 1 + A sin^2(2 theta) | mu *= 1 + A sin^2(gamma) cos 2(theta - theta_d) | mu *= 1 + A (K_c(p, "
      "gamma) cos 2 theta + K_s(p, gamma) sin 2 theta)";
  static constexpr const char* source =
      "the paper saw relatively none; test range 0 to 0.15; trellis, film: the film of the geometry "
      "(derived)";
  static constexpr std::array fields{
      Field<Orientation>{"amplitude",
                         "",
                         &Orientation::amplitude,
                         {-1.0, 10.0, true, false},
                         "Excess at 45 deg to the tows, or (trellis) along the long diagonal of a closed "
                         "trellis, or (film) share of what the film gives; 0 is off."}};
};
template <>
struct About<Adhesion> {
  static constexpr const char* id = "adhesion";
  static constexpr const char* equation = "mu += c phi/p_f, from tau += c phi";
  static constexpr const char* source = "cohesion of the contact; c a prior";
  static constexpr std::array fields{Field<Adhesion>{"stress",
                                                     "Pa",
                                                     &Adhesion::stress,
                                                     {-1e6, 1e6, false, false},
                                                     "Shear stress without load; 0 Pa is off."}};
};
template <>
struct About<DwellAgeing> {
  static constexpr const char* id = "dwell_ageing";
  static constexpr const char* equation = "mu *= 1 + A ln(1 + age/t0), d age/dt = 1 - U age/D";
  static constexpr const char* source = "Dieterich's ageing law; 5 to 25 % (prior)";
  static constexpr std::array fields{
      Field<DwellAgeing>{"amplitude",
                         "",
                         &DwellAgeing::amplitude,
                         {-1.0, 10.0, true, false},
                         "Growth of mu per e-fold of age; 0 is off."},
      Field<DwellAgeing>{"time", "s", &DwellAgeing::time, positive_range, "Age from which it counts."},
      Field<DwellAgeing>{"reset_slip", "m", &DwellAgeing::reset_slip, positive_range,
                         "Slip that wipes the age out."}};
};
template <>
struct About<Solidification> {
  static constexpr const char* id = "solidification";
  static constexpr const char* equation =
      "mu *= 1 + A (1 - exp(-t/tau)) / (1 + exp((T_i - T_c)/w)), T_i = b T_tool + (1 - b) T_fabric";
  static constexpr const char* source =
      "crystallisation of polypropylene at 110 to 125 degC (recalled); factor 1.2 to 3 (prior); b from "
      "effusivities of steel and melt (derived)";
  static constexpr std::array fields{
      Field<Solidification>{"amplitude",
                            "",
                            &Solidification::amplitude,
                            {-1.0, 10.0, true, false},
                            "Excess of mu once solid; 0 is off."},
      Field<Solidification>{"onset", "degC", &Solidification::onset, positive_range,
                            "Interface temperature of the step."},
      Field<Solidification>{"width", "K", &Solidification::width, positive_range, "Width of the step."},
      Field<Solidification>{"time", "s", &Solidification::time, positive_range, "Time to solidify."},
      Field<Solidification>{"tool_weight",
                            "",
                            &Solidification::tool_weight,
                            {0.0, 1.0, false, false},
                            "Share of the tool in the interface temperature."}};
};
template <>
struct About<Wear> {
  static constexpr const char* id = "wear";
  static constexpr const char* equation = "mu *= 1 - A (1 - exp(-q/q0)), q = Int p ds";
  static constexpr const char* source = "+-10 to 30 % over 5 to 10 passes (recalled)";
  static constexpr std::array fields{Field<Wear>{"amplitude",
                                                 "",
                                                 &Wear::amplitude,
                                                 {-10.0, 1.0, false, true},
                                                 "Share of mu lost in the end; 0 is off."},
                                     Field<Wear>{"load_slip", "Pa m", &Wear::load_slip, positive_range,
                                                 "Pressure times slip over which it is lost."}};
};
template <>
struct About<BoundaryLubrication> {
  static constexpr const char* id = "boundary_lubrication";
  static constexpr const char* equation = "mu += c0 exp(-Hs/Hc)";
  static constexpr const char* source = "boundary branch of the Stribeck curve; c0 and Hc are priors";
  static constexpr std::array fields{
      Field<BoundaryLubrication>{"amplitude",
                                 "",
                                 &BoundaryLubrication::amplitude,
                                 {-1.0, 10.0, true, false},
                                 "c0 where the film is gone; 0 is off."},
      Field<BoundaryLubrication>{"transition", "", &BoundaryLubrication::transition, positive_range,
                                 "Hersey number over which it is lost."}};
};

}  // namespace heddle::friction
