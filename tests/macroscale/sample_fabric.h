#pragma once

#include <algorithm>
#include <cmath>
#include <vector>

#include "mesoscale/fabric_properties.h"

namespace heddle::test {

/// Fabrics made up for tests: simple closed forms, so that answers can be worked out by hand.
struct SampleFabric {
  double areal_density = 0.7;      ///< [kg/m^2]
  double thickness = 1.5e-3;       ///< [m]
  double tow_stiffness = 5.9e6;    ///< EA per width [N/m]
  double shear_stiffness = 60.0;   ///< dPsi/ds = shear_stiffness * s [N/m]
  double rate_consistency = 0.0;   ///< [N s^n/m]
  double bending = 1e-3;           ///< [N m]
  double contact_stiffness = 5e8;  ///< [Pa/m], p = k d^2 / (d + toe)
  double table_end = 5e-4;         ///< largest approach of one face in the compaction table [m]
  double toe = 2e-5;               ///< [m]
};

inline mesoscale::FabricProperties make_fabric(const SampleFabric& sample) {
  mesoscale::FabricProperties fabric;
  fabric.areal_density = sample.areal_density;
  fabric.pitch = {5.39e-3, 5.39e-3};
  fabric.thickness = sample.thickness;
  // w = EA/2 (e1^2 + e2^2) is met exactly by the spline.
  constexpr int n = 9;
  std::vector<double> w;
  for (int i = 0; i < n; ++i)
    for (int j = 0; j < n; ++j) {
      const double e1 = -0.02 + 0.005 * i, e2 = -0.02 + 0.005 * j;
      w.push_back(0.5 * sample.tow_stiffness * (e1 * e1 + e2 * e2));
    }
  fabric.tension_energy = Surface(-0.02, 0.005, n, -0.02, 0.005, n, w);
  fabric.shear_stress = Curve({0.0, 1.0}, {0.0, sample.shear_stiffness});
  fabric.shear_rate.consistency = sample.rate_consistency;
  fabric.shear_rate.index = 0.38;
  fabric.shear_rate.activation_temperature = 5000.0;
  for (Curve& b : fabric.bending) b = Curve({300.0, 500.0}, {sample.bending, sample.bending});
  std::vector<double> d, p;
  for (int k = 0; k <= 200; ++k) {
    d.push_back(sample.table_end * k / 200.0);
    p.push_back(sample.contact_stiffness * d.back() * d.back() / (d.back() + sample.toe));
  }
  fabric.compaction = CurveFamily({0.0}, {Curve(d, p)});
  // The whole face touches: real pressure is nominal pressure.
  fabric.contact.log_fraction = CurveFamily({0.0}, {Curve({0.0, 20.0}, {0.0, 0.0})});
  return fabric;
}

}  // namespace heddle::test
