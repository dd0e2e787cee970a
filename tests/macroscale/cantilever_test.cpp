// Bending of a strip with answers known in closed form or by quadrature: V9, V16 of the verification plan.
#include <catch2/catch.hpp>

#include <array>
#include <cmath>
#include <numbers>

#include "macroscale/solve.h"
#include "tests/macroscale/hanging_strip.h"
#include "tests/macroscale/quasi_static.h"
#include "tests/macroscale/sample_fabric.h"

using namespace heddle::macroscale;
using Eigen::VectorXd;
using namespace heddle::test::hanging_strip;
using heddle::test::make_fabric;
using heddle::test::observed_order;
using heddle::test::run_at_rest;

namespace {}  // namespace

TEST_CASE("V9: a strip that sags a little under its weight does so by w L^4 / (8 B)",
          "[macroscale][verification]") {
  const double weight = 0.01 * 8.0 * stiffness / std::pow(length, 3);  // sags by a hundredth of its length
  const double exact = weight * std::pow(length, 4) / (8.0 * stiffness);
  const double coarse = strip_under_weight(weight, 10, 1).down, fine = strip_under_weight(weight, 20, 1).down;
  const double order = observed_order(coarse - exact, fine - exact);
  WARN("V9 small: sag " << 1e3 * coarse << ", " << 1e3 * fine << " mm with 10, 20 cells; exact "
                        << 1e3 * exact << "; order " << order);
  CHECK(fine == Approx(exact).epsilon(0.005));
  CHECK(order > 1.8);
}

TEST_CASE("V9: a strip that hangs far down under its weight follows the elastica",
          "[macroscale][verification]") {
  // The reference itself: a light strip sags as the closed form says.
  const double light = 1e-4 * 8.0 * stiffness / std::pow(length, 3);
  CHECK(elastica(light).down == Approx(1e-4 * length).epsilon(1e-6));

  const double load = GENERATE(2.0, 10.0, 40.0);  // w L^3 / B: the tip sags by 24, 70 and 89 % of the length
  const double weight = load * stiffness / std::pow(length, 3);
  const Tip exact = elastica(weight);
  const Tip coarse = strip_under_weight(weight, 10, 4), fine = strip_under_weight(weight, 20, 4);
  const double order = observed_order(coarse.down - exact.down, fine.down - exact.down);
  WARN("V9 elastica, w L^3 / B = " << load << ": sag " << 1e3 * coarse.down << ", " << 1e3 * fine.down
                                   << " mm with 10, 20 cells; exact " << 1e3 * exact.down << "; order "
                                   << order);
  CHECK(fine.down == Approx(exact.down).epsilon(0.005));
  CHECK(fine.inwards == Approx(exact.inwards).epsilon(0.005));
  CHECK(order > 1.8);
  // A straight-beam formula is no stand-in: it would have the strip sag beyond its own length.
  if (load > 9.0) CHECK(std::abs(load / 8.0 * length / exact.down - 1.0) > 0.5);
}

TEST_CASE("V16: a pinned strip loses its stability at Euler's load pi^2 B / L^2",
          "[macroscale][verification]") {
  const auto fabric = make_fabric({.bending = stiffness});
  const double exact = std::pow(std::numbers::pi / length, 2) * stiffness;  // per width [N/m]
  const auto buckling_load = [&](int cells) {
    Scene scene;
    const double h = length / cells;
    scene.blank = make_blank({length, h}, h * (1.0 + 1e-6));
    scene.fabric = &fabric;
    scene.shear_rate = false;
    const Blank& blank = scene.blank;
    scene.held.assign(3 * blank.nodes(), 0);
    scene.load.assign(3 * blank.nodes(), 0.0);
    for (int i = 0; i < blank.nodes(); ++i) {
      scene.held[3 * i + 1] = 1;  // buckles out of its plane only
      if (i < blank.node(1, 0)) scene.held[3 * i] = 1;
      if (i < blank.node(1, 0) || i >= blank.node(blank.nu, 0)) scene.held[3 * i + 2] = 1;
    }
    // Straight and compressed it is always in equilibrium; stable as long as the exact matrix is positive.
    const auto stable = [&](double load) {
      for (int j = 0; j <= blank.nv; ++j)
        scene.load[3 * blank.node(blank.nu, j)] =
            -load * h / blank.nv * (j == 0 || j == blank.nv ? 0.5 : 1.0);
      System system(scene);
      State state = initial_state(scene);
      run_at_rest(system, state, 1e3, 1, {});
      StepData step;
      step.start = &state;
      step.dt = 1e3;
      step.target = state.x;
      system.assemble(step, state.x, Filter::none);
      return system.solver().factorise();
    };
    double low = 0.5 * exact, high = 1.5 * exact;
    REQUIRE(stable(low));
    REQUIRE_FALSE(stable(high));
    for (int k = 0; k < 16; ++k) {
      const double middle = 0.5 * (low + high);
      (stable(middle) ? low : high) = middle;
    }
    return 0.5 * (low + high);
  };
  const double coarse = buckling_load(10), fine = buckling_load(20);
  const double order = observed_order(coarse - exact, fine - exact);
  WARN("V16: " << coarse << ", " << fine << " N/m with 10, 20 cells; exact " << exact << "; order " << order);
  CHECK(fine == Approx(exact).epsilon(0.03));
  CHECK(order == Approx(2.0).margin(0.1));
}
