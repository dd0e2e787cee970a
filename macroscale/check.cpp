#include <cmath>
#include <numbers>

#include <fmt/format.h>

#include "macroscale/stamping.h"

namespace heddle::macroscale {

namespace {

class Findings {
 public:
  void demand(bool holds, const char* id, const char* key, std::string value, std::string rule,
              std::string way_out) {
    if (!holds) problems_.push_back({id, key, std::move(value), std::move(rule), std::move(way_out)});
  }
  Problems take() { return std::move(problems_); }

 private:
  Problems problems_;
};

std::string mm(double metres) {
  return fmt::format("{:g} mm", 1e3 * metres);
}

}  // namespace

Problems check(const StampingSpec& spec) {
  Findings f;
  const auto& [blank, punch, die, binder, process, artefact, shear_rate, contact_pressure] = spec;
  const double die_edge = die.opening_radius + die.fillet;
  const double half = 0.5 * std::min(blank.size[0], blank.size[1]);
  f.demand(half > die_edge && half > binder.inner_radius + binder.edge_fillet, "blank.size.reach",
           "blank.size", fmt::format("[{}, {}]", mm(blank.size[0]), mm(blank.size[1])),
           fmt::format("must reach beyond the die's edge ({}) and the binder's ({})", mm(2.0 * die_edge),
                       mm(2.0 * (binder.inner_radius + binder.edge_fillet))),
           "A blank that lies inside the opening is held by nothing: enlarge it, or the tools shrink.");
  f.demand(blank.spacing > 0.0 && blank.spacing < 0.25 * half, "blank.spacing.range", "blank.spacing",
           mm(blank.spacing),
           fmt::format("must satisfy 0 < spacing < {} (an eighth of the blank)", mm(0.25 * half)),
           "4.5 mm suits the shipped case.");
  const double cells = blank.size[0] * blank.size[1] / (blank.spacing * blank.spacing);
  f.demand(blank.spacing <= 0.0 || cells <= 5e5, "blank.spacing.nodes", "blank.spacing", mm(blank.spacing),
           fmt::format("must give at most 500000 cells; this gives {:.3g}", cells),
           "A few thousand cells resolve a part; the shipped case has 5184.");
  f.demand(blank.orientation == 0.0, "blank.orientation.range", "blank.orientation",
           fmt::format("{:g} deg", blank.orientation * 180.0 / std::numbers::pi), "must be 0 deg",
           "Blanks cut at an angle to their tows come with a later version.");
  f.demand(process.stroke < half, "process.punch.stroke.reach", "process.punch.stroke", mm(process.stroke),
           fmt::format("must be less than half the blank ({})", mm(half)),
           "A deeper stroke pulls the blank out of the binder.");
  f.demand(blank.plies == 1, "blank.plies.range", "blank.plies", fmt::format("{}", blank.plies), "must be 1",
           "Several plies come with a later version; run one.");
  f.demand(punch.radius > 0.0, "tools.punch.radius.range", "tools.punch.radius", mm(punch.radius),
           "must be > 0", "70 mm in the shipped case.");
  f.demand(die.fillet > 0.0, "tools.die.fillet.range", "tools.die.fillet", mm(die.fillet), "must be > 0",
           "A sharp edge cuts the tows; 20 mm in the shipped case.");
  f.demand(die.opening_radius > punch.radius, "tools.die.opening_radius.clearance",
           "tools.die.opening_radius", mm(die.opening_radius),
           fmt::format("must exceed the punch radius ({})", mm(punch.radius)),
           "Leave at least the fabric's compacted thickness between them.");
  f.demand(binder.inner_radius > punch.radius, "tools.binder.inner_radius.clearance",
           "tools.binder.inner_radius", mm(binder.inner_radius),
           fmt::format("must exceed the punch radius ({})", mm(punch.radius)),
           "The punch passes through the binder; 92 mm in the shipped case.");
  f.demand(binder.edge_fillet > 0.0, "tools.binder.edge_fillet.range", "tools.binder.edge_fillet",
           mm(binder.edge_fillet), "must be > 0", "2 mm in the shipped case.");
  f.demand(binder.mass > 0.0, "tools.binder.mass.range", "tools.binder.mass",
           fmt::format("{:g} kg", binder.mass), "must be > 0", "20 kg in the shipped case.");
  f.demand(process.stroke > 0.0, "process.punch.stroke.range", "process.punch.stroke", mm(process.stroke),
           "must be > 0", "70 mm in the shipped case.");
  f.demand(process.slow_down >= 0.0 && process.slow_down < process.time, "process.punch.slow_down.range",
           "process.punch.slow_down", fmt::format("{:g} s", process.slow_down),
           fmt::format("must satisfy 0 <= slow_down < time ({:g} s)", process.time),
           "The paper's profile slows in the last 0.01 s.");
  f.demand(process.speed_scale > 0.0, "process.punch.speed_scale.range", "process.punch.speed_scale",
           fmt::format("{:g}", process.speed_scale), "must be > 0",
           "1 is the paper's profile, 0.5 half its speed.");
  f.demand(process.steps >= 1, "process.steps.range", "process.steps", fmt::format("{}", process.steps),
           "must be >= 1", "100 steps of equal stroke in the shipped case.");
  f.demand(process.binder_force > 0.0, "process.binder_force.range", "process.binder_force",
           fmt::format("{:g} N", process.binder_force), "must be > 0", "650 to 3000 N in the paper.");
  f.demand(artefact.mass_scaling > 0.0, "artefact.mass_scaling.range", "artefact.mass_scaling",
           fmt::format("{:g}", artefact.mass_scaling), "must be > 0", "1 is true mass.");
  f.demand(artefact.stabilisation >= 0.0, "artefact.stabilisation.range", "artefact.stabilisation",
           fmt::format("{:g} N s/m^3", artefact.stabilisation), "must be >= 0", "0 is off.");
  return f.take();
}

}  // namespace heddle::macroscale
