#pragma once

#include <array>
#include <memory>
#include <span>
#include <vector>

#include <Eigen/Core>

#include "core/sparse_solver.h"
#include "macroscale/contact.h"
#include "macroscale/contact_points.h"
#include "macroscale/corner_element.h"
#include "macroscale/ply_contact.h"
#include "macroscale/scene.h"
#include "macroscale/tool_pose.h"

namespace heddle::macroscale {

/// What is held while one time step is solved: where it starts, its length, the frozen friction loads.
struct StepData {
  double dt = 0.0;  ///< [s]
  const State* start = nullptr;
  Eigen::VectorXd target;      ///< x_n + dt v_n: where inertia alone would go [m]
  std::vector<double> tool_z;  ///< end positions of fixed and driven tools [m]
  bool frictionless = false;   ///< friction switched off for this step (closing the binder)
  /// Trellis angle at each contact point at the start, which compaction holds over the step [rad]; empty:
  /// that of the flat fabric.
  std::vector<double> contact_shear;
  /// Per tool, per contact point: the lagged friction point (load 0 = no friction). Behind the tools, where
  /// there are any, per pair.
  std::vector<std::vector<FrictionPoint>> friction;
  /// Per ply point: what it meets at the start. Without the faces of cells as long as the sheet has met no
  /// other part of itself, so empty in a single ply.
  std::vector<PlyPair> pairs;
  Eigen::VectorXd iterate;  ///< the last position tried; the end of the step once it has converged [m]
};

/// One contact point against one tool.
struct ToolContact {
  Distance surface;
  NormalContact normal;
};

/// The same as a position keeps it, for every point and tool: without the curvature, which only those that
/// touch need, and only for a Hessian.
struct KeptContact {
  double distance = 0.0;                     ///< [m]
  Eigen::Vector3d direction{0.0, 0.0, 1.0};  ///< normal of the tool
  NormalContact normal;
};

/// A position with each law looked up there once: energy, forces and stiffness share it.
struct Position {
  Eigen::VectorXd x;                                    ///< [m]
  std::vector<CornerPoint> corners;                     ///< 4 a quad
  std::vector<std::vector<KeptContact>> contacts;       ///< per tool, per contact point
  std::vector<std::vector<FrictionResponse>> friction;  ///< the same; empty without friction
  std::vector<NormalContact> ply_contacts;  ///< per ply point; their friction is behind the tools'
};

/// Two positions to work in, of hundreds of bytes a node: kept between searches, so that only the first one
/// has to get their memory from the system.
struct SearchRoom {
  Position at, trial;
};

/// Energies of the incremental potential at one position [J]; friction only as a difference (see below).
struct PotentialTerms {
  double inertia = 0.0, tow = 0.0, shear = 0.0, rate = 0.0, bending = 0.0, twist = 0.0, compaction = 0.0;
  double tow_rate = 0.0;
  double loads = 0.0, stabilisation = 0.0;
  double compaction_plies = 0.0;  ///< between plies
  double total() const {
    return inertia + tow + shear + rate + bending + twist + compaction + loads + stabilisation +
           compaction_plies + tow_rate;
  }
};

/// The discrete incremental potential of one scene: value, gradient, Hessian, on a fixed pattern.
///     E(x) = 1/2 |x - x_n - dt v_n|_M^2 / dt^2 + U(x) + dt R + D + F_b z_b      (docs/theory/macroscale.md)
class System {
 public:
  explicit System(const Scene& scene);
  explicit System(Scene&&) = delete;  // the scene must outlive the system

  const Scene& scene() const { return scene_; }
  int size() const { return size_; }

  /// Looks everything up at at.x (which is set to x).
  void evaluate(const StepData& step, const Eigen::VectorXd& x, Position& at) const;

  PotentialTerms potential(const StepData& step, const Position& at) const;
  /// Change of the friction potential between two positions [J].
  double friction_difference(const StepData& step, const Position& from, const Position& to) const;
  /// dE/dx; at held unknowns it is the force their supports must give [N].
  Eigen::VectorXd full_gradient(const StepData& step, const Position& at) const;
  /// dE/dx with the entries of held unknowns set to zero.
  Eigen::VectorXd gradient(const StepData& step, const Position& at) const;
  /// Fills the solver's matrix with d2E/dx2 (held unknowns: identity) plus `shift` on the diagonal.
  void assemble(const StepData& step, const Position& at, Filter filter, double shift = 0.0);

