#include "core/sparse_solver.h"

#include <algorithm>
#include <cstring>
#include <optional>
#include <stdexcept>

#include <cholmod.h>
#include <fmt/format.h>

#include "core/multifrontal.h"

// OpenBLAS's own calls; its headers are not needed for them. They also make sure at link time that it is
// OpenBLAS that serves CHOLMOD: the reference BLAS takes 4 to 8 times longer.
extern "C" {
void openblas_set_num_threads(int threads);
char* openblas_get_config();
char* openblas_get_corename();
// From the OpenMP runtime that CHOLMOD brings along.
void omp_set_max_active_levels(int levels);
}

namespace heddle {

namespace {

Supernodes supernodes_of(const cholmod_factor& factor) {
  const auto copy = [](const void* from, std::size_t n) {
    const int* begin = static_cast<const int*>(from);
    return std::vector<int>(begin, begin + n);
  };
  const std::vector<int> panels = copy(factor.px, factor.nsuper + 1);
  return {copy(factor.super, factor.nsuper + 1), copy(factor.pi, factor.nsuper + 1),
          copy(factor.s, factor.ssize), std::vector<std::size_t>(panels.begin(), panels.end())};
}

}  // namespace

struct SparseSolver::Implementation {
  Implementation(SymmetricPattern p, Factorisation by)
      : pattern(std::move(p)), values(pattern.row.size(), 0.0) {
    // One thread a factorisation: a second BLAS thread gains nothing below 50 k nodes and costs
    // reproducibility.
    openblas_set_num_threads(1);
    // CHOLMOD asks for four OpenMP threads in short loops, which then spin beside TBB's on two cores
    // (docs/decisions/openmp-off.md). No active level = they run in the calling thread.
    omp_set_max_active_levels(0);
    cholmod_start(&common);
    common.supernodal = CHOLMOD_SUPERNODAL;
    common.final_ll = 1;
    common.print = 0;
    common.nmethods = 1;
    common.method[0].ordering = CHOLMOD_METIS;
    common.postorder = 1;
    // Relaxed supernodes a little wider than CHOLMOD's own (4, 16, 48; 0.8, 0.1, 0.05), with fewer zeros. For
    // the 13-node stencil of a woven sheet: docs/decisions/factorisation.md.
    common.nrelax[0] = 8;
    common.nrelax[1] = 24;
    common.nrelax[2] = 64;
    common.zrelax[0] = 0.5;
    common.zrelax[1] = 0.1;
    common.zrelax[2] = 0.03;

    matrix.nrow = matrix.ncol = static_cast<std::size_t>(pattern.size);
    matrix.nzmax = pattern.row.size();
    matrix.p = pattern.column_start.data();
    matrix.i = pattern.row.data();
    matrix.x = values.data();
    matrix.stype = -1;
    matrix.itype = CHOLMOD_INT;
    matrix.xtype = CHOLMOD_REAL;
    matrix.dtype = CHOLMOD_DOUBLE;
    matrix.sorted = 1;
    matrix.packed = 1;
    factor = cholmod_analyze(&matrix, &common);
    if (!factor)
      throw std::runtime_error(
          fmt::format("CHOLMOD could not analyse the pattern (status {})", common.status));
    if (by == Factorisation::cholmod) return;
    multifrontal.emplace(pattern, std::span(static_cast<const int*>(factor->Perm), factor->n),
                         supernodes_of(*factor));
    // Room for the panels, which CHOLMOD's solution reads.
    if (!cholmod_change_factor(CHOLMOD_REAL, 1, 1, 1, 1, factor, &common))
      throw std::runtime_error(fmt::format("no memory for a factor of {} values", factor->xsize));
  }
  ~Implementation() {
    cholmod_free_dense(&solution, &common);
    cholmod_free_dense(&work_y, &common);
    cholmod_free_dense(&work_e, &common);
    cholmod_free_factor(&factor, &common);
    cholmod_finish(&common);
  }
  Implementation(const Implementation&) = delete;
  Implementation& operator=(const Implementation&) = delete;

  SymmetricPattern pattern;
  std::vector<double> values;
  cholmod_common common{};
  cholmod_sparse matrix{};
  cholmod_factor* factor = nullptr;
  std::optional<MultifrontalFactor> multifrontal;
  cholmod_dense *solution = nullptr, *work_y = nullptr, *work_e = nullptr;  ///< kept between solves
};

SparseSolver::SparseSolver(SymmetricPattern pattern, Factorisation by)
    : implementation_(std::make_unique<Implementation>(std::move(pattern), by)) {}
SparseSolver::~SparseSolver() = default;
SparseSolver::SparseSolver(SparseSolver&&) noexcept = default;
SparseSolver& SparseSolver::operator=(SparseSolver&&) noexcept = default;

const SymmetricPattern& SparseSolver::pattern() const {
  return implementation_->pattern;
}
std::span<double> SparseSolver::values() {
  return implementation_->values;
}

bool SparseSolver::factorise() {
  auto& self = *implementation_;
  self.common.quick_return_if_not_posdef = 1;
  if (self.multifrontal)
    return self.multifrontal->factorise(self.values,
                                        {static_cast<double*>(self.factor->x), self.factor->xsize});
  cholmod_factorize(&self.matrix, self.factor, &self.common);
  if (self.common.status == CHOLMOD_NOT_POSDEF) return false;
  if (self.common.status < CHOLMOD_OK)
    throw std::runtime_error(
        fmt::format("CHOLMOD failed to factorise (status {}: {})", self.common.status,
                    self.common.status == CHOLMOD_OUT_OF_MEMORY ? "out of memory" : "see cholmod.h"));
  return self.factor->minor == self.factor->n;
}

void SparseSolver::solve(std::span<double> right_hand_side) {
  auto& self = *implementation_;
  cholmod_dense b{};
  b.nrow = b.d = b.nzmax = right_hand_side.size();
  b.ncol = 1;
  b.x = right_hand_side.data();
  b.xtype = CHOLMOD_REAL;
  b.dtype = CHOLMOD_DOUBLE;
  cholmod_solve2(CHOLMOD_A, self.factor, &b, nullptr, &self.solution, nullptr, &self.work_y, &self.work_e,
                 &self.common);
  if (!self.solution) throw std::runtime_error("CHOLMOD failed to solve");
  const double* x = static_cast<const double*>(self.solution->x);
  std::copy(x, x + right_hand_side.size(), right_hand_side.begin());
}

std::string blas_name() {
  return fmt::format("{} ({} kernels)", openblas_get_config(), openblas_get_corename());
}

}  // namespace heddle
