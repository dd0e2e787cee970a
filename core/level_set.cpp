#include "core/level_set.h"

#include <openvdb/openvdb.h>
#include <openvdb/tools/LevelSetMeasure.h>
#include <openvdb/tools/MeshToVolume.h>
#include <openvdb/tools/SignedFloodFill.h>
#include <openvdb/tools/VolumeToMesh.h>
#include <tbb/blocked_range.h>
#include <tbb/parallel_for.h>
#include <tbb/parallel_reduce.h>

#include <algorithm>
#include <cmath>
#include <deque>
#include <limits>
#include <stdexcept>
#include <utility>

#include "core/band_growth.h"
#include "core/sheet_side.h"

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

// Half width of the band that meshToVolume finds [voxel]: all that is nearer than one voxel for certain.
constexpr float surface_width = 2.0f;

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

bool meets(const Box& box, const std::array<int, 3>& origin, double voxel) {
  for (std::size_t c = 0; c < 3; ++c) {
    const double low = voxel * origin[c], high = voxel * (origin[c] + LevelSet::block - 1);
    if (high < box.low[c] || low > box.high[c]) return false;
  }
  return true;
}

// meshToVolume carries the nearest triangle from voxel to voxel as its band grows, which is slow and misses
// nearer ones. So it gives the voxels at the surface, a triangle near each and their inner side; the band is
// grown from there.
std::deque<BandBlock> grown(const FloatGrid& surface, const openvdb::Int32Grid& triangles,
                            const TriangleMesh& mesh, double voxel, double reach, const SheetSide* sheet,
                            const Box& region) {
  const auto wanted = [&](const std::array<int, 3>& origin) { return meets(region, origin, voxel); };
  std::vector<std::array<int, 3>> first;
  for (auto leaf = surface.tree().cbeginLeaf(); leaf; ++leaf)
    if (!leaf->isEmpty() && wanted(to_array(leaf->origin()))) first.push_back(to_array(leaf->origin()));
  std::sort(first.begin(), first.end());
  const auto seed = [&](const std::array<int, 3>& origin) {
    const Coord c(origin[0], origin[1], origin[2]);
    const Leaf& leaf = *surface.tree().probeConstLeaf(c);
    const auto near = triangles.getConstUnsafeAccessor();
    BandSeed known;
    known.triangle.fill(-1);
    for (auto value = leaf.cbeginValueOn(); value; ++value) {
      known.triangle[value.pos()] = near.getValue(value.getCoord());
      known.inside[value.pos()] = *value < 0.0f;
    }
    return known;
  };
  return grow_band(mesh, voxel, reach, first, seed, wanted, sheet);
}

std::unique_ptr<Leaf> leaf_of(const BandBlock& block, float beyond) {
  auto leaf = std::make_unique<Leaf>(Coord(block.origin[0], block.origin[1], block.origin[2]), beyond, false);
  for (openvdb::Index n = 0; n < Leaf::SIZE; ++n) {
    const float d = block.distance[n];
    if (std::abs(d) < beyond)
      leaf->setValueOn(n, d);
    else
      leaf->setValueOff(n, std::copysign(beyond, d));
  }
  return leaf;
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

LevelSet level_set_from_mesh(const TriangleMesh& mesh, double voxel, double half_width_voxels, Sides sides,
                             const Box& region) {
  check_sizes(voxel, half_width_voxels);
  for (const auto& triangle : mesh.triangles)
    for (int vertex : triangle)
      if (vertex < 0 || static_cast<std::size_t>(vertex) >= mesh.vertices.size())
        throw std::invalid_argument("a triangle names a vertex that does not exist");
  start_openvdb();
  if (mesh.triangles.empty()) throw std::invalid_argument("a level set needs a mesh with triangles");
  const auto transform = openvdb::math::Transform::createLinearTransform(voxel);
  const int flags = sides == Sides::open ? openvdb::tools::UNSIGNED_DISTANCE_FIELD : 0;
  openvdb::Int32Grid triangles;
  FloatGrid::Ptr surface = openvdb::tools::meshToVolume<FloatGrid>(
      MeshInVoxels(mesh, voxel), *transform, surface_width, surface_width, flags, &triangles);
  const auto sheet = sides == Sides::open ? std::make_unique<const SheetSide>(mesh) : nullptr;
  const double half_width = voxel * half_width_voxels;
  std::deque<BandBlock> band = grown(*surface, triangles, mesh, voxel, half_width, sheet.get(), region);

  // More than half_width after rounding to a float, so that what lies beyond the band is told from its rim.
  const auto beyond = static_cast<float>(half_width * (1.0 + 1e-6));
  FloatGrid::Ptr grid = empty_grid(voxel, beyond);
  for (; !band.empty(); band.pop_front()) {
    auto leaf = leaf_of(band.front(), beyond);
    if (sheet) spread_sides(*leaf, beyond);
    if (!leaf->isEmpty()) grid->tree().addLeaf(leaf.release());
  }
  // Outside the region the surface keeps its thin band, so that inside and outside stay told apart
  // everywhere.
  for (auto leaf = surface->tree().beginLeaf(); leaf; ++leaf)
    if (!leaf->isEmpty() && !meets(region, to_array(leaf->origin()), voxel))
      grid->tree().addLeaf(new Leaf(*leaf));
  if (sheet)
    fill_blocks(*grid, beyond);
  else
    openvdb::tools::signedFloodFill(grid->tree());
  return LevelSet(std::make_shared<const LevelSet::Grid>(LevelSet::Grid{grid, voxel, half_width}));
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
