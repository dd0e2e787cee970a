#include "mesoscale/solid/element.h"

#include <Eigen/Eigenvalues>
#include <catch2/catch.hpp>
#include <random>

#include "sample_cells.h"

using namespace heddle::mesoscale::solid;
using namespace heddle::test;

namespace {

VoxelEdges oblique() {
  VoxelEdges edges;
  edges << 1.0, 0.3, 0.1, 0.0, 0.8, -0.2, 0.1, 0.0, 0.5;
  return 1e-3 * edges;
}

Matrix6 general_stiffness() {
  return rotated(tow_stiffness(), turn_to({1.0, 0.7, -0.4}));
}

struct Planes {
  int nx, ny, cases;
  std::vector<double> lower, upper, force_lower, force_upper;
  std::vector<std::uint16_t> material;
  std::vector<ElementTable> tables;

  Planes(int x, int y, std::vector<ElementTable> of_materials, int side_by_side)
      : nx(x),
        ny(y),
        cases(side_by_side),
        material(static_cast<std::size_t>(x) * y),
        tables(std::move(of_materials)) {
    std::mt19937 generator(7);
    std::uniform_real_distribution<double> number(-1.0, 1.0);
    const std::size_t size = static_cast<std::size_t>(3 * cases) * x * y;
    for (auto* field : {&lower, &upper}) {
      field->resize(size);
      for (double& value : *field) value = number(generator);
    }
    for (auto* field : {&force_lower, &force_upper}) field->assign(size, 0.0);
    for (auto& m : material) m = static_cast<std::uint16_t>(generator() % tables.size());
  }
  VoxelLayer layer() {
    return {nx,
            ny,
            lower.data(),
            upper.data(),
            force_lower.data(),
            force_upper.data(),
            material.data(),
            tables.data(),
            cases};
  }
  std::size_t at(int i, int j, int component, int load) const {
    return static_cast<std::size_t>(((j % ny) * nx + i % nx) * 3 + component) * cases +
           static_cast<std::size_t>(load);
  }
};

}  // namespace

TEST_CASE("a voxel's matrix has six motions without force and no other", "[solid][element]") {
  const auto k = element_matrix(general_stiffness(), oblique());
  CHECK((k - k.transpose()).norm() / k.norm() < 1e-15);
  const auto values = Eigen::SelfAdjointEigenSolver<Eigen::MatrixXd>(k).eigenvalues();
  CHECK(values[5] / values[23] < 1e-14);
  CHECK(values[6] / values[23] > 1e-4);  // full integration leaves no hourglass
}

TEST_CASE("the layer product is the sum of the voxels' matrices at all Gauss points", "[solid][element]") {
  const auto instructions = GENERATE(Instructions::plain, Instructions::avx2, Instructions::avx512);
  if (static_cast<int>(instructions) > static_cast<int>(best_instructions()))
    return;  // not on this processor
  const std::vector<Matrix6> stiffness{general_stiffness(), isotropic_stiffness(2e9, 1e9)};
  Planes planes(3, 2, element_tables(stiffness, oblique()), GENERATE(loads, pair_of_loads));
  const auto energy = apply_layer(planes.layer(), instructions);

  std::vector<double> lower(planes.lower.size(), 0.0), upper(planes.upper.size(), 0.0);
  std::array<double, loads> expected_energy{};
  for (int j = 0; j < planes.ny; ++j)
    for (int i = 0; i < planes.nx; ++i) {
      const auto k =
          element_matrix(stiffness[planes.material[static_cast<std::size_t>(j * planes.nx + i)]], oblique());
      for (int l = 0; l < planes.cases; ++l) {
        Eigen::Matrix<double, 24, 1> u;
        for (int n = 0; n < 8; ++n)
          for (int c = 0; c < 3; ++c)
            u[3 * n + c] =
                (n & 4 ? planes.upper : planes.lower)[planes.at(i + (n & 1), j + (n >> 1 & 1), c, l)];
        const Eigen::Matrix<double, 24, 1> f = k * u;
        expected_energy[static_cast<std::size_t>(l)] += u.dot(f);
        for (int n = 0; n < 8; ++n)
          for (int c = 0; c < 3; ++c)
            (n & 4 ? upper : lower)[planes.at(i + (n & 1), j + (n >> 1 & 1), c, l)] += f[3 * n + c];
      }
    }
  const auto map = [](const std::vector<double>& v) {
    return Eigen::Map<const Eigen::VectorXd>(v.data(), static_cast<Eigen::Index>(v.size()));
  };
  CHECK(gap(map(planes.force_lower), map(lower)) < 1e-14);
  CHECK(gap(map(planes.force_upper), map(upper)) < 1e-14);
  for (std::size_t l = 0; l < loads; ++l) CHECK(energy[l] == Approx(expected_energy[l]).epsilon(1e-13));
}
