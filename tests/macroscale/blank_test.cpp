#include <catch2/catch.hpp>

#include <cmath>
#include <map>
#include <numbers>
#include <numeric>

#include <Eigen/Geometry>

#include "macroscale/blank.h"
#include "macroscale/ledger.h"
#include "macroscale/quality.h"
#include "macroscale/solve.h"
#include "macroscale/stamping.h"
#include "macroscale/system.h"
#include "tests/macroscale/sample_fabric.h"

using namespace heddle::macroscale;
using Eigen::Vector3d;
using Eigen::VectorXd;
using heddle::test::make_fabric;

namespace {

constexpr double degree = std::numbers::pi / 180.0;

// An outline with everything that can go wrong: a notch, a slanted side, holes of which one is smaller than a
// cell.
Outline hard_outline() {
  Outline outline{
      {{-0.16, -0.15}, {0.14, -0.16}, {0.15, 0.02}, {0.11, 0.03}, {0.15, 0.06}, {0.02, 0.17}, {-0.16, 0.11}},
      {}};
  outline.holes.push_back(circle(0.03, 1e-5, {-0.04, 0.02}).outer);
  outline.holes.push_back(circle(2e-3, 1e-6, {0.061, -0.0705}).outer);
  return outline;
}

Outline quarter_of(double side) {
  return {{{0.0, 0.0}, {side, 0.0}, {side, side}, {0.0, side}}, {}};
}

double total(const std::vector<double>& values) {
  return std::accumulate(values.begin(), values.end(), 0.0);
}

double piece_area(const Blank& blank) {
  double sum = 0.0;
  for (const CellPiece& piece : blank.pieces) sum += area({{piece.corners.begin(), piece.corners.end()}, {}});
  return sum * blank.spacing[0] * blank.spacing[1];
}

VectorXd moved(const Scene& scene, const std::function<Vector3d(const Vector3d&)>& map) {
  VectorXd x = VectorXd::Zero(scene.unknowns());
  for (int i = 0; i < scene.blank.nodes(); ++i) x.segment<3>(3 * i) = map(scene.blank.reference[i]);
  return x;
}

}  // namespace

TEST_CASE("a trimmed blank holds the area of its outline, whatever shape and angle",
          "[macroscale][blank][long]") {
  const double angle = GENERATE(0.0, 17.0, 45.0, 90.0, -130.0) * degree;
  const double spacing = GENERATE(4.5e-3, 11e-3);
  const std::vector<Outline> outlines{rectangle({0.32, 0.3}), circle(0.16, 1e-6), hard_outline()};
  for (const Outline& outline : outlines) {
    const Blank blank = make_blank(outline, spacing, angle);
    CHECK(total(blank.node_area) == Approx(area(outline)).epsilon(1e-12));
    CHECK(4.0 * blank.corner_area() * total(blank.share) == Approx(area(outline)).epsilon(1e-12));
    CHECK(std::max(blank.spacing[0], blank.spacing[1]) <= spacing * (1.0 + 1e-9));
    CHECK(*std::min_element(blank.share.begin(), blank.share.end()) >= smallest_share);
    // What pictures draw is the same material.
    std::vector<char> cut(blank.quads.size(), 0);
    for (const CellPiece& piece : blank.pieces) cut[piece.quad] = 1;
    const auto whole = std::count(cut.begin(), cut.end(), 0);
    CHECK(4.0 * blank.corner_area() * static_cast<double>(whole) + piece_area(blank) ==
          Approx(area(outline)).epsilon(1e-9));
    std::vector<int> used(blank.reference.size(), 0);
    for (const auto& quad : blank.quads)
      for (int node : quad) ++used[node];
    CHECK(*std::min_element(used.begin(), used.end()) >= 1);
  }
}

