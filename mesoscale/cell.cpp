#include "mesoscale/cell.h"

#include <algorithm>
#include <cmath>
#include <limits>
#include <stdexcept>

namespace heddle::mesoscale {

namespace {

CrossingGeometry crossing_of(const std::array<double, 2>& spacing, const std::array<Section, 2>& section,
                             const std::array<double, 2>& fibre_fraction, double asked_excess = 0.0) {
  const double excess = excess_with_room(section, spacing, asked_excess);
  CrossingGeometry crossing;
  for (std::size_t i = 0; i < 2; ++i)
    crossing.tow[i] = {spacing[i], section[i],
                       path_over(section[i], section[1 - i], spacing[1 - i], i == 0 ? excess : -excess),
                       fibre_fraction[i]};
  return crossing;
}

// By how much a crossing's warps rise further than where faces are flush: just nothing where they are.
double excess_of(const CrossingGeometry& crossing) {
  return crossing.tow[0].path.height - thickness(crossing.tow[1].section);
}

// How much further than by the thickness of the tows under it a path may rise.
double room_over(const Section& under, double pitch) {
  const double twice = 2.0 * enclosing_radius(under);
  if (twice <= pitch) return std::numeric_limits<double>::infinity();
  const double highest = pitch * pitch / (twice + std::sqrt((twice - pitch) * (twice + pitch)));
  return std::max(highest - thickness(under), 0.0);
}

// What is the same in every state.
FabricGeometry without_sections(const WeaveSpec& weave) {
  if (Problems problems = check_pattern(weave.pattern); !problems.empty())
    throw InputError(std::move(problems));
  FabricGeometry fabric;
  fabric.weave = parse_weave(weave.pattern).weave;
  fabric.quarters = quarter_shares(fabric.weave);
  fabric.interlacing = interlacing(fabric.weave);
  fabric.as_woven_crimp = as_woven_crimp(weave, fabric.interlacing);
  fabric.mass = mass_balance(weave, fabric.as_woven_crimp);
  return fabric;
}

// The crossing of tows of these sections, with what was woven in inside them.
void put_sections(FabricGeometry& fabric, const WeaveSpec& weave, const std::array<Section, 2>& section,
                  double excess) {
  std::array<double, 2> spacing{}, fibre_fraction{};
  for (std::size_t i = 0; i < 2; ++i) {
    spacing[i] = weave.tow(i).pitch();
    const double crimp = fabric.as_woven_crimp[i], section_area = area(section[i]);
    const double solid_area = fabric.mass.glass_area[i] + fabric.mass.resin_area[i];
    fabric.tow_solid_fraction[i] = section_share(solid_area, crimp, section_area);
    fibre_fraction[i] = section_share(fabric.mass.glass_area[i], crimp, section_area);
  }
  fabric.crossing = crossing_of(spacing, section, fibre_fraction, excess);
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
double centre_between(const Path& path, bool first_above, bool second_above, double from) {
  const double half = 0.5 * height(path);
  if (first_above == second_above) return first_above ? half : -half;
  const double fallen = half - drop(path, from);
  return first_above ? fallen : -fallen;
}

}  // namespace

FabricGeometry fabric_geometry(const WeaveSpec& weave, CellState state) {
  if (state == CellState::compacted)
    throw std::invalid_argument("fabric_geometry: the compacted state has a thickness of its own");
  FabricGeometry fabric = without_sections(weave);
  std::array<Section, 2> section{section_of(weave, 0), section_of(weave, 1)};
  fabric.thickness = weave.fabric_thickness;
  if (state == CellState::consolidated) {
    fabric.thickness = fabric.mass.consolidated_thickness();
    for (std::size_t i = 0; i < 2; ++i) {
      // A consolidated direction is as thick as what it holds.
      const double share = fabric.mass.solid_thickness[i] / fabric.thickness;
      section[i] = resized(section[i], weave.tow(i).width, share * fabric.thickness);
    }
  }
  // Between the plates of a press faces are flush.
  put_sections(fabric, weave, section, state == CellState::as_woven ? weave.crimp_excess() : 0.0);
  return fabric;
}

FabricGeometry compacted_geometry(const WeaveSpec& weave, double thickness) {
  FabricGeometry fabric = without_sections(weave);
  const double least = fabric.mass.consolidated_thickness();
  const double way = (weave.fabric_thickness - thickness) / (weave.fabric_thickness - least);
  std::array<Section, 2> section{section_of(weave, 0), section_of(weave, 1)};
  for (std::size_t i = 0; i < 2; ++i) {
    const TowSpec tow = weave.tow(i);
    const double pressed = (1.0 - way) * tow.thickness + way * fabric.mass.solid_thickness[i];
    section[i] = resized(section[i], tow.width, pressed);
  }
  fabric.thickness = thickness;
  put_sections(fabric, weave, section, (1.0 - way) * weave.crimp_excess());
  return fabric;
}

Section section_of(const WeaveSpec& weave, std::size_t direction) {
  const TowSpec tow = weave.tow(direction);
  const auto shaped = [&](SectionShape shape, double power, double cap, double thickness) -> HalfSection {
    switch (shape) {
      case SectionShape::ellipse:
        return PowerEllipseSection{tow.width, thickness, 1.0};
      case SectionShape::power_ellipse:
        return PowerEllipseSection{tow.width, thickness, power};
      case SectionShape::capped_lens:
        return capped_lens(tow.width, thickness, cap);
      case SectionShape::lens:
      case SectionShape::hybrid:
        break;
    }
    return LensSection{tow.width, thickness};
  };
  if (weave.section != SectionShape::hybrid) {
    const HalfSection both = shaped(weave.section, weave.section_power, weave.section_cap, tow.thickness);
    return {both, both};
  }
  const auto half = [&](const HalfSpec& spec, double share) {
    return shaped(spec.section, spec.section_power, spec.section_cap, 2.0 * share * tow.thickness);
  };
  return {half(weave.upper, weave.upper_share), half(weave.lower, 1.0 - weave.upper_share)};
}

ArcPath path_over(const Section& own, const Section& under, double pitch, double excess) {
  return arc_path(pitch, thickness(under) + excess, enclosing_radius(under) + 0.5 * thickness(own));
}

double excess_with_room(const std::array<Section, 2>& section, const std::array<double, 2>& spacing,
                        double excess) {
  if (excess == 0.0) return 0.0;
  const std::size_t rises = excess > 0.0 ? 0 : 1;
  const double room = std::min(room_over(section[1 - rises], spacing[1 - rises]), thickness(section[rises]));
  return std::copysign(std::min(std::abs(excess), room), excess);
}

double excess_with_room(const WeaveSpec& weave, double excess) {
  return excess_with_room({section_of(weave, 0), section_of(weave, 1)},
                          {weave.tow(0).pitch(), weave.tow(1).pitch()}, excess);
}

double gap_closure_angle(const TowGeometry& unsheared) {
  return std::acos(std::min(width(unsheared.section) / unsheared.spacing, 1.0));
}

double gap_closure_angle(const CrossingGeometry& unsheared) {
  return std::min(gap_closure_angle(unsheared.tow[0]), gap_closure_angle(unsheared.tow[1]));
}

OpenWidth oblique_width(const TowGeometry& unsheared, double shear_angle) {
  const double pitch = unsheared.spacing, free = width(unsheared.section) / pitch;
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
  std::array<double, 2> spacing{}, fibre_fraction{};
  std::array<Section, 2> section{};
  for (std::size_t i = 0; i < 2; ++i) {
    const TowGeometry& tow = unsheared.tow[i];
    const double open = oblique_width(tow, shear_angle).width;
    const double free_width = width(tow.section) / std::cos(shear_angle);
    spacing[i] = tow.spacing;
    section[i] = resized(tow.section, open, thickness(tow.section));
    fibre_fraction[i] = tow.fibre_fraction * free_width / open;
  }
  CrossingGeometry crossing = crossing_of(spacing, section, fibre_fraction, excess_of(unsheared));
  crossing.shear_angle = shear_angle;
  return crossing;
}

double UnitCell::crown() const {
  double highest = 0.0;
  for (const Tow& t : tow) highest = std::max(highest, 0.5 * height(t.path) + 0.5 * thickness(t.section));
  return highest;
}

std::array<double, 2> UnitCell::place(double xi, double eta) const {
  return {xi + eta * std::sin(shear_angle), eta * std::cos(shear_angle)};
}

PressedFabric pressed(const FabricGeometry& consolidated, double shear_angle) {
  const double swelling = 1.0 / std::cos(shear_angle);
  std::array<double, 2> spacing{}, fibre_fraction{};
  std::array<Section, 2> section{};
  for (std::size_t i = 0; i < 2; ++i) {
    const TowGeometry& tow = consolidated.crossing.tow[i];
    spacing[i] = tow.spacing;
    section[i] =
        resized(tow.section, oblique_width(tow, shear_angle).width, thickness(tow.section) * swelling);
    // The volume of a tow per pitch is its section in the parameter plane times p cos g.
    fibre_fraction[i] = tow.fibre_fraction * area(tow.section) / area(section[i]) * swelling;
  }
  PressedFabric result{crossing_of(spacing, section, fibre_fraction), consolidated.thickness * swelling};
  result.crossing.shear_angle = shear_angle;
  return result;
}

CrossingGeometry thickened(const CrossingGeometry& crossing, double factor) {
  std::array<double, 2> spacing{}, fibre_fraction{};
  std::array<Section, 2> section{};
  for (std::size_t i = 0; i < 2; ++i) {
    const TowGeometry& tow = crossing.tow[i];
    spacing[i] = tow.spacing;
    section[i] = resized(tow.section, width(tow.section), factor * thickness(tow.section));
    fibre_fraction[i] = tow.fibre_fraction * area(tow.section) / area(section[i]);
  }
  CrossingGeometry result = crossing_of(spacing, section, fibre_fraction);
  result.shear_angle = crossing.shear_angle;
  return result;
}

UnitCell unit_cell(const FabricGeometry& fabric, double shear_angle) {
  return unit_cell(fabric.weave, sheared(fabric.crossing, shear_angle));
}

UnitCell unit_cell(const WeaveMatrix& weave, const CrossingGeometry& crossing) {
  const auto shape = [](const TowGeometry& tow) { return UnitCell::Tow{tow.spacing, tow.section, tow.path}; };
  return {weave, {shape(crossing.tow[0]), shape(crossing.tow[1])}, crossing.shear_angle};
}

double warp_centre(const UnitCell& cell, int warp, double along) {
  const Along at = locate(along, cell.tow[1].spacing);
  return centre_between(cell.tow[0].path, cell.weave.warp_over(warp, at.crossing),
                        cell.weave.warp_over(warp, at.crossing + 1), at.from);
}

double weft_centre(const UnitCell& cell, int weft, double along) {
  const Along at = locate(along, cell.tow[0].spacing);
  return centre_between(cell.tow[1].path, !cell.weave.warp_over(at.crossing, weft),
                        !cell.weave.warp_over(at.crossing + 1, weft), at.from);
}

Column column(const UnitCell& cell, double xi, double eta) {
  const auto& [warps, wefts] = cell.tow;
  const int warp = static_cast<int>(std::lround(eta / warps.spacing));
  const int weft = static_cast<int>(std::lround(xi / wefts.spacing));
  const double across_warp = eta - warp * warps.spacing, across_weft = xi - weft * wefts.spacing;
  Column found;
  if (std::abs(across_warp) < 0.5 * width(warps.section)) {
    const double centre = warp_centre(cell, warp, xi);
    found.warp = true;
    found.warp_top = centre + upper_face(warps.section, across_warp);
    found.warp_bottom = centre + lower_face(warps.section, across_warp);
  }
  if (std::abs(across_weft) < 0.5 * width(wefts.section)) {
    const double centre = weft_centre(cell, weft, eta);
    found.weft = true;
    found.weft_top = centre + upper_face(wefts.section, across_weft);
    found.weft_bottom = centre + lower_face(wefts.section, across_weft);
  }
  return found;
}

Penetration penetration(const UnitCell& cell, int samples_per_pitch) {
  const double step_xi = cell.tow[1].spacing / samples_per_pitch;
  const double step_eta = cell.tow[0].spacing / samples_per_pitch;
  // dxi deta above one sample; cos g turns it into true area.
  const double patch = step_xi * step_eta * std::cos(cell.shear_angle);
  Penetration worst{-std::numeric_limits<double>::infinity(), 0.0, 0.0};
  for (int i = 0; i < samples_per_pitch * cell.weave.warps; ++i)
    for (int j = 0; j < samples_per_pitch * cell.weave.wefts; ++j) {
      // Samples stand on the crossings too: there tows touch, and lens tows are apart elsewhere.
      const Column c = column(cell, j * step_xi, i * step_eta);
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
