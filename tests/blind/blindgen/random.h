#pragma once

#include <cstdint>
#include <string_view>
#include <utility>
#include <vector>

namespace blindgen {

/// Random numbers by counter: the n-th number of a stream depends on its key and n alone, so a stream that
/// draws more takes nothing from another. Own distributions: those of the standard library differ between
/// its makers.
class Stream {
 public:
  /// @param name  what the numbers are for; streams of different names share nothing
  Stream(std::uint64_t seed, std::uint64_t number, std::string_view name);

  std::uint64_t bits();
  double uniform();                             ///< in (0, 1)
  double uniform(double low, double high);      ///< in (low, high)
  double log_uniform(double low, double high);  ///< in (low, high), both > 0
  double normal();                              ///< mean 0, deviation 1
  int index(int count);                         ///< 0..count - 1, count > 0
  double sign();                                ///< -1 or 1

  template <class T>
  void shuffle(std::vector<T>& items) {
    for (int last = static_cast<int>(items.size()) - 1; last > 0; --last) {
      std::swap(items[static_cast<std::size_t>(last)], items[static_cast<std::size_t>(index(last + 1))]);
    }
  }

 private:
  std::uint64_t key_;
  std::uint64_t counter_ = 0;
};

}  // namespace blindgen
