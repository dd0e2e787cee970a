#include <zlib.h>

#include <catch2/catch.hpp>
#include <cmath>
#include <cstring>
#include <map>
#include <numbers>
#include <regex>

#include "pipeline/export_vtu.h"
#include "pipeline/outputs.h"
#include "sample_run.h"

using namespace heddle::pipeline;
using Catch::Matchers::Contains;
namespace sample = heddle::pipeline::sample;

namespace {

/// A reader of its own for VTK XML files, after the description of the format: it knows nothing of the
/// writer.
struct VtkFile {
  struct Array {
    std::string type;
    int components;
    std::string bytes;
  };
  std::string xml;  ///< up to the appended data
  std::map<std::string, Array> arrays;
  std::size_t data_size = 0, data_read = 0;
};

std::uint64_t number_at(const std::string& bytes, std::size_t at) {
  std::uint64_t value = 0;
  REQUIRE(at + sizeof value <= bytes.size());
  std::memcpy(&value, bytes.data() + at, sizeof value);
  return value;
}

/// One array: [blocks][block size][last block size][compressed sizes...] and the blocks.
std::string inflated(const std::string& data, std::size_t offset, std::size_t& used) {
  const std::uint64_t blocks = number_at(data, offset), size = number_at(data, offset + 8),
                      last = number_at(data, offset + 16);
  std::size_t at = offset + 8 * (3 + blocks);
  std::string out;
  for (std::uint64_t b = 0; b < blocks; ++b) {
    const std::uint64_t packed = number_at(data, offset + 8 * (3 + b));
    REQUIRE(at + packed <= data.size());
    uLongf length = b + 1 == blocks && last != 0 ? last : size;
    const uLongf expected = length;
    std::string block(length, '\0');
    REQUIRE(uncompress(reinterpret_cast<Bytef*>(block.data()), &length,
                       reinterpret_cast<const Bytef*>(data.data() + at), packed) == Z_OK);
    REQUIRE(length == expected);
    out += block;
    at += packed;
  }
  used += at - offset;
  return out;
}

VtkFile parse(const std::string& file) {
  VtkFile out;
  const std::string opening = "<AppendedData encoding=\"raw\">";
  const std::size_t start = file.find(opening);
  REQUIRE(start != std::string::npos);
  const std::size_t underscore = file.find('_', start);
  const std::size_t end = file.rfind("\n  </AppendedData>");
  REQUIRE(file.substr(start + opening.size(), underscore - start - opening.size()) == "\n");
  out.xml = file.substr(0, start);
  const std::string data = file.substr(underscore + 1, end - underscore - 1);
  out.data_size = data.size();
  const std::regex array(
      "<DataArray type=\"(\\w+)\" Name=\"([^\"]+)\" NumberOfComponents=\"(\\d+)\" format=\"appended\" "
      "offset=\"(\\d+)\"/>");
  for (std::sregex_iterator it(out.xml.begin(), out.xml.end(), array), none; it != none; ++it) {
    out.arrays[(*it)[2]] = {(*it)[1], std::stoi((*it)[3]),
                            inflated(data, std::stoul((*it)[4]), out.data_read)};
  }
  return out;
}

template <class Number>
std::vector<Number> numbers(const VtkFile& file, const std::string& name) {
  REQUIRE(file.arrays.count(name) == 1);
  const std::string& bytes = file.arrays.at(name).bytes;
  REQUIRE(bytes.size() % sizeof(Number) == 0);
  std::vector<Number> out(bytes.size() / sizeof(Number));
  if (!out.empty()) std::memcpy(out.data(), bytes.data(), bytes.size());
  return out;
}

}  // namespace

