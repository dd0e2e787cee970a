#include "mesoscale/solid/reference.h"

#include <Eigen/Cholesky>
#include <Eigen/LU>
#include <algorithm>
#include <cstring>

#include <tbb/blocked_range.h>
#include <tbb/cache_aligned_allocator.h>
#include <tbb/enumerable_thread_specific.h>
#include <tbb/parallel_for.h>

#include "core/problem.h"
#include "mesoscale/solid/pencil_fft.h"
#include "mesoscale/solid/reference_kernel.h"

namespace heddle::mesoscale::solid {

namespace {

// Powers of two between the numbers of a transform fall on the same lines of the cache: a few more break
// this.
constexpr int padding = 4;  // complex numbers

using Buffer = std::vector<double, tbb::cache_aligned_allocator<double>>;

// Blocks of even size, none above the largest.
struct Blocks {
  explicit Blocks(int all) : waves(all) {
    const int number = (waves + 15) / 16;
    size = (waves + number - 1) / number;
  }
  int count() const { return (waves + size - 1) / size; }
  int first(int block) const { return block * size; }
  int length(int block) const { return std::min(size, waves - first(block)); }
  int waves, size;
};

void check_positive(const Matrix6& stiffness) {
  if (Eigen::LLT<Matrix6>(stiffness).info() != Eigen::Success)
    throw NumericalError("homogenisation: the mean stiffness of the cell is not positive definite");
}

// Where each wave stands.
std::vector<int> places_of(const std::vector<int>& order) {
  std::vector<int> place(order.size());
  for (std::size_t p = 0; p < order.size(); ++p)
    place[static_cast<std::size_t>(order[p])] = static_cast<int>(p);
  return place;
}

// Pivots of one column, inverted.
std::vector<Eigen::Matrix3d> inverse_pivots(const SlabBlocks& blocks, int planes, bool mean) {
  std::vector<Eigen::Matrix3d> inverse;
  for (int k = 0; k < planes; ++k) {
    Eigen::Matrix3d pivot = Eigen::Matrix3d::Zero();
    if (k > 0) pivot += blocks.top - blocks.up.transpose() * inverse.back() * blocks.up;
    if (k + 1 < planes) pivot += blocks.bottom;
    // Of the mean wave translations are free: the topmost plane is held, and the mean is taken out
    // afterwards.
    if (mean && k + 1 == planes) pivot += blocks.bottom;
    const Eigen::Matrix3d inverted = pivot.inverse();
    inverse.push_back(0.5 * (inverted + inverted.transpose()));
  }
  return inverse;
}

}  // namespace

struct ReferenceInverse::Parts {
  Parts(std::array<int, 3> voxels, const VoxelEdges& edges, const Matrix6& c, Faces ends, int side_by_side)
      : cases(side_by_side),
        node(3 * side_by_side),
        signals(3 * side_by_side / 2),
        count(voxels),
        faces(ends),
        planes(planes_of(voxels[2], ends)),
        blocks(voxels[0]),
        pulled(pulled_back(ends == Faces::free ? mirrored_in_z(c) : c, edges)),
        symbol(pulled),
        along_x(voxels[0], signals, signals),
        along_y(voxels[1], signals * blocks.size, stride_of_block()),
        along_z(ends == Faces::periodic ? voxels[2] : 1, signals * blocks.size, stride_of_block()),
        waves{Waves(along_x.waves()), Waves(along_y.waves()), Waves(along_z.waves())},
        place_x(places_of(along_x.waves())),
        place_y(places_of(along_y.waves())) {
    if (faces == Faces::free) factor();
  }

  int stride_of_block() const { return signals * blocks.size + padding; }
  std::size_t row() const { return static_cast<std::size_t>(node) * count[0]; }
  std::size_t plane() const { return row() * static_cast<std::size_t>(count[1]); }

  double* buffer(int rows) const {
    Buffer& mine = scratch.local();
    const auto need = 2 * static_cast<std::size_t>(rows) * static_cast<std::size_t>(stride_of_block());
    if (mine.size() < need) mine.resize(need, 0.0);
    return mine.data();
  }

