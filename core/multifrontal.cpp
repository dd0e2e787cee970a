#include "core/multifrontal.h"

#include <algorithm>
#include <atomic>
#include <mutex>

#include <tbb/task_group.h>
#include <Eigen/Core>

#include "core/sparse_solver.h"

// LAPACK and BLAS as Fortran has them (OpenBLAS; its headers are not needed for this).
extern "C" {
void dpotrf_(const char* uplo, const int* n, double* a, const int* lda, int* info);
void dtrsm_(const char* side, const char* uplo, const char* trans, const char* diag, const int* m,
            const int* n, const double* alpha, const double* a, const int* lda, double* b, const int* ldb);
void dsyrk_(const char* uplo, const char* trans, const int* n, const int* k, const double* alpha,
            const double* a, const int* lda, const double* beta, double* c, const int* ldc);
}

namespace heddle {

namespace {

// A matrix entry's place: value number `source` goes to `target` of its supernode's panel.
struct Entry {
  int source, target;
};

// Neighbouring rows of an update that are neighbours in the parent's rows as well.
struct Run {
  int from, to, length;
};

}  // namespace

struct MultifrontalFactor::Implementation {
  Implementation(const SymmetricPattern& pattern, std::span<const int> permutation, Supernodes s)
      : nodes(std::move(s)) {
    find_tree();
    place_entries(pattern, permutation);
    find_runs();
    lay_out_updates();
  }

  int columns(int s) const { return nodes.column[s + 1] - nodes.column[s]; }
  int rows(int s) const { return nodes.row_start[s + 1] - nodes.row_start[s]; }
  int below(int s) const { return rows(s) - columns(s); }
  std::size_t update_size(int s) const { return static_cast<std::size_t>(below(s)) * below(s); }
  std::span<const int> rows_of(int s) const {
    return {nodes.row.data() + nodes.row_start[s], static_cast<std::size_t>(rows(s))};
  }

  // A supernode's parent holds the first row below it.
  void find_tree() {
    const int count = nodes.count();
    std::vector<int> owner(nodes.column.back());
    for (int s = 0; s < count; ++s)
      std::fill(owner.begin() + nodes.column[s], owner.begin() + nodes.column[s + 1], s);
    parent.assign(count, -1);
    children.assign(count, {});
    first.resize(count);
    work.assign(count, 0.0);
    for (int s = 0; s < count; ++s) {
      first[s] = children[s].empty() ? s : first[children[s].front()];
      for (int k = 0; k < columns(s); ++k) work[s] += static_cast<double>(rows(s) - k) * (rows(s) - k);
      if (below(s) == 0) {
        roots.push_back(s);
        continue;
      }
      parent[s] = owner[rows_of(s)[columns(s)]];
      children[parent[s]].push_back(s);
      work[parent[s]] += work[s];
    }
    for (const int root : roots) total_work += work[root];
    column_owner = std::move(owner);
  }

  void place_entries(const SymmetricPattern& pattern, std::span<const int> permutation) {
    std::vector<int> place(pattern.size);
    for (int k = 0; k < pattern.size; ++k) place[permutation[k]] = k;
    const auto for_each_entry = [&](const auto& visit) {
      for (int j = 0; j < pattern.size; ++j)
        for (int k = pattern.column_start[j]; k < pattern.column_start[j + 1]; ++k) {
          const auto [column, row] = std::minmax(place[j], place[pattern.row[k]]);
          visit(k, column_owner[column], column, row);
        }
    };
    entry_start.assign(nodes.count() + 1, 0);
    for_each_entry([&](int, int s, int, int) { ++entry_start[s + 1]; });
    for (int s = 0; s < nodes.count(); ++s) entry_start[s + 1] += entry_start[s];
    entries.resize(pattern.row.size());
    std::vector<int> next(entry_start.begin(), entry_start.end() - 1);
    for_each_entry([&](int k, int s, int column, int row) {
      const auto list = rows_of(s);
      const auto at = std::lower_bound(list.begin(), list.end(), row) - list.begin();
      entries[next[s]++] = {k, (column - nodes.column[s]) * rows(s) + static_cast<int>(at)};
    });
  }

