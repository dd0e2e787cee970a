// What a tool file costs: a punch of 200 000 triangles from STL to a band that contact can query, and the
// time in which files that are no tools are refused.
//
//     benchmark_tool_loading
//
// The bare limit of the same run: reading the file's bytes, and measuring each voxel of the band against one
// triangle. Appends a row to benchmarks/results/tool_loading.csv; judges nothing.
#include <fmt/format.h>

#include <cstdint>
#include <cstdio>
#include <filesystem>
#include <fstream>
#include <memory>
#include <sstream>
#include <string>
#include <utility>
#include <vector>

#include "benchmarks/measure.h"
#include "core/problem.h"
#include "core/triangle_walk.h"
#include "macroscale/tool_band.h"
#include "macroscale/tool_file.h"
#include "tests/macroscale/sample_meshes.h"
#include "tests/macroscale/tool_meshes.h"

using namespace heddle;
using namespace heddle::macroscale;
using namespace heddle::benchmark;

namespace {

const Expectation expected{"tools.punch", {0.32, 0.32}, 0.07};

ToolFile in_millimetres(const std::filesystem::path& file) {
  ToolFile tool;
  tool.file = file;
  return tool;
}

double bare_seconds(const std::filesystem::path& file, const TriangleMesh& mesh, std::size_t voxels) {
  return time_of([&] {
           std::ifstream in(file, std::ios::binary);
           std::ostringstream bytes;
           bytes << in.rdbuf();
           const TriangleWalk walk(mesh);
           double sum = static_cast<double>(bytes.str().size());
           for (std::size_t n = 0; n < voxels; ++n)
             sum += walk.at(static_cast<int>(n * 7 % mesh.triangles.size()),
                            {0.1, 1e-9 * static_cast<double>(n), 0.2})
                        .squared;
           if (!(sum > 0.0)) fmt::print("nothing measured\n");
         })
      .cpu;
}

// A sparse file whose header promises n triangles: its size is what counts.
std::filesystem::path stl_of_zeros(const test::Folder& folder, std::uint32_t n) {
  const auto file = folder.write("five_million.stl", std::string(84, '\0'));
  {
    std::fstream stream(file, std::ios::in | std::ios::out | std::ios::binary);
    stream.seekp(80);
    stream.write(reinterpret_cast<const char*>(&n), sizeof n);
  }
  std::filesystem::resize_file(file, 84 + 50ull * n);
  return file;
}

std::filesystem::path obj_of_repeated_faces(const test::Folder& folder, int thousands) {
  std::string faces;
  for (int i = 0; i < 1000; ++i) faces += "f 1 2 3\n";
  std::ofstream text(folder / "five_million.obj");
  text << "v 0 0 0\nv 100 0 0\nv 0 100 0\n";
  for (int i = 0; i < thousands; ++i) text << faces;
  return folder / "five_million.obj";
}

// Wall time of the slowest refusal [s].
double refuse_all(const test::Folder& folder, const TriangleMesh& good) {
  TriangleMesh fin = good;
  fin.vertices.push_back({0.3, 0.3, 0.3});
  fin.triangles.push_back(
      {good.triangles[0][0], good.triangles[0][1], static_cast<int>(good.vertices.size())});
  std::string garbage(20'000'000, ' ');
  std::uint32_t state = 1;
  for (char& c : garbage) c = static_cast<char>((state = state * 1103515245u + 12345u) >> 16);
  TriangleMesh metres = good;
  for (auto& v : metres.vertices)
    for (double& c : v) c *= 1e-3;
  const std::vector<std::pair<std::string, std::filesystem::path>> files = {
      {"missing", folder / "missing.stl"},
      {"empty", folder.write("empty.stl", "")},
      {"garbage, 20 MB", folder.write("garbage.stl", garbage)},
      {"non-manifold, 200 000 triangles", folder.write("fin.stl", test::binary_stl(fin))},
      {"inside out, 200 000 triangles", folder.write("turned.stl", test::binary_stl(test::inside_out(good)))},
      {"metres for millimetres, 200 000 triangles", folder.write("metres.stl", test::binary_stl(metres))},
      {"5 million triangles, STL", stl_of_zeros(folder, 5'000'000)},
      {"5 million triangles, OBJ", obj_of_repeated_faces(folder, 5000)}};
  double slowest = 0.0;
  for (const auto& [what, file] : files) {
    std::string rule = "NOT REFUSED";
    const Time time = time_of([&] {
      const Problems problems = test::refusal([&] { load_tool(in_millimetres(file), expected); });
      if (!problems.empty()) rule = problems.front().id;
    });
    fmt::print("refused in {:5.2f} s ({:.2f} s CPU)  {:45} {}\n", time.wall, time.cpu, what, rule);
    slowest = std::max(slowest, time.wall);
  }
  return slowest;
}

}  // namespace

int main() {
  const test::Folder folder;
  const TriangleMesh mesh = test::punch_mesh(70e-3, 170e-3, 100);
  const auto file = folder.write("punch.stl", test::binary_stl(mesh));
  const double before = peak_megabytes();
  LoadedTool tool;
  const Time load = time_of([&] { tool = load_tool(in_millimetres(file), expected); });
  std::unique_ptr<const ToolBand> band;
  const ToolBandSpec spec{.voxel = 1e-3, .half_width = required_half_width(0.7e-3, 1.5e-3, 2e-3)};
  const Time build =
      time_of([&] { band = std::make_unique<const ToolBand>(tool_band(tool.mesh, spec, "tools.punch")); });
  const double peak = peak_megabytes();
  const std::size_t voxels = band->bricks() * 512;
  const double bare = bare_seconds(file, tool.mesh, voxels);
  const double ratio = (load.cpu + build.cpu) / bare;
  fmt::print(
      "{} triangles: read and checked in {:.2f} s ({:.2f} s CPU), band of {} voxels in {:.2f} s ({:.2f} s "
      "CPU)\n",
      mesh.triangles.size(), load.wall, load.cpu, voxels, build.wall, build.cpu);
  fmt::print(
      "peak {:.0f} MB, of which {:.0f} MB before; one triangle a voxel {:.2f} s CPU: {:.1f} times the "
      "limit\n",
      peak, before, bare, ratio);
  const double slowest = refuse_all(folder, mesh);
  return append_row(
             "tool_loading",
             "date,triangles,load_s,load_cpu_s,voxels,band_s,band_cpu_s,peak_memory_MB,bare_cpu_s,over_bare,"
             "slowest_refusal_s",
             fmt::format("{},{},{:.2f},{:.2f},{},{:.2f},{:.2f},{:.0f},{:.3f},{:.1f},{:.2f}", today(),
                         mesh.triangles.size(), load.wall, load.cpu, voxels, build.wall, build.cpu, peak,
                         bare, ratio, slowest))
             ? 0
             : 1;
}
