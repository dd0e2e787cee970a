#include "macroscale/thermal/field.h"

#include <cmath>
#include <stdexcept>

#include <fmt/format.h>
#include <tbb/blocked_range.h>
#include <tbb/parallel_for.h>

namespace heddle::macroscale::thermal {

namespace {

// Of a field with one node.
void stand_in_air(const ThermalSpec& spec, const Column& column, Field& one) {
  constexpr double longest = 0.05;  // [s]: the film's own time
  const int steps = static_cast<int>(std::ceil(spec.transfer_time / longest));
  const NodeFaces air{{air_face(spec.air), air_face(spec.air)}, 1.0};
  for (int k = 0; k < steps; ++k) advance(column, {&air, 1}, spec.transfer_time / steps, one);
  one.heat_in[0] = {};
}

}  // namespace

Field column_after_transfer(const ThermalSpec& spec, const Column& column, double temperature) {
  Field one{column.cells(),
            std::vector<double>(column.cells(), temperature),
            std::vector<double>(column.cells(), 0.0),
            {{temperature, temperature}},
            {{}}};
  if (spec.transfer_time > 0.0) stand_in_air(spec, column, one);
  return one;
}

Field repeated(const Field& one, std::size_t nodes) {
  Field field{one.cells, {}, {}, {}, {}};
  for (std::size_t i = 0; i < nodes; ++i) {
    field.temperature.insert(field.temperature.end(), one.temperature.begin(), one.temperature.end());
    field.progress.insert(field.progress.end(), one.progress.begin(), one.progress.end());
  }
  field.face.assign(nodes, one.face[0]);
  field.heat_in.assign(nodes, one.heat_in[0]);
  return field;
}

void advance(const Column& column, std::span<const NodeFaces> at, double time_step, Field& field) {
  if (at.size() != field.nodes() || field.cells != column.cells())
    throw std::invalid_argument("thermal field: faces, column and field do not fit");
  tbb::parallel_for(tbb::blocked_range<std::size_t>(0, field.nodes(), 64), [&](const auto& range) {
    for (std::size_t i = range.begin(); i != range.end(); ++i) {
      const std::size_t first = i * field.cells;
      try {
        const HeatIn in = advance(column, at[i].faces, at[i].area_ratio, time_step,
                                  {{field.temperature.data() + first, field.cells},
                                   {field.progress.data() + first, field.cells},
                                   field.face[i]});
        field.heat_in[i][0] += in.bottom;
        field.heat_in[i][1] += in.top;
        field.heat_in[i][2] += in.friction;
      } catch (const NumericalError& error) {
        throw NumericalError(fmt::format("heat at node {}: {}", i, error.what()));
      }
    }
  });
}

}  // namespace heddle::macroscale::thermal
