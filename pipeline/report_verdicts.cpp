#include <fmt/format.h>

#include <algorithm>
#include <cmath>

#include "core/units.h"
#include "pipeline/report.h"
#include "pipeline/report_heat.h"
#include "pipeline/report_solid.h"

namespace heddle::pipeline {

namespace {

/// A share as the reader says it: "0.4 %"; what is too small to matter is not drawn out in digits.
std::string percent(double share) {
  if (share == 0.0) return "0 %";
  if (std::abs(share) < 1e-6) return "less than 0.0001 %";
  return significant(100.0 * share, 2) + " %";
}

std::string limit_text(double limit) {
  return fmt::format("limit {:g} %", 100.0 * limit);
}

std::string counted(int number, std::string_view one, std::string_view many) {
  return fmt::format("{} {}", number, number == 1 ? one : many);
}

class Verdicts {
 public:
  void add(Tone tone, std::string text) { list_.push_back({tone, std::move(text)}); }
  /// A quantity with a limit: holds below it, and otherwise `tone`.
  void weigh(double value, double limit, Tone tone, const std::string& good, const std::string& bad) {
    // Not-a-number is on neither side of a limit, and must not pass.
    const bool within = value <= limit;
    add(within ? Tone::holds : tone,
        fmt::format("{} ({}, {}).", within ? good : bad, percent(value), limit_text(limit)));
  }
  std::vector<Verdict> list() && { return std::move(list_); }

