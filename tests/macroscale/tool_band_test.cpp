#include "macroscale/tool_band.h"

#include <Eigen/Geometry>
#include <catch2/catch.hpp>
#include <cmath>
#include <limits>
#include <numbers>
#include <random>

#include "core/problem.h"
#include "macroscale/solve.h"
#include "macroscale/system.h"
#include "tests/derivative_check.h"
#include "tests/macroscale/sample_fabric.h"
#include "tests/macroscale/tool_meshes.h"

using namespace heddle;
using namespace heddle::macroscale;
using Eigen::Matrix3d;
using Eigen::Vector3d;
using heddle::test::derivative_gap;

namespace {

constexpr double degree = std::numbers::pi / 180.0;
constexpr double infinity = std::numeric_limits<double>::infinity();

// Bodies with a closed distance that are round everywhere, so that only the interpolation errs.
constexpr double ball_radius = 20e-3, ring_radius = 28e-3, ring_fillet = 6e-3;

Distance ball_distance(const Vector3d& x) {
  return distance(HemisphereShape{{0, 0, -ball_radius}, ball_radius}, x);
}

ToolBand ball_band(double voxel, double half_width = 2e-3) {
  const auto d = [](double x, double y, double z) { return std::sqrt(x * x + y * y + z * z) - ball_radius; };
  const double r = ball_radius;
  return ToolBand(
      level_set_from_distance(d, {{-r, -r, -r}, {r, r, r}}, voxel, half_width / voxel + ToolBand::rim),
      half_width);
}

ToolBand torus_band(double voxel, double half_width = 2e-3) {
  const auto d = [](double x, double y, double z) {
    return std::hypot(std::hypot(x, y) - ring_radius, z) - ring_fillet;
  };
  const double r = ring_radius + ring_fillet;
  return ToolBand(level_set_from_distance(d, {{-r, -r, -ring_fillet}, {r, r, ring_fillet}}, voxel,
                                          half_width / voxel + ToolBand::rim),
                  half_width);
}

// Whether the band does not know the distance.
bool beyond_band(const ToolBand& band, const Vector3d& x) {
  return !std::isfinite(evaluate(band, x).distance);
}

struct Error {
  double distance_rms = 0.0, distance_max = 0.0;    // [m]
  double angle_rms = 0.0, angle_max = 0.0;          // [rad]
  double length_max = 0.0;                          // | |n| - 1 |
  double curvature_rms = 0.0, curvature_max = 0.0;  // Frobenius norm [1/m]
};

// `exact` against the band at points where(random) gives; those with |d| > reach are left out.
template <class Exact, class Where>
Error error_of(const ToolBand& band, const Exact& exact, const Where& where, double reach) {
  std::mt19937 random(11);
  Error e;
  int count = 0;
  for (int n = 0; n < 20000; ++n) {
    const Vector3d x = where(random);
    const Distance truth = exact(x);
    if (std::abs(truth.distance) > reach) continue;
    const Distance found = evaluate(band, x);
    const double d = std::abs(found.distance - truth.distance);
    const double angle = std::atan2(found.normal.cross(truth.normal).norm(), found.normal.dot(truth.normal));
    const double curvature = (found.curvature - truth.curvature).norm();
    ++count;
    e.distance_rms += d * d;
    e.angle_rms += angle * angle;
    e.curvature_rms += curvature * curvature;
    e.distance_max = std::max(e.distance_max, d);
    e.angle_max = std::max(e.angle_max, angle);
    e.length_max = std::max(e.length_max, std::abs(found.normal.norm() - 1.0));
    e.curvature_max = std::max(e.curvature_max, curvature);
  }
  REQUIRE(count > 500);
  for (double* sum : {&e.distance_rms, &e.angle_rms, &e.curvature_rms}) *sum = std::sqrt(*sum / count);
  return e;
}

// Points in the box, even.
auto in_box(const Vector3d& low, const Vector3d& high) {
  return [low, high](std::mt19937& random) {
    std::uniform_real_distribution<double> share(0.0, 1.0);
    Vector3d x;
    for (int c = 0; c < 3; ++c) x[c] = low[c] + share(random) * (high[c] - low[c]);
    return x;
  };
}

auto near_ball(double reach) {
  return [reach](std::mt19937& random) {
    std::uniform_real_distribution<double> share(-1.0, 1.0);
    Vector3d n(share(random), share(random), -std::abs(share(random)));
    return Vector3d(n.normalized() * (ball_radius + reach * share(random)));
  };
}

}  // namespace

