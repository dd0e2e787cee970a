#include "mesoscale/weave.h"

#include <algorithm>
#include <array>
#include <numeric>
#include <regex>
#include <sstream>

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

bool is_over(const WeaveMatrix& weave, bool is_warp, int tow, int crossing) {
  return is_warp ? weave.warp_over(tow, crossing) : !weave.warp_over(crossing, tow);
}

std::string fault_of_loose_tow(const WeaveMatrix& weave) {
  for (const bool is_warp : {true, false}) {
    const int crossings = is_warp ? weave.wefts : weave.warps;
    for (int tow = 0; tow < (is_warp ? weave.warps : weave.wefts); ++tow) {
      int over = 0;
      for (int k = 0; k < crossings; ++k) over += is_over(weave, is_warp, tow, k);
      if (over == 0 || over == crossings)
        return fmt::format("{} {} is {} every {}: it never changes sides and lies loose",
                           is_warp ? "warp" : "weft", tow + 1, over == 0 ? "under" : "over",
                           is_warp ? "weft" : "warp");
    }
  }
  return "";
}

// Tows, warps first, reached from warp 0 by stepping to tows that lie over the tow at hand (upwards) or under
// it. If some are missing, those that were reached lie over (or under) them at every crossing.
std::vector<bool> reached(const WeaveMatrix& weave, bool upwards) {
  std::vector<bool> seen(static_cast<std::size_t>(weave.warps + weave.wefts), false);
  std::vector<int> open{0};
  seen[0] = true;
  while (!open.empty()) {
    const int tow = open.back();
    open.pop_back();
    const bool is_warp = tow < weave.warps;
    for (int k = 0; k < (is_warp ? weave.wefts : weave.warps); ++k) {
      const int other = is_warp ? weave.warps + k : k;
      const bool other_is_over = !is_over(weave, is_warp, is_warp ? tow : tow - weave.warps, k);
      if (other_is_over == upwards && !seen[static_cast<std::size_t>(other)]) {
        seen[static_cast<std::size_t>(other)] = true;
        open.push_back(other);
      }
    }
  }
  return seen;
}

std::string names_of(const WeaveMatrix& weave, const std::vector<bool>& group) {
  std::string names;
  for (std::size_t k = 0; k < group.size(); ++k) {
    const int tow = static_cast<int>(k), weft = tow - weave.warps;
    if (group[k])
      names += fmt::format("{}{} {}", names.empty() ? "" : ", ", weft < 0 ? "warp" : "weft",
                           weft < 0 ? tow + 1 : weft + 1);
  }
  return names;
}

std::string fault_of_layers(const WeaveMatrix& weave) {
  for (const bool upwards : {true, false}) {
    std::vector<bool> upper = reached(weave, upwards);
    if (std::find(upper.begin(), upper.end(), false) == upper.end()) continue;
    if (!upwards) upper.flip();  // what was not reached by going down lies above
    return fmt::format("{} lie over all other tows at every crossing: the weave falls apart in layers",
                       names_of(weave, upper));
  }
  return "";
}

bool repeats_after(const WeaveMatrix& weave, int warps, int wefts) {
  for (int i = 0; i < weave.warps; ++i)
    for (int j = 0; j < weave.wefts; ++j)
      if (weave.warp_over(i, j) != weave.warp_over(i + warps, j + wefts)) return false;
  return true;
}

ParsedWeave misread(std::string fault) {
  return {{}, std::move(fault), false};
}

ParsedWeave checked(WeaveMatrix weave) {
  std::string fault = fault_of_weave(weave);
  const bool falls_apart = !fault.empty();
  return {smallest_repeat(weave), std::move(fault), falls_apart};
}

ParsedWeave parse_twill(int over, int under, int step) {
  if (over < 1 || under < 1) return misread("twill m/n must satisfy m >= 1 and n >= 1");
  if (over + under > most_tows)
    return misread(fmt::format("a twill repeats after m + n = {} tows, but at most {} are handled",
                               over + under, most_tows));
  if (step < 1 || step >= over + under) return misread("twill m/n step s must satisfy 1 <= s < m + n");
  return checked(twill_weave(over, under, step));
}

ParsedWeave parse_satin(int repeat, int step) {
  if (repeat > most_tows)
    return misread(
        fmt::format("a satin repeats after N = {} tows, but at most {} are handled", repeat, most_tows));
  if (repeat == 4) return misread("no step makes a satin of four tows; its broken order is called crowfoot");
  if (step <= 1 || step >= repeat - 1) return misread("satin N/k must satisfy 1 < k < N - 1");
  if (std::gcd(repeat, step) != 1) return misread("satin N/k needs N and k without a common divisor");
  return checked(satin_weave(repeat, step));
}

ParsedWeave parse_matrix(const std::string& rows) {
  WeaveMatrix weave;
  std::istringstream stream(rows);
  for (std::string row; std::getline(stream, row, '/'); ++weave.warps) {
    const int length = static_cast<int>(row.size());
    if (weave.warps == 0) weave.wefts = length;
    if (length != weave.wefts)
      return misread(fmt::format("every row needs as many entries, but row 1 has {} and row {} has {}",
                                 weave.wefts, weave.warps + 1, length));
    for (const char bit : row) weave.warp_above.push_back(bit == '1' ? 1 : 0);
  }
  if (weave.warps > most_tows || weave.wefts > most_tows)
    return misread(fmt::format("the matrix has {} rows and {} columns, but at most {} are handled each way",
                               weave.warps, weave.wefts, most_tows));
  return checked(std::move(weave));
}

}  // namespace

