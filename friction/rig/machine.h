#pragma once

#include <optional>
#include <vector>

#include "friction/friction_test.h"
#include "friction/rig/cam.h"

namespace heddle::friction {

/// What pulls the sample: an Instron crosshead over a cable, with a gear of 10:1 between them for speeds that
/// it cannot give by itself (paper, section 2). Stiffness, mass, damping, acceleration and backlash are
/// PRIORS.
struct Drive {
  double stiffness = 1e6;     ///< k between crosshead and sample holder [N/m], > 0
  double holder_mass = 2.0;   ///< m that hangs on it [kg], > 0
  double damping = 0.2;       ///< of that oscillator, share of the critical one [-], >= 0
  double acceleration = 1.0;  ///< of the drawn end until it has its speed [m/s^2], > 0
  double own_speed = 8.3e-3;  ///< largest speed without the gear [m/s]
  double backlash = 0.5e-3;   ///< of the gear, at the drawn end, taken up before it pulls [m], >= 0
};

/// The sample: two plies, each with one face on a plate, and an interface between them. The second ply may
/// hang in its grip with slack; until the slack is used up only the first ply and the inner interface draw it
/// on.
struct Sample {
  double slack = 0.0;              ///< of the second ply [m], >= 0
  double inner_coefficient = 0.4;  ///< mu between the plies [-], >= 0: fabric on fabric, a prior
};

/// The friction test as a machine. Plate area, pull and dwell stand in FrictionRig.
struct Machine {
  Drive drive;
  Sample sample;
  std::optional<CamGap> cam = {};  ///< absent: the normal force is held
  double sampling_rate = 100.0;    ///< of both load cells [1/s], > 0
};

/// What the load cells say at one moment.
struct RigSample {
  double time = 0.0;              ///< since the plates closed [s]
  double displacement = 0.0;      ///< of the sample holder [m]
  double pull_force = 0.0;        ///< F [N]
  double normal_force = 0.0;      ///< N [N]
  double coefficient = 0.0;       ///< F/(2 N) [-] (paper, Eq. 2)
  double film_temperature = 0.0;  ///< of the first face [K]
};

struct RigRun {
  std::vector<RigSample> samples;
  double peak_force = 0.0;          ///< largest pull force, between samples as well [N]
  double peak_displacement = 0.0;   ///< of the holder there [m]
  double steady_force = 0.0;        ///< mean over the last fifth of the pull [N]
  double steady_coefficient = 0.0;  ///< mean of F/(2 N) over it [-]
  double force_loss = 0.0;          ///< share of the normal force lost between closing and the end [-]
};

/// One pull as a history: plates closed, dwell, drive on, until the holder has moved by rig.pull_length.
/// Backward Euler in steps of a tenth of the oscillator's time or less; memory is frozen over a step, as in
/// the stamping solver.
/// @throws NumericalError  as evaluate
RigRun run_machine(const Model& model, const FrictionTestRow& row, const FrictionRig& rig,
                   const Machine& machine, const AreaFunction& area = {});

template <>
struct About<Drive> {
  static constexpr const char* id = "drive";
  static constexpr const char* equation = "m dv/dt = k (drawn - moved) + c (drawn speed - v) - friction";
  static constexpr const char* source = "paper, section 2: gear of 10:1 above 8.3 mm/s; all else is a prior";
  static constexpr std::array fields{
      Field<Drive>{"stiffness",
                   "N/m",
                   &Drive::stiffness,
                   {1e3, 1e8, false, false},
                   "Between crosshead and sample holder (prior)."},
      Field<Drive>{
          "holder_mass", "kg", &Drive::holder_mass, {0.1, 1e4, false, false}, "That hangs on it (prior)."},
      Field<Drive>{"damping",
                   "",
                   &Drive::damping,
                   {0.0, 100.0, false, false},
                   "Share of the critical damping (prior)."},
      Field<Drive>{"acceleration",
                   "m/s^2",
                   &Drive::acceleration,
                   {1e-3, 1e4, false, false},
                   "Of the drawn end until it has its speed (prior)."},
      Field<Drive>{"own_speed", "m/s", &Drive::own_speed, not_negative,
                   "Largest speed without the gear; 8.3 mm/s in the paper."},
      Field<Drive>{"backlash",
                   "m",
                   &Drive::backlash,
                   {0.0, 0.1, false, false},
                   "Of the gear, taken up before it pulls (prior)."}};
};
template <>
struct About<Sample> {
  static constexpr const char* id = "sample";
  static constexpr const char* equation =
      "friction = mu N + min(mu N, mu_i N) until the slack is used up, then 2 mu N";
  static constexpr const char* source = "paper, section 2: two layers a sample; mu_i is a prior";
  static constexpr std::array fields{
      Field<Sample>{"slack", "m", &Sample::slack, not_negative, "Of the second ply in its grip."},
      Field<Sample>{"inner_coefficient",
                    "",
                    &Sample::inner_coefficient,
                    {0.0, 10.0, false, true},
                    "mu between the two plies (prior)."}};
};

}  // namespace heddle::friction
