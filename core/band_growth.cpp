#include "core/band_growth.h"

#include <cmath>
#include <cstdint>
#include <limits>
#include <map>
#include <unordered_map>
#include <utility>

#include <tbb/parallel_for.h>

#include "core/triangle_walk.h"

namespace heddle {
namespace {

using Eigen::Vector3d;
using Voxel = std::array<int, 3>;

constexpr int row = BandBlock::row, size = BandBlock::size;
constexpr std::array<int, 3> stride{row * row, row, 1};

// A neighbour's distance counts as nearer if it is by more than the rounding of a float.
constexpr double nearer_by = 1.0 - 1e-6;

/// A triangle that may be the nearest of a voxel.
struct Offer {
  int voxel, triangle;
  bool inside;
};

std::array<int, 3> place_of(int voxel) {
  return {voxel / stride[0], voxel / stride[1] % row, voxel % row};
}

class Growth {
 public:
  Growth(const TriangleMesh& mesh, double voxel, double reach, const SheetSide* sheet)
      : walk_(mesh), voxel_(voxel), reach_(reach), sheet_(sheet) {}

  void plant(const std::vector<Voxel>& first, const std::function<BandSeed(const Voxel&)>& seed) {
    for (const Voxel& origin : first) changed_.push_back(add(origin));
    tbb::parallel_for(std::size_t{0}, first.size(), [&](std::size_t n) {
      const BandSeed known = seed(first[n]);
      std::vector<Offer> offers;
      for (int v = 0; v < size; ++v)
        if (known.triangle[v] >= 0) offers.push_back({v, known.triangle[v], known.inside[v]});
      take(blocks_[n], offers);
    });
  }

  void grow(const std::function<bool(const Voxel&)>& wanted) {
    while (!changed_.empty()) {
      // In the order of the blocks' numbers, which does not depend on threads.
      std::map<std::size_t, std::vector<Offer>> receivers;
      for (const std::size_t from : changed_)
        for (int face = 0; face < 6; ++face) {
          const Voxel origin = beside(blocks_[from].origin, face);
          const auto there = number_.find(key(origin));
          if (there != number_.end())
            receivers[there->second];
          else if (wanted(origin) && !border(blocks_[from], face, nullptr).empty())
            receivers[add(origin)];
        }
      std::vector<std::pair<std::size_t, std::vector<Offer>>> work(receivers.begin(), receivers.end());
      tbb::parallel_for(std::size_t{0}, work.size(),
                        [&](std::size_t n) { collect(work[n].first, work[n].second); });
      std::vector<char> moved(work.size());
      tbb::parallel_for(std::size_t{0}, work.size(),
                        [&](std::size_t n) { moved[n] = take(blocks_[work[n].first], work[n].second); });
      changed_.clear();
      for (std::size_t n = 0; n < work.size(); ++n)
        if (moved[n]) changed_.push_back(work[n].first);
    }
  }

  std::deque<BandBlock> blocks() && { return std::move(blocks_); }

 private:
  static std::uint64_t key(const Voxel& origin) {
    std::uint64_t k = 0;
    for (int c : origin) k = k << 21 | (static_cast<std::uint64_t>(c / row) & 0x1fffff);
    return k;
  }

  // Faces come in pairs: 2 c is the one towards smaller indices along c.
  static Voxel beside(Voxel origin, int face) {
    origin[static_cast<std::size_t>(face / 2)] += face % 2 ? row : -row;
    return origin;
  }

  std::size_t add(const Voxel& origin) {
    number_.emplace(key(origin), blocks_.size());
    BandBlock& block = blocks_.emplace_back();
    block.origin = origin;
    block.distance.fill(std::numeric_limits<float>::infinity());
    block.triangle.fill(-1);
    return blocks_.size() - 1;
  }

  Vector3d position(const BandBlock& block, int voxel) const {
    const Voxel p = place_of(voxel);
    return voxel_ * Vector3d(block.origin[0] + p[0], block.origin[1] + p[1], block.origin[2] + p[2]);
  }

  bool is_nearer(double squared, float distance) const {
    return squared < nearer_by * distance * static_cast<double>(distance);
  }

