// The page of a study of unit cells: what each length, the pattern and shear do to the properties.
#include <algorithm>
#include <cmath>

#include <fmt/format.h>

#include "core/units.h"
#include "pipeline/chart.h"
#include "pipeline/page.h"
#include "pipeline/report_figures.h"
#include "pipeline/study_command.h"

namespace heddle::pipeline {

namespace {

namespace study = mesoscale::study;

std::string words_of(study::Dimension dimension) {
  switch (dimension) {
    case study::Dimension::tow_width:
      return "tow width";
    case study::Dimension::gap:
      return "gap";
    case study::Dimension::tow_thickness:
      break;
  }
  return "tow thickness";
}

double length_of(const mesoscale::TowSpec& tow, study::Dimension dimension) {
  switch (dimension) {
    case study::Dimension::tow_width:
      return tow.width;
    case study::Dimension::gap:
      return tow.gap;
    case study::Dimension::tow_thickness:
      break;
  }
  return tow.thickness;
}

double value_of(const StudiedCell& cell, std::size_t angle, const std::string& key) {
  return cell.properties.at[angle][study::index_of(key)];
}

/// Those that a chart of relative changes can hold.
std::vector<std::string> followed(const CellStudyFindings& findings) {
  std::vector<std::string> keys{"crimp_warp",
                                "contact_fraction_10kPa",
                                "locking_angle_deg",
                                "shear_flow_40deg_N_per_mm",
                                "tension_warp_N_per_mm",
                                "bending_warp_N_mm"};
  if (findings.solid) keys.insert(keys.end(), {"solid_A11_GPa", "solid_D11_N_mm"});
  return keys;
}

// Weaves that differ from the one given in this length alone, in the order of the length.
std::vector<const StudiedCell*> slice(const CellStudyFindings& findings, study::Dimension dimension) {
  const auto d = static_cast<std::size_t>(dimension);
  const study::StudyPoint& base = findings.cells.front().point;
  std::vector<const StudiedCell*> found;
  for (const StudiedCell& cell : findings.cells) {
    study::StudyPoint point = cell.point;
    point.lengths[d] = base.lengths[d];
    if (point == base && cell.failure.empty()) found.push_back(&cell);
  }
  std::sort(found.begin(), found.end(), [d](const StudiedCell* a, const StudiedCell* b) {
    return a->point.lengths[d] < b->point.lengths[d];
  });
  return found;
}

std::vector<const StudiedCell*> patterns(const CellStudyFindings& findings) {
  const study::StudyPoint& base = findings.cells.front().point;
  std::vector<const StudiedCell*> found;
  for (const StudiedCell& cell : findings.cells)
    if (cell.point.lengths == base.lengths && cell.failure.empty()) found.push_back(&cell);
  return found;
}

// ---- charts

Canvas length_chart(const CellStudyFindings& findings, study::Dimension dimension) {
  const auto d = static_cast<std::size_t>(dimension);
  const StudiedCell& base = findings.cells.front();
  LineChart chart;
  chart.label = "Properties over the " + words_of(dimension) + ", in per cent of the weave given";
  chart.x = {words_of(dimension), "mm"};
  chart.x.quantity[0] = static_cast<char>(std::toupper(chart.x.quantity[0]));
  chart.y = {"Of the weave given", "%"};
  for (const std::string& key : followed(findings)) {
    Series series{study::properties()[study::index_of(key)].name, {}, {}};
    for (const StudiedCell* cell : slice(findings, dimension)) {
      series.x.push_back(1e3 * cell->point.lengths[d]);
      series.y.push_back(100.0 * value_of(*cell, 0, key) / value_of(base, 0, key));
    }
    chart.series.push_back(std::move(series));
  }
  chart.width = full_width;
  chart.height = 380.0;
  chart.label_room = 190.0;
  return draw(chart);
}

Canvas shear_chart_of(const CellStudyFindings& findings, const std::string& key) {
  const study::Property& property = study::properties()[study::index_of(key)];
  LineChart chart;
  chart.label = property.name + " over the shear angle, one line a pattern";
  chart.x = {"Shear angle", "°"};
  std::string name = property.name;
  name[0] = static_cast<char>(std::toupper(name[0]));
  chart.y = {name, property.unit};
  for (const StudiedCell* cell : patterns(findings)) {
    Series series{cell->point.pattern, {}, {}};
    for (std::size_t k = 0; k < findings.spec.shear_angles.size(); ++k) {
      series.x.push_back(degrees * findings.spec.shear_angles[k]);
      series.y.push_back(value_of(*cell, k, key) * property.per_si);
    }
    chart.series.push_back(std::move(series));
  }
  chart.width = half_width;
  chart.height = 320.0;
  chart.label_room = 96.0;
  return draw(chart);
}

// Three columns of bars from a common zero, one a length: per cent of the property for one per cent of it.
class SensitivityPicture {
 public:
  explicit SensitivityPicture(const CellStudyFindings& findings) : findings_(findings) {
    for (const study::Sensitivity& s : findings.sensitivities) {
      if (s.angle != findings.spec.shear_angles.front() || s.value == 0.0) continue;
      const double share = relative(s);
      if (rows_.empty() || std::find(rows_.begin(), rows_.end(), s.property) == rows_.end())
        rows_.push_back(s.property);
      largest_ = std::max(largest_, std::abs(share));
    }
    std::sort(rows_.begin(), rows_.end());
  }

