#include "pipeline/voxel_export.h"

#include <algorithm>
#include <span>

#include <fmt/format.h>

#include "core/hdf5_file.h"
#include "pipeline/outputs.h"

namespace heddle::pipeline {

void check_voxels(const mesoscale::solid::CellVoxels& voxels) {
  std::size_t expected = 1;
  for (const int count : voxels.grid.count) expected *= static_cast<std::size_t>(std::max(count, 0));
  const auto check = [&](std::size_t found, std::size_t each, const char* what) {
    if (found != each * expected)
      throw OutputError(fmt::format("voxel file: {} {} for {} x {} x {} voxels", found, what,
                                    voxels.grid.count[0], voxels.grid.count[1], voxels.grid.count[2]));
  };
  check(voxels.grid.labels.size(), 1, "labels");
  check(voxels.fraction.size(), 1, "tow fractions");
  check(voxels.direction.size(), 3, "components of tow directions");
}

std::string voxels_hdf5(const mesoscale::solid::CellVoxels& voxels) {
  check_voxels(voxels);
  const auto length = [&](std::size_t axis) { return static_cast<std::size_t>(voxels.grid.count[axis]); };
  const std::vector<std::size_t> shape{length(2), length(1), length(0)};
  Hdf5Writer file;
  file.write("/kind", "cell voxels");
  file.write("/axes", "z y x");
  file.write("/order", "x-fastest");
  file.write("/count", voxels.grid.count);
  file.write("/origin_m", voxels.grid.origin);
  file.write("/spacing_m", voxels.grid.spacing);
  file.write_packed("/label", std::span(voxels.grid.labels), shape);
  file.write_packed("/tow_fraction", std::span(voxels.fraction), shape);
  file.write_packed("/tow_direction", std::span(voxels.direction), {shape[0], shape[1], shape[2], 3});
  return file.finish();
}

}  // namespace heddle::pipeline
