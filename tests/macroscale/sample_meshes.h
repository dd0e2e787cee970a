#pragma once

#include <array>
#include <cmath>
#include <cstdint>
#include <cstring>
#include <filesystem>
#include <fstream>
#include <numbers>
#include <string>
#include <vector>

#include <fmt/format.h>
#include <unistd.h>

#include "core/problem.h"
#include "core/triangle_mesh.h"

namespace heddle::test {

/// Cube with outward normals, low corner at `at`.
inline TriangleMesh cube(double edge, std::array<double, 3> at = {}) {
  TriangleMesh mesh;
  for (int i = 0; i < 8; ++i)
    mesh.vertices.push_back({at[0] + edge * (i & 1), at[1] + edge * (i >> 1 & 1), at[2] + edge * (i >> 2)});
  mesh.triangles = {{0, 2, 3}, {0, 3, 1}, {4, 5, 7}, {4, 7, 6}, {0, 1, 5}, {0, 5, 4},
                    {2, 6, 7}, {2, 7, 3}, {0, 4, 6}, {0, 6, 2}, {1, 3, 7}, {1, 7, 5}};
  return mesh;
}

inline TriangleMesh& append(TriangleMesh& mesh, const TriangleMesh& other) {
  const int shift = static_cast<int>(mesh.vertices.size());
  mesh.vertices.insert(mesh.vertices.end(), other.vertices.begin(), other.vertices.end());
  for (const auto& t : other.triangles) mesh.triangles.push_back({t[0] + shift, t[1] + shift, t[2] + shift});
  return mesh;
}

inline TriangleMesh inside_out(TriangleMesh mesh) {
  for (auto& t : mesh.triangles) std::swap(t[1], t[2]);
  return mesh;
}

/// Sphere by circles of latitude: 2 around (bands - 1) triangles, its lowest point at the origin.
inline TriangleMesh sphere(double radius, int bands, int around) {
  TriangleMesh mesh;
  mesh.vertices.push_back({0, 0, 0});
  for (int i = 1; i < bands; ++i) {
    for (int j = 0; j < around; ++j) {
      const double t = std::numbers::pi * i / bands, p = 2.0 * std::numbers::pi * j / around;
      mesh.vertices.push_back({radius * std::sin(t) * std::cos(p), radius * std::sin(t) * std::sin(p),
                               radius * (1.0 - std::cos(t))});
    }
  }
  mesh.vertices.push_back({0, 0, 2.0 * radius});
  const int last = static_cast<int>(mesh.vertices.size()) - 1;
  const auto at = [&](int i, int j) { return 1 + (i - 1) * around + j % around; };
  for (int j = 0; j < around; ++j) {
    mesh.triangles.push_back({0, at(1, j + 1), at(1, j)});
    for (int i = 1; i + 1 < bands; ++i) {
      mesh.triangles.push_back({at(i, j), at(i, j + 1), at(i + 1, j + 1)});
      mesh.triangles.push_back({at(i, j), at(i + 1, j + 1), at(i + 1, j)});
    }
    mesh.triangles.push_back({last, at(bands - 1, j), at(bands - 1, j + 1)});
  }
  return mesh;
}

inline double mesh_volume(const TriangleMesh& mesh) {
  double six = 0.0;
  for (const auto& t : mesh.triangles) {
    const auto &a = mesh.vertices[t[0]], &b = mesh.vertices[t[1]], &c = mesh.vertices[t[2]];
    six += a[0] * (b[1] * c[2] - b[2] * c[1]) + a[1] * (b[2] * c[0] - b[0] * c[2]) +
           a[2] * (b[0] * c[1] - b[1] * c[0]);
  }
  return six / 6.0;
}

/// A folder that goes away with the test.
class Folder {
 public:
  Folder() {
    static int count = 0;
    path_ = std::filesystem::temp_directory_path() / fmt::format("heddle-tools-{}-{}", ::getpid(), ++count);
    std::filesystem::create_directories(path_);
  }
  ~Folder() {
    std::error_code ignored;
    std::filesystem::remove_all(path_, ignored);
  }
  Folder(const Folder&) = delete;
  Folder& operator=(const Folder&) = delete;

  std::filesystem::path write(const std::string& name, const std::string& text) const {
    std::ofstream(path_ / name, std::ios::binary) << text;
    return path_ / name;
  }
  std::filesystem::path operator/(const std::string& name) const { return path_ / name; }

 private:
  std::filesystem::path path_;
};

/// Coordinates in millimetres; vertices as float, as binary STL holds them.
inline std::string binary_stl(const TriangleMesh& mesh) {
  std::string text(84 + 50 * mesh.triangles.size(), '\0');
  const auto n = static_cast<std::uint32_t>(mesh.triangles.size());
  std::memcpy(&text[80], &n, sizeof n);
  std::size_t at = 84;
  for (const auto& t : mesh.triangles) {
    for (int k = 0; k < 3; ++k) {
      for (int c = 0; c < 3; ++c) {
        const auto x = static_cast<float>(1e3 * mesh.vertices[t[k]][c]);
        std::memcpy(&text[at + 12 + 12 * k + 4 * c], &x, sizeof x);
      }
    }
    at += 50;
  }
  return text;
}

inline std::string text_stl(const TriangleMesh& mesh) {
  std::string text = "solid sample\n";
  for (const auto& t : mesh.triangles) {
    text += "facet normal 0 0 0\n outer loop\n";
    for (int vertex : t) {
      const auto& p = mesh.vertices[vertex];
      text += fmt::format("  vertex {:.9g} {:.9g} {:.9g}\n", 1e3 * p[0], 1e3 * p[1], 1e3 * p[2]);
    }
    text += " endloop\nendfacet\n";
  }
  return text + "endsolid sample\n";
}

inline std::string obj(const TriangleMesh& mesh) {
  std::string text = "# sample\n";
  for (const auto& p : mesh.vertices)
    text += fmt::format("v {:.9g} {:.9g} {:.9g}\n", 1e3 * p[0], 1e3 * p[1], 1e3 * p[2]);
  for (const auto& t : mesh.triangles) text += fmt::format("f {} {} {}\n", t[0] + 1, t[1] + 1, t[2] + 1);
  return text;
}

/// The problems with which a call is refused; none if it returns.
template <class Call>
Problems refusal(Call call) {
  try {
    call();
  } catch (const InputError& error) {
    return error.problems();
  }
  return {};
}

/// Whether one problem has this id and all these words in its rule and way out.
inline bool names(const Problems& problems, const std::string& id, const std::vector<std::string>& words) {
  for (const Problem& p : problems) {
    bool all = p.id == id;
    for (const std::string& word : words)
      all = all && (p.rule + " | " + p.way_out).find(word) != std::string::npos;
    if (all) return true;
  }
  return false;
}

}  // namespace heddle::test
