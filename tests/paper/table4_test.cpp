// Friction tests of Gorczyca, Sherwood & Chen: Table 4 (four pulls) and the conditions of Table 2.

#include <array>
#include <catch2/catch.hpp>
#include <cmath>
#include <fstream>
#include <map>
#include <sstream>
#include <string>
#include <vector>

#include "friction/calibrate.h"
#include "tests/source_dir.h"

using namespace heddle::friction;

namespace {

using Form = ToolTemperatureShift::Form;

const std::string data_folder = std::string(heddle::test::source_dir) + "/tests/paper/data/";

std::vector<FrictionTestRow> table4() {
  return read_friction_table(data_folder + "friction_table4.csv");
}

Model form_of(const Law& law, Form form = Form::term) {
  return {.law = law,
          .film = {},  // n = 0.38 of polypropylene
          .effects = {.tool_temperature_shift = ToolTemperatureShift{.slope = 0.0, .form = form}},
          .box = {}};
}

const Law power_form = HerseyPower{}, linear_form = HerseyLinear{};

/// Change of mu from the first row to another [-].
double contrast(const Calibration& calibration, std::size_t row) {
  return calibration.rows[row].mu / calibration.rows[0].mu - 1.0;
}

/// Values of one parameter of Table 2, baseline first, in the unit of the file.
std::map<std::string, std::vector<double>> table2() {
  std::ifstream file(data_folder + "friction_table2_design.csv");
  REQUIRE(file);
  std::map<std::string, std::vector<double>> design;
  std::string line;
  std::getline(file, line);
  REQUIRE(line == "parameter,unit,baseline,additional");
  while (std::getline(file, line)) {
    std::stringstream cells(line);
    std::string name, unit, baseline, additional, value;
    std::getline(cells, name, ',');
    std::getline(cells, unit, ',');
    std::getline(cells, baseline, ',');
    std::getline(cells, additional);
    design[name].push_back(std::stod(baseline));
    for (std::stringstream list(additional); std::getline(list, value, ';');)
      design[name].push_back(std::stod(value));
  }
  return design;
}

/// Every combination of Table 2, and beyond it the lowest pressure under a binder (5 kPa) and the fastest
/// punch (326 mm/s).
struct Table2Box {
  std::vector<double> speed, pressure, fabric, tool;
};
Table2Box table2_box(double plate_area) {
  auto design = table2();
  Table2Box box;
  for (const double v : design.at("velocity")) box.speed.push_back(1e-3 * v);
  for (const double n : design.at("normal_force")) box.pressure.push_back(n / plate_area);
  for (const double t : design.at("fabric_temperature")) box.fabric.push_back(t + 273.15);
  for (const double t : design.at("tool_temperature")) box.tool.push_back(t + 273.15);
  box.speed.push_back(0.326);
  box.pressure.push_back(5e3);
  return box;
}

struct Range {
  double mu_low = 1e300, mu_high = 0.0;
  double slope_low = 1e300;  ///< smallest d tau / d p: the friction force rises with N where it is positive
};
Range range_over(const Model& model, const Table2Box& box, const AreaFunction& area = {}) {
  Range range;
  for (const double speed : box.speed)
    for (const double pressure : box.pressure)
      for (const double fabric : box.fabric)
        for (const double tool : box.tool) {
          const auto [fraction, slope] = area ? area(pressure) : std::pair{1.0, 0.0};
          const Traction t = traction(model,
                                      {.slip_speed = speed,
                                       .pressure = pressure,
                                       .fabric_temperature = fabric,
                                       .tool_temperature = tool,
                                       .area_fraction = fraction,
                                       .area_slope = slope},
                                      {});
          range.mu_low = std::min(range.mu_low, t.friction.mu);
          range.mu_high = std::max(range.mu_high, t.friction.mu);
          range.slope_low = std::min(range.slope_low, t.dtau_dpressure);
        }
  return range;
}

/// Contact area as tow flattening gives it, phi ~ p^a.
AreaFunction area_with_exponent(double a) {
  return [a](double p) {
    const double phi = 0.1 * std::pow(p / 1e5, a);
    return std::pair{phi, a * phi / p};
  };
}

}  // namespace

TEST_CASE("Table 4 is as printed", "[paper]") {
  const auto rows = table4();
  REQUIRE(rows.size() == 4);
  const std::array measured{843.0, 896.0, 1551.0, 690.0}, of_paper{804.0, 848.0, 1673.0, 703.0};
  const std::array velocity{16.67e-3, 41.67e-3, 16.67e-3, 16.67e-3}, force{1500.0, 1500.0, 3000.0, 1500.0};
  const std::array tool{85.0, 85.0, 85.0, 140.0};
  for (std::size_t i = 0; i < 4; ++i) {
    CHECK(*rows[i].measured_force == measured[i]);
    CHECK(*rows[i].paper_model_force == of_paper[i]);
    CHECK(rows[i].velocity == velocity[i]);
    CHECK(rows[i].normal_force == force[i]);
    CHECK(rows[i].tool_temperature == Approx(tool[i] + 273.15));
    CHECK(rows[i].fabric_temperature == Approx(453.15));
  }
}

