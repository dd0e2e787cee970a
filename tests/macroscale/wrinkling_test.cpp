// Wrinkles: when shear makes them (V16), and stampings full of them that must come to their end.
#include <catch2/catch.hpp>

#include <cmath>
#include <numbers>
#include <optional>
#include <random>
#include <utility>
#include <vector>

#include <fmt/format.h>

#include "macroscale/folds.h"
#include "macroscale/indicators.h"
#include "macroscale/solve.h"
#include "macroscale/stamping.h"
#include "mesoscale/cell_spec.h"
#include "tests/macroscale/quasi_static.h"
#include "tests/macroscale/sample_fabric.h"

using namespace heddle::macroscale;
using Eigen::Vector3d;
using Eigen::VectorXd;
using heddle::test::make_fabric;
using heddle::test::observed_order;

namespace {

constexpr double pi = std::numbers::pi;

// A square sheet in uniform trellis shear and equal tension of both tows, in its plane by its supports,
// pinned out of it at its edges; or free there in a band along its long diagonal only, `band` cells wide.
class ShearedSheet {
 public:
  static constexpr double angle = 0.4;  // [rad]

  ShearedSheet(int cells, double spacing, double bending, int band = 0)
      : fabric_(
            make_fabric({.tow_stiffness = tow_stiffness, .shear_stiffness = stiffness, .bending = bending})) {
    scene_.blank = make_blank({cells * spacing, cells * spacing}, spacing);
    scene_.fabric = &fabric_;
    scene_.shear_rate = 0.0;
    scene_.held.assign(3 * scene_.blank.nodes(), 1);
    for (int n = 0; n < scene_.blank.nodes(); ++n) {
      const auto [i, j] = scene_.blank.grid[n];
      const bool edge = i == 0 || j == 0 || i == cells || j == cells;
      scene_.held[3 * n + 2] = edge || (band > 0 && 2 * std::abs(i - j) >= band);
    }
    system_.emplace(scene_);
  }

  // Slope of the shear energy there: Psi'(s) [N/m].
  static double shear_stress() { return stiffness * std::sin(angle); }

  // Whether the exact stiffness, and `shift` on its diagonal, is positive definite: it does not wrinkle.
  bool is_stable(double tension, double shift = 0.0) {
    State state = initial_state(scene_);
    StepData step;
    step.start = &state;
    step.dt = 1e4;  // inertia does not count
    step.frictionless = true;
    const double stretch = 1.0 + tension / tow_stiffness, c = std::cos(0.5 * angle),
                 s = std::sin(0.5 * angle);
    VectorXd x = state.x;
    for (int n = 0; n < scene_.blank.nodes(); ++n) {
      const Vector3d& r = scene_.blank.reference[n];
      x.segment<3>(3 * n) = stretch * Vector3d(c * r.x() + s * r.y(), s * r.x() + c * r.y(), 0.0);
    }
    step.target = x;
    system_->assemble(step, x, Filter::none, shift);
    return system_->solver().factorise();
  }

  // Length along a tow [m] of the wave that asks for least energy, by inverse iteration just below it.
  // @param least  about what it asks for, < 0 [N/m^3]
  double wrinkle_length(double tension, double least) {
    const Blank& blank = scene_.blank;
    REQUIRE(is_stable(tension, -1.1 * least * blank.spacing[0] * blank.spacing[1]));
    VectorXd v = VectorXd::Zero(system_->size());
    std::mt19937 random(17);
    for (int n = 0; n < blank.nodes(); ++n)
      if (!scene_.held[3 * n + 2]) v[3 * n + 2] = static_cast<double>(random()) / 4294967296.0 - 0.5;
    for (int k = 0; k < 80; ++k) {
      system_->solver().solve({v.data(), static_cast<std::size_t>(v.size())});
      v /= v.norm();
    }
    double slope2 = 0.0, size2 = 0.0;
    for (const TowSegment& segment : blank.segments) {
      const double a = v[3 * segment.from + 2], b = v[3 * segment.to + 2];
      slope2 += (b - a) * (b - a) / (blank.spacing[0] * blank.spacing[0]);
      size2 += 0.5 * (a * a + b * b);
    }
    return 2.0 * pi * std::sqrt(size2 / slope2);
  }

  // Tension of each tow below which the sheet wrinkles [N/m], by halving.
  double onset() {
    double low = 0.4 * shear_stress(), high = 1.5 * shear_stress();
    REQUIRE(is_stable(high));
    REQUIRE_FALSE(is_stable(low));
    while (high - low > 1e-3 * shear_stress()) {
      const double middle = 0.5 * (low + high);
      (is_stable(middle) ? high : low) = middle;
    }
    return 0.5 * (low + high);
  }

