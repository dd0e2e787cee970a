#pragma once

#include <filesystem>
#include <optional>
#include <string>
#include <vector>

#include "friction/friction_test.h"
#include "friction/model.h"
#include "friction/rig/curved_plates.h"
#include "friction/rig/machine.h"
#include "macroscale/stamping.h"
#include "mesoscale/cell_spec.h"
#include "mesoscale/solid/solid_cell.h"
#include "pipeline/calibrate_keys.h"
#include "pipeline/config_reader.h"
#include "pipeline/discover_keys.h"
#include "pipeline/fabric_override.h"
#include "pipeline/study_keys.h"

namespace heddle::pipeline {

/// What the user says of friction. Where a table calibrates the law, its constants are still to be fitted.
struct FrictionSpec {
  /// The form of the law, its constants where they were given, the film and the effects.
  friction::Model model;
  macroscale::ContactPressure contact_pressure = macroscale::ContactPressure::real;
  friction::FrictionRig rig;    ///< plate area and its band; the band is {area, area} where none was given
  bool has_plate_area = false;  ///< Coulomb friction needs none
  std::filesystem::path calibration_data;  ///< empty: the constants of the law were given
  mesoscale::WeaveSpec calibration_weave;  ///< of the fabric that was pulled; Table 1 unless given
  bool fit_temperature_slope = false;      ///< `slope: fitted`; else the slope in the model is held
  Problems table_problems;                 ///< of the table of a law, where it could not be read
  bool calibrated() const { return !calibration_data.empty(); }
};

struct FrictionTestSpec {
  std::filesystem::path data;    ///< measured friction forces
  std::filesystem::path design;  ///< ranges of the parameters; may be empty
};

/// The friction test as a machine, beside the comparison of single forces.
struct FrictionMachineSpec {
  friction::Machine machine;
  friction::SCurve bend;         ///< of the S-curve plates
  bool finite_elements = false;  ///< every pull through the stamping solver as well
};

/// The same blank and the same friction sample cut at several angles to the tows.
struct OrientationStudySpec {
  std::vector<double> blanks;    ///< warp against x [rad]
  std::vector<double> friction;  ///< warp against the pull [rad]
};

/// One configuration, typed and checked. Stages that the file does not ask for are absent.
struct Case {
  std::string name;
  std::optional<mesoscale::CellSpec> cell;
  FabricOverride fabric;                                  ///< given in place of what the cell says
  std::optional<mesoscale::solid::SolidSpec> solid;       ///< stiffness of the weave's solid part
  std::optional<mesoscale::solid::VoxelFileSpec> voxels;  ///< stiffness of a cell of its own, from a file
  std::optional<FrictionSpec> friction;
  std::optional<FrictionTestSpec> friction_test;
  std::optional<FrictionMachineSpec> friction_machine;
  std::optional<macroscale::StampingSpec> stamping;
  macroscale::ShearFriction shear_friction;  ///< between tows, also for shear tests without a stamping
  bool grid_error = false;                   ///< the stamping is run once more on a coarser grid
  std::optional<OrientationStudySpec> orientation_study;  ///< runs the stamping once an angle
  std::optional<mesoscale::study::StudySpec> study;       ///< what `heddle study` is to change of the weave
  std::optional<CalibrateSpec> calibrate;                 ///< what `heddle calibrate` is to fit
  std::optional<DiscoverSpec> discover;                   ///< what `heddle discover` is to look for
  std::vector<std::string> notes;                         ///< keys not used, and values that are assumed
  Settings settings;                                      ///< every key behind the above
};

/// Reads a configuration file with --set applied, checks every key and the keys against each other. Tool
/// files must be there; load_tools reads them.
/// @throws InputError  with every problem of the file
Case read_case(const std::filesystem::path& file, const std::vector<std::string>& assignments = {});

/// The same for text. @param folder  against which file keys are resolved
Case read_case_text(const std::string& text, const std::string& file, const std::filesystem::path& folder,
                    const std::vector<std::string>& assignments = {});

/// Reads the tools that files give, which takes seconds, and measures them against each other, the fabric and
/// the blank.
/// @throws InputError  with every problem
void load_tools(Case& a_case);

/// Both, and the problems of both at once.
/// @throws InputError  with every problem of the file and of its tools
Case read_case_and_tools(const std::filesystem::path& file, const std::vector<std::string>& assignments = {});

/// What `heddle run` would do, one line a stage.
std::vector<std::string> stage_lines(const Case& a_case);

/// Writes FOLDER/resolved.yaml and copies of the files it names to FOLDER/inputs: the folder runs on its own.
void write_resolved(const Case& a_case, const std::filesystem::path& folder);

}  // namespace heddle::pipeline
