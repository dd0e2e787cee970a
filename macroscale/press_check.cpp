#include "macroscale/press_check.h"

#include <algorithm>
#include <cmath>
#include <iterator>
#include <limits>
#include <string>
#include <utility>

#include <fmt/format.h>

namespace heddle::macroscale {

namespace {

// A punch off its axis still has to pass die and binder; drawn tools are measured on their surfaces
// (check_tools).
Problems check_offset(const StampingSpec& spec) {
  const auto& [x, y] = spec.process.press.punch_offset;
  const double offset = std::hypot(x, y);
  if (offset == 0.0 || spec.punch.file) return {};
  double room = std::numeric_limits<double>::infinity();
  if (!spec.die.file) room = std::min(room, spec.die.opening_radius - spec.punch.radius);
  if (!spec.binder.file) room = std::min(room, spec.binder.inner_radius - spec.punch.radius);
  if (offset < room) return {};
  return {{"effects.punch_misalignment.offset.clearance"_rule,
           "effects.punch_misalignment.offset",
           "",
           fmt::format("is {:.4g} mm, and {:.4g} mm are free beside the punch", 1e3 * offset, 1e3 * room),
           "The punch would run into the die or the binder: less, or a wider opening.",
           "",
           0,
           {"tools.punch.radius", "tools.die.opening_radius", "tools.binder.inner_radius"}}};
}

Problems check_bottom(const StampingSpec& spec) {
  if (spec.die.bottom == DieBottom::open || spec.die.file) return {};
  Problems problems;
  const double least = spec.die.opening_radius + spec.die.fillet;
  if (spec.die.bottom == DieBottom::bowl && spec.die.depth < least)
    problems.push_back(
        {"tools.die.depth.bowl"_rule,
         "tools.die.depth",
         "",
         fmt::format("must be at least {:.4g} mm, the bowl's radius and the edge's fillet", 1e3 * least),
         "A bowl has the radius of the opening and begins below the fillet.",
         "",
         0,
         {"tools.die.opening_radius", "tools.die.fillet"}});
  if (spec.process.press.force_limit == 0.0 && spec.process.stroke > spec.die.depth)
    problems.push_back(
        {"tools.die.depth.stroke"_rule,
         "tools.die.depth",
         "",
         fmt::format("is less than the stroke of {:.4g} mm, and nothing says at which force the punch stops",
                     1e3 * spec.process.stroke),
         "Give process.bottoming_force, or shorten process.punch.stroke.",
         "",
         0,
         {"process.punch.stroke"}});
  return problems;
}

// One plate that carries its force at the punch's axis.
Problems check_free_tilt(const StampingSpec& spec) {
  if (!spec.binder.free_tilt || spec.binder.control == BinderControl::gap) return {};
  Problems problems;
  const auto refuse_if = [&](bool wrong, RuleId id, std::string rule, std::string way_out,
                             std::string other) {
    if (wrong)
      problems.push_back({std::move(id),
                          "tools.binder.tilt",
                          "",
                          std::move(rule),
                          std::move(way_out),
                          "",
                          0,
                          {std::move(other)}});
  };
  refuse_if(spec.binder.sectors > 1, "tools.binder.tilt.sectors"_rule,
            "must be held where the binder is split: sectors move by themselves already",
            "Leave it out, or leave tools.binder.sectors out.", "tools.binder.sectors");
  refuse_if(spec.process.press.binder_tilt != 0.0, "tools.binder.tilt.angle"_rule,
            "must be held where effects.binder_tilt holds the binder at an angle", "Leave one of them out.",
            "effects.binder_tilt.angle");
  refuse_if(spec.blank.symmetry != Symmetry::none, "tools.binder.tilt.symmetry"_rule,
            "must be held in a part of which a piece is computed: what is symmetric does not tilt its binder",
            "Leave it out, or blank.symmetry: then the whole blank is computed.", "blank.symmetry");
  return problems;
}

}  // namespace

Problems check_press(const StampingSpec& spec) {
  Problems problems = check_offset(spec);
  for (Problems more : {check_bottom(spec), check_free_tilt(spec)})
    std::move(more.begin(), more.end(), std::back_inserter(problems));
  return problems;
}

}  // namespace heddle::macroscale
