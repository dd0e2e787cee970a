#pragma once

#include <array>
#include <cstdint>
#include <string>
#include <vector>

namespace heddle::mesoscale {

/// One repeat of a weave: which tow is on top at every crossing.
struct WeaveMatrix {
  int warps = 0;                         ///< tows along axis 1 in one repeat
  int wefts = 0;                         ///< tows along axis 2 in one repeat
  std::vector<std::uint8_t> warp_above;  ///< warps x wefts, row-major; 1 = the warp is over the weft

  /// Indices may lie outside the repeat, negative ones included.
  bool warp_over(int warp, int weft) const;
};

/// plain: (i + j) mod 2; twill m/n: (i + j) mod (m + n) < m; satin N/k: i == k j mod N.
WeaveMatrix plain_weave();
WeaveMatrix twill_weave(int over, int under);
WeaveMatrix satin_weave(int repeat, int step);

struct ParsedWeave {
  WeaveMatrix weave;
  std::string fault;  ///< "" if the text names a weave; else the rule it breaks
};
/// @param text  "plain", "twill m/n" or "satin N/k"
ParsedWeave parse_weave(const std::string& text);

/// First thing that keeps the matrix from being a fabric, or "". A tow that never changes sides is loose; and
/// if a group of tows lies over all others everywhere, it lifts off (the "is over" graph is not strongly
/// connected).
std::string fault_of_weave(const WeaveMatrix& weave);

/// Share of the steps between neighbouring crossings at which a tow changes sides, {warp, weft} [-];
/// plain: 1.
std::array<double, 2> interlacing(const WeaveMatrix& weave);

/// Share of the quarter crossings whose {upper, lower} tow floats (keeps its side) towards the next crossing:
/// weight[upper floats][lower floats]; the four add to 1.
using QuarterShares = std::array<std::array<double, 2>, 2>;
QuarterShares quarter_shares(const WeaveMatrix& weave);

}  // namespace heddle::mesoscale
