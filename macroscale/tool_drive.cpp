#include "macroscale/tool_drive.h"

namespace heddle::macroscale {

// A loaded tool's spring is at rest where its shape stands. A sprung tool's has its other end at the drive,
// so its extension is the unknown itself: small beside the stroke, and kept with all its digits.
Drive drive_at(const Tool& tool, double u) {
  Drive spring{0.5 * tool.stiffness * u * u, tool.stiffness * u, tool.stiffness, 0.0, 0.0};
  if (tool.yield > 0.0 && spring.force > tool.yield) {
    const double reach = tool.yield / tool.stiffness;
    spring = {tool.yield * (u - 0.5 * reach), tool.yield, 0.0, 0.0, 0.0};
  }
  spring.spring_energy = spring.energy;
  spring.spring_force = spring.force;
  if (tool.motion == Motion::sprung) return spring;
  const double dead = tool.force + tool.weight;
  return {dead * u + spring.energy, dead + spring.force, spring.stiffness, spring.energy, spring.force};
}

Drive tilt_drive_at(const Tool& tool, double lift) {
  const double energy = 0.5 * tool.stiffness * lift * lift, force = tool.stiffness * lift;
  return {energy, force, tool.stiffness, energy, force};
}

}  // namespace heddle::macroscale
