#include "judge.h"

#include <fmt/format.h>

#include <stdexcept>

namespace heddle::blind {

namespace {

Judged judge_case(const Store& store, const PlannedCase& planned) {
  const std::optional<Record> record = store.finished(planned.number);
  if (!record) {
    throw std::runtime_error(
        fmt::format("case {} of {} has not been run: start the campaign again, it goes on from there",
                    planned.number, store.folder().string()));
  }
  Judged judged{
      .planned = planned, .truth = {}, .wall_time = record->wall_time, .cpu_time = record->cpu_time};
  if (record->timed_out)
    judged.failure = "ran out of time";
  else if (record->exit_code != 0)
    judged.failure = fmt::format("exit code {}", record->exit_code);
  else if (record->report_sha256.empty())
    judged.failure = "no report";
  if (!judged.failure.empty()) return judged;
  try {
    judged.answer = read_answer(store.report(planned.number));
  } catch (const std::runtime_error& error) {
    judged.failure = error.what();
  }
  return judged;
}

}  // namespace

Scored judge(const Store& store) {
  Scored scored{.manifest = store.manifest(), .cases = {}};
  for (const PlannedCase& planned : plan(scored.manifest.campaign, scored.manifest.selection)) {
    scored.cases.push_back(judge_case(store, planned));
  }
  for (Judged& judged : scored.cases) judged.truth = blindgen::draw_case(judged.planned.spec).hidden;
  return scored;
}

}  // namespace heddle::blind
