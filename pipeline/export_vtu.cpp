#include "pipeline/export_vtu.h"

#include <fmt/format.h>
#include <zlib.h>

#include <algorithm>
#include <bit>
#include <cmath>
#include <cstring>
#include <limits>
#include <numbers>

#include "core/units.h"
#include "pipeline/outputs.h"
#include "pipeline/painter.h"
#include "pipeline/voxel_export.h"

namespace heddle::pipeline {

namespace {

static_assert(std::endian::native == std::endian::little,
              "the files say LittleEndian and hold the machine's own bytes");

template <class Number>
std::string bytes_of(const std::vector<Number>& values) {
  std::string bytes(values.size() * sizeof(Number), '\0');
  if (!values.empty()) std::memcpy(bytes.data(), values.data(), bytes.size());
  return bytes;
}

std::string compressed(std::string_view block) {
  // Level 1: the next levels cost several times as long for a few per cent of size.
  constexpr int level = 1;
  uLongf size = compressBound(block.size());
  std::string out(size, '\0');
  if (compress2(reinterpret_cast<Bytef*>(out.data()), &size, reinterpret_cast<const Bytef*>(block.data()),
                block.size(), level) != Z_OK) {
    throw OutputError("zlib could not compress a block of " + std::to_string(block.size()) + " bytes");
  }
  out.resize(size);
  return out;
}

/// The part of a VTK XML file behind the underscore. Each array there is
///     [blocks][size of a block][size of the last block if it is shorter, else 0][compressed size of each
///     block] data
/// with UInt64 numbers (VTK file formats, "XML file formats", compressed appended data).
class AppendedData {
 public:
  /// @return  offset of this array from the byte after the underscore
  std::size_t add(std::string_view bytes) {
    const std::size_t offset = data_.size();
    std::vector<std::uint64_t> header{(bytes.size() + block_size - 1) / block_size, block_size,
                                      bytes.size() % block_size};
    std::string blocks;
    for (std::size_t at = 0; at < bytes.size(); at += block_size) {
      const std::string block = compressed(bytes.substr(at, block_size));
      header.push_back(block.size());
      blocks += block;
    }
    data_ += bytes_of(header) + blocks;
    return offset;
  }
  std::string element() const {
    return "  <AppendedData encoding=\"raw\">\n_" + data_ + "\n  </AppendedData>\n";
  }

