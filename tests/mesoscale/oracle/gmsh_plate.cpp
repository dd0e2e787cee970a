#include "gmsh_plate.h"

#include <gmsh.h>

#include <Eigen/LU>
#include <Eigen/SparseCore>
#include <algorithm>
#include <cmath>
#include <map>
#include <numeric>
#include <set>
#include <stdexcept>
#include <string>

#include "core/sparse_solver.h"

#ifdef __SANITIZE_ADDRESS__
/// gmsh keeps tables until the process ends; our own leaks still fail a run under the sanitizer.
extern "C" const char* __lsan_default_suppressions();
extern "C" const char* __lsan_default_suppressions() {
  return "leak:libgmsh\nleak:libTK\n";
}
#endif

namespace heddle::test {

namespace {

using mesoscale::UnitCell;
using mesoscale::solid::Matrix6;
using Place = std::array<double, 3>;
using Triangle = std::array<int, 3>;

// Points of one unwrapped repeat, numbered by where they stand.
class Numbering {
 public:
  int of(const Place& place) {
    const auto bin = [](double x) { return std::llround(x / 1e-10 + 0.123); };
    const auto [at, fresh] =
        number_.try_emplace({bin(place[0]), bin(place[1]), bin(place[2])}, static_cast<int>(number_.size()));
    if (fresh) places_.push_back(place);
    return at->second;
  }
  const std::vector<Place>& places() const { return places_; }

