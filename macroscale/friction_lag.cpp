#include "macroscale/friction_lag.h"

#include <algorithm>
#include <cmath>
#include <functional>

#include <tbb/blocked_range.h>
#include <tbb/parallel_for.h>
#include <tbb/parallel_reduce.h>
#include <Eigen/Geometry>

#include "friction/hersey.h"

namespace heddle::macroscale {

namespace {

using Eigen::Vector3d;
using Eigen::VectorXd;

friction::Context context_of(const Scene& scene, double fabric_temperature, double pressure,
                             double shear_angle) {
  friction::Context context;
  context.pressure = pressure;
  context.fabric_temperature = fabric_temperature;
  context.tool_temperature = scene.tool_temperature;
  context.shear_angle = shear_angle;
  if (scene.contact_pressure == ContactPressure::real) {
    const auto floored = friction::floored(pressure);
    const auto area = scene.fabric->contact.evaluate(floored.value, shear_angle);
    context.area_fraction = area.fraction;
    context.area_slope = area.slope * floored.slope;
  }
  return context;
}

// Of the film between fabric and tool; two plies have no such film.
void set_drag_direction(const Scene& scene, friction::Context& context) {
  const auto drag = scene.fabric->contact.drag.evaluate(context.pressure, context.shear_angle);
  context.drag_cosine = drag.cosine;
  context.drag_sine = drag.sine;
}

// Slip direction against the warp in the tangent plane of the contact, growing towards the weft whichever
// face of the sheet the tool touches [rad]; 0 at rest.
double slip_angle(const TowDirections& tows, const Vector3d& normal, const Vector3d& v) {
  const Vector3d warp = tows.warp - normal.dot(tows.warp) * normal, slip = v - normal.dot(v) * normal;
  const double side = normal.dot(tows.warp.cross(tows.weft)) < 0.0 ? -1.0 : 1.0;
  return std::atan2(side * normal.dot(warp.cross(slip)), warp.dot(slip));
}

// Between plies there is no tool: both sides are as warm as the fabric. The direction of slip is against the
// warp of the ply that looks, and so is the shear of the area that touches.
void freeze_plies(const System& system, const StepData& step, const VectorXd& x,
                  std::vector<FrictionPoint>& points) {
  const Scene& scene = system.scene();
  const int row = static_cast<int>(scene.tools.size());
  if (!system.rubs(step, row)) return;
  tbb::parallel_for(std::size_t{0}, points.size(), [&](std::size_t i) {
    FrictionPoint& point = points[i];
    point.memory = system.memory_in_row(step, row, static_cast<int>(i));
    const PlyPair& pair = step.pairs[i];
    const NormalContact contact = system.contact_of_plies(pair, x);
    if (contact.pressure <= 0.0) return;
    point.load = contact.pressure * pair.area;
    point.normal = pair.normal;
    const int quad = system.ply_points()[i].quad;
    const auto corners = corners_of(scene.blank.quads[quad]);
    double shear = 0.0;
    for (std::size_t c = 0; c < 4; ++c)
      shear += 0.25 * corners[c].sign * step.start->corner_angle[4 * static_cast<std::size_t>(quad) + c];
    const double temperature = scene.blank_temperature_at(step.start->time);
    point.context = context_of(scene, temperature, contact.pressure, shear);
    point.context.tool_temperature = temperature;
    point.context.time_step = step.dt;
    point.context.slip_angle =
        slip_angle(tow_directions(scene.blank, system.ply_points()[i], x), point.normal,
                   system.velocity_in_row(step, x, row, static_cast<int>(i)));
  });
}

}  // namespace

FrictionPoints freeze(const System& system, const StepData& step, const VectorXd& x,
                      const std::vector<double>& shear_angle) {
  const Scene& scene = system.scene();
  const int count = system.contacts();
  FrictionPoints points(scene.tools.size(), std::vector<FrictionPoint>(count));
  if (!step.pairs.empty()) points.emplace_back(step.pairs.size());
  if (step.frictionless || !scene.friction) return points;
  for (int k = 0; k < static_cast<int>(scene.tools.size()); ++k)
    tbb::parallel_for(0, count, [&, k](int i) {
      const auto [d, contact] = system.tool_contact(step, x, k, i);
      FrictionPoint& point = points[k][i];
      point.memory = step.start->memory[k][i];
      if (contact.pressure <= 0.0) return;
      point.load = contact.pressure * system.contact_area(step, i);
      // A distance interpolated from samples has a gradient of length about 1: slip needs a true projection.
      point.normal = d.normal.normalized();
      point.context = context_of(scene, fabric_temperature(scene, *step.start, k, system.contact_points()[i]),
                                 contact.pressure, shear_angle[i]);
      set_drag_direction(scene, point.context);
      point.context.tool_temperature = tool_temperature(scene, k);
      point.context.interface_temperature =
          face_temperature(scene, *step.start, k, system.contact_points()[i]);
      point.context.time_step = step.dt;
      point.context.slip_angle = slip_angle(tow_directions(scene.blank, scene.contact_sites, x, i),
                                            point.normal, system.relative_velocity(step, x, k, i));
    });
  if (!step.pairs.empty()) freeze_plies(system, step, x, points.back());
  return points;
}

std::vector<double> nodal_pressure(const System& system, const StepData& step, int k) {
  const Scene& scene = system.scene();
  std::vector<double> pressure(scene.blank.nodes(), 0.0), area(scene.blank.nodes(), 0.0);
  for (int i = 0; i < system.contacts(); ++i) {
    if (scene.contact_sites == ContactSites::nodes) {
      pressure[i] = step.friction[k][i].context.pressure;
      continue;
    }
    const ContactPoint& point = system.contact_points()[i];
    for (std::size_t a = 0; a < 4; ++a) {
      pressure[point.node[a]] += point.weight[a] * step.friction[k][i].load;
      area[point.node[a]] += point.weight[a] * system.contact_area(step, i);
    }
  }
  for (std::size_t n = 0; n < area.size(); ++n)
    if (area[n] > 0.0) pressure[n] /= area[n];
  return pressure;
}

LagChange lag_change(const System& system, const StepData& step, const VectorXd& x,
                     const FrictionPoints& before, const FrictionPoints& after) {
  struct Sums {
    double change = 0.0, size = 0.0, largest = 0.0;
    Sums operator+(const Sums& b) const {
      return {change + b.change, size + b.size, std::max(largest, b.largest)};
    }
  };
  const auto of_point = [&](int k, int i) {
    const FrictionPoint &old = before[k][i], &now = after[k][i];
    if (old.load == 0.0 && now.load == 0.0) return Sums{};
    const FrictionSettings settings = system.friction_settings(k);
    const Vector3d v = system.velocity_in_row(step, x, k, i);
    const auto force = [&](const FrictionPoint& p) -> Vector3d {
      return p.load > 0.0 ? friction_force(settings, p, v) : Vector3d::Zero();
    };
    const Vector3d reached = force(now);
    const double moved = (reached - force(old)).norm();
    return Sums{moved, reached.norm(), moved};
  };
  Sums all;
  for (int k = 0; k < static_cast<int>(after.size()); ++k)
    all = all + tbb::parallel_deterministic_reduce(
                    tbb::blocked_range<int>(0, static_cast<int>(after[k].size()), 512), Sums{},
                    [&](const tbb::blocked_range<int>& range, Sums sum) {
                      for (int i = range.begin(); i != range.end(); ++i) sum = sum + of_point(k, i);
                      return sum;
                    },
                    std::plus<>());
  const double relative = all.size > 0.0 ? all.change / all.size : (all.change > 0.0 ? 1.0 : 0.0);
  return {relative, all.largest};
}

FrictionPoints blend(const System& system, const StepData& step, const FrictionPoints& before,
                     FrictionPoints after, double share, const std::vector<double>& shear_angle) {
  const Scene& scene = system.scene();
  for (std::size_t k = 0; k < after.size(); ++k)
    tbb::parallel_for(0, static_cast<int>(after[k].size()), [&, k](int i) {
      const FrictionPoint& old = before[k][i];
      FrictionPoint& point = after[k][i];
      const double kept = (1.0 - share) * old.load, added = share * point.load;
      if (kept + added == 0.0) return;
      const Vector3d normal = (kept * old.normal + added * point.normal).normalized();
      if (point.load == 0.0) point = old;
      point.load = kept + added;
      point.normal = normal;
      const friction::Context last = point.context;
      const double angle = k < scene.tools.size() ? shear_angle[i] : last.shear_angle;
      point.context = context_of(scene, last.fabric_temperature,
                                 point.load / system.area_in_row(step, static_cast<int>(k), i), angle);
      if (k < scene.tools.size()) set_drag_direction(scene, point.context);
      point.context.tool_temperature = last.tool_temperature;
      point.context.interface_temperature = last.interface_temperature;
      point.context.time_step = last.time_step;
      point.context.slip_angle = last.slip_angle;
    });
  return after;
}

}  // namespace heddle::macroscale
