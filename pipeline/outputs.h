#pragma once

#include <array>
#include <cstdint>
#include <filesystem>
#include <optional>
#include <span>
#include <stdexcept>
#include <string>
#include <string_view>
#include <utility>
#include <vector>

#include "macroscale/folds.h"
#include "macroscale/grid_error.h"
#include "macroscale/indicators.h"
#include "macroscale/stamping.h"
#include "mesoscale/cell_spec.h"
#include "mesoscale/level_set.h"
#include "mesoscale/nesting.h"
#include "mesoscale/solid/solid_cell.h"

/// The files of a run as text. Functions named after a file return its bytes; `write_file` puts them in
/// place. Numbers are written in the shortest form that reads back as the same double, so equal results give
/// equal bytes. A value that is not finite is never written: the writer throws OutputError and names it.
namespace heddle::pipeline {

/// A file that cannot be written, or a value that must not be; names the path or the quantity, and the
/// reason.
class OutputError : public std::runtime_error {
 public:
  using std::runtime_error::runtime_error;
};

/// Writes under a temporary name beside `path`, then renames: `path` holds the old bytes or all the new ones,
/// even if the run is interrupted. Creates the folder if it is missing.
/// @param durable  the bytes are on the disk before the name is: a power cut leaves the old file or the new
/// one
/// @throws OutputError  naming the path and the reason; the temporary file is removed
void write_file(const std::filesystem::path& path, std::string_view bytes, bool durable = false);
/// @throws OutputError  naming the path and the reason
std::string read_file(const std::filesystem::path& path);

/// Shortest decimal form of a double that reads back as the same bits.
std::string shortest(double value);

// ---- tables (CSV)
// ------------------------------------------------------------------------------------------------

std::string history_csv(std::span<const macroscale::HistoryRow> rows);

/// Temperatures while the tools stay closed after the stroke: time_s and the columns that a run with
/// temperatures adds to history.csv.
std::string hold_csv(std::span<const macroscale::HeatRow> rows);

/// One test of the sled, by the model, and what others found for it. SI units.
struct FrictionTestRow {
  std::string name;                           ///< "baseline"
  double velocity = 0.0;                      ///< [m/s]
  double normal_force = 0.0;                  ///< [N]
  double tool_temperature = 0.0;              ///< [K]
  double fabric_temperature = 0.0;            ///< [K]
  double orientation = 0.0;                   ///< [rad]
  double friction_coefficient = 0.0;          ///< of this model [-]
  double pull_force = 0.0;                    ///< of this model [N]
  std::optional<double> measured_force = {};  ///< [N]
  std::optional<double> paper_force = {};     ///< of the paper's own model [N]
};

/// Pull force of the model over the measured one, minus one; empty without a measurement.
std::optional<double> error_of_model(const FrictionTestRow& row);
std::optional<double> error_of_paper(const FrictionTestRow& row);

/// Columns after pull_force_N: measured_force_N, paper_force_N, error, paper_error (fractions; empty if not
/// known).
std::string friction_test_csv(std::span<const FrictionTestRow> rows);

/// One pull of the friction rig, taken as a machine. SI units. What a pull between curved plates has no
/// history for is empty.
struct FrictionRigRow {
  std::string name;
  double velocity = 0.0;                          ///< [m/s]
  double normal_force = 0.0;                      ///< when the plates close [N]
  double tool_temperature = 0.0;                  ///< [K]
  double fabric_temperature = 0.0;                ///< [K]
  double orientation = 0.0;                       ///< [rad]
  bool curved = false;                            ///< between S-curve plates
  double law_force = 0.0;                         ///< steady, of the law by itself [N]
  std::optional<double> peak_force = {};          ///< [N]
  std::optional<double> peak_displacement = {};   ///< [m]; empty where nothing stands out of the steady force
  std::optional<double> steady_force = {};        ///< over the last fifth of the pull [N]
  std::optional<double> steady_coefficient = {};  ///< mean of F/(2 N) over it [-]
  std::optional<double> normal_force_loss = {};   ///< share of the normal force lost by the end [-]
  std::optional<double> film_temperature = {};    ///< at the end [K]
  std::optional<double> element_force = {};       ///< through the finite elements [N]
  std::optional<double> measured_force = {};      ///< [N]
  std::optional<double> paper_force = {};         ///< of the paper's own model [N]
};

std::string friction_rig_csv(std::span<const FrictionRigRow> rows);

/// What the load cells say at one moment of a pull. SI units.
struct FrictionHistoryRow {
  std::string name;               ///< of the pull
  double time = 0.0;              ///< since the plates closed [s]
  double displacement = 0.0;      ///< of the sample holder [m]
  double pull_force = 0.0;        ///< [N]
  double normal_force = 0.0;      ///< [N]
  double coefficient = 0.0;       ///< F/(2 N) [-]
  double film_temperature = 0.0;  ///< [K]
};

std::string friction_history_csv(std::span<const FrictionHistoryRow> rows);

/// Pressure on both plates of one pull, node by node: index = i * ny + j, i along the pull.
struct PlatePressure {
  std::string name;
  int nx = 0, ny = 0;
  double spacing_x = 0.0, spacing_y = 0.0;  ///< along the pull and across [m]
  std::vector<double> lower, upper;         ///< [Pa]
};

/// One point of the friction law. SI units.
struct FrictionCurveRow {
  double tool_temperature = 0.0;      ///< [K]
  double fabric_temperature = 0.0;    ///< [K]
  double pressure = 0.0;              ///< nominal [Pa]
  double slip_speed = 0.0;            ///< [m/s]
  double film_viscosity = 0.0;        ///< [Pa s]; 0 where the law has none
  double hersey = 0.0;                ///< [-]; 0 where the law has none
  double friction_coefficient = 0.0;  ///< [-]
};

std::string curve_csv(std::span<const FrictionCurveRow> rows);

/// Contact fraction of one face over pressures [Pa] and trellis shear angles [rad]; one row a pair, angles
/// outermost.
std::string contact_csv(const mesoscale::ContactArea& contact, std::span<const double> pressures,
                        std::span<const double> shear_angles);

/// What the film under the sheared fabric makes of friction by direction, at the pressures and angles of its
/// table. One row a pair, angles outermost: K_c, K_s, and mu along over mu across the long diagonal.
std::string drag_direction_csv(const mesoscale::DragDirection& drag);

/// How two plies press each other: distance of their middles over the pressure.
std::string ply_facing_csv(const mesoscale::PlyFacing& facing);

// ---- records (JSON)
// ----------------------------------------------------------------------------------------------

/// Parts that were not computed are absent, and their keys with them.
struct SummaryRecord {
  std::optional<mesoscale::CellSummary> cell = {};
  std::optional<mesoscale::TowBodies> tow_bodies = {};
  std::optional<mesoscale::StackSummary> stack = {};        ///< of several plies
  std::optional<double> contact_area_fraction_binder = {};  ///< phi under the binder's mean pressure [-]
  std::optional<macroscale::StampingSummary> stamping = {};
  std::optional<macroscale::GridError> grid_error = {};
  std::vector<macroscale::LargestIndicator> indicators = {};  ///< of the last state
  std::optional<macroscale::Folds> folds = {};                ///< of the last state
  std::optional<macroscale::StampingFailure> failure = {};    ///< of a stamping that stopped
  std::string advice = {};                                    ///< what to try after it
};

std::string summary_json(const SummaryRecord& record);

/// Stiffness of the solid part, Voigt (shear strains doubled). What was not computed is absent: C of a stack
/// without end, A, B and D of one ply with free faces. `iterations` lists the load cases of C, then of the
/// ply.
std::string stiffness_json(const mesoscale::solid::SolidResult& result);
/// The plies at several trellis angles out of what stiffness_json wrote; numbers to a rounding.
/// @param file  name for messages only
/// @throws InputError  if it holds none, or something is missing
std::vector<mesoscale::solid::ShearedSolid> read_sheared_json(std::string_view text, const std::string& file);
/// A row an angle: A, B, D of the ply (upper halves, 1 = warp at every angle) and what it presses with where
/// it is held flat, a kelvin and a unit of resin shrinkage.
std::string sheared_csv(const std::vector<mesoscale::solid::ShearedSolid>& sheared);

/// @param given  what stands in place of the weave's own, for readers of the file (in_words of
/// FabricOverride)
std::string fabric_json(const mesoscale::FabricProperties& fabric,
                        const std::vector<std::string>& given = {});
/// Reads what fabric_json wrote: every number comes back bit for bit; what was given is passed over.
/// @param file  name for messages only
/// @throws InputError  naming every key that is missing, unknown, of the wrong type, or holds a table against
/// the rules
mesoscale::FabricProperties read_fabric_json(std::string_view text, const std::string& file);

struct StageRecord {
  std::string name;
  double wall_time = 0.0;    ///< [s]
  double cpu_time = 0.0;     ///< [s]
  double peak_memory = 0.0;  ///< [byte]
  bool reused = false;       ///< taken from the cache, not computed
};

/// All that may differ between two equal runs: versions, machine, times. Every other file is free of it.
struct Manifest {
  std::string name;
  std::vector<std::pair<std::string, std::string>>
      versions;                                             ///< of the program and of the libraries behind it
  std::vector<std::pair<std::string, std::string>> hashes;  ///< of inputs and sources
  std::vector<std::pair<std::string, std::string>> machine;  ///< processor, cores, BLAS kernel
  std::vector<StageRecord> stages;
};

std::string manifest_json(const Manifest& manifest);

// ---- geometry
// ----------------------------------------------------------------------------------------------------

/// Binary STL in millimetres, which is what readers of STL assume; normals from the corners.
/// @throws OutputError  naming the triangle, if a corner is not finite
std::string tows_stl(const TriangleMesh& mesh);

}  // namespace heddle::pipeline
