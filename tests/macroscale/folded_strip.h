#pragma once

// A strip laid back over itself, for tests of a sheet that meets itself.
#include <cmath>

#include <Eigen/Core>

#include "macroscale/scene.h"

namespace heddle::test {

/// Nodes of a strip along x, folded once: its first half flat at z = 0, its second half back over it, `apart`
/// above. The two cells at the crease stand out to a tip, at their own lengths, or, with `round` cells more,
/// go round it as a half circle does.
struct FoldedStrip {
  macroscale::Blank blank;
  int leg = 0;   ///< cells of each leg
  int tip = 0;   ///< cells between the legs
  double h = 0;  ///< spacing along the strip [m]

  bool lower(int node) const { return blank.grid[static_cast<std::size_t>(node)][0] <= leg; }
  bool upper(int node) const { return blank.grid[static_cast<std::size_t>(node)][0] >= leg + tip; }
};

inline FoldedStrip folded_strip(int leg, int tip, int across, double h) {
  FoldedStrip strip;
  strip.leg = leg;
  strip.tip = tip;
  strip.h = h;
  strip.blank = macroscale::make_blank({(2 * leg + tip) * h, across * h}, h * (1.0 + 1e-9));
  return strip;
}

/// Puts its nodes there.
inline void fold(const FoldedStrip& strip, double apart, Eigen::VectorXd& x) {
  const double bend = strip.leg * strip.h;
  for (int n = 0; n < strip.blank.nodes(); ++n) {
    const int i = strip.blank.grid[static_cast<std::size_t>(n)][0];
    double& along = x[3 * n];
    double& up = x[3 * n + 2];
    if (i <= strip.leg) {
      along = i * strip.h;
      up = 0.0;
    } else if (i >= strip.leg + strip.tip) {
      along = bend - (i - strip.leg - strip.tip) * strip.h;
      up = apart;
    } else {
      // Corners of a regular polygon with sides h from leg to leg: of two sides the tip stands out.
      if (strip.tip == 2) {
        along = bend + std::sqrt(strip.h * strip.h - 0.25 * apart * apart);
        up = 0.5 * apart;
      } else {
        const double r = 0.5 * apart, angle = std::acos(-1.0) * (i - strip.leg) / strip.tip;
        along = bend + r * std::sin(angle);
        up = r * (1.0 - std::cos(angle));
      }
    }
  }
}

}  // namespace heddle::test
