#include "mesoscale/nesting.h"

#include <algorithm>
#include <cmath>
#include <limits>

#include <tbb/parallel_for.h>

#include "mesoscale/root.h"

namespace heddle::mesoscale {

namespace {

constexpr double never = -std::numeric_limits<double>::infinity();

// Golden section between low and high: the top of an arc, or the kink where two of them meet.
template <class Function>
double top_between(double low, double high, const Function& f) {
  constexpr double golden = 0.6180339887498949;
  double a = low, b = high;
  double c = b - golden * (b - a), d = a + golden * (b - a), f_c = f(c), f_d = f(d);
  while (b - a > 1e-13) {  // of 1e-3 m
    if (f_c > f_d) {
      b = d, d = c, f_d = f_c;
      c = b - golden * (b - a), f_c = f(c);
    } else {
      a = c, c = d, f_c = f_d;
      d = a + golden * (b - a), f_d = f(d);
    }
  }
  return std::max(f_c, f_d);
}

constexpr int samples_of_a_pitch = 48;

// Largest value of f over [low, high]: about each sample that is no lower than its neighbours there is a top.
template <class Function>
double largest(double low, double high, double pitch, const Function& f) {
  const int samples = std::max(8, static_cast<int>(std::ceil(samples_of_a_pitch * (high - low) / pitch)));
  const double step = (high - low) / samples;
  const auto place = [&](int k) { return k == samples ? high : low + step * k; };
  double before = never, here = f(low), best = here;
  for (int k = 0; k <= samples; ++k) {
    const double next = k < samples ? f(place(k + 1)) : never;
    if (here >= before && here >= next)
      best =
          std::max({best, here, top_between(place(std::max(k - 1, 0)), place(std::min(k + 1, samples)), f)});
    before = here;
    here = next;
  }
  return best;
}

// One of the two plies, seen along {xi, eta} or, exchanged, along {eta, xi}: the first family lies along the
// first axis.
struct View {
  const UnitCell& cell;
  bool exchanged;

