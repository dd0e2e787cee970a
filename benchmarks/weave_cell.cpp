// What a voxel cell of the plain weave costs from five numbers to a file: 100 x 100 x 100 voxels, overlap and
// all.
//
//     benchmark_weave_cell
//
// CPU seconds, the best of five. The bare limit, measured in the same process: writing the finished bytes to
// a file. TexGen, for the same task on another machine: 3.6 to 4.0 s, 191 MB of text. Prints, judges
// nothing.
#include <fmt/format.h>

#include <filesystem>

#include "benchmarks/measure.h"
#include "mesoscale/pictures.h"
#include "mesoscale/solid/sampler.h"
#include "pipeline/export_vtu.h"
#include "pipeline/outputs.h"

using namespace heddle;
using namespace heddle::mesoscale;

namespace {

double best_cpu(const std::function<void()>& work) {
  double best = 1e300;
  for (int k = 0; k < 5; ++k) best = std::min(best, benchmark::time_of(work).cpu);
  return best;
}

}  // namespace

int main() {
  const std::filesystem::path file = std::filesystem::temp_directory_path() / "heddle_benchmark_cell.vti";
  UnitCell cell;
  solid::CellVoxels voxels;
  Penetration overlap{};
  std::string bytes;
  const double geometry =
      best_cpu([&] { cell = unit_cell(fabric_geometry(WeaveSpec{}, CellState::as_woven), 0.0); });
  const double labels = best_cpu([&] { voxels = solid::cell_voxels(cell, 50, 100); });
  const double penetrates = best_cpu([&] { overlap = penetration(cell, 50); });
  // What the solver takes: normals of interfaces as well.
  solid::VoxelCell sampled;
  const double sampling =
      best_cpu([&] { sampled = solid::sample(cell, 2.0 * cell.crown(), {.per_pitch = 50, .layers = 100}); });
  const double packing = best_cpu([&] { bytes = pipeline::vti(voxels); });
  const double writing = best_cpu([&] { pipeline::write_file(file, bytes); });
  const double megabytes = 1e-6 * static_cast<double>(std::filesystem::file_size(file));
  std::filesystem::remove(file);
  const double all = geometry + labels + penetrates + sampling + packing + writing;
  fmt::print(
      "plain weave, {} voxels: geometry {:.2g} s, labels, shares and directions {:.3f} s, overlap {:.3f} s "
      "({:.2g} m^3), "
      "what the solver takes {:.3f} s, packing "
      "{:.3f} s, "
      "writing {:.4f} s\n",
      voxels.fraction.size(), geometry, labels, penetrates, overlap.volume, sampling, packing, writing);
  fmt::print("in all {:.3f} CPU s and {:.3f} MB; {:.1f} Mvoxel/s, {:.0f} times the bare write\n", all,
             megabytes, 1e-6 * static_cast<double>(voxels.fraction.size()) / all, all / writing);
  benchmark::append_row(
      "weave_cell", "date,voxels,cpu_s,MB,labels_cpu_s,sampling_cpu_s,packing_cpu_s,over_bare_write",
      fmt::format("{},{},{:.3f},{:.3f},{:.3f},{:.3f},{:.3f},{:.0f}", benchmark::today(),
                  voxels.fraction.size(), all, megabytes, labels, sampling, packing, all / writing));
}
