#include <fmt/format.h>

#include <algorithm>

#include "core/units.h"
#include "pipeline/discover_plan.h"
#include "pipeline/isolability_picture.h"
#include "pipeline/page.h"

namespace heddle::pipeline {

namespace {

std::string names(const JudgedDesign& design, const std::vector<std::size_t>& places) {
  std::vector<std::string> ids;
  for (const std::size_t k : places)
    ids.push_back(design.forward.candidates[design.isolability.effects[k].effect].id);
  return fmt::format("{}", fmt::join(ids, ", "));
}

std::vector<Verdict> verdicts_of(const JudgedDesign& design, const char* which) {
  std::vector<Verdict> verdicts;
  verdicts.push_back(
      {Tone::note, fmt::format("{}: the right name is expected in {:.0f} % of campaigns, mean over "
                               "effects at their usual size.",
                               which, 100.0 * design.isolability.right_names)});
  for (const std::vector<std::size_t>& group : design.isolability.groups)
    verdicts.push_back(
        {Tone::attention, fmt::format("{}: cannot tell apart {}.", which, names(design, group))});
  std::vector<std::size_t> unseen;
  for (std::size_t k = 0; k < design.isolability.effects.size(); ++k)
    if (!design.isolability.effects[k].seen) unseen.push_back(k);
  if (!unseen.empty())
    verdicts.push_back({Tone::attention, fmt::format("{}: does not see {}.", which, names(design, unseen))});
  return verdicts;
}

std::string amplitude(const JudgedDesign& design, const discover::EffectSight& sight) {
  if (!sight.detectable) return "none";
  const std::string unit = si_unit(design.forward.candidates[sight.effect].numbers.front().unit);
  return significant(*sight.detectable, 3) + (unit.empty() ? "" : " " + unit);
}

std::string effects_table(const PlanRecord& record) {
  std::vector<std::vector<std::string>> rows;
  for (const discover::EffectSight& sight : record.given.isolability.effects) {
    const discover::Candidate& candidate = record.given.forward.candidates[sight.effect];
    std::vector<std::string> row{candidate.id, significant(candidate.numbers.front().prior.value_at(1.0), 3),
                                 amplitude(record.given, sight), fmt::format("{:.2f}", sight.right)};
    const auto& effects = record.proposed.isolability.effects;
    const auto other = std::ranges::find(effects, sight.effect, &discover::EffectSight::effect);
    row.push_back(other == effects.end() ? "" : amplitude(record.proposed, *other));
    row.push_back(other == effects.end() ? "" : fmt::format("{:.2f}", other->right));
    rows.push_back(std::move(row));
  }
  return table({"effect", "usual size", "seen from, given", "named", "seen from, proposed", "named"}, rows);
}

std::string cells_table(const std::vector<discover::CouponCell>& cells) {
  std::vector<std::vector<std::string>> rows;
  for (const discover::CouponCell& cell : cells)
    rows.push_back({fmt::format("c{:02}", cell.condition + 1), fmt::format("d{:02}", cell.day + 1),
                    significant(1e3 * cell.pull.velocity, 3), significant(cell.pull.normal_force, 4),
                    significant(cell.pull.tool_temperature - zero_celsius, 3),
                    significant(cell.pull.fabric_temperature - zero_celsius, 3),
                    significant(cell.pull.orientation * 57.29577951308232, 3), significant(cell.dwell, 3),
                    std::to_string(cell.samples)});
  return table({"condition", "day", "speed, mm/s", "load, N", "tool, °C", "fabric, °C", "angle, °", "rest, s",
                "samples"},
               rows);
}

}  // namespace

std::string plan_html(const PlanRecord& record) {
  std::string out = page_head(record.name);
  out += fmt::format(
      "<header>\n<p class=\"kind\">heddle · Plan</p>\n<h1>{}</h1>\n<p class=\"lead\">What {} could tell "
      "before "
      "anybody pulls a coupon, and as many pulls that tell more.</p>\n</header>\n",
      escape(record.name), escape(record.design_file));
  std::vector<Verdict> verdicts = verdicts_of(record.given, "As planned");
  if (record.keeps_given)
    verdicts.push_back({Tone::holds, "No campaign at the same cost was found that does better."});
  else
    for (Verdict& verdict : verdicts_of(record.proposed, "Proposed")) verdicts.push_back(std::move(verdict));
  out += section("In short", verdict_list(verdicts) + list(record.notes));
  out += section(
      "Who is taken for whom",
      figure(draw(record.given.forward, record.given.isolability),
             "As planned. One row a truth, one column a rival; dark is close. Figures: how often, in "
             "percent, the truth is taken for the rival where only the two are asked. Faint: not seen.") +
          (record.keeps_given ? ""
                              : figure(draw(record.proposed.forward, record.proposed.isolability),
                                       "Proposed, as many pulls.")));
  out += section(
      "What is seen",
      "<p>Amplitudes of three standard deviations beside what the baseline's own numbers can do, in SI "
      "units, and the expected rate of the right name at the usual size.</p>" +
          effects_table(record));
  out += section("What to pull", cells_table(record.proposed.cells));
  return out + page_foot("Written by heddle discover --plan; plan.json holds the same numbers.");
}

}  // namespace heddle::pipeline
