#include "pipeline/export/keyword_text.h"

#include <algorithm>

#include <fmt/format.h>
#include <Eigen/Geometry>

#include "core/units.h"

namespace heddle::pipeline {

double celsius(const PartTemperature& temperature) {
  return temperature.value - zero_celsius;
}

std::string data_lines(const std::vector<double>& values) {
  std::string out;
  for (std::size_t k = 0; k < values.size(); ++k)
    out += fmt::format("{:.10g}{}", values[k], (k + 1) % 8 == 0 || k + 1 == values.size() ? "\n" : ", ");
  return out;
}

std::string set_lines(const std::string& keyword, std::vector<int> members) {
  std::sort(members.begin(), members.end());
  members.erase(std::unique(members.begin(), members.end()), members.end());
  std::string out = keyword + "\n";
  for (std::size_t k = 0; k < members.size(); ++k)
    out += fmt::format("{}{}", members[k], (k + 1) % 16 == 0 || k + 1 == members.size() ? "\n" : ", ");
  return out;
}

std::string orientation_lines(const std::string& name, const CellStiffness& cell) {
  const Eigen::Vector3d warp(cell.warp.data()), normal(cell.normal.data());
  const Eigen::Vector3d across = normal.cross(warp);
  return fmt::format(
      "*ORIENTATION, NAME={}, SYSTEM=RECTANGULAR\n{:.12g}, {:.12g}, {:.12g}, {:.12g}, {:.12g}, {:.12g}\n",
      name, warp.x(), warp.y(), warp.z(), across.x(), across.y(), across.z());
}

std::string support_lines(const PartModel& model, const std::function<int(int)>& number) {
  std::vector<int> nodes;
  std::string held = "*BOUNDARY\n";
  for (const PartSupport& support : model.supports) {
    nodes.push_back(number(support.node));
    held += fmt::format("{0}, {1}, {1}\n", number(support.node), support.axis + 1);
  }
  return set_lines("*NSET, NSET=SUPPORTS", std::move(nodes)) + held;
}

}  // namespace heddle::pipeline
