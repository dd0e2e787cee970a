#include "macroscale/thermal/blank_heat.h"

#include <algorithm>
#include <cmath>
#include <limits>

#include <tbb/parallel_for.h>

#include "friction/rheology/rheology.h"
#include "macroscale/contact_points.h"
#include "macroscale/quality.h"
#include "macroscale/system.h"

namespace heddle::macroscale {

namespace {

using thermal::bottom;
using thermal::Side;
using thermal::top;

// The die lies below the blank, punch and binder above it.
Side side_of(Role role) {
  return role == Role::die ? bottom : top;
}

std::span<const double> film_of(const thermal::Column& column, std::span<const double> of_cells, Side side) {
  const auto count = static_cast<std::size_t>(column.film_cells);
  return side == bottom ? of_cells.first(count) : of_cells.last(count);
}

// Over the ply between the films: the fabric is sheared as one through its thickness, so its layers resist
// side by side.
template <class Law>
double mean_over_ply(const thermal::Column& column, std::span<const double> temperature, const Law& law,
                     double reference) {
  const auto films = static_cast<std::size_t>(column.film_cells);
  double sum = 0.0, width = 0.0;
  for (std::size_t i = films; i + films < column.cells(); ++i) {
    sum += column.grid.width[i] * law(temperature[i]);
    width += column.grid.width[i];
  }
  return sum / (width * reference);
}

std::vector<double> means_of_quads(const Blank& blank, const std::vector<double>& of_nodes) {
  std::vector<double> means(blank.quads.size());
  for (std::size_t q = 0; q < means.size(); ++q) {
    double sum = 0.0;
    for (const int node : blank.quads[q]) sum += of_nodes[static_cast<std::size_t>(node)];
    means[q] = 0.25 * sum;
  }
  return means;
}

// What the mechanics take from the field.
void derive(const Scene& scene, BlankHeat& heat) {
  const thermal::Column& column = scene.heat->column;
  const int nodes = scene.blank.nodes();
  heat.film.resize(static_cast<std::size_t>(nodes));
  std::vector<double> factor(static_cast<std::size_t>(nodes), 1.0);
  const ShearSoftening& softening = scene.effects.softening;
  std::vector<double> soft(softening.on() ? static_cast<std::size_t>(nodes) : 0);
  const mesoscale::ShearRate& resin = scene.fabric->shear_rate;
  const auto widths = std::span<const double>(column.grid.width);
  const bool rate = scene.shear_rate > 0.0 && resin.consistency > 0.0;
  const friction::Model standard;
  const friction::Model& model = scene.friction ? *scene.friction : standard;
  tbb::parallel_for(0, nodes, [&](int i) {
    const auto at = heat.field.temperature_of(static_cast<std::size_t>(i));
    for (const Side side : {bottom, top})
      heat.film[static_cast<std::size_t>(i)][side] = friction::temperature_as_thin_as(
          model.rheology.temperature, model.film, film_of(column, at, side), film_of(column, widths, side));
    if (rate)
      factor[static_cast<std::size_t>(i)] = mean_over_ply(
          column, at, [&](double t) { return resin.consistency_at(t); },
          resin.consistency_at(scene.blank_temperature));
    if (softening.on())
      soft[static_cast<std::size_t>(i)] = mean_over_ply(
          column, at, [&](double t) { return softening.factor_at(t); }, 1.0);
  });
  heat.rate_factor = means_of_quads(scene.blank, factor);
  if (softening.on()) heat.shear_factor = means_of_quads(scene.blank, soft);
}

// A face takes what all tools that touch it take; air where none does.
std::array<thermal::Face, 2> faces_at(const System& system, const State& state, int node) {
  const Scene& scene = system.scene();
  const thermal::ThermalSpec& spec = scene.heat->spec;
  std::array<thermal::Face, 2> faces{thermal::air_face(spec.air), thermal::air_face(spec.air)};
  std::array<double, 2> conductance{}, flow{};
  for (int k = 0; k < static_cast<int>(scene.tools.size()); ++k) {
    const NormalContact contact = system.contact_at(state.node(node), k, system.pose(state, k)).normal;
    if (contact.pressure <= 0.0) continue;
    const Side side = side_of(scene.tools[k].role);
    const double h = spec.contact.at(contact.pressure).value;
    conductance[side] += h;
    flow[side] += h * tool_temperature(scene, k);
  }
  for (const Side side : {bottom, top})
    if (conductance[side] > 0.0)
      faces[side] = {conductance[side], flow[side] / conductance[side], 0.0, 0.0, 0.0};
  return faces;
}

// Work that friction on tool k did on each node over a step [J/m^2].
std::vector<double> friction_work(const System& system, const State& start, const State& end, std::size_t k) {
  const Blank& blank = system.scene().blank;
  std::vector<double> work(static_cast<std::size_t>(blank.nodes()), 0.0);
  for (int i = 0; i < system.contacts(); ++i) {
    const ContactPoint& point = system.contact_points()[static_cast<std::size_t>(i)];
    const auto n = static_cast<std::size_t>(i);
    const double of_point = end.memory[k][n].work_per_area - start.memory[k][n].work_per_area;
    if (system.scene().contact_sites == ContactSites::nodes) {
      work[n] = of_point;
      continue;
    }
    for (std::size_t a = 0; a < static_cast<std::size_t>(point.nodes); ++a) {
      const auto node = static_cast<std::size_t>(point.node[a]);
      work[node] += point.weight[a] * point.area * of_point / blank.node_area[node];
    }
  }
  return work;
}

void advance_heat(const System& system, const State& start, double dt, State& end) {
  const Scene& scene = system.scene();
  const int nodes = scene.blank.nodes();
  const std::vector<double> angle = nodal_shear_angle(scene.blank, end.corner_angle);
  const auto strain = nodal_tow_strain(scene.blank, end);
  std::vector<thermal::NodeFaces> at(static_cast<std::size_t>(nodes));
  tbb::parallel_for(0, nodes, [&](int i) {
    const auto n = static_cast<std::size_t>(i);
    at[n].faces = faces_at(system, end, i);
    at[n].area_ratio = (1.0 + strain[n][0]) * (1.0 + strain[n][1]) * std::cos(angle[n]);
  });
  if (scene.heat->spec.friction_heat)
    for (std::size_t k = 0; k < scene.tools.size(); ++k) {
      const std::vector<double> work = friction_work(system, start, end, k);
      for (std::size_t n = 0; n < at.size(); ++n)
        at[n].faces[side_of(scene.tools[k].role)].heating += work[n] / dt;
    }
  thermal::advance(scene.heat->column, at, dt, end.heat.field);
  derive(scene, end.heat);
}

}  // namespace

HeatModel heat_model(const thermal::ThermalSpec& spec, double areal_density, double blank_temperature) {
  HeatModel model{spec, thermal::make_column(spec, areal_density), {}};
  model.start = thermal::column_after_transfer(spec, model.column, blank_temperature);
  return model;
}

BlankHeat initial_heat(const Scene& scene) {
  BlankHeat heat;
  if (!scene.heat) return heat;
  heat.field = thermal::repeated(scene.heat->start, static_cast<std::size_t>(scene.blank.nodes()));
  derive(scene, heat);
  return heat;
}

HeatFields heat_fields(const Scene& scene, const BlankHeat& heat) {
  HeatFields fields;
  for (std::size_t i = 0; i < heat.field.nodes(); ++i) {
    fields.bottom.push_back(heat.field.face[i][bottom]);
    fields.top.push_back(heat.field.face[i][top]);
    fields.mean.push_back(thermal::mean_temperature(scene.heat->column, heat.field.temperature_of(i)));
    fields.crystallised.push_back(thermal::mean_degree(scene.heat->column, heat.field.progress_of(i)));
  }
  return fields;
}

HeatRow heat_row(const Scene& scene, const BlankHeat& heat, double time) {
  const thermal::Column& column = scene.heat->column;
  const double freezing = scene.heat->spec.freezing_temperature;
  const thermal::Field& start = scene.heat->start;
  const double content_at_start =
      thermal::heat_content(column, start.temperature_of(0), start.progress_of(0));
  HeatRow row;
  row.time = time;
  row.coldest_face = std::numeric_limits<double>::infinity();
  double area = 0.0, change = 0.0;
  for (std::size_t i = 0; i < heat.field.nodes(); ++i) {
    const double a = scene.blank.node_area[i];
    const auto temperature = heat.field.temperature_of(i);
    const auto progress = heat.field.progress_of(i);
    const auto& face = heat.field.face[i];
    area += a;
    row.mean_temperature += a * thermal::mean_temperature(column, temperature);
    row.crystallised += a * thermal::mean_degree(column, progress);
    row.coldest_face = std::min({row.coldest_face, face[bottom], face[top]});
    row.through_bottom += a * heat.field.heat_in[i][0];
    row.through_top += a * heat.field.heat_in[i][1];
    row.of_friction += a * heat.field.heat_in[i][2];
    change += a * (thermal::heat_content(column, temperature, progress) - content_at_start);
    if (std::min(face[bottom], face[top]) < freezing) row.frozen_faces += a;
    const double hottest =
        std::max({*std::max_element(temperature.begin(), temperature.end()), face[bottom], face[top]});
    if (hottest < freezing) row.frozen_through += a;
  }
  for (double* mean : {&row.mean_temperature, &row.crystallised, &row.frozen_faces, &row.frozen_through})
    *mean /= area;
  const double all = images(scene.blank.symmetry);
  for (double* sum : {&row.through_bottom, &row.through_top, &row.of_friction, &change}) *sum *= all;
  row.residual = change - row.through_bottom - row.through_top - row.of_friction;
  return row;
}

double tool_temperature(const Scene& scene, int tool) {
  if (!scene.heat) return scene.tool_temperature;
  const thermal::ThermalSpec& spec = scene.heat->spec;
  const Role role = scene.tools[static_cast<std::size_t>(tool)].role;
  const std::optional<double>& own = role == Role::punch ? spec.punch_temperature
                                     : role == Role::die ? spec.die_temperature
                                                         : spec.binder_temperature;
  return own.value_or(scene.tool_temperature);
}

namespace {

// Of a contact point on the side that a tool touches, from numbers at the nodes, bottom and top.
double at_side(const Scene& scene, int tool, const ContactPoint& point,
               const std::vector<std::array<double, 2>>& of_nodes) {
  const Side side = side_of(scene.tools[static_cast<std::size_t>(tool)].role);
  double mean = 0.0;
  for (std::size_t a = 0; a < static_cast<std::size_t>(point.nodes); ++a)
    mean += point.weight[a] * of_nodes[static_cast<std::size_t>(point.node[a])][side];
  return mean;
}

}  // namespace

double fabric_temperature(const Scene& scene, const State& state, int tool, const ContactPoint& point) {
  if (state.heat.empty()) return scene.blank_temperature_at(state.time);
  return at_side(scene, tool, point, state.heat.film);
}

double face_temperature(const Scene& scene, const State& state, int tool, const ContactPoint& point) {
  if (state.heat.empty()) return 0.0;
  return at_side(scene, tool, point, state.heat.field.face);
}

void advance_heat(const System& system, const State& start, State& end) {
  if (!system.scene().heat) return;
  advance_heat(system, start, end.time - start.time, end);
}

void hold_heat(const System& system, double time, State& state) {
  const State start = state;
  advance_heat(system, start, time, state);
}

}  // namespace heddle::macroscale