TEST_CASE("a rectangle along its tows is the whole grid, with every share exactly 1", "[macroscale][blank]") {
  const Blank plain = make_blank(std::array{0.32, 0.28}, 4.5e-3);
  CHECK(plain.nu == 72);
  CHECK(plain.nv == 63);
  for (const auto& [outline, angle] :
       {std::pair{rectangle({0.32, 0.28}), 0.0}, std::pair{rectangle({0.28, 0.32}), 0.5 * std::numbers::pi},
        std::pair{rectangle({0.32, 0.28}), std::numbers::pi}}) {
    const Blank blank = make_blank(outline, 4.5e-3, angle);
    CHECK(blank.nodes() == 73 * 64);
    CHECK(blank.node(5, 7) == 5 * 64 + 7);
    CHECK(blank.spacing == plain.spacing);
    CHECK(blank.pieces.empty());
    CHECK(std::all_of(blank.share.begin(), blank.share.end(), [](double s) { return s == 1.0; }));
    CHECK(blank.node_area == plain.node_area);
    CHECK(blank.triples.size() == plain.triples.size());
    // Turned by right angles without rounding.
    const double c = std::round(std::cos(angle)), s = std::round(std::sin(angle));
    bool same = true;
    for (int i = 0; i < blank.nodes(); ++i) {
      const Vector3d& x = plain.reference[i];
      same &=
          blank.reference[i].x() == c * x.x() - s * x.y() && blank.reference[i].y() == s * x.x() + c * x.y();
    }
    CHECK(same);
  }
}

TEST_CASE("blanks at +45 and -45 degrees are mirror images to the last bit", "[macroscale][blank]") {
  const double angle = GENERATE(45.0, 17.0) * degree;
  const Blank plus = make_blank(rectangle({0.32, 0.32}), 4.5e-3, angle),
              minus = make_blank(rectangle({0.32, 0.32}), 4.5e-3, -angle);
  REQUIRE(plus.nodes() == minus.nodes());
  double gap = 0.0, area_gap = 0.0;
  for (int n = 0; n < plus.nodes(); ++n) {
    const auto [i, j] = plus.grid[n];
    const int image = minus.node(i, minus.nv - j);
    REQUIRE(image >= 0);
    const Vector3d &x = plus.reference[n], &y = minus.reference[image];
    gap = std::max({gap, std::abs(x.x() - y.x()), std::abs(x.y() + y.y())});
    area_gap = std::max(area_gap, std::abs(plus.node_area[n] - minus.node_area[image]));
  }
  CHECK(gap == 0.0);
  CHECK(area_gap < 1e-15 * 0.32);
}

TEST_CASE("a material point is found in its cell and moves with its corners", "[macroscale][blank]") {
  const Blank blank = make_blank(hard_outline(), 11e-3, 17.0 * degree);
  for (const EdgePoint& edge : blank.edge) {
    Eigen::Vector2d x = Eigen::Vector2d::Zero();
    for (std::size_t k = 0; k < 4; ++k)
      x += edge.point.weight[k] * blank.reference[blank.quads[edge.point.quad][k]].head<2>();
    CHECK((x - edge.reference).norm() < 1e-12);
    CHECK(edge.inward.norm() == Approx(1.0));
  }
  // Uniform shrinkage draws every straight side in by its distance from the middle.
  Scene scene;
  scene.blank = blank;
  State state;
  state.x = moved(scene, [](const Vector3d& x) { return Vector3d(0.99 * x); });
  double largest = 0.0;
  for (const EdgePoint& edge : blank.edge)
    largest = std::max(largest, -0.01 * edge.inward.dot(edge.reference));
  CHECK(largest > 1.3e-3);
  CHECK(largest_draw_in(blank, state) == Approx(largest).epsilon(1e-9));
}

