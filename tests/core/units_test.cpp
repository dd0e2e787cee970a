#include "core/units.h"

#include <catch2/catch.hpp>
#include <cstdlib>
#include <cstring>
#include <limits>
#include <numbers>
#include <random>

using heddle::read_quantity;
using heddle::write_quantity;

namespace {

bool same_bits(double a, double b) {
  return std::memcmp(&a, &b, sizeof a) == 0;
}

double value_of(const char* text, const char* example) {
  const heddle::Reading reading = read_quantity(text, example);
  INFO(text << " as " << example << ": " << reading.fault);
  REQUIRE(reading.ok());
  return reading.value;
}

}  // namespace

TEST_CASE("a decimal unit gives the bits of the same number written in SI", "[core][units]") {
  CHECK(same_bits(value_of("0.75 mm", "m"), 0.75e-3));
  CHECK(same_bits(value_of("4.64 mm", "mm"), 4.64e-3));
  CHECK(same_bits(value_of("-9.27e-4 1/K", "1/K"), -9.27e-4));
  CHECK(same_bits(value_of("60 %", "%"), 0.6));
  CHECK(same_bits(value_of("0.01 m^2", "m^2"), 0.01));
  CHECK(same_bits(value_of("0 N s/m^3", "N s/m^3"), 0.0));
  CHECK(same_bits(value_of("1872 tex", "kg/m"), 1872e-6));
  CHECK(same_bits(value_of("1872 g/km", "tex"), 1872e-6));
  CHECK(same_bits(value_of("20 kg/m^3", "kg/m^3"), 20.0));
  CHECK(same_bits(value_of("163 mm/s", "m/s"), 0.163));
  CHECK(same_bits(value_of("42 kJ/mol", "J/mol"), 42e3));
  CHECK(same_bits(value_of("0.35 W/(m K)", "W/(m K)"), 0.35));
  CHECK(same_bits(value_of("6790 Pa s^n", "Pa s^n"), 6790.0));
  CHECK(same_bits(value_of("6.79 kPa*s^n", "Pa s^n"), 6790.0));
  CHECK(same_bits(value_of("72.4 GPa", "Pa"), 72.4e9));
  CHECK(same_bits(value_of("3.2 N/mm^2", "MPa"), 3.2e6));
  CHECK(same_bits(value_of("70mm", "m"), 0.07));
  CHECK(same_bits(value_of("+.5 kN", "N"), 500.0));
}

TEST_CASE("moving the decimal exponent beats multiplying by a thousandth", "[core][units]") {
  // The reason for the rule: a product rounds twice. If no value showed the difference, the rule would be
  // idle.
  std::mt19937 random(7);
  std::uniform_int_distribution<int> thousandths(1, 99999);
  int products_off = 0;
  for (int i = 0; i < 1000; ++i) {
    const std::string digits = std::to_string(thousandths(random));
    const double literal = std::strtod((digits + "e-6").c_str(), nullptr);
    CHECK(same_bits(value_of((digits + " um").c_str(), "m"), literal));
    products_off += same_bits(std::strtod(digits.c_str(), nullptr) * 1e-6, literal) ? 0 : 1;
  }
  CHECK(products_off > 0);
}

TEST_CASE("angles and times of other bases cost one multiplication", "[core][units]") {
  CHECK(same_bits(value_of("45 deg", "rad"), 45.0 * (std::numbers::pi / 180.0)));
  CHECK(same_bits(value_of("1.5 min", "s"), 90.0));
  CHECK(same_bits(value_of("2 h", "s"), 7200.0));
}

TEST_CASE("degrees Celsius are an offset for a temperature and refused for a difference", "[core][units]") {
  CHECK(same_bits(value_of("85 degC", "degC"), 358.15));
  CHECK(same_bits(value_of("180 degC", "degC"), 453.15));
  CHECK(same_bits(value_of("21.37 degC", "degC"), 294.52));
  CHECK(same_bits(value_of("-40 degC", "degC"), 233.15));
  CHECK(same_bits(value_of("1.8e2 degC", "degC"), 453.15));
  CHECK(same_bits(value_of("358.15 K", "degC"), 358.15));
  CHECK(same_bits(value_of("10 K", "K"), 10.0));

  const heddle::Reading difference = read_quantity("10 degC", "K");
  CHECK(difference.fault == "has the unit degC, where a temperature difference is needed");
  CHECK(difference.way_out == "A difference of 5 degC is written 5 K.");
  CHECK_FALSE(read_quantity("1 1/degC", "1/K").ok());
  CHECK_FALSE(read_quantity("0.2 W/(m degC)", "W/(m K)").ok());
}

