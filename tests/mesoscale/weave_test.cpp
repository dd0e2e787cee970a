#include <array>
#include <catch2/catch.hpp>
#include <string>

#include "mesoscale/weave.h"

using namespace heddle::mesoscale;

TEST_CASE("every named weave is a fabric that holds together", "[weave]") {
  const std::string text = GENERATE("plain", "twill 1/1", "twill 2/1", "twill 1/3", "twill 2/2", "twill 3/1",
                                    "twill 2/2 step 2", "twill 2/2 step 3", "twill 2/3 step 2", "crowfoot",
                                    "satin 5/2", "satin 5/3", "satin 7/2", "satin 8/3", "satin 8/5");
  CAPTURE(text);
  const ParsedWeave parsed = parse_weave(text);
  CHECK(parsed.fault.empty());
  CHECK_FALSE(parsed.falls_apart);
  CHECK(fault_of_weave(parsed.weave).empty());
}

TEST_CASE("a text that names no weave is refused with the rule it breaks", "[weave]") {
  const std::string known = "must be plain, twill m/n, twill m/n step s, satin N/k, crowfoot or matrix";
  CHECK(parse_weave("basket").fault == known);
  CHECK(parse_weave("twill 2-2").fault == known);
  CHECK(parse_weave("matrix").fault == known);
  CHECK(parse_weave("matrix 10/02").fault == known);
  CHECK(parse_weave("twill 0/2").fault == "twill m/n must satisfy m >= 1 and n >= 1");
  CHECK(parse_weave("twill 2/2 step 0").fault == "twill m/n step s must satisfy 1 <= s < m + n");
  CHECK(parse_weave("twill 2/2 step 4").fault == "twill m/n step s must satisfy 1 <= s < m + n");
  CHECK(parse_weave("twill 20/13").fault ==
        "a twill repeats after m + n = 33 tows, but at most 32 are handled");
  CHECK(parse_weave("satin 5/1").fault == "satin N/k must satisfy 1 < k < N - 1");
  CHECK(parse_weave("satin 5/4").fault == "satin N/k must satisfy 1 < k < N - 1");
  CHECK(parse_weave("satin 8/2").fault == "satin N/k needs N and k without a common divisor");
  CHECK(parse_weave("satin 4/2").fault ==
        "no step makes a satin of four tows; its broken order is called crowfoot");
  CHECK(parse_weave("satin 33/2").fault == "a satin repeats after N = 33 tows, but at most 32 are handled");
  CHECK(parse_weave("matrix 101/01/110").fault ==
        "every row needs as many entries, but row 1 has 3 and row 2 has 2");
  CHECK(parse_weave("matrix " + std::string(33, '1')).fault ==
        "the matrix has 1 rows and 33 columns, but at most 32 are handled each way");
}

TEST_CASE("a tow that never changes sides is found and named", "[weave]") {
  const WeaveMatrix loose_warp{2, 2, {1, 1, 0, 1}};
  CHECK(fault_of_weave(loose_warp) == "warp 1 is over every weft: it never changes sides and lies loose");
  const WeaveMatrix loose_weft{3, 3, {1, 0, 1, 1, 1, 0, 1, 0, 0}};
  CHECK(fault_of_weave(loose_weft) == "weft 1 is under every warp: it never changes sides and lies loose");
  CHECK(parse_weave("matrix 101/010/000").falls_apart);
  // Every second warp would never be over.
  CHECK(parse_weave("twill 1/3 step 2").fault ==
        "warp 2 is under every weft: it never changes sides and lies loose");
}

