// A stamping whose sheet may meet itself and does not.
#include <catch2/catch.hpp>

#include <string>
#include <vector>

#include "macroscale/checkpoint.h"
#include "macroscale/stamping.h"
#include "tests/macroscale/sample_fabric.h"
#include "tests/macroscale/sample_stamping.h"

using namespace heddle::macroscale;
using heddle::Hdf5Writer;
using heddle::test::coarse_stamping;
using heddle::test::coulomb;
using heddle::test::make_fabric;

namespace {

std::string bytes_of(const StampingCheckpoint& checkpoint) {
  Hdf5Writer file;
  write(file, "/stamping", checkpoint);
  return file.finish();
}

struct Kept {
  std::vector<std::string> checkpoints;
  StampingResult result;
};

Kept run(const StampingSpec& spec, const heddle::mesoscale::FabricProperties& fabric,
         StampingControl control = {}) {
  Kept kept;
  control.keep = [&](const StampingCheckpoint& c, bool) { kept.checkpoints.push_back(bytes_of(c)); };
  kept.result = run_stamping(spec, fabric, coulomb(), control);
  return kept;
}

}  // namespace

TEST_CASE("a stamping without a fold keeps its bytes, those of its checkpoint too",
          "[macroscale][self_contact][invariant]") {
  StampingSpec spec = coarse_stamping(4);
  const auto fabric = make_fabric({.rate_consistency = 5.0});
  const Kept with = run(spec, fabric);
  spec.self_contact = false;
  const Kept without = run(spec, fabric);
  REQUIRE(with.result.summary.completed);
  CHECK(with.checkpoints == without.checkpoints);
  REQUIRE(with.result.summary.self_contact);
  CHECK_FALSE(with.result.summary.self_contact->met);
  CHECK_FALSE(without.result.summary.self_contact);
}
