#include "macroscale/tool_set.h"

#include <algorithm>
#include <cmath>
#include <limits>

#include <fmt/format.h>
#include <tbb/blocked_range.h>
#include <tbb/parallel_reduce.h>

#include "macroscale/blank.h"
#include "macroscale/symmetric_piece.h"

namespace heddle::macroscale {

namespace {

using Eigen::Vector3d;

// A node counts as under the flat face if the face is this near to being level there.
constexpr double flat_tolerance = 1e-6;  // [m]

struct Heights {
  double low = std::numeric_limits<double>::infinity(),
         high = -std::numeric_limits<double>::infinity();  ///< [m]
};

Heights heights(const TriangleMesh& mesh) {
  Heights z;
  for (const auto& v : mesh.vertices) {
    z.low = std::min(z.low, v[2]);
    z.high = std::max(z.high, v[2]);
  }
  return z;
}

bool from_above(Role role) {
  return role != Role::die;
}

// How far the file's origin is moved along z until the tool touches z = 0.
double lift_to_touch(const TriangleMesh& mesh, Role role) {
  const Heights z = heights(mesh);
  return from_above(role) ? -z.low : -z.high;
}

// Of a tool's axis from that of the press.
Vector3d offset_of(const StampingSpec& spec, Role role) {
  if (role != Role::punch) return Vector3d::Zero();
  const auto& offset = spec.process.press.punch_offset;
  return {offset[0], offset[1], 0.0};
}

Shape shape_of_numbers(const StampingSpec& spec, Role role) {
  switch (role) {
    case Role::punch:
      return HemisphereShape{offset_of(spec, role), spec.punch.radius};
    case Role::die:
      return RingShape{0.0, spec.die.opening_radius, spec.die.fillet, true,
                       spec.die.bottom == DieBottom::bowl ? spec.die.depth : 0.0};
    case Role::binder:
      return RingShape{0.0, spec.binder.inner_radius, spec.binder.edge_fillet, false};
  }
  return {};
}

const std::optional<ToolFileSpec>& file_of(const StampingSpec& spec, Role role) {
  return role == Role::punch ? spec.punch.file : role == Role::die ? spec.die.file : spec.binder.file;
}
std::string key_of(Role role) {
  return "tools." + name_of(role);
}

Shape touching(const StampingSpec& spec, Role role) {
  const auto& file = file_of(spec, role);
  if (!file) return shape_of_numbers(spec, role);
  const Vector3d offset = offset_of(spec, role);
  return BandShape{file->loaded->band,
                   Vector3d(offset.x(), offset.y(), lift_to_touch(file->loaded->tool.mesh, role))};
}

// Empty for a tool of numbers.
const TriangleMesh* mesh_of(const StampingSpec& spec, Role role) {
  const auto& file = file_of(spec, role);
  return file ? &file->loaded->tool.mesh : nullptr;
}

struct Nearest {
  double distance = std::numeric_limits<double>::infinity();  ///< [m]
  double stroke = 0.0;                                        ///< of the punch [m]
  Vector3d at = Vector3d::Zero();                             ///< in the frame of the press [m]
};

// Distance of one tool's point to another tool. Outside the fabric's reach it is told only whether they cut.
double clearance(const Shape& shape, const Vector3d& x) {
  const auto* tool = std::get_if<BandShape>(&shape);
  return tool ? tool->band->rough_distance(x - tool->offset) : distance(shape, x).distance;
}

Nearest nearer(const Nearest& a, const Nearest& b) {
  return b.distance < a.distance ? b : a;
}

// A tool at its place before the stroke.
struct Placed {
  const TriangleMesh* mesh;
  Vector3d lift;  ///< of the mesh's origin [m]
  Shape shape;
};

Placed placed(const StampingSpec& spec, Role role, double base) {
  const TriangleMesh* mesh = mesh_of(spec, role);
  const double lift = base + (mesh ? lift_to_touch(*mesh, role) : 0.0);
  return {mesh, offset_of(spec, role) + Vector3d(0.0, 0.0, lift), raised(touching(spec, role), base)};
}

// Where the vertices of one tool come nearest to another while the punch goes down. `sign` is -1 where the
// vertices are the punch's, +1 where they belong to the tool it passes.
Nearest nearest_on_stroke(const Placed& of_vertices, const Placed& other, double stroke, double sign) {
  constexpr int positions = 8;
  const auto& vertices = of_vertices.mesh->vertices;
  Nearest nearest;
  for (int k = 0; k <= positions; ++k) {
    const double travel = stroke * k / positions;
    nearest = tbb::parallel_deterministic_reduce(
        tbb::blocked_range<std::size_t>(0, vertices.size(), 1024), nearest,
        [&](const tbb::blocked_range<std::size_t>& range, Nearest found) {
          for (std::size_t i = range.begin(); i != range.end(); ++i) {
            const auto& v = vertices[i];
            const Vector3d x = Vector3d(v[0], v[1], v[2] + sign * travel) + of_vertices.lift;
            const double d = clearance(other.shape, x);
            if (d < found.distance) found = {d, travel, x};
          }
          return found;
        },
        nearer);
  }
  return nearest;
}

// Punch and the tool it passes, at the heights at which they stand on the stress-free fabric.
Problems check_passage(const StampingSpec& spec, Role other, double thickness) {
  const double half = 0.5 * thickness;
  const Placed punch = placed(spec, Role::punch, half),
               passed = placed(spec, other, other == Role::die ? -half : half);
  if (!punch.mesh && !passed.mesh) return {};  // said by check(StampingSpec)
  Nearest nearest;
  if (punch.mesh) nearest = nearest_on_stroke(punch, passed, spec.process.stroke, -1.0);
  if (passed.mesh) nearest = nearer(nearest, nearest_on_stroke(passed, punch, spec.process.stroke, +1.0));
  if (nearest.distance >= half) return {};
  std::string rule = "reaches deep into the punch";  // beyond what the distance field knows
  if (std::isfinite(nearest.distance))
    rule = nearest.distance < 0.0
               ? fmt::format("cuts {:.3g} mm into the punch", -1e3 * nearest.distance)
               : fmt::format("leaves {:.3g} mm beside the punch, less than half the fabric's {:.4g} mm",
                             1e3 * nearest.distance, 1e3 * thickness);
  return {{"tools.*.passage"_family.of(name_of(other)), key_of(other), "", rule,
           fmt::format(
               "At a stroke of {:.4g} mm near ({:.4g}, {:.4g}, {:.4g}) mm: check the files' units and places "
               "in x and y, or shorten the stroke.",
               1e3 * nearest.stroke, 1e3 * nearest.at.x(), 1e3 * nearest.at.y(), 1e3 * nearest.at.z())}};
}

// A hemisphere by its number carries on as a cylinder; a drawn punch ends where its file ends.
Problems check_punch_height(const StampingSpec& spec) {
  const TriangleMesh* punch = mesh_of(spec, Role::punch);
  if (!punch) return {};
  const Heights z = heights(*punch);
  if (spec.process.stroke < z.high - z.low) return {};
  return {
      {"tools.punch.height"_rule, "tools.punch", "",
       fmt::format("is {:.4g} mm high, less than the stroke of {:.4g} mm", 1e3 * (z.high - z.low),
                   1e3 * spec.process.stroke),
       "Its upper end would sink below the fabric: shorten process.punch.stroke, or draw the punch higher "
       "and check its length unit."}};
}

Problems check_hold(const StampingSpec& spec) {
  if (!spec.binder.file || binder_face(spec).area > 0.0) return {};
  return {{"tools.binder.hold"_rule, "tools.binder", "", "has no flat lower face over the blank",
           "The binder presses by its lowest face, which must be level and reach over the blank's edge."}};
}

}  // namespace

Box reach_of_fabric(const StampingSpec& spec, Role role, const TriangleMesh& mesh) {
  const double stroke = spec.process.stroke, margin = 0.25 * stroke, lift = lift_to_touch(mesh, role);
  const Outline outline = outline_of(spec.blank);
  Box reach = everywhere;
  for (std::size_t c = 0; c < 2; ++c) {
    const auto [low, high] =
        std::minmax_element(outline.outer.begin(), outline.outer.end(),
                            [c](const Point2& a, const Point2& b) { return a[c] < b[c]; });
    const double aside = std::abs(offset_of(spec, role)[static_cast<Eigen::Index>(c)]);
    reach.low[c] = (*low)[c] - margin - aside;
    reach.high[c] = (*high)[c] + margin + aside;
  }
  // The binder stays on the blank, the die below it; the punch is down by the stroke at its end.
  if (role == Role::die)
    reach.low[2] = -stroke - margin - lift;
  else
    reach.high[2] = (role == Role::punch ? stroke : 0.0) + margin - lift;
  return reach;
}

Problems check_tools(const StampingSpec& spec, double thickness) {
  Problems problems = check_passage(spec, Role::die, thickness);
  for (const Problems& more : {check_passage(spec, Role::binder, thickness), check_punch_height(spec),
                               check_hold(spec), check_mirrored_tools(spec)})
    problems.insert(problems.end(), more.begin(), more.end());
  return problems;
}

TouchingTools touching_tools(const StampingSpec& spec) {
  return {touching(spec, Role::punch), touching(spec, Role::die), touching(spec, Role::binder)};
}

Shape raised(Shape shape, double z) {
  struct Raise {
    double z;
    void operator()(PlaneShape& s) const { s.point.z() += z; }
    void operator()(CylinderShape& s) const { s.centre.z() += z; }
    void operator()(HemisphereShape& s) const { s.apex.z() += z; }
    void operator()(RingShape& s) const { s.level += z; }
    void operator()(SectorShape& s) const { s.level += z; }
    void operator()(CurvedPlateShape& s) const { s.level += z; }
    void operator()(BandShape& s) const { s.offset.z() += z; }
  };
  std::visit(Raise{z}, shape);
  return shape;
}

BinderFace binder_face(const StampingSpec& spec) {
  const Blank blank = turned(make_blank(outline_of(spec.blank), spec.blank.spacing, spec.blank.orientation),
                             spec.blank.turned);
  const Shape binder = touching(spec, Role::binder);
  const auto* ring = std::get_if<RingShape>(&binder);
  const double below = 1e-3;
  double area = 0.0, second_moment = 0.0;
  for (int i = 0; i < blank.nodes(); ++i) {
    const Vector3d& x = blank.reference[i];
    const bool under =
        ring ? x.head<2>().norm() >= ring->opening_radius + ring->fillet
             : std::abs(distance(binder, {x.x(), x.y(), -below}).distance - below) < flat_tolerance;
    if (!under) continue;
    area += blank.node_area[i];
    second_moment += 0.5 * blank.node_area[i] * x.head<2>().squaredNorm();
  }
  return {area, area > 0.0 ? std::sqrt(second_moment / area) : 0.0};
}

}  // namespace heddle::macroscale
