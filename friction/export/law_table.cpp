#include "friction/export/law_table.h"

#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <cmath>

#include "core/units.h"

namespace heddle::friction {

namespace {

std::vector<double> even_in_log(double low, int decades, int steps) {
  std::vector<double> values;
  for (int k = 0; k <= decades * steps; ++k)
    values.push_back(low * std::pow(10.0, static_cast<double>(k) / steps));
  return values;
}

std::vector<double> celsius(double low, double high, double step) {
  std::vector<double> values;
  for (double t = low; t <= high; t += step) values.push_back(t + zero_celsius);
  return values;
}

class Grid {
 public:
  explicit Grid(const LawTable& table) : table_(table) {}

  double at(std::size_t fabric, std::size_t tool, std::size_t pressure, std::size_t speed) const {
    return table_
        .mu[((fabric * table_.tool_temperatures.size() + tool) * table_.pressures.size() + pressure) *
                table_.speeds.size() +
            speed];
  }

  /// Mean of the corners of a cell: what linear interpolation gives in its middle.
  double middle(const std::array<std::size_t, 4>& corner, const std::array<std::size_t, 4>& ends) const {
    double sum = 0.0;
    for (std::size_t bits = 0; bits < 16; ++bits) {
      std::array<std::size_t, 4> index = corner;
      for (std::size_t axis = 0; axis < 4; ++axis)
        index[axis] = std::min(index[axis] + (bits >> axis & 1U), ends[axis]);
      sum += at(index[0], index[1], index[2], index[3]) / 16.0;
    }
    return sum;
  }

 private:
  const LawTable& table_;
};

double between(const std::vector<double>& values, std::size_t k, bool logarithmic) {
  const double a = values[k], b = values[std::min(k + 1, values.size() - 1)];
  return logarithmic ? std::sqrt(a * b) : 0.5 * (a + b);
}

double error_in_the_middle(const ExportedLaw& law, const LawTable& table) {
  const Grid grid(table);
  const std::array<std::size_t, 4> ends{table.fabric_temperatures.size() - 1,
                                        table.tool_temperatures.size() - 1, table.pressures.size() - 1,
                                        table.speeds.size() - 1};
  double worst = 0.0;
  for (std::size_t f = 0; f < std::max<std::size_t>(ends[0], 1); ++f)
    for (std::size_t t = 0; t < std::max<std::size_t>(ends[1], 1); ++t)
      for (std::size_t p = 0; p < std::max<std::size_t>(ends[2], 1); ++p)
        for (std::size_t u = 0; u < std::max<std::size_t>(ends[3], 1); ++u) {
          const Context context = context_of(
              law, between(table.speeds, u, true), between(table.pressures, p, true),
              between(table.fabric_temperatures, f, false), between(table.tool_temperatures, t, false));
          const double mu = evaluate(law.model, context, {}).mu;
          worst = std::max(worst, std::abs(grid.middle({f, t, p, u}, ends) / mu - 1.0));
        }
  return worst;
}

}  // namespace

LawTable usual_grid() {
  LawTable grid;
  grid.pressures = even_in_log(1e3, 3, 8);
  grid.speeds = even_in_log(1e-4, 4, 8);
  grid.tool_temperatures = celsius(20.0, 140.0, 20.0);
  grid.fabric_temperatures = celsius(160.0, 200.0, 20.0);
  return grid;
}

LawTable law_table(const ExportedLaw& law, LawTable grid) {
  if (Problems problems = check_export(law.model); !problems.empty()) throw InputError(std::move(problems));
  grid.mu.clear();
  for (const double fabric : grid.fabric_temperatures)
    for (const double tool : grid.tool_temperatures)
      for (const double pressure : grid.pressures)
        for (const double speed : grid.speeds)
          grid.mu.push_back(evaluate(law.model, context_of(law, speed, pressure, fabric, tool), {}).mu);
  grid.middle_error = error_in_the_middle(law, grid);
  return grid;
}

std::string law_table_csv(const LawTable& table) {
  std::string out =
      "pressure_Pa,slip_speed_mm_s,tool_temperature_C,fabric_temperature_C,friction_coefficient\n";
  std::size_t k = 0;
  for (const double fabric : table.fabric_temperatures)
    for (const double tool : table.tool_temperatures)
      for (const double pressure : table.pressures)
        for (const double speed : table.speeds)
          out += fmt::format("{:.10g},{:.10g},{:.10g},{:.10g},{}\n", pressure, 1e3 * speed,
                             tool - zero_celsius, fabric - zero_celsius, table.mu[k++]);
  return out;
}

}  // namespace heddle::friction
