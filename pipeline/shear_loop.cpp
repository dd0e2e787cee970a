#include "pipeline/shear_loop.h"

#include <cmath>
#include <numbers>

namespace heddle::pipeline {

ShearLoop shear_loop(const mesoscale::FabricProperties& fabric, const macroscale::ShearFriction& friction) {
  constexpr double degree = std::numbers::pi / 180.0;
  constexpr int points = 200;  // a way
  const Curve& resistance = fabric.shear_stress;
  macroscale::ShearMemory memory;
  double at = 0.0;
  const auto go = [&](ShearLoop::Way& way, double to) {
    for (int k = 0; k <= points; ++k) {
      const double angle = at + (to - at) * k / points, s = std::sin(angle);
      memory = macroscale::sheared_to(friction, resistance, memory, s);
      way.angle.push_back(angle);
      // F_s = T_s / cos g = dPsi/ds
      way.force.push_back((1.0 - friction.share) * std::copysign(resistance(std::abs(s)), s) + memory.stress);
    }
    at = to;
  };
  ShearLoop loop;
  loop.share = friction.share;
  for (const double to : {20.0, -20.0, 40.0, -40.0, 40.0}) go(loop.cycles, to * degree);
  memory = {};
  at = 0.0;
  go(loop.first, 40.0 * degree);
  return loop;
}

}  // namespace heddle::pipeline
