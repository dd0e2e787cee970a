#pragma once

#include "core/hdf5_file.h"
#include "friction/model.h"

namespace heddle::pipeline {

/// Law, film, rheology, effects and box of a model, every number with its bits.
void write_model(Hdf5Writer& file, const friction::Model& model);
/// @throws Hdf5Error  if something is missing or not known
friction::Model read_model(const Hdf5Reader& file);

}  // namespace heddle::pipeline
