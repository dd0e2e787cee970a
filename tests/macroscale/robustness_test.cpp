// Random stampings that must come to their end; benchmarks/robustness.cpp runs all 200.
#include <catch2/catch.hpp>

#include "mesoscale/cell_spec.h"
#include "tests/macroscale/random_stampings.h"
#include "tests/macroscale/sample_fabric.h"

using namespace heddle;

// The first ones, and those that once did not come to their end: friction that turns round at hundreds of
// nodes at once (7), a film that drags at the first touch (13, 35), wrinkles at a light binder (14), slip
// that sets in as a front where friction falls with speed (25), tows so tense that the fabric is crushed on
// the shoulder (37, 53), much binder force that rubs next to nothing (162).
TEST_CASE("random stampings of any law, binder, speed, weave direction and fabric come to their end",
          "[macroscale][robustness][slow]") {
  const mesoscale::FabricProperties fabric = mesoscale::analyse(mesoscale::CellSpec{}).fabric;
  const int number = GENERATE(0, 1, 2, 3, 4, 5, 6, 7, 8, 9, 10, 11, 12, 13, 14, 25, 35, 37, 53, 162);
  const test::RandomStamping stamping = test::random_stamping(number, fabric);
  const test::RobustnessVerdict verdict = test::run(stamping);
  INFO("case " << number << ": " << verdict.failure);
  CHECK(verdict.finished);
  CHECK(verdict.energy_residual < 0.01);
  CHECK(verdict.force_balance < 1e-3);
  CHECK(verdict.summary.nodes <= 2000);
}

// Slope of the contact law from the softest as-woven fabric to the consolidated sheet. A light binder and a
// thick fabric, so that the softest is not pressed through.
TEST_CASE("from 1e7 to 5e10 Pa/m of contact slope no step fails, and the force settles as contact stiffens",
          "[macroscale][robustness][slow]") {
  macroscale::StampingSpec spec;
  spec.blank.spacing = 16e-3;  // 21 x 21 nodes
  spec.process.stroke = 40e-3;
  spec.process.time = 0.25;
  spec.process.steps = 20;
  spec.process.binder_force = 200.0;
  spec.die.opening_radius = spec.punch.radius + 4e-3;
  friction::Model law;
  law.law = friction::Coulomb{0.3};
  std::vector<double> force;
  for (const double slope : {1e7, 1e8, 1e9, 1e10, 5e10}) {
    const auto fabric = test::make_fabric(
        {.thickness = 3e-3, .contact_stiffness = slope, .table_end = slope < 1e8 ? 1.4e-3 : 5e-4});
    const macroscale::StampingSummary s = run_stamping(spec, fabric, law).summary;
    INFO("slope " << slope << " Pa/m: " << s.failure);
    CHECK(s.completed);
    CHECK(s.rejected_steps == 0);
    CHECK(s.energy_residual_max < 0.01);
    force.push_back(s.peak_punch_force);
    WARN("contact slope " << slope << " Pa/m: " << force.back() << " N, " << s.newton_iterations
                          << " Newton iterations");
  }
  CHECK(force[4] == Approx(force[3]).epsilon(0.01));
}
