#include "macroscale/mesh_topology.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <numeric>
#include <tuple>
#include <utility>

namespace heddle::macroscale {

namespace {

Triangle sorted_corners(Triangle t) {
  std::sort(t.begin(), t.end());
  return t;
}

/// Disjoint sets over 0..n-1; the representative is the smallest member.
class Sets {
 public:
  explicit Sets(std::size_t n) : parent_(n) { std::iota(parent_.begin(), parent_.end(), 0); }
  int find(int i) {
    while (parent_[i] != i) i = parent_[i] = parent_[parent_[i]];
    return i;
  }
  void join(int a, int b) {
    a = find(a);
    b = find(b);
    parent_[std::max(a, b)] = std::min(a, b);
  }

 private:
  std::vector<int> parent_;
};

/// Six times the signed volume between a triangle and `origin`; sums to that of a closed piece [m^3].
double six_volumes(const TriangleMesh& mesh, const Triangle& t, const Place& origin) {
  std::array<Place, 3> p{};
  for (int k = 0; k < 3; ++k) {
    for (int i = 0; i < 3; ++i) p[k][i] = mesh.vertices[t[k]][i] - origin[i];
  }
  return p[0][0] * (p[1][1] * p[2][2] - p[1][2] * p[2][1]) +
         p[0][1] * (p[1][2] * p[2][0] - p[1][0] * p[2][2]) +
         p[0][2] * (p[1][0] * p[2][1] - p[1][1] * p[2][0]);
}

}  // namespace

bool usable_numbers(const TriangleMesh& mesh) {
  const int n = static_cast<int>(mesh.vertices.size());
  const auto there = [n](const Triangle& t) {
    return std::ranges::all_of(t, [n](int vertex) { return 0 <= vertex && vertex < n; });
  };
  const auto finite = [](const Place& p) {
    return std::ranges::all_of(p, [](double x) { return std::isfinite(x); });
  };
  return !mesh.triangles.empty() && std::ranges::all_of(mesh.triangles, there) &&
         std::ranges::all_of(mesh.vertices, finite);
}

std::vector<EdgeUse> edge_uses(const std::vector<Triangle>& triangles) {
  std::vector<EdgeUse> uses;
  uses.reserve(3 * triangles.size());
  for (std::size_t t = 0; t < triangles.size(); ++t) {
    for (int k = 0; k < 3; ++k) {
      const int a = triangles[t][k], b = triangles[t][(k + 1) % 3];
      uses.push_back({std::min(a, b), std::max(a, b), static_cast<int>(t), a < b});
    }
  }
  std::sort(uses.begin(), uses.end(), [](const EdgeUse& a, const EdgeUse& b) {
    return std::tie(a.low, a.high, a.triangle) < std::tie(b.low, b.high, b.triangle);
  });
  return uses;
}

Place centroid(const TriangleMesh& mesh, const Triangle& t) {
  Place c{};
  for (int vertex : t) {
    for (int i = 0; i < 3; ++i) c[i] += mesh.vertices[vertex][i] / 3.0;
  }
  return c;
}

std::string in_mm(const Place& p) {
  // + 0.0 turns a negative zero into zero.
  return fmt::format("({:.6g}, {:.6g}, {:.6g}) mm", 1e3 * p[0] + 0.0, 1e3 * p[1] + 0.0, 1e3 * p[2] + 0.0);
}

std::string counted(std::size_t n, const char* one, const char* many) {
  return fmt::format("{} {}", n, n == 1 ? one : many);
}

std::vector<int> repetitions(const std::vector<Triangle>& triangles) {
  std::vector<std::pair<Triangle, int>> keys;
  keys.reserve(triangles.size());
  for (std::size_t t = 0; t < triangles.size(); ++t)
    keys.emplace_back(sorted_corners(triangles[t]), static_cast<int>(t));
  std::sort(keys.begin(), keys.end());
  std::vector<int> again;
  for (std::size_t i = 1; i < keys.size(); ++i) {
    if (keys[i].first == keys[i - 1].first) again.push_back(keys[i].second);
  }
  std::sort(again.begin(), again.end());
  return again;
}

Tally pinched_vertices(const TriangleMesh& mesh, const std::vector<EdgeUse>& uses) {
  const std::size_t n = mesh.triangles.size();
  Sets corners(3 * n);
  const auto corner = [&](int triangle, int vertex) {
    const Triangle& t = mesh.triangles[triangle];
    return 3 * triangle + (t[0] == vertex ? 0 : t[1] == vertex ? 1 : 2);
  };
  for_each_edge(uses, [&](std::size_t first, std::size_t last) {
    for (std::size_t i = first + 1; i < last; ++i) {
      for (int vertex : {uses[first].low, uses[first].high})
        corners.join(corner(uses[first].triangle, vertex), corner(uses[i].triangle, vertex));
    }
  });
  std::vector<int> fan(mesh.vertices.size(), -1);
  std::vector<char> seen(mesh.vertices.size(), 0);
  Tally tally;
  for (std::size_t t = 0; t < n; ++t) {
    for (int k = 0; k < 3; ++k) {
      const int vertex = mesh.triangles[t][k];
      const int root = corners.find(static_cast<int>(3 * t) + k);
      if (fan[vertex] < 0) fan[vertex] = root;
      if (fan[vertex] == root || seen[vertex]) continue;
      seen[vertex] = 1;
      tally.add(mesh.vertices[vertex]);
    }
  }
  return tally;
}

std::vector<int> pieces(const TriangleMesh& mesh, const std::vector<EdgeUse>& uses) {
  Sets sets(mesh.triangles.size());
  for_each_edge(uses, [&](std::size_t first, std::size_t last) {
    for (std::size_t i = first + 1; i < last; ++i) sets.join(uses[first].triangle, uses[i].triangle);
  });
  std::vector<int> label(mesh.triangles.size());
  for (std::size_t t = 0; t < label.size(); ++t) label[t] = sets.find(static_cast<int>(t));
  return label;
}

std::vector<double> volumes(const TriangleMesh& mesh, const std::vector<int>& label) {
  std::vector<double> sum(mesh.triangles.size(), 0.0);
  for (std::size_t t = 0; t < label.size(); ++t) {
    const Place& origin = mesh.vertices[mesh.triangles[label[t]][0]];
    sum[label[t]] += six_volumes(mesh, mesh.triangles[t], origin);
  }
  return sum;
}

}  // namespace heddle::macroscale
