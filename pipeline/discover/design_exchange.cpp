#include "pipeline/discover/design_exchange.h"

#include <tbb/parallel_for.h>

#include <algorithm>
#include <map>

#include "pipeline/discover/coordinates.h"

namespace heddle::discover {

namespace {

std::vector<double> settings_of(const CouponCell& cell) {
  std::vector<double> settings;
  for (const Knob& knob : knobs()) settings.push_back(knob.get(cell));
  return settings;
}

/// One cell with what the model says of it; blocks of cells stack to campaigns.
struct Block {
  CouponCell cell;
  double hersey = 0.0;
  Changes changes;
};

/// Campaigns of blocks, judged without asking the model again.
class Judge {
 public:
  Judge(const CouponQuestion& question, std::size_t days, int stretches)
      : question_(question), days_(days), stretches_(stretches) {}

  Block block_of(const CouponCell& cell) const {
    PlannedCampaign alone = planned_campaign(question_, {cell}, stretches_, days_);
    const std::vector<double> hersey = hersey_numbers(question_.base, question_.rig, alone.cells);
    return {.cell = alone.cells.front(),
            .hersey = hersey.empty() ? 0.0 : hersey.front(),
            .changes = changes_of(alone.forward, alone.baseline)};
  }

  double criterion(const std::vector<const Block*>& blocks, const CouponNoise& noise) const {
    std::vector<CouponCell> cells;
    std::vector<double> hersey;
    for (const Block* block : blocks) {
      cells.push_back(block->cell);
      if (block->hersey > 0.0) hersey.push_back(block->hersey);
    }
    const Changes changes = stacked(blocks);
    const Observations observations{
        .value = Eigen::VectorXd::Zero(changes.baseline.rows()),
        .covariance = covariance_of(noise, cells, hersey),
        .coordinates = form_coordinates(cells, question_.noise.effect_form_length),
        .form = question_.noise.effect_form};
    const Whitened data(observations.value, observations.covariance);
    return criterion_of(fingerprints_of(changes, data, observations));
  }

 private:
  /// Effects that every block has, rows of all.
  static Changes stacked(const std::vector<const Block*>& blocks) {
    Eigen::Index rows = 0;
    for (const Block* block : blocks) rows += block->changes.baseline.rows();
    Changes all{.baseline = Eigen::MatrixXd(rows, blocks.front()->changes.baseline.cols()), .effects = {}};
    Eigen::Index at = 0;
    for (const Block* block : blocks) {
      all.baseline.middleRows(at, block->changes.baseline.rows()) = block->changes.baseline;
      at += block->changes.baseline.rows();
    }
    for (const Changes::OfEffect& first : blocks.front()->changes.effects) {
      Changes::OfEffect of{.effect = first.effect,
                           .own = Eigen::VectorXd(rows),
                           .slopes = Eigen::MatrixXd(rows, first.slopes.cols())};
      at = 0;
      for (const Block* block : blocks) {
        const auto& list = block->changes.effects;
        const auto own = std::ranges::find(list, first.effect, &Changes::OfEffect::effect);
        if (own == list.end()) break;
        of.own.segment(at, own->own.size()) = own->own;
        of.slopes.middleRows(at, own->own.size()) = own->slopes;
        at += own->own.size();
      }
      if (at == rows) all.effects.push_back(std::move(of));
    }
    return all;
  }

  const CouponQuestion& question_;
  std::size_t days_;
  int stretches_;
};

/// The blocks that the search has met, by settings and day.
class Blocks {
 public:
  explicit Blocks(const Judge& judge) : judge_(judge) {}
  /// All of them at once, on all threads.
  std::vector<const Block*> of(const std::vector<CouponCell>& cells) {
    std::vector<std::vector<double>> keys;
    std::vector<std::size_t> fresh;
    for (std::size_t k = 0; k < cells.size(); ++k) {
      keys.push_back(settings_of(cells[k]));
      keys.back().push_back(static_cast<double>(cells[k].day));
      keys.back().push_back(cells[k].samples);
      if (known_.try_emplace(keys.back()).second) fresh.push_back(k);
    }
    tbb::parallel_for(std::size_t{0}, fresh.size(),
                      [&](std::size_t k) { known_.at(keys[fresh[k]]) = judge_.block_of(cells[fresh[k]]); });
    std::vector<const Block*> blocks;
    for (const auto& key : keys) blocks.push_back(&known_.at(key));
    return blocks;
  }

