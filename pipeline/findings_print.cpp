#include <algorithm>
#include <cmath>

#include <fmt/format.h>

#include "core/units.h"
#include "pipeline/findings.h"

namespace heddle::pipeline {

namespace {

void print_cell(const mesoscale::CellSummary& s, const mesoscale::TowBodies& bodies) {
  fmt::print("areal density        {:.4f} kg/m^2\n", s.areal_density);
  fmt::print("crimp                {:.3f} % warp, {:.3f} % weft\n", 100.0 * s.crimp[0], 100.0 * s.crimp[1]);
  fmt::print("gap closure          {:.2f} deg\n", degrees * s.gap_closure_angle);
  fmt::print("locking              {:.1f} deg (shear tangent 10 times that at 20 deg)\n",
             degrees * s.locking_angle);
  fmt::print("contact fraction     {:.2f} % of one face at 0.05 mm\n", 100.0 * s.contact_area_fraction);
  fmt::print("tow fibre fraction   {:.3f}\n", s.tow_fibre_volume_fraction);
  fmt::print(
      "thickness            {:.4f} mm: tows with their voids {:.3f}, glass {:.3f}, voids {:.3f} of the "
      "sheet\n",
      1e3 * s.thickness, s.tow_share, s.glass_share, std::max(s.void_share, 0.0));
  fmt::print("overlap of tows      {:.3g} mm deep, {:.3g} mm^3 a repeat\n",
             1e3 * std::max(bodies.height_depth, 0.0), 1e9 * bodies.height_volume);
  fmt::print(
      "tows as bodies       {:.2g} % off the closed volume, {:.2g} % of it in two tows ({:.3g} mm voxels)\n",
      100.0 * bodies.volume_error, 100.0 * bodies.overlap_share, 1e3 * bodies.voxel);
}

void print_stack(const mesoscale::StackSummary& s) {
  fmt::print(
      "stack of {} plies     {:.3f} mm nested, {:.3f} mm apart; tows with their voids {:.3f}, glass {:.3f}, "
      "voids {:.3f}\n",
      s.plies, 1e3 * s.thickness, 1e3 * s.apart, s.shares.tows, s.shares.glass,
      std::max(s.shares.voids, 0.0));
}

void print_friction(const FrictionStage& stage) {
  fmt::print("{:<24}{:>9}{:>12}{:>11}{:>9}{:>12}{:>9}\n", "pull", "mu", "force N", "measured", "error",
             "paper", "error");
  const auto percent = [](const std::optional<double>& e) {
    return e ? fmt::format("{:+.1f} %", 100.0 * *e) : std::string();
  };
  const auto force = [](const std::optional<double>& f) {
    return f ? fmt::format("{:.0f}", *f) : std::string();
  };
  double square = 0.0, paper_square = 0.0;
  int measured = 0, of_paper = 0;
  for (const FrictionTestRow& row : stage.test) {
    const auto error = error_of_model(row), paper = error_of_paper(row);
    fmt::print("{:<24}{:>9.4f}{:>12.1f}{:>11}{:>9}{:>12}{:>9}\n", row.name, row.friction_coefficient,
               row.pull_force, force(row.measured_force), percent(error), force(row.paper_force),
               percent(paper));
    if (error) square += *error * *error, ++measured;
    if (paper) paper_square += *paper * *paper, ++of_paper;
  }
  if (measured > 0) fmt::print("RMS error {:.2f} %", 100.0 * std::sqrt(square / measured));
  if (of_paper > 0)
    fmt::print(", the paper's own model {:.2f} %", 100.0 * std::sqrt(paper_square / of_paper));
  if (measured > 0) fmt::print("\n");
  for (const std::string& note : stage.notes) fmt::print("{}\n", note);
}

void print_friction_rig(const FrictionRigStage& stage) {
  fmt::print("{:<32}{:>9}{:>9}{:>9}{:>9}{:>11}\n", "pull as a machine", "law N", "steady N", "peak N",
             "lost N", "elements N");
  const auto force = [](const std::optional<double>& f) {
    return f ? fmt::format("{:.1f}", *f) : std::string("-");
  };
  for (const FrictionRigRow& row : stage.rows) {
    const auto lost =
        row.normal_force_loss ? std::optional(*row.normal_force_loss * row.normal_force) : std::nullopt;
    fmt::print("{:<32}{:>9.1f}{:>9}{:>9}{:>9}{:>11}\n", row.name, row.law_force, force(row.steady_force),
               force(row.peak_force), force(lost), force(row.element_force));
  }
  for (const std::string& note : stage.notes) fmt::print("{}\n", note);
}

void print_stamping(const macroscale::StampingSummary& s, const std::optional<macroscale::GridError>& grid) {
  const bool known = grid && grid->known;
  const macroscale::GridError e = grid.value_or(macroscale::GridError{});
  const auto error = [&](double value, const char* unit) {
    return known ? fmt::format(" (estimated grid error {:.2g} {})", value, unit) : std::string();
  };
  fmt::print("peak punch force     {:.1f} N{}\n", s.peak_punch_force, error(e.force, "N"));
  fmt::print("largest shear angle  {:.2f} deg{}\n", degrees * s.shear_angle_max,
             error(degrees * e.shear_angle, "deg"));
  fmt::print("largest draw-in      {:.2f} mm{}\n", 1e3 * s.draw_in_max, error(1e3 * e.draw_in, "mm"));
  if (grid && !known) fmt::print("grid error           not known: {}\n", grid->reason);
  fmt::print("energy residual      {:.2e} of the punch work\n", s.energy_residual_max);
  fmt::print("force balance        {:.2e} of the punch force\n", s.force_balance_residual_max);
  fmt::print("steps                {} ({} tried again with half the step), {} Newton iterations, {} nodes\n",
             s.steps, s.rejected_steps, s.newton_iterations, s.nodes);
}

// What the report says that a reader of the terminal must not miss.
void print_attention(const ReportInput& input) {
  for (const Verdict& verdict : verdicts(input))
    if (verdict.tone == Tone::attention || verdict.tone == Tone::fails)
      fmt::print("attention            {}\n", verdict.text);
}

}  // namespace

void print_findings(const Case& a_case, const Findings& findings, Part part,
                    const std::filesystem::path& folder) {
  if (findings.cell && part != Part::friction) print_cell(findings.cell->summary, findings.pictures->bodies);
  if (findings.stack && part != Part::friction) print_stack(findings.stack->summary);
  if (findings.solid && part != Part::friction) print_solid(*findings.solid);
  if (findings.friction && !findings.stamping) print_friction(*findings.friction);
  if (findings.friction_rig && !findings.stamping) print_friction_rig(*findings.friction_rig);
  if (findings.stamping) print_stamping(findings.stamping->summary, findings.grid_error);
  print_attention(report_input(a_case, findings));
  fmt::print("results              {}\n", folder.string());
}

}  // namespace heddle::pipeline
