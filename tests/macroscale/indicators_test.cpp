#include "macroscale/indicators.h"

#include <catch2/catch.hpp>
#include <cmath>
#include <functional>
#include <numbers>

#include <Eigen/Geometry>

#include "sample_fabric.h"

using namespace heddle;
using namespace heddle::macroscale;
using Eigen::Vector3d;

namespace {

constexpr int cells = 16;
constexpr double h = 5e-3;  // [m]

// A grid of `cells` cells whose nodes stand where `place` puts them; strain and shear are uniform.
BlankState state(const std::function<Vector3d(double x, double y)>& place,
                 std::array<double, 2> strain = {0.0, 0.0}, double shear = 0.0) {
  BlankState blank;
  blank.nu = blank.nv = cells;
  for (int i = 0; i <= cells; ++i)
    for (int j = 0; j <= cells; ++j) {
      const Vector3d x = place(h * i, h * j);
      blank.grid.push_back({i, j});
      blank.reference.push_back({h * i, h * j});
      blank.position.push_back({x.x(), x.y(), x.z()});
      blank.tow_strain.push_back(strain);
      blank.shear_angle.push_back(shear);
    }
  return blank;
}

double value(const BlankState& blank, const std::string& name, const mesoscale::FabricProperties& fabric) {
  for (const LargestIndicator& i : largest(indicators(blank, fabric), blank))
    if (i.name == name) return i.value;
  FAIL("no indicator " << name);
  return 0.0;
}

Vector3d flat(double x, double y) {
  return {x, y, 0.0};
}

}  // namespace

TEST_CASE("a wave two or four spacings long has its amplitude as wrinkle height, one of eight a quarter",
          "[indicators]") {
  const auto fabric = test::make_fabric({});
  constexpr double amplitude = 1e-4;
  const auto height = [&](double length) {
    // Crests on nodes: half a length is a whole number of spacings.
    return value(state([&](double x, double y) {
                   return Vector3d(x, y, amplitude * std::cos(2.0 * std::numbers::pi * x / length));
                 }),
                 "wrinkle_height_max", fabric);
  };
  CHECK(height(2.0 * h) == Approx(1e3 * amplitude).epsilon(1e-9));
  CHECK(height(4.0 * h) == Approx(1e3 * amplitude).epsilon(1e-9));
  CHECK(height(8.0 * h) == Approx(0.25e3 * amplitude).epsilon(1e-6));
}

TEST_CASE("a paraboloid has no wrinkle, a cylinder of 70 mm next to none, and a fillet less than the floor",
          "[indicators]") {
  const auto fabric = test::make_fabric({});
  const auto height = [&](const std::function<Vector3d(double, double)>& place) {
    return 1e-3 * value(state(place), "wrinkle_height_max", fabric);
  };
  CHECK(height([](double x, double y) { return Vector3d(x, y, 3.0 * x * x - 2.0 * x * y + y * y); }) < 1e-12);
  constexpr double radius = 0.07;
  CHECK(height([](double x, double y) {
          return Vector3d(radius * std::sin((x - 8 * h) / radius), y,
                          radius * (std::cos((x - 8 * h) / radius) - 1.0));
        }) < 2e-6);
  // Flat, then an arc of 20 mm: curvature begins at once, wherever between two nodes.
  constexpr double fillet = 0.02;
  double worst = 0.0;
  for (const double begin : {0.0, 0.25, 0.5, 0.75}) {
    const double at = (6.0 + begin) * h;
    worst = std::max(worst, height([at](double x, double y) -> Vector3d {
                       const double s = std::min(std::max(x - at, 0.0), 0.5 * fillet);
                       return x <= at ? Vector3d(x, y, 0.0)
                                      : Vector3d(at + fillet * std::sin(s / fillet), y,
                                                 -fillet * (1.0 - std::cos(s / fillet))) +
                                            (x - at - s) * Vector3d(std::cos(0.5), 0.0, -std::sin(0.5));
                     }));
  }
  CHECK(worst < wrinkle_floor(h, fillet, 0.0));
  CHECK(worst > 0.1 * wrinkle_floor(h, fillet, 0.0));  // the floor is no wide margin
}

TEST_CASE("wrinkle height is the same however the sheet is turned", "[indicators]") {
  const auto fabric = test::make_fabric({});
  const Eigen::Matrix3d turn = (Eigen::AngleAxisd(0.7, Vector3d(1, 2, 3).normalized())).toRotationMatrix();
  const auto bumpy = [](double x, double y) {
    return Vector3d(x, y, 2e-4 * std::sin(900.0 * x) * std::cos(500.0 * y));
  };
  const double lying = value(state(bumpy), "wrinkle_height_max", fabric);
  const double turned = value(
      state([&](double x, double y) -> Vector3d { return turn * bumpy(x, y) + Vector3d(0.1, 0.2, 0.3); }),
      "wrinkle_height_max", fabric);
  CHECK(lying > 0.01);
  CHECK(turned == Approx(lying).epsilon(1e-9));
}

TEST_CASE("straight tows at the breaking strain of glass carry a load of one, slack tows none",
          "[indicators]") {
  const auto fabric = test::make_fabric({});  // n = EA e: straight from the start
  const auto load = [&](std::array<double, 2> strain) {
    return value(state(flat, strain), "tow_load_max", fabric);
  };
  CHECK(load({glass_breaking_strain, 0.0}) == Approx(1.0));
  CHECK(load({0.0, 0.5 * glass_breaking_strain}) == Approx(0.5));
  CHECK(load({-0.01, -0.02}) == 0.0);
  CHECK(value(state(flat, {-0.01, -0.02}), "tow_compression_max", fabric) == Approx(0.02));
}

TEST_CASE("tows part as the others stretch, and close and thicken as one over the cosine in shear",
          "[indicators]") {
  const auto fabric = test::make_fabric({});
  const double pitch = 1e3 * fabric.pitch[0];  // [mm]
  CHECK(value(state(flat, {0.0, 0.02}), "gap_opening_max", fabric) == Approx(0.02 * pitch));
  CHECK(indicators(state(flat, {0.0, 0.02}), fabric).gap_opening[0][1] == Approx(0.0).margin(1e-15));
  const BlankState sheared = state(flat, {0.0, 0.0}, 0.6);
  CHECK(value(sheared, "gap_opening_max", fabric) == Approx(pitch * (std::cos(0.6) - 1.0)));
  CHECK(value(sheared, "thickening_max", fabric) == Approx(1.0 / std::cos(0.6)));
  // Volume of the solid stays: thickness times area.
  const BlankState all = state(flat, {0.01, -0.005}, -0.4);
  CHECK(value(all, "thickening_min", fabric) * 1.01 * 0.995 * std::cos(0.4) == Approx(1.0));
}
