#include "score.h"

#include <algorithm>
#include <catch2/catch.hpp>
#include <nlohmann/json.hpp>
#include <stdexcept>

#include "case_list.h"
#include "history.h"
#include "page.h"

using namespace heddle::blind;
using blindgen::Kind;

namespace {

Judged judged(int number, Kind kind, std::vector<std::string> truth, std::optional<Answer> answer) {
  Judged result;
  result.planned.number = number;
  result.planned.spec.kind = kind;
  for (const std::string& id : truth) result.truth.push_back({.id = id, .asked = 0.2, .size = 0.2});
  result.answer = std::move(answer);
  if (!result.answer) result.failure = "exit code 1";
  result.wall_time = number;
  return result;
}

Answer named(std::vector<Weighted> names, std::vector<std::string> candidates) {
  return {
      .verdict = "NAMED", .named = names, .candidates = std::move(candidates), .ranking = {names.front()}};
}

Answer with_gap(Answer answer, double before, double after, double shrink) {
  answer.held_out_before = before;
  answer.held_out_after = after;
  answer.shrink = shrink;
  return answer;
}

/// Ten cases, whose figures below were worked by hand.
std::vector<Judged> example() {
  return {judged(1, Kind::single, {"static_peak"},
                 with_gap(named({{"static_peak", 0.97}}, {"static_peak"}), 0.10, 0.04, 0.6)),
          judged(2, Kind::single, {"wear"},
                 with_gap(named({{"wear", 0.92}}, {"wear", "sliding_evolution"}), 0.08, 0.02, 0.75)),
          judged(3, Kind::single, {"adhesion"},
                 Answer{.verdict = "ONE_OF",
                        .candidates = {"adhesion", "load_cell_offset"},
                        .ranking = {{"adhesion", 0.6}}}),
          judged(4, Kind::single, {"orientation"},
                 Answer{.verdict = "NO_GAP", .ranking = {{"orientation", 0.3}}}),
          judged(5, Kind::single, {"shear_heating"},
                 with_gap(
                     named({{"pressure_dependent_area", 0.91}}, {"pressure_dependent_area", "shear_heating"}),
                     0.05, 0.06, -0.2)),
          judged(6, Kind::null, {}, Answer{.verdict = "NO_GAP"}),
          judged(7, Kind::null_exact, {}, Answer{.verdict = "ONE_OF", .candidates = {"wear", "adhesion"}}),
          judged(8, Kind::pair, {"static_peak", "wear"},
                 named({{"wear", 0.95}, {"static_peak", 0.95}}, {"wear", "static_peak"})),
          judged(11, Kind::pair, {"adhesion", "wear"},
                 Answer{.verdict = "ONE_OF",
                        .candidates = {"wear", "adhesion", "load_cell_offset"},
                        .ranking = {{"wear+adhesion", 0.7}, {"wear+load_cell_offset", 0.3}}}),
          judged(12, Kind::pair, {"adhesion", "wear"},
                 Answer{.verdict = "ONE_OF",
                        .candidates = {"wear", "adhesion", "load_cell_offset"},
                        .ranking = {{"wear+load_cell_offset", 0.7}, {"wear+adhesion", 0.3}}}),
          judged(9, Kind::outside, {"dwell_bump"}, Answer{.verdict = "UNKNOWN"}),
          judged(10, Kind::rig, {"load_cell_offset"}, std::nullopt)};
}

void check_rate(const Rate& rate, int hits, int of) {
  CHECK(rate.hits == hits);
  CHECK(rate.of == of);
}

}  // namespace

TEST_CASE("the list of cases has a line a case: truth, answer, and what stood first", "[blind]") {
  Scored scored{.manifest = {}, .cases = example()};
  scored.manifest.campaign = "smoke";
  const std::string list = case_list({scored});
  CHECK(std::ranges::count(list, '\n') == 13);
  CHECK_THAT(list, Catch::Contains(",4,single,orientation,") && Catch::Contains(",NO_GAP,0,") &&
                       Catch::Contains(",ONE_OF,1,wear adhesion load_cell_offset,wear+adhesion,0.7000,"));
  CHECK_THAT(list, Catch::Contains("no report,0,,,,,\n"));
}

