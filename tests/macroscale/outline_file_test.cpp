#include <catch2/catch.hpp>
#include <numbers>

#include "macroscale/cad.h"
#include "macroscale/outline_file.h"
#include "tests/macroscale/sample_meshes.h"

using namespace heddle;
using namespace heddle::macroscale;
using namespace heddle::test;

namespace {

constexpr double pi = std::numbers::pi;

/// A DXF file around some entities, each written "code value code value ...".
std::string dxf(const std::string& entities, int units = 4) {
  std::string text =
      fmt::format("0\nSECTION\n2\nHEADER\n9\n$INSUNITS\n70\n{}\n0\nENDSEC\n0\nSECTION\n2\nENTITIES\n", units);
  for (char c : entities) text += c == ' ' ? '\n' : c;
  return text + "\n0\nENDSEC\n0\nEOF\n";
}

const std::string square = "0 LWPOLYLINE 90 4 70 1 10 0 20 0 10 100 20 0 10 100 20 100 10 0 20 100";

Outline read(const std::filesystem::path& file, double unit = 1e-3) {
  return read_outline({file, unit, 1e-5}, "blank.outline");
}

Problems refused(const std::filesystem::path& file, double unit = 1e-3) {
  return refusal([&] { read(file, unit); });
}

}  // namespace

TEST_CASE("DXF: each entity gives the border it draws", "[macroscale][outline_file]") {
  const Folder folder;
  SECTION("closed polyline, a circle in it as hole, notes passed over") {
    const Outline o =
        read(folder.write("a.dxf", dxf(square + " 0 CIRCLE 10 50 20 50 40 10 0 TEXT 10 3 20 3 1 blank")));
    CHECK(o.outer.size() == 4);
    REQUIRE(o.holes.size() == 1);
    CHECK(area(o) == Approx(1e-2 - pi * 1e-4).epsilon(1e-4));
  }
  SECTION("lines and arcs in any order and direction") {
    // A stadium: two half circles of radius 50 mm, 100 mm apart.
    const Outline o = read(
        folder.write("b.dxf", dxf("0 LINE 10 0 20 -50 11 100 21 -50 0 ARC 10 0 20 0 40 50 50 90 51 270 "
                                  "0 LINE 10 0 20 50 11 100 21 50 0 ARC 10 100 20 0 40 50 50 270 51 90")));
    CHECK(o.holes.empty());
    const double exact = 0.01 + pi * 0.05 * 0.05;
    CHECK(area(o) < exact);
    CHECK(area(o) > exact - 2.0 * pi * 0.05 * 1e-5);
  }
  SECTION("bulges of both signs") {
    // A square whose right side bulges out by a half circle, its left side in: the area stays that of the
    // square.
    const std::string bulged = "0 LWPOLYLINE 70 1 10 0 20 0 10 100 20 0 42 1 10 100 20 100 10 0 20 100 42 -1";
    const Outline o = read(folder.write("c.dxf", dxf(bulged)));
    CHECK(area(o) == Approx(1e-2).epsilon(1e-9));
    double reach = 0.0, notch = 1.0;
    for (const Point2& p : o.outer) {
      reach = std::max(reach, p[0]);
      if (std::abs(p[1] - 0.05) < 2e-3 && p[0] < 0.08) notch = std::min(notch, p[0]);
    }
    CHECK(reach == Approx(0.15).epsilon(1e-3));
    CHECK(notch == Approx(0.05).epsilon(1e-2));
    // A flat arc of a quarter turn: bulge tan(pi / 8) over a chord of 100 mm.
    const Outline quarter = read(folder.write(
        "d.dxf",
        dxf("0 LWPOLYLINE 70 1 10 0 20 0 42 0.41421356237309503 10 100 20 0 10 100 20 100 10 0 20 100")));
    const double r = 0.05 * std::sqrt(2.0), segment = 0.25 * pi * r * r - 0.5 * r * r;
    CHECK(area(quarter) == Approx(1e-2 + segment).epsilon(1e-4));
  }
  SECTION("old polylines, and one drawn from below, which mirrors x") {
    const std::string old =
        "0 POLYLINE 66 1 70 1 0 VERTEX 10 0 20 0 0 VERTEX 10 100 20 0 0 VERTEX 10 100 20 50 0 SEQEND";
    CHECK(area(read(folder.write("e.dxf", dxf(old)))) == Approx(2.5e-3).epsilon(1e-12));
    const Outline below = read(folder.write("f.dxf", dxf(square + " 210 0 220 0 230 -1")));
    CHECK(contains(below, -0.05, 0.05));
    CHECK_FALSE(contains(below, 0.05, 0.05));
  }
  SECTION("inches, and no unit at all") {
    CHECK(area(read(folder.write("g.dxf", dxf(square, 1)), 0.0254)) == Approx(2.54 * 2.54).epsilon(1e-12));
    CHECK(area(read(folder.write("h.dxf", dxf(square, 0)), 1e-2)) == Approx(1.0).epsilon(1e-12));
  }
}