 private:
  std::vector<Verdict> list_;
};

void what_was_stamped(Verdicts& out, const ReportInput& input) {
  const auto& summary = *input.stamping;
  std::string travelled = "The punch did not move";
  if (!input.history.empty()) {
    const auto& last = input.history.back();
    travelled = fmt::format("The punch travelled {} mm in {} s",
                            significant(1e3 * last.punch_displacement, 3), significant(last.time, 3));
  }
  const std::string effort = fmt::format(
      "{}, {} tried again with half the step, {}", counted(summary.steps, "step", "steps"),
      summary.rejected_steps, counted(summary.newton_iterations, "Newton iteration", "Newton iterations"));
  if (summary.completed) {
    out.add(Tone::holds, fmt::format("{}: {}, on {} nodes.", travelled, effort, summary.nodes));
  } else {
    out.add(Tone::fails,
            fmt::format("{}, then the run stopped: {}. Results below are those up to there ({}).", travelled,
                        summary.failure.empty() ? "no reason was given" : summary.failure, effort));
  }
}

void peak_force(Verdicts& out, const ReportInput& input) {
  std::string where;
  if (!input.history.empty()) {
    const auto peak =
        std::max_element(input.history.begin(), input.history.end(),
                         [](const auto& a, const auto& b) { return a.punch_force < b.punch_force; });
    where = fmt::format(", reached at {} mm", significant(1e3 * peak->punch_displacement, 3));
  }
  std::string error;
  if (input.grid_error && input.grid_error->known)
    error = fmt::format(" (estimated grid error {} N)", significant(input.grid_error->force, 2));
  out.add(Tone::note, fmt::format("Peak punch force: {} N{}{}.",
                                  significant(input.stamping->peak_punch_force, 4), error, where));
}

void grid(Verdicts& out, const ReportInput& input) {
  if (!input.grid_error) return;
  const auto& error = *input.grid_error;
  if (!error.known) {
    out.add(Tone::note, fmt::format("The error that the grid leaves is not known: {}.", error.reason));
    return;
  }
  out.weigh(error.force_share, limits.grid_error, Tone::attention,
            fmt::format("The grid leaves an estimated {} N, {}° and {} mm in force, shear and draw-in, from "
                        "the same case on a spacing of {} mm",
                        significant(error.force, 2), significant(degrees * error.shear_angle, 2),
                        significant(1e3 * error.draw_in, 2), significant(1e3 * error.spacing[0], 3)),
            "The grid leaves a noticeable error in the punch force: use a smaller blank.spacing");
}

void shear_and_draw_in(Verdicts& out, const ReportInput& input) {
  const double angle = degrees * input.stamping->shear_angle_max;
  std::string beside;
  Tone tone = Tone::note;
  if (input.cell && input.cell->gap_closure_angle > 0.0) {
    const double closure = degrees * input.cell->gap_closure_angle,
                 locking = degrees * input.cell->locking_angle;
    if (locking > 0.0 && angle > locking) {
      tone = Tone::attention;
      beside = fmt::format(", beyond the locking angle of {:.1f}°: expect wrinkles", locking);
    } else if (angle > closure) {
      beside =
          fmt::format(", beyond gap closure at {:.1f}°: neighbouring tows press on one another", closure);
    } else {
      beside = fmt::format(", below gap closure at {:.1f}°", closure);
    }
  }
  out.add(tone, fmt::format("Largest shear angle: {:.1f}°{}.", angle, beside));
  out.add(Tone::note, fmt::format("Draw-in: the outline moved in by up to {} mm.",
                                  significant(1e3 * input.stamping->draw_in_max, 3)));
  if (!input.stamping->release) return;
  const macroscale::HistoryRow& released = input.stamping->release->row;
  out.add(Tone::note,
          fmt::format(
              "Released, the blank springs back by up to {} mm: its largest shear angle is then {:.1f}°, its "
              "largest draw-in {} mm. Pictures show it released.",
              significant(1e3 * input.stamping->release->moved, 3), degrees * released.shear_angle_max,
              significant(1e3 * released.draw_in_max, 3)));
}

void balances(Verdicts& out, const macroscale::StampingSummary& summary) {
  out.weigh(summary.energy_residual_max, limits.energy_residual, Tone::fails, "The energy ledger closes",
            "The energy ledger does not close");
  out.weigh(summary.force_balance_residual_max, limits.force_balance, Tone::fails,
            "Forces balance with inertia", "Forces do not balance");
  out.weigh(summary.numerical_dissipation_share, limits.numerical_dissipation, Tone::attention,
            "Time stepping takes little energy of its own",
            "Time stepping takes a noticeable part of the punch work: use more steps");
  out.weigh(summary.twist_share, limits.twist, Tone::attention,
            "The twist control stays small in the stored energy",
            "The twist control holds a noticeable part of the stored energy");
}

void symmetry(Verdicts& out, const macroscale::StampingSummary& summary) {
  if (summary.symmetry_gap_shear < 0.0 || summary.symmetry_gap_draw_in < 0.0) {
    out.add(Tone::note,
            "The blank, its grid or the press have not got the eight symmetries of the square about the "
            "tows, so there "
            "is nothing to check by symmetry.");
    return;
  }
  const double gap = std::max(summary.symmetry_gap_shear, summary.symmetry_gap_draw_in);
  out.weigh(gap, limits.symmetry, Tone::attention,
            "Shear and draw-in share the eight symmetries of the square, so nothing has buckled",
            "Shear or draw-in break the eight symmetries of the square: look for buckling in the pictures");
}

void artefacts(Verdicts& out, const macroscale::ArtefactSpec& artefact) {
  if (artefact.mass_scaling == 1.0 && artefact.stabilisation == 0.0) {
    out.add(Tone::holds, "Nothing non-physical is switched on: true mass, no stabilisation.");
  }
  if (artefact.mass_scaling != 1.0) {
    out.add(Tone::attention,
            fmt::format("Not physics: mass is scaled by {:g}; forces carry inertia the press does not have.",
                        artefact.mass_scaling));
  }
  if (artefact.stabilisation != 0.0) {
    out.add(Tone::attention,
            fmt::format(
                "Not physics: nodal damping of {:g} N s/m³ is switched on; its work stands in the ledger.",
                artefact.stabilisation));
  }
}

void friction_range(Verdicts& out, const macroscale::StampingSummary& summary) {
  const double share = summary.friction_work_outside;
  if (share == 0.0) {
    out.add(Tone::holds,
            "All friction work was done inside the range in which the friction law was calibrated.");
  } else {
    out.add(share <= limits.outside_calibration ? Tone::note : Tone::attention,
            fmt::format("{} of the friction work was done outside the range in which the friction law was "
                        "calibrated; there its "
                        "logarithmic slope is held.",
                        percent(share)));
  }
  if (summary.falling_branch) {
    out.add(Tone::attention,
            "Friction fell with speed somewhere: sliding may be unstable there, and the solution need not be "
            "the only one.");
  }
  if (summary.friction_swing > 0.0)
    out.add(
        Tone::attention,
        fmt::format("Contact came and went with every update of its friction at some nodes; up to {} of all "
                    "friction stands for the mean of that.",
                    percent(summary.friction_swing)));
  if (summary.crush_share > 1.0)
    out.add(Tone::attention,
            fmt::format("Fabric was pressed to {:.3g} MPa, {:.2g} times the last pressure of its compaction "
                        "table: there the table's last slope is carried on, and the tows would be crushed.",
                        1e-6 * summary.pressure_max, summary.crush_share));
}

void friction_comparison(Verdicts& out, const ReportInput& input) {
  const auto root_mean_square = [&](auto error_of, int& count) {
    double sum = 0.0;
    count = 0;
    for (const FrictionTestRow& row : input.friction_test) {
      if (const auto error = error_of(row)) sum += *error * *error, ++count;
    }
    return count > 0 ? std::sqrt(sum / count) : 0.0;
  };
  int ours = 0, theirs = 0;
  const double model = root_mean_square(error_of_model, ours),
               paper = root_mean_square(error_of_paper, theirs);
  if (ours == 0) return;
  std::string text =
      fmt::format("Against {}, the pull force is off by {} (root mean square)",
                  counted(ours, "measured friction test", "measured friction tests"), percent(model));
  if (theirs > 0) text += fmt::format("; the published model is off by {}", percent(paper));
  out.add(Tone::note, text + ".");
}

void overlap(Verdicts& out, const std::optional<mesoscale::TowBodies>& bodies) {
  if (!bodies || bodies->height_depth <= 0.0) return;
  out.add(
      Tone::attention,
      fmt::format(
          "Tows reach into each other by up to {} mm, {} mm³ a repeat: a section fuller than the "
          "lens, or a half of it too flat for its path, overlaps with the tow that goes round it. lens and "
          "capped_lens do not.",
          significant(1e3 * bodies->height_depth, 2), significant(1e9 * bodies->height_volume, 3)));
}

void priors(Verdicts& out, const mesoscale::FabricProperties& fabric) {
  const auto& names = fabric.provenance.unverified;
  if (names.empty()) return;
  out.add(Tone::note, fmt::format("{} of the fabric {}, not measured: {}.",
                                  counted(static_cast<int>(names.size()), "constant", "constants"),
                                  names.size() == 1 ? "is a prior" : "are priors", fmt::join(names, ", ")));
}

}  // namespace

std::vector<Verdict> verdicts(const ReportInput& input) {
  Verdicts out;
  if (input.stamping) {
    what_was_stamped(out, input);
    peak_force(out, input);
    shear_and_draw_in(out, input);
    grid(out, input);
    balances(out, *input.stamping);
    symmetry(out, *input.stamping);
    artefacts(out, input.artefact);
    friction_range(out, *input.stamping);
    if (input.stamping->heat)
      for (Verdict& verdict : heat_verdicts(*input.stamping->heat))
        out.add(verdict.tone, std::move(verdict.text));
  }
  friction_comparison(out, input);
  overlap(out, input.tow_bodies);
  if (input.solid)
    for (Verdict& verdict : solid_verdicts(*input.solid)) out.add(verdict.tone, std::move(verdict.text));
  if (input.fabric) priors(out, *input.fabric);
  for (const std::string& warning : input.warnings) out.add(Tone::attention, warning);
  return std::move(out).list();
}

}  // namespace heddle::pipeline
