// Contact between plies in the incremental potential: pairs, forces, matrix.
#include <array>
#include <utility>

#include <tbb/blocked_range.h>
#include <tbb/parallel_for.h>

#include "macroscale/self_contact.h"
#include "macroscale/system.h"

namespace heddle::macroscale {

namespace {

using Eigen::Matrix3d;
using Eigen::Vector3d;
using Eigen::VectorXd;

// A node further than this from the other ply, or from another part of its own, cannot reach it in one step,
// which moves tools by a thickness at most. [thicknesses]
constexpr double reach = 3.0;

}  // namespace

double System::self_reach() const {
  return reach * scene_.fabric->thickness;
}

int System::points_in_row(const StepData& step, int row) const {
  return row < static_cast<int>(scene_.tools.size()) ? contacts() : static_cast<int>(step.pairs.size());
}

friction::ContactState System::memory_in_row(const StepData& step, int row, int i) const {
  const auto& memory = step.start->memory;
  if (row >= static_cast<int>(memory.size()) || i >= static_cast<int>(memory[row].size())) return {};
  return memory[row][i];
}

bool System::rubs(const StepData& step, int row) const {
  return scene_.friction && !step.frictionless &&
         (row < static_cast<int>(scene_.tools.size()) || scene_.plies_rub);
}

double System::area_in_row(const StepData& step, int row, int i) const {
  return row < static_cast<int>(scene_.tools.size()) ? contact_area(step, i) : step.pairs[i].area;
}

Vector3d System::velocity_in_row(const StepData& step, const VectorXd& x, int row, int i) const {
  if (row < static_cast<int>(scene_.tools.size())) return relative_velocity(step, x, row, i);
  const PlyPair& pair = step.pairs[i];
  return pair.quad < 0 ? Vector3d::Zero() : Vector3d((slip(pair, x) - slip(pair, step.start->x)) / step.dt);
}

NormalContact System::contact_of_plies(const PlyPair& pair, const VectorXd& x) const {
  if (pair.quad < 0) return {};
  return ply_contact(pair.own ? compaction_ : ply_compaction(*scene_.fabric), gap(pair, x), pair.rest);
}

std::vector<PlyPair> System::pairs_at(const VectorXd& x, bool all) const {
  std::vector<PlyPair> pairs = pair_plies(scene_.blank, std::span(ply_points_).first(between_plies_), x,
                                          reach * scene_.fabric->thickness, scene_.ply_rest());
  if (!scene_.self_contact) return pairs;
  const std::vector<PlyPair> own =
      pair_with_itself(scene_.blank, self_points(), x, self_reach(), scene_.fabric->thickness);
  pairs.insert(pairs.end(), own.begin(), own.end());
  if (all) pairs.resize(ply_points_.size());
  return pairs;
}

void System::pair(StepData& step) {
  if (ply_points_.empty()) return;
  // Once a part of the sheet has met another, the pattern holds room for all faces: it outlives times in
  // which none meet.
  step.pairs = pairs_at(step.start->x, step.start->coupling.quad.size() > between_plies_);
  // A run that is resumed, and a step that is tried again, go on with the pattern of the state they start
  // from: the order of elimination decides the last bits.
  if (!(step.start->coupling == coupling_)) couple(step.start->coupling);
  if (step.pairs.empty() || covers(scene_.blank, coupling_, step.pairs)) return;
  couple(coupling_of(step.pairs));
  ++patterns_;
}

void System::couple(PlyCoupling coupling) {
  coupling_ = std::move(coupling);
  build_pattern();
  assemble_constant();
}

void System::evaluate_plies(const StepData& step, Position& at) const {
  const int count = static_cast<int>(step.pairs.size()), row = static_cast<int>(scene_.tools.size());
  at.ply_contacts.resize(step.pairs.size());
  const bool rub = count > 0 && rubs(step, row);
  if (rub) at.friction[row].resize(step.pairs.size());
  const FrictionSettings settings = friction_settings(row);
  tbb::parallel_for(tbb::blocked_range<int>(0, count, 256), [&](const tbb::blocked_range<int>& range) {
    for (int i = range.begin(); i != range.end(); ++i) {
      at.ply_contacts[i] = contact_of_plies(step.pairs[i], at.x);
      if (rub && step.friction[row][i].load > 0.0)
        at.friction[row][i] =
            friction_response(settings, step.friction[row][i], velocity_in_row(step, at.x, row, i));
    }
  });
}

// In the order of the points, so that sums do not depend on threads: a small part of a gradient's cost.
void System::add_forces_of_plies(const StepData& step, const Position& at, VectorXd& g) const {
  const int row = static_cast<int>(scene_.tools.size());
  for (std::size_t k = 0; k < step.pairs.size(); ++k) {
    const PlyPair& pair = step.pairs[k];
    if (pair.quad < 0) continue;
    const auto& nodes = pair.node;
    if (at.ply_contacts[k].pressure > 0.0) {
      const Vector3d push = -pair.area * at.ply_contacts[k].pressure * pair.normal;
      for (std::size_t a = 0; a < nodes.size(); ++a) g.segment<3>(3 * nodes[a]) += pair.weight[a] * push;
    }
    if (!rubs(step, row) || step.friction[row][k].load == 0.0) continue;
    const Vector3d drag = friction_force(step.friction[row][k], at.friction[row][k]);
    const auto factor = slip_factors(pair);
    for (std::size_t a = 0; a < nodes.size(); ++a) g.segment<3>(3 * nodes[a]) += factor[a].transpose() * drag;
  }
}

void System::add_contact_of_plies(const StepData& step, const Position& at, Filter filter) {
  const int row = static_cast<int>(scene_.tools.size());
  const FrictionTangent kind = filter == Filter::none       ? FrictionTangent::exact
                               : filter == Filter::positive ? FrictionTangent::convex
                                                            : FrictionTangent::secant;
  for (std::size_t k = 0; k < step.pairs.size(); ++k) {
    const PlyPair& pair = step.pairs[k];
    if (pair.quad < 0) continue;
    const double stiffness = pair.area * at.ply_contacts[k].stiffness;
    const bool rub = rubs(step, row) && step.friction[row][k].load > 0.0;
    if (stiffness == 0.0 && !rub) continue;
    const auto& nodes = pair.node;
    const auto& along = pair.weight;
    const Matrix3d press = stiffness * pair.normal * pair.normal.transpose();
    std::array<Matrix3d, 8> across, moved;
    if (rub) {
      const Matrix3d tangent =
          friction_tangent(friction_settings(row), step.friction[row][k], at.friction[row][k], kind) /
          step.dt;
      across = slip_factors(pair);
      for (std::size_t a = 0; a < nodes.size(); ++a) moved[a] = tangent * across[a];
    }
    for (std::size_t a = 0; a < nodes.size(); ++a)
      for (std::size_t b = 0; b < nodes.size(); ++b) {
        if (nodes[a] < nodes[b]) continue;
        Matrix3d part = along[a] * along[b] * press;
        if (rub) part += across[a].transpose() * moved[b];
        add_block(block(nodes[a], nodes[b]), part);
      }
  }
}

}  // namespace heddle::macroscale
