#include <algorithm>
#include <cmath>
#include <numbers>

#include <fmt/format.h>

#include "macroscale/stamping.h"

#include "macroscale/outline_cut.h"
#include "macroscale/press_check.h"
#include "macroscale/symmetric_piece.h"

namespace heddle::macroscale {

namespace {

class Findings {
 public:
  void demand(bool holds, RuleId id, const std::string& key, std::string value, std::string rule,
              std::string way_out, std::vector<std::string> others = {}) {
    if (holds) return;
    problems_.push_back({std::move(id), key, std::move(value), std::move(rule), std::move(way_out), "", 0,
                         std::move(others)});
  }
  void add(Problems more) {
    for (Problem& problem : more) problems_.push_back(std::move(problem));
  }
  Problems take() { return std::move(problems_); }

 private:
  Problems problems_;
};

constexpr double fastest_punch = 1000.0;  ///< [m/s]; c = sqrt(E / rho) of a tow is 2 to 5 km/s

std::string mm(double metres) {
  return fmt::format("{:g} mm", 1e3 * metres);
}

// The key that says how large the blank is.
const char* size_key(const BlankSpec& blank) {
  switch (blank.shape) {
    case BlankShape::rectangle:
      return "blank.size";
    case BlankShape::circle:
      return "blank.radius";
    case BlankShape::polygon:
      return "blank.points";
  }
  return "blank.shape";
}

bool has_area(const BlankSpec& blank) {
  if (blank.shape == BlankShape::rectangle) return blank.size[0] > 0.0 && blank.size[1] > 0.0;
  if (blank.shape == BlankShape::circle) return blank.radius > 0.0;
  return blank.polygon.outer.size() >= 3 && area(polygon(blank.polygon.outer)) > 0.0;
}

// How far the blank reaches from the punch axis in every direction [m].
double reach_of(const BlankSpec& blank) {
  return has_area(blank) ? reach(outline_of(blank)) : 0.0;
}

std::string size_in_words(const BlankSpec& blank) {
  if (blank.shape == BlankShape::rectangle)
    return fmt::format("[{}, {}]", mm(blank.size[0]), mm(blank.size[1]));
  if (blank.shape == BlankShape::circle) return mm(blank.radius);
  return fmt::format("{} points", blank.polygon.outer.size());
}

// The blank grid takes any outline; what the tools demand of it is that it lies on them all round. Holes may
// lie anywhere inside: below the punch, in the opening, or under the binder.
void check_blank(Findings& f, const BlankSpec& blank, double tool_edge,
                 const std::vector<std::string>& edges) {
  const std::string key = size_key(blank);
  if (!has_area(blank)) {
    f.demand(false, "*.area"_family.of(key), key, size_in_words(blank), "must enclose an area",
             "Give three points or more, in order along the edge.");
    return;
  }
  if (Problems crossing = check(polygon(outline_of(blank).outer), key); !crossing.empty()) {
    f.add(std::move(crossing));
    return;
  }
  const double half = reach_of(blank);
  f.demand(
      half > tool_edge, "*.reach"_family.of(key), key, size_in_words(blank),
      fmt::format("must reach beyond the edges of die and binder all round ({} from the punch axis; this "
                  "reaches {})",
                  mm(tool_edge), mm(half)),
      "A blank that lies inside the opening is held by nothing: enlarge it, or make the tools smaller.",
      edges);
  f.demand(blank.spacing > 0.0 && std::isfinite(blank.spacing), "blank.spacing.range"_rule, "blank.spacing",
           mm(blank.spacing), "must satisfy 0 < spacing", "4.5 mm suits the shipped case.");
  f.demand(!(blank.spacing >= 0.25 * half), "blank.spacing.coarse"_rule, "blank.spacing", mm(blank.spacing),
           fmt::format("must be less than {} (an eighth of the blank)", mm(0.25 * half)),
           "4.5 mm suits the shipped case.", {key});
  const double cells = area({outline_of(blank).outer, {}}) / (blank.spacing * blank.spacing);
  f.demand(!(blank.spacing > 0.0) || cells <= 5e5, "blank.spacing.nodes"_rule, "blank.spacing",
           mm(blank.spacing), fmt::format("must give at most 500000 cells; this gives {:.3g}", cells),
           "A few thousand cells resolve a part; the shipped case has 5184.", {key});
  for (const RoundHole& hole : blank.holes) {
    const Point2 beyond{hole.centre[0], hole.centre[1]};
    Outline shifted{outline_of(blank).outer, {}};
    for (Point2& p : shifted.outer) p = {p[0] - beyond[0], p[1] - beyond[1]};
    f.demand(hole.radius > 0.0 && reach(shifted) > hole.radius, "blank.holes.inside"_rule, "blank.holes",
             fmt::format("[{}, {}, {}]", mm(hole.centre[0]), mm(hole.centre[1]), mm(hole.radius)),
             "must have a radius > 0 and lie inside the blank, clear of its edge",
             "Each hole is [x, y, radius]; a notch belongs into the outline.", {key});
  }
}

void check_plies(Findings& f, const BlankSpec& blank, bool heat) {
  const std::string plies = fmt::format("{}", blank.plies);
  f.demand(blank.plies >= 1 && blank.plies <= 16, "blank.plies.range"_rule, "blank.plies", plies,
           "must be 1 to 16", "Each ply has a grid of its own and costs as much as one, and more.");
  f.demand(blank.layup.empty() || blank.layup.size() == static_cast<std::size_t>(std::max(blank.plies, 0)),
           "blank.layup.plies"_rule, "blank.layup", fmt::format("{} angles", blank.layup.size()),
           fmt::format("must be one angle a ply; blank.plies is {}", plies),
           "Give the turn of each ply, bottom first, or leave it out: then all lie alike.", {"blank.plies"});
  f.demand(blank.nesting >= 0.0 && std::isfinite(blank.nesting), "blank.nesting.range"_rule, "blank.nesting",
           mm(blank.nesting), "must be >= 0",
           "0 mm: plies lie a thickness apart. heddle weave with cell.plies: 2 says how much they nest.");
  f.demand(!(heat && blank.plies > 1), "blank.plies.thermal"_rule, "blank.plies", plies,
           "must be 1 in a run with temperatures: heat goes through one ply from tool to tool",
           "Leave out `thermal`, or run one ply.", {"thermal"});
}

// A tool from a file has no numbers of its own: check_tools looks at its surface.
void check_shapes(Findings& f, const PunchSpec& punch, const DieSpec& die, const BinderSpec& binder) {
  if (!punch.file) {
    f.demand(punch.radius > 0.0, "tools.punch.radius.range"_rule, "tools.punch.radius", mm(punch.radius),
             "must be > 0", "70 mm in the shipped case.");
  }
  if (!die.file) {
    f.demand(die.fillet > 0.0, "tools.die.fillet.range"_rule, "tools.die.fillet", mm(die.fillet),
             "must be > 0", "A sharp edge cuts the tows; 20 mm in the shipped case.");
    f.demand(punch.file || die.opening_radius > punch.radius, "tools.die.opening_radius.clearance"_rule,
             "tools.die.opening_radius", mm(die.opening_radius),
             fmt::format("must exceed the punch radius ({})", mm(punch.radius)),
             "Leave at least the fabric's thickness between them.", {"tools.punch.radius"});
  }
  if (!binder.file) {
    f.demand(punch.file || binder.inner_radius > punch.radius, "tools.binder.inner_radius.clearance"_rule,
             "tools.binder.inner_radius", mm(binder.inner_radius),
             fmt::format("must exceed the punch radius ({})", mm(punch.radius)),
             "The punch passes through the binder; 92 mm in the shipped case.", {"tools.punch.radius"});
    f.demand(binder.edge_fillet > 0.0, "tools.binder.edge_fillet.range"_rule, "tools.binder.edge_fillet",
             mm(binder.edge_fillet), "must be > 0", "2 mm in the shipped case.");
  }
}

}  // namespace

Problems check(const StampingSpec& spec) {
  Findings f;
  const auto& [blank, punch, die, binder, process, artefact, shear_rate, shear_friction, contact_pressure,
               contact_sites, compaction_follows_shear, self_contact, heat, effects] = spec;
  if (heat) f.add(thermal::check(*heat));
  f.add(check_press(spec));
  f.add(check(effects));
  const double die_edge = die.opening_radius + die.fillet;
  double edge = 0.0;
  std::vector<std::string> edges{"tools.die.file", "tools.binder.file"};
  if (!die.file) {
    edge = std::max(edge, die_edge);
    edges.insert(edges.end(), {"tools.die.opening_radius", "tools.die.fillet"});
  }
  if (!binder.file) {
    edge = std::max(edge, binder.inner_radius + binder.edge_fillet);
    edges.insert(edges.end(), {"tools.binder.inner_radius", "tools.binder.edge_fillet"});
  }
  check_blank(f, blank, edge, edges);
  const double half = reach_of(blank);
  f.demand(half <= 0.0 || process.stroke < half, "process.punch.stroke.reach"_rule, "process.punch.stroke",
           mm(process.stroke), fmt::format("must be less than half the blank ({})", mm(half)),
           "A deeper stroke pulls the blank out of the binder.", {size_key(blank)});
  check_plies(f, blank, heat.has_value());
  if (half > 0.0) f.add(check_symmetry(spec));
  check_shapes(f, punch, die, binder);
  f.demand(binder.mass > 0.0, "tools.binder.mass.range"_rule, "tools.binder.mass",
           fmt::format("{:g} kg", binder.mass), "must be > 0", "20 kg in the shipped case.");
  f.demand(process.stroke > 0.0, "process.punch.stroke.range"_rule, "process.punch.stroke",
           mm(process.stroke), "must be > 0", "70 mm in the shipped case.");
  f.demand(process.time > 0.0, "process.punch.time.range"_rule, "process.punch.time",
           fmt::format("{:g} s", process.time), "must be > 0", "0.43 s in the shipped case.");
  f.demand(process.slow_down >= 0.0, "process.punch.slow_down.range"_rule, "process.punch.slow_down",
           fmt::format("{:g} s", process.slow_down), "must be >= 0",
           "The paper's profile slows in the last 0.01 s; 0 s stops at once.");
  f.demand(!(process.slow_down >= process.time), "process.punch.slow_down.shorter"_rule,
           "process.punch.slow_down", fmt::format("{:g} s", process.slow_down),
           fmt::format("must be shorter than the stroke's time ({:g} s)", process.time),
           "The paper's profile slows in the last 0.01 s.", {"process.punch.time"});
  f.demand(process.speed_scale > 0.0, "process.punch.speed_scale.range"_rule, "process.punch.speed_scale",
           fmt::format("{:g}", process.speed_scale), "must be > 0",
           "1 is the paper's profile, 0.5 half its speed.");
  const double speed = process.stroke / process.time * process.speed_scale;
  f.demand(
      !(process.time > 0.0 && process.speed_scale > 0.0) || speed <= fastest_punch,
      "process.punch.time.speed"_rule, "process.punch.time", fmt::format("{:g} s", process.time),
      fmt::format("must leave the punch slower than {:g} m/s; it moves at {:.4g} m/s", fastest_punch, speed),
      "Sound in the tows is not much faster; 0.16 m/s in the shipped case.",
      {"process.punch.stroke", "process.punch.speed_scale"});
  f.demand(process.steps >= 1, "process.steps.range"_rule, "process.steps", fmt::format("{}", process.steps),
           "must be >= 1", "100 steps of equal stroke in the shipped case.");
  f.demand(process.binder_force > 0.0, "process.binder_force.range"_rule, "process.binder_force",
           fmt::format("{:g} N", process.binder_force), "must be > 0", "650 to 3000 N in the paper.");
  // The whole blank's area gives the least pressure there can be.
  const double crushing = half > 0.0 ? crush_pressure * area(outline_of(blank)) : 0.0;
  f.demand(
      crushing <= 0.0 || !(process.binder_force > crushing) || binder.control == BinderControl::gap,
      "process.binder_force.crush"_rule, "process.binder_force", fmt::format("{:g} N", process.binder_force),
      fmt::format("must stay below {:.4g} N: spread over the whole blank it is {:g} MPa, which crushes any "
                  "woven fabric",
                  crushing, 1e-6 * crush_pressure),
      "Less force, or a larger blank that spreads it.", {size_key(blank)});
  f.demand(artefact.mass_scaling > 0.0, "artefact.mass_scaling.range"_rule, "artefact.mass_scaling",
           fmt::format("{:g}", artefact.mass_scaling), "must be > 0", "1 is true mass.");
  f.demand(artefact.stabilisation >= 0.0, "artefact.stabilisation.range"_rule, "artefact.stabilisation",
           fmt::format("{:g} N s/m^3", artefact.stabilisation), "must be >= 0", "0 is off.");
  f.demand(shear_rate >= 0.0, "effects.shear_rate.factor.range"_rule, "effects.shear_rate.factor",
           fmt::format("{:g}", shear_rate), "must be >= 0", "1 is what weave and melt give, 0 is off.");
  f.demand(shear_friction.share >= 0.0 && shear_friction.share < 1.0,
           "fabric.shear_hysteresis.share.range"_rule, "fabric.shear_hysteresis.share",
           fmt::format("{:g}", shear_friction.share), "must be at least 0 and below 1",
           "0 is off: shear gives back all it took. 1 would leave no spring in the fabric.");
  f.demand(shear_friction.stiffness >= 1.0, "fabric.shear_hysteresis.stiffness.range"_rule,
           "fabric.shear_hysteresis.stiffness", fmt::format("{:g}", shear_friction.stiffness),
           "must be at least 1",
           "Below, a reversal would be softer than the loading before it; 2 is the default.");
  f.demand(!(effects.tension_coupling.on() && shear_friction.on()),
           "effects.tension_shear_coupling.amplitude.hysteresis"_rule,
           "effects.tension_shear_coupling.amplitude",
           fmt::format("{:g}", effects.tension_coupling.amplitude),
           "cannot stand beside fabric.shear_hysteresis: one potential holds tension and what tows rub away "
           "only if the latter does not depend on tension",
           "Leave out one of the two.", {"fabric.shear_hysteresis.share"});
  f.demand(process.cooling_rate >= 0.0 && std::isfinite(process.cooling_rate),
           "effects.blank_cooling.rate.range"_rule, "effects.blank_cooling.rate",
           fmt::format("{:g} 1/s", process.cooling_rate), "must be >= 0", "0 1/s is off.");
  f.demand(!(process.cooling_rate > 0.0 && heat), "effects.blank_cooling.rate.thermal"_rule,
           "effects.blank_cooling.rate", fmt::format("{:g} 1/s", process.cooling_rate),
           "cannot stand beside `thermal`, which cools the blank by conduction",
           "Leave out the effect, or leave out `thermal`.", {"thermal"});
  f.demand(process.press.binder_force_error > -1.0 && std::isfinite(process.press.binder_force_error),
           "effects.binder_force_level.error.range"_rule, "effects.binder_force_level.error",
           fmt::format("{:g}", process.press.binder_force_error), "must be > -1",
           "0 is off; 0.1 presses a tenth harder than process.binder_force.");
  f.demand(std::abs(blank.turned) <= std::numbers::pi, "effects.initial_orientation.angle.range"_rule,
           "effects.initial_orientation.angle",
           fmt::format("{:g} deg", blank.turned * 180.0 / std::numbers::pi),
           "must lie within -180 and 180 deg", "0 deg is off.");
  return f.take();
}

}  // namespace heddle::macroscale
