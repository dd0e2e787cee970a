// Curves that are given in place of what the weave says of a fabric.
#include "pipeline/fabric_override.h"

#include <catch2/catch.hpp>

#include <cmath>
#include <fstream>
#include <numbers>

#include <fmt/format.h>

#include "macroscale/stamping.h"
#include "mesoscale/coupon_curves.h"
#include "pipeline/outputs.h"
#include "scratch.h"
#include "tests/macroscale/sample_fabric.h"
#include "tests/macroscale/sample_stamping.h"

using namespace heddle;
using heddle::test::Scratch;
using pipeline::FabricOverride;
namespace fs = std::filesystem;

namespace {

constexpr double degree = std::numbers::pi / 180.0;

mesoscale::CellResult sample() {
  mesoscale::CellResult result;
  result.fabric = test::make_fabric({});
  result.fabric.provenance.unverified = {"forming.tow_friction", "forming.bonding"};
  return result;
}

fs::path written(const fs::path& file, const std::string& text) {
  std::ofstream(file, std::ios::binary) << text;
  return file;
}

const std::string frame =
    "shear_angle_deg,shear_force_N_per_mm\n0,0\n10,0.004\n20,0.007\n35,0.015\n45,0.040\n55,0.16\n";

/// "rule:line" of everything wrong with the tables.
std::vector<std::string> refused(const FabricOverride& given) {
  std::vector<std::string> list;
  for (const Problem& problem : pipeline::check(given, 1.5e-3))
    list.push_back(fmt::format("{}:{}", problem.id.text(), problem.line));
  return list;
}

}  // namespace

TEST_CASE("with nothing given the fabric keeps its bits", "[pipeline][fabric]") {
  const mesoscale::CellResult weave = sample();
  const std::string before = pipeline::fabric_json(weave.fabric);
  CHECK(pipeline::fabric_json(pipeline::with_given(weave, {}).fabric) == before);
  FabricOverride nearly;
  nearly.shear_scale = 1.0 + 1e-12;
  CHECK(pipeline::fabric_json(pipeline::with_given(weave, nearly).fabric) != before);
}

TEST_CASE("a picture frame of a measured table gives the table's force back", "[pipeline][fabric]") {
  const Scratch scratch;
  FabricOverride given;
  given.shear = written(scratch / "frame.csv", frame);
  const auto fabric = pipeline::with_given(sample(), given).fabric;
  // Angles of the table, in the middle of others; the force of the machine follows from the power of the
  // frame.
  const std::vector<std::pair<double, double>> table{
      {10, 4.0}, {20, 7.0}, {35, 15.0}, {45, 40.0}, {55, 160.0}};
  const mesoscale::PictureFrame rig;
  for (const auto& [angle, force] : table) {
    const auto points = mesoscale::picture_frame(fabric, rig, {.highest = angle * degree, .points = 2});
    CHECK(points.back().normalised == Approx(force).epsilon(1e-12));
    const double half = 0.25 * std::numbers::pi - 0.5 * angle * degree;
    CHECK(points.back().force == Approx(force * std::cos(angle * degree) * rig.fabric_side * rig.fabric_side /
                                        (rig.side * std::sin(half)))
                                     .epsilon(1e-12));
  }
  // Monotone between the points, and beyond the last straight against the sine.
  const Curve& curve = fabric.shear_stress;
  CHECK(curve(std::sin(40 * degree)) > 15.0);
  CHECK(curve(std::sin(40 * degree)) < 40.0);
  const double end = std::sin(55 * degree), slope = curve.evaluate(end).slope;
  CHECK(curve(std::sin(60 * degree)) == Approx(160.0 + slope * (std::sin(60 * degree) - end)));
}

