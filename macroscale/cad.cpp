#include "macroscale/cad.h"

#include <fcntl.h>
#include <unistd.h>

#include <algorithm>
#include <cmath>
#include <cstdint>
#include <cstdio>
#include <fstream>
#include <iostream>
#include <iterator>
#include <map>
#include <mutex>
#include <unordered_map>
#include <utility>

#include <fmt/format.h>
#include <gmsh.h>

#ifdef __SANITIZE_ADDRESS__
/// OpenCASCADE and gmsh keep tables until the process ends; our own leaks still fail a run under the
/// sanitizer.
extern "C" const char* __lsan_default_suppressions();
extern "C" const char* __lsan_default_suppressions() {
  return "leak:libTK\nleak:libgmsh\n";
}
#endif

namespace heddle::macroscale {
namespace {

constexpr double mm = 1e-3;               ///< OpenCASCADE's unit, whatever the file's is
constexpr double growth_on_planes = 8.0;  ///< edges there may be this much longer

/// Turns standard output to /dev/null while it lives.
class Silence {
 public:
  Silence() {
    std::cout.flush();
    std::fflush(stdout);
    saved_ = ::dup(STDOUT_FILENO);
    const int nowhere = ::open("/dev/null", O_WRONLY | O_CLOEXEC);
    if (saved_ >= 0 && nowhere >= 0) ::dup2(nowhere, STDOUT_FILENO);
    if (nowhere >= 0) ::close(nowhere);
  }
  ~Silence() {
    std::cout.flush();
    std::fflush(stdout);
    if (saved_ < 0) return;
    ::dup2(saved_, STDOUT_FILENO);
    ::close(saved_);
  }
  Silence(const Silence&) = delete;
  Silence& operator=(const Silence&) = delete;

 private:
  int saved_ = -1;
};

/// gmsh has one global state: one session at a time.
class Session {
 public:
  explicit Session(std::vector<std::string> arguments = {}) : lock_(mutex()) {
    arguments.insert(arguments.begin(), "heddle");
    std::vector<char*> pointers;
    for (std::string& argument : arguments) pointers.push_back(argument.data());
    gmsh::initialize(static_cast<int>(pointers.size()), pointers.data(), /*readConfigFiles=*/false);
    for (const auto& [name, value] :
         {std::pair{"General.Terminal", 0.0},
          {"General.NumThreads", 1.0},
          {"General.AbortOnError", 0.0},
          {"Mesh.Algorithm", 5.0},  // Delaunay: 3.4 s for the punch, frontal 4.8 s
          {"Mesh.RandomSeed", 1.0},
          {"Mesh.MeshSizeFromPoints", 0.0}})
      gmsh::option::setNumber(name, value);
    gmsh::logger::start();
  }
  ~Session() { gmsh::finalize(); }
  Session(const Session&) = delete;
  Session& operator=(const Session&) = delete;

