// A half or a quarter of a symmetric part, computed on its planes of symmetry, is the whole part.
#include <catch2/catch.hpp>

#include <algorithm>
#include <cmath>
#include <functional>
#include <numbers>
#include <optional>

#include "macroscale/stamping.h"
#include "macroscale/stamping_scene.h"
#include "macroscale/symmetric_piece.h"
#include "macroscale/system.h"
#include "tests/macroscale/sample_fabric.h"
#include "tests/macroscale/sample_stamping.h"
#include "tests/macroscale/slope_checks.h"

using namespace heddle::macroscale;
using Eigen::Vector3d;
using Eigen::VectorXd;
using heddle::test::coarse_stamping;
using heddle::test::coulomb;
using heddle::test::make_fabric;

namespace {

using Column = double HistoryRow::*;

const std::vector<Column> forces{&HistoryRow::punch_force, &HistoryRow::die_force, &HistoryRow::binder_force};
const std::vector<Column> energies{&HistoryRow::work_punch,
                                   &HistoryRow::work_binder,
                                   &HistoryRow::work_gravity,
                                   &HistoryRow::energy_tow,
                                   &HistoryRow::energy_shear,
                                   &HistoryRow::energy_bending,
                                   &HistoryRow::energy_compaction,
                                   &HistoryRow::energy_press,
                                   &HistoryRow::friction_punch,
                                   &HistoryRow::friction_die,
                                   &HistoryRow::friction_binder,
                                   &HistoryRow::dissipation_shear_rate,
                                   &HistoryRow::dissipation_shear_hysteresis};
const std::vector<Column> measures{&HistoryRow::draw_in_max, &HistoryRow::tow_strain_max,
                                   &HistoryRow::shear_angle_max, &HistoryRow::punch_deflection};

double size(const std::vector<HistoryRow>& history, Column column) {
  double size = 0.0;
  for (const HistoryRow& row : history) size = std::max(size, std::abs(row.*column));
  return size;
}

double gap(const std::vector<HistoryRow>& a, const std::vector<HistoryRow>& b, Column column) {
  REQUIRE(a.size() == b.size());
  double gap = 0.0;
  for (std::size_t k = 0; k < a.size(); ++k) gap = std::max(gap, std::abs(a[k].*column - b[k].*column));
  return gap;
}

/// Same nodes, cells and edge; places and fields within a share of their sizes.
void check_alike(const BlankState& whole, const BlankState& mirrored, double share) {
  CHECK(mirrored.grid == whole.grid);
  CHECK(mirrored.quads == whole.quads);
  REQUIRE(mirrored.position.size() == whole.position.size());
  REQUIRE(mirrored.pieces.size() == whole.pieces.size());
  double gap = 0.0, way = 0.0, shear = 0.0, shear_gap = 0.0, pressure = 0.0, pressure_gap = 0.0;
  for (std::size_t n = 0; n < whole.grid.size(); ++n) {
    const Vector3d x(whole.position[n].data()), y(mirrored.position[n].data());
    gap = std::max(gap, (x - y).norm());
    way = std::max(way, (x - Vector3d(whole.reference[n][0], whole.reference[n][1], 0.0)).norm());
    CHECK(std::hypot(whole.reference[n][0] - mirrored.reference[n][0],
                     whole.reference[n][1] - mirrored.reference[n][1]) < 1e-12);
    shear = std::max(shear, std::abs(whole.shear_angle[n]));
    shear_gap = std::max(shear_gap, std::abs(whole.shear_angle[n] - mirrored.shear_angle[n]));
    pressure = std::max(pressure, whole.pressure[n]);
    pressure_gap = std::max(pressure_gap, std::abs(whole.pressure[n] - mirrored.pressure[n]));
  }
  CHECK(gap < share * way);
  CHECK(shear_gap < 10.0 * share * shear);
  CHECK(pressure_gap <= 100.0 * share * pressure);  // steep: a contact slope times a place
  double cut = 0.0, cut_mirrored = 0.0;
  for (std::size_t k = 0; k < whole.pieces.size(); ++k) {
    CHECK(mirrored.pieces[k].quad == whole.pieces[k].quad);
    const auto ring = [](const CellPiece& p) { return Ring(p.corners.begin(), p.corners.end()); };
    cut += area({ring(whole.pieces[k]), {}});
    cut_mirrored += area({ring(mirrored.pieces[k]), {}});
  }
  CHECK(cut_mirrored == Approx(cut).margin(1e-9));
  // About a circle the points of the whole do not begin at a plane.
  CHECK(std::abs(static_cast<double>(mirrored.edge.size()) - static_cast<double>(whole.edge.size())) <= 1.0);
}

StampingResult run(StampingSpec spec, Symmetry symmetry,
                   const std::optional<heddle::friction::Orientation>& orientation = {}) {
  spec.blank.symmetry = symmetry;
  heddle::friction::Model friction = coulomb(0.3);
  friction.effects.orientation = orientation;
  const StampingResult result =
      run_stamping(spec, make_fabric({.rate_consistency = 5.0, .bending = 2e-3}), friction);
  CAPTURE(result.summary.failure);
  REQUIRE(result.summary.completed);
  return result;
}

/// @param share  of the punch's force and work, and of each measure of shape. Newton's method stops at a
/// share of
///               the mean nodal force, which nodes on the planes move a little: where that makes one search
///               more or less, 1e-6 is not to be had
void check_whole(const StampingResult& whole, const StampingResult& piece, double share) {
  const auto within = [&](const std::vector<Column>& columns, double scale) {
    for (std::size_t k = 0; k < columns.size(); ++k) {
      CAPTURE(k, scale);
      const double unit = scale > 0.0 ? scale : size(whole.history, columns[k]);
      CHECK(gap(whole.history, piece.history, columns[k]) <= share * unit);
    }
  };
  within(forces, whole.summary.peak_punch_force);
  within(energies, whole.history.back().work_punch);
  within(measures, 0.0);
  check_alike(whole.final_state, piece.final_state, share);
  for (std::size_t ray = 0; ray < 8; ++ray)
    CHECK(piece.summary.draw_in_rays[ray] == Approx(whole.summary.draw_in_rays[ray]).epsilon(1e-5));
  CHECK(piece.summary.energy_residual_max < 0.01);
  CHECK(piece.summary.force_balance_residual_max < 1e-3);
}

}  // namespace