 private:
  static constexpr std::size_t block_size = 32768;  // VTK's own default
  std::string data_;
};

std::string file_of(std::string_view type, std::string_view body, const AppendedData& data) {
  return fmt::format(
             "<?xml version=\"1.0\"?>\n<VTKFile type=\"{}\" version=\"1.0\" byte_order=\"LittleEndian\" "
             "header_type=\"UInt64\" compressor=\"vtkZLibDataCompressor\">\n{}",
             type, body) +
         data.element() + "</VTKFile>\n";
}

std::string array_element(std::string_view type, std::string_view name, int components, std::size_t offset) {
  return fmt::format(
      "        <DataArray type=\"{}\" Name=\"{}\" NumberOfComponents=\"{}\" format=\"appended\" "
      "offset=\"{}\"/>\n",
      type, escape(name), components, offset);
}

void require_writable(const std::vector<double>& values, std::string_view name, Precision precision) {
  const double largest = precision == Precision::single_precision ? double{std::numeric_limits<float>::max()}
                                                                  : std::numeric_limits<double>::max();
  for (std::size_t i = 0; i < values.size(); ++i) {
    if (!(std::abs(values[i]) <= largest))
      throw OutputError(fmt::format("array {}: entry {} is {}", name, i, values[i]));
  }
}

std::string data_elements(const std::vector<DataArray>& arrays, std::size_t places, Precision precision,
                          AppendedData& data) {
  std::string out;
  for (const DataArray& array : arrays) {
    if (array.components < 1 || array.values.size() != places * static_cast<std::size_t>(array.components)) {
      throw OutputError(fmt::format("array {}: {} values do not make {} places with {} components",
                                    array.name, array.values.size(), places, array.components));
    }
    require_writable(array.values, array.name, precision);
    const bool single_precision = precision == Precision::single_precision;
    const std::string bytes = single_precision
                                  ? bytes_of(std::vector<float>(array.values.begin(), array.values.end()))
                                  : bytes_of(array.values);
    out += array_element(single_precision ? "Float32" : "Float64", array.name, array.components,
                         data.add(bytes));
  }
  return out;
}

using Points = std::vector<std::array<double, 3>>;

std::string points_element(const Points& points, AppendedData& data) {
  std::vector<double> flat;
  for (const auto& point : points) flat.insert(flat.end(), point.begin(), point.end());
  require_writable(flat, "Points", Precision::double_precision);
  return "      <Points>\n" + array_element("Float64", "Points", 3, data.add(bytes_of(flat))) +
         "      </Points>\n";
}

/// Triangles or quads.
template <std::size_t corners>
std::string cells_element(const std::vector<std::array<int, corners>>& cells, std::size_t points,
                          AppendedData& data) {
  constexpr std::uint8_t vtk_type = corners == 3 ? 5 : 9;
  std::vector<std::int64_t> connectivity, offsets;
  for (const auto& cell : cells) {
    for (const int corner : cell) {
      if (corner < 0 || static_cast<std::size_t>(corner) >= points)
        throw OutputError(
            fmt::format("a {} names point {} of {}", corners == 3 ? "triangle" : "quad", corner, points));
      connectivity.push_back(corner);
    }
    offsets.push_back(static_cast<std::int64_t>(connectivity.size()));
  }
  const std::vector<std::uint8_t> types(cells.size(), vtk_type);
  std::string out = "      <Cells>\n";
  out += array_element("Int64", "connectivity", 1, data.add(bytes_of(connectivity)));
  out += array_element("Int64", "offsets", 1, data.add(bytes_of(offsets)));
  out += array_element("UInt8", "types", 1, data.add(bytes_of(types)));
  return out + "      </Cells>\n";
}

template <std::size_t corners>
std::string grid(const Points& points, const std::vector<std::array<int, corners>>& cells,
                 const std::vector<DataArray>& point_data, const std::vector<DataArray>& cell_data,
                 Precision precision) {
  AppendedData data;
  std::string body =
      fmt::format("  <UnstructuredGrid>\n    <Piece NumberOfPoints=\"{}\" NumberOfCells=\"{}\">\n",
                  points.size(), cells.size());
  body += "      <PointData>\n" + data_elements(point_data, points.size(), precision, data) +
          "      </PointData>\n";
  body +=
      "      <CellData>\n" + data_elements(cell_data, cells.size(), precision, data) + "      </CellData>\n";
  body += points_element(points, data) + cells_element(cells, points.size(), data);
  body += "    </Piece>\n  </UnstructuredGrid>\n";
  return file_of("UnstructuredGrid", body, data);
}

}  // namespace

std::string vtu(const QuadMesh& mesh, Precision precision) {
  return grid(mesh.points, mesh.quads, mesh.point_data, mesh.cell_data, precision);
}

std::string tows_vtu(const mesoscale::TowSurfaces& tows, int warps) {
  DataArray number{"tow", 1, {tows.tow.begin(), tows.tow.end()}}, family{"family", 1, {}};
  for (const int tow : tows.tow) family.values.push_back(tow <= warps ? 1.0 : 2.0);
  return grid(tows.mesh.vertices, tows.mesh.triangles, {}, {std::move(number), std::move(family)},
              Precision::single_precision);
}

namespace {

template <std::size_t N>
DataArray array_of(std::string name, const std::vector<std::array<double, N>>& values) {
  DataArray out{std::move(name), static_cast<int>(N), {}};
  for (const auto& value : values) out.values.insert(out.values.end(), value.begin(), value.end());
  return out;
}

}  // namespace

namespace {

std::array<double, 4> weights_at(const macroscale::Point2& p) {
  return {(1.0 - p[0]) * (1.0 - p[1]), p[0] * (1.0 - p[1]), p[0] * p[1], (1.0 - p[0]) * p[1]};
}

/// Quads that no outline cuts, then the pieces of the others on new points behind the nodes.
void add_cells(QuadMesh& mesh, const macroscale::BlankState& blank) {
  std::vector<char> cut(blank.quads.size(), 0);
  for (const auto& piece : blank.pieces) cut.at(static_cast<std::size_t>(piece.quad)) = 1;
  for (std::size_t q = 0; q < blank.quads.size(); ++q)
    if (!cut[q]) mesh.quads.push_back(blank.quads[q]);
  for (const auto& piece : blank.pieces) {
    const int first = static_cast<int>(mesh.points.size());
    for (const auto& corner : piece.corners)
      mesh.points.push_back(position_in(blank, blank.quads[static_cast<std::size_t>(piece.quad)], corner));
    mesh.quads.push_back({first, first + 1, first + 2, first + 3});
  }
}

/// Values at the corners of the pieces, behind those at the nodes.
void add_piece_values(DataArray& array, const macroscale::BlankState& blank) {
  const auto components = static_cast<std::size_t>(array.components);
  for (const auto& piece : blank.pieces) {
    const auto& quad = blank.quads[static_cast<std::size_t>(piece.quad)];
    for (const auto& corner : piece.corners) {
      const auto weight = weights_at(corner);
      for (std::size_t c = 0; c < components; ++c) {
        double value = 0.0;
        for (std::size_t k = 0; k < 4; ++k)
          value += weight[k] * array.values[static_cast<std::size_t>(quad[k]) * components + c];
        array.values.push_back(value);
      }
    }
  }
}

}  // namespace

std::array<double, 3> position_in(const macroscale::BlankState& blank, const std::array<int, 4>& quad,
                                  const macroscale::Point2& local) {
  const auto weight = weights_at(local);
  std::array<double, 3> x{};
  for (std::size_t k = 0; k < 4; ++k)
    for (std::size_t c = 0; c < 3; ++c)
      x[c] += weight[k] * blank.position[static_cast<std::size_t>(quad[k])][c];
  return x;
}

void add_nodal(QuadMesh& mesh, const macroscale::BlankState& blank, DataArray values) {
  // A quantity the run did not track is empty, and left out.
  if (values.values.empty()) return;
  add_piece_values(values, blank);
  mesh.point_data.push_back(std::move(values));
}

QuadMesh mesh_of(const macroscale::BlankState& blank) {
  QuadMesh mesh{blank.position, {}, {}, {}};
  add_cells(mesh, blank);
  const auto add = [&](DataArray array) { add_nodal(mesh, blank, std::move(array)); };
  DataArray angle{"shear_angle_deg", 1, blank.shear_angle};
  for (double& value : angle.values) value *= 180.0 / std::numbers::pi;
  add(std::move(angle));
  add(array_of("tow_strain_warp_weft", blank.tow_strain));
  add(array_of("reference_position_m", blank.reference));
  add(array_of("velocity_m_s", blank.velocity));
  add({"pressure_Pa", 1, blank.pressure});
  add({"slip_speed_m_s", 1, blank.slip_speed});
  add({"friction_coefficient", 1, blank.friction_coefficient});
  add({"hersey_number", 1, blank.hersey});
  if (!blank.plies.empty()) {
    DataArray ply{"ply", 1, {}};
    for (std::size_t k = 0; k < blank.plies.size(); ++k)
      ply.values.resize(static_cast<std::size_t>(blank.plies[k].end_node), static_cast<double>(k + 1));
    add(std::move(ply));
    DataArray slip{"slip_between_plies_mm", 1, blank.ply_slip};
    for (double& value : slip.values) value *= 1e3;
    add(std::move(slip));
    add({"pressure_between_plies_Pa", 1, blank.ply_pressure});
  }
  const auto add_celsius = [&](const char* name, std::vector<double> kelvin) {
    for (double& value : kelvin) value -= zero_celsius;
    add({name, 1, std::move(kelvin)});
  };
  add_celsius("temperature_bottom_C", blank.heat.bottom);
  add_celsius("temperature_top_C", blank.heat.top);
  add_celsius("temperature_mean_C", blank.heat.mean);
  add({"crystallised_share", 1, blank.heat.crystallised});
  return mesh;
}

std::string pvd(std::span<const SeriesFrame> frames) {
  std::string out =
      "<?xml version=\"1.0\"?>\n<VTKFile type=\"Collection\" version=\"1.0\" byte_order=\"LittleEndian\">\n  "
      "<Collection>\n";
  for (const SeriesFrame& frame : frames) {
    out += fmt::format("    <DataSet timestep=\"{}\" part=\"0\" file=\"{}\"/>\n", shortest(frame.time),
                       escape(frame.file));
  }
  return out + "  </Collection>\n</VTKFile>\n";
}

std::string vti(const mesoscale::solid::CellVoxels& voxels) {
  check_voxels(voxels);
  const mesoscale::VoxelLabels& grid = voxels.grid;
  AppendedData data;
  const std::string extent = fmt::format("0 {} 0 {} 0 {}", grid.count[0], grid.count[1], grid.count[2]);
  const auto triple = [](const std::array<double, 3>& v) {
    return shortest(v[0]) + " " + shortest(v[1]) + " " + shortest(v[2]);
  };
  std::string body = fmt::format(
      "  <ImageData WholeExtent=\"{0}\" Origin=\"{1}\" Spacing=\"{2}\">\n    <Piece Extent=\"{0}\">\n",
      extent, triple(grid.origin), triple(grid.spacing));
  body += "      <PointData/>\n      <CellData Scalars=\"label\" Vectors=\"tow_direction\">\n" +
          array_element("UInt16", "label", 1, data.add(bytes_of(grid.labels))) +
          array_element("Float32", "tow_fraction", 1, data.add(bytes_of(voxels.fraction))) +
          array_element("Float32", "tow_direction", 3, data.add(bytes_of(voxels.direction))) +
          "      </CellData>\n";
  body += "    </Piece>\n  </ImageData>\n";
  return file_of("ImageData", body, data);
}

}  // namespace heddle::pipeline
