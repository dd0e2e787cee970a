#pragma once

#include <optional>
#include <span>
#include <string>
#include <vector>

#include "friction/friction_test.h"
#include "friction/least_squares.h"
#include "friction/model.h"
#include "friction/parameters.h"

namespace heddle::friction {

struct FittedParameter {
  std::string key;   ///< as in the configuration, for instance "friction.exponent"
  std::string unit;  ///< "" for a plain number
  double value = 0.0;
  bool fitted = true;  ///< false: all rows are alike in what the parameter acts on, so it stayed where it was
  /// One standard deviation; empty when held, or when the fit is saturated (as many parameters as rows: the
  /// rows are met exactly and say nothing about the scatter).
  std::optional<double> standard_error = {};
};

/// A law fitted to friction tests, with what the fit leaves over.
struct Calibration {
  Model model;  ///< law, film, effects, and the box of the rows
  std::vector<FittedParameter> parameters;
  std::vector<FrictionTestResult> rows;  ///< the friction test with the fitted model, one a row
  double rms_error = 0.0;                ///< of the relative force errors [-]
  int degrees_of_freedom = 0;            ///< rows - fitted parameters
  LeastSquaresSummary summary;

  bool saturated() const { return degrees_of_freedom == 0; }
};

struct CalibrationOptions {
  bool hold_tool_temperature_slope = false;  ///< keep the slope that the model came with
  LeastSquaresOptions search = {};
};

/// Least squares on the relative force error (F_model - F) / F.
///
/// The form of the law is the one `start` holds: Coulomb (mu), HerseyPower (C, s) or HerseyLinear (a, b, with
/// Hs0 the Hersey number of the first row). The tool temperature slope is fitted where the effect is present,
/// unless the options hold it.
/// The film is taken as it is: n comes from polypropylene rheology, not from friction tests, whose few rows
/// cannot tell n from s.
/// @param rows  each with a measured force
/// @param area  contact area fraction against nominal pressure; empty = nominal pressure
/// @throws InputError  if check() of rig, rows or film finds something, if there are fewer rows than
/// parameters, or if
///                     the rows cannot separate the parameters
Calibration calibrate(const Model& start, std::span<const FrictionTestRow> rows, const FrictionRig& rig,
                      const AreaFunction& area = {}, const CalibrationOptions& options = {});

/// The smallest box that holds what the law saw in these tests.
CalibrationBox box_of(std::span<const FrictionTestResult> results);

/// The same at both ends of the plate area band: how far an unknown plate area moves the law elsewhere.
struct CalibrationBand {
  Calibration low, assumed, high;
};
CalibrationBand calibrate_band(const Model& start, std::span<const FrictionTestRow> rows,
                               const FrictionRig& rig, const AreaFunction& area = {},
                               const CalibrationOptions& options = {});

/// Pressure exponent a of a contact area phi ~ p^a that friction tests ask for.
struct AreaExponent {
  double value = 0.0;                    ///< a [-]
  std::optional<double> standard_error;  ///< empty when saturated
  double law_exponent = 0.0;             ///< s of mu = C Hs^s beside it [-]
  double rms_error = 0.0;                ///< of the relative force errors [-]
  LeastSquaresSummary summary;
};

/// Fits C, s, a and the tool temperature slope together, with Hs = p^a eta U / (p h). For comparison with the
/// exponent the mesoscale computes from tow flattening; no part of a calibration.
/// @throws InputError  as calibrate
AreaExponent area_exponent_that_fits(const PowerLawFilm& film, const Effects& effects,
                                     std::span<const FrictionTestRow> rows, const FrictionRig& rig);

}  // namespace heddle::friction
