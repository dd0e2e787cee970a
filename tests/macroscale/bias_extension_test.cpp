// Bias extension with the kinematics of inextensible tows as its answer: V4 of the verification plan.
#include <catch2/catch.hpp>

#include <algorithm>
#include <array>
#include <cmath>
#include <numbers>
#include <vector>

#include "macroscale/solve.h"
#include "tests/macroscale/quasi_static.h"
#include "tests/macroscale/sample_fabric.h"

using namespace heddle::macroscale;
using Eigen::Vector3d;
using Eigen::VectorXd;
using heddle::test::make_fabric;
using heddle::test::run_at_rest;

namespace {

constexpr double pi = std::numbers::pi;
constexpr double width = 0.1, height = 0.2;     // between the grips: ratio 2
constexpr double free_length = height - width;  // L0: the diagonal of zone C along the pull
constexpr double shear_modulus = 60.0;          // dPsi/ds / s [N/m]

// Half a diagonal of a cell; grid nodes lie at (p, q) times this with p + q of one parity.
struct Strip {
  Blank blank;
  std::vector<char> used;  ///< per node: belongs to a cell
  double half_diagonal = 0.0;
};

// Cells of a grid at 45 degrees that lie inside the strip, with saw teeth along its free edges. The row of
// nodes on a grip's line reaches from edge to edge, as the grip does; half a row of cells more lies inside
// the grip, so that both tows through each gripped node are held.
Strip bias_strip(int cells_across) {
  const double d = 0.5 * width / cells_across, h = d * std::numbers::sqrt2;
  Strip strip;
  strip.half_diagonal = d;
  const int n = 2 * (static_cast<int>(std::ceil((width + height) / (2.0 * d))) / 2 + 2);
  strip.blank = make_blank({n * h, n * h}, h * (1.0 + 1e-9), 0.25 * pi);
  Blank& blank = strip.blank;
  const auto inside = [&](const std::array<int, 4>& quad) {
    return std::all_of(quad.begin(), quad.end(), [&](int i) {
      const Vector3d& r = blank.reference[i];
      return std::abs(r.x()) < 0.5 * width + 0.1 * d && std::abs(r.y()) < 0.5 * height + 1.1 * d;
    });
  };
  std::erase_if(blank.quads, [&](const auto& quad) { return !inside(quad); });
  strip.used.assign(blank.nodes(), 0);
  blank.node_area.assign(blank.nodes(), 0.0);
  for (const auto& quad : blank.quads)
    for (int i : quad) {
      strip.used[i] = 1;
      blank.node_area[i] += blank.corner_area();
    }
  std::erase_if(blank.triples, [&](const TowTriple& t) {
    return !(strip.used[t.before] && strip.used[t.middle] && strip.used[t.after]);
  });
  return strip;
}

struct Outcome {
  double centre = 0.0, zone_b = 0.0, zone_a = 0.0;  ///< mean shear angles [rad]
  double centre_spread = 0.0;  ///< largest difference from the mean in the inner half of C
  double force = 0.0;          ///< on the upper grip [N]
  double exact_centre = 0.0, exact_force = 0.0;
};

// Mean shear angles by zone, over cells that lie clear of its edges, and what inextensible tows demand.
Outcome measure(const Blank& blank, const State& state, double extension, double force) {
  struct Mean {
    double sum = 0.0;
    int count = 0;
    void add(double value) { sum += value, ++count; }
    double value() const { return count > 0 ? sum / count : std::nan(""); }
  } a, b;
  std::vector<double> inner;
  const double margin = 0.1 * width, half = 0.5 * free_length;
  double area_b = 0.0, area_c = 0.0;
  for (std::size_t q = 0; q < blank.quads.size(); ++q) {
    Vector3d middle = Vector3d::Zero();
    double angle = 0.0;
    for (std::size_t k = 0; k < 4; ++k) {
      middle += 0.25 * blank.reference[blank.quads[q][k]];
      angle += 0.25 * std::abs(state.corner_angle[4 * q + k]);
    }
    const double x = std::abs(middle.x()), y = std::abs(middle.y());
    const double along = x + y, across = y - x;  // C: along < L0 / 2; A: across > L0 / 2; B: the rest
    if (along < half) {
      area_c += 4.0 * blank.corner_area();
      if (along < 0.5 * half) inner.push_back(angle);
    } else if (across < half) {
      area_b += 4.0 * blank.corner_area();
      if (along > half + margin && across < half - margin) b.add(angle);
    } else if (across > half + margin) {
      a.add(angle);
    }
  }
  Outcome outcome;
  outcome.force = force;
  Mean c;
  for (double angle : inner) c.add(angle);
  outcome.centre = c.value();
  for (double angle : inner)
    outcome.centre_spread = std::max(outcome.centre_spread, std::abs(angle - outcome.centre));
  outcome.zone_b = b.value();
  outcome.zone_a = a.value();

  // gamma = 90 deg - 2 acos((L0 + d) / (sqrt2 L0)). Force = d/dd of A_C Psi(sin gamma) + A_B Psi(sin(gamma /
  // 2)), over the areas that the saw-toothed strip has.
  const double cosine = (free_length + extension) / (std::numbers::sqrt2 * free_length);
  const double gamma = 0.5 * pi - 2.0 * std::acos(cosine);
  const double rate = 2.0 / (std::numbers::sqrt2 * free_length * std::sqrt(1.0 - cosine * cosine));
  outcome.exact_centre = gamma;
  outcome.exact_force = shear_modulus * rate *
                        (area_c * std::sin(gamma) * std::cos(gamma) +
                         0.5 * area_b * std::sin(0.5 * gamma) * std::cos(0.5 * gamma));
  return outcome;
}

// Pulled by 30 mm in three equal parts: outcomes at 10, 20 and 30 mm.
std::vector<Outcome> pull(int cells_across, double tow_stiffness) {
  const auto fabric =
      make_fabric({.tow_stiffness = tow_stiffness, .shear_stiffness = shear_modulus, .bending = 1e-7});
  const Strip strip = bias_strip(cells_across);
  Scene scene;
  scene.blank = strip.blank;
  scene.fabric = &fabric;
  scene.shear_rate = false;
  const Blank& blank = scene.blank;
  const auto gripped = [&](int i) {
    return std::abs(blank.reference[i].y()) > 0.5 * height - 0.1 * strip.half_diagonal;
  };
  scene.held.assign(3 * blank.nodes(), 0);
  for (int i = 0; i < blank.nodes(); ++i)
    for (int c = 0; c < 3; ++c)
      scene.held[3 * i + c] = !strip.used[i] || gripped(i) || c == 2;  // kept flat: no wrinkles
  System system(scene);
  State state = initial_state(scene);
  SolveOptions options;
  options.force_tolerance = 1e-6;
  options.relative_tolerance = 0.0;
  options.newton_limit = 200;
  double extension = 0.0;
  std::vector<Outcome> outcomes;
  run_at_rest(
      system, state, 100.0, 3, [&](double share) { extension = 0.03 * share; },
      [&](double, VectorXd& x) {
        for (int i = 0; i < blank.nodes(); ++i)
          if (strip.used[i] && gripped(i))
            x[3 * i + 1] = blank.reference[i].y() + std::copysign(0.5 * extension, blank.reference[i].y());
      },
      [&](const StepData& step, const State& end) {
        const VectorXd g = system.full_gradient(step, end.x);
        double force = 0.0;
        for (int i = 0; i < blank.nodes(); ++i)
          if (gripped(i) && blank.reference[i].y() > 0.0) force += g[3 * i + 1];
        outcomes.push_back(measure(blank, end, extension, force));
      },
      options);
  return outcomes;
}

constexpr double degrees = 180.0 / pi;

}  // namespace

