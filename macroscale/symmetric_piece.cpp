#include "macroscale/symmetric_piece.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <numbers>
#include <string>

#include <fmt/format.h>

#include "macroscale/outline_cut.h"
#include "macroscale/tool_set.h"

namespace heddle::macroscale {

namespace {

using Eigen::Vector3d;

// Points of a drawn outline this near to their image's border are mirror images: rounding of decimal numbers.
constexpr double outline_tolerance = 1e-6;  // [m]
// What triangles of two alike halves differ by, and a distance field of millimetre voxels on top.
constexpr double surface_tolerance = 0.25e-3;  // [m]

constexpr std::array<const char*, 2> plane_names = {"x = 0", "y = 0"};

Point2 image_of(Point2 p, std::size_t axis) {
  p[axis] = -p[axis];
  return p;
}

double distance_to(const Ring& ring, const Point2& p) {
  Outline shifted{ring, {}};
  for (Point2& q : shifted.outer) q = {q[0] - p[0], q[1] - p[1]};
  return std::abs(reach(shifted));
}

// The point of the outline that lies furthest from the border of its mirror image.
struct Furthest {
  double distance = 0.0;  ///< [m]
  Point2 at{};
};

Furthest off_image(const Outline& outline, std::size_t axis) {
  std::vector<Ring> rings = outline.holes;
  rings.push_back(outline.outer);
  Furthest worst;
  for (const Ring& ring : rings)
    for (const Point2& p : ring) {
      double nearest = 1e300;
      for (const Ring& other : rings) nearest = std::min(nearest, distance_to(other, image_of(p, axis)));
      if (nearest > worst.distance) worst = {nearest, p};
    }
  return worst;
}

class Findings {
 public:
  void refuse_if(bool wrong, RuleId id, const std::string& key, std::string rule, std::string way_out) {
    if (wrong)
      problems_.push_back(
          {std::move(id), key, "", std::move(rule), std::move(way_out), "", 0, {"blank.symmetry"}});
  }
  Problems take() { return std::move(problems_); }

 private:
  Problems problems_;
};

}  // namespace

bool runs_along_axes(double orientation) {
  return std::abs(std::sin(2.0 * orientation)) < 1e-9;
}

std::vector<char> held_by_planes(const Blank& blank) {
  if (blank.symmetry == Symmetry::none) return {};
  std::vector<char> held(3 * blank.reference.size(), 0);
  for (int i = 0; i < blank.nodes(); ++i)
    for (std::size_t axis = 0; axis < 2; ++axis) held[3 * i + axis] = on_plane(blank, i, axis);
  return held;
}

void take_share(std::vector<Tool>& tools, Symmetry symmetry) {
  const double all = images(symmetry);
  for (Tool& tool : tools)
    for (double* whole : {&tool.force, &tool.mass, &tool.weight, &tool.stiffness, &tool.yield}) *whole /= all;
}

Problems check_symmetry(const StampingSpec& spec) {
  const BlankSpec& blank = spec.blank;
  if (blank.symmetry == Symmetry::none) return {};
  const PressSpec& press = spec.process.press;
  const std::string whole = "Or leave blank.symmetry out: then the whole blank is computed.";
  Findings f;
  f.refuse_if(!runs_along_axes(blank.orientation), "blank.symmetry.orientation"_rule, "blank.orientation",
              fmt::format("is {:g} deg: on a plane of symmetry tows must run along it or straight across",
                          blank.orientation * 180.0 / std::numbers::pi),
              "0 or 90 deg. " + whole);
  f.refuse_if(blank.turned != 0.0, "blank.symmetry.turned"_rule, "effects.initial_orientation.angle",
              "must be 0 in a part of which a piece is computed: a blank laid down askew has no plane of it",
              whole);
  f.refuse_if(blank.plies > 1, "blank.symmetry.plies"_rule, "blank.plies",
              "must be 1 in a part of which a piece is computed: contact of plies does not know the planes",
              "One ply. " + whole);
  f.refuse_if(spec.binder.sectors > 1, "blank.symmetry.sectors"_rule, "tools.binder.sectors",
              "must be 1 in a part of which a piece is computed: the planes would cut sectors",
              "One binder. " + whole);
  f.refuse_if(press.binder_tilt != 0.0, "blank.symmetry.tilt"_rule, "effects.binder_tilt.angle",
              "must be 0 in a part of which a piece is computed", whole);
  for (std::size_t axis = 0; axis < 2; ++axis) {
    if (!mirrored_across(blank.symmetry, axis)) continue;
    f.refuse_if(std::abs(press.punch_offset[axis]) > 1e-12, "blank.symmetry.offset"_rule,
                "effects.punch_misalignment.offset",
                fmt::format("must leave the punch on the plane of symmetry {}", plane_names[axis]), whole);
    const Furthest worst = off_image(outline_of(blank), axis);
    f.refuse_if(worst.distance > outline_tolerance, "blank.symmetry.outline"_rule, "blank.symmetry",
                fmt::format("needs a blank that is its own mirror image in {}; its point ({:.6g}, {:.6g}) mm "
                            "lies {:.3g} mm off the image",
                            plane_names[axis], 1e3 * worst.at[0], 1e3 * worst.at[1], 1e3 * worst.distance),
                "Correct the outline or the holes. " + whole);
  }
  return f.take();
}

Problems check_mirrored_tools(const StampingSpec& spec) {
  Problems problems;
  const TouchingTools tools = touching_tools(spec);
  const std::array<std::pair<Role, const Shape*>, 3> all = {
      {{Role::punch, &tools.punch}, {Role::die, &tools.die}, {Role::binder, &tools.binder}}};
  for (const auto& [role, shape] : all) {
    const auto& file = role == Role::punch ? spec.punch.file
                       : role == Role::die ? spec.die.file
                                           : spec.binder.file;
    if (!file) continue;
    const TriangleMesh& mesh = file->loaded->tool.mesh;
    const Box room = reach_of_fabric(spec, role, mesh);
    const auto& band = std::get<BandShape>(*shape);
    for (std::size_t axis = 0; axis < 2; ++axis) {
      if (!mirrored_across(spec.blank.symmetry, axis)) continue;
      double worst = 0.0;
      Vector3d at = Vector3d::Zero();
      for (const auto& v : mesh.vertices) {
        bool reached = true;
        for (std::size_t c = 0; c < 3; ++c) reached &= v[c] >= room.low[c] && v[c] <= room.high[c];
        if (!reached) continue;
        Vector3d x(v[0], v[1], v[2]);
        x[static_cast<Eigen::Index>(axis)] *= -1.0;
        const double off = std::abs(band.band->rough_distance(x));
        if (off > worst) {
          worst = off;
          at = Vector3d(v[0], v[1], v[2]);
        }
      }
      if (worst <= surface_tolerance) continue;
      const std::string off = std::isfinite(worst) ? fmt::format("{:.3g} mm", 1e3 * worst) : "far";
      problems.push_back(
          {"tools.*.mirrored"_family.of(name_of(role)),
           "tools." + name_of(role),
           "",
           fmt::format("must be its own mirror image in {}; its point ({:.4g}, {:.4g}, {:.4g}) "
                       "mm lies {} off the image",
                       plane_names[axis], 1e3 * at.x(), 1e3 * at.y(), 1e3 * at.z(), off),
           "Draw it about the axes of the press, or leave blank.symmetry out.",
           "",
           0,
           {"blank.symmetry"}});
    }
  }
  return problems;
}

}  // namespace heddle::macroscale
