#pragma once

// V3: a net of tows with diagonal springs in a picture frame.
#include <cmath>
#include <vector>

#include "macroscale/solve.h"
#include "tests/macroscale/sample_fabric.h"

namespace heddle::test {

using namespace heddle::macroscale;

// Net whose cells carry diagonal springs of stiffness k (force over stretch): dPsi/ds in closed form.
inline mesoscale::FabricProperties diagonal_net(double k) {
  auto fabric = make_fabric({.bending = 1e-9});
  std::vector<double> s, t;
  for (int i = 0; i <= 4000; ++i) {
    s.push_back(0.9 * i / 4000.0);
    t.push_back(k * (1.0 / std::sqrt(1.0 - s.back()) - 1.0 / std::sqrt(1.0 + s.back())));
  }
  fabric.shear_stress = Curve(s, t);
  return fabric;
}

// Picture frame of hinged bars: warp turns by +angle/2, weft by -angle/2 from the square's sides.
inline Eigen::Vector3d in_frame(const Eigen::Vector3d& reference, double angle) {
  const double c = std::cos(0.5 * angle), s = std::sin(0.5 * angle);
  return {c * reference.x() + s * reference.y(), s * reference.x() + c * reference.y(), reference.z()};
}

// Torque of the frame = power of its bars' reactions over the rate of the angle, by a small turn.
inline double frame_torque(const mesoscale::FabricProperties& fabric, double side, double spacing,
                           double turned, double angle) {
  Scene scene;
  scene.blank = make_blank({side, side}, spacing, turned);
  scene.fabric = &fabric;
  System system(scene);
  State state = initial_state(scene);
  StepData step;
  step.start = &state;
  step.dt = 1.0;
  const auto energy = [&](double a) {
    Eigen::VectorXd x = state.x;
    for (int i = 0; i < scene.blank.nodes(); ++i) x.segment<3>(3 * i) = in_frame(scene.blank.reference[i], a);
    step.target = x;
    return system.potential(step, x).total();
  };
  const double h = 1e-5;
  return (energy(angle + h) - energy(angle - h)) / (2.0 * h);
}

}  // namespace heddle::test
