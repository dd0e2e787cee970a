#pragma once

#include <vector>

#include <Eigen/Core>

#include "macroscale/system.h"

namespace heddle::macroscale {

/// What friction holds while Newton's method runs: load, normal and context of each contact, per tool, per
/// contact point.
using FrictionPoints = std::vector<std::vector<FrictionPoint>>;

/// Loads, normals and contexts of all points at x.
/// @param shear_angle  per contact point [rad], for contact area and direction
FrictionPoints freeze(const System& system, const StepData& step, const Eigen::VectorXd& x,
                      const std::vector<double>& shear_angle);

/// Pressure of tool k at each node as friction holds it [Pa]: of its own point, or, with contact inside
/// cells, the force that reaches it over its area.
std::vector<double> nodal_pressure(const System& system, const StepData& step, int k);

/// How far two frozen sets are apart at x: loads, normals and coefficients all count.
struct LagChange {
  double relative = 0.0;  ///< sum of the changes of all friction forces over the sum of their sizes [-]; 1
                          ///< where all contact was lost
  double largest = 0.0;   ///< change of one contact's friction force [N]
};
LagChange lag_change(const System& system, const StepData& step, const Eigen::VectorXd& x,
                     const FrictionPoints& before, const FrictionPoints& after);

/// A share of the way from one frozen set to another. Where loads and friction drive each other to and fro (a
/// node that friction tilts off its tool loses the load that made the friction), the half-way set settles.
FrictionPoints blend(const System& system, const StepData& step, const FrictionPoints& before,
                     FrictionPoints after, double share, const std::vector<double>& shear_angle);

}  // namespace heddle::macroscale
