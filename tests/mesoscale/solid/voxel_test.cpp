#include <Eigen/LU>
#include <catch2/catch.hpp>
#include <filesystem>
#include <fstream>

#include "mesoscale/solid/voxel_file.h"
#include "sample_cells.h"

using namespace heddle::mesoscale::solid;
using namespace heddle::test;
namespace fs = std::filesystem;

namespace {

struct ScratchFile {
  explicit ScratchFile(const std::string& bytes)
      : path(fs::temp_directory_path() / ("heddle_voxels_" + std::to_string(bytes.size()) + ".raw")) {
    std::ofstream(path, std::ios::binary) << bytes;
  }
  ~ScratchFile() { fs::remove(path); }
  fs::path path;
};

VoxelFileSpec two_by_one_by_two(const fs::path& file) {
  return {file,
          {2, 1, 2},
          {1e-3, 1e-3, 1e-3},
          AxisOrder::x_fastest,
          Faces::periodic,
          {{0, {1e9, 0.5e9}}, {7, {2e9, 1e9}}}};
}

}  // namespace

TEST_CASE("labels of one and of two bytes read alike, in either order of axes", "[solid][voxels]") {
  const std::string one("\0\7\0\0", 4), two("\0\0\7\0\0\0\0\0", 8);
  const ScratchFile narrow(one), wide(two);
  for (const auto* file : {&narrow, &wide}) {
    const ReadVoxels read = read_voxels(two_by_one_by_two(file->path));
    CHECK(read.cell.content == std::vector<std::uint16_t>{0, 1, 0, 0});
    CHECK(phase_shares(read.cell, 2) == std::vector<double>{0.75, 0.25});
  }
  VoxelFileSpec turned = two_by_one_by_two(narrow.path);
  turned.order = AxisOrder::z_fastest;
  CHECK(read_voxels(turned).cell.content == std::vector<std::uint16_t>{0, 0, 1, 0});
}

TEST_CASE("a voxel file that does not fit its case is named with both numbers", "[solid][voxels]") {
  const ScratchFile file(std::string("\0\7\0\0", 4));
  VoxelFileSpec spec = two_by_one_by_two(file.path);
  spec.shape = {3, 1, 2};
  heddle::Problems problems = check(spec);
  REQUIRE(problems.size() == 1);
  CHECK(problems[0].id == "cell.voxels.file.size");
  CHECK_THROWS_AS(read_voxels(spec), heddle::InputError);

  spec = two_by_one_by_two(file.path);
  spec.phases.erase(7);
  problems = check(spec);
  REQUIRE(problems.size() == 1);
  CHECK(problems[0].id == "cell.phases.missing");

  spec = two_by_one_by_two(file.path);
  for (auto& [label, moduli] : spec.phases) moduli = {0.0, 0.0};
  problems = check(spec);
  REQUIRE(problems.size() == 1);
  CHECK(problems[0].id == "cell.phases.solid");

  spec = two_by_one_by_two(file.path);
  spec.phases[7] = {1e9, 0.0};
  spec.shape[1] = 0;
  spec.size[2] = -1.0;
  problems = check(spec);
  REQUIRE(problems.size() == 3);
  CHECK(problems[0].id == "cell.voxels.shape.range");
  CHECK(problems[1].id == "cell.voxels.size.range");
  CHECK(problems[2].id == "cell.phases.7.void");
}

TEST_CASE("layers of a voxel turn with their normal, and layers of one material are that material",
          "[solid][voxels]") {
  const Matrix6 a = stiffness(polypropylene), b = tow_stiffness();
  const Eigen::Matrix3d turn = turn_to({0.3, 1.0, 0.5});
  const std::vector<double> share{0.3, 0.7};
  const Matrix6 level = laminate(share, std::vector<Matrix6>{a, b}, Eigen::Vector3d::UnitZ());
  const Matrix6 turned = laminate(share, std::vector<Matrix6>{rotated(a, turn), rotated(b, turn)},
                                  turn * Eigen::Vector3d::UnitZ());
  CHECK(gap(turned, rotated(level, turn)) < 1e-13);
  CHECK(gap(laminate(share, std::vector<Matrix6>{b, b}, Eigen::Vector3d(1, 2, 3)), b) < 1e-13);
  // Across: compliances add up. Along: stiffnesses do, for equal Poisson coupling.
  CHECK(1.0 / level(4, 4) == Approx(0.3 / a(4, 4) + 0.7 / b(4, 4)));
  CHECK(level(5, 5) == Approx(0.3 * a(5, 5) + 0.7 * b(5, 5)));
}

TEST_CASE("a void in a mixed voxel takes its share of the stiffness", "[solid][voxels]") {
  const std::vector<double> share{0.25, 0.75};
  const Matrix6 c = stiffness(polypropylene);
  const std::vector<Matrix6> layers{Matrix6::Zero(), c};
  CHECK(gap(laminate(share, layers, Eigen::Vector3d::UnitZ()), 0.75 * c) < 1e-15);
}
