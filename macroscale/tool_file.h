#pragma once

#include <array>
#include <filesystem>
#include <string>

#include "core/triangle_mesh.h"
#include "macroscale/mesh_check.h"

namespace heddle::macroscale {

/// A tool's shape on disk.
struct ToolFile {
  std::filesystem::path file;  ///< by extension: .step .stp, .stl (text or binary), .obj
  double length_unit = 1e-3;   ///< of the file's coordinates [m]; a STEP file must state the same
  double mesh_size = 2e-3;     ///< target of the largest edge on curved faces, for STEP [m]
  double chord_error = 50e-6;  ///< facets stay this near to curved faces, for STEP [m]
  TopologyRule topology = TopologyRule::closed;
  bool repair = false;  ///< KEY.repair: apply repaired() before the mesh is checked
};

/// What the tool has to fit, and the dotted path of its keys for messages.
struct Expectation {
  std::string key = "tools.punch";
  std::array<double, 2> blank_size{};  ///< [m]
  double stroke = 0.0;                 ///< [m]
  int fabric_side = 0;                 ///< 1: the fabric is above the tool, -1: below; 0: not known
};

constexpr std::size_t most_tool_triangles = 2000000;

/// Reads a tool file into triangles [m].
///
/// STEP: see step_surface() in cad.h; the unit the file states must be `length_unit`. STL and OBJ have no
/// unit: equal vertices are merged (equal in every bit), polygons of OBJ, which must be convex, are cut into
/// fans. A tool whose largest extent is more than 20 times or less than 1/50 of the larger of blank and
/// stroke is refused; where another unit would make it fit, the message names it. Files of more than
/// most_tool_triangles are refused before they are read (STL by its header, text by counting lines).
/// @throws InputError
TriangleMesh read_tool(const ToolFile& tool, const Expectation& expected);

/// A tool that passed check().
struct LoadedTool {
  TriangleMesh mesh;
  std::string repairs;  ///< what repaired() did, for the report; empty where nothing changed
};

/// read_tool(), then repaired() where asked for (always for STEP: the kernel promises no orientation), then
/// check(). A sheet must turn its normals to the fabric, on the whole; repair turns it. This is what a run
/// uses.
/// @throws InputError
LoadedTool load_tool(const ToolFile& tool, const Expectation& expected);

}  // namespace heddle::macroscale
