// Orders of the discretisation in space and time, on smooth problems: V14 (and V8's catenary and cap) of the
// verification plan.
#include <catch2/catch.hpp>

#include <algorithm>
#include <cmath>
#include <numbers>
#include <vector>

#include "macroscale/solve.h"
#include "tests/macroscale/quasi_static.h"
#include "tests/macroscale/sample_fabric.h"

using namespace heddle::macroscale;
using Eigen::Vector3d;
using heddle::test::extrapolate;
using heddle::test::make_fabric;
using heddle::test::run_at_rest;
using heddle::test::run_steps;

namespace {

struct Answer {
  double edge_force = 0.0;  ///< in-plane pull of one edge [N], of the strip per width [N/m]
  double tow_strain = 0.0;  ///< sheet: largest; strip: in the middle
  double rise = 0.0;        ///< of the middle [m]
};

// A square sheet held along its edges and pushed out of its plane by a dead load q sin sin: membrane tension,
// shear and large deflections, with neither contact nor corners in the load to roughen them.
class Sheet {
 public:
  explicit Sheet(int cells)
      : fabric_(make_fabric({.tow_stiffness = tow_stiffness, .shear_stiffness = 100.0, .bending = 1e-8})) {
    scene_.blank = make_blank({side, side}, side / cells * (1.0 + 1e-9));
    scene_.fabric = &fabric_;
    scene_.shear_rate = false;
    const Blank& blank = scene_.blank;
    scene_.held.assign(3 * blank.nodes(), 0);
    for (int i = 0; i < blank.nodes(); ++i) {
      const Vector3d& r = blank.reference[i];
      if (std::max(std::abs(r.x()), std::abs(r.y())) > 0.499 * side)
        for (int c = 0; c < 3; ++c) scene_.held[3 * i + c] = 1;
    }
  }
  Sheet(const Sheet&) = delete;  // the scene points at the fabric

  void load(double share) {
    const Blank& blank = scene_.blank;
    scene_.load.assign(3 * blank.nodes(), 0.0);
    for (int i = 0; i < blank.nodes(); ++i) {
      const Vector3d& r = blank.reference[i];
      scene_.load[3 * i + 2] = share * pressure * blank.node_area[i] *
                               std::cos(std::numbers::pi * r.x() / side) *
                               std::cos(std::numbers::pi * r.y() / side);
    }
  }

  // Motion from rest while the load grows as sin^2 over `duration`, about one and a half of the sheet's
  // periods.
  Answer in_motion(int steps) {
    System system(scene_);
    State state = initial_state(scene_);
    Answer answer;
    for (int k = 1; k <= steps; ++k) {
      load(std::pow(std::sin(0.5 * std::numbers::pi * k / steps), 2));
      run_steps(
          system, state, duration / steps, 1, {},
          [&](const StepData& step, const State& end) { answer = measure(system, step, end); }, tight());
    }
    return answer;
  }

  // At rest under the full load: tension of a tow at the apex by its own stretch [N/m], and by the pressure
  // that it carries.
  struct Apex {
    double by_stretch, by_pressure;
  };
  Apex apex_at_rest() {
    System system(scene_);
    State state = initial_state(scene_);
    run_at_rest(
        system, state, 10.0, 8, [&](double share) { load(share); }, {}, {}, tight());
    const Blank& blank = scene_.blank;
    const int i = blank.nu / 2, j = blank.nv / 2;
    const Vector3d apex = state.node(blank.node(i, j)), beside = state.node(blank.node(i + 1, j));
    const double h = blank.spacing[0], stretch = (beside - apex).norm() / h;
    return {tow_stiffness * (stretch - 1.0), pressure * stretch / (4.0 * (apex.z() - beside.z()) / (h * h))};
  }

 private:
  static constexpr double side = 0.1, pressure = 1e3, duration = 0.004;  // [m], [Pa], [s]
  static constexpr double tow_stiffness = 1e4;                           // [N/m]

  static SolveOptions tight() {
    SolveOptions options;
    options.force_tolerance = 1e-9;
    options.relative_tolerance = 0.0;
    return options;
  }

  Answer measure(const System& system, const StepData& step, const State& end) const {
    const Blank& blank = scene_.blank;
    const Eigen::VectorXd g = system.full_gradient(step, end.x);
    Answer answer;
    for (int j = 0; j <= blank.nv; ++j) answer.edge_force += g[3 * blank.node(blank.nu, j)];
    for (const auto& quad : blank.quads)
      for (const Corner& c : corners_of(quad))
        answer.tow_strain = std::max(
            answer.tow_strain, (end.node(c.along_warp) - end.node(c.node)).norm() / blank.spacing[0] - 1.0);
    answer.rise = end.node(blank.node(blank.nu / 2, blank.nv / 2)).z();
    return answer;
  }

