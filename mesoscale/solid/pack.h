#pragma once

#include <cstring>

namespace heddle::mesoscale::solid {

#define HEDDLE_INLINE inline __attribute__((always_inline))

typedef double Four __attribute__((vector_size(32)));
typedef double Two __attribute__((vector_size(16)));

/// In place of the other four numbers where a pack has two.
struct Nothing {};
HEDDLE_INLINE Nothing operator+(Nothing, Nothing) {
  return {};
}
HEDDLE_INLINE Nothing operator-(Nothing, Nothing) {
  return {};
}
HEDDLE_INLINE Nothing operator*(Nothing, Nothing) {
  return {};
}
HEDDLE_INLINE Nothing operator*(double, Nothing) {
  return {};
}
HEDDLE_INLINE void operator+=(Nothing&, Nothing) {}
HEDDLE_INLINE void operator-=(Nothing&, Nothing) {}
HEDDLE_INLINE void operator*=(Nothing&, double) {}

/// One number of all load cases that are solved side by side, six or two, and what is done with it. Every
/// function is inlined into a caller that is compiled for its processor, so that one text serves SSE2, AVX2
/// and AVX-512.
template <int cases>
struct Pack;
template <>
struct Pack<6> {
  Four a;
  Two b;
};
template <>
struct Pack<2> {
  Two a;
  [[no_unique_address]] Nothing b;
};

template <int cases>
HEDDLE_INLINE void load(Pack<cases>& p, const double* from) {
  std::memcpy(&p.a, from, sizeof p.a);
  if constexpr (cases == 6) std::memcpy(&p.b, from + 4, sizeof p.b);
}
template <int cases>
HEDDLE_INLINE void store(double* to, const Pack<cases>& p) {
  std::memcpy(to, &p.a, sizeof p.a);
  if constexpr (cases == 6) std::memcpy(to + 4, &p.b, sizeof p.b);
}
template <int cases>
HEDDLE_INLINE void add(Pack<cases>& sum, const Pack<cases>& p) {
  sum.a += p.a;
  sum.b += p.b;
}
template <int cases>
HEDDLE_INLINE void set_sum(Pack<cases>& out, const Pack<cases>& p, const Pack<cases>& q) {
  out.a = p.a + q.a;
  out.b = p.b + q.b;
}
template <int cases>
HEDDLE_INLINE void set_difference(Pack<cases>& out, const Pack<cases>& p, const Pack<cases>& q) {
  out.a = p.a - q.a;
  out.b = p.b - q.b;
}
template <int cases>
HEDDLE_INLINE void set_product(Pack<cases>& out, double factor, const Pack<cases>& p) {
  out.a = factor * p.a;
  out.b = factor * p.b;
}
template <int cases>
HEDDLE_INLINE void add_product(Pack<cases>& sum, double factor, const Pack<cases>& p) {
  sum.a += factor * p.a;
  sum.b += factor * p.b;
}
template <int cases>
HEDDLE_INLINE void add_product(Pack<cases>& sum, const Pack<cases>& p, const Pack<cases>& q) {
  sum.a += p.a * q.a;
  sum.b += p.b * q.b;
}
template <int cases>
HEDDLE_INLINE void set_zero(Pack<cases>& out) {
  out = Pack<cases>{};
}
template <int cases>
HEDDLE_INLINE void subtract_product(Pack<cases>& sum, double factor, const Pack<cases>& p) {
  sum.a -= factor * p.a;
  sum.b -= factor * p.b;
}

}  // namespace heddle::mesoscale::solid
