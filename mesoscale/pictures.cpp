#include "mesoscale/pictures.h"

#include <cmath>

namespace heddle::mesoscale {

namespace {

// One tow as a tube: rings of 2 x across vertices (upper face one way, lower face back, the edges shared).
class TubeBuilder {
 public:
  TubeBuilder(const UnitCell& cell, TowDirection direction, int index, int stations, int across)
      : cell_(cell), direction_(direction), index_(index), stations_(stations), across_(across) {}

  void append_to(TriangleMesh& mesh) const {
    const int first = static_cast<int>(mesh.vertices.size());
    for (int s = 0; s <= stations_; ++s)
      for (int k = 0; k < ring(); ++k) mesh.vertices.push_back(vertex(s, k));
    for (int s = 0; s < stations_; ++s)
      for (int k = 0; k < ring(); ++k) {
        const int a = first + s * ring() + k, b = first + s * ring() + (k + 1) % ring();
        add(mesh, {a, b, a + ring()});
        add(mesh, {b, b + ring(), a + ring()});
      }
    add_cap(mesh, first, false);
    add_cap(mesh, first + stations_ * ring(), true);
  }

 private:
  int ring() const { return 2 * across_; }
  bool is_warp() const { return direction_ == TowDirection::warp; }

  std::array<double, 3> vertex(int station, int k) const {
    const double along = cell_.size()[is_warp() ? 0 : 1] * station / stations_;
    const bool upper = k <= across_;
    const int strip = upper ? k : ring() - k;
    // Even in the angle, so that strips are narrow where the section is thin.
    const UnitCell::Tow& tow = cell_.tow[is_warp() ? 0 : 1];
    const double across = -0.5 * width(tow.section) * std::cos(std::acos(-1.0) * strip / across_);
    const double height = strip == 0 || strip == across_ ? edge_height(tow.section)
                          : upper                        ? upper_face(tow.section, across)
                                                         : lower_face(tow.section, across);
    const double centre = is_warp() ? warp_centre(cell_, index_, along) : weft_centre(cell_, index_, along);
    const double side = index_ * tow.spacing + across;
    const std::array<double, 2> at = is_warp() ? cell_.place(along, side) : cell_.place(side, along);
    return {at[0], at[1], centre + height};
  }

  // Weft runs along eta and is wide along xi: the opposite hand of warp.
  void add(TriangleMesh& mesh, std::array<int, 3> triangle) const {
    if (is_warp()) std::swap(triangle[1], triangle[2]);
    mesh.triangles.push_back(triangle);
  }

  void add_cap(TriangleMesh& mesh, int start, bool at_end) const {
    const auto face = [&](int a, int b, int c) {
      if (at_end) std::swap(b, c);
      add(mesh, {start + a, start + b, start + c});
    };
    for (int k = 0; k < across_; ++k) {
      const int below = (ring() - k) % ring(), below_next = ring() - k - 1;
      if (k > 0) face(k, below, k + 1);
      if (k + 1 < across_) face(k + 1, below, below_next);
    }
  }

