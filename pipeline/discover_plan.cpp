#include "pipeline/discover_plan.h"

#include <fmt/format.h>

#include <algorithm>
#include <nlohmann/json.hpp>

#include "core/text_file.h"
#include "core/units.h"
#include "pipeline/discover_command.h"
#include "pipeline/discover_plan_record.h"
#include "pipeline/json_text.h"
#include "pipeline/run_folder.h"
#include "pipeline/stages.h"

namespace heddle::pipeline {

namespace fs = std::filesystem;
using nlohmann::ordered_json;

namespace {

JudgedDesign judge(const discover::CouponQuestion& question, const std::vector<discover::CouponCell>& cells,
                   int stretches) {
  discover::PlannedCampaign campaign = discover::planned_campaign(question, cells, stretches);
  JudgedDesign judged{.cells = campaign.cells,
                      .forward = campaign.forward,
                      .noise = campaign.noise,
                      .isolability = isolability_of(question, campaign)};
  return judged;
}

std::vector<std::string> ids_of(const JudgedDesign& design, const std::vector<std::size_t>& places) {
  std::vector<std::string> ids;
  for (const std::size_t k : places)
    ids.push_back(design.forward.candidates[design.isolability.effects[k].effect].id);
  return ids;
}

std::string amplitude_text(const JudgedDesign& design, const discover::EffectSight& sight) {
  if (!sight.detectable) return "none";
  const std::string unit = si_unit(design.forward.candidates[sight.effect].numbers.front().unit);
  return fmt::format("{:.3g}{}{}", *sight.detectable, unit.empty() ? "" : " ", unit);
}

void print_groups(const JudgedDesign& design) {
  for (const std::vector<std::size_t>& group : design.isolability.groups)
    fmt::print("  not apart: {}\n", fmt::join(ids_of(design, group), ", "));
  std::vector<std::size_t> unseen;
  for (std::size_t k = 0; k < design.isolability.effects.size(); ++k)
    if (!design.isolability.effects[k].seen) unseen.push_back(k);
  if (!unseen.empty()) fmt::print("  not seen:  {}\n", fmt::join(ids_of(design, unseen), ", "));
}

int pulls_of(const std::vector<discover::CouponCell>& cells) {
  int pulls = 0;
  for (const discover::CouponCell& cell : cells) pulls += cell.samples;
  return pulls;
}

void print(const PlanRecord& record, const fs::path& folder) {
  const JudgedDesign &given = record.given, &proposed = record.proposed;
  fmt::print("{} conditions, {} pulls. Detectable: three standard deviations.\n", given.cells.size(),
             pulls_of(given.cells));
  fmt::print("{:<25}{:<11}{:>19}{:>7}{:>22}{:>7}\n", "effect", "number", "given: detectable", "named",
             "proposed: detectable", "named");
  for (std::size_t k = 0; k < given.isolability.effects.size(); ++k) {
    const discover::EffectSight& sight = given.isolability.effects[k];
    const discover::Candidate& candidate = given.forward.candidates[sight.effect];
    const std::string& key = candidate.numbers.front().key;
    fmt::print("{:<25}{:<11}{:>19}{:>7.2f}", candidate.id, key.substr(key.rfind('.') + 1),
               amplitude_text(given, sight), sight.right);
    const auto other =
        std::ranges::find(proposed.isolability.effects, sight.effect, &discover::EffectSight::effect);
    if (other != proposed.isolability.effects.end())
      fmt::print("{:>22}{:>7.2f}", amplitude_text(proposed, *other), other->right);
    fmt::print("\n");
  }
  fmt::print("given: right names expected {:.0f} %\n", 100.0 * given.isolability.right_names);
  print_groups(given);
  if (record.keeps_given) {
    fmt::print("No design at the same cost was found that does better.\n");
  } else {
    fmt::print("proposed, same number of pulls, {} exchanges: right names expected {:.0f} %\n",
               record.exchange.exchanges, 100.0 * proposed.isolability.right_names);
    print_groups(proposed);
  }
  for (const std::string& note : record.notes) fmt::print("{}\n", note);
  fmt::print("results {}\n", folder.string());
}

ordered_json cells_json(const std::vector<discover::CouponCell>& cells) {
  ordered_json list = ordered_json::array();
  for (const discover::CouponCell& cell : cells)
    list.push_back({{"velocity", cell.pull.velocity},
                    {"normal_force", cell.pull.normal_force},
                    {"tool_temperature", cell.pull.tool_temperature},
                    {"fabric_temperature", cell.pull.fabric_temperature},
                    {"orientation", cell.pull.orientation},
                    {"dwell", cell.dwell},
                    {"day", cell.day},
                    {"replicates", cell.samples}});
  return list;
}

ordered_json design_json(const JudgedDesign& design) {
  return {{"cells", cells_json(design.cells)},
          {"pulls", pulls_of(design.cells)},
          {"detectable", detectable_json(design.forward, design.isolability)},
          {"isolability", isolability_json(design.forward, design.isolability)}};
}

}  // namespace

PlanRecord plan_campaign_in(const Case& a_case, const fs::path& design,
                            const std::vector<fs::path>& own_effects) {
  const DiscoverSpec spec = a_case.discover.value_or(DiscoverSpec{});
  PlanRecord record;
  record.name = a_case.name;
  record.design_file = design.filename().string();
  record.seed = spec.seed;
  Problems problems;
  const discover::CouponRig rig{
      .rig = a_case.friction->rig, .area = area_of_pulled_fabric(a_case), .faces = spec.faces};
  const discover::CouponQuestion question = question_of(a_case, rig, own_effects, problems);
  PlannedDesign planned;
  try {
    planned = read_design(design, {.dwell = a_case.friction->rig.dwell_before});
  } catch (const InputError& error) {
    problems.insert(problems.end(), error.problems().begin(), error.problems().end());
  }
  if (!problems.empty()) throw InputError(std::move(problems));
  record.notes = planned.notes;
  record.given = judge(question, planned.cells, spec.stretches);
  record.exchange = discover::exchanged_design(question, planned.cells);
  record.proposed = judge(question, record.exchange.cells, spec.stretches);
  // The exchange climbs a criterion; what counts is the rate.
  if (record.proposed.isolability.right_names <= record.given.isolability.right_names) {
    record.keeps_given = true;
    record.proposed = record.given;
  }
  record.notes.push_back(
      fmt::format("Scatter {:.3g} % from sample to sample and {:.3g} % from day to day, as {} in the case. "
                  "Pull one condition on three days or more to measure the latter.",
                  100.0 * record.given.noise.sample_sd(), 100.0 * record.given.noise.day,
                  spec.noise.sample && spec.noise.day ? "given" : "given or assumed"));
  return record;
}

std::string plan_json(const PlanRecord& record) {
  ordered_json root;
  root["design"] = record.design_file;
  root["right_names"] = {{"given", record.given.isolability.right_names},
                         {"proposed", record.proposed.isolability.right_names}};
  root["keeps_given"] = record.keeps_given;
  root["exchanges"] = record.exchange.exchanges;
  root["noise"] = {{"sample", record.given.noise.sample_sd()},
                   {"day", record.given.noise.day},
                   {"form", record.given.noise.form},
                   {"history", record.given.noise.history}};
  root["given"] = design_json(record.given);
  root["proposed"] = design_json(record.proposed);
  root["notes"] = record.notes;
  root["seed"] = record.seed;
  return json_text(root);
}

int plan_coupons(const DiscoverOptions& options) {
  Case a_case = read_friction_part(options.run);
  if (!a_case.discover) a_case.discover.emplace();
  if (options.seed) a_case.discover->seed = *options.seed;
  const PlanRecord record = plan_campaign_in(a_case, options.design, options.own_effects);
  RunFolder folder(a_case,
                   options.run.output.empty() ? fs::path("out/plan") / a_case.name : options.run.output,
                   options.run.force);
  folder.write("inputs/design.csv", read_text_file(options.design));
  folder.write("discover/plan.json", plan_json(record));
  folder.write("discover/plan.html", plan_html(record));
  folder.write("discover/design.csv", design_csv(record.proposed.cells));
  folder.close(a_case, {});
  if (options.run.print) print(record, folder.path());
  return exit_done;
}

}  // namespace heddle::pipeline