TEST_CASE("the table shipped with the configurations is Table 4", "[paper]") {
  const auto shipped =
      read_friction_table(std::string(heddle::test::source_dir) + "/configs/data/friction_table4.csv");
  const auto rows = table4();
  REQUIRE(shipped.size() == rows.size());
  for (std::size_t i = 0; i < rows.size(); ++i) {
    CHECK(shipped[i].name == rows[i].name);
    CHECK(shipped[i].measured_force == rows[i].measured_force);
    CHECK(shipped[i].velocity == rows[i].velocity);
    CHECK(shipped[i].normal_force == rows[i].normal_force);
    CHECK(shipped[i].tool_temperature == rows[i].tool_temperature);
  }
}

TEST_CASE("the paper's own model misses Table 4 by 5.4 % and has the wrong sign for the load", "[paper]") {
  const auto rows = table4();
  double square = 0.0;
  for (const FrictionTestRow& row : rows)
    square += std::pow(*row.paper_model_force / *row.measured_force - 1.0, 2);
  CHECK(std::sqrt(square / 4.0) == Approx(0.0541).margin(5e-4));
  CHECK(*rows[2].paper_model_force / *rows[0].paper_model_force > 2.0);  // mu rises with the load
  CHECK(*rows[2].measured_force / *rows[0].measured_force < 2.0);        // measured: it falls
}

TEST_CASE("power law with three fitted parameters meets Table 4 within 1 %", "[paper]") {
  const Form form = GENERATE(Form::term, Form::factor);
  const Calibration calibration = calibrate(form_of(power_form, form), table4(), {});
  REQUIRE(calibration.summary.converged);
  REQUIRE(calibration.model.film.index == 0.38);  // rheology, not fitted
  CHECK(calibration.parameters.size() == 3);
  CHECK(calibration.degrees_of_freedom == 1);

  CHECK(calibration.rms_error <= 0.01);  // reached: 0.51 %; the paper's model: 5.4 %
  // Measured contrasts, each within 2 points. Reached: +4.9, -9.0, -18.8 %.
  CHECK(std::abs(contrast(calibration, 1) - 0.063) <= 0.02);
  CHECK(std::abs(contrast(calibration, 2) + 0.080) <= 0.02);
  CHECK(std::abs(contrast(calibration, 3) + 0.181) <= 0.02);
}

TEST_CASE("calibrated numbers of the power law stay where they were", "[paper]") {
  // Least squares by the logarithms of the first three rows gives s = 0.1363; on the forces it is 0.1361.
  const Calibration c = calibrate(form_of(power_form), table4(), {});
  CHECK(c.parameters[0].value == Approx(0.32526).epsilon(1e-4));
  CHECK(c.parameters[1].value == Approx(0.13606).epsilon(1e-4));
  CHECK(c.parameters[2].value == Approx(-9.688e-4).epsilon(1e-4));
  CHECK(*c.parameters[1].standard_error == Approx(0.0136).epsilon(0.01));
}

TEST_CASE("term and factor meet Table 4 alike: one hot tool cannot tell them apart", "[paper]") {
  const Calibration term = calibrate(form_of(power_form, Form::term), table4(), {});
  const Calibration factor = calibrate(form_of(power_form, Form::factor), table4(), {});
  for (std::size_t i = 0; i < 4; ++i) {
    CHECK(term.rows[i].pull_force == Approx(factor.rows[i].pull_force).epsilon(1e-9));
  }
  // Under a binder they part: at 8 kPa the same 55 K take off 13 % or 19 % of mu.
  const Context hot{.slip_speed = 16.67e-3, .pressure = 8e3, .tool_temperature = 413.15};
  Context baseline = hot;
  baseline.tool_temperature = 358.15;
  const auto drop = [&](const Calibration& c) {
    return 1.0 - evaluate(c.model, hot, {}).mu / evaluate(c.model, baseline, {}).mu;
  };
  CHECK(drop(term) == Approx(0.126).margin(0.002));
  CHECK(drop(factor) == Approx(0.188).margin(0.002));
}

TEST_CASE("without the tool temperature the Hersey number alone misses Table 4", "[paper]") {
  // The paper: Stribeck theory holds "in all cases except for tool temperature".
  Model plain = form_of(power_form);
  plain.effects = {};
  CHECK(calibrate(plain, table4(), {}).rms_error > 0.09);
}

TEST_CASE("a constant mu with the tool temperature misses Table 4", "[paper]") {
  CHECK(calibrate(form_of(Coulomb{}), table4(), {}).rms_error > 0.05);
}

