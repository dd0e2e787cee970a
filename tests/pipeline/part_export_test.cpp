// The formed part as a structural model: its mesh, its layers, its decks; and what CalculiX makes of them.
#include <Eigen/Eigenvalues>
#include <Eigen/LU>
#include <array>
#include <catch2/catch.hpp>
#include <cmath>
#include <functional>
#include <numbers>
#include <optional>
#include <string>
#include <vector>

#include <fmt/format.h>

#include "macroscale/blank.h"
#include "macroscale/stamping.h"
#include "part_deck.h"
#include "pipeline/export/abaqus_part.h"
#include "pipeline/export/ccx_part.h"
#include "pipeline/export/part_layers.h"
#include "pipeline/export/part_mesh.h"
#include "pipeline/export/part_model.h"
#include "sample_run.h"
#include "tests/ccx_run.h"

using namespace heddle;
using namespace heddle::pipeline;
using namespace heddle::test;
using Eigen::Matrix3d;
using Eigen::Vector3d;
using mesoscale::solid::Matrix6;
using mesoscale::solid::ShearedSolid;
using mesoscale::solid::Vector6;

namespace {

constexpr double areal_density = 0.7;  // [kg/m^2]
constexpr double pi = std::numbers::pi;

// The weave of Table 1, coarse; twice the same in one process is once too often.
const std::vector<ShearedSolid>& table() {
  static const std::vector<ShearedSolid> rows = [] {
    mesoscale::solid::SolidSpec spec;
    spec.grid = {.per_pitch = 8, .layers = 8};
    spec.shear_angles = {0.0, pi / 6.0, pi / 4.0};
    return mesoscale::solid::analyse(mesoscale::WeaveSpec{}, spec).sheared;
  }();
  return rows;
}

// A layered plate of three unlike materials: coupled, unbalanced, with a thermal moment.
PartLayers unlike_layers(double share) {
  PartLayers layers{0.5e-3, share, {}, {}};
  for (std::size_t k = 0; k < 3; ++k) {
    const double s = static_cast<double>(k);
    layers.stiffness[k] << 9e9 + 2e9 * s, 2e9, 1e9 * (s - 1.0), 2e9, 7e9 - 1e9 * s, 0.5e9, 1e9 * (s - 1.0),
        0.5e9, 2e9 + 0.3e9 * s;
    layers.expansion[k] = {2e-5 + 1e-5 * s, 3e-5, 1e-5 * (1.0 - s)};
  }
  return layers;
}

// A flat parallelogram of cells sheared by a trellis angle, in x-y, its warp at `turn` to x.
macroscale::BlankState flat_part(int along, int across, double cell, double shear, double turn = 0.0) {
  macroscale::BlankState blank;
  blank.nu = along;
  blank.nv = across;
  for (int i = 0; i <= along; ++i)
    for (int j = 0; j <= across; ++j) {
      const double a = cell * i, b = cell * j, x = a + std::sin(shear) * b, y = std::cos(shear) * b;
      blank.grid.push_back({i, j});
      blank.reference.push_back({a, b});
      blank.position.push_back(
          {std::cos(turn) * x - std::sin(turn) * y, std::sin(turn) * x + std::cos(turn) * y, 0.0});
    }
  for (int i = 0; i < along; ++i)
    for (int j = 0; j < across; ++j) {
      const int first = i * (across + 1) + j, next = first + across + 1;
      blank.quads.push_back({first, next, next + 1, first + 1});
    }
  return blank;
}

PartModel model_of(const macroscale::BlankState& blank, double room = 298.15) {
  return part_model("a test", blank, table(), areal_density, {391.15, "a test"}, {room, "a test"});
}

// The round blank with a hole, flat or laid on a dome.
macroscale::BlankState trimmed(bool on_dome) {
  macroscale::BlankSpec spec;
  spec.shape = macroscale::BlankShape::circle;
  spec.radius = 0.1;
  spec.holes = {{{0.03, 0.01}, 0.017}};
  const macroscale::Blank flat = macroscale::make_blank(macroscale::outline_of(spec), 0.012, 0.3);
  macroscale::BlankState blank;
  blank.nu = flat.nu;
  blank.nv = flat.nv;
  blank.grid = flat.grid;
  blank.quads = flat.quads;
  blank.pieces = flat.pieces;
  for (const Vector3d& x : flat.reference) {
    blank.reference.push_back({x.x(), x.y()});
    const double arc = std::hypot(x.x(), x.y()), dome = 0.09;
    const double in = on_dome && arc > 0.0 ? dome * std::sin(arc / dome) / arc : 1.0;
    blank.position.push_back({in * x.x(), in * x.y(), on_dome ? -dome * std::cos(arc / dome) : 0.0});
  }
  return blank;
}

double last_energy(const std::string& dat, std::size_t& at) {
  at = dat.find("total internal energy", at);
  REQUIRE(at != std::string::npos);
  at = dat.find('\n', at) + 1;
  return std::stod(dat.substr(at));
}

// Unit strains 11, 22, 12 and curvatures 11, 22, 12, and sums of any two of them.
std::vector<Vector6> plate_loads() {
  std::vector<Vector6> loads;
  for (int i = 0; i < 6; ++i)
    for (int j = 0; j <= i; ++j) {
      Vector6 load = Vector6::Zero();
      load[i] = 1e-3;
      load[j] = 1e-3;
      loads.push_back(load);
    }
  return loads;
}

// [A B; B D] in N/mm, N, N mm that CalculiX finds in a flat part whose rim is moved with each uniform strain
// and curvature: the energies of all pairs of them. The warp lies at `turn` to x.
Matrix6 plate_by_ccx(const PartModel& model, double turn) {
  const std::string body = ccx_part_body(model);
  const PartDeck deck = read_deck(body);
  // The rim: nodes over free sides of the middle surface, ends and middles.
  std::vector<std::array<Vector3d, 2>> sides;
  for (const auto& [a, b] : free_sides(model.mesh))
    sides.push_back({deck.nodes.at(ccx_middle_node(a)), deck.nodes.at(ccx_middle_node(b))});
  std::vector<int> rim;
  for (const auto& [number, x] : deck.nodes)
    for (const auto& [a, b] : sides) {
      const Vector3d flat(x.x(), x.y(), 0.0);
      if ((flat - a).cross(b - a).norm() > 1e-6 * (b - a).norm()) continue;
      if ((flat - a).dot(b - a) < -1e-6 || (flat - b).dot(a - b) < -1e-6) continue;
      rim.push_back(number);
      break;
    }
  std::string text = body;
  const Matrix3d frame = Eigen::AngleAxisd(turn, Vector3d::UnitZ()).toRotationMatrix();
  for (const Vector6& load : plate_loads()) {
    text += "*STEP\n*STATIC\n*BOUNDARY\n";
    Matrix3d e = Matrix3d::Zero(), k = Matrix3d::Zero();
    e.topLeftCorner<2, 2>() << load[0], 0.5 * load[2], 0.5 * load[2], load[1];
    k.topLeftCorner<2, 2>() << load[3], 0.5 * load[5], 0.5 * load[5], load[4];
    for (const int n : rim) {
      const Vector3d x = frame.transpose() * deck.nodes.at(n), flat(x.x(), x.y(), 0.0);
      const Vector3d u = frame * ((e + x.z() * k) * flat);
      text += fmt::format("{0}, 1, 1, {1:.12e}\n{0}, 2, 2, {2:.12e}\n", n, u.x(), u.y());
      // Across the plate the faces are free: only the middle surface is led.
      if (std::abs(x.z()) < 1e-9) text += fmt::format("{0}, 3, 3, {1:.12e}\n", n, -0.5 * flat.dot(k * flat));
    }
    text += "*EL PRINT, ELSET=PART, TOTALS=ONLY\nELSE\n*END STEP\n";
  }
  const std::string dat = run_ccx(text);
  double area = 0.0;
  for (const double a : model.area) area += 1e6 * a;  // [mm^2]
  Matrix6 twice;                                      // energy of the load with i and j, doubled, per area
  std::size_t at = 0;
  for (int i = 0; i < 6; ++i)
    for (int j = 0; j <= i; ++j) twice(i, j) = 2.0 * last_energy(dat, at) / (1e-6 * area);
  Matrix6 plate;
  for (int i = 0; i < 6; ++i)
    for (int j = 0; j <= i; ++j)
      plate(i, j) = plate(j, i) = i == j ? twice(i, i) : 0.5 * (twice(i, j) - twice(i, i) - twice(j, j));
  return plate;
}

Matrix6 in_newton_and_millimetre(const Matrix6& plate) {
  Matrix6 out = plate;
  out.topLeftCorner<3, 3>() *= 1e-3;
  out.bottomRightCorner<3, 3>() *= 1e3;
  return out;
}

// Largest difference over the geometric mean of the diagonals.
double gap(const Matrix6& a, const Matrix6& b) {
  double worst = 0.0;
  for (int i = 0; i < 6; ++i)
    for (int j = 0; j < 6; ++j)
      worst = std::max(worst, std::abs(a(i, j) - b(i, j)) / std::sqrt(b(i, i) * b(j, j)));
  return worst;
}

void check_deck(const PartModel& model, const std::string& text) {
  const PartDeck deck = read_deck(text);
  REQUIRE(deck.elements.size() == 3 * model.mesh.faces.size());
  double mass = 0.0;
  for (const auto& [number, element] : deck.elements) {
    CAPTURE(number);
    REQUIRE(deck.sections.count(element.set) == 1);
    const auto& section = deck.sections.at(element.set);
    REQUIRE(deck.density.count(section.material) == 1);
    REQUIRE(deck.orientations.count(section.orientation) == 1);
    const auto& [one, two] = deck.orientations.at(section.orientation);
    CHECK(one.norm() == Approx(1.0).epsilon(1e-10));
    CHECK(two.norm() == Approx(1.0).epsilon(1e-10));
    CHECK(std::abs(one.dot(two)) < 1e-10);
    const double volume = volume_of(deck, element);
    CHECK(volume > 0.0);
    // 3 of the orientation points from the lower face to the upper one.
    const std::size_t corners = element.type == "C3D15" ? 3 : 4;
    const Vector3d up = deck.nodes.at(element.nodes[corners]) - deck.nodes.at(element.nodes[0]);
    CHECK(one.cross(two).dot(up.normalized()) > 0.2);  // the sample has a crease of a right angle
    mass += 1e12 * deck.density.at(section.material) * 1e-9 * volume;  // [kg]
    REQUIRE(element.nodes.size() == (corners == 3 ? 15 : 20));
  }
  // By the area before forming, which every mass in a stamping rests on.
  CHECK(mass == Approx(areal_density * model.mesh.flat_area).epsilon(1e-8));
}

}  // namespace

