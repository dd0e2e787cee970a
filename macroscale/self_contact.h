#pragma once

#include <span>
#include <string>
#include <vector>

#include <Eigen/Core>

#include "macroscale/ply_contact.h"

namespace heddle::macroscale {

class System;
struct State;
struct StepData;

/// Both faces of each cell, each of which may touch another part of the same ply: 2 q and 2 q + 1 are the
/// lower and upper face of quad q.
std::vector<PlyPoint> self_points(const Blank& blank);

/// What each face meets within `reach` of the middle of its cell: the nearest other part of its ply, in the
/// direction that the face looks. Neighbours are no other parts: cells that share a node, and those nearer
/// than two thicknesses along the flat sheet, which a bend as tight as the fabric is thick brings near.
/// @param points  of self_points
/// @return a pair a point; empty where no face meets anything
std::vector<PlyPair> pair_with_itself(const Blank& blank, std::span<const PlyPoint> points,
                                      const Eigen::VectorXd& x, double reach, double thickness);

/// Whether a step took one part of the sheet through another, or to it unseen, in words; "" if it did not. A
/// step that did is tried again with half of it, so that no side is lost.
std::string passage_of(const System& system, const StepData& step, const State& end);

}  // namespace heddle::macroscale
