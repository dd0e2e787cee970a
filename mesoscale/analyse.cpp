#include <algorithm>

#include <fmt/format.h>

#include "mesoscale/cell_spec.h"
#include "mesoscale/contact.h"
#include "mesoscale/film_direction.h"
#include "mesoscale/forming.h"
#include "mesoscale/ply_facing.h"
#include "mesoscale/state.h"

namespace heddle::mesoscale {

namespace {

// Constants that no source of ours measures for this fabric.
std::vector<std::string> priors(const FormingSpec& forming) {
  std::vector<std::string> names{"forming.compaction_modulus", "forming.compaction_exponent"};
  if (forming.compaction == CompactionChoice::van_wyk) names.pop_back();
  if (forming.compaction == CompactionChoice::gutowski)
    names = {"forming.gutowski_spring", "forming.gutowski_available"};
  for (const char* name : {"forming.tow_friction", "forming.reference_tension", "forming.in_tow_shear_share",
                           "forming.bonding", "forming.compression_ratio", "weave.fibre_diameter",
                           "resin.consistency", "resin.power_index", "resin.activation_energy"})
    names.push_back(name);
  if (forming.compaction != CompactionChoice::gutowski)
    names.insert(names.end(), {"compaction.packing", "compaction.packing_modulus"});
  names.insert(names.end(), {"tension.straightening", "geometry.width_scatter", "shear.ramp_angle"});
  return names;
}

CellSummary summarise(const FormingModels& models, const MassBalance& mass, const CompactionLaw& law) {
  const FabricGeometry& fabric = models.fabric;
  const CrossingGeometry& crossing = fabric.crossing;
  CellSummary summary;
  summary.areal_density = mass.areal_density;
  for (std::size_t i = 0; i < 2; ++i) {
    summary.crimp[i] = fabric.interlacing[i] * crossing.tow[i].path.crimp();
    summary.crimp_angle[i] = crossing.tow[i].path.angle;
  }
  summary.gap_closure_angle = gap_closure_angle(crossing);
  summary.tow_fibre_volume_fraction =
      std::max(crossing.tow[0].fibre_fraction, crossing.tow[1].fibre_fraction);
  summary.tow_solid_volume_fraction = std::max(fabric.tow_solid_fraction[0], fabric.tow_solid_fraction[1]);
  summary.contact_area_fraction = plate_contact(fabric, law, 0.0).touched_fraction(0.05e-3);
  summary.tow_section_area = area(crossing.tow[0].section);
  summary.consolidated_thickness = mass.consolidated_thickness();
  summary.thickness = fabric.thickness;
  const SheetShares shares = sheet_shares(fabric);
  summary.tow_share = shares.tows;
  summary.glass_share = shares.glass;
  summary.void_share = shares.voids;
  return summary;
}

}  // namespace

CellResult analyse(const CellSpec& spec) {
  if (Problems problems = check(spec); !problems.empty()) throw InputError(std::move(problems));
  const FormingModels models = forming_models(spec);
  const FabricGeometry& fabric = models.fabric;
  ContactTables contact = contact_tables(fabric, models.compaction);

  CellResult result;
  result.summary = summarise(models, fabric.mass, models.compaction);
  FabricProperties& out = result.fabric;
  out.areal_density = fabric.mass.areal_density;
  out.pitch = {fabric.crossing.tow[0].spacing, fabric.crossing.tow[1].spacing};
  out.thickness = fabric.thickness;
  out.tension_energy = tabulate(models.tension);
  out.shear_stress = tabulate(models.shear, sine_grid(fabric));
  out.shear_rate = shear_rate(fabric, spec.resin, spec.forming.in_tow_shear_share);
  for (std::size_t i = 0; i < 2; ++i) out.bending[i] = constant_in_temperature(models.bending[i].value);
  out.compaction = std::move(contact.compaction);
  out.contact = std::move(contact.contact);
  if (spec.facing == Facing::shift)
    out.facing = facing_of_shift(fabric, models.compaction, spec.facing_shift);
  if (spec.facing == Facing::mean) out.facing = facing_of_all_shifts(fabric, models.compaction);
  if (spec.film) out.contact.drag = drag_direction(fabric, models.compaction, spec.resin, *spec.film);
  out.provenance = {specification_hash(spec), priors(spec.forming), contact.grid_error};
  if (spec.film)
    for (const char* name : {"film.roughness", "film.boundary_friction"})
      out.provenance.unverified.push_back(name);
  result.summary.locking_angle = locking_angle(out.shear_stress);

  if (Problems problems = check(out); !problems.empty())
    throw NumericalError("unit cell: a table breaks its own rule\n" + format(problems));
  return result;
}

}  // namespace heddle::mesoscale