  // The same at a position that is looked at once.
  PotentialTerms potential(const StepData& step, const Eigen::VectorXd& x) const;
  double friction_difference(const StepData& step, const Eigen::VectorXd& from,
                             const Eigen::VectorXd& to) const;
  Eigen::VectorXd full_gradient(const StepData& step, const Eigen::VectorXd& x) const;
  Eigen::VectorXd gradient(const StepData& step, const Eigen::VectorXd& x) const;
  void assemble(const StepData& step, const Eigen::VectorXd& x, Filter filter, double shift = 0.0);

  SparseSolver& solver() { return *solver_; }
  SearchRoom& room() { return room_; }
  /// Largest diagonal entry of the last assembled matrix [N/m].
  double largest_diagonal() const;

  /// Where tool k stands at the end of the step. Along z: its own unknown if it is loaded, that besides its
  /// drive's if it is sprung.
  Pose pose(const StepData& step, const Eigen::VectorXd& x, int k) const;
  /// The same of a state.
  Pose pose(const State& state, int k) const;
  /// The unknown of tool k along z, or -1; its lifts, if it tilts, are the two behind.
  int unknown_of(int k) const { return body_[k]; }
  /// Nodes or Gauss points: what touches and rubs.
  const std::vector<ContactPoint>& contact_points() const { return points_; }
  int contacts() const { return static_cast<int>(points_.size()); }
  /// Area on which the pressure of contact point i acts in this step [m^2]: of the flat blank, or, where
  /// compaction follows shear, of the sheared one.
  double contact_area(const StepData& step, int i) const;
  /// Where contact point i at x stands against tool k, and how hard they press.
  ToolContact tool_contact(const StepData& step, const Eigen::VectorXd& x, int k, int i) const;
  /// Velocity of contact point i against tool k over the step [m/s].
  Eigen::Vector3d relative_velocity(const StepData& step, const Eigen::VectorXd& x, int k, int i) const;
  /// Corner law of this step in a whole cell of a ply (time step and rate term included); `trimmed` gives a
  /// cut cell's.
  CornerLaw corner_law(const StepData& step, int ply = 0) const;
  std::vector<CornerLaw> corner_laws(const StepData& step) const;  ///< of all plies

  /// What may touch between plies, then where the sheet may touch itself; empty in a single ply that may not.
  const std::vector<PlyPoint>& ply_points() const { return ply_points_; }
  /// Those of them where the sheet may touch itself, and how far they look [m].
  std::span<const PlyPoint> self_points() const { return std::span(ply_points_).subspan(between_plies_); }
  double self_reach() const;
  /// Rows of friction: a tool each, and one of the pairs where there are any.
  int friction_rows(const StepData& step) const {
    return static_cast<int>(scene_.tools.size()) + !step.pairs.empty();
  }
  int points_in_row(const StepData& step, int row) const;
  /// What contact remembers at a point of any row; nothing at a pair that is the first of its kind.
  friction::ContactState memory_in_row(const StepData& step, int row, int i) const;
  /// Whether that row rubs in this step.
  bool rubs(const StepData& step, int row) const;
  /// Area [m^2] and velocity of slip [m/s] of a point of any row.
  double area_in_row(const StepData& step, int row, int i) const;
  Eigen::Vector3d velocity_in_row(const StepData& step, const Eigen::VectorXd& x, int row, int i) const;
  NormalContact contact_of_plies(const PlyPair& pair, const Eigen::VectorXd& x) const;
  /// Of all ply points, at positions x. @param all  whether they hold the faces of cells that meet nothing
  std::vector<PlyPair> pairs_at(const Eigen::VectorXd& x, bool all = false) const;
  /// Finds what the ply points meet at the start of the step, and makes a new pattern of the matrix where
  /// they have left the one there is, that of the state the step starts from.
  void pair(StepData& step);
  const PlyCoupling& coupling() const { return coupling_; }
  int patterns() const { return patterns_; }  ///< made because pairs had moved out of the one before
  /// Factor on its rate term in one cell: 1 at the blank's temperature.
  double rate_factor(const StepData& step, std::size_t quad) const {
    return step.start->heat.empty() ? 1.0 : step.start->heat.rate_factor[quad];
  }
  /// Factor on the rate-free shear resistance of the table in one cell, for the temperature at the start of
  /// the step: 1 unless shear softens.
  double shear_factor(const StepData& step, std::size_t quad) const;
  /// Strains of warp and weft of one corner at the start of the step [-].
  std::array<double, 2> strain_before(const StepData& step, const Corner& corner, const CornerLaw& law) const;

