#include "friction/friction_test.h"

#include <fmt/format.h>

#include <cmath>
#include <tuple>

namespace heddle::friction {

Context contact_of(const FrictionTestRow& row, const FrictionRig& rig, const AreaFunction& area) {
  Context context{.slip_speed = row.velocity,
                  .pressure = row.normal_force / rig.plate_area,
                  .fabric_temperature = row.fabric_temperature,
                  .tool_temperature = row.tool_temperature,
                  .slip_angle = row.orientation};
  if (area) std::tie(context.area_fraction, context.area_slope) = area(context.pressure);
  return context;
}

ContactState state_after_rest(const Model& model, const Context& context, double rest) {
  Context still = context;
  still.slip_speed = 0.0;
  still.time_step = rest;
  ContactState state = evaluate_unchecked(model, still, {}).state;
  state.dwell += rest;
  return state;
}

ContactState state_after_slip(const Model& model, const Context& context, ContactState state, double slip) {
  Context pull = context;
  pull.time_step = slip / context.slip_speed;
  state = evaluate_unchecked(model, pull, state).state;
  state.dwell += pull.time_step;
  state.slip += slip;
  return state;
}

ContactState state_after_pull(const Model& model, const Context& context, const FrictionRig& rig) {
  if (!has_memory(model)) return {};
  return state_after_slip(model, context, state_after_rest(model, context, rig.dwell_before),
                          rig.pull_length);
}

FrictionTestResult run_friction_test(const Model& model, const FrictionTestRow& row, const FrictionRig& rig,
                                     const AreaFunction& area) {
  const Context context = contact_of(row, rig, area);
  const Friction friction = evaluate(model, context, state_after_pull(model, context, rig));
  FrictionTestResult result{.mu = friction.mu,
                            .pull_force = 2.0 * friction.mu * row.normal_force,
                            .context = context,
                            .hersey = friction.hersey,
                            .calibrated = model.box.contains(context, friction.hersey),
                            .relative_error = {}};
  if (row.measured_force) result.relative_error = result.pull_force / *row.measured_force - 1.0;
  return result;
}

std::vector<FrictionTestResult> run_friction_tests(const Model& model, std::span<const FrictionTestRow> rows,
                                                   const FrictionRig& rig, const AreaFunction& area) {
  std::vector<FrictionTestResult> results;
  results.reserve(rows.size());
  for (const FrictionTestRow& row : rows) results.push_back(run_friction_test(model, row, rig, area));
  return results;
}

std::optional<double> rms_relative_error(std::span<const FrictionTestResult> results) {
  double sum = 0.0;
  int count = 0;
  for (const FrictionTestResult& result : results) {
    if (!result.relative_error) continue;
    sum += *result.relative_error * *result.relative_error;
    ++count;
  }
  if (count == 0) return {};
  return std::sqrt(sum / count);
}

std::vector<CurvePoint> stribeck_curve(const Model& model, const FrictionTestRow& row, const FrictionRig& rig,
                                       std::array<double, 2> speeds, int count, const AreaFunction& area) {
  std::vector<CurvePoint> points;
  FrictionTestRow at = row;
  at.measured_force.reset();
  for (int i = 0; i < count; ++i) {
    at.velocity = speeds[0] * std::pow(speeds[1] / speeds[0], static_cast<double>(i) / (count - 1));
    const FrictionTestResult result = run_friction_test(model, at, rig, area);
    points.push_back(
        {.speed = at.velocity, .hersey = result.hersey, .mu = result.mu, .calibrated = result.calibrated});
  }
  return points;
}

namespace {

bool positive(double x) {
  return x > 0.0 && std::isfinite(x);
}

void check_row(const FrictionTestRow& row, bool measured_force_needed, Problems& problems) {
  const auto demand_positive = [&](double value, const char* column, const char* unit) {
    if (positive(value)) return;
    problems.push_back({.id = "friction.test.*.range"_family.of(column),
                        .key = fmt::format("row {}, {}", row.name, column),
                        .value = fmt::format("{} {}", value, unit),
                        .rule = "must be positive",
                        .way_out = "Correct the row, or leave it out."});
  };
  demand_positive(row.velocity, "velocity", "m/s");
  demand_positive(row.normal_force, "normal_force", "N");
  demand_positive(row.tool_temperature, "tool_temperature", "K");
  demand_positive(row.fabric_temperature, "fabric_temperature", "K");
  if (row.measured_force) demand_positive(*row.measured_force, "measured_force", "N");
  if (measured_force_needed && !row.measured_force) {
    problems.push_back({.id = "friction.test.measured_force.missing"_rule,
                        .key = fmt::format("row {}, force_measured_N", row.name),
                        .value = "",
                        .rule = "must be given for a calibration",
                        .way_out = "Fill in the measured pull force, or leave the row out."});
  }
}

}  // namespace

Problems check(const FrictionRig& rig) {
  Problems problems;
  // An upper bound of 1 m^2 catches an area given in cm^2 or mm^2 as if in m^2.
  if (!(rig.plate_area > 0.0 && rig.plate_area < 1.0)) {
    problems.push_back(
        {.id = "friction.calibration.plate_area.range"_rule,
         .key = "friction.calibration.plate_area",
         .value = fmt::format("{} m^2", rig.plate_area),
         .rule = "must satisfy 0 < A < 1 m^2",
         .way_out = "The pressure is N / A. The paper does not print A; 0.01 m^2 is assumed."});
  }
  const auto [low, high] = rig.plate_area_band;
  if (!(low > 0.0 && low <= rig.plate_area && rig.plate_area <= high && high < 1.0)) {
    problems.push_back(
        {.id = "friction.calibration.plate_area_band.order"_rule,
         .key = "friction.calibration.plate_area_band",
         .value = fmt::format("[{} m^2, {} m^2]", low, high),
         .rule = fmt::format("must satisfy 0 < low <= {} m^2 <= high < 1 m^2", rig.plate_area),
         .way_out = "Give the range in which the plate area surely lies; equal ends if it is known.",
         .others = {"friction.calibration.plate_area"}});
  }
  return problems;
}

Problems check(std::span<const FrictionTestRow> rows, bool measured_force_needed) {
  Problems problems;
  if (rows.empty()) {
    problems.push_back({.id = "friction.test.empty"_rule,
                        .key = "data",
                        .value = "",
                        .rule = "must hold at least one friction test",
                        .way_out = "One line a pull, after the header line."});
  }
  for (const FrictionTestRow& row : rows) check_row(row, measured_force_needed, problems);
  return problems;
}

}  // namespace heddle::friction
