#include "macroscale/tool_band.h"

#include <fmt/format.h>
#include <tbb/parallel_for.h>

#include <Eigen/Geometry>
#include <algorithm>
#include <cmath>
#include <limits>
#include <stdexcept>
#include <utility>

namespace heddle::macroscale {

namespace {

using Eigen::Array4d;
using Eigen::Matrix3d;
using Eigen::Vector3d;

constexpr int block = LevelSet::block;

// Quadratic B-spline about the nearest sample: weights of the three samples and their derivatives.
struct Weights {
  std::array<double, 3> w, d, dd;
};

Weights weights(double t, double inverse_voxel) {
  const double left = 0.5 - t, right = 0.5 + t, second = inverse_voxel * inverse_voxel;
  return {{0.5 * left * left, 0.75 - t * t, 0.5 * right * right},
          {-left * inverse_voxel, -2.0 * t * inverse_voxel, right * inverse_voxel},
          {second, -2.0 * second, second}};
}

// Samples of 12^3 voxels about a block, and the coefficients of the inner 10^3.
class Prefilter {
 public:
  static constexpr int in = block + 4, out = block + 2;

  void read(const LevelSet& set, const std::array<int, 3>& origin) {
    set.read({origin[0] - 2, origin[1] - 2, origin[2] - 2}, in, f_.data());
  }

  struct Extremes {
    float low = std::numeric_limits<float>::infinity(), high = -low, size = low;
  };
  // Smallest and largest value, and smallest size, over the block itself and a rim of one voxel.
  Extremes extremes() const {
    Extremes found;
    for_inner([&](std::size_t n, std::size_t) {
      found.low = std::min(found.low, f_[n]);
      found.high = std::max(found.high, f_[n]);
      found.size = std::min(found.size, std::abs(f_[n]));
    });
    return found;
  }

  void write(float* coefficients) const {
    for_inner([&](std::size_t n, std::size_t m) {
      const double f = f_[n];
      const double second = f_[n - in * in] + static_cast<double>(f_[n + in * in]) + f_[n - in] + f_[n + in] +
                            f_[n - 1] + f_[n + 1] - 6.0 * f;
      coefficients[m] = static_cast<float>(f - 0.125 * second);
    });
  }

 private:
  template <class Visit>
  void for_inner(const Visit& visit) const {
    std::size_t m = 0;
    for (std::size_t i = 1; i + 1 < in; ++i)
      for (std::size_t j = 1; j + 1 < in; ++j)
        for (std::size_t k = 1; k + 1 < in; ++k) visit((i * in + j) * in + k, m++);
  }