  // A path along the grid from the surface to a voxel in reach strays from the straight one by less than a
  // voxel.
  bool hands_on(const BandBlock& block, int voxel) const {
    return std::abs(block.distance[voxel]) < reach_ + 1.5 * voxel_;
  }

  // Whether a voxel needs no word of a triangle.
  bool knows(const BandBlock& block, int voxel, int triangle) const {
    const int own = block.triangle[voxel];
    return own == triangle || (own >= 0 && walk_.touch(own, triangle));
  }

  // What the face of a block offers to the one beside it.
  std::vector<Offer> border(const BandBlock& from, int face, const BandBlock* to) const {
    const int across = stride[static_cast<std::size_t>(face / 2)], last = (row - 1) * across;
    std::vector<Offer> offers;
    for (int v = 0; v < size; ++v) {
      if (v / across % row != (face % 2 ? row - 1 : 0)) continue;
      if (!hands_on(from, v)) continue;
      const int other = face % 2 ? v - last : v + last;
      if (to && knows(*to, other, from.triangle[v])) continue;
      offers.push_back({other, from.triangle[v], std::signbit(from.distance[v])});
    }
    return offers;
  }

  void collect(std::size_t receiver, std::vector<Offer>& offers) const {
    const BandBlock& to = blocks_[receiver];
    for (int face = 0; face < 6; ++face) {
      const auto from = number_.find(key(beside(to.origin, face)));
      if (from == number_.end()) continue;
      const std::vector<Offer> more = border(blocks_[from->second], face ^ 1, &to);
      offers.insert(offers.end(), more.begin(), more.end());
    }
  }

  // Sets the voxel to the nearest triangle found from `offer`, if that is nearer than what it has.
  bool improve(BandBlock& block, const Offer& offer) const {
    const Vector3d q = position(block, offer.voxel);
    TriangleWalk::Nearest found = walk_.at(offer.triangle, q);
    float& distance = block.distance[offer.voxel];
    const bool known = block.triangle[offer.voxel] >= 0;
    if (known && !is_nearer(found.squared, distance)) return false;
    found = walk_.from(found, q);
    const bool inside = sheet_  ? sheet_->behind(q, found.triangle)
                        : known ? std::signbit(distance)
                                : offer.inside;
    block.triangle[offer.voxel] = found.triangle;
    distance = std::copysign(static_cast<float>(std::sqrt(found.squared)), inside ? -1.0f : 1.0f);
    return true;
  }

  // Takes what is nearer and hands it on within the block. Whether anything was.
  bool take(BandBlock& block, const std::vector<Offer>& offers) const {
    std::vector<int> queue;
    std::array<bool, size> waiting{};
    const auto push = [&](int v) {
      if (!waiting[v]) queue.push_back(v);
      waiting[v] = true;
    };
    for (const Offer& offer : offers)
      if (improve(block, offer)) push(offer.voxel);
    const bool anything = !queue.empty();
    for (std::size_t next = 0; next < queue.size(); ++next) {
      const int v = queue[next];
      waiting[v] = false;
      if (!hands_on(block, v)) continue;
      const Voxel p = place_of(v);
      for (std::size_t c = 0; c < 3; ++c)
        for (int step : {-1, 1}) {
          if (p[c] + step < 0 || p[c] + step >= row) continue;
          const int other = v + step * stride[c];
          if (knows(block, other, block.triangle[v])) continue;
          if (improve(block, {other, block.triangle[v], std::signbit(block.distance[v])})) push(other);
        }
    }
    return anything;
  }

  TriangleWalk walk_;
  double voxel_, reach_;
  const SheetSide* sheet_;
  std::deque<BandBlock> blocks_;
  std::unordered_map<std::uint64_t, std::size_t> number_;  ///< of the block at an origin
  std::vector<std::size_t> changed_;                       ///< numbers, rising
};

}  // namespace

std::deque<BandBlock> grow_band(const TriangleMesh& mesh, double voxel, double reach,
                                const std::vector<std::array<int, 3>>& first,
                                const std::function<BandSeed(const std::array<int, 3>&)>& seed,
                                const std::function<bool(const std::array<int, 3>&)>& wanted,
                                const SheetSide* sheet) {
  Growth growth(mesh, voxel, reach, sheet);
  growth.plant(first, seed);
  growth.grow(wanted);
  return std::move(growth).blocks();
}

}  // namespace heddle
