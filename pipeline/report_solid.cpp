#include "pipeline/report_solid.h"

#include <Eigen/LU>
#include <algorithm>
#include <cmath>
#include <numbers>
#include <tuple>

#include <fmt/format.h>

#include "core/units.h"
#include "pipeline/report_figures.h"

namespace heddle::pipeline {

namespace {

namespace solid = mesoscale::solid;

// Modulus of a sheet pulled at an angle to the warp, from its in-plane stiffness [Pa].
double modulus_along(const Eigen::Matrix3d& in_plane, double angle) {
  const double c = std::cos(angle), s = std::sin(angle);
  const Eigen::Vector3d stress(c * c, s * s, c * s);
  return 1.0 / stress.dot(in_plane.inverse() * stress);
}

Series modulus_series(std::string name, const Eigen::Matrix3d& in_plane) {
  Series series{std::move(name), {}, {}};
  for (int degree = 0; degree <= 90; degree += 2) {
    series.x.push_back(degree);
    series.y.push_back(1e-9 * modulus_along(in_plane, degree * std::numbers::pi / 180.0));
  }
  return series;
}

// Of a stack of plies that is free to contract.
Eigen::Matrix3d plane_stress(const solid::Matrix6& c) {
  const solid::Matrix6 compliance = c.inverse();
  constexpr std::array in{0, 1, 5};
  Eigen::Matrix3d soft;
  for (int i = 0; i < 3; ++i)
    for (int j = 0; j < 3; ++j) soft(i, j) = compliance(in[i], in[j]);
  return soft.inverse();
}

Eigen::Matrix3d membrane(const solid::SolidResult& s) {
  return s.plate->a / s.thickness;
}
Eigen::Matrix3d bending(const solid::SolidResult& s) {
  return 12.0 / std::pow(s.thickness, 3) * s.plate->d;
}

// A number that is nothing beside its neighbours is rounding, and said to be nothing.
std::string entry(double value, double scale) {
  return std::abs(value) < 1e-6 * scale ? "0" : significant(value, 4);
}

template <class Matrix>
std::string table(const std::string& title, const Matrix& matrix, double factor, double scale) {
  std::string out = fmt::format("<div><h3>{}</h3>\n<div class=\"scroll\"><table>\n", title);
  for (Eigen::Index i = 0; i < matrix.rows(); ++i) {
    out += "<tr>";
    for (Eigen::Index j = 0; j < matrix.cols(); ++j)
      out += fmt::format("<td class=\"number\">{}</td>", entry(factor * matrix(i, j), factor * scale));
    out += "</tr>\n";
  }
  return out + "</table></div></div>\n";
}

std::string gigapascal(double modulus) {
  return significant(1e-9 * modulus, 4) + " GPa";
}

void add_verdict(std::vector<Verdict>& out, const solid::SolverSummary& solver,
                 const solid::HomogenisationChecks& checks, const std::string& what) {
  if (!solver.converged) {
    out.push_back(
        {Tone::fails, fmt::format("The stiffness of the {} is not converged: {}.", what, solver.reason)});
    return;
  }
  out.push_back(
      {Tone::holds,
       fmt::format("The stiffness of the {} converged in {} iterations; mean work and work of the means "
                   "differ by {:.1e} of the energy.",
                   what, solver.most_iterations(), checks.hill_mandel)});
}

}  // namespace

Canvas stiffness_chart(const solid::SolidResult& s) {
  LineChart chart;
  chart.label = "Young's modulus against the direction of the pull";
  chart.x = {"Direction against the warp", "°", Scale::linear, 0.0, 90.0};
  chart.y = {"Young's modulus", "GPa", Scale::linear, 0.0, {}};
  if (s.plate) {
    chart.series.push_back(modulus_series("Stretched ply", membrane(s)));
    chart.series.push_back(modulus_series("Bent ply", bending(s)));
  }
  if (s.stack)
    chart.series.push_back(
        modulus_series(s.plate ? "Stack of plies" : "Cell", plane_stress(s.stack->stiffness)));
  chart.width = half_width;
  chart.height = 300.0;
  chart.label_room = 110.0;
  return draw(chart);
}

namespace {

// The rows by rising angle, whatever the order they were asked for in.
std::vector<const solid::ShearedSolid*> by_angle(const std::vector<solid::ShearedSolid>& rows) {
  std::vector<const solid::ShearedSolid*> sorted;
  for (const solid::ShearedSolid& row : rows) sorted.push_back(&row);
  std::stable_sort(sorted.begin(), sorted.end(),
                   [](const auto* a, const auto* b) { return a->shear_angle < b->shear_angle; });
  return sorted;
}

template <class Value>
Series against_angle(std::string name, const std::vector<solid::ShearedSolid>& rows, const Value& value) {
  Series series{std::move(name), {}, {}};
  for (const solid::ShearedSolid* row : by_angle(rows)) {
    series.x.push_back(degrees * row->shear_angle);
    series.y.push_back(value(*row));
  }
  return series;
}

LineChart angle_chart(std::string label, Axis y) {
  LineChart chart;
  chart.label = std::move(label);
  chart.x = {"Trellis angle", "°"};
  chart.y = std::move(y);
  chart.width = half_width;
  chart.height = 300.0;
  chart.label_room = 60.0;
  return chart;
}

}  // namespace

Canvas sheared_stiffness_chart(const std::vector<solid::ShearedSolid>& rows) {
  LineChart chart =
      angle_chart("stiffness of the ply against its trellis angle", {"Stiffness of the ply", "N/mm"});
  for (const auto& [name, i, j] :
       {std::tuple{"A11", 0, 0}, {"A22", 1, 1}, {"A12", 0, 1}, {"A66", 2, 2}, {"A16", 0, 2}})
    chart.series.push_back(
        against_angle(name, rows, [i = i, j = j](const auto& row) { return 1e-3 * row.plate(i, j); }));
  return draw(chart);
}

Canvas sheared_thermal_chart(const std::vector<solid::ShearedSolid>& rows) {
  LineChart chart = angle_chart("thermal resultants of the ply against its trellis angle",
                                {"Pull, held flat and 1 K cooler", "N/mm"});
  for (const auto& [name, i] : {std::pair{"N11", 0}, {"N22", 1}, {"N12", 2}})
    chart.series.push_back(against_angle(
        name, rows, [i = i](const auto& row) { return 1e-3 * row.plate_held[solid::expansion][i]; }));
  return draw(chart);
}

std::string sheared_table(const std::vector<solid::ShearedSolid>& rows) {
  using Cells = std::vector<std::string>;
  const auto table_of = [&](const char* title, std::initializer_list<const char*> heads, const auto& cells) {
    std::string out =
        fmt::format("<h3>{}</h3>\n<div class=\"scroll\"><table>\n<tr><th>Trellis angle<br>°</th>", title);
    for (const char* head : heads) out += fmt::format("<th class=\"number\">{}</th>", head);
    out += "</tr>\n";
    for (const solid::ShearedSolid* row : by_angle(rows)) {
      out += fmt::format("<tr><td>{}</td>", significant(degrees * row->shear_angle, 4));
      for (const std::string& cell : Cells(cells(*row)))
        out += fmt::format("<td class=\"number\">{}</td>", cell);
      out += "</tr>\n";
    }
    return out + "</table></div>\n";
  };
  const auto stiff = [](const solid::ShearedSolid& row) {
    const double a = 1e-3 * row.plate.topLeftCorner<3, 3>().norm();
    Cells cells{significant(1e3 * row.thickness, 4), significant(100.0 * row.fibre_fraction, 4)};
    for (const auto& [i, j] : {std::pair{0, 0}, {1, 1}, {0, 1}, {0, 2}, {1, 2}, {2, 2}})
      cells.push_back(entry(1e-3 * row.plate(i, j), a));
    for (const int i : {3, 4, 5}) cells.push_back(significant(1e3 * row.plate(i, i), 4));
    return cells;
  };
  const auto thermal = [](const solid::ShearedSolid& row) {
    Cells cells;
    const auto add = [&](const solid::Vector6& v, double factor) {
      for (int i = 0; i < 3; ++i) cells.push_back(entry(factor * v[i], factor * v.head<3>().norm()));
    };
    add(row.plate_held[solid::expansion], 1e-3);
    add(row.plate_held[solid::shrinkage], 1e-5);  // a hundredth, in N/mm
    add(solid::free_strain(row.plate, row.plate_held[solid::expansion]), 1e6);
    return cells;
  };
  return table_of("Stiffness of the ply by trellis angle",
                  {"Thickness<br>mm", "Glass in<br>the tow, %", "A11<br>N/mm", "A22<br>N/mm", "A12<br>N/mm",
                   "A16<br>N/mm", "A26<br>N/mm", "A66<br>N/mm", "D11<br>N mm", "D22<br>N mm", "D66<br>N mm"},
                  stiff) +
         table_of(
             "Pull of the ply held flat, for a kelvin of cooling and for a resin that shrinks by 1 %, "
             "and free expansion",
             {"N11<br>N/mm/K", "N22<br>N/mm/K", "N12<br>N/mm/K", "N11, 1 %<br>N/mm", "N22, 1 %<br>N/mm",
              "N12, 1 %<br>N/mm", "e11<br>1e-6/K", "e22<br>1e-6/K", "e12<br>1e-6/K"},
             thermal);
}

std::vector<Condition> solid_facts(const solid::SolidResult& s) {
  std::vector<Condition> facts{{"Voxels", fmt::format("{} × {} × {}", s.voxels[0], s.voxels[1], s.voxels[2])},
                               {"Thickness", significant(1e3 * s.thickness, 4) + " mm"}};
  if (s.tow) {
    facts.push_back({"Tows, share of the volume", significant(100.0 * s.tow_share, 4) + " %"});
    const auto& [warp, weft] = *s.tow;
    const bool alike = warp.axial_modulus == weft.axial_modulus;
    for (const auto& [name, tow] : {std::pair{alike ? "Tow" : "Warp", &warp}, {"Weft", &weft}}) {
      if (alike && tow == &weft) break;
      facts.push_back({fmt::format("{}, along and across", name),
                       gigapascal(tow->axial_modulus) + ", " + gigapascal(tow->transverse_modulus)});
      facts.push_back({fmt::format("{}, shear along and across", name),
                       gigapascal(tow->axial_shear) + ", " + gigapascal(tow->transverse_shear)});
    }
  }
  if (s.plate) {
    const Eigen::Matrix3d soft = membrane(s).inverse(), bent = bending(s).inverse();
    facts.push_back({"Ply stretched: E warp, E weft",
                     gigapascal(1.0 / soft(0, 0)) + ", " + gigapascal(1.0 / soft(1, 1))});
    facts.push_back({"Ply stretched: G, Poisson's ratio",
                     gigapascal(1.0 / soft(2, 2)) + ", " + significant(-soft(1, 0) / soft(0, 0), 3)});
    facts.push_back(
        {"Ply bent: E warp, E weft", gigapascal(1.0 / bent(0, 0)) + ", " + gigapascal(1.0 / bent(1, 1))});
  }
  if (s.stack) {
    const solid::Matrix6 soft = s.stack->stiffness.inverse();
    facts.push_back({s.plate ? "Stack: E warp, E weft, E through" : "E along 1, 2, 3",
                     fmt::format("{}, {}, {}", gigapascal(1.0 / soft(0, 0)), gigapascal(1.0 / soft(1, 1)),
                                 gigapascal(1.0 / soft(2, 2)))});
    facts.push_back({s.plate ? "Stack: G 12, 13, 23" : "G 12, 13, 23",
                     fmt::format("{}, {}, {}", gigapascal(1.0 / soft(5, 5)), gigapascal(1.0 / soft(4, 4)),
                                 gigapascal(1.0 / soft(3, 3)))});
  }
  return facts;
}

std::string stiffness_tables(const solid::SolidResult& s) {
  std::string out;
  if (s.plate) {
    const double a = s.plate->a.norm(), d = s.plate->d.norm();
    out += "<div class=\"pair\">\n" + table("A, N/mm (11, 22, 12)", s.plate->a, 1e-3, a) +
           table("D, N mm", s.plate->d, 1e3, d) + "</div>\n";
    // B is nothing beside what A and D would make of it, where the ply is the same upside down.
    if (s.plate->b.norm() > 1e-6 * std::sqrt(a * d)) out += table("B, N", s.plate->b, 1.0, std::sqrt(a * d));
  }
  if (s.stack)
    out += table(std::string(s.plate ? "C of a stack of plies" : "C") +
                     ", MPa (11, 22, 33, 23, 13, 12; shear strains doubled)",
                 s.stack->stiffness, 1e-6, s.stack->stiffness.norm());
  return out;
}

std::string laminate_table(const solid::SolidResult& s) {
  if (!s.laminate) return "";
  const solid::LaminateSolid& l = *s.laminate;
  std::string out = fmt::format(
      "<h3>A laminate of {} plies, {} mm thick</h3>\n<div class=\"scroll\"><table>\n<tr><th></th>", l.plies,
      significant(1e3 * l.thickness, 4));
  for (const char* head : {"A11<br>N/mm", "A22<br>N/mm", "A12<br>N/mm", "A66<br>N/mm", "B11<br>N",
                           "D11<br>N mm", "D22<br>N mm", "D12<br>N mm", "D66<br>N mm"})
    out += fmt::format("<th class=\"number\">{}</th>", head);
  out += "</tr>\n";
  for (const auto& [name, all] :
       {std::pair{"consolidated together", &l.plate}, {"lone plies, classical lamination", &l.apart}}) {
    out += fmt::format("<tr><td>{}</td>", name);
    const double a = 1e-3 * all->topLeftCorner<3, 3>().norm(),
                 d = 1e3 * all->bottomRightCorner<3, 3>().norm();
    for (const auto& [i, j, factor, scale] : {std::tuple{0, 0, 1e-3, a},
                                              {1, 1, 1e-3, a},
                                              {0, 1, 1e-3, a},
                                              {2, 2, 1e-3, a},
                                              {0, 3, 1.0, std::sqrt(a * d)},
                                              {3, 3, 1e3, d},
                                              {4, 4, 1e3, d},
                                              {3, 4, 1e3, d},
                                              {5, 5, 1e3, d}})
      out += fmt::format("<td class=\"number\">{}</td>", entry(factor * (*all)(i, j), scale));
    out += "</tr>\n";
  }
  return out + "</table></div>\n";
}

std::vector<Verdict> solid_verdicts(const solid::SolidResult& s) {
  std::vector<Verdict> out;
  if (s.plate) add_verdict(out, s.plate->solver, s.plate->checks, "solid ply");
  if (s.stack) add_verdict(out, s.stack->solver, s.stack->checks, s.plate ? "stack of plies" : "solid cell");
  if (s.laminate && !s.laminate->converged)
    out.push_back({Tone::fails, "The stiffness of the laminate is not converged."});
  const auto found = imbalances(s);
  for (const solid::BalancePair& pair : found)
    out.push_back(
        {Tone::attention,
         fmt::format("{} is {} {u} and {} is {} {u}, {} % apart: the weave is not balanced, or the axes of "
                     "the voxels are in the wrong order.",
                     pair.first_name, significant(pair.per_unit * pair.first, 4), pair.second_name,
                     significant(pair.per_unit * pair.second, 4), significant(100.0 * pair.gap(), 2),
                     fmt::arg("u", pair.unit))});
  if (found.empty() && !s.balance.empty()) {
    std::string names;
    for (const solid::BalancePair& pair : s.balance)
      names += fmt::format("{}{} = {}", names.empty() ? "" : ", ", pair.first_name, pair.second_name);
    out.push_back({Tone::holds, "The solid is balanced: " + names + " within 0.1 %."});
  }
  if (s.tow)
    out.push_back(
        {Tone::note,
         "Constants of the solid are priors, not measured: solid.fibre_poisson, solid.resin_modulus, "
         "solid.resin_poisson."});
  return out;
}

}  // namespace heddle::pipeline
