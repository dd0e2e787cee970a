#pragma once

#include <array>
#include <string>
#include <vector>

#include "macroscale/stamping.h"
#include "mesoscale/fabric_properties.h"

namespace heddle::macroscale {

/// Strain at which glass filaments in a tow break [-]. Prior (glass fails at 2 to 4 % of strain, processed
/// tows at the lower end), not measured on this fabric.
inline constexpr double glass_breaking_strain = 0.02;

/// What a formed fabric may not survive, or a part may not show. Read off a state; nothing of it acts on the
/// run. Arrays hold one entry a node.
struct Indicators {
  /// {warp, weft}: tension of the fabric over that of straight tows at glass_breaking_strain [-]: above 1 the
  /// tow is torn, 0 where it is slack.
  std::vector<std::array<double, 2>> tow_load;
  /// {between warp tows, between weft tows}: change of the distance of neighbours, square to them [m]. Above
  /// 0 they part. Tows are bound to one another at the nodes here, so this shows where they would be pulled
  /// apart, not how far they would slide.
  std::vector<std::array<double, 2>> gap_opening;
  /// Amplitude of the waves that the grid can hold, square to the sheet [m] (see `indicators`).
  std::vector<double> wrinkle_height;
  /// Void-free thickness over that of the flat ply: 1 / ((1 + e1)(1 + e2) cos gamma) [-].
  std::vector<double> thickening;
};

/// Wrinkle height: fourth differences along both tows over one and over two spacings,
///     |n . (x_-2 - 4 x_-1 + 6 x_0 - 4 x_1 + x_2)| / 16,
/// the larger of them. A wave of amplitude A along a tow gives A sin^4(pi m h / length) at m spacings: all of
/// it where it is 2 or 4 spacings long, a quarter at 8; a parabola, so a tool's smooth curvature, gives
/// nothing. What it leaves where curvature begins (a fillet of radius r) is at most h^2 / (3 r), whatever the
/// length of the arc. Where the grid ends within two spacings nothing is said (0).
Indicators indicators(const BlankState& blank, const mesoscale::FabricProperties& fabric);

/// The largest of a state, and the places where they are.
struct LargestIndicator {
  std::string name;            ///< "tow_load_max"
  double value = 0.0;          ///< in `unit`
  std::string unit;            ///< "", "mm"
  std::array<double, 3> at{};  ///< position of the node [m]
};
/// tow_load_max, tow_compression_max (largest shortening of a tow [-]), gap_opening_max, wrinkle_height_max,
/// thickening_max, thickening_min.
std::vector<LargestIndicator> largest(const Indicators& indicators, const BlankState& blank);

/// The height above which waves cannot be the grid's own: what a fillet leaves, and a tenth of the thickness
/// [m].
double wrinkle_floor(double spacing, double fillet, double thickness);

}  // namespace heddle::macroscale