bool WeaveMatrix::warp_over(int warp, int weft) const {
  return warp_above[static_cast<std::size_t>(wrap(warp, warps)) * wefts + wrap(weft, wefts)] != 0;
}

WeaveMatrix plain_weave() {
  return fill(2, [](int i, int j) { return (i + j) % 2 == 1; });
}

WeaveMatrix twill_weave(int over, int under, int step) {
  return fill(over + under, [=](int i, int j) { return (i + step * j) % (over + under) < over; });
}

WeaveMatrix satin_weave(int repeat, int step) {
  return fill(repeat, [=](int i, int j) { return i == (step * j) % repeat; });
}

WeaveMatrix crowfoot_weave() {
  constexpr std::array<int, 4> order{0, 1, 3, 2};
  return fill(4, [=](int i, int j) { return i == order[static_cast<std::size_t>(j)]; });
}

ParsedWeave parse_weave(const std::string& text) {
  if (text == "plain") return checked(plain_weave());
  if (text == "crowfoot") return checked(crowfoot_weave());
  static const std::regex twill("twill ([0-9]{1,3})/([0-9]{1,3})( step ([0-9]{1,3}))?");
  static const std::regex satin("satin ([0-9]{1,3})/([0-9]{1,3})");
  static const std::regex matrix("matrix ([01]+(/[01]+)*)");
  std::smatch m;
  if (std::regex_match(text, m, twill))
    return parse_twill(std::stoi(m[1]), std::stoi(m[2]), m[4].matched ? std::stoi(m[4]) : 1);
  if (std::regex_match(text, m, satin)) return parse_satin(std::stoi(m[1]), std::stoi(m[2]));
  if (std::regex_match(text, m, matrix)) return parse_matrix(m[1]);
  return misread("must be plain, twill m/n, twill m/n step s, satin N/k, crowfoot or matrix");
}

Problems check_pattern(const std::string& text) {
  const ParsedWeave parsed = parse_weave(text);
  if (parsed.fault.empty()) return {};
  if (parsed.falls_apart)
    return {{"weave.pattern.falls_apart"_rule,
             "weave.pattern",
             text,
             parsed.fault,
             "Each tow must be over some and under some of those it crosses, and no group over all others.",
             "",
             0,
             {"weave.matrix"}}};
  return {{"weave.pattern.unknown"_rule,
           "weave.pattern",
           text,
           parsed.fault,
           "Write plain, twill 2/2, twill 3/1 step 3, satin 8/3, crowfoot, or matrix with "
           "weave.matrix: [[1, 0], [0, 1]].",
           "",
           0,
           {"weave.matrix"}}};
}

std::string fault_of_weave(const WeaveMatrix& weave) {
  if (weave.warps < 2 || weave.wefts < 2) return "a repeat needs two or more tows each way";
  if (weave.warp_above.size() != static_cast<std::size_t>(weave.warps) * weave.wefts)
    return "the matrix must have warps x wefts entries";
  if (std::string loose = fault_of_loose_tow(weave); !loose.empty()) return loose;
  return fault_of_layers(weave);
}

WeaveMatrix smallest_repeat(const WeaveMatrix& weave) {
  int warps = 1, wefts = 1;
  while (weave.warps % warps != 0 || !repeats_after(weave, warps, 0)) ++warps;
  while (weave.wefts % wefts != 0 || !repeats_after(weave, 0, wefts)) ++wefts;
  WeaveMatrix small{warps, wefts, {}};
  for (int i = 0; i < warps; ++i)
    for (int j = 0; j < wefts; ++j) small.warp_above.push_back(weave.warp_over(i, j) ? 1 : 0);
  return small;
}

bool alike_both_ways(const WeaveMatrix& weave) {
  if (weave.warps != weave.wefts) return false;
  const int n = weave.warps;
  const auto same_from = [&](int shift_i, int shift_j, int hand, bool flipped) {
    for (int i = 0; i < n; ++i)
      for (int j = 0; j < n; ++j)
        if (weave.warp_over(i, j) != (weave.warp_over(hand * j + shift_i, i + shift_j) != flipped))
          return false;
    return true;
  };
  for (int i = 0; i < n; ++i)
    for (int j = 0; j < n; ++j)
      for (const int hand : {1, -1})
        for (const bool flipped : {true, false})
          if (same_from(i, j, hand, flipped)) return true;
  return false;
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
          if (over)
            shares[0][warp_floats][weft_floats] += quarter;
          else
            shares[1][weft_floats][warp_floats] += quarter;
        }
  return shares;
}

FloatShares float_shares(const QuarterShares& quarters) {
  FloatShares shares{};
  for (std::size_t warp = 0; warp < 2; ++warp)
    for (std::size_t weft = 0; weft < 2; ++weft)
      shares[warp][weft] = quarters[0][warp][weft] + quarters[1][weft][warp];
  return shares;
}

std::vector<QuarterKind> quarter_kinds(const QuarterShares& quarters, bool faces_alike) {
  const FloatShares either = float_shares(quarters);
  std::vector<QuarterKind> kinds;
  for (std::size_t top = 0; top < (faces_alike ? 1 : 2); ++top)
    for (std::size_t warp = 0; warp < 2; ++warp)
      for (std::size_t weft = 0; weft < 2; ++weft) {
        const double share = faces_alike ? either[warp][weft]
                             : top == 0  ? quarters[0][warp][weft]
                                         : quarters[1][weft][warp];
        if (share > 0.0) kinds.push_back({top, {warp == 1, weft == 1}, share});
      }
  return kinds;
}

}  // namespace heddle::mesoscale
