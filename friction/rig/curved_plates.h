#pragma once

#include <numbers>
#include <vector>

#include "core/curve.h"
#include "friction/friction_test.h"

namespace heddle::friction {

/// Matched plates bent into an S: level, down over an arc, up again over another, level (the paper's "fabric
/// bending" row; it prints no shape, so radius and angle are ASSUMED). The path of the fabric's middle; the
/// plates lie half a thickness to either side.
struct SCurve {
  double radius = 50e-3;                           ///< R of both arcs [m], > 0
  double angle = 20.0 * std::numbers::pi / 180.0;  ///< steepest slope of the path [rad], 0 < angle < pi/2

  double arcs() const { return 2.0 * radius * angle; }  ///< length of both together [m]
};

/// Slope angle (downwards) and signed curvature (> 0: bends down, the tension presses on the lower plate) at
/// s from the start of the first arc.
struct PathPoint {
  double slope = 0.0;      ///< [rad]
  double curvature = 0.0;  ///< [1/m]
};
PathPoint at(const SCurve& path, double s);

/// What carries the fabric along the path.
struct CurvedPull {
  double pull_force = 0.0;  ///< F [N]
  double upper_load = 0.0;  ///< vertical, that the upper plate carries: N [N]
  double closing = 0.0;     ///< of the upper plate from first touch, vertical [m]
  std::vector<double> s;    ///< along the path, from the free end of the fabric [m]
  std::vector<double> tension, lower_pressure, upper_pressure;  ///< [N], [Pa], [Pa]
  double released = 0.0;  ///< share of the path where one plate has lost the fabric [-]
};

/// The fabric between curved plates at constant speed, plate area and held vertical load of the row. Tension
/// grows by the friction of both faces and, where the path bends, presses the fabric from one plate to the
/// other:
///
///     dT/ds = w (tau(p_l) + tau(p_u)),   p_l - p_u = T kappa/w,   a_l + a_u = closing cos(slope),   p = P(a)
///
/// The closing is found so that the upper plate is in balance, N + w Int tau_u sin(slope) ds = w Int p_u
/// cos(slope) ds. On one face alone this is the capstan, T exp(mu angle); between plates the load that
/// tension adds to one face it takes from the other, as far as that has any.
/// @param compaction  P of one face: pressure [Pa] over approach [m], P(0) = 0, rising
/// @param width       w [m]; the path is plate_area / w long and holds the arcs in its middle
/// @throws std::invalid_argument  if the arcs are longer than the path
/// @throws NumericalError         if no closing within the compaction curve carries the load
CurvedPull pull_over(const SCurve& path, const Model& model, const FrictionTestRow& row,
                     const FrictionRig& rig, const Curve& compaction, double width,
                     const AreaFunction& area = {});

}  // namespace heddle::friction
