#pragma once

#include <optional>

#include "friction/contact_point.h"

namespace heddle::friction {

/// Effect F2 (paper, section 2, "shifting term"): mu += slope (T_tool - reference), or mu *= 1 + slope (...).
/// The paper names the term and prints neither its form nor its size. The term is the same step of mu at
/// every load; the factor is the same share of mu, so it grows where mu is large (low pressure).
struct ToolTemperatureShift {
  enum class Form { term, factor };
  double slope = 0.0;         ///< [1/K]; 0 = off
  double reference = 358.15;  ///< [K]
  Form form = Form::term;
};

/// Named terms in library order; absent = off, and off restores the baseline bit for bit.
struct Effects {
  std::optional<ToolTemperatureShift> tool_temperature_shift;
};

/// Changes mu and its slopes in place.
void apply(const ToolTemperatureShift& effect, const Context& context, Friction& friction);

/// All effects present, in library order whatever the order in the file.
void apply(const Effects& effects, const Context& context, Friction& friction);

}  // namespace heddle::friction