TEST_CASE("a bias extension of a measured table is that of its forces at the angle and at half of it",
          "[pipeline][fabric]") {
  const Scratch scratch;
  FabricOverride given;
  given.shear = written(scratch / "frame.csv", frame);
  const auto fabric = pipeline::with_given(sample(), given).fabric;
  const mesoscale::BiasExtension strip;
  const double g = 20 * degree, w = strip.width, h = strip.length, d = h - w;
  const auto at = mesoscale::bias_extension(fabric, strip, {.highest = g, .points = 2}).back();
  const double middle = 7.0 * std::cos(g), quarters = 4.0 * std::cos(0.5 * g);
  CHECK(at.force == Approx((w * (2 * h - 3 * w) * middle + w * w * quarters) /
                           (d * (std::cos(0.5 * g) - std::sin(0.5 * g))))
                        .epsilon(1e-12));
}

TEST_CASE("curves written from a fabric and read back stamp the same part", "[pipeline][fabric]") {
  const Scratch scratch;
  mesoscale::CellResult weave = sample();
  std::vector<double> sine, stress;
  for (int k = 0; k <= 40; ++k) {
    sine.push_back(0.9 * k / 40.0);
    stress.push_back(60.0 * sine.back() + 200.0 * std::pow(sine.back(), 5));
  }
  weave.fabric.shear_stress = Curve(sine, stress);
  std::string shear = "shear_angle_deg,shear_force_N_per_mm\n", compaction = "thickness_mm,pressure_kPa\n";
  for (std::size_t k = 0; k < sine.size(); ++k)
    shear += fmt::format("{},{}\n", std::asin(sine[k]) / degree, 1e-3 * stress[k]);
  const Curve& pressed = weave.fabric.compaction.curves().front();
  for (std::size_t k = 0; k < pressed.x().size(); ++k)
    compaction +=
        fmt::format("{},{}\n", 1e3 * (weave.fabric.thickness - 2.0 * pressed.x()[k]), 1e-3 * pressed.y()[k]);
  FabricOverride given;
  given.shear = written(scratch / "shear.csv", shear);
  given.compaction = written(scratch / "compaction.csv", compaction);
  given.bending = {1e-3, 1e-3};
  const mesoscale::CellResult back = pipeline::with_given(weave, given);
  const auto spec = test::coarse_stamping(6);
  const auto law = test::coulomb();
  const auto one = macroscale::run_stamping(spec, weave.fabric, law),
             other = macroscale::run_stamping(spec, back.fabric, law);
  REQUIRE(one.summary.completed);
  REQUIRE(other.summary.completed);
  CHECK(other.summary.peak_punch_force == Approx(one.summary.peak_punch_force).epsilon(1e-7));
  CHECK(other.summary.shear_angle_max == Approx(one.summary.shear_angle_max).epsilon(1e-7));
  CHECK(other.summary.draw_in_max == Approx(one.summary.draw_in_max).epsilon(1e-7));
  // The same by tables that are one per cent off is seen.
  given.shear_scale = 1.01;
  const auto off = macroscale::run_stamping(spec, pipeline::with_given(weave, given).fabric, law);
  CHECK(off.summary.peak_punch_force != Approx(one.summary.peak_punch_force).epsilon(1e-7));
}

