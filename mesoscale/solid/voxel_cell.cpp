#include "mesoscale/solid/voxel_cell.h"

#include <Eigen/LU>
#include <algorithm>
#include <map>

namespace heddle::mesoscale::solid {

namespace {

// Voigt places of what is common to the layers (strains 11, 22, 12) and what is not (33, 23, 13), normal 3.
constexpr std::array<int, 3> along{0, 1, 5}, across{2, 3, 4};

Eigen::Matrix3d part(const Matrix6& c, const std::array<int, 3>& rows, const std::array<int, 3>& columns) {
  Eigen::Matrix3d result;
  for (int i = 0; i < 3; ++i)
    for (int j = 0; j < 3; ++j) result(i, j) = c(rows[i], columns[j]);
  return result;
}

void put(Matrix6& c, const std::array<int, 3>& rows, const std::array<int, 3>& columns,
         const Eigen::Matrix3d& from) {
  for (int i = 0; i < 3; ++i)
    for (int j = 0; j < 3; ++j) c(rows[i], columns[j]) = from(i, j);
}

// A rotation whose third column is the normal.
Eigen::Matrix3d frame_of(const Eigen::Vector3d& normal) {
  const Eigen::Matrix3d turn = turn_to(normal);
  Eigen::Matrix3d frame;
  frame << turn.col(1), turn.col(2), turn.col(0);
  return frame;
}

Matrix6 layers_across_z(std::span<const double> share, std::span<const Matrix6> stiffness) {
  Eigen::Matrix3d soft = Eigen::Matrix3d::Zero(), coupling = soft, plane = soft;
  for (std::size_t n = 0; n < share.size(); ++n) {
    const Eigen::Matrix3d inverse = part(stiffness[n], across, across).inverse();
    const Eigen::Matrix3d mixed = part(stiffness[n], across, along);
    soft += share[n] * inverse;
    coupling += share[n] * inverse * mixed;
    plane += share[n] * (part(stiffness[n], along, along) - mixed.transpose() * inverse * mixed);
  }
  const Eigen::Matrix3d stiff = soft.inverse();
  Matrix6 c;
  put(c, across, across, stiff);
  put(c, across, along, stiff * coupling);
  put(c, along, across, (stiff * coupling).transpose());
  put(c, along, along, plane + coupling.transpose() * stiff * coupling);
  return 0.5 * (c + c.transpose());
}

}  // namespace

std::vector<double> phase_shares(const VoxelCell& cell, std::size_t phases) {
  std::vector<std::size_t> voxels(cell.contents.size(), 0);
  for (const std::uint16_t c : cell.content) ++voxels[c];
  std::vector<double> shares(phases, 0.0);
  for (std::size_t c = 0; c < voxels.size(); ++c)
    for (const Portion& portion : cell.contents[c].portions)
      shares[portion.phase] +=
          portion.share * static_cast<double>(voxels[c]) / static_cast<double>(cell.content.size());
  return shares;
}

Matrix6 laminate(std::span<const double> share, std::span<const Matrix6> stiffness,
                 const Eigen::Vector3d& normal) {
  const bool has_void =
      std::any_of(stiffness.begin(), stiffness.end(), [](const Matrix6& c) { return c.isZero(0.0); });
  if (share.size() == 1) return stiffness[0];
  if (has_void) {
    Matrix6 mean = Matrix6::Zero();
    for (std::size_t n = 0; n < share.size(); ++n) mean += share[n] * stiffness[n];
    return mean;
  }
  const Eigen::Matrix3d frame = frame_of(normal);
  std::vector<Matrix6> turned;
  for (const Matrix6& c : stiffness) turned.push_back(rotated(c, frame.transpose()));
  return rotated(layers_across_z(share, turned), frame);
}

std::vector<Matrix6> layer_strains(std::span<const double> share, std::span<const Matrix6> stiffness,
                                   const Eigen::Vector3d& normal) {
  const bool has_void =
      std::any_of(stiffness.begin(), stiffness.end(), [](const Matrix6& c) { return c.isZero(0.0); });
  if (share.size() == 1 || has_void) return std::vector<Matrix6>(share.size(), Matrix6::Identity());
  const Eigen::Matrix3d frame = frame_of(normal);
  std::vector<Matrix6> turned;
  for (const Matrix6& c : stiffness) turned.push_back(rotated(c, frame.transpose()));
  const Matrix6 whole = layers_across_z(share, turned);
  std::vector<Matrix6> result;
  for (const Matrix6& c : turned) {
    // Stresses across the layers are those of the whole, strains along them too.
    const Eigen::Matrix3d inverse = part(c, across, across).inverse();
    Matrix6 strain = Matrix6::Zero();
    put(strain, along, along, Eigen::Matrix3d::Identity());
    put(strain, across, across, inverse * part(whole, across, across));
    put(strain, across, along, inverse * (part(whole, across, along) - part(c, across, along)));
    result.push_back(strain_turn(frame) * strain * strain_turn(frame.transpose()));
  }
  return result;
}

std::vector<Matrix6> content_stiffness(const VoxelCell& cell, std::span<const Matrix6> phases) {
  std::map<std::pair<std::uint16_t, std::uint16_t>, Matrix6> turned;
  const auto stiffness_of = [&](const Portion& portion) -> const Matrix6& {
    const auto [place, fresh] = turned.try_emplace({portion.phase, portion.direction});
    if (fresh) place->second = rotated(phases[portion.phase], turn_to(cell.directions[portion.direction]));
    return place->second;
  };
  std::vector<Matrix6> result;
  for (const VoxelContent& content : cell.contents) {
    std::vector<double> share;
    std::vector<Matrix6> stiffness;
    for (const Portion& portion : content.portions) {
      share.push_back(portion.share);
      stiffness.push_back(portion.direction == 0 ? phases[portion.phase] : stiffness_of(portion));
    }
    result.push_back(laminate(share, stiffness, content.normal));
  }
  return result;
}

ElasticCell elastic_cell(const VoxelCell& cell, std::span<const Matrix6> content_stiffness) {
  return {cell.count, cell.edges, cell.content, content_stiffness};
}

}  // namespace heddle::mesoscale::solid
