#include "pipeline/solid_keys.h"

#include <algorithm>
#include <cmath>

#include <fmt/format.h>

#include "pipeline/key_table.h"

namespace heddle::pipeline {
namespace {

namespace solid = mesoscale::solid;

constexpr const char* cases_help =
    "Load cases solved side by side: 2 takes 0.4 of the memory of 6, and more time, for cells that do not "
    "fit.";
constexpr int labels = 16;  // that a voxel file may hold: a schema lists its keys

std::string phase_block(int label) {
  return fmt::format("cell.phases.{}", label);
}

template <class Value>
void take(const Settings& settings, const std::string& path, Value& value) {
  if (!settings.has(path)) return;
  if constexpr (std::is_same_v<Value, int>)
    value = settings.integer(path);
  else
    value = settings.number(path);
}

}  // namespace

// A table reads better in rows than one field a line.
// clang-format off
std::vector<Key> solid_keys() {
  const auto stage = Stage::solid;
  return {
      {.path = "solid.per_pitch", .type = KeyType::integer, .presence = defaulted, .default_text = "32",
       .range = "[4, 512]", .stage = stage,
       .help = "Voxels along one pitch of the consolidated weave, whose stiffness is homogenised."},
      {.path = "solid.layers", .type = KeyType::integer, .presence = defaulted, .default_text = "32",
       .range = "[2, 512]", .stage = stage, .help = "Voxels over its thickness."},
      {.path = "solid.tow_model", .type = KeyType::choice, .presence = defaulted, .default_text = "chamis",
       .choices = {"chamis", "hashin"}, .stage = stage,
       .help = "Elastic constants of a tow from those of fibre and resin."},
      {.path = "solid.fibre_poisson", .type = KeyType::quantity, .presence = defaulted, .default_text = "0.22",
       .range = "(-1, 0.5)", .stage = stage,
       .help = "Poisson's ratio of the fibre; prior: E-glass. Its modulus is weave.fibre_modulus."},
      {.path = "solid.resin_modulus", .type = KeyType::quantity, .unit = "GPa", .presence = defaulted,
       .default_text = "1.5 GPa", .range = "(0 GPa, 1000 GPa]", .stage = stage,
       .help = "Young's modulus of the solid resin; prior: polypropylene at room temperature."},
      {.path = "solid.resin_poisson", .type = KeyType::quantity, .presence = defaulted, .default_text = "0.4",
       .range = "(-1, 0.49)", .stage = stage, .help = "Its Poisson's ratio; prior: polypropylene."},
      {.path = "solid.fibre_expansion", .type = KeyType::quantity, .unit = "1/K", .presence = defaulted,
       .default_text = "5e-6 1/K", .range = "[-0.01 1/K, 0.01 1/K]", .stage = stage,
       .help = "Linear thermal expansion of the fibre; prior: E-glass."},
      {.path = "solid.resin_expansion", .type = KeyType::quantity, .unit = "1/K", .presence = defaulted,
       .default_text = "1.2e-4 1/K", .range = "[-0.01 1/K, 0.01 1/K]", .stage = stage,
       .help = "Of the solid resin; prior: polypropylene."},
      {.path = "solid.shear_angles", .type = KeyType::list, .unit = "deg", .presence = Presence::optional,
       .range = "[-60 deg, 60 deg]", .stage = stage,
       .help = "Trellis angles at which the stiffness is tabled as well, for instance [0 deg, 15 deg, 30 deg, 45 deg]."},
      {.path = "solid.load_cases_at_once", .type = KeyType::choice, .presence = defaulted, .default_text = "6",
       .choices = {"6", "2"}, .stage = stage, .help = cases_help},
  };
}

std::vector<Key> voxel_keys() {
  const auto stage = Stage::voxels;
  const std::string texgen = "cell.voxels.format=texgen", labelled = "cell.voxels.format=labels";
  std::vector<Key> keys{
      {.path = "cell.voxels.file", .type = KeyType::file, .presence = required, .stage = stage,
       .help = "Labels of one or two bytes (little endian) without a head, or TexGen's .inp: a cell of its own, no weave beside it."},
      {.path = "cell.voxels.format", .type = KeyType::choice, .presence = Presence::defaulted, .default_text = "labels",
       .choices = {"labels", "texgen"}, .stage = stage,
       .help = "texgen: a voxel deck as TexGen exports it for Abaqus, with its own shape, size and tows."},
      {.path = "cell.voxels.orientations", .type = KeyType::file, .presence = required, .stage = stage,
       .used_when = texgen, .help = "The .ori file that TexGen writes beside the deck: fibre directions of its elements."},
      {.path = "cell.voxels.length_unit", .type = KeyType::quantity, .unit = "mm", .presence = Presence::defaulted,
       .default_text = "1 mm", .range = "(0 mm, 1000 mm]", .stage = stage, .used_when = texgen,
       .help = "Of the deck's coordinates."},
      {.path = "cell.voxels.shape", .type = KeyType::list, .presence = required, .range = "[1, 4096]", .stage = stage, .used_when = labelled,
       .help = "Voxels along x (warp), y (weft) and z (thickness), for instance [64, 64, 64]."},
      {.path = "cell.voxels.size", .type = KeyType::list, .unit = "mm", .presence = required,
       .range = "(0 mm, 10000 mm)", .stage = stage, .used_when = labelled, .help = "Edges of the cell along x, y and z."},
      {.path = "cell.voxels.order", .type = KeyType::choice, .presence = required,
       .choices = {"x-fastest", "z-fastest"}, .stage = stage, .used_when = labelled,
       .help = "Which index runs fastest in the file. No default: read in the wrong order a weave has wrong moduli."},
      {.path = "cell.boundary", .type = KeyType::choice, .presence = required, .choices = {"periodic", "plate"},
       .stage = stage,
       .help = "periodic: a stack without end, C; plate: free faces across z, A, B and D."},
      {.path = "cell.voxels.load_cases_at_once", .type = KeyType::choice, .presence = Presence::defaulted, .default_text = "6",
       .choices = {"6", "2"}, .stage = stage, .help = cases_help},
  };
  for (const auto& [name, what] : {std::pair{"axial_modulus", "Young's modulus along the fibres of TexGen's yarns."},
                                   {"transverse_modulus", "Across them."},
                                   {"axial_shear", "Shear modulus along the fibres."},
                                   {"transverse_shear", "Shear modulus across them."}})
    keys.push_back({.path = fmt::format("cell.tow.{}", name), .type = KeyType::quantity, .unit = "GPa", .presence = required,
                    .range = "(0 GPa, 10000 GPa]", .stage = stage, .used_when = texgen, .help = what});
  keys.push_back({.path = "cell.tow.axial_poisson", .type = KeyType::quantity, .presence = required, .range = "(-1, 1)",
                  .stage = stage, .used_when = texgen, .help = "Contraction across under load along the fibres."});
  for (int label = 0; label < labels; ++label) {
    const std::string block = phase_block(label);
    for (const auto& [name, what] : {std::pair{"bulk_modulus", "Bulk"}, std::pair{"shear_modulus", "Shear"}})
      keys.push_back({.path = fmt::format("{}.{}", block, name), .type = KeyType::quantity, .unit = "MPa",
                      .presence = required, .range = "[0 MPa, 1e7 MPa]", .stage = stage, .used_when = block,
                      .help = fmt::format("{} modulus of the voxels labelled {}; both zero: a void.", what, label)});
  }
  return keys;
}
// clang-format on

solid::SolidSpec solid_of(const Settings& settings) {
  solid::SolidSpec spec;
  take(settings, "solid.per_pitch", spec.grid.per_pitch);
  take(settings, "solid.layers", spec.grid.layers);
  if (settings.is("solid.tow_model", "hashin")) spec.tow_model = solid::TowModel::hashin;
  take(settings, "solid.fibre_poisson", spec.fibre_poisson);
  take(settings, "solid.resin_modulus", spec.resin.modulus);
  take(settings, "solid.resin_poisson", spec.resin.poisson);
  take(settings, "solid.fibre_expansion", spec.fibre_expansion);
  take(settings, "solid.resin_expansion", spec.resin_expansion);
  if (settings.is("solid.load_cases_at_once", "2")) spec.solver.cases = solid::pair_of_loads;
  if (settings.has("solid.shear_angles")) spec.shear_angles = settings.many("solid.shear_angles");
  return spec;
}

solid::VoxelFileSpec voxels_of(const Settings& settings, const std::filesystem::path& folder) {
  solid::VoxelFileSpec spec;
  if (settings.has("cell.voxels.file")) spec.file = folder / settings.text("cell.voxels.file");
  // What is not three numbers, or not whole ones, is left at zero: the room's own rule names it.
  if (settings.has("cell.voxels.shape"))
    if (const auto& shape = settings.many("cell.voxels.shape"); shape.size() == 3)
      for (std::size_t i = 0; i < 3; ++i)
        spec.shape[i] = shape[i] == std::floor(shape[i]) ? static_cast<int>(shape[i]) : 0;
  if (settings.has("cell.voxels.size"))
    if (const auto& size = settings.many("cell.voxels.size"); size.size() == 3)
      std::copy(size.begin(), size.end(), spec.size.begin());
  if (settings.is("cell.voxels.format", "texgen")) {
    spec.format = solid::VoxelFormat::texgen;
    if (settings.has("cell.voxels.orientations"))
      spec.orientations = folder / settings.text("cell.voxels.orientations");
    take(settings, "cell.voxels.length_unit", spec.length_unit);
    take(settings, "cell.tow.axial_modulus", spec.tow.axial_modulus);
    take(settings, "cell.tow.transverse_modulus", spec.tow.transverse_modulus);
    take(settings, "cell.tow.axial_shear", spec.tow.axial_shear);
    take(settings, "cell.tow.transverse_shear", spec.tow.transverse_shear);
    take(settings, "cell.tow.axial_poisson", spec.tow.axial_poisson);
  }
  if (settings.is("cell.voxels.order", "z-fastest")) spec.order = solid::AxisOrder::z_fastest;
  if (settings.is("cell.voxels.load_cases_at_once", "2")) spec.cases = solid::pair_of_loads;
  spec.faces = settings.is("cell.boundary", "plate") ? solid::Faces::free : solid::Faces::periodic;
  for (int label = 0; label < labels; ++label) {
    const std::string block = phase_block(label);
    if (settings.blocks.count(block) == 0) continue;
    take(settings, block + ".bulk_modulus", spec.phases[label].bulk);
    take(settings, block + ".shear_modulus", spec.phases[label].shear);
  }
  return spec;
}

}  // namespace heddle::pipeline