  const Curve& compaction() const { return compaction_; }
  /// The same for a point at x of the fabric, not sheared, against tool k where it stands.
  ToolContact contact_at(const Eigen::Vector3d& x, int k, const Pose& pose) const;
  /// The same for contact point i, at x, whose fabric is as it is held in the step.
  ToolContact contact_at(const StepData& step, const Eigen::Vector3d& x, int k, int i,
                         const Pose& pose) const;
  double mass(int unknown) const { return mass_[unknown]; }
  /// Of a row of friction: a tool may have a law of its own; plies rub by the scene's.
  FrictionSettings friction_settings(int row) const {
    const bool own = row < static_cast<int>(scene_.tools.size()) && scene_.tools[row].friction;
    return {own ? &*scene_.tools[row].friction : scene_.friction, scene_.slip_smoothing};
  }
  /// Energies and forces of the constant (quadratic) terms.
  double bending_stiffness(const TowTriple& triple) const;
  double bending_stiffness(const MirroredTriple& triple) const;
  double twist_stiffness(int quad) const;

 private:
  void build_pattern();
  void assemble_constant();
  void add_corners(const StepData& step, const Position& at, Filter filter);
  void add_contact(const StepData& step, const Position& at, Filter filter);
  void add_contact_in_cells(const StepData& step, const Position& at, Filter filter);
  void add_mirrored();
  void close_tool(const StepData& step, const Position& at, int k, Filter filter);
  void close_tilting(const StepData& step, const Position& at, int k, Filter filter,
                     double stiffness_along_z);
  void add_contact_of_plies(const StepData& step, const Position& at, Filter filter);
  void evaluate_plies(const StepData& step, Position& at) const;
  void add_forces_of_plies(const StepData& step, const Position& at, Eigen::VectorXd& g) const;
  void couple(PlyCoupling coupling);
  Pose pose_of(const Eigen::VectorXd& x, int k, double tool_z) const;
  Eigen::Vector3d contact_force(const StepData& step, const Position& at, int k, int i) const;
  Eigen::Vector3d force_on_tilting(const StepData& step, const Position& at, int k) const;
  Eigen::Matrix3d contact_stiffness(const StepData& step, const Position& at, int k, int i,
                                    Filter filter) const;
  Eigen::Matrix3d friction_stiffness(const StepData& step, const Position& at, int k, int i,
                                     Filter filter) const;
  /// Where a block's first value stands in the matrix, and how many its first column has.
  struct BlockPlace {
    int first, column_length;
    bool diagonal;  ///< then the lower triangle is there
  };
  void begin_matrix(const StepData& step);
  void finish_matrix(double shift);
  int block(int row_node, int column_node) const;
  /// Where row 0 of each column of a block would stand: row r is r behind it.
  std::array<double*, 3> columns_of(const BlockPlace& place) const;
  /// Adds a 3 x 3 block (rows of the larger node) to the matrix; of a diagonal one the lower triangle.
  void add_block(int block, const Eigen::Matrix3d& part);

  const Scene& scene_;
  int size_ = 0;
  std::vector<ContactPoint> points_;
  std::vector<PlyPoint> ply_points_;
  std::size_t between_plies_ = 0;  ///< how many of them
  PlyCoupling coupling_;
  int patterns_ = 0;
  Curve compaction_;          ///< of one face at gamma = 0
  std::vector<double> mass_;  ///< per unknown [kg]
  std::vector<int> body_;     ///< per tool: its first unknown, or -1

  // Blocks of the lower triangle by node columns: rows >= column, 3 x 3 each.
  std::vector<int> block_start_, block_row_;
  std::vector<BlockPlace> block_place_;
  std::vector<double> constant_;  ///< bending and twist: a multiple of the unit matrix in each block
  std::vector<std::vector<double>> body_row_;  ///< coupling of each unknown of a tool with those of all nodes
  /// Per unknown of a tool: its diagonal entry, and those with the tool's unknowns behind it.
  std::vector<std::vector<double>> body_column_;
  struct CornerSlots {
    std::array<int, 6> slot;      ///< cc, aa, bb, ac, bc, ab
    std::array<bool, 6> flipped;  ///< stored transposed because the row must be the larger node
  };
  std::vector<CornerSlots> corner_slots_;  ///< 4 a quad
  /// Per quad: blocks of its pairs of corners (1st with 1st; 2nd with 1st, 2nd; ...), for contact inside it.
  std::vector<std::array<int, 10>> cell_slots_;
  std::array<std::vector<int>, 4>
      colours_;  ///< quads that share no node, assembled in parallel without locks
  std::unique_ptr<SparseSolver> solver_;
  std::span<double> values_;  ///< of its matrix
  SearchRoom room_;
};

}  // namespace heddle::macroscale
