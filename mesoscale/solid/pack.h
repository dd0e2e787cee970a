#pragma once

#include <cstring>

namespace heddle::mesoscale::solid {

#define HEDDLE_INLINE inline __attribute__((always_inline))

typedef double Four __attribute__((vector_size(32)));
typedef double Two __attribute__((vector_size(16)));

/// One number of all six load cases, and what is done with it. Every function is inlined into a caller that
/// is compiled for its processor, so that one text serves SSE2, AVX2 and AVX-512.
struct Pack {
  Four a;
  Two b;
};

HEDDLE_INLINE void load(Pack& p, const double* from) {
  std::memcpy(&p.a, from, sizeof p.a);
  std::memcpy(&p.b, from + 4, sizeof p.b);
}
HEDDLE_INLINE void store(double* to, const Pack& p) {
  std::memcpy(to, &p.a, sizeof p.a);
  std::memcpy(to + 4, &p.b, sizeof p.b);
}
HEDDLE_INLINE void add(Pack& sum, const Pack& p) {
  sum.a += p.a;
  sum.b += p.b;
}
HEDDLE_INLINE void set_sum(Pack& out, const Pack& p, const Pack& q) {
  out.a = p.a + q.a;
  out.b = p.b + q.b;
}
HEDDLE_INLINE void set_difference(Pack& out, const Pack& p, const Pack& q) {
  out.a = p.a - q.a;
  out.b = p.b - q.b;
}
HEDDLE_INLINE void set_product(Pack& out, double factor, const Pack& p) {
  out.a = factor * p.a;
  out.b = factor * p.b;
}
HEDDLE_INLINE void add_product(Pack& sum, double factor, const Pack& p) {
  sum.a += factor * p.a;
  sum.b += factor * p.b;
}
HEDDLE_INLINE void add_product(Pack& sum, const Pack& p, const Pack& q) {
  sum.a += p.a * q.a;
  sum.b += p.b * q.b;
}
HEDDLE_INLINE void set_zero(Pack& out) {
  out.a = Four{};
  out.b = Two{};
}
HEDDLE_INLINE void subtract_product(Pack& sum, double factor, const Pack& p) {
  sum.a -= factor * p.a;
  sum.b -= factor * p.b;
}

}  // namespace heddle::mesoscale::solid
