#include "mesoscale/film.h"

#include <algorithm>
#include <cmath>
#include <utility>

#include <fmt/format.h>
#include <tbb/parallel_for.h>

#include "core/problem.h"
#include "mesoscale/root.h"

namespace heddle::mesoscale {

namespace {

using Eigen::Vector2d;

constexpr int coarsest = 16;

// Upper face above a point of the parameter plane, below the crowns; nothing where there is no tow.
std::optional<double> depth_below_crowns(const UnitCell& cell, double xi, double eta) {
  const Column c = column(cell, xi, eta);
  if (!c.warp && !c.weft) return {};
  const double top = !c.weft ? c.warp_top : !c.warp ? c.weft_top : std::max(c.warp_top, c.weft_top);
  return cell.crown() - top;
}

double fabric_depth(const UnitCell& cell) {
  return 2.0 * cell.crown();
}

// Width up to which resin stands: narrow places fill first.
double wet_gap(const FilmMap& map, const FaceDepth& face, double fill) {
  std::vector<double> gaps;
  for (std::size_t e = 0; e < map.gap.size(); ++e)
    for (std::size_t g = 0; g < 4; ++g)
      if (face.covered[e][g]) gaps.push_back(map.gap[e][g]);
  std::sort(gaps.begin(), gaps.end());
  if (gaps.empty()) return 0.0;
  double volume = 0.0, filled = 0.0, below = gaps.front();
  for (const double gap : gaps) volume += gap;
  for (std::size_t k = 0; k < gaps.size();) {
    // Samples that mirror each other fill together; between such levels the width is interpolated, so that it
    // moves without jumps.
    double level = 0.0;
    const double gap = gaps[k];
    for (; k < gaps.size() && gaps[k] <= gap * (1.0 + 1e-9); ++k) level += gaps[k];
    if (filled + level >= fill * volume)
      return (below + (gap - below) * (fill * volume - filled) / level) * (1.0 + 1e-9);
    filled += level;
    below = gap;
  }
  return below;
}

// How far a node stands beyond the depth to which resin goes: 0 to 1 over one spacing.
double openness(const FaceDepth& face, int i, int j, double deepest) {
  const int n = face.samples;
  const double here = face.at_nodes[i * n + j];
  double change = 1e-12;
  for (const auto& [di, dj] : {std::pair{0, 1}, {1, 0}, {0, n - 1}, {n - 1, 0}}) {
    const int k = (i + di) % n * n + (j + dj) % n;
    if (face.covered_nodes[k]) change = std::max(change, std::abs(face.at_nodes[k] - here));
  }
  return std::clamp(0.5 + (here - deepest) / change, 0.0, 1.0);
}

void check_spec(const FilmSpec& spec) {
  Problems problems;
  const auto require = [&](bool holds, const char* key, double value, const char* rule, const char* way_out) {
    if (!holds)
      problems.push_back({"film.*.range"_family.of(key), key, fmt::format("{}", value), rule, way_out});
  };
  int samples = spec.samples;
  while (samples > coarsest && samples % 2 == 0) samples /= 2;
  require(samples == coarsest, "samples", spec.samples, "must be 16, 32, 64, ...",
          "Write 128: the pressure is then within a few percent.");
  require(spec.fill > 0.0 && spec.fill < 1.0, "fill", spec.fill, "must satisfy 0 < fill < 1",
          "Resin spread evenly takes 0.233 of the room in the fabric of Table 1.");
  require(spec.roughness > 0.0, "roughness", spec.roughness, "must be > 0 m",
          "A fibre's radius is 9.25e-6 m.");
  if (!problems.empty()) throw InputError(std::move(problems));
}

// Approach against load, once a film.
class LoadBalance {
 public:
  LoadBalance(const FilmBearing& bearing, double pressure, const Vector2d& sliding, FilmState& state)
      : bearing_(bearing), pressure_(pressure), sliding_(sliding), state_(state) {}

  void solve(double roughness) {
    const double touching = excess(0.0);
    if (touching >= 0.0)
      lift(roughness, touching);
    else
      press(roughness, touching);
  }