  heddle::mesoscale::FabricProperties fabric_;
  Scene scene_;
};

// Orders of all three measures from three runs, printed with their extrapolated values. `exact` may be null.
void check_orders(const char* what, const std::vector<Answer>& runs, const Answer* exact, double lowest,
                  double highest) {
  for (const auto& [name, member] :
       {std::pair{"force [N/m, N]", &Answer::edge_force}, std::pair{"tow strain", &Answer::tow_strain},
        std::pair{"rise [m]", &Answer::rise}}) {
    const auto [limit, order] = extrapolate({runs[0].*member, runs[1].*member, runs[2].*member});
    WARN("V14 " << what << ", " << name << ": " << runs[0].*member << ", " << runs[1].*member << ", "
                << runs[2].*member << "; extrapolated " << limit << ", order " << order);
    CHECK(order > lowest);
    CHECK(order < highest);
    CHECK(runs[2].*member == Approx(limit).epsilon(0.02));
    CHECK(std::abs(runs[0].*member / limit - 1.0) > 1e-4);  // there is an error to speak of
    if (exact) {
      CHECK(limit == Approx(exact->*member).epsilon(1e-4));
      CHECK(runs[2].*member == Approx(exact->*member).epsilon(2e-3));
    }
  }
}

// A strip pinned at both ends, as long as its span, that stretches and sags under a dead load per initial
// area.
constexpr double span = 0.1, weight = 1e3, tow_stiffness = 1e4;  // [m], [Pa], [N/m]

// Elastic catenary (Irvine, Cable Structures, 1981), s from the middle along the unstretched
// strip:
//     x(s) = H s / EA + H / w asinh(w s / H),   z(s) = w s^2 / (2 EA) + H / w (sqrt(1 + (w s / H)^2) - 1),
// with H from x(L / 2) = span / 2; the strain in the middle is H / EA. All per width.
Answer elastic_catenary() {
  const double half = 0.5 * span;
  const auto reach = [&](double h) {
    return h * half / tow_stiffness + h / weight * std::asinh(weight * half / h);
  };
  double low = 1e-3, high = tow_stiffness;
  for (int k = 0; k < 200; ++k) {
    const double middle = 0.5 * (low + high);
    (reach(middle) < half ? low : high) = middle;
  }
  Answer answer;
  answer.edge_force = 0.5 * (low + high);
  answer.tow_strain = answer.edge_force / tow_stiffness;
  answer.rise = weight * half * half / (2.0 * tow_stiffness) +
                answer.edge_force / weight * (std::hypot(1.0, weight * half / answer.edge_force) - 1.0);
  return answer;
}

Answer hanging_strip(int cells) {
  const auto fabric = make_fabric({.tow_stiffness = tow_stiffness, .bending = 1e-12});
  const double h = span / cells;
  Scene scene;
  scene.blank = make_blank({span, h}, h * (1.0 + 1e-9));
  scene.fabric = &fabric;
  scene.shear_rate = false;
  const Blank& blank = scene.blank;
  scene.held.assign(3 * blank.nodes(), 0);
  scene.load.assign(3 * blank.nodes(), 0.0);
  for (int i : {0, cells})
    for (int j = 0; j <= blank.nv; ++j)
      for (int c = 0; c < 3; ++c) scene.held[3 * blank.node(i, j) + c] = 1;
  System system(scene);
  State state = initial_state(scene);
  SolveOptions options;
  options.force_tolerance = 1e-10;
  options.relative_tolerance = 0.0;
  Answer answer;
  run_at_rest(
      system, state, 10.0, 2,
      [&](double share) {
        for (int i = 0; i < blank.nodes(); ++i) scene.load[3 * i + 2] = share * weight * blank.node_area[i];
      },
      {},
      [&](const StepData& step, const State& end) {
        const Eigen::VectorXd g = system.full_gradient(step, end.x);
        answer.edge_force = (g[3 * blank.node(cells, 0)] + g[3 * blank.node(cells, 1)]) / h;
        const int middle = blank.node(cells / 2, 0), next = blank.node(cells / 2 + 1, 0);
        answer.tow_strain = (end.node(next) - end.node(middle)).norm() / h - 1.0;
        answer.rise = end.node(middle).z();
      },
      options);
  return answer;
}

}  // namespace

TEST_CASE(
    "V14, V8: halving the spacing quarters the error of force, tow strain and sag of an elastic catenary",
    "[macroscale][verification]") {
  const Answer exact = elastic_catenary();
  std::vector<Answer> runs;
  for (int cells : {10, 20, 40}) runs.push_back(hanging_strip(cells));
  check_orders("space, 10, 20, 40 cells", runs, &exact, 1.9, 2.1);
}

TEST_CASE("V14: halving the time step halves the error of force, tow strain and rise of a smooth motion",
          "[macroscale][verification]") {
  Sheet sheet(6);
  std::vector<Answer> runs;
  for (int steps : {100, 200, 400}) runs.push_back(sheet.in_motion(steps));
  check_orders("time, 100, 200, 400 steps", runs, nullptr, 1.0, 1.05);
}

// Along the warp through the apex n z'' / lambda carries half of the pressure, the weft the other half: n = p
// R / 2 of a bubble, whatever holds its rim. Both sides are taken half a cell off the apex or about it, alike
// in h^2.
TEST_CASE("V8: at the apex of a blown-up sheet a tow's tension is p R / 2", "[macroscale][verification]") {
  std::vector<double> gaps;
  for (const int cells : {16, 32}) {
    Sheet sheet(cells);
    const auto [by_stretch, by_pressure] = sheet.apex_at_rest();
    gaps.push_back(by_stretch / by_pressure - 1.0);
    WARN("V8 cap, " << cells << " cells: tension " << by_stretch << " N/m, p R / 2 " << by_pressure
                    << " N/m");
  }
  CHECK(std::abs(gaps[1]) < 2e-3);
  CHECK(std::abs(gaps[1]) < 0.35 * std::abs(gaps[0]));
}
