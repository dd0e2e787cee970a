#pragma once

#include <string>

#include "core/hdf5_file.h"
#include "mesoscale/cell_spec.h"
#include "pipeline/friction_rig_stage.h"
#include "pipeline/stages.h"

/// Results of the stages before the stamping as sealed HDF5 files, for the cache. Every number comes back bit
/// for bit.
namespace heddle::pipeline {

/// Of the height field the upper face alone is kept: `bottom` and `covered` come back empty.
struct CellStage {
  mesoscale::CellResult result;
  WeavePictures pictures;
};

std::string bytes_of(const CellStage& stage, const std::string& key);
/// @throws Hdf5Error   if something is missing
/// @throws InputError  if a table of the fabric breaks a rule
CellStage read_cell_stage(const Hdf5Reader& file);

/// The law, the rows of test and curve, the notes: what files, report and stamping read. The fit behind them
/// (`calibration`, `area_exponent`) is not kept and comes back empty.
std::string bytes_of(const FrictionStage& stage, const std::string& key);
/// @throws Hdf5Error  if something is missing
FrictionStage read_friction_stage(const Hdf5Reader& file);

std::string bytes_of(const FrictionRigStage& stage, const std::string& key);
/// @throws Hdf5Error  if something is missing
FrictionRigStage read_friction_rig_stage(const Hdf5Reader& file);

}  // namespace heddle::pipeline
