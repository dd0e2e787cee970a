// Measured shear tests: read, reduced to the shear flow of the laws, compared with a case's fabric.
#include "pipeline/shear_tests.h"

#include <fmt/format.h>

#include <algorithm>
#include <catch2/catch.hpp>
#include <cmath>
#include <numbers>

#include "pipeline/discover_shear.h"
#include "pipeline/outputs.h"
#include "tests/macroscale/sample_fabric.h"
#include "tests/pipeline/scratch.h"
#include "tests/source_dir.h"

using namespace heddle;
using namespace heddle::pipeline;

namespace {

constexpr double degree = std::numbers::pi / 180.0;
using Ids = std::vector<std::string>;

const std::string frame_header =
    "test,condition_id,sample_id,frame_side_mm,fabric_side_mm,speed_mm_s,fabric_temperature_C,displacement_"
    "mm,"
    "force_N\n";
const std::string strip_header =
    "test,condition_id,sample_id,strip_length_mm,strip_width_mm,speed_mm_s,fabric_temperature_C,displacement_"
    "mm,"
    "force_N\n";

std::string frame_lines(const mesoscale::FabricProperties& fabric, const std::string& sample,
                        double factor = 1.0) {
  std::string text;
  for (const mesoscale::CouponPoint& p : mesoscale::picture_frame(
           fabric, {.side = 0.25, .fabric_side = 0.18},
           {.speed = 1e-3, .temperature = 453.15, .highest = 52.0 * degree, .points = 26}))
    text += fmt::format("picture_frame,hot,{},250,180,1,180,{:.9g},{:.9g}\n", sample, 1e3 * p.displacement,
                        factor * p.force);
  return text;
}

std::string strip_lines(const mesoscale::FabricProperties& fabric, int points) {
  std::string text;
  for (const mesoscale::CouponPoint& p : mesoscale::bias_extension(
           fabric, {.length = 0.3, .width = 0.1}, {.highest = 45.0 * degree, .points = points}))
    text += fmt::format("bias_extension,slow,a,300,100,1,180,{:.9g},{:.9g}\n", 1e3 * p.displacement, p.force);
  return text;
}

Ids problems_of(const std::string& text) {
  Ids ids;
  try {
    parse_shear_tests(text, "x.csv");
  } catch (const InputError& error) {
    for (const Problem& problem : error.problems()) ids.push_back(problem.id.text());
  }
  return ids;
}

std::string frame_curve(const std::string& sample, double side = 250.0, double fabric = 180.0,
                        double way = 1.0, double force = 1.0) {
  std::string text;
  for (int k = 1; k <= 5; ++k)
    text += fmt::format("picture_frame,hot,{},{},{},1,180,{},{}\n", sample, side, fabric, way * 10.0 * k,
                        force * k);
  return text;
}

}  // namespace

TEST_CASE("a picture frame that the laws predict is reduced to the laws again, rate and all",
          "[pipeline][discover][shear tests]") {
  const mesoscale::FabricProperties fabric = test::make_fabric({.rate_consistency = 30.0});
  const auto curves = parse_shear_tests(frame_header + frame_lines(fabric, "a"), "x.csv");
  REQUIRE(curves.size() == 1);
  REQUIRE(curves[0].points.size() == 25);  // at rest nothing is known
  for (const ShearPoint& p : curves[0].points) {
    CHECK(p.flow == Approx(mesoscale::shear_flow(fabric, p.shear_angle, p.shear_rate, 453.15)).epsilon(1e-6));
    CHECK(p.flow != Approx(mesoscale::shear_flow(fabric, p.shear_angle, 0.0, 453.15)).epsilon(1e-2));
  }
  CHECK(curves[0].points.back().shear_angle == Approx(52.0 * degree).epsilon(1e-6));
}

TEST_CASE("a bias extension comes back to the laws as its points grow denser",
          "[pipeline][discover][shear tests]") {
  const mesoscale::FabricProperties fabric = test::make_fabric({});
  const auto error_with = [&](int points) {
    double worst = 0.0;
    const auto curves = parse_shear_tests(strip_header + strip_lines(fabric, points), "x.csv");
    for (const ShearPoint& p : curves[0].points)
      if (p.shear_angle > 10.0 * degree)
        worst = std::max(worst,
                         std::abs(p.flow / mesoscale::shear_flow(fabric, p.shear_angle, 0.0, 453.15) - 1.0));
    return worst;
  };
  const double coarse = error_with(16), fine = error_with(61);
  CHECK(coarse < 0.02);
  CHECK(fine < coarse / 8.0);  // straight pieces: with the square of the spacing
}

TEST_CASE("an angle that was measured takes the place of the crosshead's",
          "[pipeline][discover][shear tests]") {
  std::string text = frame_header;
  text.insert(text.size() - 1, ",shear_angle_deg");
  for (int k = 1; k <= 4; ++k)
    text += fmt::format("picture_frame,hot,a,250,250,1,180,{},{},{}\n", 10 * k, k, 4 * k);
  const auto curves = parse_shear_tests(text, "x.csv");
  CHECK(curves[0].points[2].shear_angle == Approx(12.0 * degree));
}

