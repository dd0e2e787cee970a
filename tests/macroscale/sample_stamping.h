#pragma once

#include "friction/model.h"
#include "macroscale/stamping.h"

namespace heddle::test {

/// The shipped tools on 11 x 11 nodes, a third of the stroke.
inline macroscale::StampingSpec coarse_stamping(int steps) {
  macroscale::StampingSpec spec;
  spec.blank.spacing = 32e-3;
  spec.process.stroke = 25e-3;
  spec.process.time = 0.15;
  spec.process.steps = steps;
  return spec;
}

inline friction::Model coulomb(double mu = 0.3) {
  friction::Model model;
  model.law = friction::Coulomb{mu};
  return model;
}

}  // namespace heddle::test
