#include "pipeline/solid_stage.h"

#include <algorithm>

#include <fmt/format.h>

namespace heddle::pipeline {

mesoscale::solid::SolidResult run_solid_stage(const Case& a_case) {
  namespace solid = mesoscale::solid;
  return a_case.voxels ? solid::analyse(*a_case.voxels) : solid::analyse(a_case.cell->weave, *a_case.solid);
}

void print_solid(const mesoscale::solid::SolidResult& s) {
  if (s.plate) {
    const Eigen::Matrix3d &a = s.plate->a, &d = s.plate->d;
    fmt::print("A11, A22, A12, A66   {:.1f}, {:.1f}, {:.1f}, {:.1f} N/mm ({:.3f} mm thick)\n", 1e-3 * a(0, 0),
               1e-3 * a(1, 1), 1e-3 * a(0, 1), 1e-3 * a(2, 2), 1e3 * s.thickness);
    fmt::print("D11, D22, D12, D66   {:.2f}, {:.2f}, {:.2f}, {:.2f} N mm\n", 1e3 * d(0, 0), 1e3 * d(1, 1),
               1e3 * d(0, 1), 1e3 * d(2, 2));
  }
  if (s.stack) {
    const mesoscale::solid::Matrix6& c = s.stack->stiffness;
    fmt::print("C11, C22, C33        {:.1f}, {:.1f}, {:.1f} MPa\n", 1e-6 * c(0, 0), 1e-6 * c(1, 1),
               1e-6 * c(2, 2));
    fmt::print("C12, C13, C23        {:.1f}, {:.1f}, {:.1f} MPa\n", 1e-6 * c(0, 1), 1e-6 * c(0, 2),
               1e-6 * c(1, 2));
    fmt::print("C66, C55, C44        {:.1f}, {:.1f}, {:.1f} MPa\n", 1e-6 * c(5, 5), 1e-6 * c(4, 4),
               1e-6 * c(3, 3));
  }
  fmt::print("voxels, iterations   {} x {} x {}, {}\n", s.voxels[0], s.voxels[1], s.voxels[2],
             std::max(s.plate ? s.plate->solver.most_iterations() : 0,
                      s.stack ? s.stack->solver.most_iterations() : 0));
}

}  // namespace heddle::pipeline
