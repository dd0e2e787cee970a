#include "pipeline/friction_rig_stage.h"

#include <algorithm>
#include <cmath>
#include <numbers>
#include <utility>

#include <fmt/format.h>

#include "friction/rig/curved_plates.h"
#include "friction/rig/machine.h"
#include "friction/test_design.h"
#include "macroscale/pull_out.h"
#include "pipeline/stages.h"

namespace heddle::pipeline {

namespace {

constexpr double curved_spacing = 1.0 / 10.0;  ///< of the nodes on curved plates, share of their radius

struct Pull {
  friction::FrictionTestRow row;
  bool curved = false;
};

/// The measured pulls, then the design's one at a time; a name stands for one pull.
std::vector<Pull> pulls_of(const FrictionTestSpec& test, FrictionRigStage& stage, bool can_curve) {
  std::vector<Pull> pulls;
  for (const auto& row : friction::read_friction_table(test.data.string())) pulls.push_back({row});
  if (test.design.empty()) return pulls;
  const friction::TestDesign design = friction::read_test_design(test.design.string());
  const auto designed = friction::one_at_a_time(design);
  for (friction::FrictionTestRow row : designed) {
    const bool taken =
        std::any_of(pulls.begin(), pulls.end(), [&](const Pull& p) { return p.row.name == row.name; });
    if (taken) row.name += " of the design";
    pulls.push_back({row});
  }
  if (!design.s_curve) return pulls;
  if (!can_curve) {
    stage.notes.push_back(
        "The design's S-curve plates were left out: how they share the load follows from the fabric's "
        "compaction, which needs `weave:`.");
    return pulls;
  }
  friction::FrictionTestRow curved = designed.front();
  curved.name = "S-curve plates";
  pulls.push_back({curved, true});
  return pulls;
}

/// The rig's numbers that all pulls share.
struct Bench {
  const FrictionSpec& friction;
  const FrictionMachineSpec& machine;
  const friction::Model& model;
  const mesoscale::FabricProperties* fabric;
  friction::AreaFunction area;