TEST_CASE("a blank written for ParaView reads back with the same nodes, cells and angles", "[vtu]") {
  const auto blank = sample::blank(48);  // 2401 nodes: the points fill one block and part of a second
  const VtkFile file = parse(vtu(mesh_of(blank)));
  CHECK_THAT(file.xml, Contains("type=\"UnstructuredGrid\"") && Contains("byte_order=\"LittleEndian\"") &&
                           Contains("header_type=\"UInt64\"") &&
                           Contains("compressor=\"vtkZLibDataCompressor\""));
  CHECK_THAT(file.xml, Contains("NumberOfPoints=\"2401\" NumberOfCells=\"2304\""));
  CHECK(file.data_read == file.data_size);  // arrays lie end to end, nothing between or behind them

  const auto points = numbers<double>(file, "Points");
  REQUIRE(points.size() == 3 * blank.position.size());
  for (std::size_t i = 0; i < blank.position.size(); ++i) {
    for (std::size_t c = 0; c < 3; ++c) REQUIRE(points[3 * i + c] == blank.position[i][c]);
  }
  const auto connectivity = numbers<std::int64_t>(file, "connectivity");
  const auto offsets = numbers<std::int64_t>(file, "offsets");
  REQUIRE(connectivity.size() == 4 * blank.quads.size());
  for (std::size_t q = 0; q < blank.quads.size(); ++q) {
    REQUIRE(offsets[q] == static_cast<std::int64_t>(4 * (q + 1)));
    for (std::size_t k = 0; k < 4; ++k) REQUIRE(connectivity[4 * q + k] == blank.quads[q][k]);
  }
  CHECK(numbers<std::uint8_t>(file, "types") == std::vector<std::uint8_t>(blank.quads.size(), 9));

  const auto angles = numbers<float>(file, "shear_angle_deg");
  REQUIRE(angles.size() == blank.shear_angle.size());
  for (std::size_t i = 0; i < angles.size(); ++i) {
    REQUIRE(angles[i] == static_cast<float>(blank.shear_angle[i] * (180.0 / std::numbers::pi)));
  }
  CHECK(file.arrays.at("velocity_m_s").components == 3);
  CHECK(file.arrays.at("tow_strain_warp_weft").components == 2);
  CHECK(file.arrays.at("friction_coefficient").type == "Float32");
}

TEST_CASE("double precision keeps every bit of the data", "[vtu]") {
  QuadMesh mesh{{{0, 0, 0}, {1, 0, 0}, {1, 1, 0}, {0, 1, 0}},
                {{0, 1, 2, 3}},
                {{"point", 1, {0.1, 1.0 / 3.0, -0.0, 1e300}}},
                {{"cell", 2, {0.7, 0.2}}}};
  const VtkFile file = parse(vtu(mesh, Precision::double_precision));
  CHECK(numbers<double>(file, "point") == mesh.point_data[0].values);
  CHECK(std::signbit(numbers<double>(file, "point")[2]));
  CHECK(numbers<double>(file, "cell") == mesh.cell_data[0].values);
  // 1e300 has no single-precision form: refused rather than written as infinity.
  CHECK_THROWS_WITH(vtu(mesh, Precision::single_precision), Contains("array point: entry 3"));
}

TEST_CASE("arrays of any length are cut into blocks the format allows", "[vtu]") {
  // Just below, at and just above one and two blocks of 32768 bytes, and none at all.
  for (const int voxels : {0, 1, 16383, 16384, 16385, 32768, 32769}) {
    CAPTURE(voxels);
    heddle::mesoscale::solid::CellVoxels cell{{{voxels, 1, 1}, {}, {1, 1, 1}, {}}, {}, {}};
    cell.fraction.resize(static_cast<std::size_t>(voxels));
    cell.direction.resize(3 * static_cast<std::size_t>(voxels));
    for (int i = 0; i < voxels; ++i) cell.grid.labels.push_back(static_cast<std::uint16_t>(7 * i % 65536));
    const VtkFile file = parse(vti(cell));
    CHECK(numbers<std::uint16_t>(file, "label") == cell.grid.labels);
    CHECK(file.data_read == file.data_size);
  }
}

