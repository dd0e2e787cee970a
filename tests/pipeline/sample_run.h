#pragma once

#include <cmath>
#include <numbers>
#include <string>
#include <vector>

#include "pipeline/report.h"

/// A made-up run for tests of files and pictures: plausible in shape, not a result of the model.
namespace heddle::pipeline::sample {

inline constexpr double dome_radius = 0.070;  ///< [m]

/// A square blank laid on a hemisphere so that arcs from the apex keep their length; the rest stays a flat
/// flange.
inline macroscale::BlankState blank(int cells) {
  macroscale::BlankState state;
  state.nu = state.nv = cells;
  const double size = 0.32, quarter_arc = 0.5 * std::numbers::pi * dome_radius;
  for (int i = 0; i <= cells; ++i) {
    for (int j = 0; j <= cells; ++j) {
      const double x = size * (static_cast<double>(i) / cells - 0.5),
                   y = size * (static_cast<double>(j) / cells - 0.5);
      const double arc = std::hypot(x, y), turn = std::atan2(y, x);
      const bool on_dome = arc < quarter_arc;
      const double radius =
          on_dome ? dome_radius * std::sin(arc / dome_radius) : dome_radius + arc - quarter_arc;
      const double z = on_dome ? -dome_radius * std::cos(arc / dome_radius) : 0.0;
      const double reach = arc / quarter_arc;
      state.grid.push_back({i, j});
      state.reference.push_back({x, y});
      state.position.push_back({radius * std::cos(turn), radius * std::sin(turn), z});
      state.velocity.push_back({0.0, 0.0, 0.0});
      state.shear_angle.push_back(0.75 * std::sin(2.0 * turn) * reach * reach *
                                  std::exp(1.0 - reach * reach));
      state.tow_strain.push_back({1e-4 * reach, 2e-4 * reach});
      state.pressure.push_back(on_dome ? 2e4 : 8e3);
      state.slip_speed.push_back(0.01 * reach);
      state.friction_coefficient.push_back(0.4 + 0.1 * reach);
      state.hersey.push_back(1e-3 * reach);
    }
  }
  for (int i = 0; i < cells; ++i) {
    for (int j = 0; j < cells; ++j) {
      const int first = i * (cells + 1) + j, next = first + cells + 1;
      state.quads.push_back({first, next, next + 1, first + 1});
    }
  }
  state.outline.outer = {{-0.16, -0.16}, {0.16, -0.16}, {0.16, 0.16}, {-0.16, 0.16}};
  state.time = 0.43;
  state.punch_displacement = 0.07;
  return state;
}

/// Forces growing over the stroke, and a ledger that closes up to 0.2 % of the work.
inline std::vector<macroscale::HistoryRow> history(int steps) {
  std::vector<macroscale::HistoryRow> rows;
  for (int k = 1; k <= steps; ++k) {
    const double s = static_cast<double>(k) / steps;
    macroscale::HistoryRow row;
    row.time = 0.43 * s;
    row.punch_displacement = 0.07 * s;
    row.punch_force = 1450.0 * std::pow(s, 1.8) * (1.0 - 0.12 * std::exp(-20.0 * (1.0 - s)));
    row.die_force = 650.0 + 0.8 * row.punch_force;
    row.binder_force = 650.0 + 12.0 * std::sin(40.0 * s) * s;
    row.draw_in_max = 0.024 * std::pow(s, 2.2);
    row.shear_angle_max = 0.75 * std::pow(s, 1.4);
    row.tow_strain_max = 1e-3 * s;
    row.newton_iterations = 3 + k % 3 + (k < 4 ? 4 : 0);
    row.lag_iterations = 2;
    row.work_punch = 36.0 * std::pow(s, 2.8);
    row.work_binder = 0.4 * s;
    const double work = row.work_punch + row.work_binder;
    row.energy_tow = 0.06 * work;
    row.energy_shear = 0.13 * work;
    row.energy_bending = 0.03 * work;
    row.energy_twist = 0.004 * work;
    row.energy_compaction = 0.05 * work;
    row.energy_kinetic = 0.01 * work * (1.0 - s);
    row.friction_punch = 0.11 * work;
    row.friction_die = 0.28 * work;
    row.friction_binder = 0.16 * work;
    row.dissipation_shear_rate = 0.17 * work;
    row.dissipation_numerical = 0.004 * work;
    row.ledger_residual = work - row.energy_tow - row.energy_shear - row.energy_bending - row.energy_twist -
                          row.energy_compaction - row.energy_kinetic - row.friction_punch - row.friction_die -
                          row.friction_binder - row.dissipation_shear_rate - row.dissipation_numerical;
    row.force_balance = 1e-4 * row.punch_force;
    row.friction_work_outside = 0.03 * work;
    rows.push_back(row);
  }
  return rows;
}

inline macroscale::StampingSummary stamping() {
  macroscale::StampingSummary summary;
  summary.peak_punch_force = 1328.4;
  summary.shear_angle_max = 0.75;
  summary.draw_in_max = 0.024;
  summary.energy_residual_max = 0.0021;
  summary.force_balance_residual_max = 1.2e-4;
  summary.numerical_dissipation_share = 0.004;
  summary.twist_share = 0.012;
  summary.symmetry_gap_shear = 2.4e-4;
  summary.symmetry_gap_draw_in = 1.1e-4;
  summary.friction_work_outside = 0.031;
  summary.nodes = 5184;
  summary.steps = 100;
  summary.rejected_steps = 1;
  summary.newton_iterations = 412;
  summary.spacing = {4.45e-3, 4.45e-3};
  summary.completed = true;
  return summary;
}

inline mesoscale::CellSummary cell() {
  mesoscale::CellSummary summary;
  summary.areal_density = 0.7027;
  summary.crimp = {0.01156, 0.01156};
  summary.crimp_angle = {0.1888, 0.1888};
  summary.gap_closure_angle = 0.5339;
  summary.locking_angle = 0.82;
  summary.tow_fibre_volume_fraction = 0.189;
  summary.tow_solid_volume_fraction = 0.544;
  summary.contact_area_fraction = 0.0816;
  summary.tow_section_area = 2.332e-6;
  summary.consolidated_thickness = 0.476e-3;
  return summary;
}

inline CurveFamily family(const std::vector<double>& x, double scale, double exponent) {
  const std::vector<double> angles{0.0, 0.3, 0.6};
  std::vector<Curve> curves;
  for (const double angle : angles) {
    std::vector<double> y;
    for (const double value : x) y.push_back(scale * (1.0 + angle) + exponent * value);
    curves.emplace_back(x, y);
  }
  return {angles, curves};
}

/// Numbers without a short decimal form, so that a reader that rounds is found out.
inline mesoscale::FabricProperties fabric() {
  mesoscale::FabricProperties fabric;
  fabric.areal_density = 0.1 + 0.2;
  fabric.pitch = {5.39e-3, 5.39e-3 * (1.0 + 1e-16 * 3)};
  fabric.thickness = 1.5e-3 / 3.0;
  std::vector<double> energy;
  for (int i = 0; i < 5; ++i) {
    for (int j = 0; j < 4; ++j) energy.push_back(1e5 / 7.0 * (i * i + j * j) + 1e-300 * j);
  }
  fabric.tension_energy = Surface(-0.01 / 3.0, 0.01 / 7.0, 5, 0.0, 0.01 / 9.0, 4, energy);
  fabric.shear_stress = Curve({0.0, 1.0 / 3.0, 2.0 / 3.0, 0.9}, {0.0, 10.0 / 7.0, 30.0 / 7.0, 200.0 / 7.0});
  fabric.shear_rate = {4.0 / 3.0, 0.38, 42.0e3 / 8.314462618, 453.15};
  fabric.bending = {Curve({293.15, 453.15}, {1.0 / 300.0, 1e-5}),
                    Curve({293.15, 453.15}, {1.0 / 301.0, 1e-5})};
  fabric.compaction = family({0.0, 1e-5 / 3.0, 1e-4}, 0.0, 1e9 / 7.0);
  fabric.contact.log_fraction = family({6.0, 8.0, 10.0, 12.0}, -4.6, 0.3);
  fabric.provenance = {"3f2a\"91", {"compaction_modulus", "tow_friction", "bonding"}, 0.0123};
  return fabric;
}

inline HeightField height(int cells) {
  HeightField field{cells, cells, 10.78e-3 / cells, 10.78e-3 / cells, {}};
  for (int j = 0; j < cells; ++j) {
    for (int i = 0; i < cells; ++i) {
      const double x = (i + 0.5) / cells * 2.0, y = (j + 0.5) / cells * 2.0;  // in pitches
      const auto tow = [](double across, double along, double sign) {
        const double off = (across - std::floor(across) - 0.5) / 0.43;
        const double crown = std::abs(off) < 1.0 ? 0.375e-3 * (1.0 - off * off) : -0.75e-3;
        const double side = std::fmod(std::floor(across), 2.0) == 0.0 ? 1.0 : -1.0;
        return crown + sign * side * 0.375e-3 * std::sin(std::numbers::pi * along);
      };
      field.height.push_back(std::max({tow(y, x, 1.0), tow(x, y, -1.0), -0.75e-3}));
    }
  }
  return field;
}

inline std::vector<SectionLine> section() {
  const double pitch = 5.39e-3, half_width = 2.32e-3, half_height = 0.375e-3;
  std::vector<SectionLine> lines(1, {SectionKind::warp, {}});
  const auto middle = [&](double x) { return half_height * std::cos(std::numbers::pi * x / pitch); };
  for (int i = 0; i <= 120; ++i) {
    const double x = 2.0 * pitch * i / 120.0 - 0.5 * pitch;
    lines[0].points.push_back({x, middle(x) + half_height});
  }
  for (int i = 120; i >= 0; --i) {
    const double x = 2.0 * pitch * i / 120.0 - 0.5 * pitch;
    lines[0].points.push_back({x, middle(x) - half_height});
  }
  for (int tow = 0; tow < 2; ++tow) {
    SectionLine lens{SectionKind::weft, {}};
    for (int i = 0; i <= 48; ++i) {
      const double turn = 2.0 * std::numbers::pi * i / 48.0,
                   shape = std::sin(turn) * std::abs(std::sin(turn));
      lens.points.push_back({tow * pitch + half_width * std::cos(turn),
                             (tow == 0 ? -1 : 1) * half_height + half_height * shape});
    }
    lines.push_back(lens);
  }
  return lines;
}

inline std::vector<FrictionTestRow> friction_test() {
  const double kelvin = 273.15;
  return {{"baseline", 16.67e-3, 1500.0, 85 + kelvin, 180 + kelvin, 0.0, 0.2795, 838.5, 843.0, 804.0},
          {"velocity", 41.67e-3, 1500.0, 85 + kelvin, 180 + kelvin, 0.0, 0.2991, 897.4, 896.0, 848.0},
          {"normal force, doubled", 16.67e-3, 3000.0, 85 + kelvin, 180 + kelvin, 0.0, 0.2577, 1546.0, 1551.0,
           1673.0},
          {"no measurement", 16.67e-3, 3000.0, 85 + kelvin, 180 + kelvin, 0.7854, 0.2577, 1546.0, {}, {}}};
}

/// Pulls of the rig: five speeds beside what was measured at two of them.
inline std::vector<FrictionRigRow> friction_rig() {
  const double kelvin = 273.15;
  std::vector<FrictionRigRow> rows;
  for (const double speed : {16.67e-3, 41.67e-3, 16.6e-3, 1.66e-3, 8.33e-3, 83.3e-3}) {
    FrictionRigRow row;
    row.name = "speed " + std::to_string(rows.size());
    row.velocity = speed;
    row.normal_force = 1500.0;
    row.tool_temperature = 85 + kelvin;
    row.fabric_temperature = 180 + kelvin;
    row.law_force = 838.5 * std::pow(speed / 16.67e-3, 0.07);
    row.steady_force = 0.95 * row.law_force;
    row.element_force = 0.999 * row.law_force;
    if (rows.size() < 2) row.measured_force = rows.empty() ? 843.0 : 896.0;
    rows.push_back(row);
  }
  rows.push_back(rows[2]);
  rows.back().name = "S-curve plates";
  rows.back().curved = true;
  rows.back().steady_force.reset();
  return rows;
}

inline std::vector<FrictionHistoryRow> friction_history() {
  std::vector<FrictionHistoryRow> rows;
  for (int i = 0; i <= 50; ++i) {
    const double normal = 1500.0 - 4.0 * i, slip = 1e-3 * i;
    const double force = i == 0 ? 0.0 : 0.56 * normal * (1.0 + 0.3 * std::exp(-slip / 2e-3));
    rows.push_back({"speed 0", 0.06 * i, slip, force, normal, force / (2.0 * normal), 380.0});
  }
  return rows;
}

inline std::vector<FrictionCurveRow> friction_curve() {
  std::vector<FrictionCurveRow> rows;
  for (const double pressure : {25e3, 100e3, 300e3}) {
    for (int i = 0; i <= 30; ++i) {
      const double speed = 1e-3 * std::pow(300.0, i / 30.0),
                   viscosity = 6790.0 * std::pow(speed / 7e-5, -0.62);
      const double hersey = viscosity * speed / (pressure * 7e-5);
      rows.push_back({358.15, 453.15, pressure, speed, viscosity, hersey, 0.21 * std::pow(hersey, 0.18)});
    }
  }
  return rows;
}

inline ReportInput report() {
  ReportInput input;
  input.name = "thermostamping";
  input.description =
      "A plain weave of commingled glass and polypropylene, 320 mm square, pressed into a hemisphere of 70 "
      "mm radius.";
  input.conditions = {{"Binder force", "650 N"},
                      {"Tool temperature", "85 °C"},
                      {"Blank temperature", "180 °C"},
                      {"Stroke", "70 mm in 0.43 s"},
                      {"Friction law", "Stribeck, power form"},
                      {"Contact pressure", "real"},
                      {"Die opening", "72 mm radius, 20 mm fillet"}};
  input.cell = cell();
  input.fabric = fabric();
  input.height = height(120);
  input.section = section();
  input.friction_test = friction_test();
  input.friction_curve = friction_curve();
  input.stamping = stamping();
  input.history = history(100);
  input.blank = blank(64);
  input.notes = {
      "The plate area of the friction rig, 0.01 m², is assumed; the published account does not give it. "
      "Between "
      "0.005 and 0.02 m² the friction coefficient of the part moves with it.",
      "Shapes and sizes of the tools are ours; the published account gives none."};
  return input;
}

}  // namespace heddle::pipeline::sample
