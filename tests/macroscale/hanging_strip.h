#pragma once

// A heavy strip clamped level at one end: by quadrature, and by the solver.
#include <array>
#include <catch2/catch.hpp>
#include <cmath>

#include "macroscale/solve.h"
#include "tests/macroscale/quasi_static.h"
#include "tests/macroscale/sample_fabric.h"

namespace heddle::test::hanging_strip {

using namespace heddle::macroscale;

inline constexpr double stiffness = 1e-3;  // B [N m]
inline constexpr double length = 0.1;      // [m]

struct Tip {
  double down = 0.0, inwards = 0.0;  ///< [m]
};

// Heavy inextensible elastica clamped level at s = 0: B theta'' = -w (L - s) cos(theta), theta(0) = 0,
// theta'(L) = 0 (moment of the weight beyond s), with w per area and B per width. Shooting on theta'(0) by
// bisection, classical Runge-Kutta in between.
inline Tip elastica(double weight) {
  constexpr int n = 2000;
  const double h = length / n;
  using Y = std::array<double, 4>;  // theta, theta', down, along
  const auto slope = [&](double s, const Y& y) -> Y {
    return {y[1], -weight / stiffness * (length - s) * std::cos(y[0]), std::sin(y[0]), std::cos(y[0])};
  };
  const auto at = [](const Y& y, const Y& k, double step) {
    Y out = y;
    for (std::size_t c = 0; c < out.size(); ++c) out[c] += step * k[c];
    return out;
  };
  const auto shoot = [&](double curvature) {
    Y y = {0.0, curvature, 0.0, 0.0};
    for (int i = 0; i < n; ++i) {
      const double s = i * h;
      const Y k1 = slope(s, y), k2 = slope(s + 0.5 * h, at(y, k1, 0.5 * h)),
              k3 = slope(s + 0.5 * h, at(y, k2, 0.5 * h)), k4 = slope(s + h, at(y, k3, h));
      for (std::size_t c = 0; c < y.size(); ++c)
        y[c] += h / 6.0 * (k1[c] + 2.0 * k2[c] + 2.0 * k3[c] + k4[c]);
    }
    return y;
  };
  // With no load the tip would keep the curvature of the root; the small-deflection root curvature
  // w L^2 / (2 B) is an upper bound, for the weight's lever only shrinks as the strip hangs.
  double low = 0.0, high = 0.5 * weight * length * length / stiffness;
  for (int k = 0; k < 60; ++k) {
    const double middle = 0.5 * (low + high);
    (shoot(middle)[1] > 0.0 ? high : low) = middle;
  }
  const Y y = shoot(0.5 * (low + high));
  return {y[2], length - y[3]};
}

// The strip through the finite elements. Its two held columns of nodes clamp it halfway between them: there
// the slope of the broken line is zero, so the root's curvature counts half a cell, as it must.
inline Tip strip_under_weight(double weight, int cells, int load_steps) {
  const auto fabric = make_fabric({.bending = stiffness});
  const double h = length / (cells - 0.5);
  Scene scene;
  scene.blank = make_blank({cells * h, h}, h * (1.0 + 1e-6));
  scene.fabric = &fabric;
  scene.shear_rate = false;
  const Blank& blank = scene.blank;
  REQUIRE(blank.nu == cells);
  scene.held.assign(3 * blank.nodes(), 0);
  for (int i = 0; i < 2; ++i)
    for (int j = 0; j <= blank.nv; ++j)
      for (int c = 0; c < 3; ++c) scene.held[3 * blank.node(i, j) + c] = 1;
  scene.load.assign(3 * blank.nodes(), 0.0);
  System system(scene);
  State state = initial_state(scene);
  SolveOptions options;
  options.force_tolerance = 1e-9 * weight;
  options.relative_tolerance = 0.0;
  options.newton_limit = 400;
  const int tip = blank.node(blank.nu, 0);
  run_at_rest(
      system, state, 1e3, load_steps,
      [&](double share) {
        for (int i = 0; i < blank.nodes(); ++i) scene.load[3 * i + 2] = -share * weight * blank.node_area[i];
      },
      {}, {}, options);
  return {-state.node(tip).z(), blank.reference[tip].x() - state.node(tip).x()};
}

}  // namespace heddle::test::hanging_strip
