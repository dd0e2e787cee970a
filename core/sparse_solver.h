#pragma once

#include <memory>
#include <span>
#include <string>
#include <vector>

namespace heddle {

/// Pattern of a symmetric matrix: lower triangle by columns (compressed), row indices ascending in each
/// column, diagonal present.
struct SymmetricPattern {
  int size = 0;
  std::vector<int> column_start;  ///< size + 1
  std::vector<int> row;
};

/// Who does the numeric factorisation. CHOLMOD's own is there to be measured against.
enum class Factorisation { multifrontal, cholmod };

/// Direct solver for symmetric positive definite systems: ordered and analysed by CHOLMOD (METIS, relaxed
/// supernodes) once a pattern, any number of numeric factorisations (core/multifrontal.h). One BLAS thread
/// and sums in one order, so that results do not depend on threads or the machine's load.
class SparseSolver {
 public:
  explicit SparseSolver(SymmetricPattern pattern, Factorisation by = Factorisation::multifrontal);
  ~SparseSolver();
  SparseSolver(SparseSolver&&) noexcept;
  SparseSolver& operator=(SparseSolver&&) noexcept;

  const SymmetricPattern& pattern() const;
  /// Values in the order of pattern().row; fill, then factorise.
  std::span<double> values();
  /// False if the matrix is not positive definite (an answer, not an error).
  bool factorise();
  /// Solves in place with the last factor. Precondition: factorise() returned true.
  void solve(std::span<double> right_hand_side);

 private:
  struct Implementation;
  std::unique_ptr<Implementation> implementation_;
};

/// Name of the BLAS behind the solver, with its kernels.
std::string blas_name();

}  // namespace heddle
