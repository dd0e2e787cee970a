#pragma once

#include <optional>
#include <string>

#include "core/curve.h"
#include "core/problem.h"
#include "friction/model.h"

namespace heddle::friction {

/// A law as other programs take it: mu of slip speed, pressure and the two temperatures alone.
struct ExportedLaw {
  std::string name;  ///< of the case, for the head of the file
  Model model;
  /// ln phi against ln(p / 1 Pa) of the unsheared weave, held at phi <= 1; empty = nominal pressure.
  std::optional<Curve> log_area = {};
};

/// What such a function cannot hold: a memory of slip or time, the direction of slip. Keys: friction.law,
/// effects.ID.
Problems check_export(const Model& model);

/// The law as a user subroutine FRIC_COEF of Abaqus/Standard, in fixed form: mu and its derivatives to slip
/// rate, pressure and mean temperature, exact by the chain rule, for any system of units (its five properties
/// say which). The arguments are those of the interface with fCoefDeriv(nBlock,3) and slipRate(nBlock); later
/// releases enlarge these arrays at their ends, so the routine serves them as well.
/// @throws InputError  from check_export
std::string fric_coef_fortran(const ExportedLaw& law);

/// Context of a point of the exported law, phi included.
Context context_of(const ExportedLaw& law, double speed, double pressure, double fabric_temperature,
                   double tool_temperature);

}  // namespace heddle::friction
