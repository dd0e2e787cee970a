#include "mesoscale/solid/sampler.h"

#include <Eigen/LU>
#include <algorithm>
#include <cmath>
#include <iterator>
#include <map>
#include <numbers>
#include <unordered_map>

#include <fmt/format.h>
#include <tbb/parallel_for.h>
#include <tbb/parallel_sort.h>

#include "core/problem.h"

namespace heddle::mesoscale::solid {

namespace {

constexpr int across_voxel = 4;  // columns along x and along y
constexpr int share_steps = 32;  // of a voxel
constexpr double direction_step = 0.5 * std::numbers::pi / 180.0;
constexpr int direction_middle = 512;  // bin of a level tow
constexpr int normal_steps = 8;        // of each component

// Everything that makes two voxels alike, in one number; 0 is resin.
using Key = std::uint64_t;

struct Recipe {
  int warp = 0, weft = 0;                      // shares in steps
  int warp_direction = 0, weft_direction = 0;  // bins; 0: none
  std::array<int, 3> normal{};                 // components in steps; 0: one material only

  Key key() const {
    Key k = 0;
    const auto push = [&](int value, int bits) { k = k << bits | static_cast<Key>(value); };
    push(warp, 6);
    push(weft, 6);
    push(warp_direction, 11);
    push(weft_direction, 11);
    for (const int n : normal) push(n + normal_steps, 5);
    return warp + weft == 0 ? 0 : k;
  }
  static Recipe of(Key k) {
    Recipe r;
    if (k == 0) return r;
    const auto pop = [&](int bits) {
      const int value = static_cast<int>(k & ((Key{1} << bits) - 1));
      k >>= bits;
      return value;
    };
    for (int i = 2; i >= 0; --i) r.normal[static_cast<std::size_t>(i)] = pop(5) - normal_steps;
    r.weft_direction = pop(11);
    r.warp_direction = pop(11);
    r.weft = pop(6);
    r.warp = pop(6);
    return r;
  }
};

double overlap(double low, double high, double bottom, double top) {
  return std::max(0.0, std::min(high, top) - std::max(low, bottom));
}

int direction_bin(double rise, double run) {
  return direction_middle + static_cast<int>(std::lround(std::atan2(rise, run) / direction_step));
}

// A ply as it lies in the cell: shifted, and its middle above that of the cell [m].
struct PlacedPly {
  double xi = 0.0, eta = 0.0, z = 0.0;
};

// Places of a ply's warps and wefts among the shares.
constexpr std::size_t warps_of(std::size_t ply) {
  return 2 * ply;
}
constexpr std::size_t wefts_of(std::size_t ply) {
  return 2 * ply + 1;
}

class Sampler {
 public:
  Sampler(const UnitCell& cell, std::vector<PlacedPly> plies, double thickness, const SamplerOptions& options)
      : cell_(cell),
        plies_(std::move(plies)),
        options_(options),
        thickness_(thickness),
        count_{options.per_pitch * cell.weave.wefts, options.per_pitch * cell.weave.warps,
               options.layers * static_cast<int>(plies_.size())},
        step_{cell.tow[1].spacing / options.per_pitch, cell.tow[0].spacing / options.per_pitch},
        height_(thickness / count_[2]),
        share_(2 * plies_.size(), std::vector<float>(voxels())) {
    const std::array<double, 2> size = cell.size();
    const auto x = cell.place(size[0], 0.0), y = cell.place(0.0, size[1]);
    edges_ << x[0], y[0], 0.0, x[1], y[1], 0.0, 0.0, 0.0, thickness;
    to_reference_ = edges_.inverse().transpose();
  }

  VoxelCell run() {
    tbb::parallel_for(0, count_[1], [&](int j) { fill_shares(j); });
    std::vector<Key> keys(voxels());
    tbb::parallel_for(0, count_[1], [&](int j) { fill_keys(j, keys); });
    return collect(keys);
  }