TEST_CASE("V13: halves and quarter give forces, energies, shape and draw-in of the whole",
          "[macroscale][symmetry][verification][long]") {
  StampingSpec spec = coarse_stamping(8);
  spec.blank.spacing = 20e-3;
  using heddle::friction::Orientation;
  const auto direction =
      GENERATE(std::optional<Orientation>{},
               std::optional{Orientation{.amplitude = 0.5, .form = Orientation::Form::trellis}},
               std::optional{Orientation{.amplitude = 0.5, .form = Orientation::Form::tows}});
  const StampingResult whole = run(spec, Symmetry::none, direction);
  REQUIRE(whole.history.back().energy_bending > 0.0);
  for (const Symmetry symmetry : {Symmetry::half_x, Symmetry::half_y, Symmetry::quarter}) {
    const StampingResult piece = run(spec, symmetry, direction);
    check_whole(whole, piece, direction ? 3e-5 : 1e-6);
    CHECK(piece.summary.nodes < 0.6 * whole.summary.nodes);
  }
}

TEST_CASE(
    "V13: a quarter with weight, a soft press, springs, Gauss points, hysteresis and a hole, released, "
    "is the whole",
    "[macroscale][symmetry][verification]") {
  StampingSpec spec = coarse_stamping(6);
  spec.blank.shape = BlankShape::circle;
  spec.blank.spacing = 20e-3;
  spec.blank.orientation = 0.5 * std::numbers::pi;
  spec.blank.holes = {{{0.0, 0.13}, 0.011}, {{0.0, -0.13}, 0.011}};
  spec.process.press.gravity = true;
  spec.process.press.compliance = 1e-6;
  spec.process.press.dwell = 0.05;
  spec.process.press.release = true;
  spec.binder.stiffness = 2e4;
  spec.contact_sites = ContactSites::gauss;
  spec.compaction_follows_shear = true;
  spec.shear_friction.share = 0.3;
  const StampingResult whole = run(spec, Symmetry::none), piece = run(spec, Symmetry::quarter);
  check_whole(whole, piece, 3e-5);
  REQUIRE(piece.summary.release);
  CHECK(piece.summary.release->row.work_punch == Approx(whole.summary.release->row.work_punch).epsilon(1e-6));
  CHECK(piece.summary.release->moved == Approx(whole.summary.release->moved).epsilon(1e-5));
}