  Canvas draw() const {
    Canvas canvas(
        full_width, top + row * static_cast<double>(rows_.size()) + 14.0,
        "Change of each property in per cent for one per cent more of tow width, gap and thickness");
    for (const study::Dimension dimension : study::dimensions) {
      const double zero = zero_of(dimension);
      canvas.text({zero, 18.0}, words_of(dimension), Anchor::middle, "title");
      canvas.line({zero, top - 6.0}, {zero, top + row * static_cast<double>(rows_.size())}, "axis");
    }
    for (std::size_t r = 0; r < rows_.size(); ++r)
      canvas.text({names - 14.0, top + row * static_cast<double>(r) + 0.5 * row + 4.0},
                  study::properties()[rows_[r]].name, Anchor::end, "label");
    for (const study::Sensitivity& s : findings_.sensitivities) draw_bar(canvas, s);
    return canvas;
  }

 private:
  static constexpr double top = 36.0, row = 24.0, names = 220.0;
  static constexpr double column = (full_width - names) / 3.0;

  double relative(const study::Sensitivity& s) const {
    return s.relative(length_of(findings_.base.weave.tow(0), s.dimension));
  }
  static double zero_of(study::Dimension dimension) {
    return names + column * (static_cast<double>(dimension) + 0.5);
  }
  void draw_bar(Canvas& canvas, const study::Sensitivity& s) const {
    const auto at = std::find(rows_.begin(), rows_.end(), s.property);
    if (at == rows_.end() || s.angle != findings_.spec.shear_angles.front() || s.value == 0.0) return;
    const double share = relative(s), zero = zero_of(s.dimension);
    const double end = zero + share / largest_ * (0.5 * column - 58.0);
    const double low = top + row * static_cast<double>(at - rows_.begin());
    const Point corners[] = {
        {zero, low + 5.0}, {end, low + 5.0}, {end, low + row - 5.0}, {zero, low + row - 5.0}};
    canvas.polygon(corners, share < 0.0 ? "b6" : "b2");
    const bool right = share >= 0.0;
    canvas.text({end + (right ? 6.0 : -6.0), low + 0.5 * row + 4.0}, fmt::format("{:+.2f}", share),
                right ? Anchor::start : Anchor::end, "faint");
  }

