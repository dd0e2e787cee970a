#include "pipeline/export/part_layers.h"

#include <Eigen/Cholesky>
#include <Eigen/Eigenvalues>
#include <Eigen/LU>

#include "mesoscale/solid/solid_cell.h"

namespace heddle::pipeline {

namespace {

using Eigen::Matrix3d;
using Eigen::Vector3d;
using mesoscale::solid::Matrix6;
using mesoscale::solid::Vector6;

// Rows of a solid in the plane and across it.
constexpr std::array<int, 3> in_plane{0, 1, 5}, across_plane{2, 3, 4};

struct Heights {
  double outer, middle, arm;  // a, b, z [m]
  Heights(double thickness, double middle_share)
      : outer(0.5 * (1.0 - middle_share) * thickness),
        middle(middle_share * thickness),
        arm(0.5 * (outer + middle)) {}
};

// Smallest stiffness of a layer over that of the plate's mean, in any direction of strain [-].
double least_against(const Matrix3d& layer, const Matrix3d& mean) {
  const Matrix3d symmetric = 0.5 * (layer + layer.transpose());
  return Eigen::GeneralizedSelfAdjointEigenSolver<Matrix3d>(symmetric, mean, Eigen::EigenvaluesOnly)
      .eigenvalues()
      .minCoeff();
}

}  // namespace

std::optional<PartLayers> layers_of(const Matrix6& plate, const Vector6& held, double thickness,
                                    double middle_share, double least) {
  const Matrix3d a = plate.topLeftCorner<3, 3>(), b = plate.topRightCorner<3, 3>(),
                 d = plate.bottomRightCorner<3, 3>();
  const Heights h(thickness, middle_share);
  const double thin = h.middle * h.middle / 12.0, wide = h.arm * h.arm + h.outer * h.outer / 12.0;
  const Matrix3d sum = (d - thin * a) / (h.outer * (wide - thin)), difference = b / (h.outer * h.arm),
                 middle = (a - h.outer * sum) / h.middle;
  PartLayers layers{
      thickness, middle_share, {0.5 * (sum - difference), middle, 0.5 * (sum + difference)}, {}};
  const Matrix3d mean = a / thickness;
  for (Matrix3d& stiffness : layers.stiffness) {
    stiffness = (0.5 * (stiffness + stiffness.transpose())).eval();
    if (!(least_against(stiffness, mean) >= least)) return std::nullopt;
  }
  const Vector3d alpha = mesoscale::solid::free_strain(plate, held).head<3>();
  const Vector3d held_sum = (held.head<3>() - h.middle * middle * alpha) / h.outer,
                 held_difference = held.tail<3>() / (h.outer * h.arm);
  layers.expansion[1] = alpha;
  layers.expansion[0] = layers.stiffness[0].llt().solve(0.5 * (held_sum - held_difference));
  layers.expansion[2] = layers.stiffness[2].llt().solve(0.5 * (held_sum + held_difference));
  return layers;
}

Matrix6 plate_of(const PartLayers& layers) {
  const Heights h(layers.thickness, layers.middle_share);
  const std::array<double, 3> thickness{h.outer, h.middle, h.outer}, height{-h.arm, 0.0, h.arm};
  Matrix6 plate = Matrix6::Zero();
  for (std::size_t k = 0; k < 3; ++k) {
    const double t = thickness[k], z = height[k];
    plate.topLeftCorner<3, 3>() += t * layers.stiffness[k];
    plate.topRightCorner<3, 3>() += t * z * layers.stiffness[k];
    plate.bottomRightCorner<3, 3>() += (t * z * z + t * t * t / 12.0) * layers.stiffness[k];
  }
  plate.bottomLeftCorner<3, 3>() = plate.topRightCorner<3, 3>().transpose();
  return plate;
}

Vector6 held_of(const PartLayers& layers) {
  const Heights h(layers.thickness, layers.middle_share);
  const std::array<double, 3> thickness{h.outer, h.middle, h.outer}, height{-h.arm, 0.0, h.arm};
  Vector6 held = Vector6::Zero();
  for (std::size_t k = 0; k < 3; ++k) {
    const Vector3d stress = layers.stiffness[k] * layers.expansion[k];
    held.head<3>() += thickness[k] * stress;
    held.tail<3>() += thickness[k] * height[k] * stress;
  }
  return held;
}

Matrix6 solid_of(const Matrix3d& plane, const Matrix6& across) {
  const Matrix3d zz = across(across_plane, across_plane), pz = across(in_plane, across_plane);
  Matrix6 solid = across;
  solid(in_plane, in_plane) = plane + pz * zz.ldlt().solve(pz.transpose());
  return solid;
}

Vector6 solid_expansion(const Vector3d& plane, const Vector6& across) {
  Vector6 strain = across;
  strain(in_plane) = plane;
  return strain;
}

}  // namespace heddle::pipeline
