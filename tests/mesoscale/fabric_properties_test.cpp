#include "mesoscale/fabric_properties.h"

#include <algorithm>
#include <catch2/catch.hpp>
#include <cmath>
#include <limits>
#include <string>

#include "mesoscale/cell_spec.h"

using namespace heddle;
using namespace heddle::mesoscale;

namespace {

// Small and sound: w = (e1^2 + e2^2) 1e5, straight curves.
FabricProperties sound_fabric() {
  FabricProperties fabric;
  fabric.areal_density = 0.7;
  fabric.pitch = {5e-3, 5e-3};
  fabric.thickness = 1.5e-3;
  std::vector<double> energy;
  for (int i = 0; i < 6; ++i)
    for (int j = 0; j < 6; ++j) energy.push_back(1e5 * 1e-4 * (i * i + j * j));
  fabric.tension_energy = Surface(0.0, 0.01, 6, 0.0, 0.01, 6, energy);
  fabric.shear_stress = Curve({0.0, 0.5, 0.9}, {0.0, 1.0, 5.0});
  fabric.shear_rate = {5.0, 0.4, 5000.0, 453.15};
  fabric.bending = {Curve({273.0, 573.0}, {1e-3, 1e-3}), Curve({273.0, 573.0}, {1e-3, 1e-3})};
  fabric.compaction = CurveFamily({0.0}, {Curve({0.0, 1e-4, 2e-4}, {0.0, 1e3, 1e5})});
  fabric.contact.log_fraction = CurveFamily({0.0}, {Curve({2.0, 15.0}, {-3.0, -0.1})});
  return fabric;
}

bool has(const Problems& problems, const std::string& id) {
  return std::any_of(problems.begin(), problems.end(), [&](const Problem& p) { return p.id == id; });
}

}  // namespace

TEST_CASE("a sound fabric passes its check", "[fabric]") {
  CHECK(check(sound_fabric()).empty());
}

TEST_CASE("an empty fabric is refused table by table", "[fabric]") {
  const Problems problems = check(FabricProperties{});
  for (const char* id : {"fabric.areal_density.range", "fabric.pitch.warp.range", "fabric.pitch.weft.range",
                         "fabric.thickness.range", "fabric.tension_energy.empty", "fabric.shear_stress.empty",
                         "fabric.bending.warp.empty", "fabric.bending.weft.empty", "fabric.compaction.empty",
                         "fabric.contact.empty"}) {
    CAPTURE(id);
    CHECK(has(problems, id));
  }
}

TEST_CASE("numbers out of range are named", "[fabric]") {
  FabricProperties fabric = sound_fabric();
  fabric.areal_density = std::nan("");
  fabric.shear_rate = {-1.0, 1.5, -2.0, 0.0};
  fabric.bending[1] = Curve({273.0, 573.0}, {1e-3, -1e-3});
  const Problems problems = check(fabric);
  for (const char* id : {"fabric.areal_density.range", "fabric.shear_rate.consistency.range",
                         "fabric.shear_rate.index.range", "fabric.shear_rate.activation_temperature.range",
                         "fabric.shear_rate.reference_temperature.range", "fabric.bending.weft.range"}) {
    CAPTURE(id);
    CHECK(has(problems, id));
  }
}

TEST_CASE("tables that fall are named with the place", "[fabric]") {
  FabricProperties fabric = sound_fabric();
  fabric.shear_stress = Curve({0.0, 0.5, 0.9}, {0.0, 1.0, 0.5});
  fabric.compaction = CurveFamily({0.3}, {Curve({0.0, 1e-4, 2e-4}, {0.0, 1e3, 1e2})});
  fabric.contact.log_fraction = CurveFamily({0.0}, {Curve({2.0, 15.0}, {-0.1, -3.0})});
  const Problems problems = check(fabric);
  CHECK(has(problems, "fabric.shear_stress.monotone"));
  CHECK(has(problems, "fabric.compaction.monotone"));
  CHECK(has(problems, "fabric.contact.monotone"));
  CHECK_THAT(format(problems), Catch::Contains("point 2"));
  CHECK_THAT(format(problems), Catch::Contains("shear angle 0.3 rad"));
}

TEST_CASE("compaction must start at nothing and area must stay below the plate", "[fabric]") {
  FabricProperties fabric = sound_fabric();
  fabric.compaction = CurveFamily({0.0}, {Curve({0.0, 1e-4}, {10.0, 1e3})});
  fabric.contact.log_fraction = CurveFamily({0.0}, {Curve({2.0, 15.0}, {-3.0, 0.1})});
  CHECK(has(check(fabric), "fabric.compaction.start"));
  CHECK(has(check(fabric), "fabric.contact.range"));
}

TEST_CASE("an energy that is not convex is named with the strains", "[fabric]") {
  FabricProperties fabric = sound_fabric();
  std::vector<double> energy = fabric.tension_energy.values();
  energy[3 * 6 + 3] *= 1.5;
  fabric.tension_energy = Surface(0.0, 0.01, 6, 0.0, 0.01, 6, energy);
  CHECK(has(check(fabric), "fabric.tension_energy.convex"));
  CHECK_THAT(format(check(fabric)), Catch::Contains("strains (0.03, 0.03)"));
}