TEST_CASE("V2: on turned and trimmed blanks uniform stretch and shear store density times area",
          "[macroscale][blank][verification]") {
  const auto fabric = make_fabric({});
  const double angle = GENERATE(0.0, 17.0, 45.0) * degree;
  Scene scene;
  scene.blank = make_blank(hard_outline(), 9e-3, angle);
  scene.fabric = &fabric;
  System system(scene);
  const State state = initial_state(scene);
  StepData step;
  step.start = &state;
  step.dt = 1.0;

  // F maps warp p to (1 + e1) p', weft q to (1 + e2) q' with p'.q' = sin(gamma).
  const double e1 = 2e-3, e2 = -1e-3, gamma = 0.3;
  const Vector3d p(std::cos(angle), std::sin(angle), 0), q(-std::sin(angle), std::cos(angle), 0);
  const Vector3d p1 = (1 + e1) * p, q1 = (1 + e2) * (std::sin(gamma) * p + std::cos(gamma) * q);
  const VectorXd x = moved(scene, [&](const Vector3d& r) { return Vector3d(r.dot(p) * p1 + r.dot(q) * q1); });
  step.target = x;
  const PotentialTerms w = system.potential(step, x);
  const double surface = area(hard_outline()), ea = 5.9e6, s = std::sin(gamma);
  CHECK(w.tow == Approx(0.5 * ea * (e1 * e1 + e2 * e2) * surface).epsilon(1e-10));
  CHECK(w.shear == Approx(0.5 * 60.0 * s * s * surface).epsilon(1e-10));
  CHECK(w.bending < 1e-20);
  CHECK(w.twist < 1e-20);

  // Nodes whose four cells are whole are in balance: a uniform field pulls on the edge alone.
  const VectorXd g = system.full_gradient(step, x);
  std::vector<double> around(scene.blank.nodes(), 0.0);
  for (std::size_t k = 0; k < scene.blank.quads.size(); ++k)
    for (int node : scene.blank.quads[k]) around[node] += scene.blank.share[k] == 1.0 ? 1.0 : 0.0;
  int inner = 0;
  double worst = 0.0;
  for (int i = 0; i < scene.blank.nodes(); ++i)
    if (around[i] == 4.0) worst = std::max(worst, g.segment<3>(3 * i).norm()), ++inner;
  CHECK(inner > 500);
  CHECK(worst < 1e-10 * ea * e1 * 9e-3);  // of what one tow carries

  // Turned rigidly it stores nothing and pulls nowhere.
  const Eigen::Matrix3d turn = (Eigen::AngleAxisd(0.7, Vector3d(1, 2, 3).normalized())).toRotationMatrix();
  const VectorXd rigid = moved(scene, [&](const Vector3d& r) { return Vector3d(turn * r); });
  step.target = rigid;
  CHECK(system.potential(step, rigid).total() < 1e-12 * w.tow);
  CHECK(system.full_gradient(step, rigid).cwiseAbs().maxCoeff() < 1e-6);  // of 5.9e6 N/m

  // Mass: true, and of the outline.
  double mass = 0.0;
  for (int i = 0; i < scene.blank.nodes(); ++i) mass += system.mass(3 * i);
  CHECK(mass == Approx(0.7 * surface).epsilon(1e-12));
}

TEST_CASE("on a trimmed blank residual, matrix and ledger count every cell by its share",
          "[macroscale][blank][derivative]") {
  const auto fabric = make_fabric({.rate_consistency = 5.0});
  Scene scene;
  scene.blank = make_blank(hard_outline(), 30e-3, 17.0 * degree);
  scene.fabric = &fabric;
  System system(scene);
  const State start = initial_state(scene);
  StepData step;
  step.start = &start;
  step.dt = 0.01;
  step.target = start.x;
  // Small waves and stretch in every direction; d is another such field.
  const auto waves = [&](double size, double phase) {
    VectorXd x = VectorXd::Zero(scene.unknowns());
    for (int k = 0; k < x.size(); ++k) x[k] = size * std::sin(1.7 * k + phase);
    return x;
  };
  const VectorXd x = start.x + waves(2e-4, 0.0), d = waves(1.0, 1.0);
  const double h = 1e-7;
  const double slope =
      (system.potential(step, x + h * d).total() - system.potential(step, x - h * d).total()) / (2.0 * h);
  CHECK(system.full_gradient(step, x).dot(d) == Approx(slope).epsilon(1e-6));

  const VectorXd expected =
      (system.full_gradient(step, x + h * d) - system.full_gradient(step, x - h * d)) / (2.0 * h);
  system.assemble(step, x, Filter::none);
  const auto& pattern = system.solver().pattern();
  const auto values = system.solver().values();
  VectorXd product = VectorXd::Zero(d.size());
  for (int j = 0; j < pattern.size; ++j)
    for (int k = pattern.column_start[j]; k < pattern.column_start[j + 1]; ++k) {
      product[pattern.row[k]] += values[k] * d[j];
      if (pattern.row[k] != j) product[j] += values[k] * d[pattern.row[k]];
    }
  CHECK((product - expected).norm() < 1e-5 * expected.norm());

  State end = start;
  end.x = x;
  end.v = (x - start.x) / step.dt;
  step.friction.assign(0, {});
  const StepLedger ledger = account(system, step, end).ledger;
  const PotentialTerms w = system.potential(step, x);
  CHECK(ledger.tow == Approx(w.tow).epsilon(1e-10));
  CHECK(ledger.shear == Approx(w.shear).epsilon(1e-10));
  CHECK(ledger.twist == Approx(w.twist).epsilon(1e-10));
  CHECK(ledger.bending == Approx(w.bending).epsilon(1e-10));
}

