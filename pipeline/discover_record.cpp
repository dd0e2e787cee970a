#include <fmt/format.h>

#include <cmath>
#include <nlohmann/json.hpp>

#include "core/units.h"
#include "pipeline/discover_command.h"
#include "pipeline/discover_plan_record.h"
#include "pipeline/json_text.h"

namespace heddle::pipeline {

namespace {

using discover::Answer;
using discover::CouponFindings;
using discover::Scored;
using nlohmann::ordered_json;

/// A number with its interval, found in z and carried to the number's own scale.
ordered_json number_json(const discover::Unknown& unknown, double z, double variance) {
  const auto [low, high] = unknown.prior.bounds();
  const double sd = std::sqrt(variance);
  return {{"value", unknown.prior.value_at(z)},
          {"unit", si_unit(unknown.unit)},
          {"low", unknown.prior.value_at(std::max(z - 1.96 * sd, low))},
          {"high", unknown.prior.value_at(std::min(z + 1.96 * sd, high))}};
}

std::string last_name(const std::string& key) {
  return key.substr(key.rfind('.') + 1);
}

/// Numbers of the baseline and of each effect of a fit, with intervals.
struct FittedNumbers {
  ordered_json baseline = ordered_json::object();
  std::vector<ordered_json> effects;
};

FittedNumbers numbers_of(const discover::ForwardModel& forward, const discover::MapFit& fit) {
  FittedNumbers numbers;
  Eigen::Index at = 0;
  const auto add = [&](const discover::Unknown& unknown, ordered_json& into, const std::string& name) {
    if (!unknown.prior.is_free()) {
      into[name] = {{"value", unknown.prior.centre}, {"unit", si_unit(unknown.unit)}};
      return;
    }
    into[name] = number_json(unknown, fit.z[at], fit.covariance(at, at));
    ++at;
  };
  for (const discover::Unknown& unknown : forward.baseline) add(unknown, numbers.baseline, unknown.key);
  for (const std::size_t effect : fit.hypothesis) {
    ordered_json parameters = ordered_json::object();
    for (const discover::Unknown& unknown : forward.candidates[effect].numbers)
      add(unknown, parameters, last_name(unknown.key));
    numbers.effects.push_back(std::move(parameters));
  }
  return numbers;
}

ordered_json effects_json(const CouponFindings& found) {
  ordered_json effects = ordered_json::array();
  if (found.decision.answer != Answer::named && found.decision.answer != Answer::named_incomplete)
    return effects;
  const Scored* best = found.result.find(found.decision.named);
  const FittedNumbers numbers = numbers_of(found.forward, best->numbers);
  for (std::size_t k = 0; k < found.decision.named.size(); ++k) {
    const discover::Candidate& candidate = found.forward.candidates[found.decision.named[k]];
    effects.push_back({{"id", candidate.id},
                       {"kind", candidate.kind == discover::Kind::rig        ? "rig"
                                : candidate.kind == discover::Kind::numerics ? "numerics"
                                                                             : "physics"},
                       {"probability", found.decision.probability},
                       {"parameters", numbers.effects[k]}});
    if (!candidate.detail.empty()) effects.back()["detail"] = candidate.detail;
  }
  return effects;
}

/// "a+b", "none"
std::string joined_ids(const CouponFindings& found, const discover::Hypothesis& hypothesis) {
  std::vector<std::string> ids;
  for (const std::size_t effect : hypothesis) ids.push_back(found.forward.candidates[effect].id);
  return ids.empty() ? "none" : fmt::format("{}", fmt::join(ids, "+"));
}

ordered_json other_priors_json(const CouponFindings& found) {
  ordered_json list = ordered_json::array();
  for (const discover::UnderPrior& under : found.evidence.priors)
    list.push_back({{"width", under.width},
                    {"best", joined_ids(found, under.best)},
                    {"probability", under.probability}});
  return list;
}

ordered_json ranking_json(const CouponFindings& found) {
  ordered_json ranking = ordered_json::array();
  for (const Scored& one : found.result.scored) {
    if (ranking.size() == 12) break;
    ranking.push_back({{"id", joined_ids(found, one.fit.hypothesis)},
                       {"probability", one.probability},
                       {"log_bayes_factor", one.fit.log_evidence - found.result.log_evidence_none},
                       {"chi2", one.fit.chi2}});
  }
  return ranking;
}

ordered_json noise_json(const discover::CouponNoise& noise) {
  return {{"sample", noise.sample_sd()},
          {"sample_source", friction::in_words(noise.sample_source)},
          {"sample_degrees_of_freedom", noise.sample_freedom},
          {"day", noise.day},
          {"day_source", friction::in_words(noise.day_source)},
          {"day_degrees_of_freedom", noise.day_freedom},
          {"form", noise.form},
          {"form_length", noise.form_length},
          {"history", noise.history}};
}

ordered_json shape_json(const std::vector<discover::Shape>& shapes) {
  ordered_json list = ordered_json::array();
  for (const discover::Shape& shape : shapes) {
    if (list.size() == 5) break;
    list.push_back({{"over", shape.over},
                    {"log_bayes_factor", shape.log_evidence},
                    {"amplitude", shape.amplitude},
                    {"length", shape.length}});
  }
  return list;
}

std::string condition_cells(const discover::CouponCell& cell) {
  return fmt::format("{},{:.6g},{:.6g},{:.6g},{:.6g},{:.6g},{:.6g}", cell.pull.name, 1e3 * cell.pull.velocity,
                     cell.pull.normal_force, cell.pull.tool_temperature - zero_celsius,
                     cell.pull.fabric_temperature - zero_celsius, cell.pull.orientation * degrees,
                     cell.dwell);
}

}  // namespace

std::string discovery_json(const DiscoveryRecord& record) {
  const CouponFindings& found = record.findings;
  ordered_json root;
  root["verdict"] = in_words(found.decision.answer);
  root["effects"] = effects_json(found);
  root["candidate_set"] = found.decision.candidate_set;
  root["group"] = found.decision.group;
  root["reasons"] = found.decision.reasons;
  root["ranking"] = ranking_json(found);
  root["baseline"] = numbers_of(found.forward, found.result.baseline).baseline;
  root["gate"] = {{"statistic", found.gate_statistic},
                  {"from", found.gate_from},
                  {"p_value", found.evidence.gate_p},
                  {"stability", found.evidence.stability},
                  {"other_priors", other_priors_json(found)},
                  {"lack_of_fit_p", found.decision.lack_of_fit_p},
                  {"excess_removed", found.decision.excess_removed}};
  root["location"] = ordered_json::array();
  for (const discover::Location& location : found.locations) {
    if (root["location"].size() == 12) break;
    root["location"].push_back({{"factor", location.factor},
                                {"segment", location.segment},
                                {"statistic", location.statistic},
                                {"p_value", location.p_value}});
  }
  ordered_json gap = {{"metric", "rms of ln F_model - ln F_measured over held-out conditions"}};
  if (found.gap)
    gap.update({{"held_out_before", found.gap->before},
                {"held_out_after", found.gap->after},
                {"noise_floor", found.gap->floor},
                {"shrink", found.gap->shrink},
                {"shrink_low", found.gap->shrink_low},
                {"shrink_high", found.gap->shrink_high},
                {"closed", found.gap->closed},
                {"conditions", found.gap->conditions}});
  gap["saturated"] = found.saturated;
  root["gap"] = gap;
  root["signatures"] = ordered_json::array();
  for (const discover::Signature& signature : found.result.signatures)
    root["signatures"].push_back(
        {{"id", found.forward.candidates[signature.effect].id},
         {"score", signature.score},
         {"log_force_range", signature.change.maxCoeff() - signature.change.minCoeff()},
         {"length", signature.direction.norm()}});
  root["noise"] = noise_json(found.noise);
  root["shape"] = {{"of_the_gap", shape_json(found.evidence.gap_shapes)},
                   {"left_over", shape_json(found.evidence.rest_shapes)}};
  root["isolability"] = isolability_json(found.forward, found.isolability);
  root["detectable"] = detectable_json(found.forward, found.isolability);
  root["next_experiments"] = next_experiments_json(record.proposal);
  root["next"] = proposal_json(record.proposal);
  root["not_tried"] = ordered_json::array();
  for (const auto& [id, why] : found.refused) root["not_tried"].push_back({{"id", id}, {"why", why}});
  root["notes"] = record.notes;
  root["data"] = record.data_file;
  root["seed"] = record.seed;
  return json_text(root);
}

std::string gap_csv(const DiscoveryRecord& record) {
  std::string text =
      "condition,velocity_mm_s,normal_force_N,tool_temperature_C,fabric_temperature_C,orientation_deg,dwell_"
      "s,"
      "error_before,error_after,noise\n";
  for (const discover::HeldOut& one : record.findings.held_out)
    text +=
        fmt::format("{},{:.5f},{:.5f},{:.5f}\n", condition_cells(record.findings.campaign.cells[one.cell]),
                    one.before, one.after, one.noise);
  return text;
}

std::string shape_csv(const DiscoveryRecord& record) {
  std::string text = "of,over,at,log_force_gap,low,high,force_gap_N\n";
  const auto add = [&](const char* of, const std::vector<discover::Shape>& shapes) {
    if (shapes.empty()) return;
    for (const discover::ShapePoint& point : curve_of(shapes.front(), record.findings.training))
      text += fmt::format("{},{},{:.6g},{:.5f},{:.5f},{:.5f},{:.4g}\n", of, point.over, point.at, point.gap,
                          point.low, point.high, point.force);
  };
  add("gap", record.findings.evidence.gap_shapes);
  add("left_over", record.findings.evidence.rest_shapes);
  return text;
}

}  // namespace heddle::pipeline
