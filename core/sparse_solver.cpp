#include "core/sparse_solver.h"

#include <algorithm>
#include <cstring>
#include <stdexcept>

#include <cholmod.h>
#include <fmt/format.h>

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

struct SparseSolver::Implementation {
  explicit Implementation(SymmetricPattern p) : pattern(std::move(p)), values(pattern.row.size(), 0.0) {
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
    // Wider relaxed supernodes: 20 to 30 % faster factorisation for the 13-node stencil of a woven sheet.
    common.nrelax[0] = 16;
    common.nrelax[1] = 48;
    common.nrelax[2] = 128;
    common.zrelax[0] = 0.9;
    common.zrelax[1] = 0.4;
    common.zrelax[2] = 0.15;

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
  cholmod_dense *solution = nullptr, *work_y = nullptr, *work_e = nullptr;  ///< kept between solves
};

SparseSolver::SparseSolver(SymmetricPattern pattern)
    : implementation_(std::make_unique<Implementation>(std::move(pattern))) {}
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