TEST_CASE("V2: a plate presses a trimmed blank evenly, and its force is p times the outline's area",
          "[macroscale][blank][verification]") {
  const auto fabric = make_fabric({});
  const double force = 300.0;
  Scene scene;
  scene.blank = make_blank(hard_outline(), 15e-3, 17.0 * degree);
  scene.fabric = &fabric;
  scene.tools = {{Role::die, PlaneShape{{0, 0, -0.75e-3}, {0, 0, 1}}, Motion::fixed, 0.0, 0.0},
                 {Role::binder, PlaneShape{{0, 0, 0.75e-3}, {0, 0, -1}}, Motion::loaded, force, 0.5}};
  System system(scene);
  State state = initial_state(scene);
  SolveOptions options;
  options.force_tolerance = 1e-10;
  options.relative_tolerance = 0.0;
  for (int k = 0; k < 6; ++k) {
    State end;
    StepData step;
    const StepSummary summary = advance(system, state, 10.0, state.tool_z, {}, options, end, step);
    REQUIRE(summary.converged);
    state = std::move(end);
  }
  StepData rest;
  rest.start = &state;
  rest.dt = 1.0;
  rest.tool_z = state.tool_z;
  const double expected = force / area(hard_outline());
  double sum = 0.0;
  for (int i = 0; i < scene.blank.nodes(); ++i) {
    const double pressure = system.tool_contact(rest, state.x, 1, i).normal.pressure;
    CHECK(pressure == Approx(expected).epsilon(0.01));
    sum += pressure * scene.blank.node_area[i];
  }
  CHECK(sum == Approx(force).epsilon(1e-10));
}

TEST_CASE("blanks that the tools cannot hold are refused by shape, holes that leave the blank as well",
          "[macroscale][blank]") {
  const auto ids = [](const StampingSpec& spec) {
    std::vector<std::string> found;
    for (const auto& problem : check(spec)) found.push_back(problem.id);
    return found;
  };
  StampingSpec spec;
  spec.blank.orientation = 0.5;
  CHECK(ids(spec).empty());
  spec.blank.shape = BlankShape::circle;
  CHECK(ids(spec).empty());
  spec.blank.radius = 0.09;
  CHECK(ids(spec) == std::vector<std::string>{"blank.radius.reach"});
  spec.blank.shape = BlankShape::polygon;
  CHECK(ids(spec) == std::vector<std::string>{"blank.points.area"});
  // Large, but one side cuts across the die's opening.
  spec.blank.polygon = {{{-0.3, -0.08}, {0.3, -0.08}, {0.3, 0.3}, {-0.3, 0.3}}, {}};
  CHECK(ids(spec) == std::vector<std::string>{"blank.points.reach"});
  spec.blank.shape = BlankShape::rectangle;
  spec.blank.holes = {{{0.0, 0.0}, 0.01}, {{0.0, 0.13}, 0.01}};
  CHECK(ids(spec).empty());
  spec.blank.holes.push_back({{0.0, 0.155}, 0.01});
  CHECK(ids(spec) == std::vector<std::string>{"blank.holes.inside"});
}

// ---- V13: what symmetry says must be equal is equal

