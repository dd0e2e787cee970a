#include "macroscale/tool_loading.h"

#include <algorithm>
#include <array>
#include <optional>
#include <string>
#include <utility>

#include "macroscale/solve.h"
#include "macroscale/tool_set.h"

namespace heddle::macroscale {

namespace {

std::array<double, 2> extent(const Outline& outline) {
  std::array<double, 2> size{};
  for (std::size_t c = 0; c < 2; ++c) {
    const auto [low, high] =
        std::minmax_element(outline.outer.begin(), outline.outer.end(),
                            [c](const Point2& a, const Point2& b) { return a[c] < b[c]; });
    size[c] = (*high)[c] - (*low)[c];
  }
  return size;
}

// Longest way of a tool in one step: the punch's, which also bounds how a node can be carried.
double tool_step(const StampingSpec& spec) {
  return spec.process.stroke / spec.process.steps;
}

}  // namespace

StampingSpec with_tools_loaded(StampingSpec spec, double thickness) {
  Problems problems;
  const double half_width = required_half_width(tool_step(spec), thickness, SolveOptions{}.largest_increment);
  const std::array<std::pair<std::string, std::optional<ToolFileSpec>*>, 3> tools = {
      {{"tools.punch", &spec.punch.file},
       {"tools.die", &spec.die.file},
       {"tools.binder", &spec.binder.file}}};
  for (const auto& [key, file_pointer] : tools) {
    auto& file = *file_pointer;
    if (!file || file->loaded) continue;
    const Expectation expected{key, extent(outline_of(spec.blank)), spec.process.stroke};
    try {
      LoadedTool tool = load_tool(file->source, expected);
      const ToolBandSpec band{.voxel = file->voxel, .half_width = half_width};
      auto field = std::make_shared<const ToolBand>(tool_band(tool.mesh, band, key));
      file->loaded =
          std::make_shared<const LoadedToolFile>(LoadedToolFile{std::move(tool), std::move(field)});
    } catch (const InputError& error) {
      problems.insert(problems.end(), error.problems().begin(), error.problems().end());
    }
  }
  if (!problems.empty()) throw InputError(std::move(problems));
  return spec;
}

}  // namespace heddle::macroscale
