#pragma once

#include <array>
#include <limits>
#include <vector>

#include <Eigen/Core>

#include "macroscale/blank.h"

namespace heddle::macroscale {

/// Weights of a quad's corners at (u, v), 0..1 across it, and their slopes [-].
struct Bilinear {
  std::array<double, 4> value, along_u, along_v;
};
Bilinear bilinear(double u, double v);

/// Unit normals at the nodes of a blank at x: of the corners that meet there, by the share of their cells.
std::vector<Eigen::Vector3d> node_normals(const Blank& blank, const Eigen::VectorXd& x);

/// Middle of a quad at x [m].
Eigen::Vector3d middle_of(const std::array<int, 4>& quad, const Eigen::VectorXd& x);

/// Where a point lies over one quad along the normals interpolated between its corners: x = X(u, v) + h N(u,
/// v). Interpolated normals leave no gaps and no double cover between quads, whichever way the sheet bends.
struct Projection {
  double u = 0.5, v = 0.5;
  double h = 0.0;                                            ///< [m]
  double outside = std::numeric_limits<double>::infinity();  ///< how far off the quad [cells]; inf: not found
};
Projection project(const std::array<int, 4>& quad, const Eigen::VectorXd& x,
                   const std::vector<Eigen::Vector3d>& normals, const Eigen::Vector3d& point);

/// Quads of one ply by place, in boxes as large as the largest of them with what reaches it.
class QuadFinder {
 public:
  /// @param reach  how far off a quad a point may lie [m]
  /// @param radii  how far beside its middle, in radii of the largest quad: 2 is beyond half a cell off it
  QuadFinder(const Blank& blank, const Ply& ply, const Eigen::VectorXd& x, double reach, double radii = 2.0);

  double largest_radius() const { return radius_; }  ///< of a quad about its middle [m]

  /// Calls visit(quad, its middle) for every quad whose middle is within range, in one order whatever the
  /// threads do.
  template <class Visit>
  void near(const Eigen::Vector3d& x, const Visit& visit) const {
    std::array<int, 3> from{}, to{};
    for (int d = 0; d < 3; ++d) boxes_about(x[d], d, from[d], to[d]);
    for (int i = from[0]; i <= to[0]; ++i)
      for (int j = from[1]; j <= to[1]; ++j)
        for (int k = from[2]; k <= to[2]; ++k) {
          const std::size_t box = static_cast<std::size_t>(number({i, j, k}));
          for (int n = start_[box]; n < start_[box + 1]; ++n)
            if ((centre_[quads_[n]] - x).squaredNorm() <= range_ * range_)
              visit(first_ + quads_[n], centre_[quads_[n]]);
        }
  }

 private:
  void boxes_about(double x, int direction, int& from, int& to) const;
  int number(const std::array<int, 3>& at) const { return (at[0] * boxes_[1] + at[1]) * boxes_[2] + at[2]; }
  int first_;
  double radius_ = 0.0, range_ = 0.0;
  Eigen::Vector3d low_;
  std::array<int, 3> boxes_{};
  std::vector<Eigen::Vector3d> centre_;
  std::vector<int> start_, quads_;
};

}  // namespace heddle::macroscale
