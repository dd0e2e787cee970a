#pragma once

#include <array>
#include <functional>
#include <optional>
#include <span>
#include <string>
#include <string_view>
#include <utility>
#include <vector>

#include "friction/model.h"

namespace heddle::friction {

/// The pull-through rig: fabric between two plates of one area, pulled at constant velocity (paper, Fig. 1).
struct FrictionRig {
  /// A [m^2] of one plate. ASSUMED: the paper does not print it. The Table 4 forces do not depend on it once
  /// the law is calibrated with it; the law at another pressure does, so reports carry the band.
  double plate_area = 0.01;
  std::array<double, 2> plate_area_band{0.005, 0.02};  ///< {low, high} [m^2]
  /// Slip at which a force is read, and rest under load before it [m, s]. ASSUMED: what the paper calls the
  /// pull force is taken as steady. Only laws and effects with memory see them.
  double pull_length = 0.05;
  double dwell_before = 0.0;
};

/// One pull, and what was measured. SI units.
struct FrictionTestRow {
  std::string name;
  double velocity = 0.0;                 ///< U [m/s]
  double normal_force = 0.0;             ///< N [N]
  double tool_temperature = 358.15;      ///< [K]
  double fabric_temperature = 453.15;    ///< [K]
  double orientation = 0.0;              ///< warp against the pull [rad]; only the orientation effect sees it
  std::optional<double> measured_force;  ///< F [N]
  std::optional<double> paper_model_force;  ///< F of the paper's own finite-element model [N]
};

/// Contact area fraction against nominal pressure [Pa]: {phi, d phi / d p [1/Pa]}. Empty = nominal pressure
/// (phi = 1).
using AreaFunction = std::function<std::pair<double, double>(double pressure)>;

struct FrictionTestResult {
  double mu = 0.0;
  double pull_force = 0.0;               ///< F = 2 mu N [N]
  Context context;                       ///< what the law saw
  double hersey = 0.0;                   ///< [-]
  bool calibrated = true;                ///< inside the box of the law
  std::optional<double> relative_error;  ///< (F - F_measured) / F_measured, where measured
};

/// The contact under one plate: p = N / A.
Context contact_of(const FrictionTestRow& row, const FrictionRig& rig, const AreaFunction& area = {});

/// What the contact has gone through after a rest under load [s], and after a slip [m] at the context's speed
/// from some state. Speed and load are constant, where the memory is advanced exactly: one step is enough.
ContactState state_after_rest(const Model& model, const Context& context, double rest);
ContactState state_after_slip(const Model& model, const Context& context, ContactState state, double slip);

/// What the contact has gone through when the force is read: rest, then a pull at the row's speed and load.
ContactState state_after_pull(const Model& model, const Context& context, const FrictionRig& rig);

/// The friction test at the level of the law: both faces slide, so F = 2 mu N (paper, Eq. 2).
FrictionTestResult run_friction_test(const Model& model, const FrictionTestRow& row, const FrictionRig& rig,
                                     const AreaFunction& area = {});
std::vector<FrictionTestResult> run_friction_tests(const Model& model, std::span<const FrictionTestRow> rows,
                                                   const FrictionRig& rig, const AreaFunction& area = {});

/// Root mean square of the relative errors; empty where no row was measured.
std::optional<double> rms_relative_error(std::span<const FrictionTestResult> results);

/// One point of the Stribeck curve.
struct CurvePoint {
  double speed;     ///< U [m/s]
  double hersey;    ///< Hs [-]
  double mu;        ///< [-]
  bool calibrated;  ///< inside the box of the law
};
/// mu against Hs at the load and temperatures of one row, over speeds that are even in their logarithm.
/// @param speeds  {low, high} [m/s], 0 < low < high
/// @param count   of points, >= 2
std::vector<CurvePoint> stribeck_curve(const Model& model, const FrictionTestRow& row, const FrictionRig& rig,
                                       std::array<double, 2> speeds, int count,
                                       const AreaFunction& area = {});

/// Effective coefficient of a measured pull, mu = F / (2 N) (paper, Eq. 2).
inline double effective_coefficient(double pull_force, double normal_force) {
  return pull_force / (2.0 * normal_force);
}

/// Keys: friction.calibration.plate_area, friction.calibration.plate_area_band.
Problems check(const FrictionRig& rig);
/// Keys: "row NAME". Rows for a calibration need a measured force as well.
Problems check(std::span<const FrictionTestRow> rows, bool measured_force_needed);

/// Reads a friction-test table: one header line naming the columns, one line a pull.
///
/// Columns: case, velocity_mm_s, normal_force_N, tool_temperature_C, fabric_temperature_C; and if wanted
/// orientation_deg, force_measured_N, force_paper_model_N. Any order. The columns that format_friction_table
/// adds are passed over. Empty cells of the optional columns mean "not measured". Lines that begin with # are
/// comments.
/// @param text  content of the file
/// @param file  its name, for the problems
/// @throws InputError  with every problem and its line
std::vector<FrictionTestRow> parse_friction_table(std::string_view text, const std::string& file);

/// @throws InputError  if the file cannot be read, or as parse_friction_table
std::vector<FrictionTestRow> read_friction_table(const std::string& path);

/// The same table with the results of the friction test: friction_coefficient, pull_force_N and force_error
/// (share of the measured force, empty where not measured) beside the conditions.
/// @param results  one a row, as run_friction_tests gives them
std::string format_friction_table(std::span<const FrictionTestRow> rows,
                                  std::span<const FrictionTestResult> results);

}  // namespace heddle::friction