 private:
  static constexpr double stiffness = 60.0, tow_stiffness = 5.9e6;
  heddle::mesoscale::FabricProperties fabric_;
  Scene scene_;
  std::optional<System> system_;
};

}  // namespace

// Out of the plane the energy of a sheet in trellis shear is, per area and to second order,
//     1/2 (n - Psi' s)(w,1^2 + w,2^2) + Psi' w,1 w,2 + 1/2 B (w,11^2 + w,22^2) + 1/2 (B/10) w,12^2,
// least for waves along the short diagonal, w,2 = -w,1: with wave number k along either tow the sheet
// wrinkles where n + 1.05 B k^2 < Psi' (1 + s).
TEST_CASE("V16: a sheared sheet wrinkles where tension no longer holds Psi' (1 + sin gamma)",
          "[macroscale][verification][wrinkling]") {
  const double s = std::sin(ShearedSheet::angle), limit = ShearedSheet::shear_stress() * (1.0 + s);
  // Next to no bending. Waves must fit between the edges, and grids do not hold the shortest: both errors at
  // their best wave length go with the spacing over the side.
  const double coarse = ShearedSheet(20, 6e-3, 1e-7).onset(), fine = ShearedSheet(40, 3e-3, 1e-7).onset();
  CHECK(coarse < fine);
  CHECK(fine < limit);
  CHECK(2.0 * fine - coarse == Approx(limit).epsilon(0.01));
  CHECK(observed_order(limit - coarse, limit - fine) == Approx(1.0).margin(0.2));
}

TEST_CASE("V16: in a band bending holds a sheared sheet as well, by 1.05 B k^2 of the tension it would need",
          "[macroscale][verification][wrinkling]") {
  const double s = std::sin(ShearedSheet::angle), limit = ShearedSheet::shear_stress() * (1.0 + s);
  constexpr double width = 64e-3, share = 0.4;  // of the band along either tow [m]; that bending holds
  constexpr double k = 2.0 * pi / width;        // (1 - cos(k x)) / 2 between clamps
  constexpr int long_by = 4;                    // lengths of the band over its width
  // Two lines of held nodes clamp halfway between them, so the sheet that is free is a spacing wider.
  const auto onset = [&](int band) {
    return ShearedSheet(long_by * band, width / (band + 1), share * limit / (1.05 * k * k), band).onset();
  };
  const double coarse = onset(8), fine = onset(16);
  const double extrapolated = fine + (fine - coarse) / 3.0;
  // The band ends: half a wave along it, whose energy is (n - Psi' s + Psi') times 3 (k' / k)^2.
  const double ends = 3.0 / (16.0 * long_by * long_by);
  const double exact =
      ((1.0 - share) * limit - ends * ShearedSheet::shear_stress() * (1.0 - s)) / (1.0 + ends);
  WARN("onset at n = " << coarse << ", " << fine << ", extrapolated " << extrapolated << " N/m; closed form "
                       << exact);
  CHECK(extrapolated == Approx(exact).epsilon(0.03));
  CHECK(std::abs(extrapolated / limit - 1.0) > 0.3);  // without bending the answer is far off
}

// Waves ask for 2 (n - Psi' (1 + s)) k^2 + 2.1 B k^4 per area and squared amplitude, least at
// k^2 = (Psi' (1 + s) - n) / (2.1 B). A corner's shear sees waves of few spacings less than tension does, by
// cos^2(k h / 2): on a grid the length L that is least becomes L^2 + 2 pi^2 h^2 Psi' / (Psi' (1 + s) - n).
TEST_CASE("V16: the length of a wrinkle is set by bending, not by the grid",
          "[macroscale][verification][wrinkling]") {
  const double s = std::sin(ShearedSheet::angle), limit = ShearedSheet::shear_stress() * (1.0 + s);
  constexpr double side = 96e-3, length = 24e-3, share = 0.3;
  const double lacking = share * limit, k = 2.0 * pi / length, bending = lacking / (2.1 * k * k);
  const auto found = [&](double h, double b, double least) {
    ShearedSheet sheet(static_cast<int>(std::lround(side / h)), h, b);
    return sheet.wrinkle_length(limit - lacking, least);
  };
  std::vector<double> squares;
  for (const double h : {4e-3, 2e-3}) {
    const double wave = found(h, bending, -lacking * lacking / (2.1 * bending));
    const double on_grid =
        std::sqrt(length * length + 2.0 * pi * pi * h * h * ShearedSheet::shear_stress() / lacking);
    WARN(
        fmt::format("spacing {:.0f} mm: wrinkles {:.2f} mm long; closed form {:.2f} mm, on no grid {:.0f} mm",
                    1e3 * h, 1e3 * wave, 1e3 * on_grid, 1e3 * length));
    CHECK(wave == Approx(on_grid).epsilon(0.03));
    squares.push_back(wave * wave);
  }
  CHECK(std::sqrt((4.0 * squares[1] - squares[0]) / 3.0) == Approx(length).epsilon(0.03));
  // With next to no bending the grid sets it: half the spacing, half the length.
  const auto soft = [&](double h) {
    return found(h, 1e-4 * bending, -2.0 * lacking * lacking / (ShearedSheet::shear_stress() * h * h));
  };
  CHECK(soft(4e-3) / soft(2e-3) == Approx(2.0).epsilon(0.1));
}