TEST_CASE(
    "the spline of a band errs by the third power of the voxel, its gradient by the second, its Hessian by "
    "the first",
    "[macroscale][tool_band]") {
  const auto order = [](double coarse, double fine) { return std::log2(coarse / fine); };
  const Error coarse = error_of(ball_band(1e-3), ball_distance, near_ball(1.95e-3), 1.95e-3);
  const Error fine = error_of(ball_band(0.5e-3), ball_distance, near_ball(1.95e-3), 1.95e-3);
  CHECK(order(coarse.distance_rms, fine.distance_rms) > 2.8);
  CHECK(order(coarse.angle_rms, fine.angle_rms) > 1.9);
  CHECK(order(coarse.curvature_rms, fine.curvature_rms) > 0.9);
  CHECK(fine.distance_max < 0.02e-6);
  CHECK(fine.angle_max < 0.01 * degree);
  CHECK(fine.length_max < 2e-4);
  CHECK(fine.curvature_max < 1.5);  // of 71 1/m
}

TEST_CASE("the band of a rounded edge follows a radius of twelve voxels", "[macroscale][tool_band]") {
  const RingShape ring{ring_fillet, ring_radius - ring_fillet, ring_fillet, true};
  const auto somewhere = in_box({0, 0, 0}, {28e-3, 28e-3, 8e-3});
  const auto over_the_fillet = [&](std::mt19937& random) {
    for (;;) {
      const Vector3d x = somewhere(random);
      if (std::hypot(x.x(), x.y()) < ring_radius) return x;
    }
  };
  const Error e = error_of(
      torus_band(0.5e-3), [&](const Vector3d& x) { return distance(ring, x); }, over_the_fillet, 1.95e-3);
  CHECK(e.distance_rms < 0.04e-6);
  CHECK(e.distance_max < 0.2e-6);
  CHECK(e.angle_rms < 0.02 * degree);
  CHECK(e.angle_max < 0.1 * degree);
  CHECK(e.length_max < 2e-3);
  CHECK(e.curvature_rms < 6.0);  // of up to 250 1/m
}

TEST_CASE("the band of a punch's mesh agrees with the hemisphere it stands for up to its facets",
          "[macroscale][tool_band]") {
  // Edges of 1.5 degrees: the facets' middles lie 20 mm (1 - cos 0.75 deg) = 1.7 um inside, each way.
  const TriangleMesh mesh = test::punch_mesh(20e-3, 30e-3, 60);
  const ToolBand band = tool_band(mesh, {.voxel = 0.5e-3, .half_width = 3e-3}, "tools.punch");
  const HemisphereShape punch{{0, 0, 0}, 20e-3};
  const Error e = error_of(
      band, [&](const Vector3d& x) { return distance(punch, x); },
      in_box({-24e-3, -24e-3, -4e-3}, {24e-3, 24e-3, 24e-3}), 2.9e-3);
  CHECK(e.distance_rms < 2.2e-6);
  CHECK(e.distance_max < 4e-6);
  CHECK(e.angle_rms < 0.1 * degree);
  CHECK(e.angle_max < 0.5 * degree);
  CHECK(e.length_max < 0.01);
  CHECK(e.curvature_rms < 15.0);  // facets of a voxel's size are seen
}

TEST_CASE("the band of a die's mesh agrees with the ring with fillet it stands for up to its facets",
          "[macroscale][tool_band][long]") {
  // 3 degrees on the fillet, 1.5 round the opening: 2.1 um outside and up to 2.4 um inside.
  const TriangleMesh mesh = test::die_mesh(22e-3, 6e-3, 45e-3, 15e-3, 30, 240);
  const ToolBand band = tool_band(mesh, {.voxel = 0.5e-3, .half_width = 3e-3}, "tools.die");
  const RingShape ring{0.0, 22e-3, 6e-3, true};
  const Error e = error_of(
      band, [&](const Vector3d& x) { return distance(ring, x); },
      in_box({0, 0, -10e-3}, {28e-3, 28e-3, 4e-3}), 2.8e-3);
  CHECK(e.distance_rms < 1.5e-6);
  CHECK(e.distance_max < 8e-6);
  CHECK(e.angle_rms < 0.25 * degree);
  CHECK(e.angle_max < 2.5 * degree);  // where fillet and flat meet the curvature jumps
  CHECK(e.curvature_rms < 40.0);
}