  void fill(CellVoxels& voxels) {
    tbb::parallel_for(0, count_[1], [&](int j) { fill_shares(j); });
    voxels.fraction.resize(this->voxels());
    voxels.direction.assign(3 * this->voxels(), 0.0F);
    tbb::parallel_for(0, count_[1], [&](int j) {
      for (int i = 0; i < count_[0]; ++i) {
        const std::vector<int> bins = bins_over(i, j);
        for (int k = 0; k < count_[2]; ++k) {
          const std::size_t voxel = at(i, j, k);
          const double warp = share(0, voxel), weft = share(1, voxel);
          voxels.fraction[voxel] = static_cast<float>(warp + weft);
          if (warp + weft == 0.0) continue;
          const bool is_weft = weft > warp;
          const Eigen::Vector3d along =
              direction(is_weft, bin_of_most(is_weft ? 1 : 0, voxel, bins)).normalized();
          for (int axis = 0; axis < 3; ++axis)
            voxels.direction[3 * voxel + static_cast<std::size_t>(axis)] = static_cast<float>(along[axis]);
        }
      }
    });
  }

 private:
  std::size_t voxels() const { return static_cast<std::size_t>(count_[0]) * count_[1] * count_[2]; }
  std::size_t at(int i, int j, int k) const {
    return (static_cast<std::size_t>(k) * count_[1] + j) * count_[0] + i;
  }

  // Of one row of voxels, all layers: summed layer by layer within the row, which stays in cache.
  void fill_shares(int j) {
    const std::size_t row = static_cast<std::size_t>(count_[0]),
                      tow = row * static_cast<std::size_t>(count_[2]);
    std::vector<double> sums(tow * share_.size(), 0.0);
    for (int i = 0; i < count_[0]; ++i)
      for (int b = 0; b < across_voxel; ++b)
        for (int a = 0; a < across_voxel; ++a)
          for (std::size_t p = 0; p < plies_.size(); ++p) {
            const PlacedPly& ply = plies_[p];
            const Column c = column(cell_, (i + (a + 0.5) / across_voxel) * step_[0] - ply.xi,
                                    (j + (b + 0.5) / across_voxel) * step_[1] - ply.eta);
            if (c.warp) add(c.warp_bottom + ply.z, c.warp_top + ply.z, sums.data() + tow * warps_of(p) + i);
            if (c.weft) add(c.weft_bottom + ply.z, c.weft_top + ply.z, sums.data() + tow * wefts_of(p) + i);
          }
    const double column_volume = across_voxel * across_voxel * height_;
    for (std::size_t t = 0; t < share_.size(); ++t)
      for (int k = 0; k < count_[2]; ++k) {
        const double* from = sums.data() + tow * t + row * static_cast<std::size_t>(k);
        float* to = share_[t].data() + at(0, j, k);
        for (std::size_t i = 0; i < row; ++i) to[i] = static_cast<float>(from[i] / column_volume);
      }
  }

  // The part of a column that a tow fills, to the voxels it passes; `lowest` of them, a row of voxels a
  // layer.
  void add(double bottom, double top, double* lowest) const {
    const double low = -0.5 * thickness_;
    const int first = std::clamp(static_cast<int>((bottom - low) / height_), 0, count_[2] - 1);
    const int last = std::clamp(static_cast<int>((top - low) / height_), 0, count_[2] - 1);
    for (int k = first; k <= last; ++k)
      lowest[static_cast<std::ptrdiff_t>(k) * count_[0]] +=
          overlap(low + k * height_, low + (k + 1) * height_, bottom, top);
  }

  // Bins of the tows of each ply over a column of voxels, in the order of the shares.
  std::vector<int> bins_over(int i, int j) const {
    std::vector<int> bins;
    for (const PlacedPly& ply : plies_) {
      const double xi = (i + 0.5) * step_[0] - ply.xi, eta = (j + 0.5) * step_[1] - ply.eta;
      const int warp = static_cast<int>(std::lround(eta / cell_.tow[0].spacing)),
                weft = static_cast<int>(std::lround(xi / cell_.tow[1].spacing));
      const double warp_rise =
          warp_centre(cell_, warp, xi + 0.5 * step_[0]) - warp_centre(cell_, warp, xi - 0.5 * step_[0]);
      const double weft_rise =
          weft_centre(cell_, weft, eta + 0.5 * step_[1]) - weft_centre(cell_, weft, eta - 0.5 * step_[1]);
      bins.push_back(direction_bin(warp_rise, step_[0]));
      bins.push_back(direction_bin(weft_rise, step_[1]));
    }
    return bins;
  }

