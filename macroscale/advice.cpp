#include "macroscale/advice.h"

#include <fmt/format.h>

namespace heddle::macroscale {

namespace {

std::string finer_steps(const StampingSpec& spec) {
  return fmt::format("--set process.steps={}", 2 * spec.process.steps);
}

std::string other_force(const StampingSpec& spec, double factor) {
  return fmt::format("--set process.binder_force='{:.3g} N'", factor * spec.process.binder_force);
}

// A stroke that ends just before the last state that was reached.
std::string shorter_stroke(const StampingFailure& failure) {
  return fmt::format("--set process.punch.stroke='{:.3g} mm'", 0.95e3 * failure.blank.punch_displacement);
}

std::string while_closing(const StampingFailure& failure, const StampingSpec& spec) {
  if (failure.kind == FailureKind::pressed_through)
    return fmt::format(
        "The binder crushes the fabric before the punch moves: less force ({}), or a larger blank that "
        "spreads it.",
        other_force(spec, 0.3));
  switch (failure.kind) {
    case FailureKind::lost_tool:
      return "The binder's surface is not known where the blank lies: a tool file must cover the whole blank "
             "and stand the right way up (tools.*.file), or the blank is too large (blank.size).";
    case FailureKind::not_finite:
      return "A fabric or tool number is not usable: look at the quantities named above in fabric.json.";
    default:
      return "The binder did not come to rest: check process.binder_force, tools.binder.mass and the "
             "tools' files.";
  }
}

}  // namespace

std::string advice_for(const StampingFailure& failure, const StampingSpec& spec,
                       const StampingSummary& summary) {
  if (failure.step == 0) return while_closing(failure, spec);
  switch (failure.kind) {
    case FailureKind::folded:
      return fmt::format(
          "The fabric folds or locks there. Hold it more ({}), stop before ({}), or resolve the "
          "fold (--set blank.spacing='{:.3g} mm').",
          other_force(spec, 2.0), shorter_stroke(failure), 0.5e3 * spec.blank.spacing);
    case FailureKind::pressed_through:
      return fmt::format(
          "The tools leave no room for the fabric there. Less binder force ({}), a wider opening "
          "(tools.die.opening_radius), or stop before ({}).",
          other_force(spec, 0.3), shorter_stroke(failure));
    case FailureKind::lost_tool:
      return fmt::format(
          "The fabric was thrown further than a tool's distances reach in one step: smaller "
          "steps ({}), or a coarser voxel, whose band is wider (tools.*.voxel).",
          finer_steps(spec));
    case FailureKind::friction_loads:
      return fmt::format(
          "Contact comes and goes with the friction it makes. Smaller steps ({}), or a law that "
          "does not drag at the first touch (friction.law: stribeck, friction.form: power).",
          finer_steps(spec));
    case FailureKind::not_finite:
      return "A law has no value at the point named above: look at the friction parameters and effects "
             "switched on, and at tables read from files.";
    case FailureKind::indefinite:
      return fmt::format(
          "No direction lowers the energy, as in a fabric without stiffness: check fabric.json, "
          "then smaller steps ({}).",
          finer_steps(spec));
    case FailureKind::search:
      break;
  }
  if (summary.falling_branch)
    return fmt::format(
        "Friction falls with speed somewhere, so slip sets in by jumps and the solution may not be "
        "unique. Smaller steps ({}), or a law that does not fall (friction.law: stribeck, friction.form: "
        "power) "
        "to see whether that is all.",
        finer_steps(spec));
  return fmt::format("Try smaller steps ({}), or look at the last state (blank_failed.vtu) for a fold.",
                     finer_steps(spec));
}

}  // namespace heddle::macroscale
