#pragma once

#include <array>
#include <cstdint>
#include <functional>
#include <memory>
#include <optional>
#include <string>
#include <utility>
#include <vector>

#include "core/curve.h"
#include "core/problem.h"
#include "friction/model.h"
#include "macroscale/cell_piece.h"
#include "macroscale/fabric_effects.h"
#include "macroscale/outline.h"
#include "macroscale/press.h"
#include "macroscale/shear_friction.h"
#include "macroscale/symmetry.h"
#include "macroscale/thermal/blank_heat.h"
#include "macroscale/tool_file.h"
#include "mesoscale/fabric_properties.h"

namespace heddle::macroscale {

enum class BlankShape { rectangle, circle, polygon };

struct RoundHole {
  Point2 centre{};      ///< [m]
  double radius = 0.0;  ///< [m]
};

struct BlankSpec {
  BlankShape shape = BlankShape::rectangle;
  std::array<double, 2> size{0.32, 0.32};  ///< of a rectangle, along x and y [m]
  double radius = 0.16;                    ///< of a circle [m]
  Outline polygon;                         ///< with holes of any shape [m]
  std::vector<RoundHole> holes;            ///< cut out of any shape
  double orientation = 0.0;                ///< warp against x [rad]
  double turned = 0.0;      ///< how far the whole blank, outline and tows, was laid down turned [rad]
  double spacing = 4.5e-3;  ///< upper bound of the node spacing [m]
  int plies = 1;
  std::vector<double>
      layup;             ///< warp of each ply against `orientation`, bottom first; empty: all alike [rad]
  double nesting = 0.0;  ///< how much nearer than a thickness two plies lie unpressed [m]
  Symmetry symmetry = Symmetry::none;
};

/// All plies on one another before anything presses them [m].
inline double stack_thickness(const BlankSpec& blank, double ply_thickness) {
  return blank.plies * ply_thickness - (blank.plies - 1) * blank.nesting;
}

/// The blank's edge about the punch axis, whatever its shape. Circles are polygons within 2e-5 of the radius.
Outline outline_of(const BlankSpec& blank);

struct LoadedToolFile;

/// A tool given by a file instead of by its shape's numbers.
struct ToolFileSpec {
  ToolFile source;
  double voxel = 1e-3;                           ///< of the distance field [m]
  std::shared_ptr<const LoadedToolFile> loaded;  ///< what the file holds, once with_tools_loaded has read it
};

struct PunchSpec {                   ///< hemisphere with its apex down and a cylinder above, or a file
  double radius = 0.070;             ///< [m]
  std::optional<ToolFileSpec> file;  ///< then the numbers of the shape are not used
  std::optional<double> friction_coefficient;  ///< constant, in place of the law and its effects [-]
};
/// What lies below the opening of a die: nothing, a level floor, or a bowl of the opening's radius.
enum class DieBottom { open, flat, bowl };

struct DieSpec {                  ///< plate with a round opening and a filleted edge
  double opening_radius = 0.072;  ///< [m]
  double fillet = 0.020;          ///< [m]
  DieBottom bottom = DieBottom::open;
  double depth = 0.0;  ///< of the bottom's lowest point below the die's face [m]
  std::optional<ToolFileSpec> file;
  std::optional<double> friction_coefficient;  ///< constant, in place of the law and its effects [-]
};
/// What holds the binder: its force, or stops that keep its face at a gap from the die's.
enum class BinderControl { force, gap };

struct BinderSpec {             ///< flat ring under force, free to move in z
  double inner_radius = 0.092;  ///< [m]
  double edge_fillet = 2e-3;    ///< [m], keeps contact smooth where fabric leaves it
  double mass = 20.0;           ///< [kg]
  BinderControl control = BinderControl::force;
  double gap = 0.0;  ///< between the faces of binder and die, for BinderControl::gap [m]
  double stiffness =
      0.0;  ///< of the springs behind the binder: its force grows by this as it is lifted [N/m]
  bool free_tilt = false;  ///< turns about level axes as the fabric below it asks; else it stays level
  int sectors = 1;         ///< equal ones, each with its share of force, springs and mass, free by itself
  std::optional<ToolFileSpec> file;
  std::optional<double> friction_coefficient;  ///< constant, in place of the law and its effects [-]
};

struct ProcessSpec {
  double stroke = 0.070;  ///< [m]
  double time = 0.43;     ///< of the stroke at speed_scale 1 [s]
  /// Travel [m] over time [s] at speed_scale 1, rising from (0, 0) to (time, stroke); absent: constant speed
  /// with slow_down at the end.
  std::optional<Curve> profile;
  double slow_down =
      0.0;  ///< the punch stops linearly over this last part [s]; 0.01 in the paper (section 3.2.2)
  double speed_scale = 1.0;     ///< 0.5 = half speed [-]
  int steps = 100;              ///< equal in stroke
  double binder_force = 650.0;  ///< as asked for [N]
  double hold = 0.0;  ///< longest time that the tools stay closed after the stroke, until no melt is left [s]
  double tool_temperature = 358.15;   ///< [K]
  double blank_temperature = 453.15;  ///< [K]
  double cooling_rate = 0.0;  ///< of the blank towards the tools' temperature, without `thermal` [1/s]
  PressSpec press;