 private:
  static std::mutex& mutex() {
    static std::mutex instance;
    return instance;
  }
  std::lock_guard<std::mutex> lock_;  // before silence_: two sessions must not save each other's silence
  Silence silence_;
};

/// gmsh throws std::string; OpenCASCADE's reason stands in the log.
std::string reason(const std::string& thrown) {
  std::vector<std::string> log;
  gmsh::logger::get(log);
  for (const std::string& line : log) {
    if (line.starts_with("Error")) return line;
  }
  return thrown;
}

template <class Work>
auto with_gmsh(const std::filesystem::path& file, Work work) {
  try {
    return work();
  } catch (const std::string& thrown) {
    throw CadError(
        "file",
        fmt::format("must be readable by OpenCASCADE; {}: {}", file.filename().string(), reason(thrown)),
        "Open it in a CAD program and export it again.");
  }
}

void import(const std::filesystem::path& file) {
  gmsh::vectorpair entities;
  gmsh::model::occ::importShapes(file.string(), entities);
  gmsh::model::occ::synchronize();
}

bool is_plane(int surface) {
  std::string type;
  gmsh::model::getType(2, surface, type);
  return type == "Plane";
}

std::vector<int> tags(int dimension) {
  gmsh::vectorpair entities;
  gmsh::model::getEntities(entities, dimension);
  std::vector<int> result;
  for (const auto& entity : entities) result.push_back(entity.second);
  return result;
}

/// Smallest radius of curvature over a grid of points of a curved surface [mm].
double smallest_radius(int surface) {
  std::vector<double> low, high, parameters, largest, smallest, unused1, unused2;
  gmsh::model::getParametrizationBounds(2, surface, low, high);
  constexpr int n = 6;
  for (int i = 0; i < n; ++i) {
    for (int j = 0; j < n; ++j) {
      parameters.push_back(low[0] + (i + 0.5) / n * (high[0] - low[0]));
      parameters.push_back(low[1] + (j + 0.5) / n * (high[1] - low[1]));
    }
  }
  gmsh::model::getPrincipalCurvatures(surface, parameters, largest, smallest, unused1, unused2);
  double most = 0.0;
  for (std::size_t i = 0; i < largest.size(); ++i) {
    const double curvature = std::max(std::abs(largest[i]), std::abs(smallest[i]));
    if (std::isfinite(curvature)) most = std::max(most, curvature);
  }
  return 1.0 / most;
}

/// Edge length of each curved face [mm].
std::map<int, double> curved_faces(const SurfaceResolution& resolution) {
  std::map<int, double> sizes;
  for (int surface : tags(2))
    if (!is_plane(surface)) sizes[surface] = edge_length(resolution, mm * smallest_radius(surface)) / mm;
  return sizes;
}

/// Equilateral triangles of the sizes asked for; gmsh makes about a quarter more.
double estimated_triangles(const std::map<int, double>& curved, double size_on_planes) {
  double sum = 0.0;
  for (int surface : tags(2)) {
    double area = 0.0;
    gmsh::model::occ::getMass(2, surface, area);
    const auto found = curved.find(surface);
    const double size = found == curved.end() ? size_on_planes : found->second;
    sum += area / (0.25 * std::sqrt(3.0) * size * size);
  }
  return sum;
}

/// A curved face's size holds on the curves and points of its border too, the smallest of those that meet
/// there.
void set_sizes(const std::map<int, double>& curved, double size_on_planes) {
  std::map<std::pair<int, int>, double> sizes;
  const auto allow = [&](const std::pair<int, int>& entity, double size) {
    const auto [it, fresh] = sizes.emplace(entity, size);
    if (!fresh) it->second = std::min(it->second, size);
  };
  for (const auto& [surface, size] : curved) {
    allow({2, surface}, size);
    gmsh::vectorpair border, corners;
    gmsh::model::getBoundary({{2, surface}}, border, false, false, false);
    for (const auto& curve : border) allow(curve, size);
    gmsh::model::getBoundary({{2, surface}}, corners, false, false, true);
    for (const auto& corner : corners) allow(corner, size);
  }
  gmsh::option::setNumber("Mesh.MeshSizeMax", size_on_planes);
  gmsh::option::setNumber("Mesh.MeshSizeExtendFromBoundary", 1.0);
  gmsh::model::mesh::setSizeCallback([sizes, size_on_planes](int dimension, int tag, double, double, double) {
    const auto found = sizes.find({dimension, tag});
    return found == sizes.end() ? size_on_planes : found->second;
  });
}

/// Triangles of the model, vertices numbered in order of first use, in metres.
TriangleMesh collect_triangles() {
  std::vector<std::size_t> node_tags, element_tags, corners;
  std::vector<double> coordinates, unused;
  gmsh::model::mesh::getNodes(node_tags, coordinates, unused);
  std::unordered_map<std::size_t, std::size_t> position;
  for (std::size_t i = 0; i < node_tags.size(); ++i) position.emplace(node_tags[i], i);
  gmsh::model::mesh::getElementsByType(2, element_tags, corners);
  TriangleMesh mesh;
  std::unordered_map<std::size_t, int> number;
  for (std::size_t t = 0; t + 2 < corners.size(); t += 3) {
    std::array<int, 3> triangle{};
    for (int k = 0; k < 3; ++k) {
      const auto [it, fresh] = number.emplace(corners[t + k], static_cast<int>(mesh.vertices.size()));
      if (fresh) {
        const double* p = &coordinates[3 * position.at(corners[t + k])];
        mesh.vertices.push_back({mm * p[0], mm * p[1], mm * p[2]});
      }
      triangle[k] = it->second;
    }
    mesh.triangles.push_back(triangle);
  }
  return mesh;
}

/// Points on a curve, doubled until the middle of each chord is within `chord_error` [mm].
std::vector<std::array<double, 3>> points_on_curve(int curve, double chord_error) {
  std::vector<double> low, high;
  gmsh::model::getParametrizationBounds(1, curve, low, high);
  std::string type;
  gmsh::model::getType(1, curve, type);
  const auto sample = [&](int n) {
    std::vector<double> parameters, values;
    for (int i = 0; i <= n; ++i) parameters.push_back(low[0] + (high[0] - low[0]) * i / n);
    gmsh::model::getValue(1, curve, parameters, values);
    std::vector<std::array<double, 3>> points;
    for (int i = 0; i <= n; ++i) points.push_back({values[3 * i], values[3 * i + 1], values[3 * i + 2]});
    return points;
  };
  if (type == "Line") return sample(1);
  constexpr int most = 1 << 14;
  for (int n = 4;; n *= 2) {
    const auto fine = sample(2 * n);
    double worst = 0.0;
    for (int i = 1; i < 2 * n; i += 2) {
      double gap2 = 0.0;
      for (int c = 0; c < 3; ++c) gap2 += std::pow(fine[i][c] - 0.5 * (fine[i - 1][c] + fine[i + 1][c]), 2);
      worst = std::max(worst, std::sqrt(gap2));
    }
    if (worst <= chord_error) return sample(n);
    if (n >= most) {
      throw CadError(
          "file", fmt::format("must have border curves that {} chords follow to {:g} mm", most, chord_error),
          "Simplify the border, or ask for less with a larger chord error.");
    }
  }
}

std::string count_of(std::size_t n, const char* what) {
  return fmt::format("{} {}{}", n, what, n == 1 ? "" : "s");
}

}  // namespace

double edge_length(const SurfaceResolution& resolution, double radius) {
  return std::min(resolution.mesh_size, std::sqrt(2.0 * radius * resolution.chord_error));
}

TriangleMesh step_surface(const std::filesystem::path& file, const SurfaceResolution& resolution) {
  const Session session;
  return with_gmsh(file, [&] {
    import(file);
    if (tags(2).empty()) {
      throw CadError("file", "must hold a solid or a face; it holds none",
                     "Export the solid, not its sketch.");
    }
    double box[6];
    gmsh::model::getBoundingBox(-1, -1, box[0], box[1], box[2], box[3], box[4], box[5]);
    const double largest = std::max({box[3] - box[0], box[4] - box[1], box[5] - box[2]});
    const double size = resolution.mesh_size / mm;
    if (size > 0.5 * largest) {
      throw CadError("mesh_size",
                     fmt::format("must be at most half the tool's largest extent ({:.4g} mm)", largest),
                     fmt::format("{:.2g} mm would give a hundred edges along it.", 0.01 * largest));
    }
    const std::map<int, double> curved = curved_faces(resolution);
    const double estimate = estimated_triangles(curved, growth_on_planes * size);
    if (!(estimate <= static_cast<double>(resolution.most_triangles))) {
      throw CadError(
          "mesh_size",
          fmt::format(
              "must give at most {} triangles; about {:.2g} would be needed for {:.4g} x {:.4g} x {:.4g} mm",
              resolution.most_triangles, estimate, box[3] - box[0], box[4] - box[1], box[5] - box[2]),
          "Enlarge it or chord_error, or remove tiny fillets from the file: edges follow the smallest "
          "radius.");
    }
    set_sizes(curved, growth_on_planes * size);
    gmsh::model::mesh::generate(2);
    TriangleMesh mesh = collect_triangles();
    if (mesh.triangles.empty()) {
      throw CadError("file", "must have faces that can be meshed; no triangle came out",
                     "Heal the solid in a CAD program.");
    }
    return mesh;
  });
}

std::array<std::array<double, 3>, 2> step_box(const std::filesystem::path& file) {
  const Session session;
  return with_gmsh(file, [&] {
    import(file);
    std::array<double, 6> box{};
    gmsh::model::getBoundingBox(-1, -1, box[0], box[1], box[2], box[3], box[4], box[5]);
    for (double& x : box) x *= mm;
    return std::array<std::array<double, 3>, 2>{{{box[0], box[1], box[2]}, {box[3], box[4], box[5]}}};
  });
}

std::vector<Polyline> step_face_curves(const std::filesystem::path& file, double chord_error) {
  const Session session;
  return with_gmsh(file, [&] {
    import(file);
    const std::vector<int> surfaces = tags(2);
    if (surfaces.size() != 1) {
      throw CadError("file",
                     fmt::format("must hold one face; it holds {}", count_of(surfaces.size(), "face")),
                     "Export the flat face of the blank alone.");
    }
    gmsh::vectorpair border;
    gmsh::model::getBoundary({{2, surfaces.front()}}, border, false, false, false);
    std::vector<Polyline> curves;
    double low = INFINITY, high = -INFINITY;
    for (const auto& [dimension, curve] : border) {
      Polyline& line = curves.emplace_back();
      for (const auto& p : points_on_curve(curve, chord_error / mm)) {
        line.push_back({mm * p[0], mm * p[1]});
        low = std::min(low, p[2]);
        high = std::max(high, p[2]);
      }
    }
    if (!is_plane(surfaces.front()) || high - low > 1e-6) {
      throw CadError("file",
                     fmt::format("must hold a plane face parallel to z = 0; its border spans {:.4g} mm in z",
                                 high - low),
                     "Lay the blank flat into the xy plane.");
    }
    return curves;
  });
}

CadSummary summarise_step(const std::filesystem::path& file) {
  const Session session;
  return with_gmsh(file, [&] {
    import(file);
    CadSummary summary;
    summary.low.fill(INFINITY);
    summary.high.fill(-INFINITY);
    for (int solid : tags(3)) {
      double mass = 0.0, low[3], high[3];
      gmsh::model::occ::getMass(3, solid, mass);
      gmsh::model::getBoundingBox(3, solid, low[0], low[1], low[2], high[0], high[1], high[2]);
      summary.volume += mass * mm * mm * mm;
      ++summary.solids;
      for (int c = 0; c < 3; ++c) {
        summary.low[c] = std::min(summary.low[c], mm * low[c]);
        summary.high[c] = std::max(summary.high[c], mm * high[c]);
      }
    }
    return summary;
  });
}

void write_step(const std::filesystem::path& script, int tool, const std::filesystem::path& file) {
  {
    const Session session({"-setnumber", "tool", std::to_string(tool)});
    with_gmsh(script, [&] {
      gmsh::open(script.string());
      gmsh::model::occ::synchronize();
      if (tags(2).empty())
        throw CadError("file", "must make a solid or a face", "The script knows tools 1 to 3.");
      gmsh::write(file.string());
    });
  }
  std::ifstream input(file, std::ios::binary);
  std::string text{std::istreambuf_iterator<char>(input), {}};
  input.close();
  // FILE_NAME(name, time stamp, author, ...): only the time stamp says when.
  const std::size_t name = text.find("FILE_NAME("), comma = text.find(',', name),
                    next = text.find(',', comma + 1);
  if (next == std::string::npos)
    throw CadError("file", "must have a FILE_NAME in its header", "gmsh wrote another format.");
  text.replace(comma + 1, next - comma - 1, "'2000-01-01T00:00:00'");
  std::ofstream(file, std::ios::binary) << text;
}

}  // namespace heddle::macroscale