TEST_CASE("the band of a plate is the plane's distance up to the rounding of a float",
          "[macroscale][tool_band]") {
  const TriangleMesh mesh = test::box_mesh({-30e-3, -30e-3, -8e-3}, {30e-3, 30e-3, 0.0});
  const ToolBand band = tool_band(mesh, {.voxel = 0.5e-3, .half_width = 3e-3}, "tools.die");
  const PlaneShape plane;
  const Error e = error_of(
      band, [&](const Vector3d& x) { return distance(plane, x); },
      in_box({-20e-3, -20e-3, -2.9e-3}, {20e-3, 20e-3, 2.9e-3}), 2.9e-3);
  CHECK(e.distance_max < 1e-9);
  CHECK(e.angle_max < 1e-6);
  CHECK(e.curvature_max < 0.05);
}

TEST_CASE("value and slope of a band are continuous across voxels and bricks, the Hessian bounded",
          "[macroscale][tool_band]") {
  const double voxel = 0.5e-3;
  const ToolBand band = ball_band(voxel);
  const double e = 1e-12;
  std::mt19937 random(3);
  const auto where = near_ball(1.9e-3);
  int bricks_crossed = 0;
  for (int n = 0; n < 3000; ++n) {
    Vector3d x = where(random);
    const int axis = n % 3;
    const double border = std::floor(x[axis] / voxel) + 0.5;  // where the nearest voxel changes
    bricks_crossed += (static_cast<int>(border + 0.5) & 7) == 0;
    Vector3d below = x, above = x;
    below[axis] = border * voxel - e;
    above[axis] = border * voxel + e;
    const Distance a = evaluate(band, below), b = evaluate(band, above);
    if (!std::isfinite(a.distance) || std::abs(a.distance) > 1.9e-3) continue;
    REQUIRE(std::abs(a.distance - b.distance) < 3.0 * e);
    // The slope may change by the curvature times the way; 60 1/m is the sphere's, with the spline's own
    // jumps.
    REQUIRE((a.normal - b.normal).norm() < 2.0 * e * 200.0 + 1e-12);
    REQUIRE((a.curvature - b.curvature).norm() < 20.0);
  }
  CHECK(bricks_crossed > 200);
}

TEST_CASE("a band's normal is the slope of its distance, and its curvature the slope of the normal",
          "[macroscale][tool_band][derivative]") {
  const double voxel = 0.5e-3;
  const BandShape shape{std::make_shared<const ToolBand>(ball_band(voxel)), {0.01, -0.02, 0.3e-3}};
  std::mt19937 random(5);
  const auto where = near_ball(1.5e-3);
  for (int n = 0; n < 30; ++n) {
    Vector3d x = where(random) + shape.offset;
    // Clear of the borders of voxels, where the curvature jumps.
    for (int c = 0; c < 3; ++c)
      x[c] = voxel * (std::floor((x[c] - shape.offset[c]) / voxel) + 0.2) + shape.offset[c];
    const Distance at = distance(Shape(shape), x);
    REQUIRE(std::abs(at.distance) < 2e-3);
    for (int c = 0; c < 3; ++c) {
      const auto moved = [&](double t) {
        Vector3d y = x;
        y[c] = t;
        return distance(Shape(shape), y);
      };
      if (std::abs(at.normal[c]) > 1e-2) {
        CHECK(derivative_gap([&](double t) { return moved(t).distance; }, x[c], voxel, at.normal[c]) < 1e-7);
        CHECK(derivative_gap([&](double t) { return moved(t).distance; }, x[c], voxel, 1.01 * at.normal[c]) >
              1e-4);
      }
      for (int r = 0; r < 3; ++r) {
        const double h = 1e-3 * voxel;  // the slope is quadratic in a voxel: differences are exact
        const double difference = (moved(x[c] + h).normal[r] - moved(x[c] - h).normal[r]) / (2.0 * h);
        CHECK(at.curvature(r, c) == Approx(difference).margin(1e-5));
      }
    }
  }
}

