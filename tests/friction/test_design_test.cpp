#include <catch2/catch.hpp>

#include "friction/test_design.h"
#include "tests/source_dir.h"

using namespace heddle::friction;

TEST_CASE("the paper's Table 2 reads as a baseline and eighteen other pulls", "[friction][design]") {
  const TestDesign design = read_test_design(std::string(heddle::test::source_dir) +
                                             "/tests/paper/data/friction_table2_design.csv");
  const auto rows = one_at_a_time(design);
  REQUIRE(rows.size() == 1 + 4 + 6 + 5 + 2 + 4);
  CHECK(rows[0].velocity == Approx(16.6e-3));
  CHECK(rows[0].tool_temperature == Approx(358.15));
  CHECK(rows[1].name == "velocity 1.66 mm/s");
  CHECK(rows[1].velocity == Approx(1.66e-3));
  CHECK(rows[1].normal_force == 1500.0);
  CHECK(all_combinations(design).size() == 5 * 7 * 6 * 3);
}

TEST_CASE("a design with faults is refused with all of them and their lines",
          "[friction][design][wrong input]") {
  try {
    parse_test_design(
        "parameter,unit,baseline,additional\nvelocity,m/"
        "s,16.6,1.66\nnormal_force,N,abc,218;\nhumidity,-,1,2\norientation,deg\n",
        "design.csv");
    FAIL("was accepted");
  } catch (const heddle::InputError& error) {
    const auto& p = error.problems();
    const auto has = [&](const std::string& id, int line) {
      return std::any_of(p.begin(), p.end(), [&](const auto& x) { return x.id == id && x.line == line; });
    };
    CHECK(has("friction.design.unit", 2));
    CHECK(has("friction.design.number", 3));
    CHECK(has("friction.design.parameter", 4));
    CHECK(has("csv.cells", 5));
  }
  const auto first_id = [](const char* text) -> std::string {
    try {
      parse_test_design(text, "design.csv");
    } catch (const heddle::InputError& error) {
      return error.problems().front().id;
    }
    return "accepted";
  };
  CHECK(first_id("velocity,mm/s,16.6,1.66\n") == "friction.design.header");
  CHECK(first_id("parameter,unit,baseline,additional\nvelocity,mm/s,16.6,1.66\n") ==
        "friction.design.missing");
}
