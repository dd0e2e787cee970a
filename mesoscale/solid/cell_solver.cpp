#include "mesoscale/solid/cell_solver.h"

#include <algorithm>
#include <cmath>

#include <fmt/format.h>
#include <tbb/parallel_for.h>

#include "core/problem.h"
#include "mesoscale/solid/pack.h"

namespace heddle::mesoscale::solid {

namespace {

// One set of numbers a plane or layer, added up in order.
CaseNumbers in_order(const std::vector<CaseNumbers>& parts) {
  CaseNumbers sum{};
  for (const CaseNumbers& part : parts)
    for (std::size_t l = 0; l < loads; ++l) sum[l] += part[l];
  return sum;
}

// r -= alpha q, and q := r, of one plane.
template <int cases>
void descend(const CaseNumbers& alpha, double* r, double* q, std::size_t size) {
  Pack<cases> step;
  load(step, alpha.data());
  for (std::size_t n = 0; n < size; n += cases) {
    Pack<cases> residual, product;
    load(residual, r + n);
    load(product, q + n);
    residual.a -= step.a * product.a;
    residual.b -= step.b * product.b;
    store(r + n, residual);
    store(q + n, residual);
  }
}

template <int cases>
CaseNumbers dot(const double* x, const double* y, std::size_t size) {
  Pack<cases> sum;
  set_zero(sum);
  for (std::size_t n = 0; n < size; n += cases) {
    Pack<cases> a, b;
    load(a, x + n);
    load(b, y + n);
    add_product(sum, a, b);
  }
  CaseNumbers result{};
  store(result.data(), sum);
  return result;
}

// u += alpha p; p := z + beta p; z := 0, of one plane.
template <int cases>
void advance(const CaseNumbers& alpha, const CaseNumbers& beta, double* u, double* p, double* z,
             std::size_t size) {
  Pack<cases> step, keep, nothing;
  load(step, alpha.data());
  load(keep, beta.data());
  set_zero(nothing);
  for (std::size_t n = 0; n < size; n += cases) {
    Pack<cases> at, direction, fresh;
    load(at, u + n);
    load(direction, p + n);
    load(fresh, z + n);
    add_product(at, step, direction);
    direction.a = fresh.a + keep.a * direction.a;
    direction.b = fresh.b + keep.b * direction.b;
    store(u + n, at);
    store(p + n, direction);
    store(z + n, nothing);
  }
}

// sum of a_i b_j over the numbers of one plane, row-major.
template <int cases>
HEDDLE_INLINE void sum_outer(const double* a, const double* b, std::size_t size, double* sums) {
  Pack<cases> rows[cases];
#pragma GCC unroll 6
  for (int i = 0; i < cases; ++i) set_zero(rows[i]);
  for (std::size_t n = 0; n < size; n += cases) {
    Pack<cases> of_b;
    load(of_b, b + n);
#pragma GCC unroll 6
    for (int i = 0; i < cases; ++i) add_product(rows[i], a[n + static_cast<std::size_t>(i)], of_b);
  }
#pragma GCC unroll 6
  for (int i = 0; i < cases; ++i) store(sums + cases * i, rows[i]);
}
template <int cases>
__attribute__((target("avx2,fma"))) void sum_outer_avx2(const double* a, const double* b, std::size_t size,
                                                        double* sums) {
  sum_outer<cases>(a, b, size, sums);
}
template <int cases>
void outer_products(const double* a, const double* b, std::size_t size, double* sums) {
  if (best_instructions() == Instructions::plain)
    sum_outer<cases>(a, b, size, sums);
  else
    sum_outer_avx2<cases>(a, b, size, sums);
}

template <int cases>
Matrix6 gram_of(const Field& a, const Field& b, std::size_t plane) {
  const std::size_t planes = a.size() / plane;
  std::vector<std::array<double, cases * cases>> parts(planes);
  tbb::parallel_for(std::size_t{0}, planes, [&](std::size_t k) {
    outer_products<cases>(a.data() + k * plane, b.data() + k * plane, plane, parts[k].data());
  });
  Matrix6 sum = Matrix6::Zero();
  for (const auto& part : parts)
    sum.topLeftCorner<cases, cases>() +=
        Eigen::Map<const Eigen::Matrix<double, cases, cases, Eigen::RowMajor>>(part.data());
  return sum;
}

}  // namespace

int SolverSummary::most_iterations() const {
  return *std::max_element(iterations.begin(), iterations.end());
}

Matrix6 gram(const Field& a, const Field& b, std::size_t plane, int cases) {
  return cases == loads ? gram_of<loads>(a, b, plane) : gram_of<pair_of_loads>(a, b, plane);
}

CellSolver::CellSolver(const ElasticCell& cell, Faces faces, const Matrix6& reference, int cases)
    : cell_(cell),
      faces_(faces),
      cases_(cases),
      planes_(planes_of(cell.count[2], faces)),
      plane_(static_cast<std::size_t>(3 * cases) * cell.count[0] * cell.count[1]),
      tables_(element_tables(cell.stiffness, cell.voxel_edges())),
      inverse_(cell.count, cell.voxel_edges(), reference, faces, cases) {}

Field CellSolver::field() const {
  return Field(plane_ * static_cast<std::size_t>(planes_), 0.0);
}

std::size_t CellSolver::memory() const {
  return 4 * sizeof(double) * plane_ * static_cast<std::size_t>(planes_) +
         sizeof(ElementTable) * tables_.size() + sizeof(std::uint16_t) * cell_.voxels() + inverse_.memory();
}

CaseNumbers CellSolver::multiply(const Field& u, Field& force) const {
  return add_product(u, force, [&](int k) {
    std::fill_n(force.begin() + static_cast<std::ptrdiff_t>(plane_) * k, plane_, 0.0);
  });
}

template <class Prepare>
CaseNumbers CellSolver::add_product(const Field& u, Field& force, const Prepare& prepare) const {
  std::vector<CaseNumbers> energy(static_cast<std::size_t>(cell_.count[2]));
  for_layers(prepare, [&](int k) {
    const std::size_t low = plane_ * static_cast<std::size_t>(k),
                      high = plane_ * static_cast<std::size_t>((k + 1) % planes_);
    energy[static_cast<std::size_t>(k)] =
        apply_layer({cell_.count[0], cell_.count[1], u.data() + low, u.data() + high, force.data() + low,
                     force.data() + high,
                     cell_.material.data() + static_cast<std::size_t>(cell_.count[0]) * cell_.count[1] * k,
                     tables_.data(), cases_});
  });
  return in_order(energy);
}

// z := M z, where z holds the residual transformed along x and y. @return  r . z
CaseNumbers CellSolver::precondition(const Field& residual, Field& z) const {
  inverse_.columns(z.data());
  std::vector<CaseNumbers> parts(static_cast<std::size_t>(planes_));
  tbb::parallel_for(0, planes_, [&](int k) {
    const std::size_t at = plane_ * static_cast<std::size_t>(k);
    inverse_.backward(z.data() + at);
    parts[static_cast<std::size_t>(k)] =
        cases_ == loads ? dot<loads>(residual.data() + at, z.data() + at, plane_)
                        : dot<pair_of_loads>(residual.data() + at, z.data() + at, plane_);
  });
  return in_order(parts);
}

SolverSummary CellSolver::solve(Field& r, Field& u, const CaseNumbers& scale,
                                const SolverOptions& options) const {
  const auto cases = static_cast<std::size_t>(cases_);
  Field p = field(), q = field();
  u = field();
  CaseNumbers alpha{}, beta{}, first{}, rz{};
  std::array<bool, loads> done{};
  SolverSummary summary;
  const auto check_finite = [&](const CaseNumbers& energies, const char* what) {
    for (std::size_t l = 0; l < cases; ++l)
      if (!std::isfinite(energies[l]))
        throw NumericalError(fmt::format("homogenisation: load case {}, iteration {}: {} is not finite",
                                         l + 1, summary.most_iterations(), what));
  };
  for (int iteration = 0;; ++iteration) {
    tbb::parallel_for(0, planes_, [&](int k) {
      const std::size_t at = plane_ * static_cast<std::size_t>(k);
      (cases_ == loads ? descend<loads> : descend<pair_of_loads>)(alpha, r.data() + at, q.data() + at,
                                                                  plane_);
      inverse_.forward(q.data() + at);
    });
    const CaseNumbers next = precondition(r, q);
    check_finite(next, "the energy of the residual");
    if (iteration == 0) first = next;
    bool all = true;
    for (std::size_t l = 0; l < cases; ++l) {
      // Rounding may leave a residual of nothing slightly negative.
      const double left = std::max(next[l], 0.0);
      const double floor = 1e-28 * scale[l];
      if (!done[l]) {
        summary.iterations[l] = iteration;
        summary.residual[l] = first[l] > floor ? std::sqrt(left / first[l]) : 0.0;
        done[l] = left <= std::max(options.tolerance * options.tolerance * first[l], floor);
        beta[l] = iteration > 0 ? left / rz[l] : 0.0;
      } else {
        beta[l] = 0.0;
      }
      rz[l] = left;
      all = all && done[l];
    }
    const auto to_next = [&](int k) {
      const std::size_t at = plane_ * static_cast<std::size_t>(k);
      (cases_ == loads ? advance<loads> : advance<pair_of_loads>)(alpha, beta, u.data() + at, p.data() + at,
                                                                  q.data() + at, plane_);
    };
    if (all || iteration == options.max_iterations) {
      tbb::parallel_for(0, planes_, to_next);
      summary.converged = all;
      summary.reason = all ? "the residual is below the tolerance"
                           : fmt::format("{} iterations were not enough", options.max_iterations);
      return summary;
    }
    const CaseNumbers pq = add_product(p, q, to_next);
    check_finite(pq, "the energy of the step");
    for (std::size_t l = 0; l < cases; ++l) alpha[l] = done[l] || !(pq[l] > 0.0) ? 0.0 : rz[l] / pq[l];
  }
}

}  // namespace heddle::mesoscale::solid
