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

const Condition& anchor_of(const std::vector<Condition>& conditions) {
  return *std::ranges::max_element(conditions, {}, [](const Condition& c) { return c.cells.size(); });
}

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
  const std::vector<long> usual = anchor_of(conditions).levels;
  for (Condition& condition : conditions)
    for (std::size_t f = 0; f < condition.levels.size(); ++f)
      condition.away += condition.levels[f] != usual[f] ? 1 : 0;
  return conditions;
}

/// What stays in training has every level of every factor, or, where `between` is allowed, levels on either
/// side of it.
bool may_go(const std::vector<Condition>& conditions, const std::set<std::size_t>& out,
            const Condition& candidate, bool between) {
  for (std::size_t f = 0; f < candidate.levels.size(); ++f) {
    bool kept = false, below = false, above = false;
    for (const Condition& other : conditions) {
      if (other.number == candidate.number || out.contains(other.number)) continue;
      kept = kept || other.levels[f] == candidate.levels[f];
      below = below || other.levels[f] < candidate.levels[f];
      above = above || other.levels[f] > candidate.levels[f];
    }
    if (!kept && !(between && below && above)) return false;
  }
  return true;
}

/// Holds one condition out for each factor in which all that are held out are like the anchor: a proof that
/// never leaves a factor's usual level says nothing of effects over it.
void reach_every_factor(const std::vector<Condition>& conditions, const Condition& anchor,
                        const std::vector<std::size_t>& order, std::set<std::size_t>& out) {
  for (std::size_t f = 0; f < anchor.levels.size(); ++f) {
    const auto away = [&](const Condition& c) { return c.levels[f] != anchor.levels[f]; };
    if (std::ranges::any_of(conditions,
                            [&](const Condition& c) { return away(c) && out.contains(c.number); }))
      continue;
    for (const bool between : {false, true}) {
      const auto found = std::ranges::find_if(order, [&](std::size_t k) {
        return away(conditions[k]) && may_go(conditions, out, conditions[k], between);
      });
      if (found == order.end()) continue;
      out.insert(conditions[*found].number);
      break;
    }
  }
}

}  // namespace

Split split_conditions(const CouponCampaign& campaign, double share, std::uint64_t seed) {
  const std::vector<Condition> conditions = conditions_of(campaign);
  const Condition& anchor = anchor_of(conditions);
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
    // The anchors tell the scatter of days.
    if (anchor.cells.size() > 1)
      std::erase_if(order, [&](std::size_t k) { return conditions[k].cells.size() == anchor.cells.size(); });
    const auto hold_out = [&](std::size_t number) {
      for (const std::size_t k : order)
        if (out.size() < number && may_go(conditions, out, conditions[k], false))
          out.insert(conditions[k].number);
    };
    hold_out(std::min<std::size_t>(wanted, 2));
    if (wanted > 2) reach_every_factor(conditions, anchor, order, out);
    hold_out(wanted);
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
