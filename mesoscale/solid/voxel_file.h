#pragma once

#include <filesystem>
#include <map>

#include "core/problem.h"
#include "mesoscale/solid/voxel_cell.h"

namespace heddle::mesoscale::solid {

enum class AxisOrder { x_fastest, z_fastest };
enum class VoxelFormat { labels, texgen };

/// Moduli of an isotropic phase; both zero: a void.
struct PhaseModuli {
  double bulk = 0.0;   ///< [Pa]
  double shear = 0.0;  ///< [Pa]
};

/// A cell from a file of labels, one or two bytes each (little endian), without a head; or from a voxel deck
/// of TexGen (texgen_file.h), which knows its shape, size and tows itself.
struct VoxelFileSpec {
  std::filesystem::path file;
  std::array<int, 3> shape{};    ///< voxels along x, y, z
  std::array<double, 3> size{};  ///< of the cell [m]
  AxisOrder order = AxisOrder::x_fastest;
  Faces faces = Faces::periodic;
  std::map<int, PhaseModuli> phases;  ///< by label; of a deck: 0 is the matrix
  VoxelFormat format = VoxelFormat::labels;
  std::filesystem::path orientations = {};  ///< of a deck: directions of its elements
  double length_unit = 1e-3;                ///< of a deck [m]
  TransverseIsotropy tow{};                 ///< of a deck: all its yarns, axis along their direction
  int cases = loads;                        ///< load cases side by side (SolverOptions)
};

/// Ranges, the size of the file, and a phase for every label in it (keys of the configuration file below
/// "cell").
Problems check(const VoxelFileSpec& spec);

/// A voxel cell and the stiffness of its phases.
struct ReadVoxels {
  VoxelCell cell;
  std::vector<Matrix6> phases;
};

/// @throws InputError  if check(spec) finds something
ReadVoxels read_voxels(const VoxelFileSpec& spec);

}  // namespace heddle::mesoscale::solid
