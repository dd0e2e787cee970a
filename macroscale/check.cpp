#include <algorithm>

#include <fmt/format.h>

#include "macroscale/stamping.h"

#include "macroscale/outline_cut.h"

namespace heddle::macroscale {

namespace {

class Findings {
 public:
  void demand(bool holds, const std::string& id, const std::string& key, std::string value, std::string rule,
              std::string way_out) {
    if (!holds) problems_.push_back({id, key, std::move(value), std::move(rule), std::move(way_out)});
  }
  void add(Problems more) {
    for (Problem& problem : more) problems_.push_back(std::move(problem));
  }
  Problems take() { return std::move(problems_); }

 private:
  Problems problems_;
};

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
void check_blank(Findings& f, const BlankSpec& blank, double tool_edge) {
  const std::string key = size_key(blank);
  if (!has_area(blank)) {
    f.demand(false, (key + ".area"), key, size_in_words(blank), "must enclose an area",
             "Give three points or more, in order along the edge.");
    return;
  }
  if (Problems crossing = check(polygon(outline_of(blank).outer), key); !crossing.empty()) {
    f.add(std::move(crossing));
    return;
  }
  const double half = reach_of(blank);
  f.demand(
      half > tool_edge, (key + ".reach"), key, size_in_words(blank),
      fmt::format("must reach beyond the edges of die and binder all round ({} from the punch axis; this "
                  "reaches {})",
                  mm(tool_edge), mm(half)),
      "A blank that lies inside the opening is held by nothing: enlarge it, or the tools shrink.");
  f.demand(blank.spacing > 0.0 && blank.spacing < 0.25 * half, "blank.spacing.range", "blank.spacing",
           mm(blank.spacing),
           fmt::format("must satisfy 0 < spacing < {} (an eighth of the blank)", mm(0.25 * half)),
           "4.5 mm suits the shipped case.");
  const double cells = area({outline_of(blank).outer, {}}) / (blank.spacing * blank.spacing);
  f.demand(blank.spacing <= 0.0 || cells <= 5e5, "blank.spacing.nodes", "blank.spacing", mm(blank.spacing),
           fmt::format("must give at most 500000 cells; this gives {:.3g}", cells),
           "A few thousand cells resolve a part; the shipped case has 5184.");
  for (const RoundHole& hole : blank.holes) {
    const Point2 beyond{hole.centre[0], hole.centre[1]};
    Outline shifted{outline_of(blank).outer, {}};
    for (Point2& p : shifted.outer) p = {p[0] - beyond[0], p[1] - beyond[1]};
    f.demand(hole.radius > 0.0 && reach(shifted) > hole.radius, "blank.holes.inside", "blank.holes",
             fmt::format("[{}, {}, {}]", mm(hole.centre[0]), mm(hole.centre[1]), mm(hole.radius)),
             "must have a radius > 0 and lie inside the blank, clear of its edge",
             "Each hole is [x, y, radius]; a notch belongs into the outline.");
  }
}

// A tool from a file has no numbers of its own: check_tools looks at its surface.
void check_shapes(Findings& f, const PunchSpec& punch, const DieSpec& die, const BinderSpec& binder) {
  if (!punch.file) {
    f.demand(punch.radius > 0.0, "tools.punch.radius.range", "tools.punch.radius", mm(punch.radius),
             "must be > 0", "70 mm in the shipped case.");
  }
  if (!die.file) {
    f.demand(die.fillet > 0.0, "tools.die.fillet.range", "tools.die.fillet", mm(die.fillet), "must be > 0",
             "A sharp edge cuts the tows; 20 mm in the shipped case.");
    f.demand(punch.file || die.opening_radius > punch.radius, "tools.die.opening_radius.clearance",
             "tools.die.opening_radius", mm(die.opening_radius),
             fmt::format("must exceed the punch radius ({})", mm(punch.radius)),
             "Leave at least the fabric's compacted thickness between them.");
  }
  if (!binder.file) {
    f.demand(punch.file || binder.inner_radius > punch.radius, "tools.binder.inner_radius.clearance",
             "tools.binder.inner_radius", mm(binder.inner_radius),
             fmt::format("must exceed the punch radius ({})", mm(punch.radius)),
             "The punch passes through the binder; 92 mm in the shipped case.");
    f.demand(binder.edge_fillet > 0.0, "tools.binder.edge_fillet.range", "tools.binder.edge_fillet",
             mm(binder.edge_fillet), "must be > 0", "2 mm in the shipped case.");
  }
}

}  // namespace

Problems check(const StampingSpec& spec) {
  Findings f;
  const auto& [blank, punch, die, binder, process, artefact, shear_rate, contact_pressure] = spec;
  const double die_edge = die.opening_radius + die.fillet;
  double edge = 0.0;
  if (!die.file) edge = std::max(edge, die_edge);
  if (!binder.file) edge = std::max(edge, binder.inner_radius + binder.edge_fillet);
  check_blank(f, blank, edge);
  const double half = reach_of(blank);
  f.demand(half <= 0.0 || process.stroke < half, "process.punch.stroke.reach", "process.punch.stroke",
           mm(process.stroke), fmt::format("must be less than half the blank ({})", mm(half)),
           "A deeper stroke pulls the blank out of the binder.");
  f.demand(blank.plies == 1, "blank.plies.range", "blank.plies", fmt::format("{}", blank.plies), "must be 1",
           "Several plies come with a later version; run one.");
  check_shapes(f, punch, die, binder);
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