TEST_CASE("three layers have the A, B, D and thermal resultants of any plate of three layers",
          "[pipeline][export]") {
  const double share = GENERATE(1.0 / 3.0, 0.2);
  const PartLayers unlike = unlike_layers(share);
  const Matrix6 plate = plate_of(unlike);
  const Vector6 held = held_of(unlike);
  REQUIRE(plate.topRightCorner<3, 3>().norm() > 1e-3 * plate(0, 0) * unlike.thickness);
  const auto layers = layers_of(plate, held, unlike.thickness, share);
  REQUIRE(layers);
  CHECK(gap(plate_of(*layers), plate) < 1e-12);
  const Vector6 found = held_of(*layers);
  for (int i = 0; i < 6; ++i) CHECK(found[i] == Approx(held[i]).epsilon(1e-10).margin(1e-12 * held[0]));
  // And those of the weave at any angle, which is no stack of layers.
  for (const ShearedSolid& row : table()) {
    const auto of_weave = layers_of(row.plate, row.plate_held[0], row.thickness, share);
    REQUIRE(of_weave);
    CHECK(gap(plate_of(*of_weave), row.plate) < 1e-12);
  }
  // A plate that bends too softly for a layer of a third in the middle: the outer ones would have to push.
  Matrix6 soft = plate;
  soft.bottomRightCorner<3, 3>() *= 0.1;
  soft.topRightCorner<3, 3>().setZero();
  soft.bottomLeftCorner<3, 3>().setZero();
  CHECK_FALSE(layers_of(soft, held, unlike.thickness, 1.0 / 3.0));
}

