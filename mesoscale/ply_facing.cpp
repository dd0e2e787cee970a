#include "mesoscale/ply_facing.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <optional>
#include <vector>

#include <tbb/parallel_for.h>

#include "core/problem.h"

namespace heddle::mesoscale {

namespace {

constexpr int pitch_samples = 80;  // along each edge of a pitch
// Shifts of the mean: a lattice of Fibonacci numbers, even in both directions.
constexpr int mean_shifts = 233, mean_step = 144;
constexpr int depth_bins = 1000;                // of the two depths together, over a ply's thickness
constexpr int table_points = 128;               // of the table, even in the closing, from 0
constexpr double highest_table_pressure = 6e6;  // [Pa], as the tables against a plate

/// A face at one sample: its depth below the crowns [m] and whose tow it is {warp, weft}.
struct FacePoint {
  double depth;
  std::size_t tow;
};
using FaceSample = std::optional<FacePoint>;  // nothing where there is no tow

FaceSample upper_face_at(const UnitCell& cell, double xi, double eta) {
  const Column c = column(cell, xi, eta);
  if (!c.warp && !c.weft) return {};
  const bool warp = c.warp && (!c.weft || c.warp_top > c.weft_top);
  return FacePoint{cell.crown() - (warp ? c.warp_top : c.weft_top), warp ? 0u : 1u};
}

FaceSample lower_face_at(const UnitCell& cell, double xi, double eta) {
  const Column c = column(cell, xi, eta);
  if (!c.warp && !c.weft) return {};
  const bool warp = c.warp && (!c.weft || c.warp_bottom < c.weft_bottom);
  return FacePoint{cell.crown() + (warp ? c.warp_bottom : c.weft_bottom), warp ? 0u : 1u};
}

/// How much of the cell's area has its faces a sum of depths apart when the crowns touch: by the tows that
/// face each other there, {lower ply's, upper ply's}; evenly spaced from 0. The rest of the area has no tow
/// on one side.
struct Depths {
  double step = 0.0;  // [m]
  std::array<std::array<std::vector<double>, 2>, 2> share{};
};

void add_depth(std::vector<double>& share, double step, double depth, double area) {
  const double at = depth / step;
  const auto k = static_cast<std::size_t>(at);
  if (share.size() < k + 2) share.resize(k + 2, 0.0);
  // Linear between two places, so that the mean depth is kept.
  share[k] += area * (1.0 - (at - static_cast<double>(k)));
  share[k + 1] += area * (at - static_cast<double>(k));
}

Depths depths_at_shift(const UnitCell& cell, const PlyShift& shift) {
  const std::array<double, 2> size = cell.size();
  const int along_warp = pitch_samples * cell.weave.wefts, along_weft = pitch_samples * cell.weave.warps;
  const double area = 1.0 / (static_cast<double>(along_warp) * along_weft);
  Depths depths{2.0 * cell.crown() / depth_bins, {}};
  for (int j = 0; j < along_weft; ++j)
    for (int i = 0; i < along_warp; ++i) {
      const double xi = (i + 0.5) / along_warp * size[0], eta = (j + 0.5) / along_weft * size[1];
      const FaceSample lower = upper_face_at(cell, xi, eta),
                       upper = lower_face_at(cell, xi - shift[0], eta - shift[1]);
      if (lower && upper)
        add_depth(depths.share[lower->tow][upper->tow], depths.step, lower->depth + upper->depth, area);
    }
  return depths;
}

/// What all shifts of one fabric have in common.
struct FacingTows {
  std::vector<PairSqueeze> pair;  // of the lower ply's tow a and the upper's b: 2 a + b
  TowSqueeze layer;               // as much glass as a ply has, spread evenly at the tows' own fibre fraction
  double middles;                 // distance of the middles, crown on crown [m]
};

FacingTows facing_tows(const FabricGeometry& fabric, const CompactionLaw& law, const UnitCell& cell) {
  const auto& tow = fabric.crossing.tow;
  const auto squeeze = [&](std::size_t k) {
    return TowSqueeze(law, thickness(tow[k].section), tow[k].fibre_fraction);
  };
  const bool balanced = thickness(tow[0].section) == thickness(tow[1].section) &&
                        tow[0].fibre_fraction == tow[1].fibre_fraction;
  std::vector<PairSqueeze> pair;
  for (std::size_t a = 0; a < 2; ++a)
    for (std::size_t b = 0; b < 2; ++b) pair.emplace_back(squeeze(a), squeeze(b), balanced || a == b);
  const double fraction = std::max(tow[0].fibre_fraction, tow[1].fibre_fraction);
  return {std::move(pair),
          TowSqueeze(law, sheet_shares(fabric).glass * fabric.thickness / fraction, fraction),
          2.0 * cell.crown()};
}

// P at H - g = closing [m].
double pressure_of(const FacingTows& tows, const Depths& depths, double closing) {
  double sum = 0.0;
  for (std::size_t a = 0; a < 2; ++a)
    for (std::size_t b = 0; b < 2; ++b) {
      const std::vector<double>& share = depths.share[a][b];
      for (std::size_t k = 0; k < share.size(); ++k) {
        const double overlap = closing - depths.step * static_cast<double>(k);
        if (overlap <= 0.0) break;
        if (share[k] > 0.0) sum += share[k] * tows.pair[2 * a + b].stress(overlap);
      }
    }
  return std::max(sum, tows.layer.stress(closing - (tows.middles - tows.layer.thickness())));
}

// Closing at which fibres are packed somewhere.
double deepest_closing(const FacingTows& tows, const Depths& depths) {
  double least = tows.middles - tows.layer.thickness() + tows.layer.squeeze_at(1.2);
  for (std::size_t a = 0; a < 2; ++a)
    for (std::size_t b = 0; b < 2; ++b) {
      const std::vector<double>& share = depths.share[a][b];
      const auto first = std::find_if(share.begin(), share.end(), [](double s) { return s > 0.0; });
      if (first == share.end()) continue;
      const double start = depths.step * static_cast<double>(first - share.begin());
      least = std::min(least, start + tows.pair[2 * a + b].squeeze_at(1.2));
    }
  return least;
}

// A table from the closing at which the plies touch to that of the highest pressure.
template <class Pressure>
PlyFacing table_of(const Pressure& pressure_at, double thickness, double rest, double deepest) {
  const double start = thickness - rest;
  double low = start, high = deepest;
  if (!(pressure_at(high) > highest_table_pressure))
    throw NumericalError("plies: packed tows do not carry the highest pressure of the table");
  for (int k = 0; k < 40; ++k) {
    const double middle = 0.5 * (low + high);
    (pressure_at(middle) < highest_table_pressure ? low : high) = middle;
  }
  std::vector<double> approach(table_points), pressure(table_points);
  tbb::parallel_for(0, table_points, [&](int k) {
    const double closing = (high - start) * k / (table_points - 1);
    approach[k] = 0.5 * closing;
    pressure[k] = k == 0 ? 0.0 : pressure_at(start + closing);
  });
  return {rest, Curve(std::move(approach), std::move(pressure))};
}

}  // namespace

PlyFacing facing_of_shift(const FabricGeometry& fabric, const CompactionLaw& law, const PlyShift& shift) {
  const UnitCell cell = unit_cell(fabric, 0.0);
  const FacingTows tows = facing_tows(fabric, law, cell);
  const Depths depths = depths_at_shift(cell, shift);
  return table_of([&](double closing) { return pressure_of(tows, depths, closing); }, tows.middles,
                  closest_approach(cell, shift), deepest_closing(tows, depths));
}

PlyFacing facing_of_all_shifts(const FabricGeometry& fabric, const CompactionLaw& law) {
  const UnitCell cell = unit_cell(fabric, 0.0);
  const std::array<double, 2> size = cell.size();
  const FacingTows tows = facing_tows(fabric, law, cell);
  std::vector<Depths> shifted(mean_shifts);
  tbb::parallel_for(0, mean_shifts, [&](int k) {
    shifted[k] = depths_at_shift(cell, {(k + 0.5) / mean_shifts * size[0],
                                        (k * mean_step % mean_shifts + 0.5) / mean_shifts * size[1]});
  });
  double deepest = deepest_closing(tows, shifted.front());
  for (const Depths& depths : shifted) deepest = std::min(deepest, deepest_closing(tows, depths));
  const auto mean = [&](double closing) {
    double sum = 0.0;
    for (const Depths& depths : shifted) sum += pressure_of(tows, depths, closing) / mean_shifts;
    return sum;
  };
  return table_of(mean, tows.middles, tows.middles, deepest);
}

}  // namespace heddle::mesoscale
