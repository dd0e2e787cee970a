#include "core/level_set.h"

#include <openvdb/openvdb.h>
#include <openvdb/tools/LevelSetMeasure.h>
#include <openvdb/tools/MeshToVolume.h>
#include <openvdb/tools/SignedFloodFill.h>
#include <openvdb/tools/VolumeToMesh.h>
#include <openvdb/tree/LeafManager.h>
#include <tbb/blocked_range.h>
#include <tbb/parallel_for.h>
#include <tbb/parallel_reduce.h>

#include <algorithm>
#include <cmath>
#include <limits>
#include <stdexcept>
#include <tuple>
#include <utility>

#include "core/triangle_walk.h"

namespace heddle {

using openvdb::Coord;
using openvdb::CoordBBox;
using openvdb::FloatGrid;
using openvdb::Vec3d;
using Leaf = FloatGrid::TreeType::LeafNodeType;

struct LevelSet::Grid {
  FloatGrid::Ptr grid;
  double voxel;
  double half_width;
};

namespace {

static_assert(Leaf::DIM == LevelSet::block);

void start_openvdb() {
  static const bool started = (openvdb::initialize(), true);
  static_cast<void>(started);
}

void check_sizes(double voxel, double half_width_voxels) {
  if (!(voxel > 0.0) || !std::isfinite(voxel) || !(half_width_voxels >= 1.5))
    throw std::invalid_argument("a level set needs a positive voxel and a half width of 1.5 voxels or more");
}

std::array<int, 3> to_array(const Coord& c) {
  return {c.x(), c.y(), c.z()};
}

// Block that holds a coordinate, in blocks.
int block_of(double x, double voxel) {
  return static_cast<int>(std::floor(x / voxel / LevelSet::block));
}

class DistanceSampler {
 public:
  DistanceSampler(const std::function<double(double, double, double)>& distance, double voxel,
                  double half_width)
      : distance_(distance), voxel_(voxel), half_width_(half_width) {}

  // The leaf at `origin`, or null if no voxel of it lies in the band.
  std::unique_ptr<Leaf> sample(const Coord& origin) const {
    const double half = 0.5 * (LevelSet::block - 1);
    const double middle = at(origin.x() + half, origin.y() + half, origin.z() + half);
    // A distance changes no faster than the place: sqrt(3) * 3.5 voxels to the corner.
    if (std::abs(middle) > half_width_ + std::sqrt(3.0) * half * voxel_) return nullptr;
    auto leaf = std::make_unique<Leaf>(origin, static_cast<float>(half_width_), false);
    for (openvdb::Index row = 0; row < Leaf::SIZE; row += LevelSet::block) {
      const Coord c = leaf->offsetToGlobalCoord(row);
      for (int k = 0; k < LevelSet::block;) {
        const double d = at(c.x(), c.y(), c.z() + k);
        const double past = std::abs(d) - half_width_;
        if (past < 0.0) {
          leaf->setValueOn(row + k++, static_cast<float>(d));
          continue;
        }
        // For the same reason the next few are past the band too.
        for (int skip = 1 + static_cast<int>(past / voxel_); skip > 0 && k < LevelSet::block; --skip)
          leaf->setValueOff(row + k++, static_cast<float>(std::copysign(half_width_, d)));
      }
    }
    return leaf->isEmpty() ? nullptr : std::move(leaf);
  }

 private:
  double at(double i, double j, double k) const { return distance_(voxel_ * i, voxel_ * j, voxel_ * k); }

  const std::function<double(double, double, double)>& distance_;
  double voxel_, half_width_;
};

FloatGrid::Ptr empty_grid(double voxel, double half_width) {
  start_openvdb();
  FloatGrid::Ptr grid = FloatGrid::create(static_cast<float>(half_width));
  grid->setTransform(openvdb::math::Transform::createLinearTransform(voxel));
  grid->setGridClass(openvdb::GRID_LEVEL_SET);
  return grid;
}

// What meshToVolume reads: places in units of voxels, in double.
class MeshInVoxels {
 public:
  MeshInVoxels(const TriangleMesh& mesh, double voxel) : mesh_(mesh), scale_(1.0 / voxel) {}
  std::size_t polygonCount() const { return mesh_.triangles.size(); }
  std::size_t pointCount() const { return mesh_.vertices.size(); }
  std::size_t vertexCount(std::size_t) const { return 3; }
  void getIndexSpacePoint(std::size_t polygon, std::size_t corner, Vec3d& place) const {
    const auto& p = mesh_.vertices[static_cast<std::size_t>(mesh_.triangles[polygon][corner])];
    place = Vec3d(p[0], p[1], p[2]) * scale_;
  }

