#include "mesoscale/level_set.h"

#include <fmt/format.h>

#include <Eigen/Dense>
#include <algorithm>
#include <cmath>
#include <limits>
#include <numbers>

#include "core/problem.h"

namespace heddle::mesoscale {

namespace {

using Eigen::Matrix2d;
using Eigen::Vector2d;
using Eigen::Vector3d;

// Value and two derivatives of a function of one number.
struct Jet {
  double f, d, dd;
};

const UnitCell::Tow& family(const UnitCell& cell, const TowPiece& tow) {
  return cell.tow[tow.direction == TowDirection::warp ? 0 : 1];
}
const UnitCell::Tow& other_family(const UnitCell& cell, const TowPiece& tow) {
  return cell.tow[tow.direction == TowDirection::warp ? 1 : 0];
}

// Where a place is in the tow's own directions.
struct Local {
  double along, across;
};

// Height of a tow's middle along it, with two derivatives.
class Centreline {
 public:
  Centreline(const UnitCell& cell, const TowPiece& tow)
      : cell_(cell), tow_(tow), pitch_(other_family(cell, tow).spacing) {
    const Path& path = family(cell, tow).path;
    half_ = 0.5 * height(path);
    if (const auto* arc = std::get_if<ArcPath>(&path)) {
      radius_ = arc->radius;
      wrap_ = arc->wrap();
      steepest_ = std::tan(arc->angle);
    } else {
      steepest_ = std::tan(std::get<SinePath>(path).angle());
    }
  }

  double steepest() const { return steepest_; }

  Jet at(double along) const {
    const double crossing = std::floor(along / pitch_), from = along - crossing * pitch_;
    const bool first = above(static_cast<int>(crossing)), second = above(static_cast<int>(crossing) + 1);
    if (first == second) return {first ? half_ : -half_, 0.0, 0.0};
    const Jet drop = radius_ > 0.0 ? arc_drop(from) : sine_drop(from);
    const double sign = first ? 1.0 : -1.0;
    return {sign * (half_ - drop.f), -sign * drop.d, -sign * drop.dd};
  }

 private:
  bool above(int crossing) const {
    return tow_.direction == TowDirection::warp ? cell_.weave.warp_over(tow_.index, crossing)
                                                : !cell_.weave.warp_over(crossing, tow_.index);
  }
  // ArcPath::drop and SinePath::drop with their derivatives, without asking for the same angle again and
  // again.
  Jet arc_drop(double u) const {
    if (u > 0.5 * pitch_) {
      const Jet mirrored = arc_drop(pitch_ - u);
      return {2.0 * half_ - mirrored.f, mirrored.d, -mirrored.dd};
    }
    const double v = std::min(u, wrap_), root = std::sqrt(radius_ * radius_ - v * v);
    const double on_arc = v * v / (radius_ + root);
    if (u > wrap_) return {on_arc + (u - wrap_) * steepest_, steepest_, 0.0};
    return {on_arc, u / root, radius_ * radius_ / (root * root * root)};
  }
  Jet sine_drop(double u) const {
    const double k = std::numbers::pi / pitch_;
    return {half_ * (1.0 - std::cos(k * u)), half_ * k * std::sin(k * u), half_ * k * k * std::cos(k * u)};
  }

  const UnitCell& cell_;
  TowPiece tow_;
  double pitch_, half_ = 0.0, radius_ = 0.0, wrap_ = 0.0, steepest_ = 0.0;
};

// Half a section's outline by a parameter v in which it is smooth up to the edges.
struct Profile {
  Jet across, height;
};

// The lens by the place across it.
class LensOutline {
 public:
  explicit LensOutline(const LensSection& lens)
      : half_width_(0.5 * lens.width), half_thickness_(0.5 * lens.thickness), radius_(lens.radius()) {}

  double half_width() const { return half_width_; }
  double edge() const { return half_width_; }
  double above(double across) const { return std::clamp(across, -half_width_, half_width_); }
  double steepest() const { return half_width_ / std::sqrt(radius_ * radius_ - half_width_ * half_width_); }
  double half_height(double across) const {
    return std::abs(across) < half_width_ ? at(across).height.f : 0.0;
  }
  Profile at(double v) const {
    const double root = std::sqrt(radius_ * radius_ - v * v);
    return {
        {v, 1.0, 0.0},
        {half_thickness_ - v * v / (radius_ + root), -v / root, -radius_ * radius_ / (root * root * root)}};
  }

 private:
  double half_width_, half_thickness_, radius_;
};

// The power ellipse by its angle from the crown: w/2 sin v, t/2 cos^n v.
class PowerEllipseOutline {
 public:
  explicit PowerEllipseOutline(const PowerEllipseSection& section)
      : section_(section), a_(0.5 * section.width), b_(0.5 * section.thickness) {}

