#include "pipeline/discover/prior.h"

#include <catch2/catch.hpp>
#include <cmath>
#include <numbers>

using namespace heddle;
using discover::Prior;
using discover::read_prior;

TEST_CASE("a prior reads what an effect file says, and writes it back bit for bit", "[discover][prior]") {
  std::string fault;
  for (const auto& [text, unit] : {std::pair{"normal, mean 0, sd 0.1", ""},
                                   {"half-normal, scale 2000 Pa, within 0 Pa to 1e5 Pa", "Pa"},
                                   {"log-normal, median 2 mm, factor 2", "m"},
                                   {"normal, mean 117 degC, sd 5 K", "degC"},
                                   {"fixed, 85 degC; the baseline of Table 2", "degC"}}) {
    CAPTURE(text);
    const auto prior = read_prior(text, unit, fault);
    REQUIRE(prior);
    const auto again = read_prior(discover::write_prior(*prior, unit), unit, fault);
    REQUIRE(again);
    CHECK(again->kind == prior->kind);
    CHECK(again->centre == prior->centre);
    CHECK(again->scale == prior->scale);
    CHECK(again->low == prior->low);
    CHECK(again->high == prior->high);
  }
  const auto onset = read_prior("normal, mean 117 degC, sd 5 K", "degC", fault);
  CHECK(onset->value_at(1.0) == Approx(395.15));
  const auto length = read_prior("log-normal, median 2 mm, factor 2", "m", fault);
  CHECK(length->value_at(-1.0) == Approx(1e-3));
  CHECK(length->coordinate_of(8e-3) == Approx(2.0));
}

TEST_CASE("a prior that cannot be read says which part", "[discover][prior][bad]") {
  std::string fault;
  for (const auto& [text, words] : {std::pair{"uniform, 0 to 1", "uniform"},
                                    {"normal, 0, 0.1", "mean"},
                                    {"normal, mean 0 N, sd 1 N", "N"},
                                    {"half-normal, scale -1", "above 0"},
                                    {"log-normal, median 2, factor 1", "above 1"},
                                    {"log-normal, median -2, factor 2", "median above 0"},
                                    {"normal, mean 0, sd 1, within 2 to 1", "no room"},
                                    {"normal, mean 0, sd 1, about 2", "within"},
                                    {"normal, mean 0, sd 1, within 0 to 1, more", "more than it needs"}}) {
    CAPTURE(text, fault);
    CHECK_FALSE(read_prior(text, "", fault));
    CHECK(fault.find(words) != std::string::npos);
  }
}

TEST_CASE("the mass of a cut normal is that of its two ends, far out in a tail too", "[discover][prior]") {
  CHECK(discover::log_normal_mass(-INFINITY, INFINITY) == Approx(0.0).margin(1e-15));
  CHECK(discover::log_normal_mass(0.0, INFINITY) == Approx(std::log(0.5)));
  CHECK(discover::log_normal_mass(-1.0, 2.0) ==
        Approx(std::log(discover::normal_probability(2.0) - discover::normal_probability(-1.0))));
  // Mills' ratio: 1 - Phi(z) = phi(z)/z (1 - 1/z^2 + 3/z^4 - 15/z^6 ...)
  const double z = 20.0, q = 1.0 / (z * z);
  const double tail = -0.5 * z * z - 0.5 * std::log(2.0 * std::numbers::pi) - std::log(z) +
                      std::log1p(-q + 3 * q * q - 15 * q * q * q);
  CHECK(discover::log_normal_mass(z, INFINITY) == Approx(tail).epsilon(1e-9));
  CHECK(discover::log_normal_mass(-INFINITY, -z) == Approx(tail).epsilon(1e-9));
  CHECK(std::abs(discover::log_normal_mass(z, INFINITY) - (tail + 0.01)) > 1e-3);  // the check can fail
  CHECK((Prior{.kind = Prior::Kind::half_normal, .scale = 3.0, .low = 0.0}.log_mass()) ==
        Approx(std::log(0.5)));
}
