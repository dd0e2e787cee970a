#include "macroscale/shear_friction.h"

#include <algorithm>
#include <cmath>

namespace heddle::macroscale {

namespace {

double limit(const ShearFriction& law, const Curve& resistance, const ShearMemory& memory) {
  return law.share * resistance(memory.widest);
}

// The way from memory.sine to s inside |s| <= widest: an elastic part up to `slips_from`, the rest at the
// limit.
struct InnerWay {
  double slips_from, stress, tangent;
};

InnerWay inner_way(const ShearMemory& memory, double most, double s) {
  const double trial = memory.stress + memory.stiffness * (s - memory.sine);
  if (std::abs(trial) <= most) return {s, trial, memory.stiffness};
  const double stress = std::copysign(most, trial);
  return {memory.sine + (stress - memory.stress) / memory.stiffness, stress, 0.0};
}

double work(const ShearMemory& memory, const InnerWay& way, double s) {
  return 0.5 * (memory.stress + way.stress) * (way.slips_from - memory.sine) +
         way.stress * (s - way.slips_from);
}

// Largest slope of the curve between two places. It is a parabola between two points of the table.
double steepest(const Curve& curve, double from, double to) {
  double most = std::max(curve.evaluate(from).slope, curve.evaluate(to).slope);
  const auto& x = curve.x();
  auto next = std::upper_bound(x.begin(), x.end(), from);
  for (double low = from; low < to;) {
    const double high = next == x.end() ? to : std::min(*next++, to);
    const double a = curve.evaluate(low).slope, b = curve.evaluate(0.5 * (low + high)).slope,
                 c = curve.evaluate(high).slope;
    const double bend = a - 2.0 * b + c, lean = 0.5 * (c - a);  // b + lean t + bend t^2 / 2, t in [-1, 1]
    most = std::max({most, a, c});
    if (bend < 0.0 && std::abs(lean) < -bend) most = std::max(most, b - 0.5 * lean * lean / bend);
    low = high;
  }
  return most;
}

}  // namespace

CornerScalar tow_friction(const ShearFriction& law, const Curve& resistance, const ShearMemory& memory,
                          double s) {
  const double size = std::abs(s), most = limit(law, resistance, memory);
  if (size < memory.widest) {
    const InnerWay way = inner_way(memory, most, s);
    return {work(memory, way, s), way.stress, way.tangent};
  }
  const double edge = std::copysign(memory.widest, s);
  const Curve::Value slope = resistance.evaluate(size);
  const double beyond = resistance.integral(size) - resistance.integral(memory.widest);
  return {work(memory, inner_way(memory, most, edge), edge) + law.share * beyond,
          std::copysign(law.share * slope.y, s), law.share * slope.slope};
}

ShearMemory sheared_to(const ShearFriction& law, const Curve& resistance, const ShearMemory& memory,
                       double s) {
  ShearMemory reached = memory;
  reached.sine = s;
  reached.stress = tow_friction(law, resistance, memory, s).first;
  if (std::abs(s) <= memory.widest) return reached;
  reached.widest = std::abs(s);
  reached.stiffness = std::max(
      memory.stiffness, law.stiffness * law.share * steepest(resistance, memory.widest, reached.widest));
  return reached;
}

double stored_in_crossovers(const ShearMemory& memory) {
  return memory.stiffness > 0.0 ? 0.5 * memory.stress * memory.stress / memory.stiffness : 0.0;
}

double dissipated_by_tows(const ShearFriction& law, const Curve& resistance, const ShearMemory& memory,
                          const ShearMemory& reached) {
  const double most = limit(law, resistance, memory);
  const double end = std::clamp(reached.sine, -memory.widest, memory.widest);
  const InnerWay way = inner_way(memory, most, end);
  const double inside = std::abs(way.stress) * std::abs(end - way.slips_from);
  if (std::abs(reached.sine) <= memory.widest) return inside;
  ShearMemory edge = memory;
  edge.stress = most;
  const double beyond = resistance.integral(reached.widest) - resistance.integral(memory.widest);
  return inside + law.share * beyond - (stored_in_crossovers(reached) - stored_in_crossovers(edge));
}

}  // namespace heddle::macroscale
