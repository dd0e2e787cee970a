#include "answer.h"

#include <algorithm>
#include <array>
#include <nlohmann/json.hpp>
#include <stdexcept>

namespace heddle::blind {

namespace {

using nlohmann::json;

std::vector<Weighted> weighted_list(const json& list) {
  std::vector<Weighted> items;
  for (const json& item : list) {
    items.push_back({item.at("id").get<std::string>(), item.at("probability").get<double>()});
    const double p = items.back().probability;
    if (!(p >= 0.0 && p <= 1.0 + 1e-9)) throw std::runtime_error("a probability of " + std::to_string(p));
  }
  return items;
}

/// A proposed experiment; what it does not mention is as at the baseline.
blindgen::Condition condition(const json& experiment) {
  constexpr double zero_celsius = 273.15, degree = 3.14159265358979323846 / 180.0;
  blindgen::Condition c = blindgen::baseline();
  c.velocity = 1e-3 * experiment.value("velocity_mm_s", 1e3 * c.velocity);
  c.normal_force = experiment.value("normal_force_N", c.normal_force);
  c.tool_temperature =
      zero_celsius + experiment.value("tool_temperature_C", c.tool_temperature - zero_celsius);
  c.fabric_temperature =
      zero_celsius + experiment.value("fabric_temperature_C", c.fabric_temperature - zero_celsius);
  c.orientation = degree * experiment.value("orientation_deg", c.orientation / degree);
  c.dwell = experiment.value("dwell_s", c.dwell);
  return c;
}

/// Numbers that cannot be had are null or absent.
std::optional<double> number(const json& object, const char* key) {
  const auto found = object.find(key);
  if (found == object.end() || found->is_null()) return std::nullopt;
  return found->get<double>();
}

Answer from_json(const json& report) {
  constexpr std::array verdicts{"NO_GAP", "NAMED", "ONE_OF", "NAMED_INCOMPLETE", "UNKNOWN"};
  Answer answer;
  answer.verdict = report.at("verdict").get<std::string>();
  if (std::ranges::find(verdicts, answer.verdict) == verdicts.end()) {
    throw std::runtime_error("an unknown verdict " + answer.verdict);
  }
  answer.named = weighted_list(report.at("effects"));
  answer.candidates = report.at("candidate_set").get<std::vector<std::string>>();
  answer.ranking = weighted_list(report.at("ranking"));
  if (answer.gives_name() == answer.named.empty()) {
    throw std::runtime_error("verdict " + answer.verdict + " with " + std::to_string(answer.named.size()) +
                             " effects");
  }
  for (const json& experiment : report.value("next_experiments", json::array())) {
    answer.next_experiments.push_back(condition(experiment));
  }
  if (const auto gap = report.find("gap"); gap != report.end() && gap->is_object()) {
    answer.held_out_before = number(*gap, "held_out_before");
    answer.held_out_after = number(*gap, "held_out_after");
    answer.shrink = number(*gap, "shrink");
    const auto saturated = gap->find("saturated");
    answer.saturated = saturated != gap->end() && saturated->is_boolean() && saturated->get<bool>();
  }
  return answer;
}

}  // namespace

Answer read_answer(std::string_view report) {
  try {
    return from_json(json::parse(report));
  } catch (const json::exception& error) {
    throw std::runtime_error(std::string("no report: ") + error.what());
  }
}

}  // namespace heddle::blind
