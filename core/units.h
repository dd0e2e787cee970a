#pragma once

#include <numbers>
#include <string>
#include <string_view>

namespace heddle {

inline constexpr double degrees = 180.0 / std::numbers::pi;  ///< in a radian
inline constexpr double zero_celsius = 273.15;               ///< [K]

/// Exponents of the base quantities in a unit. Angles and amounts count, so that a plain number is not taken
/// for either.
struct Dimension {
  int mass = 0;         ///< kg
  int length = 0;       ///< m
  int time = 0;         ///< s
  int temperature = 0;  ///< K
  int angle = 0;        ///< rad
  int amount = 0;       ///< mol
  int symbolic_time =
      0;  ///< k of s^(k n): the power-law consistency "Pa s^n", with n known only to the rheology
  bool operator==(const Dimension&) const = default;
};

/// Number read from text with its unit, in SI. Either `fault` is empty or it says what is wrong.
struct Reading {
  double value = 0.0;
  std::string fault;    ///< "has the unit s, where a length is needed"
  std::string way_out;  ///< "Write the value with a unit such as mm."
  bool ok() const { return fault.empty(); }
};

/// Reads "0.75 mm", "-9.27e-4 1/K", "60 %", "0.35 W/(m K)" into SI.
///
/// A power of ten between the unit and SI moves the decimal exponent of the text before it becomes a double,
/// so "0.75 mm" has the bits of 0.75e-3. Other factors (deg, min, h) cost one multiplication.
/// @param text     number, then unit: symbols with ^ for powers, a space or * for products, one / for the
/// quotient
/// @param example  a unit of the dimension wanted, which decides the rules:
///                 ""      plain number, no unit allowed;
///                 "%"     fraction 0.25 or 25 %;
///                 "degC"  absolute temperature in degC (offset) or K;
///                 "K"     temperature difference, degC refused;
///                 else    any unit of the same dimension, and never none
Reading read_quantity(std::string_view text, std::string_view example);

/// Writes an SI value so that read_quantity(text, example) gives the same bits: in the example's unit where
/// that works, else in SI.
std::string write_quantity(double value, std::string_view example);

/// Unit of the stored value in SI base units and N, Pa, J, W where they fit whole: "m", "kg/m^3", "K"; "" for
/// numbers.
std::string si_unit(std::string_view example);

/// "a length", "a pressure"; the example itself where the dimension has no common name.
std::string dimension_name(std::string_view example);

}  // namespace heddle