  double half_width() const { return a_; }
  // But for the ellipse, powers of the cosine are not smooth where it vanishes: the outline ends 5e-7 of the
  // width short of the edge, far below any voxel.
  double edge() const { return 0.5 * std::numbers::pi - (section_.power == 1.0 ? 0.0 : 1e-3); }
  double above(double across) const { return std::asin(std::clamp(across / a_, -1.0, 1.0)); }
  double steepest() const { return std::numeric_limits<double>::infinity(); }
  double half_height(double across) const { return section_.half_height(across); }
  Profile at(double v) const {
    const double n = section_.power, s = std::sin(v), c = std::cos(v);
    const double falling = n * std::pow(c, n - 1.0) * s;
    const double bent = n == 1.0 ? 0.0 : n * (n - 1.0) * std::pow(c, n - 2.0) * s * s;
    const double height = std::pow(c, n);
    return {{a_ * s, a_ * c, -a_ * s}, {b_ * height, -b_ * falling, b_ * (bent - n * height)}};
  }

 private:
  PowerEllipseSection section_;
  double a_, b_;
};

// The capped lens by the place across it; its bend jumps where the arc ends.
class CappedLensOutline {
 public:
  explicit CappedLensOutline(const CappedLensSection& section)
      : section_(section), radius_(section.radius()), flank_(std::tan(section.angle)) {}

  double half_width() const { return 0.5 * section_.width; }
  double edge() const { return half_width(); }
  double above(double across) const { return std::clamp(across, -half_width(), half_width()); }
  double steepest() const { return flank_; }
  double half_height(double across) const { return section_.half_height(across); }
  Profile at(double v) const {
    const double height = 0.5 * section_.thickness - section_.drop(v);
    if (std::abs(v) > section_.cap) return {{v, 1.0, 0.0}, {height, v > 0.0 ? -flank_ : flank_, 0.0}};
    const double root = std::sqrt(radius_ * radius_ - v * v);
    return {{v, 1.0, 0.0}, {height, -v / root, -radius_ * radius_ / (root * root * root)}};
  }

 private:
  CappedLensSection section_;
  double radius_, flank_;
};

LensOutline outline(const LensSection& section) {
  return LensOutline(section);
}
PowerEllipseOutline outline(const PowerEllipseSection& section) {
  return PowerEllipseOutline(section);
}
CappedLensOutline outline(const CappedLensSection& section) {
  return CappedLensOutline(section);
}

// Surface of one tow piece: two faces S(u, v), by u along the tow and v across it, and two cuts.
template <class Upper, class Lower>
class TowSurface {
 public:
  TowSurface(const UnitCell& cell, const TowPiece& tow, const Upper& upper, const Lower& lower)
      : centre_(cell, tow),
        upper_(upper),
        lower_(lower),
        edge_height_(edge_height(family(cell, tow).section)),
        pitch_(other_family(cell, tow).spacing),
        middle_(tow.index * family(cell, tow).spacing),
        warp_(tow.direction == TowDirection::warp),
        sin_(std::sin(cell.shear_angle)),
        cos_(std::cos(cell.shear_angle)) {
    along_ = {1.0, 0.0, 0.0};
    across_ = {sin_, cos_, 0.0};
    if (!warp_) std::swap(along_, across_);
    const int crossings = warp_ ? cell.weave.wefts : cell.weave.warps;
    first_cut_ = -0.5 * pitch_;
    last_cut_ = (crossings - 0.5) * pitch_;
    slope_ = (std::max(upper.steepest(), lower.steepest()) + centre_.steepest()) / cos_;
  }

  double distance(const Vector3d& q) const {
    const double eta = q.y() / cos_, xi = q.x() - eta * sin_;
    const Local at = warp_ ? Local{xi, eta - middle_} : Local{eta, xi - middle_};
    const double height = over_edges(q, std::clamp(at.along, first_cut_, last_cut_));
    double nearest = face_distance(q, at, height);
    // The cuts run along the other tow direction, at cos g of the way; their rims belong to the faces.
    for (const double cut : {first_cut_, last_cut_}) {
      const double away = (at.along - cut) * cos_;
      const double foot = at.across + (at.along - cut) * sin_;
      if (within(over_edges(q, cut), foot)) nearest = std::min(nearest, std::abs(away));
    }
    const bool inside = between_cuts(at) && within(height, at.across);
    return inside ? -nearest : nearest;
  }

 private:
  struct Value {
    double energy;      // half the square of the distance
    Vector2d slope;     // in u and v
    Matrix2d tangents;  // S_a . S_b
    Matrix2d bend;      // r . S_ab
  };