TEST_CASE("gap of a table of shear tests: mean, scatter and model at the same angles",
          "[pipeline][discover][shear tests]") {
  const mesoscale::FabricProperties fabric = test::make_fabric({});
  const auto curves = parse_shear_tests(
      frame_header + frame_lines(fabric, "a", 1.1) + frame_lines(fabric, "b", 1.3), "x.csv");
  const std::vector<ShearGap> gaps = shear_gaps(curves, fabric);
  REQUIRE(gaps.size() == 10);  // 5 to 50 deg
  for (const ShearGap& gap : gaps) {
    CHECK(gap.samples == 2);
    CHECK(gap.measured == Approx(1.2 * gap.model).epsilon(2e-3));
    CHECK(gap.scatter == Approx(0.2 / std::sqrt(2.0) * gap.model).epsilon(2e-2));
  }
}

TEST_CASE("a table of shear tests is refused with every problem and its line",
          "[pipeline][discover][shear tests][wrong input]") {
  CHECK(problems_of(frame_header + frame_curve("a")).empty());
  CHECK(problems_of("test,torque\nx,1\n") ==
        Ids{"discover.shear.column.unknown", "discover.shear.column.missing", "discover.shear.column.missing",
            "discover.shear.column.missing", "discover.shear.column.missing", "discover.shear.column.missing",
            "discover.shear.column.missing"});
  CHECK(
      problems_of("test,test,condition_id,sample_id,speed_mm_s,fabric_temperature_C,displacement_mm,force_N\n"
                  "a,a,c,s,1,180,1,1\n") == Ids{"discover.shear.column.twice"});
  CHECK(problems_of(frame_header) == Ids{"discover.shear.empty"});
  CHECK(problems_of(frame_header + "picture_frame,hot,a,250,180,1,180,x,\n") ==
        Ids{"discover.shear.number", "discover.shear.number"});
  CHECK(problems_of(frame_header + frame_curve("a", 0.0, 0.0)) == Ids{"discover.shear.size"});
  CHECK(problems_of(frame_header + frame_curve("a", 250.0, 300.0)) == Ids{"discover.shear.fabric"});
  CHECK(problems_of(frame_header + frame_curve("a", 250.0, 180.0, 4.0)) == Ids{"discover.shear.reach"});
  CHECK(problems_of(frame_header + frame_curve("a", 250.0, 180.0, 1e-3)) ==
        Ids{"discover.shear.unit.displacement"});
  CHECK(problems_of(frame_header + frame_curve("a", 250.0, 180.0, 1.0, 1e-3)) ==
        Ids{"discover.shear.unit.force"});
  const std::string once = "picture_frame,hot,b,250,180,1,180,20,3\n";
  CHECK(problems_of(frame_header + frame_curve("a") + once) == Ids{"discover.shear.short"});
  CHECK(problems_of(frame_header + frame_curve("a") + frame_curve("a")) == Ids{"discover.shear.curve"});
  std::string strip;
  for (int k = 1; k <= 4; ++k) strip += fmt::format("bias_extension,c,a,150,100,0,180,{},1\n", k);
  CHECK(problems_of(strip_header + strip) == Ids{"discover.shear.strip", "discover.shear.speed"});
  std::string other;
  for (int k = 1; k <= 4; ++k) other += fmt::format("torsion,c,a,150,100,1,180,{},1\n", k);
  CHECK(problems_of(strip_header + other) == Ids{"discover.shear.test"});
}

TEST_CASE("the command leaves measured and predicted flow of every point, and names nothing",
          "[pipeline][discover][shear tests]") {
  const test::Scratch scratch;
  write_file(scratch / "frames.csv",
             frame_header + frame_curve("a") + frame_curve("b", 250.0, 180.0, 1.0, 1.2));
  DiscoverOptions options;
  options.run.file = std::filesystem::path(test::source_dir) / "configs/unit_cell.yaml";
  options.run.output = scratch / "out";
  options.run.print = false;
  options.data = scratch / "frames.csv";
  REQUIRE(discover_shear(options) == exit_done);
  const std::string points = read_file(scratch / "out/discover/shear_tests.csv");
  CHECK(std::ranges::count(points, '\n') == 11);  // a header, and five points of two pieces
  const std::string gaps = read_file(scratch / "out/discover/shear_gap.csv");
  CHECK_THAT(gaps, Catch::Contains("picture_frame,hot,10,2,"));
}

TEST_CASE("shear tests of a case without a weave are refused",
          "[pipeline][discover][shear tests][wrong input]") {
  DiscoverOptions options;
  options.run.file = std::filesystem::path(test::source_dir) / "configs/discover/friction.yaml";
  try {
    discover_shear(options);
    FAIL("was taken");
  } catch (const InputError& error) {
    REQUIRE(error.problems().size() == 1);
    CHECK(error.problems()[0].id.text() == "discover.shear.case");
  }
}
