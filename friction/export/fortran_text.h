#pragma once

#include <string>

namespace heddle::friction {

/// Modules that every exported routine starts with: numbers with their slopes to four variables (forward
/// automatic differentiation, as friction/sensitivity.h), and a smooth curve through points (core/curve.h).
extern const char* const fortran_modules;

/// A double as Fortran reads it back bit for bit: "0.325D0", "(-9.3D-4)".
std::string fortran_number(double value);

}  // namespace heddle::friction
