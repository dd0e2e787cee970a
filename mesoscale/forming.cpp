#include "mesoscale/forming.h"

#include <fmt/format.h>

#include "mesoscale/state.h"

namespace heddle::mesoscale {

namespace {

std::string state_text(const CellSpec& spec) {
  if (spec.state == CellState::as_woven) return "as_woven";
  if (spec.state == CellState::consolidated) return "consolidated";
  return spec.compacted_thickness ? fmt::format("thickness {}", *spec.compacted_thickness)
                                  : fmt::format("pressure {}", spec.compacted_pressure.value());
}

}  // namespace

CompactionLaw compaction_law(const FormingSpec& forming) {
  CompactionLaw law{forming.compaction_modulus, forming.compaction_exponent};
  if (forming.compaction == CompactionChoice::van_wyk) law.exponent = 3.0;
  if (forming.compaction == CompactionChoice::gutowski) law.form = CompactionForm::gutowski;
  law.spring = forming.gutowski_spring;
  law.available = forming.gutowski_available;
  return law;
}

FormingModels forming_models(const CellSpec& spec) {
  FormingModels models;
  models.fabric = fabric_geometry(spec);
  models.compaction = compaction_law(spec.forming);
  models.bending =
      bending_stiffness(fabric_geometry(spec.weave, CellState::consolidated),
                        {spec.weave.fibre_modulus, spec.weave.fibre_diameter, spec.forming.bonding});
  TensionOptions options;
  options.fibre_modulus = spec.weave.fibre_modulus;
  options.compression_ratio = spec.forming.compression_ratio;
  options.bending_stiffness = {models.bending[0].value, models.bending[1].value};
  models.tension = tension_model(models.fabric, models.compaction, options);
  models.shear = {models.fabric, models.compaction, models.tension, spec.forming.reference_tension,
                  spec.forming.tow_friction};
  return models;
}

std::string describe(const CellSpec& spec) {
  const WeaveSpec& w = spec.weave;
  const ResinSpec& r = spec.resin;
  const FormingSpec& f = spec.forming;
  // Shortest text that reads back to the same double, so equal bits give equal text.
  std::string text = fmt::format(
      "weave {} {} {} {} {} {} {} {} {} {} {};state {};resin {} {} {} {} {};forming {} {} {} {} {} {} {}",
      w.pattern, w.tow_width, w.gap, w.tow_thickness, w.fabric_thickness, w.linear_density,
      w.fibre_mass_fraction, w.fibre_density, w.resin_density, w.fibre_modulus, w.fibre_diameter,
      state_text(spec), r.consistency, r.power_index, r.film_thickness, r.activation_energy,
      r.reference_temperature, f.compaction_modulus, f.compaction_exponent, f.tow_friction,
      f.reference_tension, f.in_tow_shear_share, f.bonding, f.compression_ratio);
  if (w.own != std::array<OwnTow, 2>{})
    for (std::size_t i = 0; i < 2; ++i) {
      const TowSpec tow = w.tow(i);
      text += fmt::format(";tow {} {} {} {}", tow.width, tow.gap, tow.thickness, tow.linear_density);
    }
  const WeaveSpec lens;
  if (w.section != lens.section || w.section_power != lens.section_power || w.section_cap != lens.section_cap)
    text += fmt::format(";section {} {} {}", static_cast<int>(w.section), w.section_power, w.section_cap);
  if (w.section == SectionShape::hybrid || w.upper != lens.upper || w.lower != lens.lower ||
      w.upper_share != lens.upper_share) {
    text += fmt::format(";upper_share {}", w.upper_share);
    for (const HalfSpec& half : {w.upper, w.lower})
      text +=
          fmt::format(";half {} {} {}", static_cast<int>(half.section), half.section_power, half.section_cap);
  }
  if (w.warp_crimp) text += fmt::format(";warp_crimp {}", *w.warp_crimp);
  if (f.compaction != CompactionChoice::toll)
    text += fmt::format(";compaction {} {} {}", static_cast<int>(f.compaction), f.gutowski_spring,
                        f.gutowski_available);
  if (spec.facing != Facing::flat)
    text += fmt::format(";facing {} {} {}", static_cast<int>(spec.facing), spec.facing_shift[0],
                        spec.facing_shift[1]);
  if (spec.film)
    text += fmt::format(";film {} {} {} {} {} {}", spec.film->speed, spec.film->temperature,
                        spec.film->fill.value_or(-1.0), spec.film->roughness, spec.film->boundary_friction,
                        spec.film->samples);
  return text;
}

std::string specification_hash(const CellSpec& spec) {
  std::uint64_t hash = 14695981039346656037ULL;
  for (const char c : describe(spec)) hash = (hash ^ static_cast<unsigned char>(c)) * 1099511628211ULL;
  return fmt::format("{:016x}", hash);
}

}  // namespace heddle::mesoscale
