#pragma once

#include <array>
#include <span>
#include <string>
#include <vector>

#include "macroscale/stamping.h"
#include "mesoscale/solid/sampler.h"

/// Files for ParaView and VTK: XML with the numbers appended raw and compressed by zlib.
namespace heddle::pipeline {

/// One value, or several, at each point or in each cell.
struct DataArray {
  std::string name;  ///< with its unit, for instance "shear_angle_deg"
  int components = 1;
  std::vector<double> values;  ///< components of the first point, then of the second
};

enum class Precision { single_precision, double_precision };

struct QuadMesh {
  std::vector<std::array<double, 3>> points;  ///< [m]
  std::vector<std::array<int, 4>> quads;
  std::vector<DataArray> point_data, cell_data;
};

/// A .vtu file. Points are always in double precision; the arrays as asked.
/// @throws OutputError  if an array does not fit the mesh or a number is not finite; names the array
std::string vtu(const QuadMesh& mesh, Precision precision = Precision::single_precision);

/// A .vtu file of the surfaces of tows [m], with the number of each (`tow`: warps, then wefts) and its family
/// (`family`: 1 warp, 2 weft).
/// @throws OutputError  if a triangle names a vertex that is not there, or a number is not finite
std::string tows_vtu(const mesoscale::TowSurfaces& tows, int warps);

/// A place in a cell, in the cell's own coordinates, on the formed blank [m]. Bilinear.
std::array<double, 3> position_in(const macroscale::BlankState& blank, const std::array<int, 4>& quad,
                                  const macroscale::Point2& local);

/// What a picture of the blank needs: displaced nodes with shear angle, tow strains, velocity, contact and
/// friction. Cells that the outline cuts are there as their pieces, on points of their own.
QuadMesh mesh_of(const macroscale::BlankState& blank);

/// Adds values of the blank's nodes, one after the other with their components, to a mesh that mesh_of made.
void add_nodal(QuadMesh& mesh, const macroscale::BlankState& blank, DataArray values);

struct SeriesFrame {
  double time = 0.0;  ///< [s]
  std::string file;   ///< relative to the .pvd file
};

/// A .pvd file: the frames of a series in order of time.
std::string pvd(std::span<const SeriesFrame> frames);

/// A .vti file (image data): `label`, `tow_fraction` and `tow_direction` of each voxel.
/// @throws OutputError  if there are not as many of each as voxels
std::string vti(const mesoscale::solid::CellVoxels& voxels);

}  // namespace heddle::pipeline