TEST_CASE("a solid made from a stiffness in plane stress has that one, and the other's across the plane",
          "[pipeline][export]") {
  const ShearedSolid& row = table()[1];
  const Matrix3d plane = row.plate.topLeftCorner<3, 3>() / row.thickness;
  const Matrix6 solid = solid_of(plane, row.stack);
  const Matrix6 compliance = solid.inverse();
  constexpr std::array<int, 3> in_plane{0, 1, 5};
  const Matrix3d found = Matrix3d(compliance(in_plane, in_plane)).inverse();
  CHECK((found - plane).norm() < 1e-10 * plane.norm());
  CHECK(solid(2, 2) == row.stack(2, 2));
  CHECK(solid(0, 2) == row.stack(0, 2));
  CHECK(Eigen::SelfAdjointEigenSolver<Matrix6>(solid).eigenvalues().minCoeff() > 0.0);
}

TEST_CASE("a trimmed blank becomes a mesh without gaps: every free side lies on the outline",
          "[pipeline][export]") {
  const PartMesh mesh = part_mesh(trimmed(false));
  const double exact = pi * (0.1 * 0.1 - 0.017 * 0.017);
  CHECK(mesh.blank_area == Approx(exact).epsilon(2e-4));
  CHECK(mesh.flat_area == Approx(mesh.blank_area).epsilon(5e-3));
  std::size_t quads = 0;
  double worst = 1.0;
  for (const PartFace& face : mesh.faces) {
    if (face.count == 4) ++quads;
    CHECK(face.flat_area > 0.0);
    const auto x = [&](int k) {
      return Vector3d(
          mesh.position[static_cast<std::size_t>(face.corners[static_cast<std::size_t>(k)])].data());
    };
    const Vector3d normal = (x(1) - x(0)).cross(x(2) - x(0));
    CHECK(normal.z() > 0.0);
    const double longest = std::max({(x(1) - x(0)).norm(), (x(2) - x(1)).norm(), (x(0) - x(2)).norm()});
    worst = std::min(worst, normal.norm() / (longest * longest));
  }
  CHECK(worst > 1e-3);
  CHECK(quads > 100);
  CHECK(mesh.faces.size() > quads);
  // Corners within a thirtieth of a cell are one, so that a side may leave the circle by as much.
  constexpr double off = 0.012 / 30.0 * 2.0;
  for (const auto& side : free_sides(mesh))
    for (const int node : side) {
      const auto& x = mesh.position[static_cast<std::size_t>(node)];
      const double from_rim = std::abs(std::hypot(x[0], x[1]) - 0.1),
                   from_hole = std::abs(std::hypot(x[0] - 0.03, x[1] - 0.01) - 0.017);
      CAPTURE(x[0], x[1]);
      CHECK(std::min(from_rim, from_hole) < off);
    }
}

