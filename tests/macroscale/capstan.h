#pragma once

// V6: a strip drawn over a cylinder.
#include <algorithm>
#include <cmath>

#include "friction/model.h"
#include "macroscale/ledger.h"
#include "macroscale/solve.h"
#include "tests/macroscale/sample_fabric.h"
#include "tests/macroscale/steps.h"

namespace heddle::test {

using namespace heddle::macroscale;
using Eigen::Vector3d;
using Eigen::VectorXd;

struct Capstan {
  double radius = 0.05, width = 0.005;  ///< of cylinder and strip [m]
  double tension = 20.0;                ///< at the loaded end [N]
  double speed = 0.01;                  ///< of the drawn end [m/s]
};

inline friction::Model coulomb(double mu) {
  friction::Model model;
  model.law = friction::Coulomb{mu};
  return model;
}

// A narrow strip laid over a cylinder through `wrap` radians, one end pulled back by a dead load, the other
// drawn along its tangent. Returns tension at the drawn end over tension at the loaded one.
inline double capstan_ratio(const friction::Model& friction, double wrap, int per_radius,
                            ContactSites sites) {
  const auto fabric = make_fabric({.bending = 1e-9, .contact_stiffness = 5e9});
  const auto [radius, width, tension, speed] = Capstan{};
  const double mid = radius + 0.5 * fabric.thickness, tail = 0.03, length = 2.0 * tail + mid * wrap;
  Scene scene;
  scene.contact_sites = sites;
  scene.blank = make_blank({length, width}, radius / per_radius);
  scene.fabric = &fabric;
  scene.friction = &friction;
  scene.tools = {{Role::die, CylinderShape{{0, 0, 0}, radius}, Motion::fixed, 0.0, 0.0}};
  scene.slip_smoothing = 1e-6;
  scene.shear_rate = false;
  const Blank& blank = scene.blank;

  // Along the strip: tangent line, arc, tangent line; s = 0 at the crown.
  const double half = 0.5 * wrap;
  const auto place = [&](double s) {
    const double arc = std::clamp(s / mid, -half, half), rest = s - mid * arc;
    return Vector3d(mid * std::sin(arc) + rest * std::cos(arc), 0.0,
                    mid * std::cos(arc) - rest * std::sin(arc));
  };
  scene.held.assign(3 * blank.nodes(), 0);
  scene.load.assign(3 * blank.nodes(), 0.0);
  const Vector3d forward(std::cos(half), 0.0, -std::sin(half)),
      backward(-std::cos(half), 0.0, -std::sin(half));
  for (int j = 0; j <= blank.nv; ++j)
    for (int c = 0; c < 3; ++c) {
      scene.held[3 * blank.node(blank.nu, j) + c] = 1;
      scene.load[3 * blank.node(0, j) + c] =
          tension * backward[c] * (j == 0 || j == blank.nv ? 0.5 : 1.0) / blank.nv;
    }
  System system(scene);
  State state = initial_state(scene);
  for (int i = 0; i < blank.nodes(); ++i) {
    const Vector3d r = blank.reference[i];
    state.x.segment<3>(3 * i) = place(r.x()) + Vector3d(0, r.y(), 0);
  }
  const VectorXd laid = state.x;
  const auto draw = [&, speed = speed](double time, VectorXd& x) {
    for (int j = 0; j <= blank.nv; ++j) {
      const int n = blank.node(blank.nu, j);
      x.segment<3>(3 * n) = laid.segment<3>(3 * n) + speed * time * forward;
    }
  };
  double drawn = 0.0;
  run_steps(system, state, 0.01, 40, draw, [&](const StepData& step, const State& end) {
    drawn = account(system, step, end).forces.by_supports.dot(forward);
  });
  return drawn / tension;
}

}  // namespace heddle::test
