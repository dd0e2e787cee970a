#include "pipeline/indicator_outputs.h"

#include <algorithm>
#include <stdexcept>

#include <fmt/format.h>

#include "core/units.h"
#include "pipeline/outputs.h"
#include "pipeline/painter.h"

namespace heddle::pipeline {

namespace {

using macroscale::LargestIndicator;

DataArray pair_data(std::string name, const std::vector<std::array<double, 2>>& values, double per_si) {
  DataArray array{std::move(name), 2, {}};
  for (const auto& pair : values)
    for (const double value : pair) array.values.push_back(per_si * value);
  return array;
}

const LargestIndicator& named(const std::vector<LargestIndicator>& all, const std::string& name) {
  const auto found = std::find_if(all.begin(), all.end(), [&](const auto& i) { return i.name == name; });
  if (found == all.end()) throw std::invalid_argument("no indicator " + name);
  return *found;
}

std::string place(const std::array<double, 3>& at) {
  return fmt::format("at ({:.0f}, {:.0f}, {:.0f}) mm", 1e3 * at[0], 1e3 * at[1], 1e3 * at[2]);
}
std::string place(const LargestIndicator& indicator) {
  return place(indicator.at);
}

}  // namespace

QuadMesh mesh_with_indicators(const macroscale::BlankState& blank,
                              const mesoscale::FabricProperties& fabric) {
  QuadMesh mesh = mesh_of(blank);
  const macroscale::Indicators of = macroscale::indicators(blank, fabric);
  add_nodal(mesh, blank, pair_data("tow_load_warp_weft", of.tow_load, 1.0));
  add_nodal(mesh, blank, pair_data("gap_opening_warp_weft_mm", of.gap_opening, 1e3));
  DataArray height{"wrinkle_height_mm", 1, of.wrinkle_height};
  for (double& value : height.values) value *= 1e3;
  add_nodal(mesh, blank, std::move(height));
  add_nodal(mesh, blank, {"thickening", 1, of.thickening});
  macroscale::Folds folds = macroscale::find_folds(blank, fabric.thickness);
  for (double& turn : folds.turn) turn *= degrees;
  for (double& distance : folds.distance) distance *= 1e3;
  add_nodal(mesh, blank, {"fold_turn_deg", 1, std::move(folds.turn)});
  add_nodal(mesh, blank, {"self_distance_mm", 1, std::move(folds.distance)});
  return mesh;
}

std::string indicators_csv(const std::vector<LargestIndicator>& indicators) {
  std::string out = "indicator,value,unit,x_mm,y_mm,z_mm\n";
  for (const LargestIndicator& i : indicators)
    out += fmt::format("{},{},{},{},{},{}\n", i.name, shortest(i.value), i.unit, shortest(1e3 * i.at[0]),
                       shortest(1e3 * i.at[1]), shortest(1e3 * i.at[2]));
  return out;
}

IndicatorLimits indicator_limits(const macroscale::StampingSpec& spec,
                                 const mesoscale::FabricProperties& fabric,
                                 const std::array<double, 2>& spacing) {
  IndicatorLimits limits;
  limits.wrinkle_height =
      macroscale::wrinkle_floor(std::max(spacing[0], spacing[1]), spec.die.fillet, fabric.thickness);
  limits.gap_opening = 0.1 * std::min(fabric.pitch[0], fabric.pitch[1]);
  return limits;
}

std::vector<std::string> indicator_warnings(const std::vector<LargestIndicator>& indicators,
                                            const IndicatorLimits& limits) {
  std::vector<std::string> warnings;
  if (indicators.empty()) return warnings;
  const auto& load = named(indicators, "tow_load_max");
  if (load.value > limits.tow_load)
    warnings.push_back(fmt::format(
        "Tows are torn {}: {:.2f} times the tension at which glass breaks ({:g} % of strain, a prior).",
        place(load), load.value, 100.0 * macroscale::glass_breaking_strain));
  const auto& gap = named(indicators, "gap_opening_max");
  if (1e-3 * gap.value > limits.gap_opening)
    warnings.push_back(fmt::format(
        "Neighbouring tows part by {:.2f} mm {}: nodes bind them here, in a fabric they would slide apart.",
        gap.value, place(gap)));
  const auto& shorter = named(indicators, "tow_compression_max");
  if (shorter.value > limits.tow_compression)
    warnings.push_back(fmt::format("A tow is shortened by {:.2g} % {}: it would buckle.",
                                   100.0 * shorter.value, place(shorter)));
  const auto& height = named(indicators, "wrinkle_height_max");
  if (1e-3 * height.value > limits.wrinkle_height)
    warnings.push_back(
        fmt::format("The sheet waves by {:.2g} mm {}, more than the {:.2g} mm that grid and fillets leave: "
                    "look for wrinkles.",
                    height.value, place(height), 1e3 * limits.wrinkle_height));
  return warnings;
}

std::vector<std::string> fold_warnings(const macroscale::Folds& folds,
                                       const macroscale::StampingSummary& run) {
  std::vector<std::string> warnings;
  if (run.self_crossings > 0)
    warnings.push_back(fmt::format(
        "The sheet has passed through itself: up to {} tow segments cross it in one step, from {:.1f} mm of "
        "stroke on. {}, so forces and shapes after that are not to be trusted.",
        run.self_crossings, 1e3 * run.first_crossing,
        run.self_contact
            ? "Its contact with itself did not hold there (edges and creases of a cell or two are not seen)"
            : "It feels no contact with itself (contact.self)"));
  if (folds.place.empty()) return warnings;
  const macroscale::FoldPlace& largest = folds.place.front();
  warnings.push_back(fmt::format(
      "The sheet folds on itself in {} place{}, the largest {}: {} nodes turn by more than 120° within four "
      "spacings, {} stand nearer than a thickness to another part of it{}.",
      folds.place.size(), folds.place.size() == 1 ? "" : "s", place(largest.at), folds.folded, folds.near,
      !run.self_contact       ? ", which it does not feel (contact.self)"
      : run.self_contact->met ? ", which presses and rubs it"
                              : ""));
  return warnings;
}

std::string indicator_line(const std::vector<LargestIndicator>& indicators) {
  std::string out = "indicators:";
  for (const LargestIndicator& i : indicators)
    out += fmt::format("{} {} {}{} {}", &i == &indicators.front() ? "" : ",", i.name, significant(i.value, 3),
                       i.unit.empty() ? "" : " " + i.unit, place(i));
  return out;
}

}  // namespace heddle::pipeline