  // Where the rows below a supernode stand among its parent's.
  void find_runs() {
    run_start.push_back(0);
    for (int s = 0; s < nodes.count(); ++s) {
      int at = 0;
      for (int i = 0; i < below(s); ++i) {
        const auto list = rows_of(parent[s]);
        const int row = rows_of(s)[columns(s) + i];
        at = static_cast<int>(std::lower_bound(list.begin() + at, list.end(), row) - list.begin());
        const bool goes_on = i > 0 && runs.back().to + runs.back().length == at && at != columns(parent[s]);
        if (goes_on)
          ++runs.back().length;
        else
          runs.push_back({i, at, 1});
      }
      run_start.push_back(static_cast<int>(runs.size()));
    }
  }

  // Subtrees with more work than this have their branches run side by side.
  bool branches(int s) const { return work[s] > total_work / 16.0; }

  // A subtree done by one thread has its updates in one room, a parent's before its children's: what is
  // needed is a path's and its siblings'. Updates of branching supernodes and of those below them live by
  // themselves, from their making until the parent has taken them; small ones are kept for the next
  // factorisation, since new memory from the system costs more than what is done with it.
  void lay_out_updates() {
    update_start.assign(nodes.count(), 0);
    update.assign(nodes.count(), nullptr);
    own.resize(nodes.count());
    std::size_t own_size = 0;
    for (int s = 0; s < nodes.count(); ++s) {
      if (!lives_by_itself(s)) continue;
      own_size += update_size(s);
      if (!branches(s)) room_size = std::max(room_size, lay_out_children(s, 0));
    }
    kept = own_size * sizeof(double) < kept_limit;
  }
  bool lives_by_itself(int s) const { return parent[s] < 0 || branches(parent[s]); }

  std::size_t lay_out_children(int s, std::size_t begin) {
    std::size_t next = begin, end = begin;
    for (const int child : children[s]) {
      update_start[child] = next;
      next += update_size(child);
      end = std::max({end, next, lay_out_children(child, next)});
    }
    return end;
  }

  // As many rooms as subtrees are under way.
  std::unique_ptr<double[]> take_room() {
    const std::lock_guard lock(rooms_in_use);
    if (rooms.empty()) return std::unique_ptr<double[]>(new double[room_size]);  // not touched before needed
    auto room = std::move(rooms.back());
    rooms.pop_back();
    return room;
  }
  void give_back(std::unique_ptr<double[]> room) {
    const std::lock_guard lock(rooms_in_use);
    rooms.push_back(std::move(room));
  }

  void run(int s) {
    if (!branches(s)) {  // a subtree is a range of supernodes, children before parents
      auto room = take_room();
      for (int k = first[s]; k < s; ++k) update[k] = room.get() + update_start[k];
      for (int k = first[s]; k <= s && !failed; ++k) eliminate(k);
      give_back(std::move(room));
      return;
    }
    tbb::task_group side_by_side;
    for (const int child : children[s]) side_by_side.run([this, child] { run(child); });
    side_by_side.wait();
    if (!failed) eliminate(s);
  }

  void eliminate(int s) {
    const int n = columns(s), m = below(s), all = rows(s);
    double* panel = factor + nodes.value_start[s];
    std::fill(panel, panel + static_cast<std::size_t>(n) * all, 0.0);
    for (int k = entry_start[s]; k < entry_start[s + 1]; ++k)
      panel[entries[k].target] = matrix[entries[k].source];
    for (const int child : children[s]) add_update(child, panel, all, 0, n);
    int info = 0;
    dpotrf_("L", &n, panel, &all, &info);
    if (info != 0) {
      failed = true;
      return;
    }
    if (m > 0) make_update(s, panel);
    if (kept) return;
    for (const int child : children[s]) own[child].reset();
  }

