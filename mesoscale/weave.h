#pragma once

#include <array>
#include <cstdint>
#include <string>
#include <vector>

#include "core/problem.h"

namespace heddle::mesoscale {

/// One repeat of a weave: which tow is on top at every crossing.
struct WeaveMatrix {
  int warps = 0;                         ///< tows along axis 1 in one repeat
  int wefts = 0;                         ///< tows along axis 2 in one repeat
  std::vector<std::uint8_t> warp_above;  ///< warps x wefts, row-major; 1 = the warp is over the weft

  /// Indices may lie outside the repeat, negative ones included.
  bool warp_over(int warp, int weft) const;
};

/// plain: (i + j) mod 2; twill m/n: (i + s j) mod (m + n) < m; satin N/k: i == k j mod N; crowfoot, the satin
/// of four: i == {0, 1, 3, 2}[j].
WeaveMatrix plain_weave();
WeaveMatrix twill_weave(int over, int under, int step = 1);
WeaveMatrix satin_weave(int repeat, int step);
WeaveMatrix crowfoot_weave();

/// Most tows of a repeat each way: four times the satin of eight.
inline constexpr int most_tows = 32;

struct ParsedWeave {
  WeaveMatrix weave;
  std::string fault;         ///< "" if the text is a weave; else the rule it breaks
  bool falls_apart = false;  ///< the text was understood, but what it says is no fabric
};
/// @param text  "plain", "twill m/n", "twill m/n step s", "satin N/k", "crowfoot" or "matrix 110/011/101": a
///              row a warp, a digit a weft, 1 where the warp is over. A matrix that repeats a smaller one is
///              read as that.
ParsedWeave parse_weave(const std::string& text);
/// The fault of a text as problems of the key weave.pattern: none or one.
Problems check_pattern(const std::string& text);

/// First thing that keeps the matrix from being a fabric, with the tows that clash, or "". A tow that never
/// changes sides is loose; and if a group of tows lies over all others everywhere, it lifts off (the "is
/// over" graph is not strongly connected). Tows are counted from 1.
std::string fault_of_weave(const WeaveMatrix& weave);

/// The smallest repeat of the same weave along its own axes.
WeaveMatrix smallest_repeat(const WeaveMatrix& weave);

/// Whether warp and weft can be exchanged: the weave seen from its other diagonal, perhaps from below or in a
/// mirror, is the same up to where the repeat starts.
bool alike_both_ways(const WeaveMatrix& weave);

/// Share of the steps between neighbouring crossings at which a tow changes sides, {warp, weft} [-];
/// plain: 1.
std::array<double, 2> interlacing(const WeaveMatrix& weave);

/// Share of the quarter crossings by which family is on top (0 = warp, 1 = weft) and whether the {upper,
/// lower} tow floats (keeps its side) towards the next crossing: share[top][upper floats][lower floats]; all
/// add to 1.
using QuarterShares = std::array<std::array<std::array<double, 2>, 2>, 2>;
QuarterShares quarter_shares(const WeaveMatrix& weave);

/// The same whichever is on top: share[warp floats][weft floats].
using FloatShares = std::array<std::array<double, 2>, 2>;
inline constexpr FloatShares no_floats{{{1.0, 0.0}, {0.0, 0.0}}};
FloatShares float_shares(const QuarterShares& quarters);

/// Of the plain weave: nothing floats, either family is on top at every other crossing.
inline constexpr QuarterShares plain_quarters{{{{{0.5, 0.0}, {0.0, 0.0}}}, {{{0.5, 0.0}, {0.0, 0.0}}}}};

struct QuarterKind {
  std::size_t top;             ///< family on top: 0 = warp, 1 = weft
  std::array<bool, 2> floats;  ///< of {warp, weft}
  double share;                ///< > 0; all add to 1
};
/// The kinds of quarter crossing that occur.
/// @param faces_alike  it does not matter which is on top: each kind stands once, as warp on top
std::vector<QuarterKind> quarter_kinds(const QuarterShares& quarters, bool faces_alike);

}  // namespace heddle::mesoscale
