// The friction test as a machine: drive, holder, two plies, cam.
#include <algorithm>
#include <catch2/catch.hpp>
#include <cmath>

#include "friction/rig/machine.h"

using namespace heddle::friction;

namespace {

Model coulomb() {
  return {.law = Coulomb{0.3}, .film = {}, .effects = {}, .box = {}};
}

Model stribeck() {
  return {.law = HerseyPower{.scale = 0.325, .exponent = 0.136}, .film = {}, .effects = {}, .box = {}};
}

FrictionTestRow row(double velocity = 16.67e-3, double normal_force = 1500.0) {
  FrictionTestRow r;
  r.name = "pull";
  r.velocity = velocity;
  r.normal_force = normal_force;
  return r;
}

double largest_until(const RigRun& run, double displacement) {
  double force = 0.0;
  for (const RigSample& s : run.samples)
    if (s.displacement <= displacement) force = std::max(force, s.pull_force);
  return force;
}

}  // namespace

TEST_CASE("tows that flatten under a held gap take their share of the load as an exponential",
          "[friction][rig][analytic]") {
  const CamGap cam{.squeeze_rate = 0.0, .tow_relaxation = 0.2, .relaxation_time = 1.5};
  const GapState start = closed_gap(150e3, 0.07e-3);
  const auto end_of = [&](int steps) {
    GapState now = start;
    for (int k = 0; k < steps; ++k) now = relax(cam, start, now, 3.0 / steps);
    return now.pressure;
  };
  const double exact = 150e3 * (1.0 - 0.2 * (1.0 - std::exp(-3.0 / 1.5)));
  CHECK(end_of(400) == Approx(exact).epsilon(1e-6));
  const double order = std::log2(std::abs(end_of(20) - exact) / std::abs(end_of(40) - exact));
  CHECK(order == Approx(2.0).margin(0.1));
}

TEST_CASE(
    "a film under a soft stack is squeezed out as Stefan's, and under a stiff one takes the load with it",
    "[friction][rig][analytic]") {
  const double p0 = 150e3, h0 = 0.07e-3, time = 3.0, rate = 3e-6;
  const auto end_of = [&](double stiffness) {
    const CamGap cam{.stack_stiffness = stiffness, .squeeze_rate = rate, .tow_relaxation = 0.0};
    const GapState start = closed_gap(p0, h0);
    GapState now = start;
    for (int k = 0; k < 2000; ++k) now = relax(cam, start, now, time / 2000);
    return now;
  };
  CHECK(end_of(1.0).film_thickness == Approx(h0 / std::sqrt(1.0 + rate * p0 * time)).epsilon(1e-6));
  // Separable: B t/(2 h0^2) = Int dh / (h^3 (p0 - 2 K (h0 - h))) from h to h0.
  const double stiffness = 2e9;
  const GapState end = end_of(stiffness);
  double sum = 0.0;
  const int n = 20000;
  for (int i = 0; i < n; ++i) {
    const double h = end.film_thickness + (i + 0.5) / n * (h0 - end.film_thickness);
    sum += (h0 - end.film_thickness) / n / (h * h * h * (p0 - 2.0 * stiffness * (h0 - h)));
  }
  CHECK(0.5 * rate * time / (h0 * h0) == Approx(sum).epsilon(1e-5));
  CHECK(end.pressure == Approx(p0 - 2.0 * stiffness * (h0 - end.film_thickness)).epsilon(1e-12));
  CHECK(end.pressure < 0.7 * p0);
}

TEST_CASE("the machine's steady force is the law's over the speeds and loads of Table 2", "[friction][rig]") {
  for (const double velocity : {8.33e-3, 16.67e-3, 83.3e-3})
    for (const double force : {218.0, 4000.0}) {
      CAPTURE(velocity, force);
      const RigRun constant = run_machine(coulomb(), row(velocity, force), {}, {});
      CHECK(constant.steady_force == Approx(0.6 * force).epsilon(1e-3));
      const double law = run_friction_test(stribeck(), row(velocity, force), {}).pull_force;
      const RigRun rate = run_machine(stribeck(), row(velocity, force), {}, {});
      CHECK(rate.steady_force == Approx(law).epsilon(2e-3));
      CHECK(rate.force_loss == 0.0);
      CHECK(rate.samples.back().displacement >= 0.05);
    }
}

TEST_CASE("a static peak shows at start-up, less through few samples, and is gone in the steady part",
          "[friction][rig]") {
  Model model = coulomb();
  model.effects.static_peak = StaticPeak{.amplitude = 0.5, .length = 2e-3};
  const RigRun run = run_machine(model, row(8e-3), {}, {});
  // The cable holds the peak while the first tenths of a millimetre slip.
  CHECK(run.peak_force < 1.5 * 900.0 * 1.02);
  CHECK(run.peak_force > 1.35 * 900.0);
  CHECK(run.peak_displacement < 1e-3);
  CHECK(run.steady_force == Approx(900.0).epsilon(2e-3));
  Machine slow;
  slow.sampling_rate = 2.0;  // a sample each 4 mm
  CHECK(largest_until(run_machine(model, row(8e-3), {}, slow), 0.05) < run.peak_force - 50.0);
}

