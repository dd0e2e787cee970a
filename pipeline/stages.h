#pragma once

#include <functional>
#include <optional>
#include <string>
#include <vector>

#include "friction/calibrate.h"
#include "macroscale/stamping.h"
#include "mesoscale/cell_spec.h"
#include "mesoscale/pictures.h"
#include "mesoscale/solid/sampler.h"
#include "pipeline/case.h"
#include "pipeline/outputs.h"

namespace heddle::pipeline {

/// The law ready for use, and what the friction test says of it.
struct FrictionStage {
  friction::Model model;
  std::optional<friction::CalibrationBand> calibration;  ///< absent where the constants were given
  std::optional<friction::AreaExponent> area_exponent;   ///< phi ~ p^a that the calibration data ask for
  std::optional<double> area_exponent_of_weave;          ///< d ln phi / d ln p between the loads of the rows
  std::vector<FrictionTestRow> test;                     ///< rows of the friction test, for file and report
  std::vector<FrictionCurveRow> curve;                   ///< mu against speed at the test's loads
  std::vector<std::string> notes;                        ///< fitted constants, bands
};

/// Contact area fraction of the unsheared weave, as friction reads it; empty for nominal pressure.
friction::AreaFunction area_function(const FrictionSpec& spec, const mesoscale::FabricProperties* fabric);

/// The same of the fabric that the calibration pulls were made of, with a cell of its own analysed for it.
friction::AreaFunction area_of_pulled_fabric(const Case& a_case);

/// The friction model of a case, as a run has it: the numbers given, or fitted to the table that is.
/// @param area  of the fabric that was pulled
/// @throws InputError  naming the table and line
friction::Model model_of_run(const FrictionSpec& spec, const friction::AreaFunction& area);

/// Calibrates where the case asks for it, then runs the friction test.
/// @param fabric  needed where the contact pressure is real
/// @throws InputError  naming the data file and line, or the missing weave
FrictionStage run_friction_stage(const Case& a_case, const mesoscale::FabricProperties* fabric);

/// What the mesoscale hands to files and report beyond its result.
struct WeavePictures {
  mesoscale::HeightField height;
  std::vector<mesoscale::Outline> section;
  mesoscale::TowBodies bodies;
};
WeavePictures weave_pictures(const mesoscale::CellSpec& spec);

/// One unsheared repeat in the state of the case, as bodies: 24 stations a pitch and 32 voxels a pitch and
/// through the thickness where it has up to eight tows, fewer of larger ones, so that no file grows with it.
struct CellBodies {
  int warps = 0;
  mesoscale::TowSurfaces tows;
  mesoscale::solid::CellVoxels voxels;
};
CellBodies cell_bodies(const mesoscale::CellSpec& spec);

/// Size of a blank for titles: "320 x 320 mm", "round 300 mm".
std::string blank_in_words(const macroscale::BlankSpec& blank);

/// Mean binder pressure of a case: force over the blank outside the binder's opening [Pa].
double mean_binder_pressure(const macroscale::StampingSpec& spec);

}  // namespace heddle::pipeline