 private:
  static constexpr double small = 1e-4;  // of ln P

  // ln of carried over wanted load.
  double excess(double approach) {
    const FilmPressure film = bearing_.film(approach, sliding_);
    ++state_.solves;
    if (!film.converged && state_.reason.empty()) state_.reason = film.reason;
    const PlateContact& plate = bearing_.plate();
    state_.approach = approach;
    state_.film_load = film.load;
    state_.solid_load = approach > 0.0 ? plate.pressure(approach) : 0.0;
    state_.film_traction = film.traction;
    state_.resin_share = film.resin_share;
    ruptured_ = film.ruptured_traction;
    return std::log(std::max(state_.pressure(), 1e-12 * pressure_) / pressure_);
  }

  // The film alone: find the gap between h_r and where it carries less than asked, in ln h.
  void lift(double roughness, double touching) {
    double narrow = std::log(roughness), wide = narrow, f_narrow = touching, f_wide = touching;
    while (f_wide >= 0.0) {
      narrow = wide;
      f_narrow = f_wide;
      wide += std::log(2.0);
      f_wide = excess(roughness - std::exp(wide));
    }
    bracketed_root(wide, f_wide, narrow, f_narrow, small,
                   [&](double log_gap) { return excess(roughness - std::exp(log_gap)); });
  }

  // The tows carry the rest. The film's share grows with the approach at first and falls once the crowns are
  // flat, so there may be more than one balance: the one met first by a tool that comes down is meant.
  void press(double roughness, double touching) {
    const double deepest = bearing_.plate().depth_at(pressure_);  // the tows alone
    double above = 0.0, below = 0.0, f_above = touching, f_below = touching;
    for (double next = roughness; f_below < 0.0; next *= 2.0) {
      above = below;
      f_above = f_below;
      below = std::min(next, deepest);
      f_below = excess(below);
      if (below == deepest && f_below <= small) return;
    }
    bracketed_root(above, f_above, below, f_below, small, [&](double d) { return excess(d); });
  }

 public:
  Vector2d ruptured_ = Vector2d::Zero();