  const UnitCell& cell_;
  TowDirection direction_;
  int index_, stations_, across_;
};

// A cut at `across` from the middle of the warp, from `start` on over one repeat.
Outline warp_band(const UnitCell& cell, int warp, double across, double start, int points_per_pitch) {
  Outline band{TowDirection::warp, {}};
  const int steps = points_per_pitch * cell.weave.wefts;
  const Section& section = cell.tow[0].section;
  const double above = upper_face(section, across), below = lower_face(section, across);
  const double pitch = cell.tow[1].spacing;
  for (int k = 0; k <= steps; ++k) {
    const double along = start + pitch * k / points_per_pitch;
    band.points.push_back({along, warp_centre(cell, warp, along) + above});
  }
  for (int k = steps; k >= 0; --k) {
    const double along = start + pitch * k / points_per_pitch;
    band.points.push_back({along, warp_centre(cell, warp, along) + below});
  }
  return band;
}

Outline weft_section(const UnitCell& cell, double eta, int weft, int points_per_pitch) {
  Outline section{TowDirection::weft, {}};
  const Section& shape = cell.tow[1].section;
  const double w = width(shape), centre = weft_centre(cell, weft, eta);
  for (int k = 0; k < 2 * points_per_pitch; ++k) {
    const bool upper = k < points_per_pitch;
    const double share = static_cast<double>(upper ? k : 2 * points_per_pitch - k) / points_per_pitch;
    const double across = w * (share - 0.5);
    const double face = upper ? upper_face(shape, across) : lower_face(shape, across);
    section.points.push_back({weft * cell.tow[1].spacing + across, centre + face});
  }
  return section;
}

}  // namespace

VoxelLabels tow_labels(const UnitCell& cell, int per_pitch, int through) {
  VoxelLabels voxels;
  const int warps = cell.weave.warps;
  const double thickness = 2.0 * cell.crown();
  voxels.count = {per_pitch * cell.weave.wefts, per_pitch * warps, through};
  voxels.spacing = {cell.tow[1].spacing / per_pitch, cell.tow[0].spacing / per_pitch, thickness / through};
  voxels.origin = {0.0, 0.0, -0.5 * thickness};
  const auto [nx, ny, nz] = voxels.count;
  voxels.labels.assign(static_cast<std::size_t>(nx) * ny * nz, 0);
  const auto fill = [&](int i, int j, double bottom, double top, int label) {
    for (int k = 0; k < nz; ++k) {
      const double z = voxels.origin[2] + (k + 0.5) * voxels.spacing[2];
      if (bottom <= z && z <= top)
        voxels.labels[(static_cast<std::size_t>(k) * ny + j) * nx + i] = static_cast<std::uint16_t>(label);
    }
  };
  for (int j = 0; j < ny; ++j)
    for (int i = 0; i < nx; ++i) {
      const double xi = (i + 0.5) * voxels.spacing[0], eta = (j + 0.5) * voxels.spacing[1];
      const Column c = column(cell, xi, eta);
      const int warp = static_cast<int>(std::lround(eta / cell.tow[0].spacing)) % warps;
      const int weft = static_cast<int>(std::lround(xi / cell.tow[1].spacing)) % cell.weave.wefts;
      if (c.warp) fill(i, j, c.warp_bottom, c.warp_top, 1 + warp);
      if (c.weft) fill(i, j, c.weft_bottom, c.weft_top, 1 + warps + weft);
    }
  return voxels;
}

TowSurfaces tow_surfaces(const UnitCell& cell, int along, int across) {
  TowSurfaces surfaces;
  int tow = 0;
  const auto add = [&](TowDirection direction, int index, int stations) {
    TubeBuilder(cell, direction, index, stations, across).append_to(surfaces.mesh);
    surfaces.tow.resize(surfaces.mesh.triangles.size(), ++tow);
  };
  for (int i = 0; i < cell.weave.warps; ++i) add(TowDirection::warp, i, along * cell.weave.wefts);
  for (int j = 0; j < cell.weave.wefts; ++j) add(TowDirection::weft, j, along * cell.weave.warps);
  return surfaces;
}

std::vector<Outline> warp_cut(const UnitCell& cell, int warp, int points_per_pitch) {
  std::vector<Outline> cut{warp_band(cell, warp, 0.0, 0.0, points_per_pitch)};
  // The last weft closes the picture: it is the first of the next repeat.
  for (int j = 0; j <= cell.weave.wefts; ++j)
    cut.push_back(weft_section(cell, warp * cell.tow[0].spacing, j, points_per_pitch));
  return cut;
}

std::vector<Outline> stack_cut(const PlyStack& stack, int points_per_pitch) {
  const UnitCell& cell = stack.ply;
  std::vector<Outline> cut;
  for (std::size_t ply = 0; ply < stack.height.size(); ++ply) {
    const auto [along, across] = stack.shift[ply];
    const auto place = [&](Outline outline) {
      for (auto& point : outline.points) point = {point[0] + along, point[1] + stack.height[ply]};
      cut.push_back(std::move(outline));
    };
    // The plane of the cut and the start of the repeat, as the ply counts them.
    const double eta = -across, start = -along;
    const int warp = static_cast<int>(std::lround(eta / cell.tow[0].spacing));
    const double off = eta - warp * cell.tow[0].spacing;
    if (std::abs(off) < 0.5 * width(cell.tow[0].section))
      place(warp_band(cell, warp, off, start, points_per_pitch));
    const int first = static_cast<int>(std::lround(start / cell.tow[1].spacing));
    for (int weft = first; weft <= first + cell.weave.wefts; ++weft)
      place(weft_section(cell, eta, weft, points_per_pitch));
  }
  return cut;
}

}  // namespace heddle::mesoscale
