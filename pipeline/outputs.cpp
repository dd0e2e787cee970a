#include "pipeline/outputs.h"

#include <fmt/format.h>

#include <bit>
#include <cmath>
#include <cstring>

#include "core/units.h"

namespace heddle::pipeline {

namespace {

std::string finite(double value, std::string_view quantity, std::size_t row) {
  if (!std::isfinite(value))
    throw OutputError(fmt::format("{} in row {} is {}, not a number to write", quantity, row, value));
  return shortest(value);
}

/// Quoted only where the separator, a quote or a line break makes it necessary (RFC 4180).
std::string csv_text(const std::string& text) {
  if (text.find_first_of(",\"\n\r") == std::string::npos) return text;
  std::string out = "\"";
  for (const char c : text) {
    if (c == '"') out += '"';
    out += c;
  }
  return out + '"';
}

/// A column and how a row fills it, side by side so that header and values cannot drift apart.
template <class Row>
struct Column {
  std::string_view name;
  double (*value)(const Row&);
};

template <class Row>
std::string table(std::span<const Row> rows, std::span<const Column<Row>> columns) {
  std::string out;
  for (std::size_t c = 0; c < columns.size(); ++c)
    out += fmt::format("{}{}", c > 0 ? "," : "", columns[c].name);
  out += '\n';
  for (std::size_t r = 0; r < rows.size(); ++r) {
    for (std::size_t c = 0; c < columns.size(); ++c) {
      if (c > 0) out += ',';
      out += finite(columns[c].value(rows[r]), columns[c].name, r + 1);
    }
    out += '\n';
  }
  return out;
}

template <class Row, std::size_t N>
std::string table(std::span<const Row> rows, const Column<Row> (&columns)[N]) {
  return table<Row>(rows, std::span<const Column<Row>>(columns));
}

using History = macroscale::HistoryRow;

constexpr Column<History> history_columns[] = {
    {"time_s", [](const History& r) { return r.time; }},
    {"punch_displacement_mm", [](const History& r) { return 1e3 * r.punch_displacement; }},
    {"punch_force_N", [](const History& r) { return r.punch_force; }},
    {"die_force_N", [](const History& r) { return r.die_force; }},
    {"binder_force_N", [](const History& r) { return r.binder_force; }},
    {"draw_in_max_mm", [](const History& r) { return 1e3 * r.draw_in_max; }},
    {"shear_angle_max_deg", [](const History& r) { return degrees * r.shear_angle_max; }},
    {"tow_strain_max", [](const History& r) { return r.tow_strain_max; }},
    {"newton_iterations", [](const History& r) { return static_cast<double>(r.newton_iterations); }},
    {"lag_iterations", [](const History& r) { return static_cast<double>(r.lag_iterations); }},
    {"work_punch_J", [](const History& r) { return r.work_punch; }},
    {"work_binder_J", [](const History& r) { return r.work_binder; }},
    {"work_gravity_J", [](const History& r) { return r.work_gravity; }},
    {"energy_tow_J", [](const History& r) { return r.energy_tow; }},
    {"energy_shear_J", [](const History& r) { return r.energy_shear; }},
    {"energy_bending_J", [](const History& r) { return r.energy_bending; }},
    {"energy_twist_J", [](const History& r) { return r.energy_twist; }},
    {"energy_compaction_J", [](const History& r) { return r.energy_compaction; }},
    {"energy_kinetic_J", [](const History& r) { return r.energy_kinetic; }},
    {"energy_press_J", [](const History& r) { return r.energy_press; }},
    {"friction_punch_J", [](const History& r) { return r.friction_punch; }},
    {"friction_die_J", [](const History& r) { return r.friction_die; }},
    {"friction_binder_J", [](const History& r) { return r.friction_binder; }},
    {"friction_plies_J", [](const History& r) { return r.friction_plies; }},
    {"dissipation_shear_rate_J", [](const History& r) { return r.dissipation_shear_rate; }},
    {"dissipation_shear_hysteresis_J", [](const History& r) { return r.dissipation_shear_hysteresis; }},
    {"dissipation_tow_rate_J", [](const History& r) { return r.dissipation_tow_rate; }},
    {"dissipation_artefact_J", [](const History& r) { return r.dissipation_artefact; }},
    {"dissipation_numerical_J", [](const History& r) { return r.dissipation_numerical; }},
    {"ledger_residual_J", [](const History& r) { return r.ledger_residual; }},
    {"force_balance_N", [](const History& r) { return r.force_balance; }},
    {"folded_nodes", [](const History& r) { return static_cast<double>(r.folded_nodes); }},
    {"near_nodes", [](const History& r) { return static_cast<double>(r.near_nodes); }},
    {"self_crossings", [](const History& r) { return static_cast<double>(r.self_crossings); }},
    // A share of the friction columns, not a column of the ledger: it stands behind them and is not summed.
    {"friction_work_outside_calibration_J", [](const History& r) { return r.friction_work_outside; }},
    {"punch_deflection_mm", [](const History& r) { return 1e3 * r.punch_deflection; }},
    {"binder_tilt_deg", [](const History& r) { return degrees * r.binder_tilt; }},
};

// Of a run with temperatures; behind all others.
constexpr Column<History> heat_columns[] = {
    {"temperature_mean_C", [](const History& r) { return r.heat->mean_temperature - zero_celsius; }},
    {"face_temperature_min_C", [](const History& r) { return r.heat->coldest_face - zero_celsius; }},
    {"crystallised_share", [](const History& r) { return r.heat->crystallised; }},
    {"frozen_faces_share", [](const History& r) { return r.heat->frozen_faces; }},
    {"frozen_through_share", [](const History& r) { return r.heat->frozen_through; }},
    {"heat_through_bottom_J", [](const History& r) { return r.heat->through_bottom; }},
    {"heat_through_top_J", [](const History& r) { return r.heat->through_top; }},
    {"heat_of_friction_J", [](const History& r) { return r.heat->of_friction; }},
    {"heat_residual_J", [](const History& r) { return r.heat->residual; }},
};

constexpr Column<FrictionCurveRow> curve_columns[] = {
    {"tool_temperature_C", [](const FrictionCurveRow& r) { return r.tool_temperature - zero_celsius; }},
    {"fabric_temperature_C", [](const FrictionCurveRow& r) { return r.fabric_temperature - zero_celsius; }},
    {"pressure_Pa", [](const FrictionCurveRow& r) { return r.pressure; }},
    {"slip_speed_mm_s", [](const FrictionCurveRow& r) { return 1e3 * r.slip_speed; }},
    {"film_viscosity_Pa_s", [](const FrictionCurveRow& r) { return r.film_viscosity; }},
    {"hersey_number", [](const FrictionCurveRow& r) { return r.hersey; }},
    {"friction_coefficient", [](const FrictionCurveRow& r) { return r.friction_coefficient; }},
};

constexpr Column<FrictionTestRow> friction_test_columns[] = {
    {"velocity_mm_s", [](const FrictionTestRow& r) { return 1e3 * r.velocity; }},
    {"normal_force_N", [](const FrictionTestRow& r) { return r.normal_force; }},
    {"tool_temperature_C", [](const FrictionTestRow& r) { return r.tool_temperature - zero_celsius; }},
    {"fabric_temperature_C", [](const FrictionTestRow& r) { return r.fabric_temperature - zero_celsius; }},
    {"orientation_deg", [](const FrictionTestRow& r) { return degrees * r.orientation; }},
    {"friction_coefficient", [](const FrictionTestRow& r) { return r.friction_coefficient; }},
    {"pull_force_N", [](const FrictionTestRow& r) { return r.pull_force; }},
};

constexpr Column<FrictionRigRow> friction_rig_columns[] = {
    {"velocity_mm_s", [](const FrictionRigRow& r) { return 1e3 * r.velocity; }},
    {"normal_force_N", [](const FrictionRigRow& r) { return r.normal_force; }},
    {"tool_temperature_C", [](const FrictionRigRow& r) { return r.tool_temperature - zero_celsius; }},
    {"fabric_temperature_C", [](const FrictionRigRow& r) { return r.fabric_temperature - zero_celsius; }},
    {"orientation_deg", [](const FrictionRigRow& r) { return degrees * r.orientation; }},
    {"law_force_N", [](const FrictionRigRow& r) { return r.law_force; }},
};

/// Columns that some rows leave empty.
struct RigColumn {
  std::string_view name;
  std::optional<double> (*value)(const FrictionRigRow&);
};

std::optional<double> scaled(const std::optional<double>& value, double factor, double offset = 0.0) {
  return value ? std::optional(factor * *value + offset) : std::nullopt;
}

constexpr RigColumn more_rig_columns[] = {
    {"peak_force_N", [](const FrictionRigRow& r) { return r.peak_force; }},
    {"peak_displacement_mm", [](const FrictionRigRow& r) { return scaled(r.peak_displacement, 1e3); }},
    {"steady_force_N", [](const FrictionRigRow& r) { return r.steady_force; }},
    {"friction_coefficient", [](const FrictionRigRow& r) { return r.steady_coefficient; }},
    {"normal_force_loss", [](const FrictionRigRow& r) { return r.normal_force_loss; }},
    {"film_temperature_C",
     [](const FrictionRigRow& r) { return scaled(r.film_temperature, 1.0, -zero_celsius); }},
    {"finite_element_force_N", [](const FrictionRigRow& r) { return r.element_force; }},
    {"measured_force_N", [](const FrictionRigRow& r) { return r.measured_force; }},
    {"paper_force_N", [](const FrictionRigRow& r) { return r.paper_force; }},
};

constexpr Column<FrictionHistoryRow> friction_history_columns[] = {
    {"time_s", [](const FrictionHistoryRow& r) { return r.time; }},
    {"displacement_mm", [](const FrictionHistoryRow& r) { return 1e3 * r.displacement; }},
    {"pull_force_N", [](const FrictionHistoryRow& r) { return r.pull_force; }},
    {"normal_force_N", [](const FrictionHistoryRow& r) { return r.normal_force; }},
    {"friction_coefficient", [](const FrictionHistoryRow& r) { return r.coefficient; }},
    {"film_temperature_C", [](const FrictionHistoryRow& r) { return r.film_temperature - zero_celsius; }},
};

struct ContactRow {
  double shear_angle, pressure;
  mesoscale::ContactArea::Value area;
};

constexpr Column<ContactRow> contact_columns[] = {
    {"shear_angle_deg", [](const ContactRow& r) { return degrees * r.shear_angle; }},
    {"pressure_Pa", [](const ContactRow& r) { return r.pressure; }},
    {"contact_area_fraction", [](const ContactRow& r) { return r.area.fraction; }},
    {"slope_1_Pa", [](const ContactRow& r) { return r.area.slope; }},
};

std::string optional_cell(const std::optional<double>& value, std::string_view quantity, std::size_t row) {
  return "," + (value ? finite(*value, quantity, row) : std::string());
}

std::optional<double> relative_error(double value, const std::optional<double>& measured) {
  if (!measured || *measured == 0.0) return std::nullopt;
  return value / *measured - 1.0;
}

}  // namespace

std::string shortest(double value) {
  return fmt::format("{}", value);
}

std::string history_csv(std::span<const History> rows) {
  if (rows.empty() || !rows.front().heat) return table(rows, history_columns);
  std::vector<Column<History>> columns(std::begin(history_columns), std::end(history_columns));
  columns.insert(columns.end(), std::begin(heat_columns), std::end(heat_columns));
  return table<History>(rows, columns);
}

std::string hold_csv(std::span<const macroscale::HeatRow> rows) {
  std::vector<History> as_history(rows.size());
  std::vector<Column<History>> columns{history_columns[0]};
  columns.insert(columns.end(), std::begin(heat_columns), std::end(heat_columns));
  for (std::size_t k = 0; k < rows.size(); ++k) {
    as_history[k].time = rows[k].time;
    as_history[k].heat = rows[k];
  }
  return table<History>(as_history, columns);
}

std::string curve_csv(std::span<const FrictionCurveRow> rows) {
  return table(rows, curve_columns);
}

std::string contact_csv(const mesoscale::ContactArea& contact, std::span<const double> pressures,
                        std::span<const double> shear_angles) {
  std::vector<ContactRow> rows;
  for (const double angle : shear_angles) {
    for (const double pressure : pressures)
      rows.push_back({angle, pressure, contact.evaluate(pressure, angle)});
  }
  return table<ContactRow>(rows, contact_columns);
}

std::string ply_facing_csv(const mesoscale::PlyFacing& facing) {
  std::string out = "distance_mm,pressure_kPa\n";
  for (std::size_t k = 0; k < facing.compaction.x().size(); ++k)
    out += fmt::format("{},{}\n", shortest(1e3 * (facing.rest - 2.0 * facing.compaction.x()[k])),
                       shortest(1e-3 * facing.compaction.y()[k]));
  return out;
}

std::string drag_direction_csv(const mesoscale::DragDirection& drag) {
  std::string out = "shear_angle_deg,pressure_kPa,cos_2_theta,sin_2_theta,along_over_across\n";
  for (std::size_t a = 0; a < drag.cosine.parameter().size(); ++a)
    for (std::size_t p = 0; p < drag.cosine.curves()[a].x().size(); ++p) {
      const double c = drag.cosine.curves()[a].y()[p], s = drag.sine.curves()[a].y()[p];
      const double angle = drag.cosine.parameter()[a], k = c * std::sin(angle) + s * std::cos(angle);
      out += fmt::format("{},{},{},{},{}\n", shortest(degrees * drag.cosine.parameter()[a]),
                         shortest(1e-3 * std::exp(drag.cosine.curves()[a].x()[p])), shortest(c), shortest(s),
                         shortest((1.0 + k) / (1.0 - k)));
    }
  return out;
}

std::optional<double> error_of_model(const FrictionTestRow& row) {
  return relative_error(row.pull_force, row.measured_force);
}

std::optional<double> error_of_paper(const FrictionTestRow& row) {
  return row.paper_force ? relative_error(*row.paper_force, row.measured_force) : std::nullopt;
}

std::string friction_test_csv(std::span<const FrictionTestRow> rows) {
  std::string out = "case";
  for (const auto& column : friction_test_columns) out += fmt::format(",{}", column.name);
  out += ",measured_force_N,paper_force_N,error,paper_error\n";
  for (std::size_t r = 0; r < rows.size(); ++r) {
    const FrictionTestRow& row = rows[r];
    out += csv_text(row.name);
    for (const auto& column : friction_test_columns)
      out += "," + finite(column.value(row), column.name, r + 1);
    out += optional_cell(row.measured_force, "measured_force_N", r + 1);
    out += optional_cell(row.paper_force, "paper_force_N", r + 1);
    out += optional_cell(error_of_model(row), "error", r + 1);
    out += optional_cell(error_of_paper(row), "paper_error", r + 1) + "\n";
  }
  return out;
}

std::string friction_rig_csv(std::span<const FrictionRigRow> rows) {
  std::string out = "case,plates";
  for (const auto& column : friction_rig_columns) out += fmt::format(",{}", column.name);
  for (const auto& column : more_rig_columns) out += fmt::format(",{}", column.name);
  out += '\n';
  for (std::size_t r = 0; r < rows.size(); ++r) {
    out += csv_text(rows[r].name) + (rows[r].curved ? ",s_curve" : ",flat");
    for (const auto& column : friction_rig_columns)
      out += "," + finite(column.value(rows[r]), column.name, r + 1);
    for (const auto& column : more_rig_columns)
      out += optional_cell(column.value(rows[r]), column.name, r + 1);
    out += '\n';
  }
  return out;
}

std::string friction_history_csv(std::span<const FrictionHistoryRow> rows) {
  std::string out = "case";
  for (const auto& column : friction_history_columns) out += fmt::format(",{}", column.name);
  out += '\n';
  for (std::size_t r = 0; r < rows.size(); ++r) {
    out += csv_text(rows[r].name);
    for (const auto& column : friction_history_columns)
      out += "," + finite(column.value(rows[r]), column.name, r + 1);
    out += '\n';
  }
  return out;
}

namespace {

template <class Number>
void append_bytes(std::string& out, Number value) {
  static_assert(std::endian::native == std::endian::little,
                "STL and VTK files are written in the machine's own order");
  char bytes[sizeof(Number)];
  std::memcpy(bytes, &value, sizeof(Number));
  out.append(bytes, sizeof(Number));
}

std::array<double, 3> unit_normal(const std::array<std::array<double, 3>, 3>& t) {
  const std::array<double, 3> a{t[1][0] - t[0][0], t[1][1] - t[0][1], t[1][2] - t[0][2]};
  const std::array<double, 3> b{t[2][0] - t[0][0], t[2][1] - t[0][1], t[2][2] - t[0][2]};
  const std::array<double, 3> n{a[1] * b[2] - a[2] * b[1], a[2] * b[0] - a[0] * b[2],
                                a[0] * b[1] - a[1] * b[0]};
  const double size = std::hypot(n[0], n[1], n[2]);
  // The format asks for a zero normal where a triangle has none.
  return size > 0.0 ? std::array<double, 3>{n[0] / size, n[1] / size, n[2] / size} : std::array<double, 3>{};
}

}  // namespace

std::string tows_stl(const TriangleMesh& mesh) {
  std::string out = "heddle: tows of one cell, millimetres";
  out.resize(80, ' ');
  append_bytes(out, static_cast<std::uint32_t>(mesh.triangles.size()));
  for (std::size_t i = 0; i < mesh.triangles.size(); ++i) {
    std::array<std::array<double, 3>, 3> triangle;
    for (std::size_t k = 0; k < 3; ++k)
      triangle[k] = mesh.vertices[static_cast<std::size_t>(mesh.triangles[i][k])];
    for (const double component : unit_normal(triangle)) append_bytes(out, static_cast<float>(component));
    for (const auto& corner : triangle) {
      for (const double component : corner) {
        if (!std::isfinite(component))
          throw OutputError(fmt::format("tows.stl: triangle {} has a corner at {}", i, component));
        append_bytes(out, static_cast<float>(1e3 * component));
      }
    }
    append_bytes(out, std::uint16_t{0});
  }
  return out;
}

}  // namespace heddle::pipeline
