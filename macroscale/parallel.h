#pragma once

#include <functional>

#include <tbb/blocked_range.h>
#include <tbb/parallel_for.h>
#include <tbb/parallel_reduce.h>

namespace heddle::macroscale {

/// body(i) for i = 0 .. n - 1, in any order.
template <class Body>
void for_each(int n, const Body& body) {
  tbb::parallel_for(tbb::blocked_range<int>(0, n, 256), [&](const tbb::blocked_range<int>& range) {
    for (int i = range.begin(); i != range.end(); ++i) body(i);
  });
}

/// Sum of term(i) over fixed pieces in a fixed order: the same bytes on one thread or many.
template <class Term>
double ordered_sum(int n, const Term& term) {
  return tbb::parallel_deterministic_reduce(
      tbb::blocked_range<int>(0, n, 512), 0.0,
      [&](const tbb::blocked_range<int>& range, double sum) {
        for (int i = range.begin(); i != range.end(); ++i) sum += term(i);
        return sum;
      },
      std::plus<>());
}

}  // namespace heddle::macroscale