  double length() const { return std::sqrt(friction.rig.plate_area); }  ///< of the square plates [m]
};

double law_force(const Bench& bench, const Pull& pull) {
  if (!pull.curved)
    return friction::run_friction_test(bench.model, pull.row, bench.friction.rig, bench.area).pull_force;
  return friction::pull_over(bench.machine.bend, bench.model, pull.row, bench.friction.rig,
                             bench.fabric->compaction.curves().front(), bench.length(), bench.area)
      .pull_force;
}

macroscale::PullOutSpec elements_of(const Bench& bench, const Pull& pull) {
  const friction::FrictionRig& rig = bench.friction.rig;
  macroscale::PullOutSpec spec;
  spec.size = {bench.length(), bench.length()};
  spec.spacing = bench.length() / 10.0;
  spec.orientation = pull.row.orientation;
  spec.normal_force = pull.row.normal_force;
  spec.speed = pull.row.velocity;
  spec.tool_temperature = pull.row.tool_temperature;
  spec.fabric_temperature = pull.row.fabric_temperature;
  spec.contact_pressure = bench.friction.contact_pressure;
  // Along the tows the last 2 mm are enough, with the memory of what came before. At an angle to them the
  // sample shears under its own pull before all of it slides.
  const bool sheared = std::abs(std::sin(2.0 * pull.row.orientation)) > 1e-9;
  spec.travel = sheared ? rig.pull_length : std::min(2e-3, 0.5 * rig.pull_length);
  spec.steps = sheared ? 100 : 20;
  friction::FrictionRig before = rig;
  before.pull_length -= spec.travel;
  spec.memory =
      friction::state_after_pull(bench.model, friction::contact_of(pull.row, rig, bench.area), before);
  if (pull.curved) {
    spec.bend = bench.machine.bend;
    spec.spacing = std::min(spec.spacing, curved_spacing * bench.machine.bend.radius);
  }
  return spec;
}

void run_elements(const Bench& bench, const Pull& pull, FrictionRigRow& row, FrictionRigStage& stage) {
  const macroscale::PullOutSpec spec = elements_of(bench, pull);
  const auto result = macroscale::run_pull_out(spec, *bench.fabric, bench.model);
  if (!result.completed) {
    stage.notes.push_back(
        fmt::format("The finite elements did not finish the pull {}: {}.", pull.row.name, result.failure));
    return;
  }
  row.element_force = result.steady_force;
  const bool pictured = stage.plates.empty() || pull.curved;
  if (!pictured) return;
  stage.plates.push_back({.name = pull.row.name,
                          .nx = result.nu + 1,
                          .ny = result.nv + 1,
                          .spacing_x = spec.size[0] / result.nu,
                          .spacing_y = spec.size[1] / result.nv,
                          .lower = result.lower_pressure,
                          .upper = result.upper_pressure});
}

void run_history(const Bench& bench, const Pull& pull, FrictionRigRow& row, FrictionRigStage& stage) {
  const friction::RigRun run =
      friction::run_machine(bench.model, pull.row, bench.friction.rig, bench.machine.machine, bench.area);
  row.peak_force = run.peak_force;
  // Where there is no peak the largest force lies anywhere in the steady part.
  if (run.peak_force > 1.001 * run.steady_force) row.peak_displacement = run.peak_displacement;
  row.steady_force = run.steady_force;
  row.steady_coefficient = run.steady_coefficient;
  row.normal_force_loss = run.force_loss;
  row.film_temperature = run.samples.back().film_temperature;
  for (const friction::RigSample& s : run.samples)
    stage.history.push_back(
        {row.name, s.time, s.displacement, s.pull_force, s.normal_force, s.coefficient, s.film_temperature});
}

FrictionRigRow rig_row(const Bench& bench, const Pull& pull) {
  FrictionRigRow row;
  row.name = pull.row.name;
  row.velocity = pull.row.velocity;
  row.normal_force = pull.row.normal_force;
  row.tool_temperature = pull.row.tool_temperature;
  row.fabric_temperature = pull.row.fabric_temperature;
  row.orientation = pull.row.orientation;
  row.curved = pull.curved;
  row.law_force = law_force(bench, pull);
  row.measured_force = pull.row.measured_force;
  row.paper_force = pull.row.paper_model_force;
  return row;
}

/// What of the machine is assumed, and how far law and finite elements are apart.
void add_notes(const Bench& bench, FrictionRigStage& stage) {
  const friction::Drive& drive = bench.machine.machine.drive;
  stage.notes.push_back(fmt::format(
      "The rig's numbers are priors: stiffness {:g} N/m, holder {:g} kg, damping {:g} of critical, "
      "acceleration {:g} "
      "m/s^2, backlash {:g} mm above {:g} mm/s{}{}.",
      drive.stiffness, drive.holder_mass, drive.damping, drive.acceleration, 1e3 * drive.backlash,
      1e3 * drive.own_speed,
      bench.machine.machine.cam ? "; and how its load relaxes under the cam" : "; the normal force is held",
      std::any_of(stage.rows.begin(), stage.rows.end(), [](const auto& row) { return row.curved; })
          ? fmt::format("; S-curve plates of {:g} mm and {:.3g} deg", 1e3 * bench.machine.bend.radius,
                        bench.machine.bend.angle * 180.0 / std::numbers::pi)
          : ""));
  double worst = 0.0;
  int compared = 0;
  std::string where;
  for (const FrictionRigRow& row : stage.rows) {
    if (!row.element_force) continue;
    const double gap = std::abs(*row.element_force / row.law_force - 1.0);
    ++compared;
    if (gap < worst) continue;
    worst = gap;
    where = row.name;
  }
  if (compared > 0)
    stage.notes.push_back(
        fmt::format("Law and finite elements differ by at most {:.2f} % over {} pulls ({}).", 100.0 * worst,
                    compared, where));
}

}  // namespace

FrictionRigStage run_friction_rig_stage(const Case& a_case, const friction::Model& model,
                                        const mesoscale::FabricProperties* fabric) {
  const Bench bench{.friction = *a_case.friction,
                    .machine = *a_case.friction_machine,
                    .model = model,
                    .fabric = fabric,
                    .area = area_function(*a_case.friction, fabric)};
  FrictionRigStage stage;
  for (const Pull& pull : pulls_of(*a_case.friction_test, stage, fabric != nullptr)) {
    FrictionRigRow row = rig_row(bench, pull);
    if (!pull.curved) run_history(bench, pull, row, stage);
    if (bench.machine.finite_elements) run_elements(bench, pull, row, stage);
    stage.rows.push_back(std::move(row));
  }
  add_notes(bench, stage);
  return stage;
}

}  // namespace heddle::pipeline