  void fill_keys(int j, std::vector<Key>& keys) const {
    for (int i = 0; i < count_[0]; ++i) {
      const std::vector<int> bins = bins_over(i, j);
      for (int k = 0; k < count_[2]; ++k) keys[at(i, j, k)] = recipe(i, j, k, bins).key();
    }
  }

  // Of the warps (first = 0) or wefts (1) of all plies.
  double share(std::size_t first, std::size_t voxel) const {
    double sum = 0.0;
    for (std::size_t tow = first; tow < share_.size(); tow += 2)
      sum += static_cast<double>(share_[tow][voxel]);
    return sum;
  }
  int bin_of_most(std::size_t first, std::size_t voxel, const std::vector<int>& bins) const {
    std::size_t most = first;
    for (std::size_t tow = first; tow < share_.size(); tow += 2)
      if (share_[tow][voxel] > share_[most][voxel]) most = tow;
    return bins[most];
  }

  Recipe recipe(int i, int j, int k, const std::vector<int>& bins) const {
    const std::size_t voxel = at(i, j, k);
    const double warp = share(0, voxel), weft = share(1, voxel);
    Recipe r;
    if (options_.mixing == Mixing::dominant) {
      const double resin = 1.0 - warp - weft;
      if (warp >= std::max(weft, resin))
        r.warp = share_steps;
      else if (weft >= resin)
        r.weft = share_steps;
    } else {
      r.warp = static_cast<int>(std::lround(share_steps * warp));
      r.weft = std::min(static_cast<int>(std::lround(share_steps * weft)), share_steps - r.warp);
    }
    if (r.warp > 0) r.warp_direction = bin_of_most(0, voxel, bins);
    if (r.weft > 0) r.weft_direction = bin_of_most(1, voxel, bins);
    const bool pure = r.warp + r.weft == 0 || r.warp == share_steps || r.weft == share_steps;
    if (!pure) r.normal = normal(r.warp >= r.weft ? 0 : 1, i, j, k);
    return r;
  }

  // Of the surface of a tow, by the gradient of its share; upwards.
  std::array<int, 3> normal(std::size_t tow, int i, int j, int k) const {
    const auto wrap = [](int n, int size) { return (n + size) % size; };
    const auto share_at = [&](int x, int y, int z) {
      return share(tow, at(wrap(x, count_[0]), wrap(y, count_[1]), z));
    };
    const int low = std::max(k - 1, 0), high = std::min(k + 1, count_[2] - 1);
    const Eigen::Vector3d in_cell(
        0.5 * count_[0] * (share_at(i + 1, j, k) - share_at(i - 1, j, k)),
        0.5 * count_[1] * (share_at(i, j + 1, k) - share_at(i, j - 1, k)),
        high == low ? 0.0 : count_[2] * (share_at(i, j, high) - share_at(i, j, low)) / (high - low));
    Eigen::Vector3d n = to_reference_ * in_cell;
    // A share that is the same all round has no interface to speak of; across the sheet is as good as any.
    if (!(n.norm() > 1e-9 / thickness_)) return {0, 0, normal_steps};
    n *= normal_steps / n.norm();
    if (n.z() < 0.0) n = -n;
    return {static_cast<int>(std::lround(n.x())), static_cast<int>(std::lround(n.y())),
            static_cast<int>(std::lround(n.z()))};
  }

