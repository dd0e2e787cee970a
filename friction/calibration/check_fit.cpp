#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <map>

#include "core/units.h"
#include "friction/calibration/coupon_fit.h"
#include "friction/calibration/model_numbers.h"

namespace heddle::friction {

namespace {

void check_number(const FreeNumber& wish, const ModelNumber& number, Problems& problems) {
  const auto written = [&](double value) { return write_quantity(value, number.unit); };
  if (wish.bounds) {
    const auto [low, high] = *wish.bounds;
    const std::string key = "calibrate.bounds." + wish.key;
    if (!(low < high))
      problems.push_back({.id = "calibrate.bounds.order"_rule,
                          .key = key,
                          .value = fmt::format("[{}, {}]", written(low), written(high)),
                          .rule = "must be [low, high] with low < high",
                          .way_out = "Swap the two."});
    else if (!(low <= number.value && number.value <= high))
      problems.push_back({.id = "calibrate.bounds.start"_rule,
                          .key = key,
                          .value = fmt::format("[{}, {}]", written(low), written(high)),
                          .rule = fmt::format("must hold the value that the fit starts from, {} = {}",
                                              wish.key, written(number.value)),
                          .way_out = "Widen the bounds, or start elsewhere."});
  }
  if (wish.prior && !(wish.prior->sd > 0.0 && std::isfinite(wish.prior->mean)))
    problems.push_back({.id = "calibrate.prior.sd"_rule,
                        .key = "calibrate.prior." + wish.key,
                        .value = fmt::format("sd {}", wish.prior->sd),
                        .rule = "must be [mean, standard deviation] with a standard deviation above 0",
                        .way_out = "Leave the number out of calibrate.parameters to hold it."});
}

/// Whether every row was pulled at one speed, load and temperature.
bool all_alike(const CouponData& data) {
  const FrictionTestRow& first = data.rows.front().pull;
  const auto near = [](double a, double b, double share) { return std::abs(a - b) <= share * std::abs(b); };
  return std::ranges::all_of(data.rows, [&](const CouponRow& row) {
    const FrictionTestRow& pull = row.pull;
    return near(pull.velocity, first.velocity, 1e-3) && near(pull.normal_force, first.normal_force, 1e-3) &&
           std::abs(pull.tool_temperature - first.tool_temperature) < 0.1 &&
           std::abs(pull.fabric_temperature - first.fabric_temperature) < 0.1 &&
           std::abs(pull.orientation - first.orientation) < 1e-3 &&
           near(row.dwell, data.rows.front().dwell, 1e-3) &&
           row.slip.has_value() == data.rows.front().slip.has_value() &&
           near(row.slip.value_or(1.0), data.rows.front().slip.value_or(1.0), 1e-2);
  });
}

void check_data(const CouponData& data, const CouponFitSpec& spec, Problems& problems) {
  std::size_t priors = 0;
  for (const FreeNumber& wish : spec.numbers)
    if (wish.prior) ++priors;
  const std::size_t from_data = spec.numbers.size() - priors;
  if (data.rows.size() + priors < spec.numbers.size())
    problems.push_back({.id = "calibrate.data.rows"_rule,
                        .key = "data",
                        .value = fmt::format("{} pulls", data.rows.size()),
                        .rule = fmt::format("must hold at least {} pulls, one for each number that no prior "
                                            "tells",
                                            from_data),
                        .way_out = "Add pulls, give priors, or fit fewer numbers.",
                        .file = data.file});
  if (all_alike(data) && from_data > 1)
    problems.push_back(
        {.id = "calibrate.data.alike"_rule,
         .key = "data",
         .value = fmt::format("{} pulls", data.rows.size()),
         .rule = fmt::format("hold one condition only, which cannot tell {} numbers apart", from_data),
         .way_out = "Vary velocity, normal force and tool temperature, or fit one number.",
         .file = data.file});
}

}  // namespace

Problems check_fit(const Model& start, const CouponData& data, const CouponFitSpec& spec) {
  Problems problems;
  const std::vector<ModelNumber> numbers = numbers_of(start);
  if (spec.numbers.empty())
    problems.push_back({.id = "calibrate.parameters.none"_rule,
                        .key = "calibrate.parameters",
                        .value = "",
                        .rule = "must name at least one number of the model",
                        .way_out = "For instance [friction.scale, friction.exponent]."});
  std::map<std::string, int> times;
  for (const FreeNumber& wish : spec.numbers) {
    if (++times[wish.key] == 2)
      problems.push_back({.id = "calibrate.parameters.twice"_rule,
                          .key = "calibrate.parameters",
                          .value = wish.key,
                          .rule = "names a number twice",
                          .way_out = "Leave the second one out."});
    const auto number = std::ranges::find(numbers, wish.key, &ModelNumber::key);
    if (number != numbers.end()) {
      check_number(wish, *number, problems);
      continue;
    }
    std::vector<std::string> known;
    for (const ModelNumber& one : numbers) known.push_back(one.key);
    problems.push_back({.id = "calibrate.parameters.acts"_rule,
                        .key = "calibrate.parameters",
                        .value = wish.key,
                        .rule = "is no number that acts in this case",
                        .way_out = known.empty() ? "This law has no numbers."
                                                 : fmt::format("These do: {}.", fmt::join(known, ", ")),
                        .others = {"friction.law", "friction.form"}});
  }
  if (!spec.numbers.empty()) check_data(data, spec, problems);
  return problems;
}

}  // namespace heddle::friction
