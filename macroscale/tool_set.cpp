#include "macroscale/tool_set.h"

#include <algorithm>
#include <functional>
#include <limits>
#include <numbers>

#include <fmt/format.h>
#include <tbb/blocked_range.h>
#include <tbb/parallel_reduce.h>

#include "macroscale/blank.h"
#include "macroscale/mesh_distance.h"
#include "macroscale/tool_band.h"

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

Shape shape_of_numbers(const StampingSpec& spec, Role role) {
  switch (role) {
    case Role::punch:
      return HemisphereShape{Vector3d::Zero(), spec.punch.radius};
    case Role::die:
      return RingShape{0.0, spec.die.opening_radius, spec.die.fillet, true};
    case Role::binder:
      return RingShape{0.0, spec.binder.inner_radius, spec.binder.edge_fillet, false};
  }
  return {};
}

const std::optional<ToolFileSpec>& file_of(const StampingSpec& spec, Role role) {
  return role == Role::punch ? spec.punch.file : role == Role::die ? spec.die.file : spec.binder.file;
}
std::optional<ToolFileSpec>& file_of(StampingSpec& spec, Role role) {
  return role == Role::punch ? spec.punch.file : role == Role::die ? spec.die.file : spec.binder.file;
}

std::string name_of(Role role) {
  return role == Role::punch ? "punch" : role == Role::die ? "die" : "binder";
}
std::string key_of(Role role) {
  return "tools." + name_of(role);
}

constexpr std::array<Role, 3> roles = {Role::punch, Role::die, Role::binder};

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

// A tool that touches z = 0 as something to measure against: exactly, without a band.
class Solid {
 public:
  Solid(const StampingSpec& spec, Role role) : shape_(shape_of_numbers(spec, role)) {
    const auto& file = file_of(spec, role);
    if (!file) return;
    mesh_ = &file->loaded->mesh;
    lift_ = lift_to_touch(*mesh_, role);
  }

  const TriangleMesh* mesh() const { return mesh_; }
  double lift() const { return lift_; }

  void prepare() {
    if (mesh_ && !measure_) measure_ = std::make_unique<MeshDistance>(*mesh_);
  }
  double distance_to(const Vector3d& x) const {
    if (measure_) return measure_->signed_distance({x.x(), x.y(), x.z() - lift_});
    return distance(shape_, x).distance;
  }

 private:
  Shape shape_;
  const TriangleMesh* mesh_ = nullptr;
  double lift_ = 0.0;
  std::unique_ptr<MeshDistance> measure_;
};

struct Nearest {
  double distance = std::numeric_limits<double>::infinity();  ///< [m]
  double stroke = 0.0;                                        ///< of the punch [m]
  Vector3d at = Vector3d::Zero();                             ///< in the frame of the press [m]
};

Nearest nearer(const Nearest& a, const Nearest& b) {
  return b.distance < a.distance ? b : a;
}

// Where the vertices of one tool come nearest to another while the punch goes down. `sign` is -1 where the
// vertices are the punch's, +1 where they belong to the tool it passes.
Nearest nearest_on_stroke(const Solid& of_vertices, double base_of_vertices, const Solid& other,
                          double base_of_other, double stroke, double sign) {
  constexpr int positions = 8;
  const auto& vertices = of_vertices.mesh()->vertices;
  Nearest nearest;
  for (int k = 0; k <= positions; ++k) {
    const double travel = stroke * k / positions;
    const double shift = of_vertices.lift() + base_of_vertices - base_of_other + sign * travel;
    nearest = tbb::parallel_deterministic_reduce(
        tbb::blocked_range<std::size_t>(0, vertices.size(), 1024), nearest,
        [&](const tbb::blocked_range<std::size_t>& range, Nearest found) {
          for (std::size_t i = range.begin(); i != range.end(); ++i) {
            const Vector3d x(vertices[i][0], vertices[i][1], vertices[i][2] + shift);
            const double d = other.distance_to(x);
            if (d < found.distance) found = {d, travel, x + Vector3d(0.0, 0.0, base_of_other)};
          }
          return found;
        },
        nearer);
  }
  return nearest;
}

