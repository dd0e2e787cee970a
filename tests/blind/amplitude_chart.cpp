#include "amplitude_chart.h"

#include <map>

#include "pipeline/chart.h"

namespace heddle::blind {

std::string amplitude_chart(const std::vector<Judged>& cases) {
  std::map<double, std::vector<Judged>> by_amplitude;
  for (const Judged& judged : cases) by_amplitude[judged.planned.spec.amplitude].push_back(judged);
  using pipeline::Series;
  Series set{"truth in the set", {}, {}}, top{"top-1 name", {}, {}}, low{"its lower bound", {}, {}},
      high{"its upper bound", {}, {}};
  for (const auto& [amplitude, group] : by_amplitude) {
    const Scores s = score(group);
    const Interval interval = wilson(s.top1);
    for (Series* series : {&set, &top, &low, &high}) series->x.push_back(amplitude);
    set.y.push_back(100.0 * s.candidate_set.value());
    top.y.push_back(100.0 * s.top1.value());
    low.y.push_back(100.0 * interval.low);
    high.y.push_back(100.0 * interval.high);
  }
  const pipeline::LineChart chart{
      .label = "Share of hidden effects that are named, against their amplitude",
      .x = {.quantity = "Amplitude (1 = 15 to 30 % of the force)", .unit = "", .low = 0.0},
      .y = {.quantity = "Cases", .unit = "%", .low = 0.0, .high = 100.0},
      .series = {top, high, low, set}};
  return pipeline::draw(chart).standalone_svg();
}

}  // namespace heddle::blind