TEST_CASE(
    "a deck read back: each element has a section, axes that stand upright, and all have the blank's mass",
    "[pipeline][export]") {
  for (const macroscale::BlankState& blank : {sample::blank(8), trimmed(true)}) {
    const PartModel model = model_of(blank);
    check_deck(model, ccx_part(model));
  }
  const PartModel whole = model_of(sample::blank(8));
  CHECK(whole.mesh.flat_area == Approx(0.32 * 0.32).epsilon(1e-12));
  CHECK(whole.mesh.faces.size() == 64);
}

TEST_CASE("the Abaqus deck holds each cell's A, B, D and thermal forces in N and mm", "[pipeline][export]") {
  const PartModel model = model_of(flat_part(2, 1, 0.01, pi / 6.0));
  const std::string text = abaqus_part(model);
  const auto at = text.find("*SHELL GENERAL SECTION, ELSET=E2");
  REQUIRE(at != std::string::npos);
  std::istringstream lines(text.substr(text.find('\n', at) + 1));
  std::string line;
  std::vector<double> all;
  for (int k = 0; k < 3; ++k) {
    std::getline(lines, line);
    for (const double v : numbers_of(line)) all.push_back(v);
  }
  REQUIRE(all.size() == 21);
  const Matrix6 plate = in_newton_and_millimetre(table()[1].plate);
  std::size_t n = 0;
  for (int column = 0; column < 6; ++column)
    for (int row = 0; row <= column; ++row)
      CHECK(all[n++] == Approx(plate(row, column)).epsilon(1e-8).margin(1e-8 * plate(3, 3)));
  std::getline(lines, line);
  const std::vector<double> thermal = numbers_of(line);
  REQUIRE(thermal.size() == 6);
  CHECK(thermal[0] == Approx(1e-3 * table()[1].plate_held[0][0]));
  CHECK(text.find("Not run in Abaqus") != std::string::npos);
}

