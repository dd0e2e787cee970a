#pragma once

#include <string>

namespace heddle::test {

/// The tools of the shipped case by their numbers: what a test of something else reads at once.
inline const std::string tools_by_shape =
    "tools={punch: {shape: hemisphere, radius: 70 mm}, die: {shape: ring, opening_radius: 72 mm, fillet: 20 "
    "mm}, "
    "binder: {shape: ring, inner_radius: 92 mm, mass: 20 kg}}";

/// The same from the shipped files, meshed and sampled coarsely: seconds instead of half a minute.
inline const std::string tools_by_file =
    "tools={punch: {file: tools/punch.step, length_unit: mm, mesh_size: 6 mm, voxel: 3 mm}, "
    "die: {file: tools/die.step, length_unit: mm, mesh_size: 6 mm, voxel: 3 mm}, "
    "binder: {file: tools/binder.step, length_unit: mm, mesh_size: 6 mm, voxel: 3 mm, mass: 20 kg}}";

}  // namespace heddle::test