namespace {

heddle::friction::Model coulomb() {
  heddle::friction::Model model;
  model.law = heddle::friction::Coulomb{0.3};
  return model;
}

// The same, dragging along the long diagonal of the trellis: what is symmetric must be so with it as well.
heddle::friction::Model coulomb_along_the_trellis() {
  heddle::friction::Model model = coulomb();
  model.effects.orientation =
      heddle::friction::Orientation{.amplitude = 0.5, .form = heddle::friction::Orientation::Form::trellis};
  return model;
}

StampingSpec small_case(double spacing) {
  StampingSpec spec;
  spec.blank.spacing = spacing;
  spec.process.stroke = 25e-3;
  spec.process.time = 0.15;
  spec.process.steps = 10;
  return spec;
}

// Newton stops at a residual, so equal problems summed in another order end a little apart.
double largest_gap(const StampingResult& a, const StampingResult& b, double HistoryRow::*column) {
  REQUIRE(a.history.size() == b.history.size());
  double gap = 0.0, size = 0.0;
  for (std::size_t k = 0; k < a.history.size(); ++k) {
    gap = std::max(gap, std::abs(a.history[k].*column - b.history[k].*column));
    size = std::max(size, std::abs(a.history[k].*column));
  }
  return gap / size;
}

void check_alike(const StampingResult& a, const StampingResult& b,
                 const std::function<std::size_t(std::size_t)>& image, const Eigen::Matrix3d& map,
                 double shear_sign) {
  REQUIRE(a.summary.completed);
  REQUIRE(b.summary.completed);
  for (double HistoryRow::*column :
       {&HistoryRow::punch_force, &HistoryRow::draw_in_max, &HistoryRow::shear_angle_max})
    CHECK(largest_gap(a, b, column) < 1e-6);
  const BlankState &x = a.final_state, &y = b.final_state;
  REQUIRE(x.position.size() == y.position.size());
  double moved = 0.0, gap = 0.0, shear = 0.0, shear_gap = 0.0;
  for (std::size_t n = 0; n < x.position.size(); ++n) {
    const std::size_t m = image(n);
    const Vector3d p(x.position[n].data()), q(y.position[m].data());
    moved = std::max(moved, (p - Vector3d(x.reference[n][0], x.reference[n][1], 0.0)).norm());
    gap = std::max(gap, (map * p - q).norm());
    shear = std::max(shear, std::abs(x.shear_angle[n]));
    shear_gap = std::max(shear_gap, std::abs(x.shear_angle[n] - shear_sign * y.shear_angle[m]));
  }
  CHECK(gap < 1e-6 * moved);
  CHECK(shear_gap < 1e-6 * shear);
}

}  // namespace

TEST_CASE("V13: a 90/0 blank is the 0/90 blank turned", "[macroscale][blank][verification]") {
  const auto law = GENERATE(false, true) ? coulomb_along_the_trellis() : coulomb();
  StampingSpec spec = small_case(20e-3);
  spec.blank.size = {0.32, 0.28};
  const auto fabric = make_fabric({.rate_consistency = 5.0});
  const StampingResult a = run_stamping(spec, fabric, law);
  spec.blank.size = {0.28, 0.32};
  spec.blank.orientation = 0.5 * std::numbers::pi;
  const StampingResult b = run_stamping(spec, fabric, law);
  Eigen::Matrix3d quarter_turn;
  quarter_turn << 0, -1, 0, 1, 0, 0, 0, 0, 1;
  check_alike(
      a, b, [](std::size_t n) { return n; }, quarter_turn, 1.0);
}

TEST_CASE("V13: a -45 blank is the mirror image of the +45 blank",
          "[macroscale][blank][verification][long]") {
  const auto law = GENERATE(false, true) ? coulomb_along_the_trellis() : coulomb();
  StampingSpec spec = small_case(20e-3);
  spec.blank.holes = {{{0.12, 0.05}, 0.012}};
  spec.blank.orientation = 45.0 * degree;
  const auto fabric = make_fabric({.rate_consistency = 5.0});
  const StampingResult a = run_stamping(spec, fabric, law);
  spec.blank.holes[0].centre[1] *= -1.0;
  spec.blank.orientation *= -1.0;
  const StampingResult b = run_stamping(spec, fabric, law);
  CHECK_FALSE(b.final_state.pieces.empty());
  std::map<std::array<int, 2>, std::size_t> node_at;
  for (std::size_t n = 0; n < b.final_state.grid.size(); ++n) node_at[b.final_state.grid[n]] = n;
  const int nv = a.final_state.nv;
  check_alike(
      a, b,
      [&](std::size_t n) {
        const auto [i, j] = a.final_state.grid[n];
        return node_at.at({i, nv - j});
      },
      Eigen::DiagonalMatrix<double, 3>(1, -1, 1).toDenseMatrix(), -1.0);
}

