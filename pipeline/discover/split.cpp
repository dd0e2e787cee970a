#include "pipeline/discover/split.h"

#include <algorithm>
#include <cmath>
#include <map>
#include <set>

#include "pipeline/discover/random.h"

namespace heddle::discover {

namespace {

/// Level of each factor but the day, as a number that is the same for conditions meant alike.
std::vector<long> levels_of(const CouponCell& cell) {
  std::vector<long> levels;
  for (const Factor& factor : factors())
    if (std::string(factor.name) != "day") levels.push_back(std::lround(20.0 * factor.of(cell)));
  return levels;
}

struct Condition {
  std::size_t number = 0;
  std::vector<std::size_t> cells;
  std::vector<long> levels;
  int away = 0;  ///< factors in which it differs from the most repeated one
};

std::vector<Condition> conditions_of(const CouponCampaign& campaign) {
  std::map<std::size_t, Condition> by_number;
  for (std::size_t c = 0; c < campaign.cells.size(); ++c) {
    Condition& condition = by_number[campaign.cells[c].condition];
    condition.number = campaign.cells[c].condition;
    condition.cells.push_back(c);
    if (condition.levels.empty()) condition.levels = levels_of(campaign.cells[c]);
  }
  std::vector<Condition> conditions;
  for (auto& [number, condition] : by_number) conditions.push_back(std::move(condition));
  const auto anchor =
      std::ranges::max_element(conditions, {}, [](const Condition& c) { return c.cells.size(); });
  for (Condition& condition : conditions)
    for (std::size_t f = 0; f < condition.levels.size(); ++f)
      condition.away += condition.levels[f] != anchor->levels[f] ? 1 : 0;
  return conditions;
}

/// Whether every level of every factor keeps a condition in training.
bool leaves_every_level(const std::vector<Condition>& conditions, const std::set<std::size_t>& out,
                        const Condition& candidate) {
  for (std::size_t f = 0; f < candidate.levels.size(); ++f) {
    const bool kept = std::ranges::any_of(conditions, [&](const Condition& other) {
      return other.number != candidate.number && !out.contains(other.number) &&
             other.levels[f] == candidate.levels[f];
    });
    if (!kept) return false;
  }
  return true;
}

}  // namespace

Split split_conditions(const CouponCampaign& campaign, double share, std::uint64_t seed) {
  std::vector<Condition> conditions = conditions_of(campaign);
  const std::size_t most =
      std::ranges::max(conditions, {}, [](const Condition& c) { return c.cells.size(); }).cells.size();
  std::set<std::size_t> out;
  if (conditions.size() >= 8 && share > 0.0) {
    const auto wanted = static_cast<std::size_t>(std::lround(share * static_cast<double>(conditions.size())));
    std::vector<std::size_t> order(conditions.size());
    for (std::size_t k = 0; k < order.size(); ++k) order[k] = k;
    Random random(seed);
    random.shuffle(order);
    // Two corners first, the others as they are drawn.
    std::ranges::stable_sort(order, std::greater{}, [&](std::size_t k) { return conditions[k].away; });
    if (order.size() > 2) {
      std::vector<std::size_t> rest(order.begin() + 2, order.end());
      std::ranges::sort(rest);
      random.shuffle(rest);
      std::ranges::copy(rest, order.begin() + 2);
    }
    for (const std::size_t k : order) {
      if (out.size() == wanted) break;
      const Condition& condition = conditions[k];
      if (most > 1 && condition.cells.size() == most) continue;  // the anchors tell the scatter of days
      if (leaves_every_level(conditions, out, condition)) out.insert(condition.number);
    }
  }
  Split split;
  for (std::size_t c = 0; c < campaign.cells.size(); ++c)
    (out.contains(campaign.cells[c].condition) ? split.held_out : split.training).push_back(c);
  return split;
}

std::vector<CouponCell> pick(const std::vector<CouponCell>& cells, const std::vector<std::size_t>& indices) {
  std::vector<CouponCell> picked;
  for (const std::size_t index : indices) picked.push_back(cells[index]);
  return picked;
}

}  // namespace heddle::discover
