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

constexpr int edge_samples = 160;               // along each edge of the repeat
constexpr int depth_bins = 1000;                // of the depth of a face, over a ply's thickness
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

template <class Visit>
void over_repeat(const UnitCell& cell, const Visit& visit) {
  const std::array<double, 2> size = cell.size();
  for (int j = 0; j < edge_samples; ++j)
    for (int i = 0; i < edge_samples; ++i)
      visit((i + 0.5) / edge_samples * size[0], (j + 0.5) / edge_samples * size[1]);
}

constexpr double sample_area = 1.0 / (static_cast<double>(edge_samples) * edge_samples);

Depths depths_at_shift(const UnitCell& cell, const PlyShift& shift) {
  Depths depths{2.0 * cell.crown() / depth_bins, {}};
  over_repeat(cell, [&](double xi, double eta) {
    const FaceSample lower = upper_face_at(cell, xi, eta),
                     upper = lower_face_at(cell, xi - shift[0], eta - shift[1]);
    if (lower && upper)
      add_depth(depths.share[lower->tow][upper->tow], depths.step, lower->depth + upper->depth, sample_area);
  });
  return depths;
}

Depths depths_of_all_shifts(const UnitCell& cell) {
  Depths depths{2.0 * cell.crown() / depth_bins, {}};
  std::array<std::array<std::vector<double>, 2>, 2> face;  // {upper face, lower face} by tow
  over_repeat(cell, [&](double xi, double eta) {
    if (const FaceSample f = upper_face_at(cell, xi, eta))
      add_depth(face[0][f->tow], depths.step, f->depth, sample_area);
    if (const FaceSample f = lower_face_at(cell, xi, eta))
      add_depth(face[1][f->tow], depths.step, f->depth, sample_area);
  });
  for (std::size_t a = 0; a < 2; ++a)
    for (std::size_t b = 0; b < 2; ++b) {
      const std::vector<double>&lower = face[0][a], &upper = face[1][b];
      std::vector<double>& sum = depths.share[a][b];
      if (lower.empty() || upper.empty()) continue;
      sum.assign(lower.size() + upper.size(), 0.0);
      for (std::size_t i = 0; i < lower.size(); ++i)
        for (std::size_t k = 0; k < upper.size(); ++k) sum[i + k] += lower[i] * upper[k];
    }
  return depths;
}

class Pressing {
 public:
  Pressing(const FabricGeometry& fabric, const CompactionLaw& law, Depths depths)
      : depths_(std::move(depths)),
        layer_(even_layer(fabric, law)),
        middles_(2.0 * unit_cell(fabric, 0.0).crown()) {
    const auto squeeze = [&](std::size_t k) {
      const TowGeometry& tow = fabric.crossing.tow[k];
      return TowSqueeze(law, thickness(tow.section), tow.fibre_fraction);
    };
    const bool balanced =
        thickness(fabric.crossing.tow[0].section) == thickness(fabric.crossing.tow[1].section) &&
        fabric.crossing.tow[0].fibre_fraction == fabric.crossing.tow[1].fibre_fraction;
    for (std::size_t a = 0; a < 2; ++a)
      for (std::size_t b = 0; b < 2; ++b) pair_.emplace_back(squeeze(a), squeeze(b), balanced || a == b);
  }

  /// P at H - g = closing [m].
  double pressure(double closing) const {
    double sum = 0.0;
    for (std::size_t a = 0; a < 2; ++a)
      for (std::size_t b = 0; b < 2; ++b) {
        const std::vector<double>& share = depths_.share[a][b];
        for (std::size_t k = 0; k < share.size(); ++k) {
          const double overlap = closing - depths_.step * static_cast<double>(k);
          if (overlap <= 0.0) break;
          if (share[k] > 0.0) sum += share[k] * pair_[2 * a + b].stress(overlap);
        }
      }
    return std::max(sum, layer_.stress(closing - (middles_ - layer_.thickness())));
  }

  /// Closing at which fibres are packed somewhere.
  double deepest() const {
    double least = middles_ - layer_.thickness() + layer_.squeeze_at(1.2);
    for (std::size_t a = 0; a < 2; ++a)
      for (std::size_t b = 0; b < 2; ++b) {
        const std::vector<double>& share = depths_.share[a][b];
        const auto first = std::find_if(share.begin(), share.end(), [](double s) { return s > 0.0; });
        if (first == share.end()) continue;
        const double start = depths_.step * static_cast<double>(first - share.begin());
        least = std::min(least, start + pair_[2 * a + b].squeeze_at(1.2));
      }
    return least;
  }

 private:
  // As much glass as a ply has, spread evenly at the tows' own fibre fraction.
  static TowSqueeze even_layer(const FabricGeometry& fabric, const CompactionLaw& law) {
    const double fraction =
        std::max(fabric.crossing.tow[0].fibre_fraction, fabric.crossing.tow[1].fibre_fraction);
    return TowSqueeze(law, sheet_shares(fabric).glass * fabric.thickness / fraction, fraction);
  }

  Depths depths_;
  TowSqueeze layer_;
  double middles_;                 // distance of the middles, crown on crown [m]
  std::vector<PairSqueeze> pair_;  // 2 a + b
};

PlyFacing table_of(const Pressing& pressing, double thickness, double rest) {
  const double start = thickness - rest;
  double low = start, high = pressing.deepest();
  if (!(pressing.pressure(high) > highest_table_pressure))
    throw NumericalError("plies: packed tows do not carry the highest pressure of the table");
  for (int k = 0; k < 60; ++k) {
    const double middle = 0.5 * (low + high);
    (pressing.pressure(middle) < highest_table_pressure ? low : high) = middle;
  }
  std::vector<double> approach(table_points), pressure(table_points);
  tbb::parallel_for(0, table_points, [&](int k) {
    const double closing = (high - start) * k / (table_points - 1);
    approach[k] = 0.5 * closing;
    pressure[k] = k == 0 ? 0.0 : pressing.pressure(start + closing);
  });
  return {rest, Curve(std::move(approach), std::move(pressure))};
}

}  // namespace

PlyFacing facing_of_shift(const FabricGeometry& fabric, const CompactionLaw& law, const PlyShift& shift) {
  const UnitCell cell = unit_cell(fabric, 0.0);
  return table_of(Pressing(fabric, law, depths_at_shift(cell, shift)), 2.0 * cell.crown(),
                  closest_approach(cell, shift));
}

PlyFacing facing_of_all_shifts(const FabricGeometry& fabric, const CompactionLaw& law) {
  const UnitCell cell = unit_cell(fabric, 0.0);
  return table_of(Pressing(fabric, law, depths_of_all_shifts(cell)), 2.0 * cell.crown(), 2.0 * cell.crown());
}

}  // namespace heddle::mesoscale
