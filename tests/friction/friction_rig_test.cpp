#include <catch2/catch.hpp>
#include <cmath>
#include <vector>

#include "friction/friction_test.h"

using namespace heddle::friction;

namespace {

const Model coulomb{.law = Coulomb{0.3}, .film = {}, .effects = {}, .box = {}};
const Model stribeck{
    .law = HerseyPower{.scale = 0.325, .exponent = 0.136}, .film = {}, .effects = {}, .box = {}};

FrictionTestRow pull(double velocity, double normal_force) {
  FrictionTestRow row;
  row.name = "pull";
  row.velocity = velocity;
  row.normal_force = normal_force;
  return row;
}

}  // namespace

TEST_CASE("a sled with constant mu is pulled with twice mu times the normal force", "[friction][analytic]") {
  const double normal_force = GENERATE(218.0, 343.0, 1000.0, 1069.0, 1500.0, 3000.0, 4000.0);
  const double velocity = GENERATE(1.66e-3, 83.3e-3);
  const FrictionTestResult result = run_friction_test(coulomb, pull(velocity, normal_force), {});
  CHECK(result.pull_force == 2.0 * 0.3 * normal_force);
  CHECK(effective_coefficient(result.pull_force, normal_force) == Approx(0.3).epsilon(1e-15));
}

TEST_CASE("the pressure under the plate is the normal force over its area", "[friction][analytic]") {
  const FrictionRig rig{.plate_area = 0.02};
  CHECK(contact_of(pull(0.01, 3000.0), rig).pressure == 150e3);
}

TEST_CASE("the same pressure under a larger plate gives the same mu", "[friction][invariant]") {
  const FrictionRig small{.plate_area = 0.01}, large{.plate_area = 0.02};
  CHECK(run_friction_test(stribeck, pull(0.01, 1500.0), small).mu ==
        run_friction_test(stribeck, pull(0.01, 3000.0), large).mu);
}

TEST_CASE("less real contact area lowers mu as a higher load does", "[friction][invariant]") {
  const AreaFunction half = [](double) { return std::pair{0.5, 0.0}; };
  const double real = run_friction_test(stribeck, pull(0.01, 1500.0), {}, half).mu;
  CHECK(real < run_friction_test(stribeck, pull(0.01, 1500.0), {}).mu);
  CHECK(real == Approx(run_friction_test(stribeck, pull(0.01, 3000.0), {}).mu).epsilon(1e-9));
}

TEST_CASE("the error of a friction test is the share of the measured force", "[friction][analytic]") {
  FrictionTestRow measured = pull(0.01, 1000.0);
  measured.measured_force = 500.0;
  std::vector rows{measured, pull(0.01, 1000.0), measured};
  rows[2].measured_force = 750.0;
  const auto results = run_friction_tests(coulomb, rows, {});
  CHECK(*results[0].relative_error == Approx(0.2));
  CHECK_FALSE(results[1].relative_error.has_value());
  CHECK(*results[2].relative_error == Approx(-0.2));
  CHECK(*rms_relative_error(results) == Approx(0.2));
  CHECK_FALSE(rms_relative_error(run_friction_tests(coulomb, std::vector{pull(0.01, 1.0)}, {})).has_value());
}

TEST_CASE("a pull outside the calibrated box is marked", "[friction]") {
  Model model = stribeck;
  model.box.speed_high = 0.05;
  CHECK(run_friction_test(model, pull(0.05, 1500.0), {}).calibrated);
  CHECK_FALSE(run_friction_test(model, pull(0.06, 1500.0), {}).calibrated);
}

TEST_CASE("the Stribeck curve of a power law is a straight line in its logarithms", "[friction][analytic]") {
  const auto points = stribeck_curve(stribeck, pull(0.01, 1500.0), {}, {1e-3, 1.0}, 31);
  REQUIRE(points.size() == 31);
  CHECK(points.front().speed == 1e-3);
  CHECK(points.back().speed == Approx(1.0).epsilon(1e-14));
  for (const CurvePoint& point : points) {
    CHECK(point.mu == Approx(0.325 * std::pow(point.hersey, 0.136)).epsilon(1e-12));
  }
}

TEST_CASE("a friction test table is read into SI, columns in any order", "[friction]") {
  const auto rows = parse_friction_table(
      "# pulls of one day\r\n"
      "normal_force_N,case,velocity_mm_s,fabric_temperature_C,tool_temperature_C,force_measured_N,"
      "orientation_deg\r\n"
      "\r\n"
      "1500, slow ,16.67,180,85,843,90\r\n"
      "3000,fast,41.67,180,140,,\r\n",
      "pulls.csv");
  REQUIRE(rows.size() == 2);
  CHECK(rows[0].name == "slow");
  CHECK(rows[0].velocity == 16.67e-3);
  CHECK(rows[0].normal_force == 1500.0);
  CHECK(rows[0].tool_temperature == 358.15);
  CHECK(rows[0].fabric_temperature == 453.15);
  CHECK(rows[0].orientation == Approx(std::acos(0.0)));
  CHECK(*rows[0].measured_force == 843.0);
  CHECK_FALSE(rows[0].paper_model_force.has_value());
  CHECK_FALSE(rows[1].measured_force.has_value());
  CHECK(rows[1].orientation == 0.0);
}

TEST_CASE("a written friction test table reads back", "[friction][invariant]") {
  FrictionTestRow row = pull(16.67e-3, 1069.0);
  row.orientation = std::acos(0.0) / 3.0;
  row.tool_temperature = 294.15;
  row.measured_force = 612.25;
  const std::vector rows{row, pull(1.66e-3, 218.0)};
  const auto results = run_friction_tests(stribeck, rows, {});
  const std::string text = format_friction_table(rows, results);
  CHECK(text.starts_with(
      "case,velocity_mm_s,normal_force_N,tool_temperature_C,fabric_temperature_C,orientation_deg,"
      "friction_coefficient,pull_force_N,force_measured_N,force_paper_model_N,force_error\n"
      "pull,16.67,1069,21,180,"));
  const auto back = parse_friction_table(text, "written.csv");
  REQUIRE(back.size() == 2);
  for (std::size_t i = 0; i < 2; ++i) {
    CHECK(back[i].name == rows[i].name);
    CHECK(back[i].velocity == rows[i].velocity);
    CHECK(back[i].normal_force == rows[i].normal_force);
    CHECK(back[i].tool_temperature == rows[i].tool_temperature);
    CHECK(back[i].fabric_temperature == rows[i].fabric_temperature);
    CHECK(back[i].orientation == Approx(rows[i].orientation).epsilon(1e-14));
    CHECK(back[i].measured_force == rows[i].measured_force);
    CHECK(back[i].paper_model_force == rows[i].paper_model_force);
  }
}