  // Rows of one block of waves, `step` doubles apart in the field, to the buffer and back.
  void gather(const double* from, std::size_t step, int rows, int length, double* to) const {
    for (int n = 0; n < rows; ++n)
      std::memcpy(to + 2 * static_cast<std::size_t>(stride_of_block()) * n, from + step * n,
                  sizeof(double) * static_cast<std::size_t>(node) * static_cast<std::size_t>(length));
  }
  void scatter(const double* from, std::size_t step, int rows, int length, double* to) const {
    for (int n = 0; n < rows; ++n)
      std::memcpy(to + step * n, from + 2 * static_cast<std::size_t>(stride_of_block()) * n,
                  sizeof(double) * static_cast<std::size_t>(node) * static_cast<std::size_t>(length));
  }

  template <class Transform>
  void transform_y(double* of_plane, const Transform& transform) const {
    double* mine = buffer(count[1]);
    for (int b = 0; b < blocks.count(); ++b) {
      double* at = of_plane + static_cast<std::size_t>(node) * blocks.first(b);
      gather(at, row(), count[1], blocks.length(b), mine);
      transform(mine);
      scatter(mine, row(), count[1], blocks.length(b), at);
    }
  }

  // Factors of half of the waves of y; the opposite ones have the same with u_z turned round.
  std::size_t factor_start(int ky, int b) const {
    return 6 * static_cast<std::size_t>(planes) *
           (static_cast<std::size_t>(ky) * count[0] + static_cast<std::size_t>(blocks.first(b)));
  }

  void factor() {
    const int half = count[1] / 2 + 1;
    factors.resize(6 * static_cast<std::size_t>(planes) * half * count[0]);
    tbb::parallel_for(0, half, [&](int ky) {
      for (int b = 0; b < blocks.count(); ++b)
        for (int w = 0; w < blocks.length(b); ++w) {
          const int x = blocks.first(b) + w;
          const auto inverse = inverse_pivots(slab_blocks(pulled, waves[0], waves[1], x, place_y[ky]), planes,
                                              x == 0 && ky == 0);
          for (int k = 0; k < planes; ++k) {
            const auto p = packed(inverse[static_cast<std::size_t>(k)]);
            std::copy(p.begin(), p.end(),
                      factors.begin() + static_cast<std::ptrdiff_t>(factor_start(ky, b)) +
                          6 * (static_cast<std::ptrdiff_t>(k) * blocks.length(b) + w));
          }
        }
    });
  }

  void periodic_columns(int y, int b, double* mine) const {
    const double scale = 1.0 / (static_cast<double>(count[0]) * count[1] * count[2]);
    along_z.forward(mine);
    for (int z = 0; z < count[2]; ++z)
      divide_by_symbol(symbol, waves, {blocks.first(b), blocks.length(b), y, z, cases}, scale,
                       mine + 2 * static_cast<std::ptrdiff_t>(stride_of_block()) * z);
    along_z.backward(mine);
  }

  void subtract_mean(double* mine) const {
    double mean[3 * loads] = {};
    const std::ptrdiff_t stride = 2 * static_cast<std::ptrdiff_t>(stride_of_block());
    for (int k = 0; k < planes; ++k)
      for (int i = 0; i < node; ++i) mean[i] += mine[stride * k + i] / planes;
    for (int k = 0; k < planes; ++k)
      for (int i = 0; i < node; ++i) mine[stride * k + i] -= mean[i];
  }

  // The blocks `up` of the waves of a task.
  void couple(int w, int x, int y, double* up) const {
    const Eigen::Matrix3d u = slab_blocks(pulled, waves[0], waves[1], x, y).up;
    for (int i = 0; i < 3; ++i)
      for (int j = 0; j < 3; ++j) up[(3 * i + j) * largest_block + w] = u(i, j);
  }

  void slab_columns(int y, int b, double* mine) const {
    const bool mean = y == 0 && b == 0;
    if (mean) subtract_mean(mine);
    const int ky = along_y.waves()[static_cast<std::size_t>(y)];
    double up[9 * largest_block];
    SlabBlock task{blocks.length(b),
                   planes,
                   2 * static_cast<std::ptrdiff_t>(stride_of_block()),
                   nullptr,
                   up,
                   1.0,
                   1.0 / (static_cast<double>(count[0]) * count[1]),
                   cases};
    if (2 * ky > count[1]) {
      solve_opposite(ky, b, mine, task, up);
    } else {
      for (int w = 0; w < task.count; ++w) couple(w, blocks.first(b) + w, y, up);
      task.inverse = factors.data() + factor_start(ky, b);
      solve_slab(task, mine);
    }
    if (mean) subtract_mean(mine);
  }

