// Cell voxels as an HDF5 file that says how its axes lie.
#include "pipeline/voxel_export.h"

#include <catch2/catch.hpp>

#include "core/hdf5_file.h"
#include "mesoscale/cell.h"
#include "pipeline/outputs.h"

using namespace heddle;
using namespace heddle::pipeline;
using Catch::Matchers::Contains;
using mesoscale::solid::CellVoxels;

namespace {

// Where voxel {x, y, z} stands in a file, by what the file says of itself.
std::size_t place_in(const Hdf5Reader& file, std::array<int, 3> voxel) {
  const std::vector<int> count = file.integers("/count");
  std::size_t place = 0;
  for (const char axis : file.text("/axes")) {
    if (axis == ' ') continue;
    const auto a = static_cast<std::size_t>(axis - 'x');
    place = place * static_cast<std::size_t>(count[a]) + static_cast<std::size_t>(voxel[a]);
  }
  return place;
}

}  // namespace

TEST_CASE("a woven cell comes back from its voxel file by the order of axes that the file states",
          "[voxels][hdf5]") {
  mesoscale::WeaveSpec weave;
  weave.pattern = "satin 5/2";  // no two axes are alike
  weave.own[0].gap = 1.1e-3;
  const mesoscale::UnitCell cell =
      mesoscale::unit_cell(mesoscale::fabric_geometry(weave, mesoscale::CellState::as_woven), 0.0);
  const CellVoxels voxels = mesoscale::solid::cell_voxels(cell, 6, 10);
  const std::string bytes = voxels_hdf5(voxels);
  CHECK((voxels_hdf5(voxels) == bytes));
  const Hdf5Reader file(bytes);
  CHECK(file.text("/axes") == "z y x");
  CHECK(file.text("/order") == "x-fastest");
  CHECK(file.integers("/count") == std::vector<int>{30, 30, 10});
  const std::vector<double> origin = file.doubles("/origin_m"), spacing = file.doubles("/spacing_m");
  const std::vector<int> label = file.integers("/label");
  const std::vector<double> fraction = file.doubles("/tow_fraction"),
                            direction = file.doubles("/tow_direction");
  int tows = 0, misread = 0;
  for (int z = 0; z < 10; ++z)
    for (int y = 0; y < 30; ++y)
      for (int x = 0; x < 30; ++x) {
        const std::size_t at = place_in(file, {x, y, z});
        const mesoscale::Column column =
            mesoscale::column(cell, origin[0] + (x + 0.5) * spacing[0], origin[1] + (y + 0.5) * spacing[1]);
        const double height = origin[2] + (z + 0.5) * spacing[2];
        const bool warp = column.warp && column.warp_bottom <= height && height <= column.warp_top,
                   weft = column.weft && column.weft_bottom <= height && height <= column.weft_top;
        tows += warp || weft;
        CHECK((label[at] != 0) == (warp || weft));
        if (warp) CHECK(label[at] <= cell.weave.warps);
        if (weft && !warp) CHECK(label[at] > cell.weave.warps);
        // A full voxel of one warp runs along x and up or down, of one weft along y.
        if (fraction[at] > 0.999 && warp) CHECK(std::abs(direction[3 * at]) > 0.7);
        if (fraction[at] > 0.999 && weft && !warp) CHECK(std::abs(direction[3 * at + 1]) > 0.7);
        // The check can fail: read with x slowest it is another cell.
        const std::size_t wrong = (static_cast<std::size_t>(x) * 30 + static_cast<std::size_t>(y)) * 10 +
                                  static_cast<std::size_t>(z);
        misread += (label[wrong] != 0) != (warp || weft);
      }
  CHECK(tows > 1000);
  CHECK(misread > 1000);
}

TEST_CASE("shares of a cell's voxels add up to the volume of its tows, and directions are unit vectors",
          "[voxels][sampler]") {
  const mesoscale::UnitCell cell = mesoscale::unit_cell(
      mesoscale::fabric_geometry(mesoscale::WeaveSpec{}, mesoscale::CellState::as_woven), 0.0);
  const CellVoxels voxels = mesoscale::solid::cell_voxels(cell, 32, 24);
  double volume = 0.0;
  for (std::size_t v = 0; v < voxels.fraction.size(); ++v) {
    volume += static_cast<double>(voxels.fraction[v]);
    const float* d = voxels.direction.data() + 3 * v;
    const double length = d[0] * d[0] + d[1] * d[1] + d[2] * d[2];
    CHECK(length == Approx(voxels.fraction[v] > 0.0F ? 1.0 : 0.0).margin(1e-6));
  }
  for (const double step : voxels.grid.spacing) volume *= step;
  // Two warps and two wefts over two pitches: vertical cuts, so area times run.
  const double tows = 4.0 * area(cell.tow[0].section) * 2.0 * cell.tow[0].spacing;
  CHECK(volume == Approx(tows).epsilon(2e-3));
}

TEST_CASE("voxels that do not fit their cell are refused before a file is written", "[voxels][hdf5]") {
  const CellVoxels voxels{{{3, 2, 1}, {}, {1, 1, 1}, {0, 1, 2, 3, 4}}, {}, {}};
  CHECK_THROWS_WITH(voxels_hdf5(voxels), Contains("5 labels for 3 x 2 x 1 voxels"));
}
