#include "macroscale/corner_filter.h"

#include <algorithm>
#include <array>
#include <cmath>

#include <Eigen/Eigenvalues>

namespace heddle::macroscale {

namespace {

using Eigen::Matrix4d;
using Eigen::Vector4d;

// diagonal[k], next[k] between k and k + 1; `vectors` hold the basis it is written in as columns.
struct Tridiagonal {
  std::array<double, 4> diagonal, next;  // next[3] is room to work in
  Matrix4d vectors = Matrix4d::Identity();

  void rotate(int i, int j, double c, double s) {  // new i = c i + s j, new j = c j - s i
    const Vector4d old = vectors.col(i);
    vectors.col(i) = c * old + s * vectors.col(j);
    vectors.col(j) = c * vectors.col(j) - s * old;
  }
};

struct Rotation {
  double c, s, length;
};

// Turns (x, y) into (length, 0).
Rotation rotation(double x, double y) {
  if (y == 0.0) return {1.0, 0.0, x};
  const double length = std::sqrt(x * x + y * y);
  return {x / length, y / length, length};
}

// Ring order: 0 a along, 1 a across, 2 b along, 3 b across, with 0-3 and 1-2 not coupled.
Tridiagonal tridiagonal(const CornerRing& r) {
  Tridiagonal t;
  // In the plane of 1 and 2, so that only one of them is coupled with 0.
  const auto [c, s, first] = rotation(r.turn_a, r.along);
  const double d1 = c * c * r.across_a + s * s * r.along_b, d2 = s * s * r.across_a + c * c * r.along_b;
  const double e12 = c * s * (r.along_b - r.across_a);
  const double e13 = c * r.across + s * r.turn_b, e23 = c * r.turn_b - s * r.across;
  t.rotate(1, 2, c, s);
  // In the plane of 2 and 3, so that only one of them is coupled with 1.
  const auto [c2, s2, second] = rotation(e12, e13);
  t.diagonal = {r.along_a, d1, c2 * c2 * d2 + 2.0 * c2 * s2 * e23 + s2 * s2 * r.across_b,
                s2 * s2 * d2 - 2.0 * c2 * s2 * e23 + c2 * c2 * r.across_b};
  t.next = {first, second, c2 * s2 * (r.across_b - d2) + (c2 * c2 - s2 * s2) * e23, 0.0};
  t.rotate(2, 3, c2, s2);
  return t;
}

// As many negative eigenvalues as negative pivots (Sylvester).
bool is_positive(const Tridiagonal& t) {
  double pivot = t.diagonal[0];
  for (int k = 0; k < 3; ++k) {
    if (!(pivot > 0.0)) return false;
    pivot = t.diagonal[k + 1] - t.next[k] * t.next[k] / pivot;
  }
  return pivot > 0.0;
}

// One implicit QL step with Wilkinson's shift on the block from `low` to `high`.
void ql_step(Tridiagonal& t, int low, int high) {
  auto& d = t.diagonal;
  auto& e = t.next;
  const double half = (d[low + 1] - d[low]) / (2.0 * e[low]);
  double g = d[high] - d[low] + e[low] / (half + std::copysign(std::sqrt(half * half + 1.0), half));
  double s = 1.0, c = 1.0, p = 0.0;
  for (int i = high - 1; i >= low; --i) {
    const double f = s * e[i], b = c * e[i];
    const double length = std::sqrt(f * f + g * g);
    e[i + 1] = length;
    if (length == 0.0) {
      d[i + 1] -= p;
      e[high] = 0.0;
      return;
    }
    s = f / length;
    c = g / length;
    g = d[i + 1] - p;
    const double r = (d[i] - g) * s + 2.0 * c * b;
    p = s * r;
    d[i + 1] = g + p;
    g = c * r - b;
    t.rotate(i + 1, i, c, s);
  }
  d[low] -= p;
  e[low] = g;
  e[high] = 0.0;
}

// Leaves eigenvalues on the diagonal, eigenvectors in `vectors`.
void diagonalise(Tridiagonal& t) {
  constexpr double rounding = 2.3e-16;
  constexpr int most = 40;  // steps an eigenvalue; two are usual
  double size = 0.0;
  for (int k = 0; k < 4; ++k) size = std::max(size, std::abs(t.diagonal[k]) + std::abs(t.next[k]));
  for (int low = 0; low < 4; ++low)
    for (int step = 0; step < most; ++step) {
      int high = low;
      // What is lost against the largest entry is lost to the sum over eigenvalues as well.
      while (high < 3 && std::abs(t.next[high]) > rounding * size) ++high;
      if (high == low) break;
      ql_step(t, low, high);
    }
}

}  // namespace

Matrix4d matrix_of(const CornerRing& r) {
  Matrix4d m;
  m << r.along_a, r.turn_a, r.along, 0.0,   //
      r.turn_a, r.across_a, 0.0, r.across,  //
      r.along, 0.0, r.along_b, r.turn_b,    //
      0.0, r.across, r.turn_b, r.across_b;
  return m;
}

Symmetric2 positive_part(Symmetric2 m) {
  const double mean = 0.5 * (m.xx + m.yy), half = 0.5 * (m.xx - m.yy);
  const double radius = std::hypot(half, m.xy);
  const double low = mean - radius, high = mean + radius;
  if (low >= 0.0) return m;
  if (high <= 0.0) return {};
  // Projector on the upper eigenvector, times its eigenvalue.
  const double cos2 = half / radius, sin2 = m.xy / radius;
  return {0.5 * high * (1.0 + cos2), 0.5 * high * sin2, 0.5 * high * (1.0 - cos2)};
}

Matrix4d positive_part(const CornerRing& ring) {
  Matrix4d m = matrix_of(ring);
  Tridiagonal t = tridiagonal(ring);
  if (is_positive(t)) return m;
  diagonalise(t);
  for (int k = 0; k < 4; ++k)
    if (t.diagonal[k] < 0.0) m -= t.diagonal[k] * t.vectors.col(k) * t.vectors.col(k).transpose();
  return m;
}

Matrix4d positive_part(const Matrix4d& m) {
  const Eigen::SelfAdjointEigenSolver<Matrix4d> eigen(m);
  if (eigen.eigenvalues()[0] >= 0.0) return m;
  return eigen.eigenvectors() * eigen.eigenvalues().cwiseMax(0.0).asDiagonal() *
         eigen.eigenvectors().transpose();
}

}  // namespace heddle::macroscale