TEST_CASE("measured tensions come back within a step of the strain grid, each tow by itself",
          "[pipeline][fabric]") {
  const Scratch scratch;
  FabricOverride given;
  // Tows that straighten, then carry: 0, 20, 100, 300 N/mm and half of it.
  given.tension = written(scratch / "tension.csv",
                          "strain,warp_tension_N_per_mm,weft_tension_N_per_mm\n0,0,0\n0.005,5,2.5\n"
                          "0.01,30,15\n0.02,180,90\n0.03,360,180\n");
  const auto weave = sample();
  // A table of as many points as that of a weave.
  mesoscale::CellResult fine = weave;
  constexpr int n = 301;
  const double step = 0.05 / (n - 1);
  std::vector<double> w;
  for (int i = 0; i < n; ++i)
    for (int j = 0; j < n; ++j) {
      const double a = -0.02 + step * i, b = -0.02 + step * j;
      w.push_back(0.5 * 5.9e6 * (a * a + b * b));
    }
  fine.fabric.tension_energy = Surface(-0.02, step, n, -0.02, step, n, w);
  const Surface energy = pipeline::with_given(fine, given).fabric.tension_energy;
  // The spline's tension is the table's averaged over a step either way: off by its slope's change over a
  // step.
  const std::vector<std::array<double, 3>> table{
      {0.005, 5e3, 2.5e3}, {0.01, 30e3, 15e3}, {0.02, 180e3, 90e3}, {0.03, 360e3, 180e3}};
  for (const auto& [strain, warp, weft] : table) {
    const double most = 1.8e7 * 0.5 * energy.dx();  // steepest slope of the table times half a step
    CAPTURE(strain, energy.evaluate(strain, 0.0).fx, most);
    CHECK(std::abs(energy.evaluate(strain, 0.0).fx - warp) < most);
    CHECK(std::abs(energy.evaluate(0.01, strain).fy - weft) < most);
    CHECK(std::abs(energy.evaluate(strain, strain).fxy) < 1e-6 * 1.8e7);
  }
  CHECK(std::abs(energy.evaluate(0.0, 0.0).fx) < 1e-6 * 360e3);
  CHECK(std::abs(energy.evaluate(0.0, 0.0).fy) < 1e-6 * 360e3);
  // Shortened, the tow goes on by the weave's curve.
  CHECK(energy.evaluate(-0.01, 0.0).fx == Approx(-0.01 * 5.9e6).epsilon(0.02));
}

TEST_CASE("factors scale tension and shear, and provenance says all that was given", "[pipeline][fabric]") {
  const Scratch scratch;
  const mesoscale::CellResult weave = sample();
  FabricOverride given;
  given.shear = written(scratch / "frame.csv", frame);
  given.bending[1] = 2e-3;
  given.shear_scale = 10.0;
  given.tension_scale = 0.1;
  const auto fabric = pipeline::with_given(weave, given).fabric;
  CHECK(fabric.shear_stress(std::sin(20 * degree)) == Approx(70.0));
  CHECK(fabric.tension_energy.evaluate(0.01, 0.005).fx ==
        Approx(0.1 * weave.fabric.tension_energy.evaluate(0.01, 0.005).fx));
  CHECK(fabric.bending[0](400.0) == weave.fabric.bending[0](400.0));
  CHECK(fabric.bending[1](400.0) == 2e-3);
  const std::vector<std::string> said = pipeline::in_words(given);
  CHECK(said == std::vector<std::string>{"shear: frame.csv", "bending along weft: 2 N mm", "shear: times 10",
                                         "tension: times 0.1"});
  CHECK(fabric.provenance.unverified == std::vector<std::string>{"forming.bonding"});
  const std::string json = pipeline::fabric_json(fabric, said);
  CHECK_THAT(json, Catch::Contains("shear: frame.csv"));
  CHECK(pipeline::fabric_json(pipeline::read_fabric_json(json, "fabric.json"), said) == json);
}

TEST_CASE("a table that no fabric has is refused by its rows", "[pipeline][fabric][wrong input]") {
  const Scratch scratch;
  FabricOverride given;
  given.shear = written(scratch / "a.csv",
                        "shear_angle_deg,shear_force_N_per_mm\n1,0.1\n10,0.2\n9,0.3\n20,0.1\n91,0.4\n");
  given.compaction = written(scratch / "b.csv", "thickness_mm,pressure_kPa\n1.4,0\n1.2,10\n1.3,20\n");
  given.tension =
      written(scratch / "c.csv", "strain,warp_tension_N_per_mm,weft_tension_N_per_mm\n0,0,0\n1,5,0\n3,9,0\n");
  CHECK(refused(given) == std::vector<std::string>{"fabric.file.start:2", "fabric.file.order:4",
                                                   "fabric.file.monotone:5", "fabric.file.last:6",
                                                   "fabric.file.nothing:4", "fabric.file.last:4",
                                                   "fabric.file.start:2", "fabric.file.order:4"});
  CHECK_THROWS_AS(pipeline::with_given(sample(), given), InputError);
}
