#pragma once

#include <array>
#include <functional>
#include <string>
#include <vector>

#include "core/problem.h"
#include "mesoscale/study/properties.h"

namespace heddle::mesoscale::study {

/// A length of the tows that a study changes, in warp and weft alike.
enum class Dimension : std::size_t { tow_width, gap, tow_thickness };
inline constexpr std::array<Dimension, 3> dimensions{Dimension::tow_width, Dimension::gap,
                                                     Dimension::tow_thickness};
/// "tow_width": the key below `weave` and below `study`.
std::string name_of(Dimension dimension);

enum class Design {
  one_at_a_time,  ///< each value beside the weave given
  crossed         ///< every combination, with the values of the weave given among them
};

/// What to change. Values that the weave has already are passed over, so no cell is looked at twice.
struct StudySpec {
  std::vector<std::string> patterns;          ///< as WeaveSpec::pattern
  std::array<std::vector<double>, 3> values;  ///< by Dimension [m]
  std::vector<double> shear_angles{0.0};      ///< at which every cell is looked at [rad]
  Design design = Design::one_at_a_time;
  bool sensitivities = true;
  double step = 0.005;  ///< of the central differences, as a share of the tow width (thickness: of itself)
};

inline constexpr std::size_t most_cells = 5000;

/// One weave of the study.
struct StudyPoint {
  CellSpec cell;
  std::string pattern;
  std::array<double, 3> lengths{};  ///< by Dimension [m]
  bool operator==(const StudyPoint& other) const {
    return pattern == other.pattern && lengths == other.lengths;
  }
};

/// A cell with one length of its tows changed by `by` [m], in both directions. The fabric's thickness follows
/// the tows', so that what Table 1 rounds stays as it is.
CellSpec changed(CellSpec cell, Dimension dimension, double by);

/// All weaves, that of `base` first.
std::vector<StudyPoint> points(const CellSpec& base, const StudySpec& spec);

/// Everything wrong with the study of a sound cell: weaves that cannot be, each named by the key of the study
/// that asks for it, and steps that leave the weaves that can be (keys below "study").
Problems check(const StudySpec& spec, const CellSpec& base);

/// First-order change of a property with a length, by central differences of the cells at -2h, -h, h and 2h.
struct Sensitivity {
  std::size_t property = 0;
  Dimension dimension = Dimension::tow_width;
  double angle = 0.0;  ///< trellis angle [rad]
  double value = 0.0;  ///< of the property [SI]
  double slope = 0.0;  ///< D(h), per metre of the length in both directions [SI/m]
  double error = 0.0;  ///< |D(2h) - D(h)| / 3: what the step leaves, to leading order, and the noise [SI/m]
  /// Change in per cent for one per cent of the length (that of the warp) [-].
  double relative(double length) const { return slope * length / value; }
  double relative_error(double length) const { return error * length / std::abs(value); }
};

/// Cells the differences need, in order {-2h, -h, h, 2h}.
std::array<CellSpec, 4> stencil(const CellSpec& base, const StudySpec& spec, Dimension dimension);
double step_of(const CellSpec& base, const StudySpec& spec, Dimension dimension);  ///< h [m]

/// @param base     properties of the cell itself
/// @param around   of its stencil
/// Properties without a value, or without change at all four, are left out or zero.
std::vector<Sensitivity> sensitivities(const CellProperties& base,
                                       const std::array<CellProperties, 4>& around, double step,
                                       Dimension dimension, std::span<const double> angles);

}  // namespace heddle::mesoscale::study