TEST_CASE("contact with a band: the residual is the slope of the potential, the matrix that of the residual",
          "[macroscale][tool_band][derivative]") {
  const auto fabric = test::make_fabric({});
  Scene scene;
  scene.blank = make_blank({0.02, 0.02}, 0.005);
  scene.fabric = &fabric;
  // The apex stands 0.4 mm below the blank: the middle node and its neighbours are pressed.
  const BandShape punch{std::make_shared<const ToolBand>(ball_band(0.5e-3, 4e-3)),
                        {0, 0, ball_radius - 0.3e-3}};
  scene.tools = {{Role::punch, punch, Motion::driven, 0.0, 0.0}};
  const State state = initial_state(scene);
  StepData step;
  step.dt = 5e-3;
  step.start = &state;
  step.target = state.x;
  step.tool_z = {-0.1e-3};
  step.frictionless = true;
  System system(scene);
  std::mt19937 random(7);
  std::uniform_real_distribution<double> uniform(-1.0, 1.0);
  Eigen::VectorXd x = state.x, d = state.x;
  for (double& value : x) value += 1e-4 * uniform(random);
  for (double& value : d) value = uniform(random);
  int pressed = 0;
  for (int i = 0; i < scene.blank.nodes(); ++i)
    pressed += system.tool_contact(step, x, 0, i).normal.pressure > 0.0;
  REQUIRE(pressed >= 3);

  // Only what the tool adds: the blank itself is stiffer by orders.
  const auto compaction = [&](double t) { return system.potential(step, x + t * d).compaction; };
  Eigen::VectorXd force = Eigen::VectorXd::Zero(x.size()), bend = force;
  for (int i = 0; i < scene.blank.nodes(); ++i) {
    const ToolContact contact = system.tool_contact(step, x, 0, i);
    const double a = scene.blank.node_area[i];
    const Vector3d along = d.segment<3>(3 * i);
    force.segment<3>(3 * i) = -a * contact.normal.pressure * contact.surface.normal;
    bend.segment<3>(3 * i) =
        a * (contact.normal.stiffness * contact.surface.normal.dot(along) * contact.surface.normal -
             contact.normal.pressure * contact.surface.curvature * along);
  }
  CHECK(derivative_gap(compaction, 0.0, 1e-4, force.dot(d)) < 1e-6);
  CHECK(derivative_gap(compaction, 0.0, 1e-4, 1.001 * force.dot(d)) > 1e-4);
  const auto slope = [&](double t) {
    const Eigen::VectorXd y = x + t * d;
    double sum = 0.0;
    for (int i = 0; i < scene.blank.nodes(); ++i) {
      const ToolContact contact = system.tool_contact(step, y, 0, i);
      sum -= scene.blank.node_area[i] * contact.normal.pressure *
             contact.surface.normal.dot(d.segment<3>(3 * i));
    }
    return sum;
  };
  CHECK(derivative_gap(slope, 0.0, 1e-4, bend.dot(d)) < 1e-6);
  CHECK(derivative_gap(slope, 0.0, 1e-4, 1.001 * bend.dot(d)) > 1e-4);

  // And the whole system, as the solver sees it.
  const Eigen::VectorXd g = system.gradient(step, x);
  CHECK(derivative_gap([&](double t) { return system.potential(step, x + t * d).total(); }, 0.0, 1e-4,
                       g.dot(d)) < 1e-6);
}