  // Over the line from edge to edge of the section at a place along the tow.
  double over_edges(const Vector3d& q, double along) const {
    return q.z() - centre_.at(along).f - edge_height_;
  }
  bool between_cuts(const Local& at) const { return at.along > first_cut_ && at.along < last_cut_; }
  bool within(double height, double across) const {
    return -lower_.half_height(across) < height && height < upper_.half_height(across);
  }

  // The face on the point's own side of the edges is the nearer one, unless the section is thin or steep
  // there: the other is no nearer than the gap to it in z over sqrt(1 + slope^2).
  double face_distance(const Vector3d& q, const Local& at, double height) const {
    const double side = height >= 0.0 ? 1.0 : -1.0;
    const auto distance = [&](double of) {
      return of > 0.0 ? foot_distance(q, at, of, upper_) : foot_distance(q, at, of, lower_);
    };
    const double near = distance(side);
    const bool over_the_tow = between_cuts(at) && std::abs(at.across) < upper_.half_width();
    const double other = side > 0.0 ? lower_.half_height(at.across) : upper_.half_height(at.across);
    const double gap = std::abs(height) + other;
    if (over_the_tow && gap > near * std::sqrt(1.0 + slope_ * slope_)) return near;
    return std::min(near, distance(-side));
  }

  template <class Half>
  double foot_distance(const Vector3d& q, const Local& start, double side, const Half& half) const {
    const Vector2d low{first_cut_, -half.edge()}, high{last_cut_, half.edge()};
    Vector2d at = Vector2d(start.along, half.above(start.across)).cwiseMax(low).cwiseMin(high);
    Value now = value(q, at, side, half);
    double damping = 0.0;
    for (int k = 0; k < 60; ++k) {
      const Vector2d next = step(now, at, damping, low, high), moved = next - at;
      // In place, not in parameters. The distance is wrong by the square of what is left, over itself.
      if (moved.dot(now.tangents * moved) < 1e-12 * pitch_ * pitch_) break;
      const Value then = value(q, next, side, half);
      if (then.energy <= now.energy) {
        at = next;
        now = then;
        damping *= 0.1;
        if (damping < 1e-3) damping = 0.0;
      } else {
        damping = std::max(10.0 * damping, 0.1);
        if (damping > 1e6) break;  // no lower place in any neighbourhood that rounding can tell
      }
    }
    return std::sqrt(2.0 * now.energy);
  }

  template <class Half>
  Value value(const Vector3d& q, const Vector2d& at, double side, const Half& half) const {
    const Jet path = centre_.at(at[0]);
    const Profile p = half.at(at[1]);
    const Vector3d up = Vector3d::UnitZ();
    const Vector3d s =
        at[0] * along_ + (middle_ + p.across.f) * across_ + (path.f + edge_height_ + side * p.height.f) * up;
    const Vector3d su = along_ + path.d * up, sv = p.across.d * across_ + side * p.height.d * up;
    const Vector3d svv = p.across.dd * across_ + side * p.height.dd * up;
    const Vector3d r = s - q;
    Value result;
    result.energy = 0.5 * r.squaredNorm();
    result.slope = {r.dot(su), r.dot(sv)};
    result.tangents << su.squaredNorm(), su.dot(sv), su.dot(sv), sv.squaredNorm();
    result.bend << r.z() * path.dd, 0.0, 0.0, r.dot(svv);
    return result;
  }

  // Newton's step, damped, on the rectangle of the parameters: one that leaves it stops at its edge and the
  // other parameter is solved alone.
  Vector2d step(const Value& now, const Vector2d& at, double damping, const Vector2d& low,
                const Vector2d& high) const {
    Matrix2d h = now.tangents + now.bend;
    if (!(h(0, 0) > 0.0 && h(1, 1) > 0.0 && h.determinant() > 1e-6 * h(0, 0) * h(1, 1))) h = now.tangents;
    h.diagonal() += damping * now.tangents.diagonal();
    Vector2d next = at - h.inverse() * now.slope;
    for (int c = 0; c < 2; ++c) {
      const double held = std::clamp(next[c], low[c], high[c]);
      if (held == next[c]) continue;
      const int other = 1 - c;
      Vector2d result;
      result[c] = held;
      result[other] = std::clamp(at[other] - (now.slope[other] + h(0, 1) * (held - at[c])) / h(other, other),
                                 low[other], high[other]);
      return result;
    }
    return next;
  }