TEST_CASE("a value of another dimension, or none, is a fault with a way out", "[core][units]") {
  struct Row {
    const char* text;
    const char* example;
    const char* fault;
  };
  const Row row =
      GENERATE(Row{"0.75", "mm", "has no unit, where a length is needed"},
               Row{"0.75 s", "mm", "has the unit s, where a length is needed"},
               Row{"0.75 mm", "", "has the unit \"mm\", where a plain number is needed"},
               Row{"60 %", "", "has %, where a plain number is needed"},
               Row{"60 %", "mm", "has %, where a length is needed"},
               Row{"6 mm", "%", "has the unit \"mm\", where a fraction is needed"},
               Row{"45", "deg", "has no unit, where an angle is needed"},
               Row{"1 rad", "mm", "has the unit rad, where a length is needed"},
               Row{"6790 Pa s", "Pa s^n", "has the unit Pa s, where a power-law consistency is needed"},
               Row{"42 kJ", "kJ/mol", "has the unit kJ, where an energy per amount is needed"},
               Row{"1 furlong", "mm", "has the unknown unit \"furlong\""},
               Row{"1 m2", "m^2", "has the unit \"m2\", which cannot be read at \"2\""},
               Row{"1 W/m K", "W/(m K)", "has the unit \"W/m K\", which can be read in two ways"},
               Row{"1 W/m/K", "W/(m K)", "has the unit \"W/m/K\", which can be read in two ways"},
               Row{"1 W/(m K", "W/(m K)", "has an open bracket in \"W/(m K\""},
               Row{"1 m^", "m", "has no whole number after m^"}, Row{"1 m^n", "m", "has the power m^n"},
               Row{"5 % m", "m", "has % inside the unit \"% m\""}, Row{"nan", "", "is not finite"},
               Row{".inf m", "m", "is not finite"}, Row{"1e999 m", "m", "is not finite"},
               Row{"many", "", "is not a number"}, Row{"", "mm", "is not a number"},
               Row{"010", "", "starts with a zero"}, Row{"-007 mm", "mm", "starts with a zero"});
  const heddle::Reading reading = read_quantity(row.text, row.example);
  CAPTURE(row.text, row.example);
  CHECK(reading.fault == row.fault);
  CHECK_FALSE(reading.way_out.empty());
}

TEST_CASE("a value written out reads back with the same bits", "[core][units]") {
  CHECK(write_quantity(0.75e-3, "mm") == "0.75 mm");
  CHECK(write_quantity(0.07, "mm") == "70 mm");
  CHECK(write_quantity(358.15, "degC") == "85 degC");
  CHECK(write_quantity(0.6, "%") == "60 %");
  CHECK(write_quantity(-9.27e-4, "1/K") == "-0.000927 1/K");
  CHECK(write_quantity(1872e-6, "tex") == "1872 tex");
  CHECK(write_quantity(42e3, "kJ/mol") == "42 kJ/mol");
  CHECK(write_quantity(0.0, "N s/m^3") == "0 N s/m^3");
  CHECK(write_quantity(3.2e6, "MPa") == "3.2 MPa");
  CHECK(write_quantity(0.38, "") == "0.38");

  std::mt19937_64 random(11);
  std::uniform_real_distribution<double> exponent(-9.0, 9.0);
  const char* example = GENERATE("", "%", "mm", "degC", "deg", "kJ/mol", "Pa s^n", "W/(m K)", "min");
  for (int i = 0; i < 300; ++i) {
    const double value = std::pow(10.0, exponent(random));
    const std::string text = write_quantity(value, example);
    CAPTURE(text, example, value);
    CHECK(same_bits(value_of(text.c_str(), example), value));
  }
}