  void make_update(int s, double* panel) {
    const int n = columns(s), m = below(s), all = rows(s);
    const double one = 1.0, minus = -1.0, zero = 0.0;
    if (lives_by_itself(s)) {
      if (!own[s]) own[s].reset(new double[update_size(s)]);
      update[s] = own[s].get();
    }
    dtrsm_("R", "L", "T", "N", &m, &n, &one, panel, &all, panel + n, &all);
    dsyrk_("L", "N", &m, &n, &minus, panel + n, &all, &zero, update[s], &m);
    for (const int child : children[s]) add_update(child, update[s], m, n, all);
  }

  // Adds those columns of a child's update that its parent has between `begin` and `end` to a dense lower
  // triangle whose first row and column is the parent's row `begin`.
  void add_update(int child, double* target, int stride, int begin, int end) const {
    const int m = below(child);
    for (int r = run_start[child]; r < run_start[child + 1]; ++r) {
      const Run& run = runs[r];
      if (run.to < begin || run.to >= end) continue;  // no run crosses the parent's last own column
      for (int k = 0; k < run.length; ++k) {
        const double* source = update[child] + static_cast<std::size_t>(run.from + k) * m;
        double* column = target + static_cast<std::size_t>(run.to + k - begin) * stride;
        add(source + run.from + k, column + (run.to + k - begin), run.length - k);
        for (int below_run = r + 1; below_run < run_start[child + 1]; ++below_run)
          add(source + runs[below_run].from, column + (runs[below_run].to - begin), runs[below_run].length);
      }
    }
  }

  static void add(const double* from, double* to, int length) {
    Eigen::Map<Eigen::ArrayXd>(to, length) += Eigen::Map<const Eigen::ArrayXd>(from, length);
  }

  bool factorise(std::span<const double> values, std::span<double> panels) {
    matrix = values.data();
    factor = panels.data();
    failed = false;
    tbb::task_group side_by_side;
    for (const int root : roots) side_by_side.run([this, root] { run(root); });
    side_by_side.wait();
    return !failed;
  }

  Supernodes nodes;
  std::vector<int> parent, first;  ///< first: of the supernodes in a subtree
  std::vector<std::vector<int>> children;
  std::vector<int> roots, column_owner;
  std::vector<double> work;  ///< of a subtree
  double total_work = 0.0;
  std::vector<int> entry_start, run_start;
  std::vector<Entry> entries;
  std::vector<Run> runs;
  std::vector<std::size_t> update_start;
  std::vector<double*> update;                           ///< of each supernode, while it lives
  static constexpr std::size_t kept_limit = 256u << 20;  ///< of all own updates together [bytes]
  bool kept = false;                                     ///< own updates live on
  std::vector<std::unique_ptr<double[]>> own;            ///< of those that live by themselves
  std::size_t room_size = 0;
  std::vector<std::unique_ptr<double[]>> rooms;  ///< free
  std::mutex rooms_in_use;

  // Of the factorisation that is going on.
  const double* matrix = nullptr;
  double* factor = nullptr;
  std::atomic<bool> failed = false;
};

MultifrontalFactor::MultifrontalFactor(const SymmetricPattern& pattern, std::span<const int> permutation,
                                       Supernodes supernodes)
    : implementation_(std::make_unique<Implementation>(pattern, permutation, std::move(supernodes))) {}
MultifrontalFactor::~MultifrontalFactor() = default;
MultifrontalFactor::MultifrontalFactor(MultifrontalFactor&&) noexcept = default;
MultifrontalFactor& MultifrontalFactor::operator=(MultifrontalFactor&&) noexcept = default;

bool MultifrontalFactor::factorise(std::span<const double> values, std::span<double> factor) {
  return implementation_->factorise(values, factor);
}

}  // namespace heddle
