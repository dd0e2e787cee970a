#pragma once

#include "mesoscale/bending.h"
#include "mesoscale/cell_spec.h"
#include "mesoscale/compaction.h"
#include "mesoscale/shear.h"
#include "mesoscale/tension.h"

namespace heddle::mesoscale {

CompactionLaw compaction_law(const FormingSpec& forming);

/// The models behind the tables of FabricProperties, from one specification: for tests, reports and studies.
struct FormingModels {
  FabricGeometry fabric;  ///< in the state asked for
  CompactionLaw compaction;
  std::array<BendingStiffness, 2> bending{};
  TensionModel tension;
  ShearModel shear;
};
FormingModels forming_models(const CellSpec& spec);

/// Text of every value the stage reads, and its 64-bit FNV-1a hash in hexadecimal.
std::string describe(const CellSpec& spec);
std::string specification_hash(const CellSpec& spec);

}  // namespace heddle::mesoscale
