#include "mesoscale/cell.h"

#include <algorithm>
#include <cmath>
#include <limits>

namespace heddle::mesoscale {

namespace {

CrossingGeometry crossing_of(double pitch, double width, double thickness, double fibre_fraction) {
  const LensSection section{width, thickness};
  return {0.0, pitch, section, arc_path(pitch, thickness, section.radius() + 0.5 * thickness),
          fibre_fraction};
}

struct Along {
  int crossing;  ///< index of the crossing before the point
  double from;   ///< distance from it, in [0, p)
};

Along locate(double along, double pitch) {
  const double before = std::floor(along / pitch);
  return {static_cast<int>(before), along - before * pitch};
}

// Between two crossings a tow goes from its side at the first to its side at the second.
double centre_between(const UnitCell& cell, bool first_above, bool second_above, double from) {
  const double half = 0.5 * cell.crimp_height();
  if (first_above == second_above) return first_above ? half : -half;
  const double fallen = half - drop(cell.path, from);
  return first_above ? fallen : -fallen;
}

}  // namespace

FabricGeometry fabric_geometry(const WeaveSpec& weave, CellState state) {
  if (Problems problems = check_pattern(weave.pattern); !problems.empty())
    throw InputError(std::move(problems));
  FabricGeometry fabric;
  fabric.weave = parse_weave(weave.pattern).weave;
  fabric.quarters = quarter_shares(fabric.weave);
  fabric.interlacing = interlacing(fabric.weave);
  fabric.as_woven_crimp = as_woven_crimp(weave, 0.5 * (fabric.interlacing[0] + fabric.interlacing[1]));
  fabric.mass = mass_balance(weave, fabric.as_woven_crimp);

  const bool woven = state == CellState::as_woven;
  fabric.thickness = woven ? weave.fabric_thickness : fabric.mass.consolidated_thickness;
  const double thickness = woven ? weave.tow_thickness : 0.5 * fabric.thickness;
  const double section_area = LensSection{weave.tow_width, thickness}.area();
  const double solid_area = fabric.mass.glass_area + fabric.mass.resin_area;
  fabric.tow_solid_fraction = section_share(solid_area, fabric.as_woven_crimp, section_area);
  fabric.crossing = crossing_of(weave.tow_width + weave.gap, weave.tow_width, thickness,
                                section_share(fabric.mass.glass_area, fabric.as_woven_crimp, section_area));
  return fabric;
}

double gap_closure_angle(const CrossingGeometry& unsheared) {
  return std::acos(std::min(unsheared.section.width / unsheared.pitch, 1.0));
}

OpenWidth oblique_width(const CrossingGeometry& unsheared, double shear_angle) {
  const double pitch = unsheared.pitch, free = unsheared.section.width / pitch;
  const double x = free / std::cos(shear_angle);
  const double dx_dg = x * std::tan(shear_angle);
  // A gapless weave is in contact from the start, so its scatter would change the as-woven tow: half the gap
  // at most.
  const double scatter = std::min(width_scatter, 0.5 * (1.0 - free));
  if (x <= 1.0 - scatter) return {pitch * x, pitch * dx_dg};
  if (x >= 1.0 + scatter) return {pitch, 0.0};
  const double into = x - 1.0 + scatter;
  return {pitch * (x - into * into / (4.0 * scatter)), pitch * dx_dg * (1.0 - into / (2.0 * scatter))};
}

CrossingGeometry sheared(const CrossingGeometry& unsheared, double shear_angle) {
  const double width = oblique_width(unsheared, shear_angle).width;
  const double free_width = unsheared.section.width / std::cos(shear_angle);
  CrossingGeometry crossing = crossing_of(unsheared.pitch, width, unsheared.section.thickness,
                                          unsheared.fibre_fraction * free_width / width);
  crossing.shear_angle = shear_angle;
  return crossing;
}

std::array<double, 2> UnitCell::place(double xi, double eta) const {
  return {xi + eta * std::sin(shear_angle), eta * std::cos(shear_angle)};
}

UnitCell unit_cell(const FabricGeometry& fabric, double shear_angle) {
  const CrossingGeometry crossing = sheared(fabric.crossing, shear_angle);
  return {fabric.weave, crossing.pitch, crossing.section, crossing.path, shear_angle};
}

double warp_centre(const UnitCell& cell, int warp, double along) {
  const Along at = locate(along, cell.pitch);
  return centre_between(cell, cell.weave.warp_over(warp, at.crossing),
                        cell.weave.warp_over(warp, at.crossing + 1), at.from);
}

double weft_centre(const UnitCell& cell, int weft, double along) {
  const Along at = locate(along, cell.pitch);
  return centre_between(cell, !cell.weave.warp_over(at.crossing, weft),
                        !cell.weave.warp_over(at.crossing + 1, weft), at.from);
}

Column column(const UnitCell& cell, double xi, double eta) {
  const double half_width = 0.5 * width(cell.section);
  const int warp = static_cast<int>(std::lround(eta / cell.pitch));
  const int weft = static_cast<int>(std::lround(xi / cell.pitch));
  const double across_warp = eta - warp * cell.pitch, across_weft = xi - weft * cell.pitch;
  Column found;
  if (std::abs(across_warp) < half_width) {
    const double centre = warp_centre(cell, warp, xi), half = half_height(cell.section, across_warp);
    found.warp = true;
    found.warp_top = centre + half;
    found.warp_bottom = centre - half;
  }
  if (std::abs(across_weft) < half_width) {
    const double centre = weft_centre(cell, weft, eta), half = half_height(cell.section, across_weft);
    found.weft = true;
    found.weft_top = centre + half;
    found.weft_bottom = centre - half;
  }
  return found;
}

Penetration penetration(const UnitCell& cell, int samples_per_pitch) {
  const double step = cell.pitch / samples_per_pitch;
  // dxi deta above one sample; cos g turns it into true area.
  const double patch = step * step * std::cos(cell.shear_angle);
  Penetration worst{-std::numeric_limits<double>::infinity(), 0.0, 0.0};
  for (int i = 0; i < samples_per_pitch * cell.weave.warps; ++i)
    for (int j = 0; j < samples_per_pitch * cell.weave.wefts; ++j) {
      // Samples stand on the crossings too: there lens tows touch, and elsewhere they are apart.
      const Column c = column(cell, j * step, i * step);
      if (c.warp) worst.tow_volume += patch * (c.warp_top - c.warp_bottom);
      if (c.weft) worst.tow_volume += patch * (c.weft_top - c.weft_bottom);
      if (!c.warp || !c.weft) continue;
      const double overlap = std::min(c.warp_top, c.weft_top) - std::max(c.warp_bottom, c.weft_bottom);
      worst.depth = std::max(worst.depth, overlap);
      worst.volume += patch * std::max(overlap, 0.0);
    }
  return worst;
}

HeightField height_field(const UnitCell& cell, int n) {
  const std::array<double, 2> size = cell.size();
  HeightField field;
  field.n = n;
  field.along_warp = cell.place(size[0], 0.0);
  field.along_weft = cell.place(0.0, size[1]);
  const std::size_t count = static_cast<std::size_t>(n) * n;
  field.top.assign(count, 0.0);
  field.bottom.assign(count, 0.0);
  field.covered.assign(count, 0);
  for (int i = 0; i < n; ++i)
    for (int j = 0; j < n; ++j) {
      const Column c = column(cell, (j + 0.5) * size[0] / n, (i + 0.5) * size[1] / n);
      if (!c.warp && !c.weft) continue;
      const std::size_t k = static_cast<std::size_t>(i) * n + j;
      field.covered[k] = 1;
      field.top[k] = !c.weft ? c.warp_top : !c.warp ? c.weft_top : std::max(c.warp_top, c.weft_top);
      field.bottom[k] = !c.weft   ? c.warp_bottom
                        : !c.warp ? c.weft_bottom
                                  : std::min(c.warp_bottom, c.weft_bottom);
    }
  return field;
}

}  // namespace heddle::mesoscale
