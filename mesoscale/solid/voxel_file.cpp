#include "mesoscale/solid/voxel_file.h"

#include <fmt/format.h>

#include <algorithm>
#include <set>

#include "core/text_file.h"
#include "mesoscale/solid/texgen_file.h"

namespace heddle::mesoscale::solid {

namespace {

std::size_t voxels_of(const std::array<int, 3>& shape) {
  return static_cast<std::size_t>(shape[0]) * static_cast<std::size_t>(shape[1]) *
         static_cast<std::size_t>(shape[2]);
}

void check_moduli(Problems& problems, const VoxelFileSpec& spec) {
  for (const auto& [label, moduli] : spec.phases) {
    const bool nothing = moduli.bulk == 0.0 && moduli.shear == 0.0;
    if (nothing || (moduli.bulk > 0.0 && moduli.shear > 0.0)) continue;
    const std::string block = fmt::format("cell.phases.{}", label);
    problems.push_back({"cell.phases.*.void"_family.of(std::to_string(label)),
                        block + ".bulk_modulus",
                        fmt::format("{:g} MPa", 1e-6 * moduli.bulk),
                        "must be above zero together with shear_modulus, or zero together with it",
                        "A void has neither; a material without shear stiffness is no solid.",
                        "",
                        0,
                        {block + ".shear_modulus"}});
  }
}

void check_numbers(Problems& problems, const VoxelFileSpec& spec) {
  const bool shaped =
      std::all_of(spec.shape.begin(), spec.shape.end(), [](int n) { return n >= 1 && n <= 4096; });
  if (!shaped)
    problems.push_back({"*.range"_family.of("cell.voxels.shape"), "cell.voxels.shape", "",
                        "must be three whole numbers from 1 to 4096", "Voxels along x, y and z."});
  const bool sized =
      std::all_of(spec.size.begin(), spec.size.end(), [](double l) { return l > 0.0 && l < 10.0; });
  if (!sized)
    problems.push_back({"*.range"_family.of("cell.voxels.size"), "cell.voxels.size", "",
                        "must be three lengths above 0 and below 10 m",
                        "Edges of the cell along x, y and z."});
  check_moduli(problems, spec);
}

// Labels in the order of the file, or what is wrong with it.
std::vector<std::uint16_t> labels_of(const VoxelFileSpec& spec, Problems& problems) {
  const std::string bytes = read_text_file(spec.file);
  const std::size_t voxels = voxels_of(spec.shape);
  std::vector<std::uint16_t> labels(voxels);
  if (bytes.size() == voxels) {
    std::transform(bytes.begin(), bytes.end(), labels.begin(),
                   [](char c) { return static_cast<std::uint16_t>(static_cast<unsigned char>(c)); });
  } else if (bytes.size() == 2 * voxels) {
    for (std::size_t v = 0; v < voxels; ++v) {
      const unsigned low = static_cast<unsigned char>(bytes[2 * v]),
                     high = static_cast<unsigned char>(bytes[2 * v + 1]);
      labels[v] = static_cast<std::uint16_t>(low + 256U * high);
    }
  } else {
    problems.push_back(
        {"cell.voxels.file.size"_rule,
         "cell.voxels.file",
         spec.file.filename().string(),
         fmt::format("must hold {} x {} x {} = {} labels of one or two bytes, but has {} bytes",
                     spec.shape[0], spec.shape[1], spec.shape[2], voxels, bytes.size()),
         "Check the shape; the file has no head.",
         "",
         0,
         {"cell.voxels.shape"}});
    labels.clear();
  }
  return labels;
}

void check_labels(Problems& problems, const VoxelFileSpec& spec, const std::vector<std::uint16_t>& labels) {
  const std::set<int> found(labels.begin(), labels.end());
  bool solid = labels.empty();
  for (const int label : found) {
    const auto phase = spec.phases.find(label);
    if (phase != spec.phases.end()) {
      solid = solid || phase->second.shear > 0.0;
      continue;
    }
    problems.push_back({"cell.phases.missing"_rule,
                        "cell.phases",
                        "",
                        fmt::format("has no phase {}, which the voxel file holds", label),
                        fmt::format("Add {}: {{bulk_modulus: ..., shear_modulus: ...}}.", label),
                        "",
                        0,
                        {"cell.voxels.file"}});
    solid = true;
  }
  if (!solid)
    problems.push_back({"cell.phases.solid"_rule, "cell.phases", "", "leaves nothing but voids in the cell",
                        "Give the moduli of at least one label of the file."});
}

}  // namespace

Problems check(const VoxelFileSpec& spec) {
  Problems problems;
  if (spec.format == VoxelFormat::texgen) {
    check_moduli(problems, spec);
    for (Problem& problem : check_texgen(spec)) problems.push_back(std::move(problem));
    return problems;
  }
  check_numbers(problems, spec);
  if (!problems.empty()) return problems;
  check_labels(problems, spec, labels_of(spec, problems));
  return problems;
}

ReadVoxels read_voxels(const VoxelFileSpec& spec) {
  if (spec.format == VoxelFormat::texgen) return read_texgen(spec);
  Problems problems;
  check_numbers(problems, spec);
  if (!problems.empty()) throw InputError(std::move(problems));
  const std::vector<std::uint16_t> labels = labels_of(spec, problems);
  check_labels(problems, spec, labels);
  if (!problems.empty()) throw InputError(std::move(problems));

  ReadVoxels read;
  VoxelCell& cell = read.cell;
  cell.count = spec.shape;
  cell.edges = Eigen::Vector3d(spec.size[0], spec.size[1], spec.size[2]).asDiagonal();
  std::map<int, std::uint16_t> index;
  for (const auto& [label, moduli] : spec.phases) {
    index[label] = static_cast<std::uint16_t>(read.phases.size());
    cell.contents.push_back({{{index[label], 0, 1.0}}, Eigen::Vector3d::UnitZ()});
    read.phases.push_back(isotropic_stiffness(moduli.bulk, moduli.shear));
  }
  const auto [nx, ny, nz] = spec.shape;
  cell.content.resize(labels.size());
  for (int z = 0; z < nz; ++z)
    for (int y = 0; y < ny; ++y)
      for (int x = 0; x < nx; ++x) {
        const std::size_t to = (static_cast<std::size_t>(z) * ny + y) * nx + x;
        const std::size_t from =
            spec.order == AxisOrder::x_fastest ? to : (static_cast<std::size_t>(x) * ny + y) * nz + z;
        cell.content[to] = index.at(labels[from]);
      }
  return read;
}

}  // namespace heddle::mesoscale::solid
