#include <catch2/catch.hpp>

#include <algorithm>
#include <cmath>
#include <random>
#include <vector>

#include <tbb/global_control.h>

#include "core/sparse_solver.h"

using heddle::Factorisation;
using heddle::SparseSolver;
using heddle::SymmetricPattern;

namespace {
// Chain of springs, one end held: stiffness tridiag(-1, 2, -1), last diagonal 1.
SymmetricPattern chain_pattern(int n) {
  SymmetricPattern p;
  p.size = n;
  p.column_start.push_back(0);
  for (int j = 0; j < n; ++j) {
    p.row.push_back(j);
    if (j + 1 < n) p.row.push_back(j + 1);
    p.column_start.push_back(static_cast<int>(p.row.size()));
  }
  return p;
}
void fill_chain(SparseSolver& solver, double stiffness) {
  const auto& p = solver.pattern();
  auto v = solver.values();
  for (int j = 0; j < p.size; ++j)
    for (int k = p.column_start[j]; k < p.column_start[j + 1]; ++k)
      v[k] = p.row[k] == j ? (j + 1 < p.size ? 2.0 : 1.0) * stiffness : -stiffness;
}
// n x n nodes, each bound to its neighbours up to `reach` lines away, and one unknown bound to all of them,
// as a rigid tool is to a sheet.
SymmetricPattern sheet_pattern(int n, int reach) {
  SymmetricPattern p;
  p.size = n * n + 1;
  p.column_start.push_back(0);
  for (int j = 0; j < n * n; ++j) {
    for (int i = j; i < n * n; ++i)
      if (i / n - j / n <= reach && std::abs(i % n - j % n) <= reach) p.row.push_back(i);
    p.row.push_back(n * n);
    p.column_start.push_back(static_cast<int>(p.row.size()));
  }
  p.row.push_back(n * n);
  p.column_start.push_back(static_cast<int>(p.row.size()));
  return p;
}

// Random springs between all that are bound, so weakly to the ground that the last digits matter.
void fill_springs(SparseSolver& solver, unsigned seed) {
  std::mt19937 random(seed);
  std::uniform_real_distribution<double> exponent(-3.0, 3.0);
  const auto& p = solver.pattern();
  auto v = solver.values();
  std::fill(v.begin(), v.end(), 0.0);
  for (int j = 0; j < p.size; ++j) {
    v[p.column_start[j]] += 1.0;
    for (int k = p.column_start[j] + 1; k < p.column_start[j + 1]; ++k) {
      const double stiffness = std::pow(10.0, exponent(random));
      v[k] = -stiffness;
      v[p.column_start[j]] += stiffness;
      v[p.column_start[p.row[k]]] += stiffness;
    }
  }
}

std::vector<double> solution(SparseSolver& solver) {
  std::vector<double> b(solver.pattern().size);
  for (std::size_t i = 0; i < b.size(); ++i) b[i] = std::sin(static_cast<double>(i));
  solver.solve(b);
  return b;
}

// Largest residual of A x = b against the largest of b, with `solution`'s b.
double residual(SparseSolver& solver, const std::vector<double>& x) {
  const auto& p = solver.pattern();
  const auto v = solver.values();
  std::vector<double> r(x.size());
  for (std::size_t i = 0; i < r.size(); ++i) r[i] = -std::sin(static_cast<double>(i));
  for (int j = 0; j < p.size; ++j)
    for (int k = p.column_start[j]; k < p.column_start[j + 1]; ++k) {
      r[p.row[k]] += v[k] * x[j];
      if (p.row[k] != j) r[j] += v[k] * x[p.row[k]];
    }
  double largest = 0.0;
  for (double value : r) largest = std::max(largest, std::abs(value));
  return largest;
}
}  // namespace

TEST_CASE("a sheet of random springs is solved as CHOLMOD alone solves it, again after other springs",
          "[core][solver]") {
  const SymmetricPattern pattern = sheet_pattern(40, 2);
  SparseSolver ours(pattern), reference(pattern, Factorisation::cholmod);
  for (unsigned seed : {1u, 2u}) {
    fill_springs(ours, seed);
    fill_springs(reference, seed);
    REQUIRE(ours.factorise());
    REQUIRE(reference.factorise());
    const auto x = solution(ours), y = solution(reference);
    double apart = 0.0, size = 0.0;
    for (std::size_t i = 0; i < x.size(); ++i) {
      apart = std::max(apart, std::abs(x[i] - y[i]));
      size = std::max(size, std::abs(y[i]));
    }
    CHECK(apart < 1e-9 * size);
    CHECK(residual(ours, x) < 1e-9);
    auto wrong = x;
    wrong[7] *= 1.01;
    CHECK(residual(ours, wrong) > 1e-4);  // the check can fail
  }
}

TEST_CASE("a factor is the same to the last bit on one thread and on several", "[core][solver]") {
  SparseSolver solver(sheet_pattern(40, 2));
  fill_springs(solver, 3);
  const auto on = [&](std::size_t threads) {
    const tbb::global_control limit(tbb::global_control::max_allowed_parallelism, threads);
    REQUIRE(solver.factorise());
    return solution(solver);
  };
  const auto one = on(1);
  for (int k = 0; k < 5; ++k) CHECK(on(4) == one);
}

TEST_CASE("a spring that pushes deep inside a sheet makes it indefinite, for CHOLMOD as well",
          "[core][solver]") {
  const SymmetricPattern pattern = sheet_pattern(20, 2);
  for (auto by : {Factorisation::multifrontal, Factorisation::cholmod}) {
    SparseSolver solver(pattern, by);
    fill_springs(solver, 4);
    solver.values()[pattern.column_start[210]] = -1.0;
    CHECK_FALSE(solver.factorise());
    fill_springs(solver, 4);
    CHECK(solver.factorise());
  }
}

TEST_CASE("two sheets that do not touch are two trees of the same factor", "[core][solver]") {
  SymmetricPattern pattern = chain_pattern(30);
  const SymmetricPattern other = sheet_pattern(10, 1);
  for (int row : other.row) pattern.row.push_back(row + 30);
  for (std::size_t j = 1; j < other.column_start.size(); ++j)
    pattern.column_start.push_back(pattern.column_start[30] + other.column_start[j]);
  pattern.size += other.size;
  SparseSolver solver(pattern);
  fill_springs(solver, 5);
  REQUIRE(solver.factorise());
  CHECK(residual(solver, solution(solver)) < 1e-9);
}

TEST_CASE("a chain of springs pulled at its end stretches linearly, and again after a second factorisation",
          "[core][solver]") {
  const int n = 200;
  SparseSolver solver(chain_pattern(n));
  for (double stiffness : {1.0, 4.0}) {
    fill_chain(solver, stiffness);
    REQUIRE(solver.factorise());
    std::vector<double> b(n, 0.0);
    b.back() = 1.0;
    solver.solve(b);
    for (int i = 0; i < n; ++i) CHECK(b[i] == Approx((i + 1) / stiffness).epsilon(1e-10));
  }
}

TEST_CASE("a matrix that is not positive definite is an answer, and the solver works on", "[core][solver]") {
  SparseSolver solver(chain_pattern(10));
  fill_chain(solver, -1.0);
  CHECK_FALSE(solver.factorise());
  fill_chain(solver, 1.0);
  CHECK(solver.factorise());
}

TEST_CASE("the BLAS behind the solver is OpenBLAS", "[core][solver]") {
  CHECK_THAT(heddle::blas_name(), Catch::StartsWith("OpenBLAS"));
}
