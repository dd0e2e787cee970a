#pragma once

#include <Eigen/Core>
#include <cmath>
#include <cstdint>
#include <numbers>
#include <random>
#include <utility>

namespace heddle::discover {

/// Draws that are the same with every standard library: only the engine is taken from it.
class Random {
 public:
  explicit Random(std::uint64_t seed) : engine_(seed) {}

  /// Even in (0, 1).
  double uniform() { return (static_cast<double>(engine_() >> 11) + 0.5) * 0x1p-53; }
  /// 0 .. count - 1.
  std::size_t below(std::size_t count) {
    return static_cast<std::size_t>(uniform() * static_cast<double>(count));
  }
  double normal() {
    return std::sqrt(-2.0 * std::log(uniform())) * std::cos(2.0 * std::numbers::pi * uniform());
  }
  Eigen::VectorXd normals(Eigen::Index count) {
    Eigen::VectorXd draws(count);
    for (double& draw : draws) draw = normal();
    return draws;
  }
  template <class List>
  void shuffle(List& list) {
    for (std::size_t k = list.size(); k > 1; --k) std::swap(list[k - 1], list[below(k)]);
  }

 private:
  std::mt19937_64 engine_;
};

}  // namespace heddle::discover