  VoxelCell collect(const std::vector<Key>& keys) const {
    std::vector<Key> distinct;  // neighbours are mostly alike
    std::unique_copy(keys.begin(), keys.end(), std::back_inserter(distinct));
    tbb::parallel_sort(distinct.begin(), distinct.end());
    distinct.erase(std::unique(distinct.begin(), distinct.end()), distinct.end());
    if (distinct.size() > 65535)
      throw NumericalError(
          fmt::format("voxels: the grid has {} different voxels, at most 65535 are held", distinct.size()));
    VoxelCell cell;
    cell.count = count_;
    cell.edges = edges_;
    std::map<std::pair<bool, int>, std::uint16_t> directions;
    std::unordered_map<Key, std::uint16_t> index;
    for (const Key key : distinct) {
      index[key] = static_cast<std::uint16_t>(cell.contents.size());
      cell.contents.push_back(content(Recipe::of(key), directions, cell.directions));
    }
    cell.content.resize(keys.size());
    tbb::parallel_for(std::size_t{0}, static_cast<std::size_t>(count_[2]), [&](std::size_t k) {
      const std::size_t layer = static_cast<std::size_t>(count_[0]) * count_[1];
      Key last = keys[layer * k];
      std::uint16_t of_last = index.at(last);
      for (std::size_t v = layer * k; v < layer * (k + 1); ++v) {
        if (keys[v] != last) {
          last = keys[v];
          of_last = index.at(last);
        }
        cell.content[v] = of_last;
      }
    });
    return cell;
  }

  VoxelContent content(const Recipe& r, std::map<std::pair<bool, int>, std::uint16_t>& known,
                       std::vector<Eigen::Vector3d>& directions) const {
    VoxelContent content;
    const auto add_tow = [&](int steps, bool is_weft, int bin) {
      if (steps == 0) return;
      const auto [place, fresh] =
          known.try_emplace({is_weft, bin}, static_cast<std::uint16_t>(directions.size()));
      if (fresh) directions.push_back(direction(is_weft, bin));
      content.portions.push_back(
          {is_weft ? weft_phase : warp_phase, place->second, static_cast<double>(steps) / share_steps});
    };
    add_tow(r.warp, false, r.warp_direction);
    add_tow(r.weft, true, r.weft_direction);
    const int resin = share_steps - r.warp - r.weft;
    if (resin > 0) content.portions.push_back({resin_phase, 0, static_cast<double>(resin) / share_steps});
    if (content.portions.size() > 1)
      content.normal = Eigen::Vector3d(r.normal[0], r.normal[1], r.normal[2]).normalized();
    return content;
  }

  Eigen::Vector3d direction(bool is_weft, int bin) const {
    const std::array<double, 2> along = is_weft ? cell_.place(0.0, 1.0) : cell_.place(1.0, 0.0);
    return {along[0], along[1], std::tan((bin - direction_middle) * direction_step)};
  }

  const UnitCell& cell_;
  std::vector<PlacedPly> plies_;
  SamplerOptions options_;
  double thickness_;
  std::array<int, 3> count_;
  std::array<double, 2> step_;  // along {xi, eta}
  double height_;
  Eigen::Matrix3d edges_, to_reference_;
  std::vector<std::vector<float>> share_;  // of the warps and the wefts of each ply
};

}  // namespace

VoxelCell sample(const UnitCell& cell, double thickness, const SamplerOptions& options) {
  return Sampler(cell, {PlacedPly{}}, thickness, options).run();
}

VoxelCell sample(const PlyStack& stack, const SamplerOptions& options) {
  std::vector<PlacedPly> plies;
  for (std::size_t k = 0; k < stack.height.size(); ++k)
    plies.push_back({stack.shift[k][0], stack.shift[k][1], stack.middle(k)});
  return Sampler(stack.ply, std::move(plies), stack.thickness, options).run();
}

CellVoxels cell_voxels(const UnitCell& cell, int per_pitch, int through) {
  CellVoxels voxels;
  voxels.grid = tow_labels(cell, per_pitch, through);
  Sampler(cell, {PlacedPly{}}, 2.0 * cell.crown(), {.per_pitch = per_pitch, .layers = through}).fill(voxels);
  return voxels;
}

}  // namespace heddle::mesoscale::solid
