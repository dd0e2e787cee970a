#include "macroscale/contact_points.h"

#include "macroscale/scene.h"

namespace heddle::macroscale {

namespace {

using Eigen::Vector3d;
using Eigen::VectorXd;

// Bilinear weights at the Gauss point nearest to a corner: of that corner, its two neighbours, the one
// across.
constexpr double gauss = 0.5773502691896258;  // 1 / sqrt(3)
constexpr double near_weight = 0.25 * (1.0 + gauss) * (1.0 + gauss),
                 side_weight = 0.25 * (1.0 - gauss * gauss),
                 far_weight = 0.25 * (1.0 - gauss) * (1.0 - gauss);

std::array<double, 4> weights_at(std::size_t corner) {
  std::array<double, 4> weight{};
  weight[corner] = near_weight;
  weight[(corner + 1) % 4] = weight[(corner + 3) % 4] = side_weight;
  weight[(corner + 2) % 4] = far_weight;
  return weight;
}

TowDirections at_node(const Blank& blank, const VectorXd& x, int node) {
  const auto [i, j] = blank.grid[node];
  const Ply& ply = blank.ply(blank.ply_of_node(node));
  const auto neighbour = [&](int line_i, int line_j) -> Vector3d {
    const bool outside = line_i < 0 || line_j < 0 || line_i > ply.nu || line_j > ply.nv;
    const int n = outside ? -1 : ply.node(line_i, line_j);
    return x.segment<3>(3 * (n < 0 ? node : n));
  };
  TowDirections tows{neighbour(i + 1, j) - neighbour(i - 1, j), neighbour(i, j + 1) - neighbour(i, j - 1)};
  // A tow that crosses a plane of symmetry does so at a right angle.
  for (std::size_t axis = 0; axis < 2; ++axis)
    if (on_plane(blank, node, axis)) {
      Vector3d& across = (std::abs(ply.warp[0]) > 0.5) == (axis == 0) ? tows.warp : tows.weft;
      across = Vector3d::Unit(static_cast<Eigen::Index>(axis)) * across[static_cast<Eigen::Index>(axis)];
    }
  return tows;
}

TowDirections in_cell(const std::array<int, 4>& quad, const VectorXd& x, std::size_t corner) {
  const auto node = [&](std::size_t k) -> Vector3d { return x.segment<3>(3 * quad[k]); };
  // Corners 0, 1 lie on the lower weft line, 0, 3 on the first warp line.
  const double upper = corner >= 2 ? 0.5 * (1.0 + gauss) : 0.5 * (1.0 - gauss);
  const double right = corner == 1 || corner == 2 ? 0.5 * (1.0 + gauss) : 0.5 * (1.0 - gauss);
  return {(1.0 - upper) * (node(1) - node(0)) + upper * (node(2) - node(3)),
          (1.0 - right) * (node(3) - node(0)) + right * (node(2) - node(1))};
}

}  // namespace

int contact_count(const Blank& blank, ContactSites sites) {
  return sites == ContactSites::nodes ? blank.nodes() : static_cast<int>(4 * blank.quads.size());
}

std::vector<ContactPoint> contact_points(const Blank& blank, ContactSites sites) {
  std::vector<ContactPoint> points;
  points.reserve(contact_count(blank, sites));
  if (sites == ContactSites::nodes) {
    for (int i = 0; i < blank.nodes(); ++i) points.push_back({{i}, {1.0}, 1, blank.node_area[i]});
    return points;
  }
  for (std::size_t q = 0; q < blank.quads.size(); ++q)
    for (std::size_t corner = 0; corner < 4; ++corner)
      points.push_back({blank.quads[q], weights_at(corner), 4,
                        blank.share[q] * blank.ply(blank.ply_of_quad(static_cast<int>(q))).corner_area()});
  return points;
}

std::vector<double> contact_shear_angle(const Blank& blank, ContactSites sites,
                                        const std::vector<double>& corner_angle) {
  if (sites == ContactSites::nodes) return nodal_shear_angle(blank, corner_angle);
  std::vector<double> angle;
  angle.reserve(corner_angle.size());
  for (std::size_t q = 0; q < blank.quads.size(); ++q) {
    const auto corners = corners_of(blank.quads[q]);
    for (std::size_t point = 0; point < 4; ++point) {
      const auto weight = weights_at(point);
      double sum = 0.0;
      for (std::size_t k = 0; k < 4; ++k) sum += weight[k] * (corners[k].sign * corner_angle[4 * q + k]);
      angle.push_back(sum);
    }
  }
  return angle;
}

TowDirections tow_directions(const Blank& blank, ContactSites sites, const VectorXd& x, int point) {
  if (sites == ContactSites::nodes) return at_node(blank, x, point);
  return in_cell(blank.quads[point / 4], x, static_cast<std::size_t>(point % 4));
}

}  // namespace heddle::macroscale