 private:
  const Judge& judge_;
  std::map<std::vector<double>, Block> known_;
};

std::vector<bool> cells_that_stay(const std::vector<CouponCell>& cells) {
  std::map<std::size_t, int> days;
  for (const CouponCell& cell : cells) ++days[cell.condition];
  std::vector<bool> stay;
  for (const CouponCell& cell : cells) stay.push_back(stay.empty() || days[cell.condition] >= 3);
  return stay;
}

/// The cell at every other level of every knob.
std::vector<CouponCell> variants_of(const CouponCell& cell, const std::vector<std::vector<double>>& levels) {
  std::vector<CouponCell> variants;
  for (std::size_t k = 0; k < knobs().size(); ++k)
    for (const double level : levels[k]) {
      if (level == knobs()[k].get(cell)) continue;
      variants.push_back(cell);
      knobs()[k].set(variants.back(), level);
    }
  return variants;
}

}  // namespace

const std::vector<Knob>& knobs() {
  static const std::vector<Knob> all{
      {"velocity_mm_s", [](const CouponCell& c) { return c.pull.velocity; },
       [](CouponCell& c, double value) { c.pull.velocity = value; }},
      {"normal_force_N", [](const CouponCell& c) { return c.pull.normal_force; },
       [](CouponCell& c, double value) { c.pull.normal_force = value; }},
      {"tool_temperature_C", [](const CouponCell& c) { return c.pull.tool_temperature; },
       [](CouponCell& c, double value) { c.pull.tool_temperature = value; }},
      {"fabric_temperature_C", [](const CouponCell& c) { return c.pull.fabric_temperature; },
       [](CouponCell& c, double value) { c.pull.fabric_temperature = value; }},
      {"orientation_deg", [](const CouponCell& c) { return c.pull.orientation; },
       [](CouponCell& c, double value) { c.pull.orientation = value; }},
      {"dwell_s", [](const CouponCell& c) { return c.dwell; },
       [](CouponCell& c, double value) { c.dwell = value; }}};
  return all;
}

std::vector<std::vector<double>> levels_of(const std::vector<CouponCell>& cells) {
  std::vector<std::vector<double>> levels;
  for (const Knob& knob : knobs()) {
    std::vector<double> all;
    for (const CouponCell& cell : cells) all.push_back(knob.get(cell));
    std::ranges::sort(all);
    const auto rest = std::ranges::unique(all);
    all.erase(rest.begin(), rest.end());
    levels.push_back(std::move(all));
  }
  return levels;
}

void number_conditions(std::vector<CouponCell>& cells) {
  std::map<std::vector<double>, std::size_t> known;
  for (CouponCell& cell : cells)
    cell.condition = known.try_emplace(settings_of(cell), known.size()).first->second;
}

double criterion_of(const std::vector<Fingerprint>& prints) {
  const Eigen::MatrixXd lambda = separations(prints);
  double sum = 0.0;
  for (Eigen::Index k = 0; k < lambda.rows(); ++k) {
    double chance = normal_probability(prints[static_cast<std::size_t>(k)].own.norm() - 3.0);
    for (Eigen::Index m = 0; m < lambda.cols(); ++m)
      if (m != k) chance *= 1.0 - swap_rate(lambda(k, m));
    sum += chance;
  }
  return prints.empty() ? 0.0 : sum / static_cast<double>(prints.size());
}

Exchange exchanged_design(const CouponQuestion& question, std::vector<CouponCell> cells,
                          const ExchangeOptions& options) {
  std::size_t days = 1;
  for (const CouponCell& cell : cells) days = std::max(days, cell.day + 1);
  const CouponNoise noise = planned_campaign(question, cells, options.stretches).noise;
  const std::vector<std::vector<double>> levels = levels_of(cells);
  const std::vector<bool> stays = cells_that_stay(cells);
  const Judge judge(question, days, options.stretches);
  Blocks blocks(judge);
  std::vector<const Block*> design = blocks.of(cells);
  Exchange exchange;
  exchange.before = exchange.after = judge.criterion(design, noise);
  for (int pass = 0; pass < options.passes; ++pass) {
    const int before = exchange.exchanges;
    for (std::size_t c = 0; c < cells.size(); ++c) {
      if (stays[c]) continue;
      const std::vector<CouponCell> variants = variants_of(cells[c], levels);
      const std::vector<const Block*> tried = blocks.of(variants);
      std::vector<double> criteria(variants.size());
      tbb::parallel_for(std::size_t{0}, variants.size(), [&](std::size_t v) {
        std::vector<const Block*> other = design;
        other[c] = tried[v];
        criteria[v] = judge.criterion(other, noise);
      });
      const auto best = std::ranges::max_element(criteria);
      if (best == criteria.end() || *best < exchange.after + options.gain) continue;
      const auto v = static_cast<std::size_t>(best - criteria.begin());
      exchange.after = *best;
      ++exchange.exchanges;
      cells[c] = variants[v];
      design[c] = tried[v];
    }
    if (exchange.exchanges == before) break;
  }
  number_conditions(cells);
  exchange.cells = std::move(cells);
  return exchange;
}

}  // namespace heddle::discover