  Centreline centre_;
  Upper upper_;
  Lower lower_;
  double edge_height_, pitch_, middle_;
  bool warp_;
  double sin_, cos_, slope_ = 0.0;
  double first_cut_ = 0.0, last_cut_ = 0.0;
  Vector3d along_, across_;
};

// Calls use(surface) with the surface of a tow piece, whatever its section.
template <class Use>
auto with_surface(const UnitCell& cell, const TowPiece& tow, const Use& use) {
  const Section& section = family(cell, tow).section;
  return std::visit(
      [&](const auto& upper, const auto& lower) {
        return use(TowSurface(cell, tow, outline(upper), outline(lower)));
      },
      section.upper, section.lower);
}

int crossings(const UnitCell& cell, const TowPiece& tow) {
  return tow.direction == TowDirection::warp ? cell.weave.wefts : cell.weave.warps;
}

}  // namespace

std::vector<TowPiece> tow_pieces(const UnitCell& cell) {
  std::vector<TowPiece> tows;
  for (int i = 0; i < cell.weave.warps; ++i) tows.push_back({TowDirection::warp, i});
  for (int j = 0; j < cell.weave.wefts; ++j) tows.push_back({TowDirection::weft, j});
  return tows;
}

double tow_distance(const UnitCell& cell, const TowPiece& tow, const std::array<double, 3>& place) {
  return with_surface(cell, tow, [&](const auto& surface) {
    return surface.distance({place[0], place[1], place[2]});
  });
}

LevelSet tow_level_set(const UnitCell& cell, const TowPiece& tow, double voxel, double half_width_voxels) {
  const UnitCell::Tow& own = family(cell, tow);
  const double thickness = mesoscale::thickness(own.section);
  if (!(voxel > 0.0) || voxel > 0.2 * thickness)
    throw InputError(
        {{"level_set.voxel.range"_rule, "voxel", fmt::format("{} mm", 1e3 * voxel),
          fmt::format("must satisfy 0 < voxel <= a fifth of the tow thickness, {} mm", 0.2e3 * thickness),
          "Write 0.05 mm for the tow of Table 1."}});
  const double pitch = other_family(cell, tow).spacing;
  const double start = -0.5 * pitch, end = start + crossings(cell, tow) * pitch;
  const double side = 0.5 * width(own.section), middle = tow.index * own.spacing;
  const double top = 0.5 * (height(own.path) + thickness);
  Box box{{1e300, 1e300, -top}, {-1e300, -1e300, top}};
  for (const double along : {start, end})
    for (const double across : {middle - side, middle + side}) {
      const auto corner =
          tow.direction == TowDirection::warp ? cell.place(along, across) : cell.place(across, along);
      for (std::size_t c = 0; c < 2; ++c) {
        box.low[c] = std::min(box.low[c], corner[c]);
        box.high[c] = std::max(box.high[c], corner[c]);
      }
    }
  return with_surface(cell, tow, [&](const auto& surface) {
    return level_set_from_distance(
        [&](double x, double y, double z) {
          return surface.distance({x, y, z});
        },
        box, voxel, half_width_voxels);
  });
}

LevelSetCheck level_set_check(const UnitCell& cell, double voxel) {
  LevelSetCheck check;
  check.voxel = voxel;
  check.tows = tow_pieces(cell);
  std::vector<LevelSet> sets;
  for (const TowPiece& tow : check.tows) {
    sets.push_back(tow_level_set(cell, tow, voxel));
    check.tow_volume.push_back(volume(sets.back()));
    check.closed_form_volume.push_back(area(family(cell, tow).section) * other_family(cell, tow).spacing *
                                       std::cos(cell.shear_angle) * crossings(cell, tow));
    check.closed_form_total += check.closed_form_volume.back();
    check.memory += sets.back().memory();
  }
  check.largest_depth = -std::numeric_limits<double>::infinity();
  const std::size_t warps = static_cast<std::size_t>(cell.weave.warps);
  for (std::size_t i = 0; i < warps; ++i)
    for (std::size_t j = warps; j < sets.size(); ++j) {
      const Overlap shared = overlap(sets[i], sets[j]);
      check.overlap_volume += shared.volume;
      check.largest_depth = std::max(check.largest_depth, shared.depth);
    }
  check.overlap_share = check.overlap_volume / check.closed_form_total;
  return check;
}

TowBodies tow_bodies(const UnitCell& cell) {
  const double thinnest = std::min(thickness(cell.tow[0].section), thickness(cell.tow[1].section));
  const LevelSetCheck check = level_set_check(cell, thinnest / 7.5);
  const Penetration heights = penetration(cell, 64);
  // Heights of 1e-3 m are rounded to 1e-19 m: below 1e-15 m tows touch and no more.
  const bool touch = std::abs(heights.depth) < 1e-15;
  TowBodies bodies{check.voxel,
                   0.0,
                   check.overlap_share,
                   check.largest_depth,
                   touch ? 0.0 : heights.depth,
                   touch ? 0.0 : heights.volume};
  for (std::size_t k = 0; k < check.tows.size(); ++k)
    bodies.volume_error =
        std::max(bodies.volume_error, std::abs(check.tow_volume[k] / check.closed_form_volume[k] - 1.0));
  return bodies;
}

}  // namespace heddle::mesoscale
