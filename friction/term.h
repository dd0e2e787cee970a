#pragma once

#include <limits>

namespace heddle::friction {

/// Interval that a parameter must lie in, in SI.
struct Bounds {
  double low = -std::numeric_limits<double>::infinity();
  double high = std::numeric_limits<double>::infinity();
  bool low_open = true, high_open = true;

  /// NaN lies nowhere.
  bool contains(double x) const {
    return (low_open ? x > low : x >= low) && (high_open ? x < high : x <= high);
  }
};
inline constexpr Bounds positive_range{.low = 0.0};
inline constexpr Bounds not_negative{.low = 0.0, .low_open = false};

/// One number of a law, rheology or effect. The number of an effect that comes first is its amplitude, whose
/// off value is 0.
template <class Term>
struct Field {
  const char* name;  ///< key in the configuration
  const char* unit;  ///< example unit as core/units takes it; "" = plain number, "degC" = absolute
  double Term::*member;
  Bounds range;
  const char* help;  ///< one line
};

/// What a term is called, what it says and where it comes from. Specialised beside each term:
///     id        name in the configuration
///     equation  as docs/theory/friction.md has it
///     source    where form and default numbers come from
///     fields    std::array of Field<Term>
template <class Term>
struct About;

}  // namespace heddle::friction