  std::array<float, in * in * in> f_;
};

struct MeshSize {
  double area = 0.0;
  Vector3d low = Vector3d::Constant(std::numeric_limits<double>::infinity());
  Vector3d high = -low;
};

Vector3d vertex(const TriangleMesh& mesh, int index) {
  const auto& v = mesh.vertices[static_cast<std::size_t>(index)];
  return {v[0], v[1], v[2]};
}

bool meets(const Box& a, const Box& b) {
  for (std::size_t c = 0; c < 3; ++c)
    if (a.high[c] < b.low[c] || a.low[c] > b.high[c]) return false;
  return true;
}

Box block_box(const std::array<int, 3>& origin, double voxel) {
  Box box;
  for (std::size_t c = 0; c < 3; ++c) {
    box.low[c] = voxel * (origin[c] - 0.5);
    box.high[c] = voxel * (origin[c] + block - 0.5);
  }
  return box;
}

Box larger(Box box, double by) {
  for (std::size_t c = 0; c < 3; ++c) {
    box.low[c] -= by;
    box.high[c] += by;
  }
  return box;
}

// Size of what meets the region; a triangle that reaches out of it counts whole.
MeshSize size_of(const TriangleMesh& mesh, const Box& region = everywhere) {
  MeshSize size;
  for (const auto& t : mesh.triangles) {
    const Vector3d a = vertex(mesh, t[0]), b = vertex(mesh, t[1]), c = vertex(mesh, t[2]);
    Box box;
    Vector3d::Map(box.low.data()) = a.cwiseMin(b).cwiseMin(c);
    Vector3d::Map(box.high.data()) = a.cwiseMax(b).cwiseMax(c);
    if (!meets(box, region)) continue;
    size.area += 0.5 * (b - a).cross(c - a).norm();
    size.low = size.low.cwiseMin(a).cwiseMin(b).cwiseMin(c);
    size.high = size.high.cwiseMax(a).cwiseMax(b).cwiseMax(c);
  }
  return size;
}

// Number of edges that are not shared by two triangles, one each way.
std::size_t open_edges(const TriangleMesh& mesh) {
  std::vector<std::pair<int, int>> forth, back;
  forth.reserve(3 * mesh.triangles.size());
  back.reserve(3 * mesh.triangles.size());
  for (const auto& t : mesh.triangles)
    for (std::size_t k = 0; k < 3; ++k) {
      const int a = t[k], b = t[(k + 1) % 3];
      forth.emplace_back(a, b);
      back.emplace_back(b, a);
    }
  std::sort(forth.begin(), forth.end());
  std::sort(back.begin(), back.end());
  std::vector<std::pair<int, int>> single;
  std::set_difference(forth.begin(), forth.end(), back.begin(), back.end(), std::back_inserter(single));
  return single.size();
}

double level_set_half_width(const ToolBandSpec& spec) {
  return spec.half_width / spec.voxel + ToolBand::rim;
}

std::string millimetres(double metres) {
  return fmt::format("{:.4g} mm", 1e3 * metres);
}

}  // namespace

double required_half_width(double tool_step, double thickness, double largest_increment) {
  return tool_step + thickness + largest_increment;
}

ToolBand::ToolBand(const LevelSet& level_set, double half_width, Sides sides, const Box& region)
    : voxel_(level_set.voxel()),
      inverse_voxel_(1.0 / voxel_),
      half_width_(half_width),
      sides_(sides),
      region_(region) {
  if (!(half_width > 0.0) || level_set.half_width() < half_width + (rim - 1e-6) * voxel_)
    throw std::invalid_argument(
        fmt::format("a tool band of {} needs a level set of {}", half_width, half_width + rim * voxel_));
  const std::vector<std::array<int, 3>> blocks = level_set.blocks();
  if (blocks.empty()) throw std::invalid_argument("a tool band needs a level set with a surface in it");
  std::array<int, 3> last = blocks.front();
  first_ = last;
  for (const auto& b : blocks)
    for (std::size_t c = 0; c < 3; ++c) {
      first_[c] = std::min(first_[c], b[c]);
      last[c] = std::max(last[c], b[c]);
    }
  for (std::size_t c = 0; c < 3; ++c) {
    blocks_[c] = (last[c] - first_[c]) / block + 1;
    first_[c] /= block;
  }
  const auto place = [&](const std::array<int, 3>& b) {
    return (static_cast<std::size_t>(b[0] / block - first_[0]) * blocks_[1] + (b[1] / block - first_[1])) *
               blocks_[2] +
           (b[2] / block - first_[2]);
  };

  // A block matters if some point that is nearest to one of its voxels lies in the promised band.
  const auto reach = static_cast<float>(half_width + 0.5 * std::sqrt(3.0) * voxel_);
  std::vector<Prefilter::Extremes> extremes(blocks.size());
  std::vector<std::uint8_t> in_region(blocks.size());
  tbb::parallel_for(std::size_t{0}, blocks.size(), [&](std::size_t n) {
    Prefilter samples;
    samples.read(level_set, blocks[n]);
    extremes[n] = samples.extremes();
    in_region[n] = meets(region_, block_box(blocks[n], voxel_));
  });
  float lowest = 0.0f;
  for (std::size_t n = 0; n < blocks.size(); ++n)
    if (in_region[n]) lowest = std::min(lowest, extremes[n].low);
  depth_ = -lowest;

  table_.resize(static_cast<std::size_t>(blocks_[0]) * blocks_[1] * blocks_[2]);
  tbb::parallel_for(std::size_t{0}, table_.size(), [&](std::size_t n) {
    const int k = static_cast<int>(n) % blocks_[2], j = static_cast<int>(n) / blocks_[2] % blocks_[1],
              i = static_cast<int>(n) / blocks_[2] / blocks_[1];
    float middle;
    level_set.read({(first_[0] + i) * block + block / 2, (first_[1] + j) * block + block / 2,
                    (first_[2] + k) * block + block / 2},
                   1, &middle);
    table_[n] = middle < 0.0f ? inside : outside;
  });
  std::vector<std::array<int, 3>> kept;
  for (std::size_t n = 0; n < blocks.size(); ++n) {
    std::int32_t& entry = table_[place(blocks[n])];
    if (!in_region[n]) {
      entry = extremes[n].high < 0.0f ? inside : extremes[n].low > 0.0f ? outside : unknown;
    } else if (extremes[n].size <= reach) {
      entry = static_cast<std::int32_t>(kept.size());
      kept.push_back(blocks[n]);
    }
  }
  // A row of three is read as four: one more at the very end.
  brick_.resize(kept.size() * brick_size + 1);
  tbb::parallel_for(std::size_t{0}, kept.size(), [&](std::size_t n) {
    Prefilter samples;
    samples.read(level_set, kept[n]);
    samples.write(&brick_[n * brick_size]);
  });
}

std::size_t ToolBand::memory() const {
  return sizeof *this + table_.size() * sizeof(table_[0]) + brick_.size() * sizeof(brick_[0]);
}

bool ToolBand::in_region(const Vector3d& x) const {
  const Eigen::Map<const Vector3d> low(region_.low.data()), high(region_.high.data());
  return (x.array() >= low.array()).all() && (x.array() <= high.array()).all();
}

std::int32_t ToolBand::brick_at(const std::array<int, 3>& voxel) const {
  std::size_t place = 0;
  for (std::size_t c = 0; c < 3; ++c) {
    int b = (voxel[c] >> 3) - first_[c];
    if (b < 0 || b >= blocks_[c]) {
      if (sides_ == Sides::closed) return outside;
      b = std::clamp(b, 0, blocks_[c] - 1);
    }
    place = place * static_cast<std::size_t>(blocks_[c]) + static_cast<std::size_t>(b);
  }
  const std::int32_t found = table_[place];
  return found;
}

Distance ToolBand::beyond(const Vector3d& x, bool within) const {
  constexpr double infinity = std::numeric_limits<double>::infinity();
  if (within) return {-infinity, Vector3d::UnitZ(), Matrix3d::Zero()};
  // The surface lies in the box of the table: no nearer than the box.
  Vector3d away = Vector3d::Zero();
  for (int c = 0; c < 3; ++c) {
    const double low = first_[static_cast<std::size_t>(c)] * block * voxel_;
    const double high = low + blocks_[static_cast<std::size_t>(c)] * block * voxel_;
    away[c] = x[c] - std::clamp(x[c], low, high);
  }
  const double far = away.norm();
  return {std::max(half_width_, far), far > 0.0 ? Vector3d(away / far) : Vector3d(Vector3d::UnitZ()),
          Matrix3d::Zero()};
}

double ToolBand::rough_distance(const Vector3d& x) const {
  constexpr double infinity = std::numeric_limits<double>::infinity();
  if (in_region(x)) return evaluate(x).distance;
  std::array<int, 3> nearest;
  for (int c = 0; c < 3; ++c) {
    const double whole = std::floor(x[c] * inverse_voxel_ + 0.5);
    if (!(std::abs(whole) < 1e9)) return infinity;
    nearest[static_cast<std::size_t>(c)] = static_cast<int>(whole);
  }
  return brick_at(nearest) == inside ? -infinity : infinity;
}

Distance ToolBand::evaluate(const Vector3d& x) const {
  std::array<int, 3> nearest;
  std::array<double, 3> offset;
  for (int c = 0; c < 3; ++c) {
    const double s = x[c] * inverse_voxel_, whole = std::floor(s + 0.5);
    if (!(std::abs(whole) < 1e9)) {  // no integer holds it; NaN comes out as NaN
      if (std::isfinite(x[c])) return beyond(x, false);
      return {std::numeric_limits<double>::quiet_NaN(), Vector3d::UnitZ(), Matrix3d::Zero()};
    }
    nearest[static_cast<std::size_t>(c)] = static_cast<int>(whole);
    offset[static_cast<std::size_t>(c)] = s - whole;
  }
  if (!in_region(x)) return beyond(x, true);
  const std::int32_t brick = brick_at(nearest);
  if (brick < 0) return beyond(x, brick != outside);

  const Weights wx = weights(offset[0], inverse_voxel_), wy = weights(offset[1], inverse_voxel_),
                wz = weights(offset[2], inverse_voxel_);
  // First of the 27: the rim puts voxel 0 of the block at 1, and the stencil starts one before the nearest.
  const float* first = &brick_[static_cast<std::size_t>(brick) * brick_size] +
                       ((nearest[0] & (block - 1)) * brick_row + (nearest[1] & (block - 1))) * brick_row +
                       (nearest[2] & (block - 1));
  // Along x, then y, then z; the fourth of each row is read and not used. Suffixes are orders of derivative.
  Array4d s00 = Array4d::Zero(), s10 = s00, s20 = s00, s01 = s00, s11 = s00, s02 = s00;
  for (std::size_t j = 0; j < 3; ++j) {
    Array4d v0 = Array4d::Zero(), v1 = v0, v2 = v0;
    for (std::size_t i = 0; i < 3; ++i) {
      const Array4d row =
          Eigen::Map<const Eigen::Array4f>(first + (i * brick_row + j) * brick_row).cast<double>();
      v0 += wx.w[i] * row;
      v1 += wx.d[i] * row;
      v2 += wx.dd[i] * row;
    }
    s00 += wy.w[j] * v0;
    s10 += wy.w[j] * v1;
    s20 += wy.w[j] * v2;
    s01 += wy.d[j] * v0;
    s11 += wy.d[j] * v1;
    s02 += wy.dd[j] * v0;
  }
  const auto along = [](const Array4d& s, const std::array<double, 3>& w) {
    return w[0] * s[0] + w[1] * s[1] + w[2] * s[2];
  };
  Distance d;
  d.distance = along(s00, wz.w);
  if (d.distance < -half_width_) return beyond(x, true);
  d.normal = {along(s10, wz.w), along(s01, wz.w), along(s00, wz.d)};
  const double xy = along(s11, wz.w), xz = along(s10, wz.d), yz = along(s01, wz.d);
  d.curvature << along(s20, wz.w), xy, xz, xy, along(s02, wz.w), yz, xz, yz, along(s00, wz.dd);
  return d;
}

Distance evaluate(const ToolBand& band, const Vector3d& x) {
  return band.evaluate(x);
}

double estimated_memory(const TriangleMesh& mesh, const ToolBandSpec& spec) {
  const MeshSize size = size_of(mesh);
  const double area_in_region = size_of(mesh, larger(spec.region, spec.half_width)).area;
  // Blocks that a band of this width cuts: as thick as the band and, on average over all directions, one and
  // a half blocks more.
  const double side = block * spec.voxel;
  const auto blocks_cut = [&](double area, double half_width) {
    return area * (2.0 * half_width + 1.5 * side) / (side * side * side);
  };
  const double leaf = block * block * block * sizeof(float) + 256.0, brick = 1000.0 * sizeof(float);
  // The surface's own voxels with a triangle each; the band, with a triangle each while it grows; the bricks.
  const double surface = 2.0 * leaf * blocks_cut(size.area, 3.0 * spec.voxel);
  const double level_set = 2.0 * leaf * blocks_cut(area_in_region, spec.voxel * level_set_half_width(spec));
  const double bricks = brick * blocks_cut(area_in_region, spec.half_width + 2.0 * spec.voxel);
  const Eigen::Array3d across = (size.high - size.low).array() / side + 4.0;
  constexpr double per_triangle = 300.0;  // triangles about each vertex, list of edges
  return surface + level_set + bricks + across.prod() * sizeof(std::int32_t) +
         per_triangle * static_cast<double>(mesh.triangles.size());
}

Problems check(const TriangleMesh& mesh, const ToolBandSpec& spec, const std::string& key) {
  Problems problems;
  if (mesh.triangles.empty())
    problems.push_back(
        {"*.empty"_family.of(key), key, "0 triangles", "must have a surface", "Check the tool's file."});
  if (!(spec.voxel > 0.0) || !std::isfinite(spec.voxel))
    problems.push_back({"*.range"_family.of(key + ".voxel"), key + ".voxel", millimetres(spec.voxel),
                        "must satisfy voxel > 0",
                        "Write a twentieth of the smallest radius that touches the fabric."});
  if (!(spec.half_width > 0.0) || !std::isfinite(spec.half_width))
    problems.push_back(
        {"*.band.range"_family.of(key), key + ".band", millimetres(spec.half_width),
         "must satisfy band half width > 0",
         "Write the tool's step plus the fabric's thickness plus the largest Newton increment."});
  if (!problems.empty()) return problems;
  for (std::size_t n = 0; n < mesh.vertices.size(); ++n)
    for (double c : mesh.vertices[n])
      if (!std::isfinite(c)) {
        problems.push_back({"*.finite"_family.of(key), key, fmt::format("vertex {}", n),
                            "must have finite coordinates", "Check the tool's file."});
        return problems;
      }
  for (const auto& t : mesh.triangles)
    for (int v : t)
      if (v < 0 || static_cast<std::size_t>(v) >= mesh.vertices.size()) {
        problems.push_back({"*.index"_family.of(key), key, fmt::format("vertex {}", v),
                            "must have triangles between vertices that exist", "Check the tool's file."});
        return problems;
      }
  if (spec.sides == Sides::closed) {
    const std::size_t open = open_edges(mesh);
    if (open > 0)
      problems.push_back({"*.closed"_family.of(key), key, fmt::format("{} open edges", open),
                          "a tool's surface must be closed, or said to be a sheet with its normals outward",
                          "Close the surface, or say that the mesh is open."});
  }
  const double memory = estimated_memory(mesh, spec);
  if (memory > spec.memory_limit) {
    // Memory grows at least with the square of 1 / voxel: a voxel on the safe side.
    const double voxel = spec.voxel * std::sqrt(memory / spec.memory_limit) * 1.1;
    problems.push_back(
        {"*.voxel.memory"_family.of(key), key + ".voxel", millimetres(spec.voxel),
         fmt::format("must let the tool's distance field fit into {:.0f} MB; this one needs about {:.0f} MB",
                     1e-6 * spec.memory_limit, 1e-6 * memory),
         fmt::format("Write a voxel of {} or more, or a narrower band.", millimetres(voxel))});
  }
  return problems;
}

namespace {

// What is thinner than a voxel has hardly a point inside, whose depth says nothing of the thickness.
std::string thickness_in_words(double thickness, double voxel) {
  return thickness > voxel ? fmt::format("{} at its thickest", millimetres(thickness))
                           : fmt::format("less than a voxel of {} at its thickest", millimetres(voxel));
}

}  // namespace

ToolBand tool_band(const TriangleMesh& mesh, const ToolBandSpec& spec, const std::string& key) {
  Problems problems = check(mesh, spec, key);
  if (!problems.empty()) throw InputError(std::move(problems));
  // The splines of the region's outermost blocks read a little of those next to them.
  const Box known = larger(spec.region, 2.0 * block * spec.voxel);
  ToolBand band(level_set_from_mesh(mesh, spec.voxel, level_set_half_width(spec), spec.sides, known),
                spec.half_width, spec.sides, spec.region);
  if (band.depth() < spec.half_width)
    throw InputError({{"*.thin"_family.of(key), key, thickness_in_words(2.0 * band.depth(), spec.voxel),
                       fmt::format("must be thicker than twice its band's half width, {}: a node pressed "
                                   "through it would count as free",
                                   millimetres(2.0 * spec.half_width)),
                       "Make the tool a thicker solid, or shorten the steps that ask for this band."}});
  return band;
}

}  // namespace heddle::macroscale
