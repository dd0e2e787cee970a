#pragma once

#include <array>
#include <span>
#include <vector>

#include "macroscale/thermal/column.h"

namespace heddle::macroscale::thermal {

/// The columns below all nodes of a blank. Numbers of one node stand together.
struct Field {
  std::size_t cells = 0;                       ///< of a column
  std::vector<double> temperature;             ///< of cells [K]
  std::vector<double> progress;                ///< P of crystallisation in cells [-]
  std::vector<std::array<double, 2>> face;     ///< of the faces, bottom and top [K]
  std::vector<std::array<double, 3>> heat_in;  ///< since the start: bottom, top, friction [J/m^2 unsheared]

  std::size_t nodes() const { return face.size(); }
  bool empty() const { return face.empty(); }
  std::span<const double> temperature_of(std::size_t node) const {
    return {temperature.data() + node * cells, cells};
  }
  std::span<const double> progress_of(std::size_t node) const {
    return {progress.data() + node * cells, cells};
  }
};

/// A field of one node that was at `temperature` and then stood in air for the transfer time. The heat it
/// lost on the way is not counted in heat_in.
Field column_after_transfer(const ThermalSpec& spec, const Column& column, double temperature);
/// A field of one node, for as many.
Field repeated(const Field& one, std::size_t nodes);

/// What one node's column meets over a step.
struct NodeFaces {
  std::array<Face, 2> faces;  ///< bottom, top
  double area_ratio = 1.0;    ///< area of the fabric over that of the unsheared [-]
};

/// One step of all columns, in parallel; the same bits on one thread or many.
/// @param at  one entry a node
/// @throws NumericalError  naming the node
void advance(const Column& column, std::span<const NodeFaces> at, double time_step, Field& field);

}  // namespace heddle::macroscale::thermal