 private:
  const TriangleMesh& mesh_;
  double scale_;
};

// Which side of an oriented surface a place is on, by the normals of its faces, edges and corners: at an edge
// the sum of both faces, at a corner the sum weighted by angle. Source: Baerentzen & Aanaes 2005.
class SideOfSheet {
 public:
  explicit SideOfSheet(const TriangleMesh& mesh) : mesh_(mesh), corner_(mesh.vertices.size(), Vec3d(0.0)) {
    struct Side {
      std::array<int, 2> edge;
      std::size_t place;  // 3 * triangle + side
    };
    std::vector<Side> sides;
    face_.reserve(mesh.triangles.size());
    sides.reserve(3 * mesh.triangles.size());
    for (std::size_t t = 0; t < mesh.triangles.size(); ++t) {
      const auto& v = mesh.triangles[t];
      Vec3d normal = (vertex(v[1]) - vertex(v[0])).cross(vertex(v[2]) - vertex(v[0]));
      normal.normalize();
      face_.push_back(normal);
      for (std::size_t k = 0; k < 3; ++k) {
        const int a = v[k], b = v[(k + 1) % 3], c = v[(k + 2) % 3];
        sides.push_back({{std::min(a, b), std::max(a, b)}, 3 * t + k});
        const Vec3d e = vertex(b) - vertex(a), f = vertex(c) - vertex(a);
        corner_[static_cast<std::size_t>(a)] += normal * std::atan2(e.cross(f).length(), e.dot(f));
      }
    }
    std::sort(sides.begin(), sides.end(), [](const Side& a, const Side& b) {
      return std::tie(a.edge, a.place) < std::tie(b.edge, b.place);
    });
    edge_.assign(3 * mesh.triangles.size(), Vec3d(0.0));
    for (std::size_t first = 0, end = 0; first < sides.size(); first = end) {
      Vec3d sum(0.0);
      for (end = first; end < sides.size() && sides[end].edge == sides[first].edge; ++end)
        sum += face_[sides[end].place / 3];
      for (std::size_t n = first; n < end; ++n) edge_[sides[n].place] = sum;
    }
  }

  // Whether the place lies against the normals of the nearest feature of this triangle.
  bool behind(const Vec3d& q, std::size_t triangle) const {
    // Regions of a triangle: Ericson, Real-Time Collision Detection, 5.1.5.
    const auto& v = mesh_.triangles[triangle];
    const Vec3d a = vertex(v[0]), b = vertex(v[1]), c = vertex(v[2]), ab = b - a, ac = c - a;
    const auto side = [&](const Vec3d& foot, const Vec3d& normal) { return (q - foot).dot(normal) < 0.0; };
    const auto corner = [&](std::size_t k, const Vec3d& foot) {
      return side(foot, corner_[static_cast<std::size_t>(v[k])]);
    };
    const double d1 = ab.dot(q - a), d2 = ac.dot(q - a);
    if (d1 <= 0.0 && d2 <= 0.0) return corner(0, a);
    const double d3 = ab.dot(q - b), d4 = ac.dot(q - b);
    if (d3 >= 0.0 && d4 <= d3) return corner(1, b);
    if (d1 * d4 - d3 * d2 <= 0.0 && d1 >= 0.0 && d3 <= 0.0) return side(a, edge_[3 * triangle]);
    const double d5 = ab.dot(q - c), d6 = ac.dot(q - c);
    if (d6 >= 0.0 && d5 <= d6) return corner(2, c);
    if (d5 * d2 - d1 * d6 <= 0.0 && d2 >= 0.0 && d6 <= 0.0) return side(a, edge_[3 * triangle + 2]);
    if (d3 * d6 - d5 * d4 <= 0.0 && d4 - d3 >= 0.0 && d5 - d6 >= 0.0) return side(b, edge_[3 * triangle + 1]);
    return side(a, face_[triangle]);
  }

 private:
  Vec3d vertex(int index) const {
    const auto& p = mesh_.vertices[static_cast<std::size_t>(index)];
    return {p[0], p[1], p[2]};
  }

