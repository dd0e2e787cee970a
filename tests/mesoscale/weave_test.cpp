#include <catch2/catch.hpp>
#include <string>

#include "mesoscale/weave.h"

using namespace heddle::mesoscale;

TEST_CASE("every named weave is a fabric that holds together", "[weave]") {
  const std::string text = GENERATE("plain", "twill 1/1", "twill 2/1", "twill 1/3", "twill 2/2", "twill 3/1",
                                    "satin 5/2", "satin 5/3", "satin 7/2", "satin 8/3", "satin 8/5");
  CAPTURE(text);
  const ParsedWeave parsed = parse_weave(text);
  CHECK(parsed.fault.empty());
  CHECK(fault_of_weave(parsed.weave).empty());
}

TEST_CASE("a text that names no weave is refused with the rule it breaks", "[weave]") {
  CHECK(parse_weave("basket").fault == "must be plain, twill m/n or satin N/k");
  CHECK(parse_weave("twill 2-2").fault == "must be plain, twill m/n or satin N/k");
  CHECK(parse_weave("twill 0/2").fault == "twill m/n must satisfy m >= 1 and n >= 1");
  CHECK(parse_weave("satin 5/1").fault == "satin N/k must satisfy 1 < k < N - 1");
  CHECK(parse_weave("satin 5/4").fault == "satin N/k must satisfy 1 < k < N - 1");
  CHECK(parse_weave("satin 8/2").fault == "satin N/k needs N and k without a common divisor");
}

TEST_CASE("a tow that never changes sides is found", "[weave]") {
  const WeaveMatrix loose_warp{2, 2, {1, 1, 0, 1}};
  CHECK(fault_of_weave(loose_warp) == "warp 0 never changes sides");
  const WeaveMatrix loose_weft{3, 3, {1, 0, 1, 1, 1, 0, 1, 0, 0}};
  CHECK(fault_of_weave(loose_weft) == "weft 0 never changes sides");
}

TEST_CASE("two layers that lie on each other without a tow in common are no fabric", "[weave]") {
  // Warps 0, 1 weave with wefts 0, 1, and warps 2, 3 with wefts 2, 3; the first group lies over the second.
  const WeaveMatrix layers{4,
                           4,
                           {1, 0, 1, 1,  //
                            0, 1, 1, 1,  //
                            0, 0, 1, 0,  //
                            0, 0, 0, 1}};
  CHECK(fault_of_weave(layers) == "a group of tows lies over all others everywhere, so it lifts off");
}

TEST_CASE("tows change sides at every step of a plain weave, and twice a repeat of a satin", "[weave]") {
  CHECK(interlacing(plain_weave())[0] == 1.0);
  CHECK(interlacing(twill_weave(2, 2))[1] == 0.5);
  CHECK(interlacing(satin_weave(8, 3))[0] == 0.25);
  CHECK(interlacing(satin_weave(8, 3))[1] == 0.25);
}

TEST_CASE("quarter crossings add to one, and none floats in a plain weave", "[weave]") {
  for (const WeaveMatrix& weave : {plain_weave(), twill_weave(2, 2), satin_weave(8, 3)}) {
    const QuarterShares q = quarter_shares(weave);
    CHECK(q[0][0] + q[0][1] + q[1][0] + q[1][1] == Approx(1.0).epsilon(1e-14));
  }
  CHECK(quarter_shares(plain_weave())[0][0] == 1.0);
}