TEST_CASE("voxels carry the frame of the cell, x fastest", "[vtu]") {
  heddle::mesoscale::solid::CellVoxels voxels{
      {{3, 2, 1}, {0.5e-3, 0.0, -1e-3}, {1e-4, 2e-4, 3e-4}, {0, 1, 2, 3, 4, 5}},
      {0.0F, 0.25F, 1.0F, 0.5F, 0.1F, 0.9F},
      std::vector<float>(18, 0.5F)};
  voxels.direction[4] = -1.0F;
  const VtkFile file = parse(vti(voxels));
  CHECK_THAT(file.xml, Contains("WholeExtent=\"0 3 0 2 0 1\"") && Contains("Origin=\"0.0005 0 -0.001\"") &&
                           Contains("Spacing=\"0.0001 0.0002 0.0003\""));
  CHECK(numbers<std::uint16_t>(file, "label") == voxels.grid.labels);
  CHECK(numbers<float>(file, "tow_fraction") == voxels.fraction);
  CHECK(numbers<float>(file, "tow_direction") == voxels.direction);
  voxels.direction.pop_back();
  CHECK_THROWS_WITH(vti(voxels), Contains("17 components of tow directions for 3 x 2 x 1 voxels"));
  voxels.fraction.pop_back();
  CHECK_THROWS_WITH(vti(voxels), Contains("5 tow fractions for 3 x 2 x 1 voxels"));
  voxels.grid.labels.pop_back();
  CHECK_THROWS_WITH(vti(voxels), Contains("5 labels for 3 x 2 x 1 voxels"));
}

TEST_CASE("tows are triangles with their number and family", "[vtu]") {
  heddle::mesoscale::TowSurfaces tows{
      {{{0, 0, 0}, {1e-3, 0, 0}, {0, 1e-3, 0}, {0, 0, 1e-3}}, {{0, 1, 2}, {1, 3, 2}}}, {1, 2}};
  const VtkFile file = parse(tows_vtu(tows, 1));
  CHECK(numbers<std::int64_t>(file, "connectivity") == std::vector<std::int64_t>{0, 1, 2, 1, 3, 2});
  CHECK(numbers<std::int64_t>(file, "offsets") == std::vector<std::int64_t>{3, 6});
  CHECK(numbers<std::uint8_t>(file, "types") == std::vector<std::uint8_t>{5, 5});
  CHECK(numbers<float>(file, "tow") == std::vector<float>{1.0F, 2.0F});
  CHECK(numbers<float>(file, "family") == std::vector<float>{1.0F, 2.0F});
  CHECK(numbers<double>(file, "Points")[3] == 1e-3);
  tows.mesh.triangles[1][1] = 4;
  CHECK_THROWS_WITH(tows_vtu(tows, 1), Contains("a triangle names point 4 of 4"));
}

TEST_CASE("data that does not fit the mesh is refused by name", "[vtu]") {
  QuadMesh mesh{{{0, 0, 0}, {1, 0, 0}, {1, 1, 0}, {0, 1, 0}}, {{0, 1, 2, 3}}, {{"short", 3, {1, 2, 3}}}, {}};
  CHECK_THROWS_WITH(vtu(mesh), Contains("array short"));
  mesh.point_data = {{"broken", 1, {0, 1, NAN, 3}}};
  CHECK_THROWS_WITH(vtu(mesh), Contains("array broken: entry 2 is nan"));
  mesh.point_data.clear();
  mesh.quads[0][3] = 4;
  CHECK_THROWS_WITH(vtu(mesh), Contains("names point 4 of 4"));
}

TEST_CASE("equal blanks give equal bytes, and quantities not tracked are left out", "[vtu]") {
  auto blank = sample::blank(8);
  CHECK(vtu(mesh_of(blank)) == vtu(mesh_of(blank)));
  blank.hersey.clear();
  CHECK(parse(vtu(mesh_of(blank))).arrays.count("hersey_number") == 0);
}

TEST_CASE("a series lists its frames in order with relative names", "[vtu]") {
  const std::vector<SeriesFrame> frames{{0.0, "blank_0000.vtu"}, {0.1, "blank_0001.vtu"}};
  const std::string text = pvd(frames);
  CHECK_THAT(text, Contains("type=\"Collection\"") &&
                       Contains("timestep=\"0\" part=\"0\" file=\"blank_0000.vtu\"") &&
                       Contains("timestep=\"0.1\" part=\"0\" file=\"blank_0001.vtu\""));
  CHECK(text.find("blank_0000") < text.find("blank_0001"));
}
