// What a failed stamping is told to set must be there to be set.
#include <algorithm>
#include <catch2/catch.hpp>
#include <regex>
#include <string>

#include "macroscale/advice.h"
#include "pipeline/config_schema.h"

using namespace heddle;
using macroscale::FailureKind;

namespace {

/// Every advice there is, one after the other.
std::string all_advice() {
  macroscale::StampingSpec spec;
  macroscale::StampingFailure failure;
  macroscale::StampingSummary summary;
  std::string text;
  for (const bool falling : {false, true})
    for (const int step : {0, 7})
      for (const auto kind :
           {FailureKind::search, FailureKind::indefinite, FailureKind::friction_loads, FailureKind::folded,
            FailureKind::pressed_through, FailureKind::lost_tool, FailureKind::not_finite}) {
        failure.step = step;
        failure.kind = kind;
        summary.falling_branch = falling;
        text += macroscale::advice_for(failure, spec, summary) + "\n";
      }
  return text;
}

}  // namespace

TEST_CASE("every key that the advice after a failure names is in the schema, with values it may have",
          "[config][advice]") {
  const std::string text = all_advice();
  const std::regex key_value(R"(([a-z_]+(?:\.(?:[a-z_]+|\*))+)(?:(?:: |=)([a-z_]+))?)");
  int keys = 0, values = 0;
  for (std::sregex_iterator at(text.begin(), text.end(), key_value), end; at != end; ++at) {
    const std::string path = std::regex_replace((*at)[1].str(), std::regex(R"(\*)"), "punch");
    if (path == "fabric.json" || path.ends_with(".vtu")) continue;  // files
    CAPTURE(path);
    const pipeline::Key* key = pipeline::find_key(path);
    REQUIRE(key != nullptr);
    ++keys;
    if (!(*at)[2].matched || key->choices.empty()) continue;
    CAPTURE((*at)[2].str());
    CHECK(std::ranges::count(key->choices, (*at)[2].str()) == 1);
    ++values;
  }
  CHECK(keys > 20);
  CHECK(values >= 2);
}
