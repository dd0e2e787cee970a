#include "case_list.h"

#include <fmt/format.h>
#include <fmt/ranges.h>

#include <cmath>

namespace heddle::blind {

namespace {

std::string number(const std::optional<double>& value) {
  return value ? fmt::format("{:.4f}", *value) : "";
}

std::string line_of(const Scored& campaign, const Judged& judged) {
  std::string line =
      fmt::format("{},{},{},{},{},{},{},{}", campaign.manifest.campaign, campaign.manifest.selection.seed,
                  judged.planned.number, blindgen::name_of(judged.planned.spec.kind), truth_name(judged),
                  judged.truth.empty() ? "" : fmt::format("{:.3f}", std::expm1(judged.truth.front().size)),
                  answer_name(judged), went_well(judged) ? 1 : 0);
  if (!judged.answer) return line + ",,,,,\n";
  const Answer& a = *judged.answer;
  const Weighted first = a.ranking.empty() ? Weighted{} : a.ranking.front();
  return line + fmt::format(",{},{},{:.4f},{},{}\n", fmt::join(a.candidates, " "), first.id,
                            first.probability, number(a.held_out_before), number(a.held_out_after));
}

}  // namespace

std::string case_list(const std::vector<Scored>& campaigns) {
  std::string text =
      "campaign,seed,case,kind,truth,size,answer,right,candidate_set,first,probability,held_out_before,held_"
      "out_after\n";
  for (const Scored& campaign : campaigns)
    for (const Judged& judged : campaign.cases) text += line_of(campaign, judged);
  return text;
}

}  // namespace heddle::blind
