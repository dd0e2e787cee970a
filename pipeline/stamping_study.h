#pragma once

#include <limits>
#include <optional>
#include <string>
#include <vector>

#include "pipeline/case.h"
#include "pipeline/case_list.h"
#include "pipeline/commands.h"
#include "pipeline/shear_place.h"
#include "pipeline/stamping_study_keys.h"

namespace heddle::pipeline {

/// One accepted step of a stamping, as history.csv has it.
struct StudiedStep {
  double stroke = 0.0;      ///< [m]
  double force = 0.0;       ///< of the punch [N]
  double shear = 0.0;       ///< largest trellis angle [rad]
  double tow_strain = 0.0;  ///< largest [-]
  double draw_in = 0.0;     ///< largest [m]
  /// Cumulative [J]: work of the punch; done by friction at punch, die and binder; by the rate of shear.
  double work = 0.0, friction = 0.0, shear_rate = 0.0;
};

/// One stamping of a study and what it came to.
struct StudiedStamping {
  std::string id;     ///< its files are in cases/ID/
  std::string model;  ///< "given", or a name of stamping_study.models
  double binder_force = 0.0, speed_scale = 1.0;
  CaseStatus status = CaseStatus::done;
  std::string message = {};                 ///< why it is not done
  std::vector<StudiedStep> steps = {};      ///< those accepted, also of one that stopped
  double energy_residual_max = 0.0;         ///< [-]
  double outside_calibration = 0.0;         ///< share of friction work [-]
  double force_balance_residual_max = 0.0;  ///< [-]
  /// Estimated grid error of the punch force [N] (blank.grid_error); NaN where it is not known.
  double grid_error = std::numeric_limits<double>::quiet_NaN();
  int variation = -1;                    ///< of StampingStudySpec::variations; -1: none
  std::vector<std::string> values = {};  ///< of StampingStudyFindings::keys, "" where it has none
  std::optional<ShearPlace> shear = {};  ///< at the end of the stroke, or where it stopped

  /// The step at which the punch force is largest; null where there is none.
  const StudiedStep* peak() const;
};

/// All that files and page show of a study of stampings.
struct StampingStudyFindings {
  std::string name;
  std::string description;  ///< one sentence
  StampingStudySpec spec;
  double binder_force = 0.0, speed_scale = 1.0;  ///< of the case as given
  std::vector<StudiedStamping> stampings;
  std::vector<std::string> notes;
  std::vector<std::string> keys = {};  ///< that vary (varied_keys)
};

/// Stampings of one model that differ in speed alone, by rising speed; those that failed are left out.
std::vector<const StudiedStamping*> over_speed(const StampingStudyFindings& findings,
                                               const std::string& model);
/// Stampings of one variation that are done, in the order of its combinations.
std::vector<const StudiedStamping*> over_variation(const StampingStudyFindings& findings, int variation);
/// The case as given at every binder force, by rising force.
std::vector<const StudiedStamping*> over_binder_force(const StampingStudyFindings& findings);

/// How a peak force rises over three speeds V/2, V, 2V: the signature (F2 - F1) / (F1 - F0.5) tells what
/// depends on speed. A term ~ V^n gives 2^n: 4 for inertia, 2 for damping, 1 for a logarithm.
struct SpeedSignature {
  std::string model;
  double speed = 1.0;             ///< V, as a scale [-]
  std::array<double, 3> force{};  ///< at V/2, V, 2V [N]
  double rise_low() const { return force[1] / force[0] - 1.0; }
  double rise_high() const { return force[2] / force[1] - 1.0; }
  /// Nothing where either rise is below `noise`: a ratio of what the grid and the tolerance leave.
  std::optional<double> ratio() const;
  static constexpr double noise = 1e-3;  ///< of the force
};
std::vector<SpeedSignature> speed_signatures(const StampingStudyFindings& findings);

/// Least-squares line of peak force over binder force.
struct BinderLine {
  double intercept = 0.0;     ///< [N]
  double slope = 0.0;         ///< [N/N]
  double r_squared = 1.0;     ///< share of the variance that the line explains
  double largest_miss = 0.0;  ///< largest distance of a point, over its force [-]
};
/// Nothing with fewer than three forces.
std::optional<BinderLine> binder_line(const StampingStudyFindings& findings);

/// table.csv: one row a stamping, keys then results at its peak force; empty where it has none.
std::string stamping_table_csv(const StampingStudyFindings& findings);
/// The same numbers as data sets /keys/..., /results/... (NaN for what is not there), one entry a row.
std::string stamping_table_h5(const StampingStudyFindings& findings);
/// The part of the page about the keys that vary: one chart a result for each variation, and its table.
std::string variation_sections(const StampingStudyFindings& findings);
/// The page.
std::string stamping_study_html(const StampingStudyFindings& findings);

/// Stamps every model at every speed, the case as given at every binder force, and every variation, each as
/// `heddle run` would, in cases/ID. Writes table.csv, table.h5 and report.html. What is done already is not
/// run again; a signal ends the study inside a stamping, and the same command goes on there. Returns an exit
/// code.
/// @throws InputError  where the keys of a model or variation cannot be read, with its name and every problem
int study_stampings(const RunOptions& options, const Case& a_case);

}  // namespace heddle::pipeline
