#include "mesoscale/weave.h"

#include <numeric>
#include <regex>

#include <fmt/format.h>

namespace heddle::mesoscale {

namespace {

int wrap(int index, int size) {
  const int rest = index % size;
  return rest < 0 ? rest + size : rest;
}

template <class IsOver>
WeaveMatrix fill(int size, const IsOver& is_over) {
  WeaveMatrix weave{size, size, std::vector<std::uint8_t>(static_cast<std::size_t>(size) * size)};
  for (int i = 0; i < size; ++i)
    for (int j = 0; j < size; ++j)
      weave.warp_above[static_cast<std::size_t>(i) * size + j] = is_over(i, j) ? 1 : 0;
  return weave;
}

std::string fault_of_loose_tow(const WeaveMatrix& weave) {
  for (int i = 0; i < weave.warps; ++i) {
    int over = 0;
    for (int j = 0; j < weave.wefts; ++j) over += weave.warp_over(i, j);
    if (over == 0 || over == weave.wefts) return fmt::format("warp {} never changes sides", i);
  }
  for (int j = 0; j < weave.wefts; ++j) {
    int over = 0;
    for (int i = 0; i < weave.warps; ++i) over += weave.warp_over(i, j);
    if (over == 0 || over == weave.warps) return fmt::format("weft {} never changes sides", j);
  }
  return "";
}

// Tows reached from warp 0 by stepping to tows that lie over (upwards) or under the tow at hand.
int reached(const WeaveMatrix& weave, bool upwards) {
  std::vector<std::uint8_t> seen(static_cast<std::size_t>(weave.warps + weave.wefts), 0);
  std::vector<int> open{0};
  seen[0] = 1;
  int count = 0;
  while (!open.empty()) {
    const int tow = open.back();
    open.pop_back();
    ++count;
    const bool is_warp = tow < weave.warps;
    for (int k = 0; k < (is_warp ? weave.wefts : weave.warps); ++k) {
      const int other = is_warp ? weave.warps + k : k;
      const bool warp_is_over = is_warp ? weave.warp_over(tow, k) : weave.warp_over(k, tow - weave.warps);
      const bool other_is_over = is_warp ? !warp_is_over : warp_is_over;
      if (other_is_over == upwards && !seen[static_cast<std::size_t>(other)]) {
        seen[static_cast<std::size_t>(other)] = 1;
        open.push_back(other);
      }
    }
  }
  return count;
}

}  // namespace

bool WeaveMatrix::warp_over(int warp, int weft) const {
  return warp_above[static_cast<std::size_t>(wrap(warp, warps)) * wefts + wrap(weft, wefts)] != 0;
}

WeaveMatrix plain_weave() {
  return fill(2, [](int i, int j) { return (i + j) % 2 == 1; });
}

WeaveMatrix twill_weave(int over, int under) {
  return fill(over + under, [=](int i, int j) { return (i + j) % (over + under) < over; });
}

WeaveMatrix satin_weave(int repeat, int step) {
  return fill(repeat, [=](int i, int j) { return i == (step * j) % repeat; });
}

ParsedWeave parse_weave(const std::string& text) {
  if (text == "plain") return {plain_weave(), ""};
  // Two digits are plenty: a repeat of 99 tows is half a metre wide.
  static const std::regex form("(twill|satin) ([0-9]{1,2})/([0-9]{1,2})");
  std::smatch match;
  if (!std::regex_match(text, match, form)) return {{}, "must be plain, twill m/n or satin N/k"};
  const int first = std::stoi(match[2]), second = std::stoi(match[3]);
  if (match[1] == "twill") {
    if (first < 1 || second < 1) return {{}, "twill m/n must satisfy m >= 1 and n >= 1"};
    return {twill_weave(first, second), ""};
  }
  if (second <= 1 || second >= first - 1) return {{}, "satin N/k must satisfy 1 < k < N - 1"};
  if (std::gcd(first, second) != 1) return {{}, "satin N/k needs N and k without a common divisor"};
  return {satin_weave(first, second), ""};
}

std::string fault_of_weave(const WeaveMatrix& weave) {
  if (weave.warps < 2 || weave.wefts < 2) return "a repeat needs two or more tows each way";
  if (weave.warp_above.size() != static_cast<std::size_t>(weave.warps) * weave.wefts)
    return "the matrix must have warps x wefts entries";
  if (std::string loose = fault_of_loose_tow(weave); !loose.empty()) return loose;
  const int tows = weave.warps + weave.wefts;
  if (reached(weave, true) != tows || reached(weave, false) != tows)
    return "a group of tows lies over all others everywhere, so it lifts off";
  return "";
}

std::array<double, 2> interlacing(const WeaveMatrix& weave) {
  int warp_changes = 0, weft_changes = 0;
  for (int i = 0; i < weave.warps; ++i)
    for (int j = 0; j < weave.wefts; ++j) {
      warp_changes += weave.warp_over(i, j) != weave.warp_over(i, j + 1);
      weft_changes += weave.warp_over(i, j) != weave.warp_over(i + 1, j);
    }
  const double crossings = static_cast<double>(weave.warps) * weave.wefts;
  return {warp_changes / crossings, weft_changes / crossings};
}

QuarterShares quarter_shares(const WeaveMatrix& weave) {
  QuarterShares shares{};
  const double quarter = 0.25 / (static_cast<double>(weave.warps) * weave.wefts);
  for (int i = 0; i < weave.warps; ++i)
    for (int j = 0; j < weave.wefts; ++j)
      for (int step_weft : {-1, 1})
        for (int step_warp : {-1, 1}) {
          const bool over = weave.warp_over(i, j);
          const bool warp_floats = over == weave.warp_over(i, j + step_weft);
          const bool weft_floats = over == weave.warp_over(i + step_warp, j);
          const bool upper = over ? warp_floats : weft_floats;
          const bool lower = over ? weft_floats : warp_floats;
          shares[upper][lower] += quarter;
        }
  return shares;
}

}  // namespace heddle::mesoscale