  std::size_t family(std::size_t k) const { return exchanged ? 1 - k : k; }
  const UnitCell::Tow& tow(std::size_t k) const { return cell.tow[family(k)]; }
  int count(std::size_t k) const { return family(k) == 0 ? cell.weave.warps : cell.weave.wefts; }
  double centre(std::size_t k, int index, double along) const {
    return family(k) == 0 ? warp_centre(cell, index, along) : weft_centre(cell, index, along);
  }
  double repeat(std::size_t k) const { return tow(k).spacing * count(k); }  ///< across the family
};

// Tows of the first family in both plies: paths against each other along them, sections across.
double parallel_tows(const View& view, const PlyShift& shift) {
  const double spacing = view.tow(0).spacing, pitch = view.tow(1).spacing;
  const Section& section = view.tow(0).section;
  const double half = 0.5 * width(section);
  double most = never;
  for (int lower = 0; lower < view.count(0); ++lower) {
    const int nearest = static_cast<int>(std::lround(lower - shift[1] / spacing));
    for (int upper = nearest - 1; upper <= nearest + 1; ++upper) {
      const double apart = upper * spacing + shift[1] - lower * spacing;
      if (std::abs(apart) >= 2.0 * half) continue;
      const double across =
          largest(std::max(-half, apart - half), std::min(half, apart + half), pitch,
                  [&](double y) { return upper_face(section, y) - lower_face(section, y - apart); });
      const double along = largest(0.0, view.repeat(1), pitch, [&](double x) {
        return view.centre(0, lower, x) - view.centre(0, upper, x - shift[0]);
      });
      most = std::max(most, across + along);
    }
  }
  return most;
}

// A tow of the first family below one of the second.
double crossing_tows(const View& view, const PlyShift& shift) {
  const Section &below = view.tow(0).section, &above = view.tow(1).section;
  const double half_below = 0.5 * width(below), half_above = 0.5 * width(above);
  double most = never;
  for (int lower = 0; lower < view.count(0); ++lower)
    for (int upper = 0; upper < view.count(1); ++upper) {
      const double at = upper * view.tow(1).spacing + shift[0];  // along the lower tow
      const double along = largest(at - half_above, at + half_above, view.tow(1).spacing, [&](double x) {
        return view.centre(0, lower, x) - lower_face(above, x - at);
      });
      const double middle = lower * view.tow(0).spacing;
      const double across = largest(
          middle - half_below, middle + half_below, view.tow(0).spacing,
          [&](double y) { return upper_face(below, y - middle) - view.centre(1, upper, y - shift[1]); });
      most = std::max(most, along + across);
    }
  return most;
}

// As many plies, each so far from the next that the stack has this thickness.
void spread(PlyStack& stack, double thickness) {
  const double more = (thickness - stack.thickness) / static_cast<double>(stack.height.size() - 1);
  for (std::size_t k = 0; k < stack.height.size(); ++k) stack.height[k] += more * static_cast<double>(k);
  stack.thickness = thickness;
}

// Of the stack, from those of a lone ply that is `thickness` thick.
SheetShares shares_in(const PlyStack& stack, const CrossingGeometry& crossing, const SheetShares& lone,
                      double lone_thickness) {
  const double plies = static_cast<double>(stack.height.size());
  const double thinner = plies * lone_thickness / stack.thickness;
  SheetShares shares{lone.glass * thinner, lone.resin * thinner, 0.0, 0.0};
  shares.voids = 1.0 - shares.glass - shares.resin;
  for (const TowGeometry& tow : crossing.tow)
    shares.tows += plies * area(tow.section) / tow.spacing / stack.thickness;
  return shares;
}

// Thickness of a ply's glass and resin, spread evenly over its area after shear.
double solid_thickness(const FabricGeometry& fabric, double shear_angle) {
  return fabric.mass.consolidated_thickness() / std::cos(shear_angle);
}

}  // namespace

double closest_approach(const UnitCell& ply, const PlyShift& shift) {
  const View along_warps{ply, false}, along_wefts{ply, true};
  const PlyShift exchanged{shift[1], shift[0]};
  return std::max({parallel_tows(along_warps, shift), parallel_tows(along_wefts, exchanged),
                   crossing_tows(along_warps, shift), crossing_tows(along_wefts, exchanged)});
}

PlyStack nested(const UnitCell& ply, const std::vector<PlyShift>& shift) {
  PlyStack stack{ply, shift, {0.0}, 0.0};
  for (std::size_t upper = 1; upper < shift.size(); ++upper) {
    double height = 0.0;
    for (std::size_t lower = 0; lower < upper; ++lower)
      height =
          std::max(height, stack.height[lower] + closest_approach(ply, {shift[upper][0] - shift[lower][0],
                                                                        shift[upper][1] - shift[lower][1]}));
    stack.height.push_back(height);
  }
  stack.thickness = stack.height.back() + 2.0 * ply.crown();
  return stack;
}

double sampled_overlap(const PlyStack& stack, int samples_per_pitch) {
  const UnitCell& cell = stack.ply;
  const int nx = samples_per_pitch * cell.weave.wefts, ny = samples_per_pitch * cell.weave.warps;
  const std::array<double, 2> size = cell.size();
  double deepest = never;
  std::vector<Column> columns(stack.shift.size());
  for (int j = 0; j < ny; ++j)
    for (int i = 0; i < nx; ++i) {
      // Off the crossings, where the samples of other checks stand.
      const double xi = (i + 0.37) * size[0] / nx, eta = (j + 0.41) * size[1] / ny;
      for (std::size_t k = 0; k < columns.size(); ++k)
        columns[k] = column(cell, xi - stack.shift[k][0], eta - stack.shift[k][1]);
      for (std::size_t upper = 1; upper < columns.size(); ++upper)
        for (std::size_t lower = 0; lower < upper; ++lower) {
          const Column &a = columns[lower], &b = columns[upper];
          const double top = std::max(a.warp ? a.warp_top : never, a.weft ? a.weft_top : never);
          const double bottom = std::min(b.warp ? b.warp_bottom : -never, b.weft ? b.weft_bottom : -never);
          deepest = std::max(deepest, stack.height[lower] + top - stack.height[upper] - bottom);
        }
    }
  return deepest;
}

StackedFabric stacked(const FabricGeometry& fabric, double shear_angle, const std::vector<PlyShift>& shift) {
  StackedFabric result;
  result.crossing = sheared(fabric.crossing, shear_angle);
  result.stack = nested(unit_cell(fabric.weave, result.crossing), shift);
  const double least = static_cast<double>(shift.size()) * solid_thickness(fabric, shear_angle);
  if (shift.size() > 1 && result.stack.thickness < least) spread(result.stack, least);
  SheetShares lone = sheet_shares(fabric);
  lone.glass /= std::cos(shear_angle);
  lone.resin /= std::cos(shear_angle);
  result.shares = shares_in(result.stack, result.crossing, lone, fabric.thickness);
  return result;
}

StackedFabric consolidated_stack(const FabricGeometry& consolidated, double shear_angle,
                                 const std::vector<PlyShift>& shift) {
  const PressedFabric lone = pressed(consolidated, shear_angle);
  const double plies = static_cast<double>(shift.size()), wanted = plies * lone.thickness;
  const auto at = [&](double factor) {
    return nested(unit_cell(consolidated.weave, thickened(lone.crossing, factor)), shift);
  };
  StackedFabric result;
  const double short_of = at(1.0).thickness - wanted;
  // A ply alone as thick as the stack is enough.
  if (short_of < -1e-12 * wanted)
    result.swelling = bracketed_root(1.0, short_of, plies, at(plies).thickness - wanted, 1e-13 * wanted,
                                     [&](double factor) { return at(factor).thickness - wanted; });
  result.crossing = thickened(lone.crossing, result.swelling);
  result.stack = at(result.swelling);
  const SheetShares shares = sheet_shares(consolidated);
  result.shares = shares_in(result.stack, result.crossing, shares, lone.thickness);
  return result;
}

StackedFabric stacked(const CellSpec& spec) {
  const FabricGeometry fabric = fabric_geometry(spec);
  const std::vector<PlyShift> shift = spec.stack.shifts();
  return spec.state == CellState::consolidated ? consolidated_stack(fabric, 0.0, shift)
                                               : stacked(fabric, 0.0, shift);
}

StackSummary summary_of(const StackedFabric& fabric, double ply_thickness) {
  const std::size_t plies = fabric.stack.height.size();
  return {static_cast<int>(plies), fabric.stack.thickness, static_cast<double>(plies) * ply_thickness,
          fabric.swelling, fabric.shares};
}

NestingMap nesting_map(const UnitCell& ply, int n) {
  NestingMap map{n, {ply.size()[0] / n, ply.size()[1] / n}, {}};
  map.thickness.resize(static_cast<std::size_t>(n) * static_cast<std::size_t>(n));
  tbb::parallel_for(0, n, [&](int j) {
    for (int i = 0; i < n; ++i)
      map.thickness[static_cast<std::size_t>(j) * static_cast<std::size_t>(n) + static_cast<std::size_t>(i)] =
          2.0 * ply.crown() + closest_approach(ply, {i * map.step[0], j * map.step[1]});
  });
  return map;
}

}  // namespace heddle::mesoscale
