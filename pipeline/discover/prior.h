#pragma once

#include <array>
#include <limits>
#include <optional>
#include <string>
#include <string_view>

namespace heddle::discover {

/// Belief about one number before the data, written over a coordinate z that is standard normal between its
/// bounds. Searches and evidence live in z, so that units and sizes do not matter.
struct Prior {
  enum class Kind {
    fixed,        ///< the number is `centre`
    normal,       ///< centre + scale z
    half_normal,  ///< scale z, z >= 0
    log_normal    ///< centre scale^z: `centre` the median, `scale` the factor of one standard deviation
  };
  Kind kind = Kind::fixed;
  double centre = 0.0;
  double scale = 1.0;  ///< > 0; > 1 of log_normal
  double low =
      -std::numeric_limits<double>::infinity();  ///< of the number, as the prior or its key bounds it
  double high = std::numeric_limits<double>::infinity();

  double value_at(double z) const;
  double coordinate_of(double value) const;
  /// {low, high} in z.
  std::array<double, 2> bounds() const;
  /// ln of the prior mass that a standard normal z has between the bounds: what cutting it off multiplies by.
  double log_mass() const;
  bool is_free() const { return kind != Kind::fixed; }
};

/// Reads "normal, mean 0, sd 0.1", "half-normal, scale 3e3 Pa, within 0 Pa to 1e5 Pa",
/// "log-normal, median 2e-3 m, factor 2" or "fixed, 0.945". What follows a semicolon is a remark.
/// @param unit   example unit of the number, as core/units takes it
/// @param fault  what is wrong with the text, where nothing is returned
std::optional<Prior> read_prior(std::string_view text, const std::string& unit, std::string& fault);

/// The same text for a prior, without remark: read_prior gives the same bits.
std::string write_prior(const Prior& prior, const std::string& unit);

/// Phi(z) of the standard normal distribution.
double normal_probability(double z);
/// ln(Phi(high) - Phi(low)), also far out in a tail.
double log_normal_mass(double low, double high);

}  // namespace heddle::discover
