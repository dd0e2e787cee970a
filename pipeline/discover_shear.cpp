#include "pipeline/discover_shear.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <map>
#include <numbers>
#include <optional>
#include <utility>

#include "core/text_file.h"
#include "mesoscale/cell.h"
#include "pipeline/case.h"
#include "pipeline/discover_command.h"
#include "pipeline/outputs.h"
#include "pipeline/run_folder.h"

namespace heddle::pipeline {

namespace {

constexpr double degree = std::numbers::pi / 180.0;

/// Flow and rate of a curve at an angle between two of its points; empty beyond them.
std::optional<ShearPoint> at_angle(const ShearCurve& curve, double angle) {
  for (std::size_t k = 1; k < curve.points.size(); ++k) {
    const ShearPoint &a = curve.points[k - 1], &b = curve.points[k];
    if (angle < a.shear_angle || angle > b.shear_angle || !(b.shear_angle > a.shear_angle)) continue;
    const double share = (angle - a.shear_angle) / (b.shear_angle - a.shear_angle);
    return ShearPoint{.shear_angle = angle,
                      .shear_rate = std::lerp(a.shear_rate, b.shear_rate, share),
                      .flow = std::lerp(a.flow, b.flow, share)};
  }
  return {};
}

std::string tests_csv(const std::vector<ShearCurve>& curves, const mesoscale::FabricProperties& fabric) {
  std::string text =
      "test,condition_id,sample_id,displacement_mm,force_N,shear_angle_deg,shear_rate_1_s,"
      "shear_flow_N_m,shear_flow_model_N_m\n";
  for (const ShearCurve& curve : curves)
    for (const ShearPoint& p : curve.points)
      text += fmt::format("{},{},{},{:.6g},{:.6g},{:.4f},{:.5g},{:.5g},{:.5g}\n", name_of(curve.test),
                          curve.condition, curve.sample, 1e3 * p.displacement, p.force,
                          p.shear_angle / degree, p.shear_rate, p.flow,
                          mesoscale::shear_flow(fabric, p.shear_angle, p.shear_rate, curve.temperature));
  return text;
}

std::string gap_table(const std::vector<ShearGap>& gaps) {
  std::string text =
      "test,condition_id,shear_angle_deg,samples,shear_flow_N_m,scatter_N_m,shear_flow_model_N_m\n";
  for (const ShearGap& g : gaps)
    text += fmt::format("{},{},{:.0f},{},{:.5g},{:.5g},{:.5g}\n", name_of(g.test), g.condition,
                        g.shear_angle / degree, g.samples, g.measured, g.scatter, g.model);
  return text;
}

void print_gaps(const std::vector<ShearGap>& gaps) {
  fmt::print("{:<16}{:<20}{:>7}{:>9}{:>14}{:>12}{:>12}\n", "test", "condition", "deg", "samples", "T_s N/m",
             "scatter", "model N/m");
  for (const ShearGap& g : gaps)
    fmt::print("{:<16}{:<20}{:>7.0f}{:>9}{:>14.4g}{:>12}{:>12.4g}\n", name_of(g.test), g.condition,
               g.shear_angle / degree, g.samples, g.measured,
               g.samples > 1 ? fmt::format("{:.2g}", g.scatter) : "-", g.model);
  fmt::print("No effect of the library acts on shear tests: the gap is shown, and nothing is named.\n");
}

}  // namespace

std::vector<ShearGap> shear_gaps(const std::vector<ShearCurve>& curves,
                                 const mesoscale::FabricProperties& fabric) {
  std::map<std::pair<ShearTest, std::string>, std::vector<const ShearCurve*>> alike;
  for (const ShearCurve& curve : curves) alike[{curve.test, curve.condition}].push_back(&curve);
  std::vector<ShearGap> gaps;
  for (const auto& [name, list] : alike)
    for (int k = 1; k < 18; ++k) {
      ShearGap gap{.test = name.first, .condition = name.second, .shear_angle = 5.0 * k * degree};
      std::vector<double> flows;
      for (const ShearCurve* curve : list) {
        const std::optional<ShearPoint> at = at_angle(*curve, gap.shear_angle);
        if (!at) continue;
        flows.push_back(at->flow);
        gap.model += mesoscale::shear_flow(fabric, at->shear_angle, at->shear_rate, curve->temperature);
      }
      if (flows.empty()) continue;
      gap.samples = static_cast<int>(flows.size());
      gap.model /= gap.samples;
      for (const double flow : flows) gap.measured += flow / gap.samples;
      for (const double flow : flows) gap.scatter += std::pow(flow - gap.measured, 2);
      gap.scatter = gap.samples > 1 ? std::sqrt(gap.scatter / (gap.samples - 1)) : 0.0;
      gaps.push_back(gap);
    }
  return gaps;
}

int discover_shear(const DiscoverOptions& options) {
  Case a_case = read_case(options.run.file, options.run.assignments);
  a_case.stamping.reset();
  if (!a_case.cell)
    throw InputError(
        {{"discover.shear.case"_rule, "weave", "",
          "must be there: shear tests are compared with what the weave's laws say",
          "Give the case a weave, as configs/unit_cell.yaml has it.", options.run.file.string()}});
  const std::vector<ShearCurve> curves =
      parse_shear_tests(read_text_file(options.data), options.data.filename().string());
  mesoscale::CellSpec cell = *a_case.cell;
  cell.film.reset();  // shear alone is asked for
  cell.facing = mesoscale::Facing::flat;
  const mesoscale::FabricProperties fabric = analyse_cell(cell, a_case.fabric).fabric;
  const std::vector<ShearGap> gaps = shear_gaps(curves, fabric);
  RunFolder folder(
      a_case,
      options.run.output.empty() ? std::filesystem::path("out/discover") / a_case.name : options.run.output,
      options.run.force);
  folder.write("inputs/shear_tests.csv", read_text_file(options.data));
  folder.write("discover/shear_tests.csv", tests_csv(curves, fabric));
  folder.write("discover/shear_gap.csv", gap_table(gaps));
  folder.close(a_case, {});
  if (options.run.print) print_gaps(gaps);
  return exit_done;
}

}  // namespace heddle::pipeline
