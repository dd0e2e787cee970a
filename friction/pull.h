#pragma once

#include <optional>
#include <vector>

#include "friction/friction_test.h"

namespace heddle::friction {

/// One moment of a pull.
struct PullPoint {
  double time;   ///< since the pull began [s]
  double slip;   ///< [m]
  double mu;     ///< [-]
  double force;  ///< F = 2 mu N [N]
};

/// The whole pull of one row, from rest under load (rig.dwell_before) to rig.pull_length, in equal steps of
/// slip. Each force is taken with the memory at its own moment.
/// @param steps  >= 1; a peak or an evolution over s0 asks for slip per step below s0/5
/// @return       steps + 1 points, the first at slip 0
std::vector<PullPoint> pull_history(const Model& model, const FrictionTestRow& row, const FrictionRig& rig,
                                    int steps, const AreaFunction& area = {});

/// The sawtooth of a pull through a spring.
struct Sawtooth {
  double upper_force;  ///< F_s, at which the contact breaks away [N]
  double lower_force;  ///< to which the spring unloads [N]
  double slip_jump;    ///< [m]
  double period;       ///< [s]
};
/// Stick-slip of the row's pull, where mu at its speed lies below mu at rest (F5, or a falling law); empty
/// where it does not. Of this the law gives F_s = 2 mu(0) N and F_k = 2 mu(U) N; the rig gives the rest: an
/// undamped slider overshoots to 2 F_k - F_s, over the slip 2 (F_s - F_k)/k, and the spring loads again at k
/// U (Rabinowicz). Jump and period go with 1/k, the force amplitude does not.
/// @param stiffness  k of the rig between drive and specimen [N/m], > 0
std::optional<Sawtooth> sawtooth(const Model& model, const FrictionTestRow& row, const FrictionRig& rig,
                                 double stiffness, const AreaFunction& area = {});

}  // namespace heddle::friction
