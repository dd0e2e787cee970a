#include <catch2/catch.hpp>

#include <cmath>
#include <vector>

#include "core/sparse_solver.h"

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
}  // namespace

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
