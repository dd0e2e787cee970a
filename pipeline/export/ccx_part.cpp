#include "pipeline/export/ccx_part.h"

#include <algorithm>
#include <map>
#include <numeric>
#include <utility>

#include <fmt/format.h>
#include <Eigen/Core>

#include "pipeline/export/keyword_text.h"

namespace heddle::pipeline {

namespace {

using Eigen::Vector3d;

// Levels of the nodes over a point of the middle surface: faces of the layers, and the middles between them.
constexpr int levels = 7, middle_level = 3, interfaces = 4;

int number_at(int node, int level) {
  return levels * node + 1 + level;
}

// Nodes and bricks of the three layers.
class Bricks {
 public:
  Bricks(const PartModel& model, double middle_share) : model_(model) {
    const double inner = 0.5 * middle_share;
    heights_ = {-0.5, -0.25 - 0.5 * inner, -inner, 0.0, inner, 0.25 + 0.5 * inner, 0.5};
    for (const PartFace& face : model.mesh.faces)
      for (int k = 0; k < face.count; ++k) {
        const auto side = side_of(face, k);
        if (sides_.count(side) == 0) sides_.emplace(side, static_cast<int>(sides_.size()));
      }
  }

  std::string nodes() const {
    std::string out = "*NODE, NSET=PART\n";
    const auto add = [&](int number, const Vector3d& x) {
      out += fmt::format("{}, {:.9g}, {:.9g}, {:.9g}\n", number, 1e3 * x[0], 1e3 * x[1], 1e3 * x[2]);
    };
    for (int n = 0; n < static_cast<int>(model_.mesh.position.size()); ++n)
      for (int level = 0; level < levels; ++level) add(number_at(n, level), at(n, level));
    std::vector<std::array<int, 2>> in_order(sides_.size());
    for (const auto& [side, index] : sides_) in_order[static_cast<std::size_t>(index)] = side;
    for (std::size_t s = 0; s < in_order.size(); ++s)
      for (int face = 0; face < interfaces; ++face)
        add(number_on(static_cast<int>(s), face),
            0.5 * (at(in_order[s][0], 2 * face) + at(in_order[s][1], 2 * face)));
    return out;
  }

  // Corners below, corners above, middles of the sides below, above, then of the uprights.
  std::string brick(std::size_t f, int layer) const {
    const PartFace& face = model_.mesh.faces[f];
    std::vector<int> nodes;
    for (const int up : {0, 1})
      for (int k = 0; k < face.count; ++k)
        nodes.push_back(number_at(face.corners[static_cast<std::size_t>(k)], 2 * (layer + up)));
    for (const int up : {0, 1})
      for (int k = 0; k < face.count; ++k)
        nodes.push_back(number_on(sides_.at(side_of(face, k)), layer + up));
    for (int k = 0; k < face.count; ++k)
      nodes.push_back(number_at(face.corners[static_cast<std::size_t>(k)], 2 * layer + 1));
    std::string out = fmt::format("{}", element_number(f, layer));
    for (std::size_t k = 0; k < nodes.size(); ++k)
      out += fmt::format("{}{}", k == 14 && face.count == 4 ? ",\n " : ", ", nodes[k]);
    return out + "\n";
  }

  static int element_number(std::size_t f, int layer) { return 3 * static_cast<int>(f) + layer + 1; }

 private:
  static std::array<int, 2> side_of(const PartFace& face, int k) {
    const int a = face.corners[static_cast<std::size_t>(k)],
              b = face.corners[static_cast<std::size_t>((k + 1) % face.count)];
    return {std::min(a, b), std::max(a, b)};
  }
  int number_on(int side, int face) const {
    return number_at(static_cast<int>(model_.mesh.position.size()), 0) + interfaces * side + face;
  }
  Vector3d at(int node, int level) const {
    const auto n = static_cast<std::size_t>(node);
    return Vector3d(model_.mesh.position[n].data()) +
           heights_[static_cast<std::size_t>(level)] * Vector3d(model_.director[n].data());
  }

