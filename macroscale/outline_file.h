#pragma once

#include <filesystem>
#include <string>

#include "macroscale/outline.h"

namespace heddle::macroscale {

/// A blank's shape on disk.
struct OutlineFile {
  std::filesystem::path file;  ///< by extension: .dxf (text), .step .stp (one plane face)
  double length_unit =
      1e-3;  ///< [m]; must agree with $INSUNITS of a DXF file, where stated, and with a STEP file
  double chord_error = 1e-5;  ///< arcs become chords with their ends on the arc, nearer than this [m]
};

/// Reads an outline: the ring with the largest area is the outer border, all others are holes.
///
/// DXF: LINE, ARC, CIRCLE, LWPOLYLINE and POLYLINE with bulges, in model space, on all layers. Pieces that
/// are not closed by themselves are joined where ends meet within 1e-6 of the drawing's extent. Text,
/// dimensions and points are passed over; any other entity (SPLINE, ELLIPSE, INSERT, ...) is refused, because
/// leaving it out would change the blank. The result passed check().
/// @param key  dotted path for messages, for instance "blank.outline"
/// @throws InputError with the line of the DXF file
Outline read_outline(const OutlineFile& outline, const std::string& key);

}  // namespace heddle::macroscale
