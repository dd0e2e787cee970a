#pragma once

#include "mesoscale/solid/voxel_file.h"

namespace heddle::mesoscale::solid {

/// Whether spec.file is a voxel deck as TexGen writes it for Abaqus, with the directions of its elements in
/// spec.orientations, and whether the constants of its tows are those of a stable material.
///
/// What is read of the deck: *Node blocks without a set, *Element blocks of type C3D8 or C3D8R, and the
/// element sets Matrix and Yarn0, Yarn1, ...; all else (boundary conditions, materials, steps) is passed
/// over. Nodes must stand on a box of equal voxels, one element in each, in any order. The line of an element
/// in the file of directions is its number, the direction of the fibres, and a second vector that is not
/// needed here; the line without a number is Abaqus' default. Source: TexGen 3 (Core/VoxelMesh.cpp), whose
/// files these must be.
Problems check_texgen(const VoxelFileSpec& spec);

/// Phase 0 is the matrix, phase 1 the tows. Directions are rounded to a 256th of their components, 0.2
/// degrees.
/// @throws InputError  if check_texgen(spec) finds something
ReadVoxels read_texgen(const VoxelFileSpec& spec);

}  // namespace heddle::mesoscale::solid