TEST_CASE("twelve cases worked by hand have the figures of the scorer", "[blind]") {
  const std::vector<Judged> cases = example();
  const Scores s = score(cases);
  CHECK(s.cases == 12);
  CHECK(s.failed == 1);
  check_rate(s.top1, 3, 5);           // 1, 2 and the head of 3
  check_rate(s.named_alone, 2, 5);    // 1, 2
  check_rate(s.first_ranked, 4, 5);   // all but 5
  check_rate(s.candidate_set, 4, 5);  // all but 4
  check_rate(s.precision, 2, 3);      // 1, 2 of 1, 2, 5
  check_rate(s.any_precision, 2, 3);
  check_rate(s.improved, 2, 3);
  CHECK(median(s.shrinks).value() == 0.6);
  // Bins: 0.3 right; 0.6 right; 0.97, 0.92 right and 0.91 wrong: (0.7 + 0.4 + 3 * (0.93333 - 0.66667)) / 5.
  CHECK(calibration_error(s.forecasts) == Approx(0.38));
  check_rate(s.null_named, 1, 2);
  check_rate(s.null_exact_named, 1, 1);
  check_rate(s.null_name, 0, 2);
  check_rate(s.null_gap, 1, 2);
  check_rate(s.pair_exact, 2, 3);  // 8 and the head of 11
  check_rate(s.pair_named, 1, 3);
  check_rate(s.pair_one, 3, 3);
  check_rate(s.pair_false, 0, 3);
  check_rate(s.outside_clean, 0, 1);
  check_rate(s.outside_unknown, 1, 1);
  check_rate(s.outside_set, 0, 1);
  check_rate(s.rig_physics, 1, 1);  // without a report it counts as wrong
  check_rate(s.rig_named, 0, 1);
  std::vector<int> wrong;
  for (const Judged* failure : s.failures) wrong.push_back(failure->planned.number);
  CHECK(wrong == std::vector<int>{4, 5, 7, 12, 10});
  CHECK(median(s.wall_times).value() == 6.5);
  CHECK(s.confusion.at("shear_heating").at("pressure_dependent_area") == 1);
  CHECK(s.confusion.at("static_peak+wear").at("static_peak+wear") == 1);
}

TEST_CASE("a case that fails is wrong in every figure of its kind", "[blind]") {
  for (Judged& one : example()) {
    one.answer.reset();
    CHECK_FALSE(went_well(one));
    const std::vector<Judged> alone{one};
    const Scores s = score(alone);
    CHECK(s.top1.hits + s.candidate_set.hits + s.pair_exact.hits + s.pair_one.hits + s.rig_named.hits == 0);
    CHECK(s.null_named.hits == s.null_named.of);
    CHECK(s.outside_clean.hits == s.outside_clean.of);
    CHECK(s.pair_false.hits == s.pair_false.of);
  }
}

TEST_CASE("intervals of Wilson have their published values", "[blind]") {
  const auto check = [](int hits, int of, double low, double high) {
    const Interval interval = wilson({hits, of});
    CHECK(interval.low == Approx(low).margin(5e-4));
    CHECK(interval.high == Approx(high).margin(5e-4));
  };
  check(0, 10, 0.0, 0.2775);  // Brown, Cai & DasGupta 2001: z^2 / (n + z^2) at none
  check(5, 10, 0.2366, 0.7634);
  check(10, 10, 0.7225, 1.0);
  check(429, 440, 0.9558, 0.9863);
  check(9, 240, 0.0199, 0.0697);
  check(0, 60, 0.0, 0.0602);
}

TEST_CASE("rates pass by the bound of their interval and not by their value", "[blind]") {
  Scores s;
  s.top1 = {318, 330};  // 96.4 %, lower bound 93.8 %
  CHECK(requirements(s).front().holds == false);
  s.top1 = {320, 330};  // 97.0 %, lower bound 94.5 %
  CHECK(requirements(s).front().holds == true);
  CHECK_FALSE(requirements(Scores{}).front().holds.has_value());
}

TEST_CASE("a report that breaks the format is refused and says where", "[blind]") {
  const std::string good =
      R"({"verdict": "NAMED", "effects": [{"id": "wear", "probability": 0.9, "parameters": {}}],
          "candidate_set": ["wear"], "ranking": [{"id": "wear", "probability": 0.9}],
          "gap": {"held_out_before": 0.1, "held_out_after": 0.05, "shrink": 0.5, "saturated": false}})";
  const Answer answer = read_answer(good);
  CHECK(answer.named.at(0).id == "wear");
  CHECK(answer.shrink == 0.5);
  const auto replaced = [&](const std::string& from, const std::string& to) {
    std::string text = good;
    return text.replace(text.find(from), from.size(), to);
  };
  CHECK_THROWS_AS(read_answer("{"), std::runtime_error);
  CHECK_THROWS_AS(read_answer(replaced("\"NAMED\"", "\"SURE\"")), std::runtime_error);
  CHECK_THROWS_AS(read_answer(replaced("\"NAMED\"", "\"NO_GAP\"")),
                  std::runtime_error);  // but effects are named
  CHECK_THROWS_AS(read_answer(replaced("0.9", "1.9")), std::runtime_error);
  CHECK_THROWS_AS(read_answer(replaced("candidate_set", "candidates")), std::runtime_error);
}

TEST_CASE("the page of the blind test lists every case that went wrong", "[blind]") {
  Scored scored;
  scored.manifest.campaign = "smoke";
  scored.cases = example();
  const std::string text = page({scored});
  for (const std::string row : {"| 4 | single | orientation", "| 5 | single | shear_heating",
                                "| 7 | null_exact | nothing", "| 10 | rig | load_cell_offset"}) {
    CHECK(text.find(row) != std::string::npos);
  }
  CHECK(text.find("| 1 | single") == std::string::npos);

  const std::string header = history_header(), line = history_lines(scored, "2026-01-01");
  CHECK(std::ranges::count(header, ',') == std::ranges::count(line, ','));
  CHECK(std::ranges::count(line, '\n') == 1);
  scored.cases[0].planned.spec.amplitude = 0.5;
  CHECK(std::ranges::count(history_lines(scored, "2026-01-01"), '\n') == 2);
}
