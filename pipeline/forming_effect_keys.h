#pragma once

#include <vector>

#include "macroscale/stamping.h"
#include "pipeline/config_schema.h"
#include "pipeline/settings.h"

/// Effects of forming beside friction, the rate of shear and the press's frame: of the fabric (M2 to M5, M7,
/// M8) and of the process (P3, P5 to P7). docs/theory/forming-effects.md.
namespace heddle::pipeline {

std::vector<Key> forming_effect_keys();

/// Puts what the settings say of them into a stamping that has its blank and process.
void take_forming_effects(const Settings& settings, macroscale::StampingSpec& stamping);

}  // namespace heddle::pipeline