TEST_CASE("two layers that lie on each other without a tow in common are no fabric", "[weave]") {
  // Warps 1, 2 weave with wefts 1, 2, and warps 3, 4 with wefts 3, 4; the first group lies over the second.
  const WeaveMatrix layers{4,
                           4,
                           {1, 0, 1, 1,  //
                            0, 1, 1, 1,  //
                            0, 0, 1, 0,  //
                            0, 0, 0, 1}};
  const std::string upper =
      "warp 1, warp 2, weft 1, weft 2 lie over all other tows at every crossing: the weave falls apart in "
      "layers";
  CHECK(fault_of_weave(layers) == upper);
  // The same with the layers changed: the search starts from a tow of the lower one.
  const WeaveMatrix swapped{4,
                            4,
                            {1, 0, 0, 0,  //
                             0, 1, 0, 0,  //
                             1, 1, 1, 0,  //
                             1, 1, 0, 1}};
  CHECK(fault_of_weave(swapped) ==
        "warp 3, warp 4, weft 3, weft 4 lie over all other tows at every crossing: the weave falls apart in "
        "layers");
}

TEST_CASE("a named weave and its matrix are the same weave", "[weave]") {
  const auto same = [](const std::string& name, const std::string& matrix) {
    const WeaveMatrix a = parse_weave(name).weave, b = parse_weave("matrix " + matrix).weave;
    CHECK(a.warps == b.warps);
    CHECK(a.wefts == b.wefts);
    CHECK(a.warp_above == b.warp_above);
  };
  same("plain", "01/10");
  same("twill 2/2", "1100/1001/0011/0110");
  same("crowfoot", "1000/0100/0001/0010");
  same("satin 5/2", "10000/00010/01000/00001/00100");
}

TEST_CASE("a matrix that repeats a smaller one is read as that", "[weave]") {
  const WeaveMatrix twice = parse_weave("matrix 0101/1010/0101/1010").weave;
  CHECK(twice.warps == 2);
  CHECK(twice.wefts == 2);
  CHECK(twice.warp_above == plain_weave().warp_above);
  // A rib: pairs of warps run together, so that two wefts are a repeat but four warps.
  const WeaveMatrix rib = parse_weave("twill 2/2 step 2").weave;
  CHECK(rib.warps == 4);
  CHECK(rib.wefts == 2);
  CHECK(interlacing(rib) == std::array<double, 2>{1.0, 0.5});
}

TEST_CASE("tows change sides at every step of a plain weave, and twice a repeat of a satin", "[weave]") {
  CHECK(interlacing(plain_weave())[0] == 1.0);
  CHECK(interlacing(twill_weave(2, 2))[1] == 0.5);
  CHECK(interlacing(satin_weave(8, 3))[0] == 0.25);
  CHECK(interlacing(satin_weave(8, 3))[1] == 0.25);
}

TEST_CASE("quarter crossings add to one, and none floats in a plain weave", "[weave]") {
  for (const WeaveMatrix& weave : {plain_weave(), twill_weave(2, 2), satin_weave(8, 3)}) {
    const FloatShares q = float_shares(quarter_shares(weave));
    CHECK(q[0][0] + q[0][1] + q[1][0] + q[1][1] == Approx(1.0).epsilon(1e-14));
  }
  CHECK(float_shares(quarter_shares(plain_weave())) == no_floats);
}

TEST_CASE("the tow on top of a satin that shows its wefts is a warp at one crossing in eight", "[weave]") {
  const QuarterShares q = quarter_shares(satin_weave(8, 3));
  double warp_on_top = 0.0;
  for (const auto& row : q[0])
    for (const double share : row) warp_on_top += share;
  CHECK(warp_on_top == Approx(1.0 / 8.0));
  // Where the warp is on top, it dives on both sides, and so does the weft.
  CHECK(q[0][0][0] == Approx(1.0 / 8.0));
}

TEST_CASE("warp and weft can be exchanged in plain, twill, satin and crowfoot, but not in a rib", "[weave]") {
  for (const char* text :
       {"plain", "twill 2/2", "twill 3/1", "twill 2/1", "satin 5/2", "satin 8/3", "crowfoot"})
    CHECK(alike_both_ways(parse_weave(text).weave));
  CHECK_FALSE(alike_both_ways(parse_weave("twill 2/2 step 2").weave));
}
