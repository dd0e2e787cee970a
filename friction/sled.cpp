#include "friction/sled.h"

#include <algorithm>

#include "friction/pull.h"

namespace heddle::friction {

SledResult sled_test(const Model& model, const Sled& sled) {
  FrictionTestRow row;
  row.name = "sled";
  row.velocity = sled.speed;
  row.normal_force = sled.normal_force();
  row.tool_temperature = sled.tool_temperature;
  row.fabric_temperature = sled.fabric_temperature;
  FrictionRig rig;
  rig.plate_area = sled.side * sled.side;
  rig.pull_length = sled.travel;
  constexpr int steps = 2600;  // 0.05 mm over the standard's travel
  SledResult result;
  double area = 0.0;
  const std::vector<PullPoint> pull = pull_history(model, row, rig, steps);
  for (std::size_t i = 0; i < pull.size(); ++i) {
    if (pull[i].slip <= sled.start)
      result.static_coefficient = std::max(result.static_coefficient, pull[i].mu);
    else
      area += 0.5 * (pull[i - 1].mu + pull[i].mu) * (pull[i].slip - std::max(pull[i - 1].slip, sled.start));
  }
  result.kinetic_coefficient = area / (sled.travel - sled.start);
  result.calibrated = run_friction_test(model, row, rig).calibrated;
  return result;
}

}  // namespace heddle::friction
