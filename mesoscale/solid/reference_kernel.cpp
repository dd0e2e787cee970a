#include "mesoscale/solid/reference_kernel.h"

#include <cmath>
#include <cstddef>
#include <numbers>

#include "mesoscale/solid/pack.h"

namespace heddle::mesoscale::solid {

namespace {

using Matrix9 = Eigen::Matrix<double, 9, 9>;

Eigen::Matrix3d block_of(const Matrix9& t, int m, int n) {
  return t.block<3, 3>(3 * m, 3 * n);
}

// Six numbers a wave, one array each, so that the compiler works on several waves at once.
using Symmetric = double[6][largest_block];

HEDDLE_INLINE void invert(const Symmetric& s, double scale, int count, Symmetric& m) {
  for (int w = 0; w < count; ++w) {
    const double a = s[0][w], b = s[1][w], c = s[2][w], d = s[3][w], e = s[4][w], f = s[5][w];
    const double m00 = b * c - f * f, m01 = e * f - d * c, m02 = d * f - b * e;
    const double over = scale / (a * m00 + d * m01 + e * m02);
    m[0][w] = over * m00;
    m[1][w] = over * (a * c - e * e);
    m[2][w] = over * (a * b - d * d);
    m[3][w] = over * m01;
    m[4][w] = over * m02;
    m[5][w] = over * (d * e - a * f);
  }
}

template <int cases>
HEDDLE_INLINE void divide(const PeriodicSymbol& symbol, const std::array<Waves, 3>& waves,
                          const PeriodicBlock& block, double scale, double* values) {
  const double* x2 = waves[0].sine2.data() + block.first;
  const double* xc = waves[0].cross.data() + block.first;
  const double* xe = waves[0].even.data() + block.first;
  const auto y = static_cast<std::size_t>(block.y), z = static_cast<std::size_t>(block.z);
  const double ye = waves[1].even[y], ze = waves[2].even[z];
  const double xx = ye * ze, yy = waves[1].sine2[y] * ze, zz = ye * waves[2].sine2[z];
  const double xy = waves[1].cross[y] * ze, xz = ye * waves[2].cross[z],
               yz = waves[1].cross[y] * waves[2].cross[z];
  Symmetric s, m;
  for (int entry = 0; entry < 6; ++entry) {
    const auto c = [&](int term) {
      return symbol.coefficient[static_cast<std::size_t>(term)][static_cast<std::size_t>(entry)];
    };
    const double of_sine2 = c(0) * xx, of_even = c(1) * yy + c(2) * zz + c(5) * yz,
                 of_cross = c(3) * xy + c(4) * xz;
    for (int w = 0; w < block.count; ++w) s[entry][w] = of_sine2 * x2[w] + of_even * xe[w] + of_cross * xc[w];
  }
  const bool mean = block.first == 0 && block.y == 0 && block.z == 0;
  if (mean)
    for (int entry = 0; entry < 6; ++entry) s[entry][0] = entry < 3 ? 1.0 : 0.0;
  invert(s, scale, block.count, m);
  if (mean)
    for (int entry = 0; entry < 6; ++entry) m[entry][0] = 0.0;
  for (int w = 0; w < block.count; ++w) {
    double* at = values + static_cast<std::ptrdiff_t>(3 * cases) * w;
    Pack<cases> r[3], u[3];
#pragma GCC unroll 3
    for (int i = 0; i < 3; ++i) load(r[i], at + cases * i);
    set_product(u[0], m[0][w], r[0]);
    add_product(u[0], m[3][w], r[1]);
    add_product(u[0], m[4][w], r[2]);
    set_product(u[1], m[3][w], r[0]);
    add_product(u[1], m[1][w], r[1]);
    add_product(u[1], m[5][w], r[2]);
    set_product(u[2], m[4][w], r[0]);
    add_product(u[2], m[5][w], r[1]);
    add_product(u[2], m[2][w], r[2]);
#pragma GCC unroll 3
    for (int i = 0; i < 3; ++i) store(at + cases * i, u[i]);
  }
}

// sign i u: real and imaginary parts change places.
template <int cases>
HEDDLE_INLINE void turn(Pack<cases>& u, double sign) {
  if constexpr (cases == 6) {
    const Four a = {-u.a[1], u.a[0], -u.a[3], u.a[2]};
    const Two b = {-u.b[1], u.b[0]};
    u.a = sign * a;
    u.b = sign * b;
  } else {
    const Two a = {-u.a[1], u.a[0]};
    u.a = sign * a;
  }
}

template <int cases>
HEDDLE_INLINE void multiply_symmetric(const double* m, const Pack<cases>* x, Pack<cases>* y) {
  set_product(y[0], m[0], x[0]);
  add_product(y[0], m[3], x[1]);
  add_product(y[0], m[4], x[2]);
  set_product(y[1], m[3], x[0]);
  add_product(y[1], m[1], x[1]);
  add_product(y[1], m[5], x[2]);
  set_product(y[2], m[4], x[0]);
  add_product(y[2], m[5], x[1]);
  add_product(y[2], m[2], x[2]);
}

// v_k = P_k (r_k - up^T v_(k-1)) upwards, then u_k = v_k - P_k up u_(k+1) downwards.
template <int cases>
HEDDLE_INLINE void thomas(const SlabBlock& b, double* values) {
  constexpr std::ptrdiff_t wave = 3 * cases;
  const auto up = [&](int row, int column, int w) { return b.up[(3 * row + column) * largest_block + w]; };
  for (int k = 0; k < b.planes; ++k) {
    double* here = values + b.stride * k;
    const double* inverse = b.inverse + static_cast<std::ptrdiff_t>(6) * b.count * k;
    for (int w = 0; w < b.count; ++w) {
      double* at = here + wave * w;
      Pack<cases> r[3], v[3];
#pragma GCC unroll 3
      for (int i = 0; i < 3; ++i) {
        load(r[i], at + cases * i);
        r[i].a *= b.scale;
        r[i].b *= b.scale;
      }
      turn(r[2], b.sign);
      if (k > 0) {
#pragma GCC unroll 3
        for (int i = 0; i < 3; ++i) load(v[i], at - b.stride + cases * i);
#pragma GCC unroll 3
        for (int i = 0; i < 3; ++i)
#pragma GCC unroll 3
          for (int j = 0; j < 3; ++j) subtract_product(r[i], up(j, i, w), v[j]);
      }
      multiply_symmetric(inverse + 6 * w, r, v);
#pragma GCC unroll 3
      for (int i = 0; i < 3; ++i) store(at + cases * i, v[i]);
    }
  }
  for (int k = b.planes - 1; k >= 0; --k) {
    double* here = values + b.stride * k;
    const double* inverse = b.inverse + static_cast<std::ptrdiff_t>(6) * b.count * k;
    for (int w = 0; w < b.count; ++w) {
      double* at = here + wave * w;
      if (k + 1 < b.planes) {
        Pack<cases> above[3], pull[3], fall[3], v;
#pragma GCC unroll 3
        for (int i = 0; i < 3; ++i) load(above[i], at + b.stride + cases * i);
#pragma GCC unroll 3
        for (int i = 0; i < 3; ++i) {
          set_product(pull[i], up(i, 0, w), above[0]);
          add_product(pull[i], up(i, 1, w), above[1]);
          add_product(pull[i], up(i, 2, w), above[2]);
        }
        multiply_symmetric(inverse + 6 * w, pull, fall);
#pragma GCC unroll 3
        for (int i = 0; i < 3; ++i) {
          load(v, at + cases * i);
          set_difference(v, v, fall[i]);
          store(at + cases * i, v);
        }
      }
    }
  }
  // Back from w_z = i u_z.
  for (int k = 0; k < b.planes; ++k)
    for (int w = 0; w < b.count; ++w) {
      double* at = values + b.stride * k + wave * w + 2 * cases;
      Pack<cases> u;
      load(u, at);
      turn(u, -b.sign);
      store(at, u);
    }
}

template <int cases>
void divide_plain(const PeriodicSymbol& s, const std::array<Waves, 3>& w, const PeriodicBlock& b,
                  double scale, double* values) {
  divide<cases>(s, w, b, scale, values);
}
template <int cases>
__attribute__((target("avx2,fma"))) void divide_avx2(const PeriodicSymbol& s, const std::array<Waves, 3>& w,
                                                     const PeriodicBlock& b, double scale, double* values) {
  divide<cases>(s, w, b, scale, values);
}
template <int cases>
void thomas_plain(const SlabBlock& b, double* values) {
  thomas<cases>(b, values);
}
template <int cases>
__attribute__((target("avx2,fma"))) void thomas_avx2(const SlabBlock& b, double* values) {
  thomas<cases>(b, values);
}

bool has_avx2() {
  return best_instructions() != Instructions::plain;
}

}  // namespace

Waves::Waves(const std::vector<int>& order) {
  for (const int k : order) {
    const double angle = std::numbers::pi * k / static_cast<double>(order.size()), s = std::sin(angle),
                 c = std::cos(angle);
    sine2.push_back(s * s);
    cross.push_back(s * c);
    even.push_back(c * c + s * s / 3.0);
  }
}

PeriodicSymbol::PeriodicSymbol(const Matrix9& t) {
  constexpr int pairs[6][2] = {{0, 0}, {1, 1}, {2, 2}, {0, 1}, {0, 2}, {1, 2}};
  for (std::size_t term = 0; term < 6; ++term) {
    const auto [m, n] = pairs[term];
    coefficient[term] =
        packed(m == n ? block_of(t, m, m) : Eigen::Matrix3d(block_of(t, m, n) + block_of(t, n, m)));
  }
}

void divide_by_symbol(const PeriodicSymbol& symbol, const std::array<Waves, 3>& waves,
                      const PeriodicBlock& block, double scale, double* values) {
  if (block.cases == loads)
    (has_avx2() ? divide_avx2<loads> : divide_plain<loads>)(symbol, waves, block, scale, values);
  else
    (has_avx2() ? divide_avx2<pair_of_loads> : divide_plain<pair_of_loads>)(symbol, waves, block, scale,
                                                                            values);
}

SlabBlocks slab_blocks(const Matrix9& t, const Waves& x, const Waves& y, int place_x, int place_y) {
  const auto i = static_cast<std::size_t>(place_x), j = static_cast<std::size_t>(place_y);
  // Energy of e = (b + t) / 2 and o = (t - b) / 2 of a layer's planes b and t:
  //   e* in_plane e + o* (in_plane / 3 + across) o, and mixed parts -i e* mixed o.
  const Eigen::Matrix3d in_plane = block_of(t, 0, 0) * (x.sine2[i] * y.even[j]) +
                                   block_of(t, 1, 1) * (y.sine2[j] * x.even[i]) +
                                   (block_of(t, 0, 1) + block_of(t, 1, 0)) * (x.cross[i] * y.cross[j]);
  const Eigen::Matrix3d odd = in_plane / 3.0 + block_of(t, 2, 2) * (x.even[i] * y.even[j]);
  Eigen::Matrix3d mixed =
      block_of(t, 0, 2) * (x.cross[i] * y.even[j]) + block_of(t, 1, 2) * (y.cross[j] * x.even[i]);
  // With i u_z for u_z the factor -i becomes -1 for in-plane rows and +1 for the row of z.
  mixed.topRows<2>() *= -1.0;
  return {0.25 * (in_plane + odd - mixed - mixed.transpose()),
          0.25 * (in_plane + odd + mixed + mixed.transpose()),
          0.25 * (in_plane - odd + mixed - mixed.transpose())};
}

void solve_slab(const SlabBlock& block, double* values) {
  if (block.cases == loads)
    (has_avx2() ? thomas_avx2<loads> : thomas_plain<loads>)(block, values);
  else
    (has_avx2() ? thomas_avx2<pair_of_loads> : thomas_plain<pair_of_loads>)(block, values);
}

}  // namespace heddle::mesoscale::solid