TEST_CASE("DXF files that are no outline are refused with the line", "[macroscale][outline_file]") {
  const Folder folder;
  const auto write = [&](const std::string& entities) { return folder.write("a.dxf", dxf(entities)); };
  CHECK(names(refused(folder / "missing.dxf"), "blank.outline.file.missing", {"no such file"}));
  CHECK(names(refused(folder.write("a.txt", "x")), "blank.outline.file.type", {".dxf, .step or .stp"}));
  CHECK(names(refused(folder.write("b.dxf", "AutoCAD Binary DXF\r\n")), "blank.outline.file.binary",
              {"ASCII"}));
  CHECK(names(refused(folder.write("c.dxf", "some words\n")), "blank.outline.file.format", {"`some words`"}));
  const std::string whole = dxf(square);
  CHECK(names(refused(folder.write("d.dxf", whole.substr(0, whole.size() - 6))), "blank.outline.file.cut_off",
              {"EOF"}));
  CHECK(names(refused(write("0 TEXT 1 nothing")), "blank.outline.file.no_border", {"holds none"}));
  CHECK(names(refused(folder.write("e.dxf", whole), 1e-2), "blank.outline.length_unit.stated",
              {"e.dxf states: mm", "its line 8"}));
  CHECK(names(refused(folder.write("f.dxf", dxf(square, 9))), "blank.outline.file.unit", {"$INSUNITS"}));
  CHECK(names(
      refused(write(
          "0 LINE 10 0 20 0 11 100 21 0 0 LINE 10 100 20 0 11 100 21 100 0 LINE 10 100 20 100 11 0 21 1")),
      "blank.outline.file.open", {"ends at (0, 1) mm", "1 mm from"}));
  CHECK(names(
      refused(write(
          "0 LINE 10 0 20 0 11 100 21 0 0 LINE 10 100 20 0 11 100 21 100 0 LINE 10 100 20 0 11 0 21 100")),
      "blank.outline.file.branch", {"2 lines go on from (100, 0) mm"}));
  CHECK(names(refused(write(square + " 0 CIRCLE 10 100 20 50 40 10")), "blank.outline.apart",
              {"the outer border and hole 1"}));
  CHECK(names(refused(write(square + " 0 CIRCLE 10 50 20 50 40 0")), "blank.outline.file.radius",
              {"positive"}));
  CHECK(names(refused(write("0 CIRCLE 10 100 20 50")), "blank.outline.file.group",
              {"group 40 in each CIRCLE"}));
  CHECK(names(refused(write("0 POLYLINE 70 8 0 SEQEND")), "blank.outline.file.polyline", {"flags 8"}));
  CHECK(names(refused(write("0 CIRCLE 10 0 20 0 40 10 210 1 230 0")), "blank.outline.file.plane",
              {"this CIRCLE is not"}));

  const Problems spline = refused(write(square + " 0 SPLINE 70 8"));
  REQUIRE(spline.size() == 1);
  CHECK(spline[0].id == "blank.outline.file.entity");
  CHECK(spline[0].line == 14 + 22 + 2);
  const Problems number = refused(write("0 CIRCLE 10 wide 20 50 40 10"));
  REQUIRE(number.size() == 1);
  CHECK(number[0].line == 14 + 4);
}

TEST_CASE("a STEP face gives its border and holes", "[macroscale][outline_file]") {
  const Folder folder;
  const auto script = folder.write(
      "face.geo",
      "SetFactory(\"OpenCASCADE\");\nDefineConstant[ tool = 1 ];\n"
      "If (tool == 1)\n  Rectangle(1) = {-150, -100, 0, 300, 200, 20};\n  Disk(2) = {30, 0, 0, 25};\n"
      "  BooleanDifference(3) = { Surface{1}; Delete; }{ Surface{2}; Delete; };\nEndIf\n"
      "If (tool == 2)\n  Cylinder(1) = {0, 0, 0, 0, 0, 10, 5};\nEndIf\n"
      "If (tool == 3)\n  Rectangle(1) = {0, 0, 0, 300, 200};\n  Rotate {{1, 0, 0}, {0, 0, 0}, 0.1} { "
      "Surface{1}; }\nEndIf\n");
  const auto make = [&](int which) {
    const auto file = folder / fmt::format("face{}.step", which);
    write_step(script, which, file);
    return file;
  };
  const auto file = make(1);
  const Outline o = read(file);
  REQUIRE(o.holes.size() == 1);
  const double exact = 0.3 * 0.2 - (4.0 - pi) * 0.02 * 0.02 - pi * 0.025 * 0.025;
  CHECK(std::abs(area(o) - exact) < 2.0 * pi * (0.02 + 0.025) * 1e-5);
  CHECK_FALSE(contains(o, 0.03, 0.0));
  CHECK(contains(o, -0.149, 0.0));
  CHECK_FALSE(contains(o, -0.149, 0.099));  // rounded corner
  CHECK(names(refused(file, 1.0), "blank.outline.length_unit.stated", {"mm"}));
  CHECK(names(refused(make(2)), "blank.outline.file.cad", {"must hold one face; it holds 3 faces"}));
  CHECK(names(refused(make(3)), "blank.outline.file.cad", {"parallel to z = 0"}));
}