TEST_CASE("V4: bias extension shears zone C as inextensible tows demand, zone B by half of it and zone A not",
          "[macroscale][verification]") {
  const auto coarse = pull(6, 5.9e6), fine = pull(12, 5.9e6);
  for (std::size_t k = 0; k < fine.size(); ++k) {
    const Outcome &f = fine[k], &c = coarse[k];
    WARN("V4, d = " << 10 * (k + 1) << " mm: centre " << degrees * c.centre << ", " << degrees * f.centre
                    << " deg with 6, 12 cells across, exact " << degrees * f.exact_centre << "; zone B "
                    << degrees * f.zone_b << ", zone A " << degrees * f.zone_a << "; force " << c.force
                    << ", " << f.force << " N, exact for these saw teeth " << c.exact_force << ", "
                    << f.exact_force);
    CHECK(std::abs(f.centre - f.exact_centre) * degrees < 0.5);
    CHECK(f.centre_spread * degrees < 0.5);
    CHECK(std::abs(f.zone_b - 0.5 * f.exact_centre) * degrees < 0.5);
    CHECK(f.zone_a * degrees < 0.5);
    CHECK(f.force == Approx(f.exact_force).epsilon(0.005));
  }
}

TEST_CASE("V4: with tows that stretch the kinematics of bias extension are lost: the check can fail",
          "[macroscale][verification]") {
  const Outcome soft = pull(6, 100.0 * shear_modulus).back();
  CHECK(std::abs(soft.centre - soft.exact_centre) * degrees > 0.5);
}
