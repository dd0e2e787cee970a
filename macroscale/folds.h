#pragma once

#include <array>
#include <numbers>
#include <vector>

#include <Eigen/Core>

#include "macroscale/blank.h"
#include "macroscale/stamping.h"

namespace heddle::macroscale {

/// From where on a turn of the sheet is a fold: normals within four spacings of each other.
inline constexpr double fold_turn = 2.0 * std::numbers::pi / 3.0;  ///< [rad]
inline constexpr int fold_span = 4;                                ///< [spacings]

/// One connected part of the grid whose nodes fold or come near another part of the sheet.
struct FoldPlace {
  int nodes = 0;
  std::array<double, 3> at{};  ///< their mean position [m]
  double turn = 0.0;           ///< largest turn among them [rad]
  double distance = 0.0;       ///< smallest distance to another part among them [m]; reach if none is near
};

/// Where a formed sheet folds on itself. Read off a state; nothing of it acts on the run.
struct Folds {
  /// Per node: largest angle between the sheet's normal there and up to four spacings away, along the tows
  /// and between them [rad].
  std::vector<double> turn;
  /// Per node: distance to the nearest cell that is no neighbour, at most `reach` [m]. Neighbours are closer
  /// than four spacings or four thicknesses in the flat sheet: what lies closer there may come near by shear
  /// and curvature alone, and is told by its turn.
  std::vector<double> distance;
  double reach = 0.0;            ///< the fabric's thickness [m]
  int folded = 0;                ///< nodes beyond fold_turn
  int near = 0;                  ///< nodes nearer than `reach` to another part
  int crossings = 0;             ///< tow segments that pass through a cell that shares no node with them
  std::vector<FoldPlace> place;  ///< largest first

  bool any() const { return folded + near + crossings > 0; }
};

/// @param thickness  of the fabric: two parts whose middles are nearer than this touch [m]
Folds find_folds(const BlankState& blank, double thickness);

/// Its `crossings` by itself, of a blank whose nodes stand at x [m].
int count_crossings(const Blank& blank, const Eigen::VectorXd& x);

}  // namespace heddle::macroscale
