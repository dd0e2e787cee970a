#pragma once

#include <array>
#include <cstdint>
#include <string>
#include <vector>

#include "pipeline/painter.h"

namespace heddle::pipeline {

/// The colours of a picture and the bar that explains them. Values arrive in the unit that `unit` names.
struct ColourScale {
  double low = 0.0, high = 1.0;
  std::string quantity, unit;
  ColourMap map = ColourMap::angle;
};

/// A view along parallel rays. Elevation 90 degrees and azimuth -90 degrees look straight down with x to the
/// right and y up.
struct Camera {
  double azimuth = -90.0;    ///< of the viewer about z, from x [deg]
  double elevation = 90.0;   ///< of the viewer above the x-y plane [deg]
  bool turned_over = false;  ///< the body is first rolled half a turn about x: a bowl becomes a dome
};

/// A surface of quadrilaterals coloured by a nodal value, painted from back to front.
struct MeshPicture {
  std::string label;                          ///< what the picture shows, for readers who cannot see it
  std::vector<std::array<double, 3>> points;  ///< [m]
  std::vector<std::array<int, 4>> quads;      ///< indices of points
  std::vector<double> value;                  ///< per point, unit of `colours`
  ColourScale colours;
  Camera camera;
  /// Thin lines on the surface, one entry a quad or none: bit 0 joins the middles of its sides 3-0 and 1-2,
  /// bit 1 the middles of 0-1 and 2-3.
  std::vector<std::uint8_t> threads;
  std::vector<std::vector<std::array<double, 3>>> outlines;  ///< dashed lines over the picture [m]
  double width = 520.0, height = 460.0;                      ///< [px]
};

/// @throws std::invalid_argument  if a quad names a point that does not exist, or values and points differ in
/// number
Canvas draw(const MeshPicture& picture);

/// Values on an even grid seen from above, one coloured cell each. Row-major with x fastest: value[j * nx +
/// i].
struct GridPicture {
  std::string label;
  int nx = 0, ny = 0;
  double spacing_x = 0.0, spacing_y = 0.0;  ///< [m]
  std::vector<double> value;                ///< unit of `colours`
  ColourScale colours;
  double width = 520.0;  ///< [px]; the height follows
};

/// @throws std::invalid_argument  if the number of values is not nx * ny
Canvas draw(const GridPicture& picture);

/// What a polygon of a section belongs to.
enum class SectionKind { warp, weft, outline };

struct SectionLine {
  SectionKind kind = SectionKind::outline;
  std::vector<std::array<double, 2>>
      points;  ///< {along, height} [m]; tows are closed and filled, outlines are open
};

/// Polygons at true proportions with millimetre rulers.
struct SectionPicture {
  std::string label;
  std::string along = "Along the section";
  std::vector<SectionLine> lines;
  double width = 720.0;  ///< [px]; the height follows
};

Canvas draw(const SectionPicture& picture);

}  // namespace heddle::pipeline
