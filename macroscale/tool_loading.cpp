#include "macroscale/tool_loading.h"

#include <algorithm>
#include <array>
#include <optional>
#include <string>
#include <utility>

#include <tbb/task_group.h>

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
  const double half_width = required_half_width(tool_step(spec), thickness, SolveOptions{}.largest_increment);
  struct Source {
    std::string key;
    Role role;
    std::optional<ToolFileSpec>& file;
    Problems problems = {};
  };
  std::array<Source, 3> sources = {{{"tools.punch", Role::punch, spec.punch.file},
                                    {"tools.die", Role::die, spec.die.file},
                                    {"tools.binder", Role::binder, spec.binder.file}}};
  // Files are read one by one, which is gmsh's way; meanwhile the band of the tool before is built.
  tbb::task_group bands;
  for (Source& source : sources) {
    if (!source.file || source.file->loaded) continue;
    const Expectation expected{source.key, extent(outline_of(spec.blank)), spec.process.stroke,
                               source.role == Role::die ? 1 : -1};
    const bool sheet = source.file->source.topology == TopologyRule::open_allowed;
    try {
      auto tool = std::make_shared<LoadedTool>(load_tool(source.file->source, expected));
      const ToolBandSpec band{.voxel = source.file->voxel,
                              .half_width = half_width,
                              .sides = sheet ? Sides::open : Sides::closed,
                              .region = reach_of_fabric(spec, source.role, tool->mesh)};
      bands.run([&source, tool, band] {
        try {
          auto field = std::make_shared<const ToolBand>(tool_band(tool->mesh, band, source.key));
          source.file->loaded =
              std::make_shared<const LoadedToolFile>(LoadedToolFile{std::move(*tool), std::move(field)});
        } catch (const InputError& error) {
          source.problems = error.problems();
        }
      });
    } catch (const InputError& error) {
      source.problems = error.problems();
    }
  }
  bands.wait();
  Problems problems;
  for (const Source& source : sources)
    problems.insert(problems.end(), source.problems.begin(), source.problems.end());
  if (!problems.empty()) throw InputError(std::move(problems));
  return spec;
}

}  // namespace heddle::macroscale
