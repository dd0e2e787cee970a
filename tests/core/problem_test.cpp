#include "core/problem.h"

#include <catch2/catch.hpp>
#include <string>
#include <string_view>
#include <type_traits>

using heddle::Problem;
using heddle::Rule;
using heddle::RuleFamily;
using heddle::RuleId;
using heddle::operator""_rule;
using heddle::operator""_family;

TEST_CASE("problems are listed by file and line with rule and way out", "[core][problem]") {
  const heddle::Problems problems{Problem{.id = "friction.film.index.range"_rule,
                                          .key = "friction.film.index",
                                          .value = "1.7",
                                          .rule = "must satisfy 0 < n <= 1",
                                          .way_out = "The resin thins with rate (Gorczyca et al., Eq. 4).",
                                          .file = "configs/stamping.yaml",
                                          .line = 14},
                                  Problem{.id = "weave.gap.range"_rule,
                                          .key = "weave.gap",
                                          .value = "0.75 m",
                                          .rule = "must satisfy 0 <= gap < 0.1 m",
                                          .way_out = "Table 1 gives 0.75 mm; write 0.75 mm.",
                                          .file = "configs/stamping.yaml",
                                          .line = 6},
                                  Problem{.id = "key.unknown"_rule,
                                          .key = "weave.gpa",
                                          .value = "",
                                          .rule = "is not a known key",
                                          .way_out = "",
                                          .file = "--set #2"}};
  CHECK(heddle::format(problems) ==
        "configs/stamping.yaml: 2 problem(s)\n"
        "  weave.gap (line 6) = 0.75 m   must satisfy 0 <= gap < 0.1 m\n"
        "    Table 1 gives 0.75 mm; write 0.75 mm.\n"
        "  friction.film.index (line 14) = 1.7   must satisfy 0 < n <= 1\n"
        "    The resin thins with rate (Gorczyca et al., Eq. 4).\n"
        "--set #2: 1 problem(s)\n"
        "  weave.gpa   is not a known key\n");
}

TEST_CASE("an input error carries every problem and says them all", "[core][problem]") {
  const heddle::InputError error(
      {Problem{.id = "a"_rule, .key = "first", .value = "", .rule = "is wrong", .way_out = ""},
       Problem{.id = "b"_rule, .key = "second", .value = "", .rule = "is wrong too", .way_out = ""}});
  CHECK(error.problems().size() == 2);
  CHECK(std::string(error.what()).find("input: 2 problem(s)") == 0);
  CHECK(std::string(error.what()).find("second   is wrong too") != std::string::npos);
}

// The list of all rules is read from the source (tests/pipeline/rule_list_test.cpp): no name may be made
// elsewhere.
static_assert(!std::is_constructible_v<RuleId, std::string> && !std::is_constructible_v<RuleId, const char*>);
static_assert(!std::is_constructible_v<RuleId, std::string, std::string_view>);
static_assert(!std::is_constructible_v<Rule, const char*> &&
              !std::is_constructible_v<Rule, std::string_view>);
static_assert(!std::is_constructible_v<RuleFamily, const char*>);
static_assert(!std::is_convertible_v<RuleFamily, RuleId>);  // a family says of which key

TEST_CASE("the id of a family holds the key where its name has the star", "[core][problem]") {
  const RuleId range = "*.range"_family.of("weave.gap");
  CHECK(range == "weave.gap.range");
  CHECK(range.name() == "*.range");
  CHECK("tools.*.passage"_family.of("die") == "tools.die.passage");
  CHECK("*.anchor"_family.of("") == "anchor");  // of the file as a whole
  const RuleId alone = "yaml.syntax"_rule;
  CHECK(alone == "yaml.syntax");
  CHECK(alone.name() == "yaml.syntax");
}
