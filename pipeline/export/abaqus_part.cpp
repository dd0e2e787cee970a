#include "pipeline/export/abaqus_part.h"

#include <fmt/format.h>

#include "pipeline/export/keyword_text.h"

namespace heddle::pipeline {

namespace {

constexpr double shear_correction = 5.0 / 6.0;  // of a plate of one material (Reissner)

std::string abaqus_head(const PartModel& model) {
  return fmt::format(
      "** heddle: the formed part {}, solid. Units: mm, N, MPa, tonne, degC.\n"
      "** Not run in Abaqus. Try first: one cell alone, held at six freedoms and warmed by a kelvin, must "
      "end\n"
      "** without section forces; if it does not, the sign of the last line but one of its section is the "
      "other.\n"
      "** Sections: [A B; B D] and thermal forces of each cell, 1 along the warp, 3 normal to the cell.\n"
      "** Free of stress at {:.1f} degC ({}), cooled to {:.1f} degC ({}).\n",
      model.name, celsius(model.stress_free), model.stress_free.source, celsius(model.room),
      model.room.source);
}

// Columns of the upper half of [A B; B D], thermal forces, and both as they are (scaled by one).
std::string section(const PartModel& model, std::size_t f) {
  const CellStiffness& cell = model.cell_of(f);
  const auto unit = [](int row, int column) {  // N/mm, N and N mm
    return row < 3 && column < 3 ? 1e-3 : row < 3 || column < 3 ? 1.0 : 1e3;
  };
  std::vector<double> stiffness, thermal;
  for (int column = 0; column < 6; ++column)
    for (int row = 0; row <= column; ++row) stiffness.push_back(unit(row, column) * cell.plate(row, column));
  for (int row = 0; row < 6; ++row) thermal.push_back((row < 3 ? 1e-3 : 1.0) * cell.expansion[row]);
  const double shear = 1e-3 * shear_correction * model.thickness[f];
  return fmt::format("*SHELL GENERAL SECTION, ELSET=E{0}, ORIENTATION=O{0}, DENSITY={1:.10g}, ZERO={2:.9g}\n",
                     f + 1, 1e-9 * model.mass[f] / model.area[f], celsius(model.stress_free)) +
         data_lines(stiffness) + data_lines(thermal) + "1., 1.\n" +
         fmt::format("*TRANSVERSE SHEAR\n{:.10g}, {:.10g}, {:.10g}\n", shear * cell.stack(4, 4),
                     shear * cell.stack(3, 3), shear * cell.stack(3, 4));
}

}  // namespace

std::string abaqus_part(const PartModel& model) {
  const auto number = [](int node) { return node + 1; };
  std::string out = abaqus_head(model) + "*NODE, NSET=PART\n";
  for (std::size_t n = 0; n < model.mesh.position.size(); ++n) {
    const auto& x = model.mesh.position[n];
    out += fmt::format("{}, {:.9g}, {:.9g}, {:.9g}\n", n + 1, 1e3 * x[0], 1e3 * x[1], 1e3 * x[2]);
  }
  const std::size_t faces = model.mesh.faces.size();
  for (std::size_t f = 0; f < faces; ++f) {
    const PartFace& face = model.mesh.faces[f];
    out += fmt::format("*ELEMENT, TYPE={}, ELSET=E{}\n{}", face.count == 4 ? "S4" : "S3", f + 1, f + 1);
    for (int k = 0; k < face.count; ++k)
      out += fmt::format(", {}", number(face.corners[static_cast<std::size_t>(k)]));
    out += "\n";
  }
  out += fmt::format("*ELSET, ELSET=PART, GENERATE\n1, {}, 1\n", faces);
  std::vector<int> edge;
  for (const auto& side : free_sides(model.mesh))
    for (const int node : side) edge.push_back(number(node));
  out += set_lines("*NSET, NSET=EDGE", std::move(edge));
  for (std::size_t f = 0; f < faces; ++f)
    out += orientation_lines(fmt::format("O{}", f + 1), model.cell_of(f)) + "3, 0.\n" + section(model, f);
  return out +
         fmt::format("*INITIAL CONDITIONS, TYPE=TEMPERATURE\nPART, {:.9g}\n", celsius(model.stress_free)) +
         support_lines(model, number) +
         fmt::format(
             "** Springs in as it cools. Loads go below *TEMPERATURE, or into a further step.\n"
             "*STEP\n*STATIC\n*TEMPERATURE\nPART, {:.9g}\n*OUTPUT, FIELD\n*NODE OUTPUT\nU\n"
             "*ELEMENT OUTPUT\nSF, SE\n*OUTPUT, HISTORY\n*NODE OUTPUT, NSET=SUPPORTS\nRF\n*END STEP\n",
             celsius(model.room));
}

}  // namespace heddle::pipeline