  const TriangleMesh& mesh_;
  std::vector<Vec3d> face_, edge_, corner_;
};

// Voxels of a leaf that lie beyond the band take the side of a neighbour that does not.
void spread_sides(Leaf& leaf, float beyond) {
  std::array<signed char, Leaf::SIZE> side{};
  int unknown = 0;
  for (openvdb::Index n = 0; n < Leaf::SIZE; ++n)
    if (leaf.isValueOn(n))
      side[n] = leaf.getValue(n) < 0.0f ? -1 : 1;
    else
      ++unknown;
  constexpr std::array<int, 3> stride{64, 8, 1};
  while (unknown > 0 && unknown < static_cast<int>(Leaf::SIZE)) {
    const auto before = side;
    for (int n = 0; n < static_cast<int>(Leaf::SIZE); ++n) {
      if (before[n] != 0) continue;
      for (int step : stride) {
        const int along = n / step % 8;
        signed char found = along > 0 ? before[n - step] : static_cast<signed char>(0);
        if (found == 0 && along < 7) found = before[n + step];
        if (found == 0) continue;
        side[n] = found;
        --unknown;
        break;
      }
    }
  }
  for (openvdb::Index n = 0; n < Leaf::SIZE; ++n)
    if (!leaf.isValueOn(n)) leaf.setValueOff(n, side[n] < 0 ? -beyond : beyond);
}

// Empty blocks in the box of a sheet's band take the side of the nearest block that has one, layer by layer;
// where neighbours disagree (round the sheet's edge) they are inside, which is an error for who asks and
// never a silence.
void fill_blocks(FloatGrid& grid, float beyond) {
  std::vector<Coord> leaves;
  CoordBBox box;
  for (auto leaf = grid.tree().cbeginLeaf(); leaf; ++leaf) {
    leaves.push_back(leaf->origin() >> 3);
    box.expand(leaves.back());
  }
  const Coord extent = box.dim();
  const auto place = [&](const Coord& c) {
    const Coord r = c - box.min();
    return (static_cast<std::size_t>(r.x()) * extent.y() + r.y()) * extent.z() + r.z();
  };
  std::vector<signed char> side(static_cast<std::size_t>(box.volume()), 0);  // 2: a leaf, which has both
  for (const Coord& c : leaves) side[place(c)] = 2;
  std::vector<std::pair<Coord, signed char>> layer;
  do {
    layer.clear();
    for (auto c = box.begin(); c; ++c) {
      if (side[place(*c)] != 0) continue;
      signed char found = 0;
      for (int axis = 0; axis < 3; ++axis)
        for (int step : {-1, 1}) {
          Coord neighbour = *c;
          neighbour[axis] += step;
          if (!box.isInside(neighbour) || side[place(neighbour)] == 0) continue;
          signed char there = side[place(neighbour)];
          if (there == 2) {
            Coord facing = (*c << 3) + Coord(4);
            facing[axis] = step < 0 ? (*c)[axis] * 8 - 1 : (*c)[axis] * 8 + 8;
            there = grid.tree().getValue(facing) < 0.0f ? -1 : 1;
          }
          found = found == 0 ? there : std::min(found, there);
        }
      if (found != 0) layer.emplace_back(*c, found);
    }
    for (const auto& [c, found] : layer) {
      side[place(c)] = found;
      if (found < 0) grid.tree().addTile(1, c << 3, -beyond, false);
    }
  } while (!layer.empty());
}

// meshToVolume carries the nearest triangle from voxel to voxel as its band grows, which misses nearer ones,
// worst where triangles are smaller than voxels. So it gives the band, its inner side and a triangle to start
// from, and the distances are taken anew. A sheet has no inner side but that of its normals.
void measure(FloatGrid& grid, const openvdb::Int32Grid& triangles, const TriangleMesh& mesh, double voxel,
             Sides sides) {
  const TriangleWalk walk(mesh);
  const auto sheet = sides == Sides::open ? std::make_unique<const SideOfSheet>(mesh) : nullptr;
  const float beyond = grid.background();
  openvdb::tree::LeafManager<FloatGrid::TreeType> leaves(grid.tree());
  leaves.foreach ([&](Leaf& leaf, std::size_t) {
    const auto near = triangles.getConstUnsafeAccessor();
    TriangleWalk::Nearest nearest{
        0.0, -1};  // of this leaf alone: the result must not depend on who works on which
    for (auto value = leaf.beginValueOn(); value; ++value) {
      const Coord c = value.getCoord();
      const Vec3d at = c.asVec3d() * voxel;
      const Eigen::Vector3d q(at.x(), at.y(), at.z());
      TriangleWalk::Nearest start = walk.at(std::max(near.getValue(c), 0), q);
      if (nearest.triangle >= 0) {
        const TriangleWalk::Nearest last = walk.at(nearest.triangle, q);
        if (last.squared < start.squared) start = last;
      }
      nearest = walk.from(start, q);
      const bool inside =
          sheet ? sheet->behind(at, static_cast<std::size_t>(nearest.triangle)) : *value < 0.0f;
      const auto d = static_cast<float>(std::sqrt(nearest.squared));
      value.setValue(inside ? -d : d);
    }
    if (sheet) spread_sides(leaf, beyond);
  });
  if (sheet) fill_blocks(grid, beyond);
}

}  // namespace

double LevelSet::voxel() const {
  return grid_->voxel;
}

double LevelSet::half_width() const {
  return grid_->half_width;
}

std::size_t LevelSet::active_voxels() const {
  return grid_->grid->activeVoxelCount();
}

std::size_t LevelSet::memory() const {
  return grid_->grid->memUsage();
}

std::vector<std::array<int, 3>> LevelSet::blocks() const {
  std::vector<std::array<int, 3>> found;
  for (auto leaf = grid_->grid->tree().cbeginLeaf(); leaf; ++leaf)
    if (!leaf->isEmpty()) found.push_back(to_array(leaf->origin()));
  std::sort(found.begin(), found.end());
  return found;
}

void LevelSet::read(std::array<int, 3> first, int count, float* values) const {
  const FloatGrid::ConstUnsafeAccessor accessor = grid_->grid->getConstUnsafeAccessor();
  for (int i = 0; i < count; ++i)
    for (int j = 0; j < count; ++j) {
      // Along k as long as one leaf lasts.
      int k = 0;
      while (k < count) {
        const Coord c(first[0] + i, first[1] + j, first[2] + k);
        const int in_block = c.z() & (block - 1);
        const int run = std::min(block - in_block, count - k);
        if (const Leaf* leaf = accessor.probeConstLeaf(c)) {
          const float* source = leaf->buffer().data() + Leaf::coordToOffset(c);
          values = std::copy(source, source + run, values);
        } else {
          values = std::fill_n(values, run, accessor.getValue(c));
        }
        k += run;
      }
    }
}

LevelSet level_set_from_distance(const std::function<double(double, double, double)>& distance,
                                 const Box& body, double voxel, double half_width_voxels) {
  check_sizes(voxel, half_width_voxels);
  const double half_width = voxel * half_width_voxels;
  // Two voxels more than the band: the outermost blocks must come out empty or positive at their rim.
  const double margin = half_width + 2.0 * voxel;
  Coord low, high;
  for (int c = 0; c < 3; ++c) {
    low[c] = block_of(body.low[static_cast<std::size_t>(c)] - margin, voxel);
    high[c] = block_of(body.high[static_cast<std::size_t>(c)] + margin, voxel);
  }
  const CoordBBox all(low, high);
  const Coord extent = all.dim();
  std::vector<std::unique_ptr<Leaf>> leaves(static_cast<std::size_t>(all.volume()));
  const DistanceSampler sampler(distance, voxel, half_width);
  tbb::parallel_for(std::size_t{0}, leaves.size(), [&](std::size_t n) {
    const int k = static_cast<int>(n) % extent.z(), j = static_cast<int>(n) / extent.z() % extent.y(),
              i = static_cast<int>(n) / extent.z() / extent.y();
    leaves[n] = sampler.sample(Coord(low.x() + i, low.y() + j, low.z() + k) << 3);
  });
  FloatGrid::Ptr grid = empty_grid(voxel, half_width);
  for (auto& leaf : leaves)
    if (leaf) grid->tree().addLeaf(leaf.release());
  const CoordBBox band = grid->evalActiveVoxelBoundingBox();
  for (int c = 0; c < 3 && !band.empty(); ++c)
    if (band.min()[c] <= low[c] * LevelSet::block ||
        band.max()[c] >= high[c] * LevelSet::block + LevelSet::block - 1)
      throw std::invalid_argument("the body of a level set reaches out of the box given for it");
  openvdb::tools::signedFloodFill(grid->tree());
  return LevelSet(std::make_shared<const LevelSet::Grid>(LevelSet::Grid{grid, voxel, half_width}));
}

LevelSet level_set_from_mesh(const TriangleMesh& mesh, double voxel, double half_width_voxels, Sides sides) {
  check_sizes(voxel, half_width_voxels);
  for (const auto& triangle : mesh.triangles)
    for (int vertex : triangle)
      if (vertex < 0 || static_cast<std::size_t>(vertex) >= mesh.vertices.size())
        throw std::invalid_argument("a triangle names a vertex that does not exist");
  start_openvdb();
  if (mesh.triangles.empty()) throw std::invalid_argument("a level set needs a mesh with triangles");
  // A voxel more than asked for: the band is found by distances that may be a little too large.
  const auto width = static_cast<float>(half_width_voxels + 1.0);
  const auto transform = openvdb::math::Transform::createLinearTransform(voxel);
  const int flags = sides == Sides::open ? openvdb::tools::UNSIGNED_DISTANCE_FIELD : 0;
  openvdb::Int32Grid triangles;
  FloatGrid::Ptr grid = openvdb::tools::meshToVolume<FloatGrid>(MeshInVoxels(mesh, voxel), *transform, width,
                                                                width, flags, &triangles);
  measure(*grid, triangles, mesh, voxel, sides);
  return LevelSet(
      std::make_shared<const LevelSet::Grid>(LevelSet::Grid{grid, voxel, voxel * half_width_voxels}));
}

double volume(const LevelSet& body) {
  return openvdb::tools::levelSetVolume(*body.grid().grid, true);
}

Overlap overlap(const LevelSet& a, const LevelSet& b) {
  if (a.voxel() != b.voxel())
    throw std::invalid_argument("two level sets are compared voxel by voxel: their voxels must be equal");
  CoordBBox both = a.grid().grid->evalActiveVoxelBoundingBox();
  both.intersect(b.grid().grid->evalActiveVoxelBoundingBox());
  Overlap found{0.0, -std::numeric_limits<double>::infinity(), 0};
  if (both.empty()) return found;
  // Values are floats: bodies that touch at a voxel's very centre must not be taken for an overlap.
  const float rounding = static_cast<float>(-1e-6 * a.voxel());
  struct Count {
    std::size_t voxels = 0;
    float depth = -std::numeric_limits<float>::infinity();
  };
  const Count count = tbb::parallel_reduce(  // a number and a maximum: the order does not matter
      tbb::blocked_range<int>(both.min().x(), both.max().x() + 1), Count{},
      [&](const tbb::blocked_range<int>& range, Count sum) {
        const auto in_a = a.grid().grid->getConstUnsafeAccessor(),
                   in_b = b.grid().grid->getConstUnsafeAccessor();
        for (int i = range.begin(); i < range.end(); ++i)
          for (int j = both.min().y(); j <= both.max().y(); ++j)
            for (int k = both.min().z(); k <= both.max().z(); ++k) {
              const Coord c(i, j, k);
              const float d = std::max(in_a.getValue(c), in_b.getValue(c));
              sum.depth = std::max(sum.depth, -d);
              sum.voxels += d < rounding;
            }
        return sum;
      },
      [](Count x, const Count& y) {
        return Count{x.voxels + y.voxels, std::max(x.depth, y.depth)};
      });
  found.voxels = count.voxels;
  found.depth = count.depth;
  found.volume = static_cast<double>(count.voxels) * a.voxel() * a.voxel() * a.voxel();
  return found;
}

TriangleMesh surface(const LevelSet& body) {
  std::vector<openvdb::Vec3s> points;
  std::vector<openvdb::Vec4I> quads;
  openvdb::tools::volumeToMesh(*body.grid().grid, points, quads);
  TriangleMesh mesh;
  mesh.vertices.reserve(points.size());
  for (const openvdb::Vec3s& p : points) mesh.vertices.push_back({p.x(), p.y(), p.z()});
  mesh.triangles.reserve(2 * quads.size());
  for (const openvdb::Vec4I& q : quads) {
    const std::array<int, 4> v{static_cast<int>(q[0]), static_cast<int>(q[1]), static_cast<int>(q[2]),
                               static_cast<int>(q[3])};
    // OpenVDB's faces run clockwise seen from outside.
    mesh.triangles.push_back({v[0], v[2], v[1]});
    mesh.triangles.push_back({v[0], v[3], v[2]});
  }
  return mesh;
}

}  // namespace heddle