  // With the factors of the opposite waves, brought into the order of these.
  void solve_opposite(int ky, int b, double* mine, SlabBlock task, double* up) const {
    std::vector<double> inverse(6 * static_cast<std::size_t>(planes) * task.count);
    for (int w = 0; w < task.count; ++w) {
      const int kx = along_x.waves()[static_cast<std::size_t>(blocks.first(b) + w)];
      const int x = place_x[(count[0] - kx) % count[0]], opposite = count[1] - ky;
      couple(w, x, place_y[opposite], up);
      const int from = x / blocks.size, length = blocks.length(from);
      const double* source = factors.data() + factor_start(opposite, from) + 6 * (x - blocks.first(from));
      for (int k = 0; k < planes; ++k)
        std::memcpy(inverse.data() + 6 * (static_cast<std::size_t>(k) * task.count + w),
                    source + 6 * static_cast<std::size_t>(k) * length, 6 * sizeof(double));
    }
    task.sign = -1.0;
    task.inverse = inverse.data();
    solve_slab(task, mine);
  }

  void columns_of(int y, double* field) const {
    double* mine = buffer(planes);
    for (int b = 0; b < blocks.count(); ++b) {
      double* at =
          field + row() * static_cast<std::size_t>(y) + static_cast<std::size_t>(node) * blocks.first(b);
      gather(at, plane(), planes, blocks.length(b), mine);
      if (faces == Faces::periodic)
        periodic_columns(y, b, mine);
      else
        slab_columns(y, b, mine);
      scatter(mine, plane(), planes, blocks.length(b), at);
    }
  }

  int cases;
  int node;     // doubles
  int signals;  // complex numbers a node
  std::array<int, 3> count;
  Faces faces;
  int planes;
  Blocks blocks;
  Eigen::Matrix<double, 9, 9> pulled;
  PeriodicSymbol symbol;
  PencilFft along_x, along_y, along_z;
  std::array<Waves, 3> waves;
  std::vector<int> place_x, place_y;  // of each wave
  std::vector<double> factors;
  mutable tbb::enumerable_thread_specific<Buffer> scratch;
};

ReferenceInverse::ReferenceInverse(std::array<int, 3> count, const VoxelEdges& edges,
                                   const Matrix6& stiffness, Faces faces, int cases) {
  check_positive(stiffness);
  parts_ = std::make_unique<Parts>(count, edges, stiffness, faces, cases);
}
ReferenceInverse::~ReferenceInverse() = default;
ReferenceInverse::ReferenceInverse(ReferenceInverse&&) noexcept = default;

void ReferenceInverse::forward(double* plane) const {
  for (int y = 0; y < parts_->count[1]; ++y)
    parts_->along_x.forward(plane + parts_->row() * static_cast<std::size_t>(y));
  parts_->transform_y(plane, [&](double* mine) { parts_->along_y.forward(mine); });
}

void ReferenceInverse::columns(double* field) const {
  tbb::parallel_for(0, parts_->count[1], [&](int y) { parts_->columns_of(y, field); });
}

void ReferenceInverse::backward(double* plane) const {
  parts_->transform_y(plane, [&](double* mine) { parts_->along_y.backward(mine); });
  for (int y = 0; y < parts_->count[1]; ++y)
    parts_->along_x.backward(plane + parts_->row() * static_cast<std::size_t>(y));
}

std::size_t ReferenceInverse::memory() const {
  return sizeof(double) * parts_->factors.size();
}

Matrix6 mirrored_in_z(const Matrix6& stiffness) {
  Matrix6 c = stiffness;
  // An index is odd in z when it has one z: 23 and 13.
  for (int i = 0; i < 6; ++i)
    for (int j = 0; j < 6; ++j)
      if ((i == 3 || i == 4) != (j == 3 || j == 4)) c(i, j) = 0.0;
  return c;
}

}  // namespace heddle::mesoscale::solid
