// A stamping whose sheet may meet itself and does not.
#include <catch2/catch.hpp>

#include "macroscale/stamping.h"
#include "tests/macroscale/kept_stamping.h"
#include "tests/macroscale/sample_fabric.h"
#include "tests/macroscale/sample_stamping.h"

using namespace heddle::macroscale;
using heddle::test::coarse_stamping;
using heddle::test::coulomb;
using heddle::test::Kept;
using heddle::test::make_fabric;
using heddle::test::run_and_keep;

TEST_CASE("a stamping without a fold keeps its bytes, those of its checkpoint too",
          "[macroscale][self_contact][invariant]") {
  StampingSpec spec = coarse_stamping(4);
  const auto fabric = make_fabric({.rate_consistency = 5.0});
  const Kept with = run_and_keep(spec, fabric, coulomb());
  spec.self_contact = false;
  const Kept without = run_and_keep(spec, fabric, coulomb());
  REQUIRE(with.result.summary.completed);
  CHECK(with.checkpoints == without.checkpoints);
  REQUIRE(with.result.summary.self_contact);
  CHECK_FALSE(with.result.summary.self_contact->met);
  CHECK_FALSE(without.result.summary.self_contact);
}
