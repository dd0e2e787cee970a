// Effects of forming hidden in punch forces of a finer grid, at several speeds and binder forces.
#include <catch2/catch.hpp>

#include <algorithm>
#include <cmath>
#include <fstream>
#include <memory>
#include <string>
#include <vector>

#include "pipeline/cache.h"
#include "pipeline/case.h"
#include "pipeline/discover/random.h"
#include "pipeline/discover_stamping.h"
#include "tests/pipeline/scratch.h"

using namespace heddle;
using namespace heddle::test;

namespace {

// The shipped case of discovery, coarse, with friction known from coupons: what else the binder does is then
// to be seen.
const std::vector<std::string> coarse{
    "blank.spacing=20 mm",
    "process.steps=16",
    "process.punch={stroke: 50 mm, time: 0.307 s}",
    "discover.effects=shear_rate shear_locking tension_shear_coupling bending "
    "tow_rate_stiffening inertia binder_force_level press_compliance discretisation",
    "discover.prior.friction.coefficient=[0.3, 0.01]",
    "discover.stretches=10",
    "discover.held_out=30 %"};

struct Condition {
  std::string name;
  double speed, binder_force;
};
const std::vector<Condition> conditions{{"slow", 0.5, 1000.0},
                                        {"weak", 1.0, 400.0},
                                        {"usual", 1.0, 1000.0},
                                        {"strong", 1.0, 2500.0},
                                        {"fast", 2.0, 1000.0}};

class Press {
 public:
  Press()
      : cache_({}, [](const std::string&) {}),
        runs_(fs::path(source_dir) / "configs/discover/stamping.yaml", coarse, cache_,
              [](const std::string&) {}) {}

  /// Five blanks a condition, a gain of 2 % for a blank and 1 % a point, on a grid 1.4 times as fine with
  /// half as many steps again and other numbers than the case has.
  pipeline::StampingDiscovery look_for(const std::vector<std::string>& hidden, std::uint64_t seed) {
    std::vector<std::string> truth{"blank.spacing=14 mm", "process.steps=24", "friction.coefficient=0.297",
                                   "forming.tow_friction=0.22"};
    truth.insert(truth.end(), hidden.begin(), hidden.end());
    discover::Random random(seed);
    const fs::path table = scratch_ / "stampings.csv";
    std::ofstream file(table);
    file << "condition_id,sample_id,day_id,speed_scale,binder_force_N,tool_temperature_C,blank_temperature_C,"
            "orientation_deg,punch_displacement_mm,punch_force_N\n";
    for (const Condition& c : conditions) {
      std::vector<std::string> keys = truth;
      keys.push_back("process.punch.speed_scale=" + pipeline::shortest(c.speed));
      keys.push_back("process.binder_force=" + pipeline::shortest(c.binder_force) + " N");
      const pipeline::ForceCurve& curve = runs_(keys);
      REQUIRE(curve.completed);
      for (int sample = 0; sample < 5; ++sample) {
        const double gain = 0.02 * random.normal();
        for (std::size_t k = 0; k < curve.stroke.size(); ++k)
          file << c.name << ',' << c.name << sample << ",d1," << c.speed << ',' << c.binder_force
               << ",85,180,0," << 1e3 * curve.stroke[k] << ','
               << curve.force[k] * std::exp(gain + 0.01 * random.normal()) << '\n';
      }
    }
    file.close();
    return pipeline::discover_stamping_in(runs_.case_with({}), runs_, table);
  }

 private:
  Scratch scratch_;
  pipeline::Cache cache_;
  pipeline::StampingRuns runs_;
};

bool in_set(const discover::Decision& decision, const std::string& id) {
  return std::ranges::count(decision.candidate_set, id) > 0;
}

std::string told(const pipeline::StampingDiscovery& found) {
  std::string text = discover::in_words(found.record.findings.decision.answer);
  for (const std::string& id : found.record.findings.decision.candidate_set) text += " " + id;
  for (const std::string& reason : found.record.findings.decision.reasons) text += "; " + reason;
  return text;
}

}  // namespace

TEST_CASE(
    "effects of forming hidden in the force of a finer grid are named or left among few, and none where none "
    "is",
    "[pipeline][discover][slow]") {
  using discover::Answer;
  Press press;
  const auto none = press.look_for({}, 11);
  WARN("nothing hidden: " << told(none));
  const Answer nothing = none.record.findings.decision.answer;
  CHECK(nothing != Answer::named);
  CHECK(nothing != Answer::named_incomplete);

  const auto level = press.look_for({"effects.binder_force_level.error=0.4"}, 12);
  WARN("binder force off by 40 %: " << told(level));
  const auto& of_level = level.record.findings.decision;
  CHECK((of_level.answer == Answer::named || of_level.answer == Answer::one_of));
  CHECK(in_set(of_level, "binder_force_level"));

  const auto locking = press.look_for({"effects.shear_locking={amplitude: 150 N/m, angle: 20 deg}"}, 13);
  WARN("locking from 20 degrees on: " << told(locking));
  const auto& of_locking = locking.record.findings.decision;
  CHECK((of_locking.answer == Answer::named || of_locking.answer == Answer::one_of));
  CHECK(in_set(of_locking, "shear_locking"));
}
