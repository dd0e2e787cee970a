#include "mesoscale/solid/ccx_deck.h"

#include <Eigen/LU>
#include <algorithm>
#include <sstream>
#include <stdexcept>

#include <fmt/format.h>

#include "core/problem.h"
#include "mesoscale/solid/woven_solid.h"

namespace heddle::mesoscale::solid {

namespace {

constexpr double to_mm = 1e3, to_mpa = 1e-6;

// Nodes of the mesh, x fastest, numbered from 1; the drivers follow.
struct NodeGrid {
  std::array<int, 3> voxels;

  int along(std::size_t axis) const { return voxels[axis] + 1; }
  int count() const { return along(0) * along(1) * along(2); }
  int number(int i, int j, int k) const { return 1 + i + along(0) * (j + along(1) * k); }
  int driver(std::size_t axis) const { return count() + 1 + static_cast<int>(axis); }
};

template <class Visit>
void for_each_node(const NodeGrid& grid, const Visit& visit) {
  for (int k = 0; k < grid.along(2); ++k)
    for (int j = 0; j < grid.along(1); ++j)
      for (int i = 0; i < grid.along(0); ++i) visit(std::array{i, j, k});
}

void add_nodes(std::string& out, const NodeGrid& grid, const Eigen::Matrix3d& edges) {
  out += "*NODE, NSET=CELL\n";
  for_each_node(grid, [&](const std::array<int, 3>& at) {
    const Eigen::Vector3d share(static_cast<double>(at[0]) / grid.voxels[0],
                                static_cast<double>(at[1]) / grid.voxels[1],
                                static_cast<double>(at[2]) / grid.voxels[2]);
    const Eigen::Vector3d x = to_mm * (edges * share);
    out += fmt::format("{}, {:.9g}, {:.9g}, {:.9g}\n", grid.number(at[0], at[1], at[2]), x[0], x[1], x[2]);
  });
  out += "*NODE, NSET=DRIVERS\n";
  for (std::size_t axis = 0; axis < 3; ++axis) {
    const Eigen::Vector3d x = 1.25 * to_mm * edges.col(static_cast<Eigen::Index>(axis));  // beside the cell
    out += fmt::format("{}, {:.9g}, {:.9g}, {:.9g}\n", grid.driver(axis), x[0], x[1], x[2]);
  }
}

// Elements of one content in a set: ccx gives materials to sets.
void add_elements(std::string& out, const NodeGrid& grid, const VoxelCell& cell) {
  std::vector<std::vector<int>> of_content(cell.contents.size());
  for (std::size_t v = 0; v < cell.content.size(); ++v)
    of_content[cell.content[v]].push_back(static_cast<int>(v));
  for (std::size_t c = 0; c < of_content.size(); ++c) {
    if (of_content[c].empty()) continue;
    out += fmt::format("*ELEMENT, TYPE=C3D8, ELSET=CONTENT{}\n", c);
    for (const int v : of_content[c]) {
      const int i = v % grid.voxels[0], j = v / grid.voxels[0] % grid.voxels[1],
                k = v / (grid.voxels[0] * grid.voxels[1]);
      out += fmt::format("{}, {}, {}, {}, {}, {}, {}, {}, {}\n", v + 1, grid.number(i, j, k),
                         grid.number(i + 1, j, k), grid.number(i + 1, j + 1, k), grid.number(i, j + 1, k),
                         grid.number(i, j, k + 1), grid.number(i + 1, j, k + 1),
                         grid.number(i + 1, j + 1, k + 1), grid.number(i, j + 1, k + 1));
    }
  }
}

void add_phases(std::string& out, std::span<const DeckPhase> phases) {
  for (const auto& [name, m] : phases)
    out += fmt::format(
        "*MATERIAL, NAME={}\n*ELASTIC, TYPE=ENGINEERING CONSTANTS\n{:.10g}, {:.10g}, {:.10g}, {:.10g}, "
        "{:.10g}, "
        "{:.10g}, {:.10g}, {:.10g}\n{:.10g}\n",
        name, to_mpa * m.axial_modulus, to_mpa * m.transverse_modulus, to_mpa * m.transverse_modulus,
        m.axial_poisson, m.axial_poisson, m.transverse_poisson(), to_mpa * m.axial_shear,
        to_mpa * m.axial_shear, to_mpa * m.transverse_shear);
}

// The 21 constants go by columns of the upper half, in the order 11, 22, 33, 12, 13, 23.
void add_mixed_material(std::string& out, std::size_t content, const Matrix6& c) {
  constexpr std::array<int, 6> order{0, 1, 2, 5, 4, 3};
  out += fmt::format("*MATERIAL, NAME=MIXED{}\n*ELASTIC, TYPE=ANISO\n", content);
  int written = 0;
  for (std::size_t column = 0; column < 6; ++column)
    for (std::size_t row = 0; row <= column; ++row)
      out += fmt::format("{:.10g}{}", to_mpa * c(order[row], order[column]),
                         ++written % 8 == 0 || written == 21 ? "\n" : ", ");
}

void add_sections(std::string& out, const VoxelCell& cell, std::span<const DeckPhase> phases,
                  std::span<const Matrix6> content_stiffness) {
  for (std::size_t d = 0; d < cell.directions.size(); ++d) {
    const Eigen::Matrix3d turn = turn_to(cell.directions[d]);
    out += fmt::format(
        "*ORIENTATION, NAME=TOW{}, SYSTEM=RECTANGULAR\n{:.10g}, {:.10g}, {:.10g}, {:.10g}, {:.10g}, "
        "{:.10g}\n",
        d, turn(0, 0), turn(1, 0), turn(2, 0), turn(0, 1), turn(1, 1), turn(2, 1));
  }
  std::vector<bool> used(cell.contents.size(), false);
  for (const std::uint16_t content : cell.content) used[content] = true;
  for (std::size_t c = 0; c < cell.contents.size(); ++c) {
    if (!used[c]) continue;
    const std::vector<Portion>& portions = cell.contents[c].portions;
    if (portions.size() > 1) {
      add_mixed_material(out, c, content_stiffness[c]);
      out += fmt::format("*SOLID SECTION, ELSET=CONTENT{0}, MATERIAL=MIXED{0}\n", c);
    } else {
      out += fmt::format("*SOLID SECTION, ELSET=CONTENT{}, MATERIAL={}, ORIENTATION=TOW{}\n", c,
                         phases[portions[0].phase].name, portions[0].direction);
    }
  }
}

// u(far) - u(near) - drivers = 0, the far node first: ccx eliminates it. Four terms a line.
void add_equations(std::string& out, const NodeGrid& grid) {
  for_each_node(grid, [&](const std::array<int, 3>& at) {
    std::array<int, 3> image = at;
    std::vector<int> crossed;
    for (std::size_t axis = 0; axis < 3; ++axis)
      if (at[axis] == grid.voxels[axis]) {
        image[axis] = 0;
        crossed.push_back(grid.driver(axis));
      }
    if (crossed.empty()) return;
    for (int dof = 1; dof <= 3; ++dof) {
      out +=
          fmt::format("*EQUATION\n{}\n{}, {}, 1., {}, {}, -1.", 2 + crossed.size(),
                      grid.number(at[0], at[1], at[2]), dof, grid.number(image[0], image[1], image[2]), dof);
      for (std::size_t n = 0; n < crossed.size(); ++n)
        out += fmt::format("{}{}, {}, -1.", n == 2 ? ",\n" : ", ", crossed[n], dof);
      out += "\n";
    }
  });
}

// Loads are kept by ccx from step to step: OP=NEW drops those of the one before.
void add_steps(std::string& out, const NodeGrid& grid, const Eigen::Matrix3d& edges) {
  // A corner against translation; the period along x stays on its line and that along y in its plane.
  out += fmt::format("*BOUNDARY\n1, 1, 3\n{0}, 2, 3\n{1}, 3, 3\n", grid.driver(0), grid.driver(1));
  const Eigen::Matrix3d mm = to_mm * edges, dual = mm.inverse().transpose() * mm.determinant();
  for (const auto& [a, b] : voigt_axes) {
    Eigen::Matrix3d stress = Eigen::Matrix3d::Zero();
    stress(a, b) = stress(b, a) = 1.0;  // [MPa]
    out += "*STEP\n*STATIC\n*CLOAD, OP=NEW\n";
    for (std::size_t axis = 0; axis < 3; ++axis) {
      const Eigen::Vector3d force = stress * dual.col(static_cast<Eigen::Index>(axis));  // [N]
      for (int dof = 0; dof < 3; ++dof)
        if (force[dof] != 0.0)
          out += fmt::format("{}, {}, {:.12g}\n", grid.driver(axis), dof + 1, force[dof]);
    }
    out += "*NODE PRINT, NSET=DRIVERS\nU\n*END STEP\n";
  }
}

}  // namespace

std::string ccx_deck(const VoxelCell& cell, std::span<const DeckPhase> phases,
                     std::span<const Matrix6> content_stiffness) {
  for (const VoxelContent& content : cell.contents)
    for (const Portion& portion : content.portions)
      if (portion.phase >= phases.size())
        throw std::invalid_argument("a voxel holds a phase that is not named");
  for (const std::uint16_t content : cell.content)
    if (content_stiffness[content].isZero()) throw std::invalid_argument("a voxel is a void");
  const NodeGrid grid{cell.count};
  std::string out =
      "** Unit cell as voxels. mm, MPa. Steps: unit strains 11, 22, 33, 23, 13, 12 (engineering).\n";
  add_nodes(out, grid, cell.edges);
  add_elements(out, grid, cell);
  add_phases(out, phases);
  add_sections(out, cell, phases, content_stiffness);
  add_equations(out, grid);
  add_steps(out, grid, cell.edges);
  return out;
}

std::string ccx_deck(const WeaveSpec& weave, double shear_angle, const SolidSpec& spec) {
  if (Problems problems = check(spec); !problems.empty()) throw InputError(std::move(problems));
  const FabricGeometry fabric = fabric_geometry(weave, CellState::consolidated);
  const WovenSolid solid = woven_solid(fabric.weave, pressed(fabric, shear_angle), weave.fibre_modulus, spec);
  const TransverseIsotropy resin{spec.resin.modulus, spec.resin.modulus, spec.resin.shear(),
                                 spec.resin.shear(), spec.resin.poisson};
  const std::vector<DeckPhase> phases{{"RESIN", resin}, {"WARP", solid.tows[0]}, {"WEFT", solid.tows[1]}};
  return ccx_deck(solid.cell, phases, solid.stiffness);
}

Matrix6 stiffness_from_ccx(const std::string& dat, const std::string& file, const Eigen::Matrix3d& edges) {
  Matrix6 compliance = Matrix6::Zero();  // [1/MPa]
  const Eigen::Matrix3d inverse = (to_mm * edges).inverse();
  Eigen::Matrix3d moved;
  std::istringstream lines(dat);
  int step = 0, axis = 3;
  for (std::string line; std::getline(lines, line);) {
    if (line.find("displacements (vx,vy,vz) for set DRIVERS") != std::string::npos) {
      if (axis != 3 || step == 6) break;
      ++step, axis = 0;
      continue;
    }
    int node = 0;
    std::istringstream words(line);
    Eigen::Vector3d u;
    if (axis == 3 || !(words >> node >> u[0] >> u[1] >> u[2])) continue;
    moved.col(axis++) = u;
    if (axis < 3) continue;
    const Eigen::Matrix3d gradient = moved * inverse;
    for (int row = 0; row < 6; ++row) {
      const auto [a, b] = voigt_axes[static_cast<std::size_t>(row)];
      compliance(row, step - 1) = a == b ? gradient(a, a) : gradient(a, b) + gradient(b, a);
    }
  }
  if (step != 6 || axis != 3)
    throw InputError(
        {{"ccx.displacements"_rule, "", "",
          fmt::format("holds {} whole steps of three drivers instead of six", axis == 3 ? step : step - 1),
          "Run ccx on the deck that heddle wrote, to its end.", file}});
  return compliance.inverse() / to_mpa;
}

}  // namespace heddle::mesoscale::solid