TEST_CASE("mu stays between 0.1 and 0.8 and the friction force rises with the load over all of Table 2",
          "[paper]") {
  const Form form = GENERATE(Form::term, Form::factor);
  const double plate_area = GENERATE(0.005, 0.01, 0.02);  // assumed value and both ends of its band
  const FrictionRig rig{.plate_area = plate_area};
  const Model model = calibrate(form_of(power_form, form), table4(), rig).model;
  const Table2Box box = table2_box(plate_area);
  REQUIRE(box.speed.size() == 6);
  REQUIRE(box.pressure.size() == 8);
  REQUIRE(box.fabric.size() == 3);
  REQUIRE(box.tool.size() == 6);

  const Range range = range_over(model, box);
  CAPTURE(plate_area, range.mu_low, range.mu_high, range.slope_low);
  CHECK(range.mu_low >= 0.1);
  CHECK(range.mu_high <= 0.8);
  CHECK(range.slope_low > 0.0);
}

TEST_CASE("the same bounds hold with the real contact area, whatever its pressure exponent", "[paper]") {
  const Form form = GENERATE(Form::term, Form::factor);
  const double plate_area = GENERATE(0.005, 0.01, 0.02);
  const double a = GENERATE(0.3, 0.6, 0.9);
  const AreaFunction area = area_with_exponent(a);
  const Model model = calibrate(form_of(power_form, form), table4(), {.plate_area = plate_area}, area).model;
  const Range range = range_over(model, table2_box(plate_area), area);
  CAPTURE(plate_area, a, range.mu_low, range.mu_high, range.slope_low);
  CHECK(range.mu_low >= 0.1);
  CHECK(range.mu_high <= 0.8);
  CHECK(range.slope_low > 0.0);
}

TEST_CASE("held linear law keeps the friction force rising with the load over all of Table 2", "[paper]") {
  const double plate_area = GENERATE(0.005, 0.01, 0.02);
  Model held = calibrate(form_of(linear_form), table4(), {.plate_area = plate_area}).model;
  const Table2Box box = table2_box(plate_area);
  const Range range = range_over(held, box);
  CAPTURE(plate_area, range.mu_low, range.mu_high, range.slope_low);
  CHECK(range.mu_low >= 0.1);
  CHECK(range.mu_high <= 1.0);  // reached: 0.98 at 0.005 m^2; the power law stays below 0.69
  CHECK(range.slope_low > 0.0);

  held.box = {};  // the straight line itself blows up at low pressure
  CHECK(range_over(held, box).mu_high > 3.0);
}

TEST_CASE("linear law meets Table 4 within 0.1 %", "[paper]") {
  const Calibration c = calibrate(form_of(linear_form), table4(), {});
  CHECK(c.rms_error < 1e-3);  // reached: 0.085 %
  // literature: exact on four rows with n = 0.361: a = 0.2360, b = 0.0450
  CHECK(c.parameters[0].value == Approx(0.236).epsilon(0.01));
  CHECK(c.parameters[1].value == Approx(0.045).epsilon(0.03));
}

TEST_CASE("Table 4 asks for a contact area that grows as pressure to about 0.3", "[paper]") {
  // ln mu rises by 0.0611 over ln 2.5 in U and falls by 0.0835 over ln 2 in N, so 1 - a = n 0.1204 / 0.0666.
  const double n = GENERATE(0.37, 0.38, 0.41);
  const PowerLawFilm film{.index = n};
  const AreaExponent found = area_exponent_that_fits(film, form_of(power_form).effects, table4(), {});
  REQUIRE(found.summary.converged);
  const double by_hand = 1.0 - n * (std::log(1686.0 / 1551.0) / std::log(2.0)) /
                                   (std::log(896.0 / 843.0) / std::log(41.67 / 16.67));
  CHECK(found.value == Approx(by_hand).margin(1e-5));
  CHECK(found.value > 0.25);
  CHECK(found.value < 0.34);
  CHECK_FALSE(found.standard_error.has_value());  // four numbers, four parameters
}

TEST_CASE(
    "real contact area with pressure exponents of tow flattening is met less well than nominal pressure",
    "[paper]") {
  // phi ~ p^a with a = 0.6..0.9 from geometry alone against the 0.31 that would fit: the more a, the worse.
  const auto rms = [](double a) {
    return calibrate(form_of(power_form), table4(), {}, area_with_exponent(a)).rms_error;
  };
  CHECK(rms(0.3125) < 1e-4);
  CHECK(rms(0.6) > 0.005);
  CHECK(rms(0.9) > rms(0.75));
  CHECK(rms(0.75) > rms(0.6));
}

TEST_CASE("a fabric at 160 or 200 degC is predicted to change mu by 6 to 7 %", "[paper]") {
  // The paper saw "relatively no effect" and prints no numbers. With the film at fabric temperature the law
  // cannot give none; this pins the size of the disagreement.
  const Model model = calibrate(form_of(power_form), table4(), {}).model;
  const auto mu = [&](double celsius) {
    return evaluate(model, {.slip_speed = 16.6e-3, .pressure = 150e3, .fabric_temperature = celsius + 273.15},
                    {})
        .mu;
  };
  CHECK(mu(160.0) / mu(180.0) - 1.0 == Approx(0.0725).margin(1e-3));
  CHECK(mu(200.0) / mu(180.0) - 1.0 == Approx(-0.0621).margin(1e-3));
}