  const PartModel& model_;
  std::array<double, levels> heights_{};  // over the thickness
  std::map<std::array<int, 2>, int> sides_;
};

// The 21 constants go by columns of the upper half, in the order 11, 22, 33, 12, 13, 23 [MPa]; shears of the
// expansion are those of the strain tensor, half of the engineering ones.
std::string material(const std::string& name, const mesoscale::solid::Matrix6& c,
                     const mesoscale::solid::Vector6& expansion, double density, double zero) {
  constexpr std::array<int, 6> order{0, 1, 2, 5, 4, 3};
  std::vector<double> constants;
  for (std::size_t column = 0; column < 6; ++column)
    for (std::size_t row = 0; row <= column; ++row) constants.push_back(1e-6 * c(order[row], order[column]));
  std::string out = fmt::format("*MATERIAL, NAME={}\n*ELASTIC, TYPE=ANISO\n{}", name, data_lines(constants));
  out += fmt::format("*EXPANSION, TYPE=ANISO, ZERO={:.9g}\n", zero);
  out += data_lines(
      {expansion[0], expansion[1], expansion[2], 0.5 * expansion[5], 0.5 * expansion[4], 0.5 * expansion[3]});
  return out + fmt::format("*DENSITY\n{:.10g}\n", 1e-12 * density);
}

std::string ccx_head(const PartModel& model) {
  return fmt::format(
      "** heddle: the formed part {}, solid. Units: mm, N, MPa, tonne, degC.\n"
      "** Three layers of bricks a cell; together they have the cell's A, B, D and thermal resultants.\n"
      "** Orientations: 1 along the warp, 3 normal to the cell.\n"
      "** Free of stress at {:.1f} degC ({}), cooled to {:.1f} degC ({}).\n"
      "** SUPPORTS hold the part at six freedoms (3-2-1): their reactions are zero as long as nothing else "
      "presses on it.\n",
      model.name, celsius(model.stress_free), model.stress_free.source, celsius(model.room),
      model.room.source);
}

std::string sets(const PartModel& model) {
  const int faces = static_cast<int>(model.mesh.faces.size());
  std::string out = fmt::format("*ELSET, ELSET=PART, GENERATE\n1, {}, 1\n", 3 * faces);
  for (int layer = 1; layer <= 3; ++layer)
    out += fmt::format("*ELSET, ELSET=LAYER{}, GENERATE\n{}, {}, 3\n", layer, layer, 3 * (faces - 1) + layer);
  std::vector<int> beyond, middle, edge;
  for (std::size_t f = 0; f < model.mesh.faces.size(); ++f)
    for (int layer = 0; layer < 3; ++layer)
      if (model.cell_of(f).beyond_table) beyond.push_back(Bricks::element_number(f, layer));
  for (std::size_t n = 0; n < model.mesh.position.size(); ++n)
    middle.push_back(ccx_middle_node(static_cast<int>(n)));
  for (const auto& side : free_sides(model.mesh))
    for (const int node : side) edge.push_back(ccx_middle_node(node));
  if (!beyond.empty()) out += set_lines("*ELSET, ELSET=BEYOND_TABLE", std::move(beyond));
  return out + set_lines("*NSET, NSET=MIDDLE", std::move(middle)) +
         set_lines("*NSET, NSET=EDGE", std::move(edge));
}

}  // namespace

int ccx_middle_node(int node) {
  return number_at(node, middle_level);
}

std::string ccx_part_body(const PartModel& model) {
  const std::vector<PartLayers> layers = part_layers(model);
  const Bricks bricks(model, layers.front().middle_share);
  std::string out = ccx_head(model) + bricks.nodes();
  for (std::size_t f = 0; f < layers.size(); ++f)
    for (int layer = 0; layer < 3; ++layer)
      out +=
          fmt::format("*ELEMENT, TYPE={}, ELSET=E{}\n{}", model.mesh.faces[f].count == 4 ? "C3D20R" : "C3D15",
                      Bricks::element_number(f, layer), bricks.brick(f, layer));
  out += sets(model);
  for (std::size_t f = 0; f < layers.size(); ++f) {
    const CellStiffness& cell = model.cell_of(f);
    const auto across = mesoscale::solid::free_strain(cell.stack, cell.stack_held);
    const double density = model.mass[f] / (model.area[f] * model.thickness[f]);
    out += orientation_lines(fmt::format("O{}", f + 1), cell);
    for (int layer = 0; layer < 3; ++layer) {
      const auto k = static_cast<std::size_t>(layer);
      const int e = Bricks::element_number(f, layer);
      out += material(fmt::format("M{}", e), solid_of(layers[f].stiffness[k], cell.stack),
                      solid_expansion(layers[f].expansion[k], across), density, celsius(model.stress_free));
      out += fmt::format("*SOLID SECTION, ELSET=E{}, MATERIAL=M{}, ORIENTATION=O{}\n", e, e, f + 1);
    }
  }
  return out +
         fmt::format("*INITIAL CONDITIONS, TYPE=TEMPERATURE\nPART, {:.9g}\n", celsius(model.stress_free));
}

std::string ccx_part_cooling(const PartModel& model) {
  return support_lines(model, ccx_middle_node) +
         fmt::format(
             "** Springs in as it cools. Loads go below *TEMPERATURE, or into a further step: forces by "
             "*CLOAD, a\n"
             "** pressure on the upper face by `*DLOAD` and `LAYER3, P2, 1.` (lower face: LAYER1, P1). "
             "Large\n"
             "** displacements: *STEP, NLGEOM.\n"
             "*STEP\n*STATIC\n*TEMPERATURE\nPART, {:.9g}\n"
             "*NODE FILE\nU\n*EL FILE\nS\n"
             "*NODE PRINT, NSET=MIDDLE\nU\n*NODE PRINT, NSET=SUPPORTS\nRF\n"
             "*EL PRINT, ELSET=PART, TOTALS=ONLY\nELSE\n*END STEP\n",
             celsius(model.room));
}

std::string ccx_part(const PartModel& model) {
  return ccx_part_body(model) + ccx_part_cooling(model);
}

}  // namespace heddle::pipeline
