#include "pipeline/report_plies.h"

#include <algorithm>

#include <fmt/format.h>

#include "core/units.h"
#include "macroscale/ply_state.h"
#include "pipeline/page.h"
#include "pipeline/report_figures.h"

namespace heddle::pipeline {

namespace {

std::string millimetres(double metres) {
  return significant(1e3 * metres, 3) + " mm";
}

std::string plies_table(const macroscale::StackSummary& stack) {
  std::vector<std::vector<std::string>> rows;
  for (std::size_t k = stack.plies.size(); k-- > 0;) {
    const macroscale::PlySummary& ply = stack.plies[k];
    const bool top = k + 1 == stack.plies.size();
    rows.push_back({std::to_string(k + 1), fmt::format("{:.0f}°", degrees * ply.orientation),
                    fmt::format("{:.1f}°", degrees * ply.shear_angle_max), millimetres(ply.draw_in_max),
                    top ? "" : millimetres(stack.interfaces[k].slip_mean),
                    top ? "" : millimetres(stack.interfaces[k].slip_max)});
  }
  return table({"Ply, from below", "Warp against x", "Largest shear angle", "Largest draw-in",
                "Slip to the ply above, mean", "largest"},
               rows);
}

}  // namespace

std::string plies_section(const ReportInput& input) {
  if (!input.blank || !input.stamping || !input.stamping->stack) return "";
  std::string out = "<h3>Plies</h3>\n" + plies_table(*input.stamping->stack);
  double largest = 0.0, slipped = 0.0;
  for (const double angle : input.blank->shear_angle) largest = std::max(largest, std::abs(angle));
  for (const double slip : input.blank->ply_slip) slipped = std::max(slipped, slip);
  for (int k = 0; k < macroscale::ply_count(*input.blank); ++k) {
    const macroscale::BlankState ply = macroscale::ply_of(*input.blank, k);
    std::vector<double> slip = ply.ply_slip;
    for (double& value : slip) value *= 1e3;
    const ColourScale colours{0.0, slipped > 0.0 ? 1e3 * slipped : 1.0, "Slip", "mm", ColourMap::angle};
    out += pair(
        figure(
            top_picture(ply, largest),
            fmt::format("Ply {} from below, coloured by its shear angle; one scale for all plies.", k + 1)),
        figure(top_picture(ply, std::move(slip), colours, fmt::format("Slip of ply {}", k + 1)),
               fmt::format("The way that ply {} slipped along its neighbours while pressed, the larger of "
                           "both faces.",
                           k + 1)));
  }
  return out;
}

}  // namespace heddle::pipeline
