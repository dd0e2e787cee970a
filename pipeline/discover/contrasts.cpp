#include "pipeline/discover/contrasts.h"

#include <cmath>

namespace heddle::discover {

namespace {

enum class Differs { velocity, normal_force, tool_temperature, other };

/// In which condition alone two pulls differ; `other` where it is none, another or several.
Differs difference(const friction::FrictionTestRow& a, const friction::FrictionTestRow& b) {
  const bool u = a.velocity != b.velocity, n = a.normal_force != b.normal_force,
             t = a.tool_temperature != b.tool_temperature;
  if (a.fabric_temperature != b.fabric_temperature || a.orientation != b.orientation || u + n + t != 1)
    return Differs::other;
  return u ? Differs::velocity : n ? Differs::normal_force : Differs::tool_temperature;
}

/// Mean of the slopes of several pairs.
class Mean {
 public:
  void add(double slope) {
    sum_ += slope;
    ++count_;
  }
  std::optional<double> value() const { return count_ > 0 ? std::optional(sum_ / count_) : std::nullopt; }

 private:
  double sum_ = 0.0;
  int count_ = 0;
};

}  // namespace

std::optional<double> Sensitivities::implied_index() const {
  if (!velocity || !normal_force || *normal_force == 0.0) return {};
  return -*velocity / *normal_force;
}

bool Sensitivities::can_be_hersey() const {
  const auto index = implied_index();
  return !index || (*index > 0.0 && *index <= 1.0);
}

Sensitivities sensitivities_of(std::span<const friction::FrictionTestRow> rows,
                               const std::vector<double>& forces) {
  Mean velocity, normal_force, tool_temperature;
  for (std::size_t i = 0; i < rows.size(); ++i)
    for (std::size_t j = 0; j < i; ++j) {
      const double change = std::log(friction::effective_coefficient(forces[i], rows[i].normal_force) /
                                     friction::effective_coefficient(forces[j], rows[j].normal_force));
      switch (difference(rows[i], rows[j])) {
        case Differs::velocity:
          velocity.add(change / std::log(rows[i].velocity / rows[j].velocity));
          break;
        case Differs::normal_force:
          normal_force.add(change / std::log(rows[i].normal_force / rows[j].normal_force));
          break;
        case Differs::tool_temperature:
          tool_temperature.add(change / (rows[i].tool_temperature - rows[j].tool_temperature));
          break;
        case Differs::other:
          break;
      }
    }
  return {velocity.value(), normal_force.value(), tool_temperature.value()};
}

}  // namespace heddle::discover