TEST_CASE("V13: heat of a quarter is that of the whole", "[macroscale][symmetry][verification]") {
  StampingSpec spec = coarse_stamping(5);
  spec.thermal = thermal::ThermalSpec{};
  const StampingResult whole = run(spec, Symmetry::none), piece = run(spec, Symmetry::quarter);
  check_whole(whole, piece, 1e-4);
  const HeatRow &a = *whole.history.back().heat, &b = *piece.history.back().heat;
  CHECK(a.through_top != 0.0);
  CHECK(b.through_top == Approx(a.through_top).epsilon(1e-5));
  CHECK(b.of_friction == Approx(a.of_friction).epsilon(1e-4));
  CHECK(b.mean_temperature == Approx(a.mean_temperature).epsilon(1e-7));
}

TEST_CASE("tows that cross a plane of symmetry bend there as in the whole: slopes of their energy",
          "[macroscale][symmetry][derivative]") {
  const auto fabric = make_fabric({.bending = 2e-3});
  Scene whole, piece;
  for (auto [scene, symmetry] : {std::pair{&whole, Symmetry::none}, std::pair{&piece, Symmetry::quarter}}) {
    scene->blank = make_blank(rectangle({0.08, 0.06}), 0.01, 0.0, 0.0, symmetry);
    scene->fabric = &fabric;
    scene->held = held_by_planes(scene->blank);
  }
  // A bowl, deepest on the planes: all of its bending crosses them somewhere.
  const auto bowl = [](const Scene& scene) {
    VectorXd x = initial_state(scene).x;
    for (int i = 0; i < scene.blank.nodes(); ++i) {
      const Vector3d& r = scene.blank.reference[i];
      x[3 * i + 2] = 5.0 * r.x() * r.x() + 3.0 * r.y() * r.y() + 40.0 * r.x() * r.x() * r.y() * r.y();
    }
    return x;
  };
  System all(whole), part(piece);
  StepData step;
  const State rest = initial_state(piece), whole_rest = initial_state(whole);
  step.dt = 0.01;
  step.start = &whole_rest;
  step.target = whole_rest.x;
  const double energy = all.potential(step, bowl(whole)).bending;
  step.start = &rest;
  step.target = rest.x;
  const VectorXd x = bowl(piece);
  CHECK(4.0 * part.potential(step, x).bending == Approx(energy).epsilon(1e-12));

  Scene without = piece;
  without.blank.mirrored.clear();
  CHECK(4.0 * System(without).potential(step, x).bending < 0.9 * energy);

  // In directions that the planes allow.
  VectorXd d(x.size());
  for (Eigen::Index k = 0; k < d.size(); ++k)
    d[k] = piece.held[static_cast<std::size_t>(k)] ? 0.0 : std::sin(1.0 + 3.0 * static_cast<double>(k));
  heddle::test::check_slopes(part, step, x, d);
}

TEST_CASE("a blank or press that is not its own mirror image is refused by name", "[macroscale][symmetry]") {
  const auto rules = [](const std::function<void(StampingSpec&)>& change) {
    StampingSpec spec = coarse_stamping(5);
    spec.blank.symmetry = Symmetry::quarter;
    change(spec);
    std::vector<std::string> names;
    for (const heddle::Problem& problem : check(spec)) names.push_back(problem.id.text());
    return names;
  };
  CHECK(rules([](StampingSpec&) {}).empty());
  CHECK(rules([](StampingSpec& s) { s.blank.orientation = 0.5 * std::numbers::pi; }).empty());
  CHECK(rules([](StampingSpec& s) { s.blank.orientation = 0.1; }) ==
        std::vector<std::string>{"blank.symmetry.orientation"});
  CHECK(rules([](StampingSpec& s) {
          s.blank.holes = {{{0.0, 0.12}, 0.01}};
        }) == std::vector<std::string>{"blank.symmetry.outline"});
  CHECK(rules([](StampingSpec& s) {
          s.blank.symmetry = Symmetry::half_x;
          s.blank.holes = {{{0.0, 0.12}, 0.01}};
        }).empty());
  CHECK(rules([](StampingSpec& s) {
          s.process.press.punch_offset = {1e-3, 0.0};
        }) == std::vector<std::string>{"blank.symmetry.offset"});
  CHECK(rules([](StampingSpec& s) {
          s.blank.symmetry = Symmetry::half_y;
          s.process.press.punch_offset = {1e-3, 0.0};
        }).empty());
  CHECK(rules([](StampingSpec& s) { s.binder.sectors = 4; }) ==
        std::vector<std::string>{"blank.symmetry.sectors"});
  CHECK(rules([](StampingSpec& s) { s.blank.plies = 2; }) ==
        std::vector<std::string>{"blank.symmetry.plies"});
}
