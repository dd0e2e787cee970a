#pragma once

#include <filesystem>
#include <string>
#include <vector>

#include "macroscale/stamping.h"
#include "mesoscale/solid/solid_cell.h"
#include "pipeline/case.h"

namespace heddle::pipeline {

/// What a finished stamping left in its folder of the part once it is solid.
struct FormedPart {
  macroscale::BlankState blank;                       ///< released, where the press releases it
  std::vector<mesoscale::solid::ShearedSolid> table;  ///< stiffness over the trellis angle
  double areal_density = 0.0;                         ///< before forming [kg/m^2]
};

/// Whether the case stamps one ply and tables its solid part at two angles or more.
bool hands_over_a_part(const Case& a_case);

/// Reads macroscale/checkpoint.h5 and mesoscale/stiffness.json. Nothing is computed anew.
/// @param a_case  of the folder
/// @throws InputError  naming what is missing or damaged, with the command that makes it
FormedPart read_formed_part(const std::filesystem::path& folder, const Case& a_case);

}  // namespace heddle::pipeline
