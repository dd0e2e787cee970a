#include "pipeline/discover_plan_record.h"

#include <fmt/format.h>

#include <nlohmann/json.hpp>
#include <numbers>

#include "core/units.h"
#include "pipeline/discover_command.h"

namespace heddle::pipeline {

using discover::ForwardModel;
using discover::Isolability;
using nlohmann::ordered_json;

namespace {

std::string id_of(const ForwardModel& forward, const Isolability& isolability, std::size_t k) {
  return forward.candidates[isolability.effects[k].effect].id;
}

ordered_json matrix_json(const Eigen::MatrixXd& matrix) {
  ordered_json rows = ordered_json::array();
  for (Eigen::Index i = 0; i < matrix.rows(); ++i) {
    ordered_json row = ordered_json::array();
    for (Eigen::Index j = 0; j < matrix.cols(); ++j) row.push_back(matrix(i, j));
    rows.push_back(std::move(row));
  }
  return rows;
}

ordered_json pair_json(const discover::Proposal& proposal, const discover::RivalPair& pair) {
  return {proposal.rivals[pair.first].name, proposal.rivals[pair.second].name};
}

/// A setting as a lab would write it: six digits, not what the way from degC to K and back leaves.
std::string setting(double value) {
  return fmt::format("{:.6g}", value);
}

std::vector<std::pair<std::string, std::string>> settings_of(const discover::CouponCell& cell) {
  return {{"velocity_mm_s", setting(1e3 * cell.pull.velocity)},
          {"normal_force_N", setting(cell.pull.normal_force)},
          {"tool_temperature_C", setting(cell.pull.tool_temperature - zero_celsius)},
          {"fabric_temperature_C", setting(cell.pull.fabric_temperature - zero_celsius)},
          {"orientation_deg", setting(cell.pull.orientation * 180.0 / std::numbers::pi)},
          {"dwell_s", setting(cell.dwell)}};
}

}  // namespace

ordered_json next_experiments_json(const discover::Proposal& proposal) {
  ordered_json list = ordered_json::array();
  for (const discover::ProposedPull& next : proposal.pulls) {
    ordered_json one;
    for (const auto& [column, value] : settings_of(next.cell)) one[column] = ordered_json::parse(value);
    one["replicates"] = next.cell.samples;
    one["expected_right"] = next.right;
    one["expected_gain"] = next.gain;
    one["separates"] = ordered_json::array();
    for (const discover::RivalPair& pair : next.separates)
      one["separates"].push_back(pair_json(proposal, pair));
    list.push_back(std::move(one));
  }
  return list;
}

ordered_json proposal_json(const discover::Proposal& proposal) {
  ordered_json json = {{"rivals", ordered_json::array()},
                       {"right_before", proposal.right_before},
                       {"right_after", proposal.right_after},
                       {"not_separable", ordered_json::array()}};
  for (const discover::Rival& rival : proposal.rivals)
    json["rivals"].push_back({{"name", rival.name}, {"probability", rival.probability}});
  for (const discover::RivalPair& pair : proposal.inseparable)
    json["not_separable"].push_back(pair_json(proposal, pair));
  return json;
}

std::string next_experiments_csv(const DiscoveryRecord& record) {
  std::string text =
      "condition_id,velocity_mm_s,normal_force_N,tool_temperature_C,fabric_temperature_C,orientation_deg,"
      "dwell_s,replicates\n";
  int number = 0;
  for (const discover::ProposedPull& next : record.proposal.pulls) {
    text += fmt::format("next{}", ++number);
    for (const auto& [column, value] : settings_of(next.cell)) text += "," + value;
    text += fmt::format(",{}\n", next.cell.samples);
  }
  return text;
}

ordered_json isolability_json(const ForwardModel& forward, const Isolability& isolability) {
  ordered_json json = {{"effects", ordered_json::array()}};
  ordered_json groups = ordered_json::array(), unseen = ordered_json::array(), rates = ordered_json::object();
  for (std::size_t k = 0; k < isolability.effects.size(); ++k) {
    const std::string id = id_of(forward, isolability, k);
    json["effects"].push_back(id);
    rates[id] = isolability.effects[k].right;
    if (!isolability.effects[k].seen) unseen.push_back(id);
  }
  for (const std::vector<std::size_t>& group : isolability.groups) {
    groups.emplace_back(ordered_json::array());
    for (const std::size_t k : group) groups.back().push_back(id_of(forward, isolability, k));
  }
  json["lambda"] = matrix_json(isolability.lambda);
  json["swap_rate"] = matrix_json(isolability.lambda.unaryExpr(&discover::swap_rate));
  for (std::size_t k = 0; k < isolability.effects.size(); ++k) json["swap_rate"][k][k] = nullptr;
  json["groups"] = std::move(groups);
  json["not_seen"] = std::move(unseen);
  json["right_names"] = isolability.right_names;
  json["name_rate"] = std::move(rates);
  return json;
}

ordered_json detectable_json(const ForwardModel& forward, const Isolability& isolability) {
  ordered_json list = ordered_json::array();
  for (const discover::EffectSight& sight : isolability.effects) {
    const discover::Candidate& candidate = forward.candidates[sight.effect];
    const discover::Unknown& amplitude = candidate.numbers.front();
    list.push_back({{"id", candidate.id},
                    {"parameter", amplitude.key.substr(amplitude.key.rfind('.') + 1)},
                    {"amplitude", sight.detectable ? ordered_json(*sight.detectable) : ordered_json(nullptr)},
                    {"unit", si_unit(amplitude.unit)},
                    {"usual", amplitude.prior.value_at(1.0)},
                    {"seen", sight.seen}});
  }
  return list;
}

}  // namespace heddle::pipeline
