#pragma once

#include <cstdint>
#include <memory>
#include <span>
#include <vector>

namespace heddle {

struct SymmetricPattern;

/// Shape of a Cholesky factor by supernodes: neighbouring columns with the same rows below them, kept as one
/// dense panel (column-major, rows x columns). A symbolic analysis gives it. Columns are numbered so that
/// what is eliminated first comes first.
struct Supernodes {
  std::vector<int> column;               ///< first column of each, then the size of the matrix; count + 1
  std::vector<int> row_start;            ///< where the rows of each begin in `row`; count + 1
  std::vector<int> row;                  ///< ascending, the supernode's own columns first
  std::vector<std::size_t> value_start;  ///< where the panel of each begins in the factor; count + 1

  int count() const { return static_cast<int>(column.size()) - 1; }
};

/// Multifrontal Cholesky factorisation: each supernode's panel is factorised as a dense matrix, and what it
/// takes from the columns after it is one dense symmetric update, added to the parent in the elimination
/// tree. The same arithmetic as a left-looking supernodal factorisation in fewer and larger pieces;
/// independent subtrees run side by side. Sums have one order on any number of threads. Source: Duff & Reid
/// 1983; Liu, SIAM Review 34 (1992) 82.
class MultifrontalFactor {
 public:
  /// @param pattern      of the matrix (lower triangle, its own order)
  /// @param permutation  permutation[k] = row of the matrix that is eliminated as k-th
  MultifrontalFactor(const SymmetricPattern& pattern, std::span<const int> permutation,
                     Supernodes supernodes);
  ~MultifrontalFactor();
  MultifrontalFactor(MultifrontalFactor&&) noexcept;
  MultifrontalFactor& operator=(MultifrontalFactor&&) noexcept;

  /// @param values  of the matrix, in the order of pattern.row
  /// @param factor  panels of L, in the order of the supernodes; above the diagonals zero
  /// @return false if the matrix is not positive definite
  bool factorise(std::span<const double> values, std::span<double> factor);

 private:
  struct Implementation;
  std::unique_ptr<Implementation> implementation_;
};

}  // namespace heddle