  const CellStudyFindings& findings_;
  std::vector<std::size_t> rows_;
  double largest_ = 1e-12;
};

// ---- tables

std::string shown_value(const StudiedCell& cell, std::size_t angle, std::size_t property) {
  if (!cell.failure.empty()) return "failed";
  const double value = cell.properties.at[angle][property];
  return significant_or_dash(value * study::properties()[property].per_si, 4);
}

// A row a property, a column a weave, at the first angle.
std::string property_table(const CellStudyFindings& findings, const std::vector<const StudiedCell*>& cells,
                           const std::vector<std::string>& names) {
  std::vector<std::string> head{"Property"};
  head.insert(head.end(), names.begin(), names.end());
  std::vector<std::vector<std::string>> rows;
  for (std::size_t p = 0; p < study::properties().size(); ++p) {
    const study::Property& property = study::properties()[p];
    if (property.solid && !findings.solid) continue;
    rows.push_back({property.name + (property.unit.empty() ? "" : ", " + property.unit)});
    for (const StudiedCell* cell : cells) rows.back().push_back(shown_value(*cell, 0, p));
  }
  return table(head, rows);
}

std::string angle_table(const CellStudyFindings& findings) {
  std::vector<std::string> head{"Property"};
  for (const double angle : findings.spec.shear_angles)
    head.push_back(fmt::format("{:.6g}°", degrees * angle));
  std::vector<std::vector<std::string>> rows;
  for (std::size_t p = 0; p < study::properties().size(); ++p) {
    const study::Property& property = study::properties()[p];
    if (!property.of_the_angle || (property.solid && !findings.solid)) continue;
    rows.push_back({property.name + (property.unit.empty() ? "" : ", " + property.unit)});
    for (std::size_t k = 0; k < findings.spec.shear_angles.size(); ++k)
      rows.back().push_back(shown_value(findings.cells.front(), k, p));
  }
  return table(head, rows);
}

std::string sensitivity_table(const CellStudyFindings& findings) {
  std::vector<std::vector<std::string>> rows;
  for (const study::Sensitivity& s : findings.sensitivities) {
    if (s.angle != findings.spec.shear_angles.front()) continue;
    const study::Property& property = study::properties()[s.property];
    // Properties come in the same order for each length.
    auto row =
        std::find_if(rows.begin(), rows.end(), [&](const auto& r) { return r.front() == property.name; });
    if (row == rows.end())
      row =
          rows.insert(row, {property.name, significant(s.value * property.per_si, 4) + " " + property.unit});
    const double per_mm = 1e-3 * property.per_si;
    row->push_back(
        fmt::format("{} ± {}", significant(s.slope * per_mm, 4), significant(s.error * per_mm, 1)));
  }
  return table({"Property", "Value", "per mm of tow width", "per mm of gap", "per mm of thickness"}, rows);
}

// ---- sections

std::string tiles(const CellStudyFindings& findings) {
  const StudiedCell& base = findings.cells.front();
  if (!base.failure.empty()) return "";
  std::string out;
  std::vector<std::string> keys{"crimp_warp", "contact_fraction_10kPa", "locking_angle_deg",
                                "shear_flow_40deg_N_per_mm"};
  if (findings.solid) keys.push_back("solid_A11_GPa");
  for (const std::string& key : keys) {
    const std::size_t p = study::index_of(key);
    out += result(study::properties()[p].name, shown_value(base, 0, p), study::properties()[p].unit);
  }
  return results(out);
}

std::string length_sections(const CellStudyFindings& findings) {
  std::string out;
  for (const study::Dimension dimension : study::dimensions) {
    const auto cells = slice(findings, dimension);
    if (cells.size() < 2 || !findings.cells.front().failure.empty()) continue;
    std::vector<std::string> names;
    for (const StudiedCell* cell : cells)
      names.push_back(significant(1e3 * cell->point.lengths[static_cast<std::size_t>(dimension)], 4) + " mm");
    out +=
        figure(length_chart(findings, dimension),
               fmt::format("Each property over its value in the weave given, at {:.4g}° of shear, as the {} "
                           "changes in warp and weft alike.",
                           degrees * findings.spec.shear_angles.front(), words_of(dimension))) +
        property_table(findings, cells, names);
  }
  return section("What the tows' dimensions do", out);
}

std::string shear_section(const CellStudyFindings& findings) {
  if (findings.spec.shear_angles.size() < 2 || !findings.cells.front().failure.empty()) return "";
  std::string out = pair(figure(shear_chart_of(findings, "shear_flow_N_per_mm"),
                                "Rate-free shear flow under the reference tension."),
                         figure(shear_chart_of(findings, "contact_fraction_10kPa"),
                                "Share of one face that touches a flat tool under 10 kPa."));
  if (findings.solid)
    out +=
        pair(figure(shear_chart_of(findings, "solid_A11_GPa"), "Stiffness of the solid ply along the warp."),
             figure(shear_chart_of(findings, "solid_A66_GPa"), "And in shear, in the warp's axes."));
  return section("What shear does", out + angle_table(findings));
}

std::string pattern_section(const CellStudyFindings& findings) {
  const auto cells = patterns(findings);
  if (cells.size() < 2) return "";
  std::vector<std::string> names;
  for (const StudiedCell* cell : cells) names.push_back(cell->point.pattern);
  return section("What the pattern does", property_table(findings, cells, names));
}

std::string sensitivity_section(const CellStudyFindings& findings) {
  if (findings.sensitivities.empty()) return "";
  return section(
      "First-order sensitivities",
      figure(SensitivityPicture(findings).draw(),
             fmt::format(
                 "Change of each property in per cent for one per cent more of a length (of its warp), at "
                 "{:.4g}° of shear; blue grows, orange falls.",
                 degrees * findings.spec.shear_angles.front())) +
          sensitivity_table(findings));
}

std::string notes_section(const CellStudyFindings& findings) {
  std::vector<std::string> notes;
  if (!findings.sensitivities.empty())
    notes.push_back(
        fmt::format("Sensitivities are central differences D(h) with h = {:.3g} % of the tow width "
                    "(thickness: of itself); ± is "
                    "|D(2h) − D(h)|/3, what the step leaves to leading order.",
                    100.0 * findings.spec.step));
  notes.push_back(
      "A change of the tow's thickness changes the fabric's by twice as much; linear density and "
      "everything else stay.");
  notes.push_back(
      "Constants of compaction, tow friction, in-tow shear and bonding are priors, not measured: read "
      "trends rather than levels from what rests on them.");
  for (const StudiedCell& cell : findings.cells)
    if (!cell.failure.empty()) notes.push_back(cell.point.pattern + " failed: " + cell.failure);
  notes.insert(notes.end(), findings.notes.begin(), findings.notes.end());
  return section("What it rests on", list(notes));
}

}  // namespace

std::string cell_study_html(const CellStudyFindings& findings) {
  const study::StudyPoint& base = findings.cells.front().point;
  std::string out = page_head(findings.name);
  out += fmt::format(
      "<header>\n<p class=\"kind\">heddle · Unit cell study</p>\n<h1>{}</h1>\n<p "
      "class=\"lead\">{}</p>\n</header>\n",
      escape(findings.name),
      escape(fmt::format(
          "{} weaves at {} shear angles, about a {} weave of tows {:.4g} mm wide, {:.4g} mm apart and "
          "{:.4g} mm thick.",
          findings.cells.size(), findings.spec.shear_angles.size(), base.pattern, 1e3 * base.lengths[0],
          1e3 * base.lengths[1], 1e3 * base.lengths[2])));
  out += tiles(findings) + sensitivity_section(findings) + length_sections(findings) +
         shear_section(findings) + pattern_section(findings) + notes_section(findings);
  return out +
         page_foot(
             "Written by heddle. Numbers: table.csv, table.h5 and sensitivities.csv in the same folder.");
}

}  // namespace heddle::pipeline