TEST_CASE("V13: a quarter blank held on its planes of symmetry is a quarter of the whole",
          "[macroscale][blank][verification]") {
  const auto fabric = make_fabric({.rate_consistency = 5.0});
  const auto law = coulomb();
  const double half = 0.15, h = 15e-3;
  const auto scene_of = [&](const Outline& outline, double binder_share) {
    Scene scene;
    scene.blank = make_blank(outline, h, 0.0);
    scene.fabric = &fabric;
    scene.friction = &law;
    scene.slip_smoothing = 1e-4;
    scene.tools = {{Role::punch, HemisphereShape{{0, 0, 0.75e-3}, 0.06}, Motion::driven, 0.0, 0.0},
                   {Role::die, RingShape{-0.75e-3, 0.065, 0.02, true}, Motion::fixed, 0.0, 0.0},
                   {Role::binder, RingShape{0.75e-3, 0.085, 2e-3, false}, Motion::loaded,
                    400.0 * binder_share, 20.0 * binder_share}};
    // A triple across a plane of symmetry has its third node in the other half; left out on both sides.
    std::erase_if(scene.blank.triples, [&](const TowTriple& t) {
      return std::abs(scene.blank.reference[t.middle][t.direction]) < 1e-9;
    });
    return scene;
  };
  Scene whole = scene_of(rectangle({2 * half, 2 * half}), 1.0), quarter = scene_of(quarter_of(half), 0.25);
  quarter.held.assign(quarter.unknowns(), 0);
  for (int i = 0; i < quarter.blank.nodes(); ++i)
    for (int c = 0; c < 2; ++c)
      if (std::abs(quarter.blank.reference[i][c]) < 1e-12) quarter.held[3 * i + c] = 1;

  SolveOptions options;
  options.force_tolerance = options.relative_tolerance = 1e-9;
  const auto run = [&](const Scene& scene) {
    System system(scene);
    State state = initial_state(scene);
    double force = 0.0;
    for (int k = 1; k <= 6; ++k) {
      State end;
      StepData step;
      const StepSummary summary = advance(system, state, 0.02, {-3e-3 * k, 0.0, 0.0}, {}, options, end, step);
      INFO(summary.reason);
      REQUIRE(summary.converged);
      force = account(system, step, end).forces.on_tool[0].z();
      state = std::move(end);
    }
    return std::pair{state, force};
  };
  const auto [all, force] = run(whole);
  const auto [part, quarter_force] = run(quarter);
  CHECK(force > 5.0);
  CHECK(4.0 * quarter_force == Approx(force).epsilon(1e-6));
  double gap = 0.0;
  for (int i = 0; i < quarter.blank.nodes(); ++i) {
    const auto [a, b] = quarter.blank.grid[i];
    const int image = whole.blank.node(a + whole.blank.nu / 2, b + whole.blank.nv / 2);
    REQUIRE((whole.blank.reference[image] - quarter.blank.reference[i]).norm() < 1e-12);
    gap = std::max(gap, (all.node(image) - part.node(i)).norm());
  }
  CHECK(gap < 1e-6 * 18e-3);
}

TEST_CASE("a round blank keeps the symmetries of the square about its tows", "[macroscale][blank]") {
  StampingSpec spec = small_case(16e-3);
  spec.blank.shape = BlankShape::circle;
  const StampingResult result = run_stamping(spec, make_fabric({.rate_consistency = 5.0}), coulomb());
  REQUIRE(result.summary.completed);
  CHECK(result.summary.rejected_steps == 0);
  CHECK(result.summary.symmetry_gap_shear >= 0.0);
  CHECK(result.summary.symmetry_gap_shear < 1e-3);
  CHECK(result.summary.symmetry_gap_draw_in < 1e-3);
  CHECK(result.summary.energy_residual_max < 0.01);
  CHECK(result.summary.force_balance_residual_max < 1e-3);
  // Along the tows the edge moves in farther than between them.
  CHECK(result.summary.draw_in_rays[0] > result.summary.draw_in_rays[1]);
}
