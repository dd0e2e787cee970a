#include "pipeline/export/part_model.h"

#include <algorithm>
#include <cmath>
#include <numbers>

#include <fmt/format.h>
#include <Eigen/Core>
#include <Eigen/Geometry>

#include "core/problem.h"

namespace heddle::pipeline {

namespace {

using Eigen::Vector3d;

Vector3d vector_of(const std::array<double, 3>& x) {
  return {x[0], x[1], x[2]};
}
std::array<double, 3> array_of(const Vector3d& v) {
  return {v.x(), v.y(), v.z()};
}

// A face with values at its corners, at a place in it: value and both slopes, bilinear or linear.
struct Place {
  std::array<double, 4> weight, along, across;  // of the corners: shape functions and their slopes
  double share = 0.0;                           // of the parameter area
};

std::vector<Place> places_in(int corners) {
  std::vector<Place> places;
  if (corners == 3) {
    for (int k = 0; k < 3; ++k) {
      Place place{
          {1.0 / 6.0, 1.0 / 6.0, 1.0 / 6.0, 0.0}, {-1.0, 1.0, 0.0, 0.0}, {-1.0, 0.0, 1.0, 0.0}, 1.0 / 6.0};
      place.weight[static_cast<std::size_t>(k)] = 2.0 / 3.0;
      places.push_back(place);
    }
    return places;
  }
  const double away = 0.5 / std::sqrt(3.0);
  for (const double x : {0.5 - away, 0.5 + away})
    for (const double y : {0.5 - away, 0.5 + away})
      places.push_back({{(1 - x) * (1 - y), x * (1 - y), x * y, (1 - x) * y},
                        {-(1 - y), 1 - y, y, -y},
                        {-(1 - x), -x, x, 1 - x},
                        0.25});
  return places;
}

Vector3d sum_of(const std::array<double, 4>& weight, const std::vector<std::array<double, 3>>& values,
                const PartFace& face) {
  Vector3d sum = Vector3d::Zero();
  for (std::size_t k = 0; k < static_cast<std::size_t>(face.count); ++k)
    sum += weight[k] * vector_of(values[static_cast<std::size_t>(face.corners[k])]);
  return sum;
}

double area_of(const PartFace& face, const PartMesh& mesh) {
  double area = 0.0;
  for (const Place& p : places_in(face.count))
    area +=
        p.share * sum_of(p.along, mesh.position, face).cross(sum_of(p.across, mesh.position, face)).norm();
  return area;
}

// Of the body from -1/2 to 1/2 of the directors. The determinant is a quadratic in the height.
double volume_of(const PartFace& face, const PartMesh& mesh,
                 const std::vector<std::array<double, 3>>& director) {
  double volume = 0.0;
  const double away = 0.5 / std::sqrt(3.0);
  for (const Place& p : places_in(face.count))
    for (const double z : {-away, away}) {
      const Vector3d along = sum_of(p.along, mesh.position, face) + z * sum_of(p.along, director, face),
                     across = sum_of(p.across, mesh.position, face) + z * sum_of(p.across, director, face);
      volume += 0.5 * p.share * along.cross(across).dot(sum_of(p.weight, director, face));
    }
  return volume;
}

// Means over the faces about each node, by area.
std::vector<std::array<double, 3>> directors_of(const PartModel& model) {
  const std::size_t nodes = model.mesh.position.size();
  std::vector<Vector3d> normal(nodes, Vector3d::Zero());
  std::vector<double> thickness(nodes, 0.0), area(nodes, 0.0);
  for (std::size_t f = 0; f < model.mesh.faces.size(); ++f) {
    const PartFace& face = model.mesh.faces[f];
    for (std::size_t k = 0; k < static_cast<std::size_t>(face.count); ++k) {
      const auto node = static_cast<std::size_t>(face.corners[k]);
      normal[node] += model.area[f] * vector_of(model.cell_of(f).normal);
      thickness[node] += model.area[f] * model.cell_of(f).thickness;
      area[node] += model.area[f];
    }
  }
  std::vector<std::array<double, 3>> director;
  for (std::size_t n = 0; n < nodes; ++n)
    director.push_back(array_of(thickness[n] / area[n] * normal[n].normalized()));
  return director;
}

// The node for which a number is largest.
template <class Number>
int node_of_largest(const PartMesh& mesh, const Number& number) {
  int best = 0;
  double largest = -1e300;
  for (std::size_t n = 0; n < mesh.position.size(); ++n)
    if (const double value = number(vector_of(mesh.position[n])); value > largest)
      largest = value, best = static_cast<int>(n);
  return best;
}

// A node at the middle, held; one far from it, held across the line between them; one far from that line,
// held along the axis on which it would turn about it most.
std::array<PartSupport, 6> supports_of(const PartMesh& mesh) {
  Vector3d middle = Vector3d::Zero();
  for (const auto& x : mesh.position) middle += vector_of(x) / static_cast<double>(mesh.position.size());
  const int first = node_of_largest(mesh, [&](const Vector3d& x) { return -(x - middle).norm(); });
  const Vector3d origin = vector_of(mesh.position[static_cast<std::size_t>(first)]);
  const int second = node_of_largest(mesh, [&](const Vector3d& x) { return (x - origin).norm(); });
  const Vector3d line = vector_of(mesh.position[static_cast<std::size_t>(second)]) - origin;
  const auto turn_of = [&](const Vector3d& x) -> Vector3d { return line.cross(x - origin); };
  const int third = node_of_largest(mesh, [&](const Vector3d& x) { return turn_of(x).norm(); });
  int along = 0, turned = 0;
  line.cwiseAbs().maxCoeff(&along);
  turn_of(vector_of(mesh.position[static_cast<std::size_t>(third)])).cwiseAbs().maxCoeff(&turned);
  return {{{first, 0},
           {first, 1},
           {first, 2},
           {second, (along + 1) % 3},
           {second, (along + 2) % 3},
           {third, turned}}};
}

}  // namespace

PartModel part_model(std::string name, const macroscale::BlankState& blank,
                     const std::vector<mesoscale::solid::ShearedSolid>& table, double areal_density,
                     PartTemperature stress_free, PartTemperature room) {
  PartModel model;
  model.name = std::move(name);
  model.mesh = part_mesh(blank);
  model.cells = part_stiffness(blank, table);
  model.stress_free = std::move(stress_free);
  model.room = std::move(room);
  for (const PartFace& face : model.mesh.faces) {
    model.area.push_back(area_of(face, model.mesh));
    model.mass.push_back(areal_density * face.flat_area);
  }
  model.director = directors_of(model);
  for (std::size_t f = 0; f < model.mesh.faces.size(); ++f)
    model.thickness.push_back(volume_of(model.mesh.faces[f], model.mesh, model.director) / model.area[f]);
  model.supports = supports_of(model.mesh);
  return model;
}

std::vector<PartLayers> part_layers(const PartModel& model) {
  std::size_t face_at_fault = 0;
  for (const double share : {1.0 / 3.0, 0.2, 0.1}) {
    std::vector<PartLayers> all;
    for (std::size_t f = 0; f < model.mesh.faces.size(); ++f) {
      const CellStiffness& cell = model.cell_of(f);
      auto layers = layers_of(cell.plate, cell.expansion, model.thickness[f], share);
      if (!layers) {
        face_at_fault = f;
        break;
      }
      all.push_back(*layers);
    }
    if (all.size() == model.mesh.faces.size()) return all;
  }
  const CellStiffness& cell = model.cell_of(face_at_fault);
  throw NumericalError(
      fmt::format("cell {}, {} at {:.1f} deg of shear: no three layers have its A, B and D with a positive "
                  "stiffness each; the table of the solid part is not that of a plate as thick as {:.3f} mm",
                  cell.cell[0], cell.cell[1], 180.0 / std::numbers::pi * cell.shear_angle,
                  1e3 * model.thickness[face_at_fault]));
}

}  // namespace heddle::pipeline