TEST_CASE("beyond its band a tool is either far or an error, never 'no contact' inside",
          "[macroscale][tool_band]") {
  const ToolBand band = ball_band(0.5e-3);
  const double w = band.half_width();
  CHECK(w == 2e-3);
  CHECK(band.depth() >= w);
  // Along a line from the middle outwards.
  double before = -infinity;
  for (double r = 0.0; r < 0.06; r += 0.05e-3) {
    const Vector3d x = r * Vector3d(0.3, -0.5, 0.8).normalized();
    const Distance found = evaluate(band, x);
    CAPTURE(r, found.distance);
    CHECK(found.normal.allFinite());
    CHECK(found.curvature.allFinite());
    const double truth = r - ball_radius;
    if (truth < -w - 1e-6) {
      CHECK(found.distance == -infinity);
      CHECK(beyond_band(band, x));
      continue;
    }
    if (truth < -w + 1e-6) continue;
    CHECK_FALSE(beyond_band(band, x));
    CHECK(found.distance >= std::min(before, w));
    if (truth <= w) {
      CHECK(found.distance == Approx(truth).margin(2e-6));
    } else {
      CHECK(found.distance >= w - 1e-6);
      CHECK(found.distance <= truth + 0.1 * band.voxel());  // where the rim ends the spline swings a little
    }
    before = found.distance;
  }
  CHECK(evaluate(band, {1.0, 0.0, 0.0}).distance == Approx(1.0 - ball_radius).margin(10e-3));
  CHECK(evaluate(band, {1.0, 0.0, 0.0}).distance < 1.0 - ball_radius);
  CHECK(evaluate(band, {1e300, 0.0, 0.0}).distance > 1e200);
  const Vector3d nowhere(0.0, std::numeric_limits<double>::quiet_NaN(), 0.0);
  CHECK(std::isnan(evaluate(band, nowhere).distance));
  CHECK(beyond_band(band, nowhere));
}

TEST_CASE("pressed beyond the band, the contact energy is not finite, so no line search takes the step",
          "[macroscale][tool_band]") {
  const auto fabric = test::make_fabric({});
  Scene scene;
  scene.blank = make_blank({0.02, 0.02}, 0.01);
  scene.fabric = &fabric;
  scene.tools = {{Role::punch, BandShape{std::make_shared<const ToolBand>(ball_band(0.5e-3)), {0, 0, 0}},
                  Motion::driven, 0.0, 0.0}};
  const State state = initial_state(scene);
  StepData step;
  step.dt = 5e-3;
  step.start = &state;
  step.target = state.x;
  step.tool_z = {0.0};
  step.frictionless = true;
  System system(scene);
  CHECK_FALSE(std::isfinite(system.potential(step, state.x).compaction));
  step.tool_z = {0.05};
  CHECK(system.potential(step, state.x).compaction == 0.0);

  // A tool that jumps onto the blank in one step: the step is refused, and says who is where.
  State above = state, end;
  above.tool_z = {0.05};
  SolveOptions options;
  options.frictionless = true;
  const StepSummary refused = advance(system, above, 5e-3, {0.0}, nullptr, options, end, step);
  CHECK_FALSE(refused.converged);
  CHECK_THAT(refused.reason, Catch::Contains("node 0 at (-10, -10, 0) mm is deeper in the punch"));
}

TEST_CASE("a band of a region is the whole band there, and an error elsewhere",
          "[macroscale][tool_band][long]") {
  const TriangleMesh punch = test::punch_mesh(20e-3, 60e-3, 30);
  ToolBandSpec spec{.voxel = 0.5e-3, .half_width = 3e-3};
  const ToolBand whole = tool_band(punch, spec, "tools.punch");
  spec.region.high[2] = 30e-3;
  const ToolBand part = tool_band(punch, spec, "tools.punch");
  CHECK(10 * part.bricks() < 7 * whole.bricks());
  std::mt19937 random(3);
  const auto where = in_box({-25e-3, -25e-3, -5e-3}, {25e-3, 25e-3, 65e-3});
  int inside = 0, outside = 0;
  for (int n = 0; n < 20000; ++n) {
    const Vector3d x = where(random);
    const Distance expected = evaluate(whole, x), found = evaluate(part, x);
    if (x.z() <= spec.region.high[2]) {
      REQUIRE(found.distance == expected.distance);
      REQUIRE(found.normal == expected.normal);
      REQUIRE(part.rough_distance(x) == expected.distance);
      continue;
    }
    REQUIRE(found.distance == -infinity);
    REQUIRE(beyond_band(part, x));
    const double rough = part.rough_distance(x);
    REQUIRE(std::isinf(rough));
    inside += rough < 0.0;
    outside += rough > 0.0;
    if (rough < 0.0) REQUIRE(expected.distance < 0.0);
    const bool far_from_top = x.z() < 50e-3;
    const double depth = -distance(HemisphereShape{{0, 0, 0}, 20e-3}, x).distance;
    if (far_from_top && depth > 9e-3)
      REQUIRE(rough < 0.0);  // deeper than the diagonal of a block and its rim
  }
  CHECK(inside > 500);
  CHECK(outside > 500);
}

