// What a run of several plies leaves behind: files and pages, from a made-up stack.
#include <catch2/catch.hpp>

#include <algorithm>

#include "macroscale/ply_state.h"
#include "pipeline/export_vtu.h"
#include "pipeline/outputs.h"
#include "pipeline/report_plies.h"
#include "sample_run.h"

using namespace heddle;
using namespace heddle::pipeline;
using Catch::Matchers::Contains;

namespace {

template <class T>
void append(std::vector<T>& list, const std::vector<T>& more) {
  list.insert(list.end(), more.begin(), more.end());
}

macroscale::BlankState two_plies(int cells) {
  macroscale::BlankState below = sample::blank(cells), above = sample::blank(cells);
  const int nodes = static_cast<int>(below.position.size()), quads = static_cast<int>(below.quads.size());
  for (auto& x : above.position) x[2] += 1.5e-3;
  for (auto& quad : above.quads)
    for (int& node : quad) node += nodes;
  append(below.grid, above.grid);
  append(below.reference, above.reference);
  append(below.position, above.position);
  append(below.velocity, above.velocity);
  append(below.shear_angle, above.shear_angle);
  append(below.tow_strain, above.tow_strain);
  append(below.pressure, above.pressure);
  append(below.slip_speed, above.slip_speed);
  append(below.friction_coefficient, above.friction_coefficient);
  append(below.hersey, above.hersey);
  append(below.quads, above.quads);
  below.plies = {{cells, cells, 0, nodes, 0, quads, 0, 0},
                 {cells, cells, nodes, 2 * nodes, quads, 2 * quads, 0, 0}};
  below.ply_slip.assign(below.position.size(), 2e-3);
  below.ply_pressure.assign(below.position.size(), 1e4);
  return below;
}

}  // namespace

TEST_CASE("a file of several plies says of each point which ply it belongs to, a file of one ply does not",
          "[outputs][plies]") {
  const macroscale::BlankState blank = two_plies(4);
  const QuadMesh mesh = mesh_of(blank);
  const auto find = [](const QuadMesh& of, const std::string& name) {
    return std::find_if(of.point_data.begin(), of.point_data.end(),
                        [&](const auto& a) { return a.name == name; });
  };
  const auto ply = find(mesh, "ply");
  REQUIRE(ply != mesh.point_data.end());
  CHECK(ply->values.size() == blank.position.size());
  CHECK(ply->values.front() == 1.0);
  CHECK(ply->values.back() == 2.0);
  REQUIRE(find(mesh, "slip_between_plies_mm") != mesh.point_data.end());
  CHECK(find(mesh, "slip_between_plies_mm")->values.front() == Approx(2.0));
  const QuadMesh one = mesh_of(macroscale::ply_of(blank, 1));
  CHECK(find(one, "ply") == one.point_data.end());
  CHECK(one.points.size() * 2 == mesh.points.size());
}

TEST_CASE("the report shows every ply and what lies between; of one ply it says nothing of plies",
          "[report][plies]") {
  ReportInput input;
  input.blank = two_plies(8);
  input.stamping = sample::stamping();
  CHECK(plies_section(input).empty());
  input.stamping->stack = macroscale::StackSummary{
      .plies = {{0.0, 0.5, 0.02}, {0.25 * std::numbers::pi, 0.6, 0.03}}, .interfaces = {{20e-3, 11e-3}}};
  const std::string section = plies_section(input);
  CHECK_THAT(section, Contains("Ply 1 from below") && Contains("Ply 2 from below") && Contains("45°") &&
                          Contains("20.0 mm") && Contains("11.0 mm"));
}
