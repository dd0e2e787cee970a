// What a tool from a file costs: building the band of a punch of 200 000 triangles, and one distance query
// with gradient and Hessian for the nodes of a formed blank in the order of the mesh, beside what merely
// fetching 27 floats a node costs in the same run.
//
//     benchmark_contact_query [voxel in mm] [half width in mm]
//
// Appends a row to benchmarks/results/contact_query.csv. Times are the best of many repeats on one thread: on
// a shared machine the best is what the code costs, the rest is the neighbours.
#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <cstdio>
#include <cstdlib>
#include <memory>
#include <random>
#include <vector>

#include "benchmarks/measure.h"
#include "macroscale/tool_band.h"
#include "tests/macroscale/tool_meshes.h"

using namespace heddle;
using namespace heddle::macroscale;
using namespace heddle::benchmark;
using Eigen::Vector3d;

namespace {

constexpr double radius = 70e-3, height = 200e-3;  // the shipped punch, long enough for the whole blank
constexpr double blank = 320e-3, half_thickness = 0.75e-3;
constexpr int nodes_a_side = 73;  // the shipped case: 5329 nodes

// The blank wrapped over dome and wall by arc length, half a thickness off the tool: every node in the band.
std::vector<Vector3d> formed_blank() {
  std::vector<Vector3d> nodes;
  for (int j = 0; j < nodes_a_side; ++j)
    for (int i = 0; i < nodes_a_side; ++i) {
      const double x = blank * (static_cast<double>(i) / (nodes_a_side - 1) - 0.5);
      const double y = blank * (static_cast<double>(j) / (nodes_a_side - 1) - 0.5);
      const double s = std::hypot(x, y), quarter = 0.5 * std::numbers::pi * radius;
      const double a = std::min(s, quarter) / radius, off = radius + half_thickness;
      const double r = off * std::sin(a), z = radius - off * std::cos(a) + std::max(s - quarter, 0.0);
      nodes.emplace_back(s > 0.0 ? r * x / s : 0.0, s > 0.0 ? r * y / s : 0.0, z);
    }
  return nodes;
}

double query_seconds(const ToolBand& band, const std::vector<Vector3d>& nodes, double& sum) {
  return best_seconds(200, [&] {
    for (const Vector3d& x : nodes) {
      const Distance d = evaluate(band, x);
      sum += d.distance + d.normal.z() + d.curvature(0, 1);
    }
  });
}

// 27 floats and multiply-adds a node out of as much memory as the band holds, evenly strided.
double bare_seconds(std::size_t floats, std::size_t count, double& sum) {
  std::vector<float> memory(floats, 1.0f);
  const std::size_t stride = (floats - 27) / count;
  return best_seconds(200, [&] {
    for (std::size_t n = 0; n < count; ++n) {
      const float* from = &memory[n * stride];
      double s = 0.0;
      for (int k = 0; k < 27; ++k) s += static_cast<double>(from[k]) * (k - 13.5);
      sum += s;
    }
  });
}

}  // namespace

int main(int argc, char** argv) {
  const ToolBandSpec spec{.voxel = 1e-3 * (argc > 1 ? std::atof(argv[1]) : 0.5),
                          .half_width = 1e-3 * (argc > 2 ? std::atof(argv[2]) : 3.0)};
  const TriangleMesh mesh = test::punch_mesh(radius, height, 93);
  double estimate = 0.0;
  const double check_time = time_of([&] { estimate = 1e-6 * estimated_memory(mesh, spec); }).wall;
  std::unique_ptr<const ToolBand> band;
  const auto [build, build_cpu] =
      time_of([&] { band = std::make_unique<const ToolBand>(tool_band(mesh, spec, "tools.punch")); });
  const double peak = peak_megabytes();

  std::vector<Vector3d> nodes = formed_blank();
  double sum = 0.0;
  const double per_node = 1e9 / static_cast<double>(nodes.size());
  const double in_order = per_node * query_seconds(*band, nodes, sum);
  std::shuffle(nodes.begin(), nodes.end(), std::mt19937(1));
  const double shuffled = per_node * query_seconds(*band, nodes, sum);
  const double bare = per_node * bare_seconds(band->memory() / sizeof(float), nodes.size(), sum);
  if (!std::isfinite(sum)) {
    fmt::print(stderr, "a node lies beyond the band: this is no measurement\n");
    return 1;
  }

  fmt::print(
      "{} triangles, voxel {} mm, half width {} mm: built in {:.2f} s ({:.2f} s of all cores), peak {:.0f} "
      "MB (estimated {:.0f} MB in "
      "{:.3f} s), band {:.0f} MB\n",
      mesh.triangles.size(), 1e3 * spec.voxel, 1e3 * spec.half_width, build, build_cpu, peak, estimate,
      check_time, 1e-6 * static_cast<double>(band->memory()));
  fmt::print(
      "a query: {:.0f} ns in the order of the mesh, {:.0f} ns shuffled; 27 floats alone {:.1f} ns: {:.1f} "
      "times "
      "the limit\n",
      in_order, shuffled, bare, in_order / bare);
  const bool written =
      append_row("contact_query",
                 "date,triangles,voxel_mm,half_width_mm,build_s,build_cpu_s,peak_memory_MB,band_MB,nodes,"
                 "query_mesh_order_ns,"
                 "query_shuffled_ns,bare_27_floats_ns,query_over_bare",
                 fmt::format("{},{},{:g},{:g},{:.2f},{:.2f},{:.0f},{:.0f},{},{:.1f},{:.1f},{:.2f},{:.1f}",
                             today(), mesh.triangles.size(), 1e3 * spec.voxel, 1e3 * spec.half_width, build,
                             build_cpu, peak, 1e-6 * static_cast<double>(band->memory()), nodes.size(),
                             in_order, shuffled, bare, in_order / bare));
  return written ? 0 : 1;
}