TEST_CASE(
    "CalculiX finds the homogenised A, B and D in the deck of a flat part, unsheared and sheared by 30 deg",
    "[pipeline][export][ccx]") {
  if (!ccx_is_there()) return;
  const auto [row, turn] =
      GENERATE(std::pair<std::size_t, double>{0, 0.0}, std::pair<std::size_t, double>{1, 0.5});
  const ShearedSolid& ply = table()[row];
  const PartModel model = model_of(flat_part(3, 3, 5e-3, ply.shear_angle, turn));
  const Matrix6 ours = in_newton_and_millimetre(ply.plate), theirs = plate_by_ccx(model, turn);
  WARN(fmt::format(
      "at {:.0f} deg: A11 {:.2f} and {:.2f} N/mm, D11 {:.4f} and {:.4f} N mm, largest gap {:.1e}",
      180.0 / pi * ply.shear_angle, theirs(0, 0), ours(0, 0), theirs(3, 3), ours(3, 3), gap(theirs, ours)));
  CAPTURE(theirs, ours);
  CHECK(gap(theirs, ours) < 1e-4);
}

TEST_CASE("a strip of the part bends under a force at its end as a beam of its D does",
          "[pipeline][export][ccx]") {
  if (!ccx_is_there()) return;
  const double length = 0.12, width = 6e-3, force = 0.01;  // [m], [N]
  const PartModel model = model_of(flat_part(40, 2, 3e-3, 0.0));
  std::string text = ccx_part_body(model);
  const PartDeck deck = read_deck(text);
  std::string root, tip;
  std::vector<int> end;
  for (const auto& [n, x] : deck.nodes) {
    if (x.x() < 1e-9) root += fmt::format("{0}, 1, 1\n", n);
    if (x.x() < 1e-9 && std::abs(x.z()) < 1e-9) root += fmt::format("{0}, 3, 3\n", n);
    if (x.x() < 1e-9 && x.y() < 1e-9 && std::abs(x.z()) < 1e-9) root += fmt::format("{0}, 2, 2\n", n);
    if (x.x() > 1e3 * length - 1e-6 && std::abs(x.z()) < 1e-9) end.push_back(n);
  }
  REQUIRE(end.size() == 3);
  text += "*BOUNDARY\n" + root + "*STEP\n*STATIC\n*CLOAD\n";
  const std::array<double, 3> share{0.25, 0.5, 0.25};
  for (std::size_t k = 0; k < 3; ++k) text += fmt::format("{}, 3, {:.12e}\n", end[k], force * share[k]);
  text += "*NODE PRINT, NSET=MIDDLE\nU\n*END STEP\n";
  const Vectors u = last_table(run_ccx(text), "displacements (vx,vy,vz)");
  const Matrix6 compliance = table()[0].plate.inverse();
  const double beam = force * std::pow(length, 3) / 3.0 * compliance(3, 3) / width;  // [m]
  const double found = 1e-3 * u.at(end[1])[2];
  WARN(fmt::format("tip {:.4f} mm, beam {:.4f} mm", 1e3 * found, 1e3 * beam));
  CHECK(found == Approx(beam).epsilon(0.01));
}

TEST_CASE("a free flat part cools without stress, to the strain of its ply", "[pipeline][export][ccx]") {
  if (!ccx_is_there()) return;
  const ShearedSolid& ply = table()[GENERATE(0, 1)];
  const macroscale::BlankState blank = flat_part(3, 2, 5e-3, ply.shear_angle);
  const PartModel model = model_of(blank, 291.15);  // by 100 K
  const std::string dat = run_ccx(ccx_part(model));
  const Vectors u = last_table(dat, "displacements (vx,vy,vz)");
  const Vector6 free = mesoscale::solid::free_strain(ply.plate, ply.plate_held[0]);
  Matrix3d strain = Matrix3d::Zero();
  strain.topLeftCorner<2, 2>() << free[0], 0.5 * free[2], 0.5 * free[2], free[1];
  // Free but for a rigid turn of first order: distances say it.
  const auto at = [&](std::size_t n) -> Vector3d { return 1e3 * Vector3d(model.mesh.position[n].data()); };
  const auto moved = [&](std::size_t n) -> Vector3d {
    return Vector3d(u.at(ccx_middle_node(static_cast<int>(n))).data());
  };
  double largest = 0.0;
  for (std::size_t n = 1; n < model.mesh.position.size(); ++n) {
    const Vector3d way = at(n) - at(0);
    const double found = way.dot(moved(n) - moved(0)), wanted = -100.0 * way.dot(strain * way);
    CAPTURE(n);
    CHECK(found == Approx(wanted).epsilon(1e-4));
    largest = std::max(largest, std::abs(wanted));
  }
  CHECK(largest > 1e-3);
  for (const auto& [node, reaction] : last_table(dat, "forces (fx,fy,fz)"))
    for (const double r : reaction) CHECK(std::abs(r) < 1e-6);
  // Held flat it would store a thousandth of a J and more.
  std::size_t place = 0;
  CHECK(std::abs(last_energy(dat, place)) < 1e-9);
}