 private:
  const FilmBearing& bearing_;
  double pressure_;
  Vector2d sliding_;
  FilmState& state_;
};

}  // namespace

double even_fill(const FabricGeometry& fabric) {
  // Per area of the fabric, in m: glass and resin of both families, and the thickness they stand in.
  double glass = 0.0, resin = 0.0;
  for (std::size_t i = 0; i < 2; ++i) {
    const double length = (1.0 + fabric.as_woven_crimp[i]) / fabric.crossing.tow[i].spacing;
    glass += fabric.mass.glass_area[i] * length;
    resin += fabric.mass.resin_area[i] * length;
  }
  return resin / (fabric.thickness - glass);
}

FaceDepth face_depth(const UnitCell& cell, int samples) {
  const std::array<double, 2> size = cell.size();
  const auto count = static_cast<std::size_t>(samples) * static_cast<std::size_t>(samples);
  const double nothing = fabric_depth(cell);
  FaceDepth face{samples, {}, {}, {}, {}};
  face.at_points.resize(count);
  face.covered.resize(count);
  face.at_nodes.resize(count);
  face.covered_nodes.resize(count);
  tbb::parallel_for(0, samples, [&](int i) {
    for (int j = 0; j < samples; ++j) {
      const auto k = static_cast<std::size_t>(i) * samples + static_cast<std::size_t>(j);
      const auto depth = [&](double x, double y) {
        return depth_below_crowns(cell, (j + x) * size[0] / samples, (i + y) * size[1] / samples);
      };
      const std::optional<double> node = depth(0.0, 0.0);
      face.at_nodes[k] = node.value_or(nothing);
      face.covered_nodes[k] = node.has_value();
      for (std::size_t g = 0; g < 4; ++g) {
        const std::optional<double> point = depth(film_points[g][0], film_points[g][1]);
        face.at_points[k][g] = point.value_or(nothing);
        face.covered[k][g] = point.has_value();
      }
    }
  });
  return face;
}

FilmMap film_map(const UnitCell& cell, const FaceDepth& face, double approach, double roughness,
                 double fill) {
  const auto gap = [&](double depth) { return roughness + std::max(depth - approach, 0.0); };
  const auto edge = [](const std::array<double, 2>& at) { return Vector2d(at[0], at[1]); };
  const std::array<double, 2> size = cell.size();
  FilmMap map{face.samples,
              face.samples,
              edge(cell.place(size[0], 0.0)),
              edge(cell.place(0.0, size[1])),
              {},
              {},
              {},
              {}};
  map.gap.resize(face.at_points.size());
  map.resin.resize(face.at_points.size());
  map.wet.resize(face.at_nodes.size());
  for (std::size_t e = 0; e < map.gap.size(); ++e)
    for (std::size_t g = 0; g < 4; ++g) map.gap[e][g] = gap(face.at_points[e][g]);
  const double widest = wet_gap(map, face, fill);
  map.openness.assign(face.at_nodes.size(), 1.0);
  for (int i = 0; i < face.samples; ++i)
    for (int j = 0; j < face.samples; ++j) {
      const std::size_t k = i * face.samples + j;
      if (face.covered_nodes[k]) map.openness[k] = openness(face, i, j, approach + widest - roughness);
      map.wet[k] = map.openness[k] < 1.0;
      for (std::size_t g = 0; g < 4; ++g) map.resin[k][g] = face.covered[k][g] && map.gap[k][g] <= widest;
    }
  return map;
}

FilmBearing::FilmBearing(const FabricGeometry& fabric, const CompactionLaw& law, double shear_angle,
                         const FilmSpec& spec)
    : cell_(unit_cell(fabric, shear_angle)), plate_(plate_contact(fabric, law, shear_angle)), spec_(spec) {
  check_spec(spec);
  for (int samples = coarsest; samples <= spec.samples; samples *= 2)
    faces_.push_back(face_depth(cell_, samples));
}

FilmMap FilmBearing::map(double approach) const {
  return film_map(cell_, faces_.back(), approach, spec_.roughness, spec_.fill);
}

// From coarse to fine: the edge of the broken film moves by a layer of nodes an iteration, so each grid
// starts from where the coarser one left it.
FilmPressure FilmBearing::film(double approach, const Vector2d& sliding) const {
  FilmPressure result;
  std::vector<double> start;
  for (const FaceDepth& face : faces_) {
    const FilmMap map = film_map(cell_, face, approach, spec_.roughness, spec_.fill);
    result = solve_reynolds(map, spec_.fluid, sliding, {}, std::move(start));
    start = refine_pressure(map, result.pressure);
  }
  return result;
}

FilmState FilmBearing::state(double pressure, double speed, double direction) const {
  const Vector2d along(std::cos(direction), std::sin(direction)), left(-along.y(), along.x());
  FilmState state;
  LoadBalance balance(*this, pressure, speed * along, state);
  balance.solve(spec_.roughness);
  state.converged = state.reason.empty() && std::abs(std::log(state.pressure() / pressure)) < 1e-3;
  if (!state.converged && state.reason.empty()) state.reason = "the load was not met to 1e-3";
  state.least_gap = spec_.roughness + std::max(-state.approach, 0.0);
  state.touched_fraction = state.approach > 0.0 ? plate_.touched_fraction(state.approach) : 0.0;
  state.along = state.film_traction.dot(along) + spec_.boundary_friction * state.solid_load;
  state.across = -state.film_traction.dot(left);
  state.ruptured_share_of_drag = balance.ruptured_.dot(along) / state.along;
  return state;
}

std::vector<FilmState> friction_by_direction(const FilmBearing& bearing, double pressure, double speed,
                                             const std::vector<double>& directions) {
  std::vector<FilmState> states;
  for (const double direction : directions) states.push_back(bearing.state(pressure, speed, direction));
  return states;
}

double anisotropy(const std::vector<FilmState>& states) {
  const auto [low, high] = std::minmax_element(
      states.begin(), states.end(), [](const FilmState& a, const FilmState& b) { return a.along < b.along; });
  return high->along / low->along - 1.0;
}

}  // namespace heddle::mesoscale