 private:
  std::map<std::array<long long, 3>, int> number_;
  std::vector<Place> places_;
};

// The faces of a TetCell between bodies that hang together, and outwards.
struct Bodies {
  Numbering points;
  std::vector<int> phase;                                       // of each body
  std::map<std::array<int, 2>, std::vector<Triangle>> between;  // of bodies; -1: outside
};

Bodies bodies_of(const TetCell& cell) {
  Bodies bodies;
  struct Owner {
    std::size_t tet;
    Triangle corners;
  };
  std::map<Triangle, std::vector<Owner>> faces;
  for (std::size_t t = 0; t < cell.tetrahedra.size(); ++t) {
    std::array<int, 4> corner{};
    for (std::size_t n = 0; n < 4; ++n) corner[n] = bodies.points.of(cell.tetrahedra[t].place[n]);
    for (std::size_t left_out = 0; left_out < 4; ++left_out) {
      Triangle face{};
      for (std::size_t n = 0, k = 0; n < 4; ++n)
        if (n != left_out) face[k++] = corner[n];
      Triangle key = face;
      std::sort(key.begin(), key.end());
      faces[key].push_back({t, face});
    }
  }
  std::vector<std::size_t> parent(cell.tetrahedra.size());
  std::iota(parent.begin(), parent.end(), std::size_t{0});
  const auto root = [&](std::size_t t) {
    while (parent[t] != t) t = parent[t] = parent[parent[t]];
    return t;
  };
  for (const auto& [key, owners] : faces)
    if (owners.size() == 2 && cell.tetrahedra[owners[0].tet].phase == cell.tetrahedra[owners[1].tet].phase)
      parent[root(owners[0].tet)] = root(owners[1].tet);
  std::map<std::size_t, int> body;
  for (std::size_t t = 0; t < cell.tetrahedra.size(); ++t)
    if (body.try_emplace(root(t), static_cast<int>(body.size())).second)
      bodies.phase.push_back(cell.tetrahedra[t].phase);
  for (const auto& [key, owners] : faces) {
    const int a = body.at(root(owners[0].tet)), b = owners.size() == 2 ? body.at(root(owners[1].tet)) : -1;
    if (a != b) bodies.between[{std::min(a, b), std::max(a, b)}].push_back(owners[0].corners);
  }
  return bodies;
}

struct Session {
  Session() {
    gmsh::initialize(0, nullptr, /*readConfigFiles=*/false);
    for (const auto& [name, value] :
         {std::pair{"General.Terminal", 0.0},
          {"General.NumThreads", 1.0},
          {"Mesh.RandomSeed", 1.0},
          {"Mesh.Algorithm3D", 1.0},  // Delaunay; HXT of gmsh 4.8 breaks off at sheared cells
          {"Mesh.Optimize", 1.0},
          {"Mesh.MeshSizeExtendFromBoundary", 1.0}})
      gmsh::option::setNumber(name, value);
    gmsh::logger::start();
  }
  ~Session() { gmsh::finalize(); }
  Session(const Session&) = delete;
  Session& operator=(const Session&) = delete;
};

// The bodies' faces as entities of gmsh, and a volume between the faces of each body: body n is volume n + 1.
void hand_over(const Bodies& bodies) {
  std::vector<std::vector<int>> surfaces(bodies.phase.size());
  std::set<int> placed;
  int surface = 0;
  std::size_t element = 0;
  for (const auto& [pair, triangles] : bodies.between) {
    gmsh::model::addDiscreteEntity(2, ++surface);
    std::vector<std::size_t> tags, fresh, corners;
    std::vector<double> places;
    for (const Triangle& triangle : triangles) {
      tags.push_back(++element);
      for (const int n : triangle) {
        corners.push_back(static_cast<std::size_t>(n) + 1);
        if (!placed.insert(n).second) continue;
        fresh.push_back(static_cast<std::size_t>(n) + 1);
        // In millimetres: gmsh's tolerances are of that size.
        for (const double x : bodies.points.places()[static_cast<std::size_t>(n)]) places.push_back(1e3 * x);
      }
    }
    gmsh::model::mesh::addNodes(2, surface, fresh, places);
    gmsh::model::mesh::addElementsByType(surface, 2, tags, corners);
    for (const int body : pair)
      if (body >= 0) surfaces[static_cast<std::size_t>(body)].push_back(surface);
  }
  for (std::size_t body = 0; body < surfaces.size(); ++body) {
    const int tag = static_cast<int>(body) + 1;
    gmsh::model::geo::addSurfaceLoop(surfaces[body], tag);
    gmsh::model::geo::addVolume({tag}, tag);
  }
  gmsh::model::geo::synchronize();
}

// Volume [m^3], and 12 (3 V)^(2/3) over the sum of the squared edges: 1 for a regular tetrahedron.
std::array<double, 2> size_of(const GmshCell::Tetrahedron& tet) {
  Eigen::Matrix<double, 3, 4> corner;
  for (Eigen::Index n = 0; n < 4; ++n)
    corner.col(n) = Eigen::Map<const Eigen::Vector3d>(tet.place[static_cast<std::size_t>(n)].data());
  Eigen::Matrix3d sides;
  sides << corner.col(1) - corner.col(0), corner.col(2) - corner.col(0), corner.col(3) - corner.col(0);
  const double volume = std::abs(sides.determinant()) / 6.0;
  double edges = 0.0;
  for (Eigen::Index a = 0; a < 4; ++a)
    for (Eigen::Index b = a + 1; b < 4; ++b) edges += (corner.col(a) - corner.col(b)).squaredNorm();
  return {volume, 12.0 * std::pow(3.0 * volume, 2.0 / 3.0) / edges};
}

}  // namespace

GmshCell gmsh_cell(const UnitCell& cell, const TetCell& faces) try {
  const Bodies bodies = bodies_of(faces);
  const Session session;
  hand_over(bodies);
  gmsh::model::mesh::generate(3);

  GmshCell result;
  result.area = faces.area;
  result.regions = static_cast<int>(bodies.phase.size());
  std::vector<std::size_t> node_tags;
  std::vector<double> coordinates, parameters;
  gmsh::model::mesh::getNodes(node_tags, coordinates, parameters);
  std::map<std::size_t, Place> place;
  for (std::size_t n = 0; n < node_tags.size(); ++n)
    place[node_tags[n]] = {1e-3 * coordinates[3 * n], 1e-3 * coordinates[3 * n + 1],
                           1e-3 * coordinates[3 * n + 2]};

  // Nodes of a repeat by their place within it.
  Eigen::Matrix2d lattice;
  const auto [width, depth] = cell.size();
  const auto along = cell.place(width, 0.0), across = cell.place(0.0, depth);
  lattice << along[0], across[0], along[1], across[1];
  const Eigen::Matrix2d to_lattice = lattice.inverse();
  std::map<std::array<long long, 3>, int> number;
  const auto node_at = [&](const Place& p) {
    const Eigen::Vector2d s = to_lattice * Eigen::Vector2d(p[0], p[1]);
    constexpr long long bins = 10'000'000;
    const auto bin = [](double x) { return std::llround((x - std::floor(x)) * bins + 0.123) % bins; };
    return number
        .try_emplace({bin(s[0]), bin(s[1]), std::llround(p[2] / 1e-10 + 0.123)},
                     static_cast<int>(number.size()))
        .first->second;
  };
  result.worst = 1.0;
  for (std::size_t body = 0; body < bodies.phase.size(); ++body) {
    std::vector<std::size_t> tags, corners;
    gmsh::model::mesh::getElementsByType(4, tags, corners, static_cast<int>(body) + 1);
    if (tags.empty()) throw std::runtime_error("gmsh left a body empty");
    for (std::size_t t = 0; t < tags.size(); ++t) {
      GmshCell::Tetrahedron tet{};
      tet.phase = bodies.phase[body];
      Place middle{};
      for (std::size_t n = 0; n < 4; ++n) {
        tet.place[n] = place.at(corners[4 * t + n]);
        tet.node[n] = node_at(tet.place[n]);
        for (std::size_t axis = 0; axis < 3; ++axis) middle[axis] += 0.25 * tet.place[n][axis];
      }
      for (std::size_t a = 0, edge = 4; a < 4; ++a)
        for (std::size_t b = a + 1; b < 4; ++b, ++edge)
          tet.node[edge] =
              node_at({0.5 * (tet.place[a][0] + tet.place[b][0]), 0.5 * (tet.place[a][1] + tet.place[b][1]),
                       0.5 * (tet.place[a][2] + tet.place[b][2])});
      tet.fibre = fibre_direction(cell, tet.phase, middle);
      const auto [volume, quality] = size_of(tet);
      result.volume[static_cast<std::size_t>(tet.phase)] += volume;
      if (!(quality > 1e-6)) throw std::runtime_error("gmsh made a tetrahedron without volume");
      result.worst = std::min(result.worst, quality);
      result.tetrahedra.push_back(tet);
    }
  }
  result.nodes = static_cast<int>(number.size());
  return result;
} catch (const std::string& words) {
  throw std::runtime_error("gmsh: " + words);
}

namespace {

using Strain = Eigen::Matrix<double, 6, 30>;

// Strains of a quadratic tetrahedron with straight edges at barycentric coordinates L.
Strain strain_at(const Eigen::Matrix<double, 3, 4>& slope, const Eigen::Vector4d& l) {
  Strain strain = Strain::Zero();
  const auto put = [&](Eigen::Index node, const Eigen::Vector3d& g) {
    strain.block<6, 3>(0, 3 * node) << g[0], 0, 0, 0, g[1], 0, 0, 0, g[2], 0, g[2], g[1], g[2], 0, g[0], g[1],
        g[0], 0;
  };
  for (Eigen::Index n = 0; n < 4; ++n) put(n, (4.0 * l[n] - 1.0) * slope.col(n));
  for (Eigen::Index a = 0, edge = 4; a < 4; ++a)
    for (Eigen::Index b = a + 1; b < 4; ++b, ++edge)
      put(edge, 4.0 * (l[a] * slope.col(b) + l[b] * slope.col(a)));
  return strain;
}

struct PlateElement {
  Eigen::Matrix<double, 30, 30> stiff = Eigen::Matrix<double, 30, 30>::Zero();
  Eigen::Matrix<double, 30, 6> push = Eigen::Matrix<double, 30, 6>::Zero();
  Matrix6 energy = Matrix6::Zero();
};

PlateElement element_of(const GmshCell::Tetrahedron& tet, const Matrix6& c) {
  Eigen::Matrix4d corners;
  for (Eigen::Index n = 0; n < 4; ++n) {
    const auto& p = tet.place[static_cast<std::size_t>(n)];
    corners.row(n) << 1.0, p[0], p[1], p[2];
  }
  const double volume = std::abs(corners.determinant()) / 6.0;
  const Eigen::Matrix<double, 3, 4> slope = corners.inverse().bottomRows<3>();
  PlateElement e;
  // Exact for squares: strains are linear.
  constexpr double near = 0.5854101966249685, far = 0.1381966011250105;
  for (Eigen::Index point = 0; point < 4; ++point) {
    Eigen::Vector4d l = Eigen::Vector4d::Constant(far);
    l[point] = near;
    const double z = l.dot(corners.col(3)), weight = 0.25 * volume;
    const Strain b = strain_at(slope, l);
    Eigen::Matrix<double, 6, 6> macro = Eigen::Matrix<double, 6, 6>::Zero();  // 11, 22, 12, and times z
    for (const auto& [row, column] : {std::pair{0, 0}, {1, 1}, {5, 2}}) {
      macro(row, column) = 1.0;
      macro(row, column + 3) = z;
    }
    e.stiff += weight * b.transpose() * c * b;
    e.push += weight * b.transpose() * c * macro;
    e.energy += weight * macro.transpose() * c * macro;
  }
  return e;
}

}  // namespace

Matrix6 plate_of(const GmshCell& cell, const std::array<Matrix6, 3>& phases) {
  const int unknowns = 3 * cell.nodes - 3;  // the first node is held
  std::vector<Eigen::Triplet<double>> entries;
  Eigen::MatrixXd force = Eigen::MatrixXd::Zero(unknowns, 6);
  Matrix6 energy = Matrix6::Zero();
  for (const GmshCell::Tetrahedron& tet : cell.tetrahedra) {
    const Matrix6& still = phases[static_cast<std::size_t>(tet.phase)];
    const Matrix6 c = tet.phase == 0
                          ? still
                          : mesoscale::solid::rotated(
                                still, mesoscale::solid::turn_to({tet.fibre[0], tet.fibre[1], tet.fibre[2]}));
    const PlateElement e = element_of(tet, c);
    energy += e.energy;
    const auto unknown = [&](int a) { return 3 * tet.node[static_cast<std::size_t>(a / 3)] + a % 3 - 3; };
    for (int a = 0; a < 30; ++a) {
      if (unknown(a) < 0) continue;
      force.row(unknown(a)) -= e.push.row(a);
      for (int b = 0; b < 30; ++b)
        if (unknown(b) >= 0 && unknown(b) <= unknown(a))
          entries.emplace_back(unknown(a), unknown(b), e.stiff(a, b));
    }
  }
  Eigen::SparseMatrix<double> lower(unknowns, unknowns);
  lower.setFromTriplets(entries.begin(), entries.end());
  SymmetricPattern pattern;
  pattern.size = unknowns;
  pattern.column_start.assign(lower.outerIndexPtr(), lower.outerIndexPtr() + unknowns + 1);
  pattern.row.assign(lower.innerIndexPtr(), lower.innerIndexPtr() + lower.nonZeros());
  SparseSolver solver(std::move(pattern));
  std::copy_n(lower.valuePtr(), lower.nonZeros(), solver.values().begin());
  if (!solver.factorise()) throw std::runtime_error("tetrahedra: the stiffness is not positive definite");
  Eigen::MatrixXd u = force;
  for (Eigen::Index load = 0; load < 6; ++load)
    solver.solve({u.col(load).data(), static_cast<std::size_t>(unknowns)});
  return (energy - force.transpose() * u) / cell.area;
}

}  // namespace heddle::test
