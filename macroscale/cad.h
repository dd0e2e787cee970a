#pragma once

#include <array>
#include <cstddef>
#include <filesystem>
#include <stdexcept>
#include <string>
#include <vector>

#include "core/triangle_mesh.h"

namespace heddle::macroscale {

/// What the CAD kernel (gmsh with OpenCASCADE) cannot do with a file, and the way out.
class CadError : public std::runtime_error {
 public:
  CadError(std::string key, const std::string& what, std::string way_out)
      : std::runtime_error(what), key_(std::move(key)), way_out_(std::move(way_out)) {}
  const std::string& key() const { return key_; }  ///< "file" or "mesh_size"
  const std::string& way_out() const { return way_out_; }

 private:
  std::string key_, way_out_;
};

/// How fine a CAD surface is cut into triangles.
struct SurfaceResolution {
  double mesh_size = 2e-3;  ///< target of edges on curved faces and their borders [m]; single ones are up to
                            ///< twice as long (1.95 times on the shipped punch)
  double chord_error = 50e-6;  ///< facets of a curved face stay nearer to it than this [m]
  std::size_t most_triangles = 2000000;
};

/// Target of edges where the smaller radius of curvature is `radius`: sqrt(2 R chord_error), at which the
/// chord error (2 L)^2 / (8 R) of an edge twice as long is what is allowed, and at most mesh_size [m].
double edge_length(const SurfaceResolution& resolution, double radius);

/// Surface of the solids in a STEP file, or of its faces if it holds no solid. Closed where the solid is;
/// triangles of one face agree, but may point inwards (mesh_check repairs that).
///
/// Each face has one edge length, that of its smallest radius. Edges on planes, where every edge is exact,
/// grow to eight times `mesh_size` away from curved faces. Deterministic: one thread, Delaunay with a fixed
/// seed. OpenCASCADE writes to standard output, which is turned to /dev/null meanwhile: nothing else of the
/// process should write there. Calls wait for each other.
/// @throws CadError, also when the triangles estimated from areas and curvatures exceed the limit
TriangleMesh step_surface(const std::filesystem::path& file, const SurfaceResolution& resolution);

/// Low and high corner of the box around all that a STEP file holds [m].
/// @throws CadError
std::array<std::array<double, 3>, 2> step_box(const std::filesystem::path& file);

using Polyline = std::vector<std::array<double, 2>>;

/// Border curves of the one planar face in a STEP file, which must be parallel to z = 0, each as a chain of
/// points nearer than `chord_error` [m] to the curve. In no order; ends meet to OpenCASCADE's tolerance.
/// @throws CadError
std::vector<Polyline> step_face_curves(const std::filesystem::path& file, double chord_error);

/// Bounding box [m] and volume [m^3] of the solids in a STEP file, by OpenCASCADE.
struct CadSummary {
  std::array<double, 3> low{}, high{};
  double volume = 0.0;
  int solids = 0;
};
CadSummary summarise_step(const std::filesystem::path& file);

/// Runs a gmsh script with its parameter `tool` set and writes what it makes as STEP, with a header that
/// holds no date, so that the same script gives the same bytes.
void write_step(const std::filesystem::path& script, int tool, const std::filesystem::path& file);

}  // namespace heddle::macroscale