TEST_CASE("an arc closes by what it shrinks more across its thickness than along it",
          "[pipeline][export][ccx]") {
  if (!ccx_is_there()) return;
  constexpr int cells = 24;
  constexpr double radius = 0.02, opening = 0.5 * pi;
  macroscale::BlankState blank = flat_part(cells, 2, radius * opening / cells, 0.0);
  for (auto& x : blank.position) {
    const double angle = x[0] / radius - 0.5 * opening;
    x = {radius * std::sin(angle), x[1], -radius * std::cos(angle)};
  }
  const PartModel model = model_of(blank, 291.15);  // by 100 K
  const Vectors u = last_table(run_ccx(ccx_part(model)), "displacements (vx,vy,vz)");
  // Direction of the chord between grid lines i and i + 1 in the plane of the arc, at j = 0.
  const auto direction = [&](int i, bool after) {
    const auto at = [&](int line) -> Vector3d {
      const int node = 3 * line;
      const Vector3d x = 1e3 * Vector3d(model.mesh.position[static_cast<std::size_t>(node)].data());
      return after ? Vector3d(x + Vector3d(u.at(ccx_middle_node(node)).data())) : x;
    };
    const Vector3d way = at(i + 1) - at(i);
    return std::atan2(way.z(), way.x());
  };
  const double found =
      direction(cells - 1, true) - direction(0, true) - (direction(cells - 1, false) - direction(0, false));
  const ShearedSolid& ply = table()[0];
  const double along = mesoscale::solid::free_strain(ply.plate, ply.plate_held[0])[0],
               through = mesoscale::solid::free_strain(ply.stack, ply.stack_held[0])[2];
  // Nelson & Cairns 1989 (recalled): a part that is alike all along its arc keeps free of stress.
  const double wanted = opening * (cells - 1) / cells * (along - through) * -100.0;
  WARN(fmt::format("an arc of 90 deg closes by {:.4f} deg, by the formula {:.4f}", 180.0 / pi * found,
                   180.0 / pi * wanted));
  CHECK(found == Approx(wanted).epsilon(0.01));
}

TEST_CASE(
    "a dome springs in as it cools; turned as a whole it stores the same, and its supports carry nothing",
    "[pipeline][export][ccx]") {
  if (!ccx_is_there()) return;
  const macroscale::BlankState upright = sample::blank(12);
  macroscale::BlankState turned = upright;
  const Matrix3d turn = Eigen::AngleAxisd(1.1, Vector3d(1.0, 2.0, -0.5).normalized()).toRotationMatrix();
  for (auto& x : turned.position) {
    const Vector3d y = turn * Vector3d(x.data());
    x = {y.x(), y.y(), y.z()};
  }
  const std::string a = run_ccx(ccx_part(model_of(upright))), b = run_ccx(ccx_part(model_of(turned)));
  std::size_t at_a = 0, at_b = 0;
  const double stored = last_energy(a, at_a), other = last_energy(b, at_b);
  CHECK(stored > 0.0);
  CHECK(other == Approx(stored).epsilon(1e-5));
  for (const std::string& dat : {a, b})
    for (const auto& [node, reaction] : last_table(dat, "forces (fx,fy,fz)"))
      for (const double r : reaction) CHECK(std::abs(r) < 1e-5);
  double largest = 0.0;
  for (const auto& [node, u] : last_table(a, "displacements (vx,vy,vz)"))
    largest = std::max(largest, Vector3d(u.data()).norm());
  WARN(fmt::format("cooled by 93 K: {:.4f} mJ stored, {:.3f} mm moved against the middle", stored, largest));
  CHECK(largest > 0.05);
}
