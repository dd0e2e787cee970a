#pragma once

#include <string>
#include <vector>

#include "friction/model.h"
#include "mesoscale/fabric_properties.h"
#include "pipeline/case.h"
#include "pipeline/outputs.h"

namespace heddle::pipeline {

/// The friction test as a machine: every pull as a history, and where asked for through the finite elements.
struct FrictionRigStage {
  std::vector<FrictionRigRow> rows;         ///< of the measured pulls, then of the design
  std::vector<FrictionHistoryRow> history;  ///< of every row but curved ones, one after the other
  std::vector<PlatePressure>
      plates;  ///< through the finite elements: flat, and bent if the design asks for it
  std::vector<std::string> notes;
};

/// @param model   the law, calibrated
/// @param fabric  needed for finite elements, curved plates and real contact pressure; else may be null
/// @throws NumericalError  naming the row, if the law or a pull breaks down
FrictionRigStage run_friction_rig_stage(const Case& a_case, const friction::Model& model,
                                        const mesoscale::FabricProperties* fabric);

}  // namespace heddle::pipeline
