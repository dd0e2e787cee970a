#include "pipeline/discover_plan_record.h"

#include <nlohmann/json.hpp>

#include "core/units.h"

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

}  // namespace

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