// Punch and the tool it passes, at the heights at which they stand on the stress-free fabric.
Problems check_passage(const StampingSpec& spec, Role other, double thickness) {
  Solid punch(spec, Role::punch), passed(spec, other);
  if (!punch.mesh() && !passed.mesh()) return {};  // said by check(StampingSpec)
  const double half = 0.5 * thickness, base = other == Role::die ? -half : half;
  Nearest nearest;
  if (punch.mesh()) {
    passed.prepare();
    nearest = nearest_on_stroke(punch, half, passed, base, spec.process.stroke, -1.0);
  }
  if (passed.mesh()) {
    punch.prepare();
    nearest = nearer(nearest, nearest_on_stroke(passed, base, punch, half, spec.process.stroke, +1.0));
  }
  if (nearest.distance >= half) return {};
  return {{fmt::format("tools.{}.passage", name_of(other)), key_of(other), "",
           nearest.distance < 0.0
               ? fmt::format("cuts {:.3g} mm into the punch", -1e3 * nearest.distance)
               : fmt::format("leaves {:.3g} mm beside the punch, less than half the fabric's {:.4g} mm",
                             1e3 * nearest.distance, 1e3 * thickness),
           fmt::format(
               "At a stroke of {:.4g} mm near ({:.4g}, {:.4g}, {:.4g}) mm: check the files' units and places "
               "in x and y, or shorten the stroke.",
               1e3 * nearest.stroke, 1e3 * nearest.at.x(), 1e3 * nearest.at.y(), 1e3 * nearest.at.z())}};
}

Problems check_hold(const StampingSpec& spec) {
  if (!spec.binder.file || binder_area(spec) > 0.0) return {};
  return {{"tools.binder.hold", "tools.binder", "", "has no flat lower face over the blank",
           "The binder presses by its lowest face, which must be level and reach over the blank's edge."}};
}

}  // namespace

StampingSpec with_tools_loaded(StampingSpec spec) {
  Problems problems;
  for (const Role role : roles) {
    auto& file = file_of(spec, role);
    if (!file || file->loaded) continue;
    const Expectation expected{key_of(role), extent(outline_of(spec.blank)), spec.process.stroke};
    try {
      file->loaded = std::make_shared<const LoadedTool>(load_tool(file->source, expected));
    } catch (const InputError& error) {
      problems.insert(problems.end(), error.problems().begin(), error.problems().end());
    }
  }
  if (!problems.empty()) throw InputError(std::move(problems));
  return spec;
}

Problems check_tools(const StampingSpec& spec, double thickness) {
  Problems problems = check_passage(spec, Role::die, thickness);
  for (const Problems& more : {check_passage(spec, Role::binder, thickness), check_hold(spec)})
    problems.insert(problems.end(), more.begin(), more.end());
  return problems;
}

TouchingTools touching_tools(const StampingSpec& spec, double thickness, double largest_increment) {
  TouchingTools tools;
  const auto make = [&](Role role) -> Shape {
    const auto& file = file_of(spec, role);
    if (!file) return shape_of_numbers(spec, role);
    const LoadedTool& loaded = *file->loaded;
    const ToolBandSpec band{.voxel = file->voxel,
                            .half_width = required_half_width(tool_step(spec), thickness, largest_increment)};
    tools.notes.push_back(fmt::format("{}: {} triangles from {}{}{}", name_of(role),
                                      loaded.mesh.triangles.size(), file->source.file.filename().string(),
                                      loaded.repairs.empty() ? "" : "; ", loaded.repairs));
    return BandShape{std::make_shared<const ToolBand>(tool_band(loaded.mesh, band, key_of(role))),
                     Vector3d(0.0, 0.0, lift_to_touch(loaded.mesh, role))};
  };
  tools.punch = make(Role::punch);
  tools.die = make(Role::die);
  tools.binder = make(Role::binder);
  return tools;
}

Shape raised(Shape shape, double z) {
  struct Raise {
    double z;
    void operator()(PlaneShape& s) const { s.point.z() += z; }
    void operator()(CylinderShape& s) const { s.centre.z() += z; }
    void operator()(HemisphereShape& s) const { s.apex.z() += z; }
    void operator()(RingShape& s) const { s.level += z; }
    void operator()(BandShape& s) const { s.offset.z() += z; }
  };
  std::visit(Raise{z}, shape);
  return shape;
}

double binder_area(const StampingSpec& spec) {
  const Blank blank = make_blank(outline_of(spec.blank), spec.blank.spacing, spec.blank.orientation);
  Solid binder(spec, Role::binder);
  binder.prepare();
  const double ring = spec.binder.inner_radius + spec.binder.edge_fillet, below = 1e-3;
  double area = 0.0;
  for (int i = 0; i < blank.nodes(); ++i) {
    const Vector3d& x = blank.reference[i];
    const bool under = binder.mesh()
                           ? std::abs(binder.distance_to({x.x(), x.y(), -below}) - below) < flat_tolerance
                           : x.head<2>().norm() >= ring;
    if (under) area += blank.node_area[i];
  }
  return area;
}

}  // namespace heddle::macroscale