TEST_CASE("rest under load ages the contact before the machine starts", "[friction][rig]") {
  Model model = coulomb();
  model.effects.dwell_ageing = DwellAgeing{.amplitude = 0.1, .time = 1.0, .reset_slip = 2e-3};
  FrictionRig rested;
  rested.dwell_before = 10.0;
  const RigRun fresh = run_machine(model, row(8e-3), {}, {}),
               aged = run_machine(model, row(8e-3), rested, {});
  CHECK(aged.peak_force > 1.1 * fresh.peak_force);
  CHECK(aged.steady_force == Approx(fresh.steady_force).epsilon(2e-3));
  CHECK(aged.samples[500].pull_force == 0.0);
  CHECK(aged.samples[500].time == Approx(5.0));
}

TEST_CASE("the gear takes up its backlash before the sample moves, and only where it is engaged",
          "[friction][rig]") {
  const auto first_move = [](double velocity, double backlash) {
    Machine machine;
    machine.drive.backlash = backlash;
    machine.sampling_rate = 2000.0;
    for (const RigSample& s : run_machine(coulomb(), row(velocity), {}, machine).samples)
      if (s.displacement > 1e-6) return s.time;
    return -1.0;
  };
  CHECK(first_move(16.67e-3, 2e-3) - first_move(16.67e-3, 0.0) == Approx(2e-3 / 16.67e-3).epsilon(0.02));
  CHECK(first_move(8.3e-3, 2e-3) == first_move(8.3e-3, 0.0));
}

TEST_CASE("a slack second ply is drawn by the inner interface until its grip holds it",
          "[friction][rig][analytic]") {
  Machine machine;
  machine.sample = {.slack = 10e-3, .inner_coefficient = 0.1};
  const RigRun run = run_machine(coulomb(), row(8e-3), {}, machine);
  // mu N + mu_i N at first, 2 mu N in the end.
  const auto force_at = [&](double displacement) {
    for (const RigSample& s : run.samples)
      if (s.displacement >= displacement) return s.pull_force;
    return -1.0;
  };
  CHECK(force_at(8e-3) == Approx((0.3 + 0.1) * 1500.0).epsilon(1e-3));
  CHECK(force_at(15e-3) == Approx(2.0 * 0.3 * 1500.0).epsilon(1e-3));
  // An inner interface that holds more than the plate draws the second ply along at once.
  machine.sample.inner_coefficient = 0.4;
  CHECK(run_machine(coulomb(), row(8e-3), {}, machine).steady_force == Approx(900.0).epsilon(1e-3));
}

TEST_CASE("under the cam pull and normal force fall together and their ratio is the law's",
          "[friction][rig]") {
  Machine machine;
  machine.cam = CamGap{};
  FrictionRig rig;
  rig.dwell_before = 1.0;
  const RigRun run = run_machine(coulomb(), row(), rig, machine);
  CHECK(run.force_loss > 0.05);
  CHECK(run.force_loss < 0.3);
  CHECK(run.steady_coefficient == Approx(0.3).epsilon(1e-3));
  CHECK(run.steady_force < 0.97 * 900.0);
  // The normal force never rises.
  for (std::size_t k = 1; k < run.samples.size(); ++k)
    CHECK(run.samples[k].normal_force <= run.samples[k - 1].normal_force);
}

TEST_CASE("a law that falls with speed makes the machine stick and slip, the longer the softer it is",
          "[friction][rig][long]") {
  Model model = coulomb();
  model.effects.stick_slip = StickSlip{.amplitude = 0.4, .speed = 5e-3};
  const auto teeth = [&](double stiffness) {
    Machine machine;
    machine.drive = {.stiffness = stiffness, .holder_mass = 2.0, .damping = 0.02, .acceleration = 1.0};
    machine.sampling_rate = 1000.0;
    const RigRun run = run_machine(model, row(2e-3), {.pull_length = 15e-3}, machine);
    int count = 0;
    double low = 1e9, high = 0.0, first = 0.0, last = 0.0;
    const double middle = 2.0 * 0.3 * 1.25 * 1500.0;
    for (std::size_t k = 1; k < run.samples.size(); ++k) {
      const RigSample &a = run.samples[k - 1], &b = run.samples[k];
      if (b.displacement < 5e-3) continue;
      low = std::min(low, b.pull_force);
      high = std::max(high, b.pull_force);
      if (a.pull_force > middle && b.pull_force <= middle) {
        if (count++ == 0) first = b.time;
        last = b.time;
      }
    }
    struct Teeth {
      double low, high, period;
      int count;
    };
    return Teeth{low, high, (last - first) / std::max(count - 1, 1), count};
  };
  const auto soft = teeth(4e5), stiff = teeth(8e5);
  REQUIRE(soft.count > 3);
  // An undamped slider breaks away at F_s, slips fast, where mu is 0.3, and overshoots to 2 F_k - F_s; the
  // cable loads again at k U (Rabinowicz). The damping of 2 % takes 4 % off the overshoot.
  const double still = 2.0 * 0.42 * 1500.0, fast = 2.0 * 0.3 * 1500.0, drop = 2.0 * (still - fast);
  CHECK(soft.high == Approx(still).epsilon(0.02));
  CHECK(soft.low == Approx(still - drop).epsilon(0.05));
  CHECK(soft.period == Approx(drop / (4e5 * 2e-3)).epsilon(0.05));
  CHECK(soft.period / stiff.period == Approx(2.0).epsilon(0.1));
}
