#include "pipeline/report.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>

#include "core/units.h"
#include "macroscale/ply_state.h"
#include "pipeline/coupon_report.h"
#include "pipeline/page.h"
#include "pipeline/report_figures.h"
#include "pipeline/report_heat.h"
#include "pipeline/report_plies.h"
#include "pipeline/report_solid.h"
#include "pipeline/rig_figures.h"

namespace heddle::pipeline {

namespace {

// ---- the top of the page
// -----------------------------------------------------------------------------------------

std::string main_results(const ReportInput& input) {
  std::string out;
  if (input.stamping) {
    const auto& summary = *input.stamping;
    out += result("Peak punch force", significant(summary.peak_punch_force, 4), "N");
    out += result("Largest shear angle", fmt::format("{:.1f}", degrees * summary.shear_angle_max), "°");
    out += result("Largest draw-in", significant(1e3 * summary.draw_in_max, 3), "mm");
    if (input.grid_error && input.grid_error->known)
      out += result("Grid error of the force, estimated", significant(input.grid_error->force, 2), "N");
    else
      out += result("Energy residual", significant(100.0 * summary.energy_residual_max, 2), "%");
  } else if (input.cell) {
    const auto& cell = *input.cell;
    out += result("Areal density", significant(cell.areal_density, 3), "kg/m²");
    out += result("Crimp", significant(100.0 * cell.crimp[0], 4), "%");
    out += result("Gap closure", fmt::format("{:.2f}", degrees * cell.gap_closure_angle), "°");
    out += result("Contact fraction", significant(100.0 * cell.contact_area_fraction, 3), "%");
  }
  return results(out);
}

std::string header(const ReportInput& input) {
  const bool of_cell = (input.cell || input.solid) && input.friction_rig.empty();
  const std::string_view kind = input.stamping ? "Stamping report"
                                : of_cell      ? "Unit-cell report"
                                               : "Friction report";
  std::string out =
      fmt::format("<header>\n<p class=\"kind\">heddle · {}</p>\n<h1>{}</h1>\n", kind, escape(input.name));
  if (!input.description.empty()) out += fmt::format("<p class=\"lead\">{}</p>\n", escape(input.description));
  return out + "</header>\n";
}

// ---- sections
// ----------------------------------------------------------------------------------------------------

std::string formed_part(const ReportInput& input) {
  if (!input.blank) return "";
  // The lowest ply is on the outside of a part that a punch pushes down.
  const macroscale::BlankState outer = macroscale::ply_of(*input.blank, 0);
  return pair(figure(formed_picture(outer),
                     "The formed blank, turned over so that the dome points up; white lines follow some of "
                     "its tows. "
                     "Look for shear between the two tow directions, where the tows run at 45° to the edge "
                     "of the "
                     "dome."),
              figure(top_picture(outer),
                     "The same from above. The dashed outline is the blank before forming: the distance to "
                     "it is the "
                     "draw-in. A part that is not symmetric here has buckled or was set up so.")) +
         plies_section(input);
}

std::string forces(const ReportInput& input) {
  if (input.history.size() < 2) return "";
  return figure(force_chart(input.history),
                "Forces on the tools over the stroke. The binder holds its force; the punch force grows as "
                "the fabric "
                "wraps the dome, shears, and slides over the die.") +
         pair(figure(draw_in_chart(input.history),
                     "How far the outline has moved in, at the point that moved most."),
              figure(shear_chart(input.history), "The largest trellis shear angle anywhere in the blank."));
}

std::string soundness(const ReportInput& input) {
  if (input.history.size() < 2) return "";
  return figure(ledger_chart(input.history),
                "The energy ledger. Bands are what the work was spent on, added up: blue is stored, orange "
                "is friction, "
                "green and grey are other losses. The line is the work of punch and binder; it should lie on "
                "the "
                "top of the stack.") +
         pair(figure(residual_chart(input.history),
                     "What the ledger leaves over, on its own axis. The limit is 1 % either way."),
              figure(iteration_chart(input.history),
                     "Newton iterations of each accepted step. A rise marks a hard moment: first contact, "
                     "sticking, buckling."));
}

std::vector<Condition> cell_facts(const mesoscale::CellSummary& cell) {
  const auto angle = [](double radians) { return fmt::format("{:.2f}°", degrees * radians); };
  const auto percent = [](double share, int digits) { return significant(100.0 * share, digits) + " %"; };
  const auto both = [](const std::string& warp, const std::string& weft) {
    return warp == weft ? warp : fmt::format("{} warp, {} weft", warp, weft);
  };
  return {
      {"Areal density", significant(cell.areal_density, 4) + " kg/m²"},
      {"Crimp (tow length over pitch, less one)", both(percent(cell.crimp[0], 4), percent(cell.crimp[1], 4))},
      {"Crimp angle", both(angle(cell.crimp_angle[0]), angle(cell.crimp_angle[1]))},
      {"Gap closure (neighbouring tows touch)", angle(cell.gap_closure_angle)},
      {"Locking (shear ten times as stiff as at 20°)", angle(cell.locking_angle)},
      {"Glass in the tow, by volume", percent(cell.tow_fibre_volume_fraction, 3)},
      {"Glass and resin in the tow, by volume", percent(cell.tow_solid_volume_fraction, 3)},
      {"Contact fraction of one face at 0.05 mm depth", percent(cell.contact_area_fraction, 3)},
      {"Tow section", significant(1e6 * cell.tow_section_area, 4) + " mm²"},
      {"Thickness", significant(1e3 * cell.thickness, 4) + " mm"},
      {"Of the sheet: tows with their voids; glass; all voids",
       fmt::format("{}, {}, {}", percent(cell.tow_share, 3), percent(cell.glass_share, 3),
                   percent(std::max(cell.void_share, 0.0), 3))},
      {"Consolidated thickness", significant(1e3 * cell.consolidated_thickness, 3) + " mm"}};
}

std::string overlap_words(const std::optional<mesoscale::TowBodies>& bodies) {
  if (!bodies || bodies->height_depth <= 0.0) return " and nowhere cuts into them.";
  return fmt::format(" and cuts into them by up to {} mm.", significant(1e3 * bodies->height_depth, 2));
}

std::string weave(const ReportInput& input) {
  std::string out;
  if (!input.section.empty()) {
    out += figure(section_picture(input.section),
                  "Section through the weave, at true proportions. Weft tows (blue) are cut across; the warp "
                  "tow (brown) runs over and under them" +
                      overlap_words(input.tow_bodies));
  }
  std::string left, right;
  if (!input.height.height.empty()) {
    left = figure(height_picture(input.height),
                  "The upper face of the cell. A flat tool meets the light crowns first; the dark gaps stay "
                  "clear of it.");
  }
  if (input.cell) right = "<div>\n" + facts_table(cell_facts(*input.cell)) + "</div>\n";
  return out + pair(left, right);
}

// The structural part is made of plies that were sheared before they were consolidated.
std::string sheared_solid(const std::vector<mesoscale::solid::ShearedSolid>& rows) {
  if (rows.empty()) return "";
  const std::string table = sheared_table(rows);
  if (rows.size() < 2) return table;
  return pair(figure(sheared_stiffness_chart(rows),
                     "What the sheet becomes where the part has sheared it: axis 1 along the warp, the weft "
                     "turned towards it. A16 couples stretch and shear."),
              figure(sheared_thermal_chart(rows),
                     "What a kelvin of cooling pulls with in a ply held flat, along the warp, across it and "
                     "in shear.")) +
         table;
}

std::string solid_part(const ReportInput& input) {
  if (!input.solid) return "";
  const std::string_view caption =
      input.solid->tow ? "How stiff the cold, consolidated sheet is in each direction. A ply bent is another "
                         "material than a ply stretched: its fibres lie where its faces are not."
                       : "How stiff the cell is in each direction of its plane.";
  return pair(figure(stiffness_chart(*input.solid), caption),
              "<div>\n" + facts_table(solid_facts(*input.solid)) + "</div>\n") +
         stiffness_tables(*input.solid) + laminate_table(*input.solid) + sheared_solid(input.solid->sheared);
}

std::string signed_percent(const std::optional<double>& share) {
  if (!share) return "–";
  std::string text = fmt::format("{:+.1f} %", 100.0 * *share);
  if (text.front() == '-') text.replace(0, 1, "\u2212");
  return text;
}

std::string friction_table(const std::vector<FrictionTestRow>& rows) {
  if (rows.empty()) return "";
  const auto newtons = [](const std::optional<double>& force) {
    return force ? significant(*force, 4) : std::string("–");
  };
  std::string out =
      "<h3>Friction tests</h3>\n<div class=\"scroll\"><table>\n<tr><th>Case</th><th "
      "class=\"number\">Speed<br>mm/s</th>"
      "<th class=\"number\">Normal force<br>N</th><th class=\"number\">Tool<br>°C</th><th "
      "class=\"number\">Fabric<br>°C</th>"
      "<th class=\"number\">Direction<br>°</th><th class=\"number\">μ<br>model</th><th class=\"number\">Pull "
      "force<br>model, N</th>"
      "<th class=\"number\">Pull force<br>measured, N</th><th class=\"number\">Error<br>model</th>"
      "<th class=\"number\">Error<br>published model</th></tr>\n";
  for (const FrictionTestRow& row : rows) {
    out += fmt::format("<tr><td>{}</td>", escape(row.name));
    for (const std::string& cell :
         {significant(1e3 * row.velocity, 4), significant(row.normal_force, 4),
          fmt::format("{:.0f}", row.tool_temperature - zero_celsius),
          fmt::format("{:.0f}", row.fabric_temperature - zero_celsius),
          fmt::format("{:.0f}", degrees * row.orientation), fmt::format("{:.3f}", row.friction_coefficient),
          significant(row.pull_force, 4), newtons(row.measured_force), signed_percent(error_of_model(row)),
          signed_percent(error_of_paper(row))}) {
      out += fmt::format("<td class=\"number\">{}</td>", cell);
    }
    out += "</tr>\n";
  }
  return out + "</table></div>\n";
}

std::string film(const ReportInput& input) {
  if (!input.film) return "";
  return figure(
      film_chart(*input.film),
      "How far the resin film has gone from the fabric's temperature to the tool's, by conduction. It is "
      "sheared where it is hottest, so friction follows the warmest line most. A stamping stroke ends at "
      "0.4 s, a slow pull at 3 s.");
}

std::string friction_section(const ReportInput& input) {
  std::string contact, hersey, speed;
  if (input.fabric && !input.fabric->contact.log_fraction.empty()) {
    contact = figure(
        contact_chart(input.fabric->contact),
        "Share of the fabric face that touches a flat tool, against nominal pressure, for several trellis "
        "shear angles γ. The steeper the line, the less friction depends on pressure.");
  }
  if (input.fabric && !input.touched.empty()) {
    std::vector<std::string> pictures;
    for (const mesoscale::TouchedFace& face : input.touched) {
      const auto share = [&](double pressure) {
        return significant(100.0 * input.fabric->contact.evaluate(pressure, face.shear_angle).fraction, 3) +
               " %";
      };
      pictures.push_back(figure(
          touched_picture(face),
          fmt::format("One repeat{}: where a flat tool touches, by the nominal pressure at which it gets "
                      "there. At 0.1, 1 and 10 kPa it touches {}, {} and {} of the face.",
                      face.shear_angle == 0.0
                          ? std::string()
                          : fmt::format(", sheared by {:.0f}°", degrees * face.shear_angle),
                      share(1e2), share(1e3), share(1e4))));
    }
    for (std::size_t k = 0; k < pictures.size(); k += 2)
      contact += k + 1 < pictures.size() ? pair(pictures[k], pictures[k + 1]) : pictures[k];
  }
  const auto& curve = input.friction_curve;
  if (std::any_of(curve.begin(), curve.end(), [](const FrictionCurveRow& row) { return row.hersey > 0.0; })) {
    hersey =
        figure(friction_chart(curve, FrictionAbscissa::hersey),
               "Friction coefficient against Hersey number. Curves that fall on one another depend on speed, "
               "pressure and viscosity through this number alone.");
  }
  if (!curve.empty()) {
    speed =
        figure(friction_chart(curve, FrictionAbscissa::speed),
               "Friction coefficient against slip speed at several nominal pressures and tool temperatures.");
  }
  return contact + film(input) + pair(hersey, speed) + friction_table(input.friction_test);
}

std::string rig_figures(const ReportInput& input, RigParameter parameter) {
  const auto force = rig_chart(input.friction_rig, parameter, RigQuantity::pull_force);
  const auto mu = rig_chart(input.friction_rig, parameter, RigQuantity::coefficient);
  if (!force || !mu) return "";
  return pair(figure(*force, "Steady pull force, everything else at the baseline."),
              figure(*mu, "The same as effective coefficient."));
}

std::string rig(const ReportInput& input) {
  std::string out;
  if (!input.friction_history.empty()) {
    out += figure(
        pull_chart(input.friction_history),
        "What the load cell of the pull sees: the cable takes up the load, then the sample slides. A peak "
        "at the start is static friction, ageing, or a gear that takes up its backlash.");
    if (const auto normal = normal_force_chart(input.friction_history))
      out +=
          figure(*normal,
                 "The cam holds the gap, not the force: what the stack gives up in thickness is load lost.");
  }
  for (const RigParameter parameter :
       {RigParameter::velocity, RigParameter::normal_force, RigParameter::tool_temperature,
        RigParameter::fabric_temperature, RigParameter::orientation})
    out += rig_figures(input, parameter);
  for (const PlatePressure& plate : input.plates)
    out += pair(
        figure(plate_picture(plate, Plate::lower),
               "Pressure on the lower plate through the finite elements, pulled to the right: " + plate.name +
                   ". Even means that every part of the plate measures the same friction."),
        figure(plate_picture(plate, Plate::upper),
               "On the upper plate. Where plates bend, tension takes from one what it gives to the other."));
  return out;
}

std::string grounds(const ReportInput& input) {
  std::string out;
  if (!input.conditions.empty()) {
    const auto half =
        input.conditions.begin() + static_cast<std::ptrdiff_t>((input.conditions.size() + 1) / 2);
    out += "<div class=\"columns\">\n" + facts_table({input.conditions.begin(), half}) +
           facts_table({half, input.conditions.end()}) + "</div>\n";
  }
  if (!input.notes.empty()) out += "<h3>Assumptions</h3>\n" + list(input.notes);
  return out;
}

}  // namespace

std::string report_html(const ReportInput& input) {
  std::string out = page_head(input.name);
  out += header(input) + main_results(input) + verdict_list(verdicts(input));
  out += section("The formed part", formed_part(input));
  out += section("Forces and motion", forces(input));
  out += section("Temperatures", heat_section(input));
  out += section("Is the answer sound?", soundness(input));
  out += section("The weave", weave(input));
  if (input.stack) out += section("Plies on one another", stack_section(*input.stack));
  // A stamping has enough to show; its weave has a report of its own.
  if (input.fabric && !input.stamping)
    out += section("Shear tests as the laws predict them", coupon_section(*input.fabric, input.shear_loop));
  out += section("The solid part", solid_part(input));
  out += section("Contact and friction", friction_section(input));
  out += section("The friction test as a machine", rig(input));
  out += section("What it rests on", grounds(input));
  return out + page_foot(
                   "Written by heddle. Numbers behind the charts: summary.json, macroscale/history.csv and "
                   "mesoscale/fabric.json in the same folder. Angles in degrees, forces in newtons.");
}

}  // namespace heddle::pipeline
