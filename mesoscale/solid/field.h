#pragma once

#include <sys/mman.h>

#include <cstddef>
#include <cstdlib>
#include <new>
#include <vector>

namespace heddle::mesoscale::solid {

/// Memory on borders of 2 MiB, which the kernel is asked to serve in pages of that size: the columns of a
/// field jump from plane to plane, and small pages cost a miss of the address cache each.
template <class T>
struct LargePages {
  using value_type = T;
  LargePages() = default;
  template <class Other>
  explicit LargePages(const LargePages<Other>&) {}

  static constexpr std::size_t page = std::size_t{1} << 21;

  T* allocate(std::size_t count) {
    const std::size_t bytes = (count * sizeof(T) + page - 1) / page * page;
    void* memory = std::aligned_alloc(page, bytes);
    if (!memory) throw std::bad_alloc();
    madvise(memory, bytes, MADV_HUGEPAGE);  // advice: where it is not taken, all is the same but slower
    return static_cast<T*>(memory);
  }
  void deallocate(T* memory, std::size_t) { std::free(memory); }
  friend bool operator==(LargePages, LargePages) { return true; }
};

/// Displacements or forces of all nodes and load cases: [plane][node of y][node of x][component][load case].
using Field = std::vector<double, LargePages<double>>;

}  // namespace heddle::mesoscale::solid