namespace {

// The shipped tools under a binder that holds next to nothing.
StampingSpec wrinkling_case(double spacing, double orientation_deg, int steps) {
  StampingSpec spec;
  spec.blank.spacing = spacing;
  spec.blank.orientation = orientation_deg * pi / 180.0;
  spec.process.binder_force = 20.0;
  spec.process.stroke = 60e-3;
  spec.process.time = 0.37;
  spec.process.steps = steps;
  return spec;
}

heddle::friction::Model coulomb(double coefficient) {
  heddle::friction::Model model;
  model.law = heddle::friction::Coulomb{coefficient};
  return model;
}

struct Wrinkled {
  StampingSummary summary;
  double height = 0.0;  ///< [mm]
  Folds folds;
};

Wrinkled wrinkle(const StampingSpec& spec, const heddle::mesoscale::FabricProperties& fabric,
                 double coefficient) {
  const StampingResult result = run_stamping(spec, fabric, coulomb(coefficient));
  Wrinkled found{result.summary, 0.0, find_folds(result.final_state, fabric.thickness)};
  for (const LargestIndicator& i : largest(indicators(result.final_state, fabric), result.final_state))
    if (i.name == "wrinkle_height_max") found.height = i.value;
  return found;
}

std::string line_of(const Wrinkled& w) {
  const StampingSummary& s = w.summary;
  return fmt::format(
      "{} steps, {} tried again, {} Newton iterations, {} factorisations, wrinkle height {:.2f} mm, {} nodes "
      "folded, "
      "{} near, {} crossings, energy residual {:.2g}{}",
      s.steps, s.rejected_steps, s.newton_iterations, s.factorisations, w.height, w.folds.folded,
      w.folds.near, s.self_crossings, s.energy_residual_max, s.failure.empty() ? "" : ", " + s.failure);
}

}  // namespace

TEST_CASE("under 20 N of binder a soft sheet wrinkles, and the stamping comes to its end by inertia alone",
          "[macroscale][wrinkling][long]") {
  const auto [orientation, coefficient] = GENERATE(std::pair{30.0, 0.3}, std::pair{45.0, 0.0});
  CAPTURE(orientation, coefficient);
  const Wrinkled found =
      wrinkle(wrinkling_case(16e-3, orientation, 12), make_fabric({.bending = 1e-4}), coefficient);
  INFO(line_of(found));
  CHECK(found.summary.completed);
  CHECK(found.summary.energy_residual_max < 0.01);
  CHECK(found.height > 0.15);  // a tenth of the thickness
}

TEST_CASE(
    "on three grids and at 0, 30 and 45 degrees a sheet under 20 N of binder wrinkles and comes to its end",
    "[macroscale][wrinkling][slow]") {
  const double spacing = GENERATE(16e-3, 10e-3, 7e-3), orientation = GENERATE(0.0, 30.0, 45.0),
               coefficient = GENERATE(0.0, 0.3);
  const Wrinkled found =
      wrinkle(wrinkling_case(spacing, orientation, 40), make_fabric({.bending = 1e-4}), coefficient);
  WARN(fmt::format("{:.0f} mm, {:.0f} deg, mu {}: ", 1e3 * spacing, orientation, coefficient)
       << line_of(found));
  CHECK(found.summary.completed);
  CHECK(found.summary.energy_residual_max < 0.01);
  CHECK(found.height > 0.15);
}