TEST_CASE("a sheet has a band on both sides, told by its normals", "[macroscale][tool_band]") {
  // The lower half of a ball as a bowl, normals downwards and outwards; far from its rim.
  test::Meridian meridian;
  test::add_arc(meridian, {0.0, 0.0}, ball_radius, -0.5 * std::numbers::pi, 0.0, 60);
  const TriangleMesh bowl = test::revolved(meridian, 240, false);
  CHECK_THROWS_AS(tool_band(bowl, {.voxel = 0.5e-3, .half_width = 2e-3}, "tools.punch"), InputError);
  const ToolBand band =
      tool_band(bowl, {.voxel = 0.5e-3, .half_width = 2e-3, .sides = Sides::open}, "tools.punch");
  std::mt19937 random(9);
  const auto where = near_ball(1.9e-3);
  for (int n = 0; n < 2000; ++n) {
    const Vector3d x = where(random);
    if (x.z() > -4e-3) continue;
    REQUIRE(evaluate(band, x).distance == Approx(x.norm() - ball_radius).margin(10e-6));
  }
  CHECK(beyond_band(band, {0.0, 0.0, -10e-3}));
  CHECK(evaluate(band, {0.0, 0.0, -30e-3}).distance >= 2e-3);
  CHECK(evaluate(band, {30e-3, 0.0, -10e-3}).distance >= 2e-3);
}

TEST_CASE("a band too large, too narrow or for a tool too thin is refused with the way out",
          "[macroscale][tool_band]") {
  const auto problem = [](const TriangleMesh& mesh, const ToolBandSpec& spec) -> std::string {
    try {
      tool_band(mesh, spec, "tools.die");
    } catch (const InputError& error) {
      REQUIRE(error.problems().size() == 1);
      CHECK_FALSE(error.problems().front().way_out.empty());
      return error.problems().front().id;
    }
    return "";
  };
  const TriangleMesh plate = test::box_mesh({-50e-3, -50e-3, -8e-3}, {50e-3, 50e-3, 0.0});
  CHECK(problem(plate, {.voxel = 1e-3, .half_width = 3e-3}) == "");
  CHECK(problem(plate, {.voxel = 0.01e-3, .half_width = 3e-3}) == "tools.die.voxel.memory");
  CHECK(problem(plate, {.voxel = 1e-3, .half_width = 5e-3}) == "tools.die.thin");
  CHECK(problem(plate, {.voxel = 0.0}) == "tools.die.voxel.range");
  CHECK(problem(plate, {.half_width = -1.0}) == "tools.die.band.range");
  CHECK(problem({}, {}) == "tools.die.empty");
  TriangleMesh open = plate;
  open.triangles.pop_back();
  CHECK(problem(open, {.voxel = 1e-3, .half_width = 3e-3}) == "tools.die.closed");
  TriangleMesh wild = plate;
  wild.vertices[3][1] = infinity;
  CHECK(problem(wild, {}) == "tools.die.finite");
  wild = plate;
  wild.triangles[3][1] = 8;
  CHECK(problem(wild, {}) == "tools.die.index");
  CHECK_THROWS_AS(ToolBand(level_set_from_mesh(plate, 1e-3, 3.0), 2e-3), std::invalid_argument);
  CHECK(required_half_width(0.6e-3, 1.5e-3, 1e-3) == Approx(3.1e-3));
}

TEST_CASE("a memory estimate is above what the band takes and within a factor of four",
          "[macroscale][tool_band]") {
  const TriangleMesh punch = test::punch_mesh(20e-3, 30e-3, 30);
  const ToolBandSpec spec{.voxel = 0.5e-3, .half_width = 3e-3};
  const ToolBand band = tool_band(punch, spec, "tools.punch");
  const LevelSet set = level_set_from_mesh(punch, spec.voxel, spec.half_width / spec.voxel + ToolBand::rim);
  const double taken = static_cast<double>(band.memory() + set.memory());
  CHECK(estimated_memory(punch, spec) > taken);
  CHECK(estimated_memory(punch, spec) < 4.0 * taken);
}