  /// What the press truly puts on the binder [N].
  double applied_binder_force() const { return binder_force * (1.0 + press.binder_force_error); }
};

/// No woven fabric holds more under a binder [Pa].
inline constexpr double crush_pressure = 5e6;

/// Non-physical helps. Off here; a report that used one says so.
struct ArtefactSpec {
  double mass_scaling = 1.0;   ///< factor on areal density [-]
  double stabilisation = 0.0;  ///< nodal damping per area [N s/m^3]
};

enum class ContactPressure { real, nominal };

/// Where the fabric is asked for contact and friction: at its nodes, each with its tributary area, or at 2 x
/// 2 Gauss points of each cell.
enum class ContactSites { nodes, gauss };

struct StampingSpec {
  BlankSpec blank;
  PunchSpec punch;
  DieSpec die;
  BinderSpec binder;
  ProcessSpec process;
  ArtefactSpec artefact;
  double shear_rate = 1.0;       ///< factor on the rate-dependent shear resistance; 0 is off [-]
  ShearFriction shear_friction;  ///< share of the shear resistance that is friction; 0 is off
  ContactPressure contact_pressure = ContactPressure::real;
  ContactSites contact_sites = ContactSites::nodes;
  bool compaction_follows_shear =
      false;                 ///< p(d, gamma) on current areas; off: the flat fabric's, initial areas
  bool self_contact = true;  ///< whether a ply that folds touches itself
  std::optional<thermal::ThermalSpec> thermal;  ///< absent: one temperature a run
  FabricEffects effects;                        ///< all off by default
};

/// One accepted step: a row of history.csv. Energies are cumulative since the punch touched [J].
struct HistoryRow {
  double time = 0.0;                                              ///< [s]
  double punch_displacement = 0.0;                                ///< of its drive [m], downwards positive
  double punch_force = 0.0, die_force = 0.0, binder_force = 0.0;  ///< [N]; punch: pushing positive
  double draw_in_max = 0.0;                                       ///< along the outline [m]
  double shear_angle_max = 0.0;                                   ///< [rad]
  double tow_strain_max = 0.0;                                    ///< [-]
  int newton_iterations = 0;
  int lag_iterations = 0;
  int folded_nodes = 0, near_nodes = 0, self_crossings = 0;  ///< of macroscale/folds.h
  double work_punch = 0.0, work_binder = 0.0;
  double work_gravity = 0.0;  ///< by the weight of fabric and binder
  double energy_tow = 0.0, energy_shear = 0.0, energy_bending = 0.0, energy_twist = 0.0,
         energy_compaction = 0.0;
  double energy_kinetic = 0.0;
  double energy_press = 0.0;  ///< in the frame of the press and the springs of the binder
  double friction_punch = 0.0, friction_die = 0.0, friction_binder = 0.0;
  double friction_plies = 0.0;                ///< between plies
  double dissipation_shear_hysteresis = 0.0;  ///< friction between tows
  double dissipation_tow_rate = 0.0;          ///< tows that resist the rate of their stretch
  double dissipation_shear_rate = 0.0, dissipation_artefact = 0.0, dissipation_numerical = 0.0;
  double ledger_residual = 0.0;        ///< what the columns above leave over [J]
  double force_balance = 0.0;          ///< |sum F - sum m a| [N]
  double friction_work_outside = 0.0;  ///< done outside the calibrated box [J]
  double punch_deflection = 0.0;       ///< how far the punch stays behind punch_displacement, its drive's [m]
  double binder_tilt = 0.0;            ///< of a binder that is free to tilt, against level [rad]
  std::optional<HeatRow> heat;         ///< of a run with temperatures
};

/// A point of the blank's edge, and how far it has moved in.
struct EdgeState {
  std::array<double, 2> reference;  ///< [m]
  std::array<double, 3> position;   ///< [m]
  double draw_in = 0.0;             ///< along the inward normal of the flat edge [m]
};

/// What belongs to one ply of several in the lists of a BlankState: [first, end) of each.
struct PlyRange {
  int nu = 0, nv = 0;  ///< cells of its grid
  int first_node = 0, end_node = 0, first_quad = 0, end_quad = 0, first_edge = 0, end_edge = 0;
};

/// The blank at one instant, for pictures and files. Nodes ascend by grid lines (i, j), i along warp; a whole
/// rectangle holds all of them, index = i * (nv + 1) + j. Several plies stand one after the other, bottom
/// first.
struct BlankState {
  int nu = 0, nv = 0;                             ///< cells of the grid along warp and weft, before trimming
  Symmetry symmetry = Symmetry::none;             ///< which piece of the blank it is
  std::vector<PlyRange> plies;                    ///< empty: one ply
  std::vector<std::array<int, 2>> grid;           ///< (i, j) of each node
  std::vector<std::array<double, 2>> reference;   ///< [m]
  std::vector<std::array<double, 3>> position;    ///< [m]
  std::vector<std::array<double, 3>> velocity;    ///< [m/s]
  std::vector<std::array<int, 4>> quads;          ///< (i,j) (i+1,j) (i+1,j+1) (i,j+1)
  std::vector<CellPiece> pieces;                  ///< the material of those quads that the outline cuts
  std::vector<EdgeState> edge;                    ///< along the outer edge, corners left out
  Outline outline;                                ///< of the flat blank
  std::vector<double> shear_angle;                ///< per node, signed [rad]
  std::vector<std::array<double, 2>> tow_strain;  ///< per node {warp, weft} [-]
  std::vector<double> pressure, slip_speed, friction_coefficient,
      hersey;  ///< per node, of the face that presses most on a tool
  std::vector<double> ply_slip,
      ply_pressure;  ///< at each node the largest of the cells about it against other plies: way
                     ///< slipped [m], pressure [Pa]; empty: one ply
  HeatFields heat;   ///< empty: one temperature a run
  double time = 0.0, punch_displacement = 0.0, binder_position = 0.0;
};

/// Heat of a run, from its rows.
struct HeatSummary {
  HeatRow last;                      ///< at the end of the stroke, or of the hold after it
  std::optional<double> first_face;  ///< when a first face froze [s]
  std::optional<double> solid;       ///< when no melt was left [s]
  double residual_share =
      0.0;            ///< largest residual of the heat balance over the heat that went through faces [-]
  double held = 0.0;  ///< how long the tools stayed closed after the stroke [s]
};

/// The blank once punch and binder have gone up and it has come to rest on the die.
struct Release {
  HistoryRow row;      ///< the ledger goes on; work_punch and work_binder take back what the tools gave up
  double moved = 0.0;  ///< largest way of a node [m]
};

/// One ply of several.
struct PlySummary {
  double orientation = 0.0;      ///< of its warp against x [rad]
  double shear_angle_max = 0.0;  ///< at the end [rad]
  double draw_in_max = 0.0;      ///< at the end [m]
};

/// Two neighbouring plies, the lower one named by its place from the bottom.
struct InterfaceSummary {
  double slip_max = 0.0;   ///< way that a point of contact slipped while pressed [m]
  double slip_mean = 0.0;  ///< by area [m]
};

/// A blank of several plies.
struct StackSummary {
  std::vector<PlySummary> plies;             ///< bottom first
  std::vector<InterfaceSummary> interfaces;  ///< one fewer
  int patterns = 0;            ///< of the matrix, made anew as plies slipped out of the one before
  double pairing_share = 0.0;  ///< energy that the plies' meeting points, held over each step, leave out: sum
                               ///< of sizes over the punch's work [-]
};

/// A sheet that may touch itself.
struct SelfContactSummary {
  bool met = false;            ///< parts of it have come within reach of each other
  int patterns = 0;            ///< of the matrix, made anew as pairs, of plies as well, left the one before
  double pairing_share = 0.0;  ///< as StackSummary's
};

struct StampingSummary {
  double peak_punch_force = 0.0;            ///< [N]
  double shear_angle_max = 0.0;             ///< [rad]
  double draw_in_max = 0.0;                 ///< [m]
  std::array<double, 8> draw_in_rays{};     ///< along rays at 0, 45, ... 315 deg to x: inward at the edge [m]
  double energy_residual_max = 0.0;         ///< [-]
  double force_balance_residual_max = 0.0;  ///< [-]
  double numerical_dissipation_share = 0.0;  ///< of the punch work [-]
  double twist_share = 0.0;                  ///< largest share of the twist control in the stored energy [-]
  double symmetry_gap_shear = 0.0;  ///< 8 symmetries of the square about the tows, share of the maximum [-];
                                    ///< < 0: the grid has not got them
  double symmetry_gap_draw_in = 0.0;
  double friction_work_outside = 0.0;  ///< share of friction work outside the calibrated box [-]
  double pressure_max = 0.0;           ///< of any node on any tool [Pa]
  double crush_share = 0.0;     ///< pressure_max over the last pressure of the compaction table: above 1 that
                                ///< curve was carried on along its last slope [-]
  double friction_swing = 0.0;  ///< largest share of friction that came and went with each update of its
                                ///< loads in a step that was accepted [-]; 0: all loads settled
  int self_crossings = 0;       ///< tow segments that pass through the sheet, most in any step (folds.h)
  double first_crossing = 0.0;  ///< punch displacement of the first step with one [m]
  std::optional<SelfContactSummary> self_contact;  ///< where it may touch itself
  bool falling_branch = false;  ///< the law fell with speed somewhere: the solution may not be unique
  int nodes = 0, steps = 0, rejected_steps = 0, newton_iterations = 0;
  int factorisations = 0;           ///< of the matrix; more than Newton iterations where it was indefinite
  std::array<double, 2> spacing{};  ///< as used [m]
  bool completed = false;
  bool stopped = false;               ///< from outside, between two Newton iterations; no failure
  std::string failure;                ///< why it stopped, when not completed
  std::optional<HeatSummary> heat;    ///< of a run with temperatures
  std::optional<StackSummary> stack;  ///< of several plies
  std::optional<Release> release;     ///< where the press releases the blank
};

/// What ended a step, by the cure it asks for (macroscale/advice.h).
enum class FailureKind {
  search,           ///< Newton's method did not come to rest
  indefinite,       ///< no direction lowers the energy
  friction_loads,   ///< friction and contact drive each other to and fro
  folded,           ///< a corner of the grid closed or turned over
  pressed_through,  ///< a tool stands behind the middle of the fabric
  lost_tool,        ///< a node where a tool's distance is not known
  not_finite        ///< a quantity is no number
};

/// What the last attempt of a stamping that failed looked like in the end.
struct StampingFailure {
  FailureKind kind = FailureKind::search;
  std::string reason;
  int step = 0;                  ///< that failed; 0 = closing the binder
  double time = 0.0;             ///< where the last attempt would have ended [s]
  double time_step = 0.0;        ///< of the last attempt [s]
  BlankState blank;              ///< the last iterate
  std::vector<double> residual;  ///< out-of-balance force of each node there [N]; -1 = not finite
  struct Unknown {
    std::string name;                  ///< "node 12", "binder (tool 2)"
    double residual = 0.0;             ///< [N]
    std::array<double, 3> position{};  ///< of a node [m]; of a tool {0, 0, z}
  };
  std::vector<Unknown> worst;                            ///< largest finite residual first, at most ten
  std::vector<std::pair<std::string, double>> energies;  ///< terms of the incremental potential there [J]
  std::vector<std::string> not_finite;                   ///< nodes and energies that are no numbers any more
};

struct StampingResult {
  StampingSummary summary;
  std::vector<HistoryRow> history;         ///< one a step of the stroke, then those of the dwell
  std::vector<HeatRow> hold;               ///< while the tools stayed closed after the stroke
  BlankState final_state;                  ///< released, where the press releases it
  std::optional<StampingFailure> failure;  ///< present where summary.failure is
};

/// Called after each accepted step, and once with step 0 when the binder has closed. The blank is the piece
/// that is computed.
using StampingObserver = std::function<void(int step, int steps, const HistoryRow&, const BlankState&)>;

struct StampingCheckpoint;  // macroscale/checkpoint.h

/// How a run is watched, kept and stopped. None of it changes a result.
struct StampingControl {
  StampingObserver observe = {};
  /// Called when the binder has closed and after each step with all that the next step needs, and once more
  /// when the run ends, whatever ends it (`last`): after a failure or a stop with the state after the last
  /// whole step.
  std::function<void(const StampingCheckpoint&, bool last)> keep = {};
  std::function<bool()> stop = {};  ///< asked between Newton iterations; true ends the run
  const StampingCheckpoint* resume_from =
      nullptr;  ///< of a run with the same arguments; null = from the start
};

Problems check(const StampingSpec& spec);

/// Closes the binder, then drives the punch. Not finishing is a result (`summary.failure` says why), and so
/// is a quantity that is not finite: history and state up to there are kept.
/// @throws InputError      if check(spec) or check(fabric) finds something
StampingResult run_stamping(const StampingSpec& spec, const mesoscale::FabricProperties& fabric,
                            const friction::Model& friction, const StampingObserver& observe = {});

/// The same, resumed, kept and stopped as `control` says. A run that goes on from a checkpoint ends with the
/// same bits as one that was never interrupted; `observe` is called for the steps still to do.
/// @throws std::invalid_argument  if the checkpoint is not of this blank
StampingResult run_stamping(const StampingSpec& spec, const mesoscale::FabricProperties& fabric,
                            const friction::Model& friction, const StampingControl& control);

}  // namespace heddle::macroscale
