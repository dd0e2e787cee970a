#include "friction/rig/machine.h"

#include <algorithm>
#include <cmath>
#include <tuple>

#include <fmt/format.h>

namespace heddle::friction {

namespace {

/// Where the drawn end of the drive is, that would be without load.
double drawn(const Drive& drive, double speed, double time) {
  const double ramp = speed / drive.acceleration;
  const double way = time < ramp ? 0.5 * drive.acceleration * time * time : speed * (time - 0.5 * ramp);
  const double lost = speed > drive.own_speed ? drive.backlash : 0.0;
  return std::max(0.0, way - lost);
}

/// The rig between two steps.
class Rig {
 public:
  Rig(const Model& model, const FrictionTestRow& row, const FrictionRig& rig, const Machine& machine,
      const AreaFunction& area)
      : model_(model),
        row_(row),
        rig_(rig),
        machine_(machine),
        area_(area),
        start_(closed_gap(row.normal_force / rig.plate_area, model.film.thickness)),
        gap_(start_),
        smoothing_(std::max(2e-4 * row.velocity, 1e-6)) {
    const Drive& drive = machine.drive;
    damping_ = 2.0 * drive.damping * std::sqrt(drive.stiffness * drive.holder_mass);
    longest_step_ = std::min(0.1 * std::sqrt(drive.holder_mass / drive.stiffness),
                             rig.pull_length / row.velocity / 2000.0);
  }

  /// So that a step sees the oscillator, and where the law falls with speed keeps one answer: the inertia of
  /// the holder then outweighs the slope.
  double longest_step() const {
    double slope = 0.0;
    for (const double speed : {speed_, row_.velocity, 10.0 * smoothing_})
      slope = std::min(slope, evaluate(model_, context_at(speed, 0.0), first_).dmu_dspeed);
    const double falling = -2.0 * slope * gap_.pressure * rig_.plate_area;
    if (falling == 0.0) return longest_step_;
    return std::min(longest_step_, 0.5 * machine_.drive.holder_mass / falling);
  }
  double displacement() const { return displacement_; }
  double pull_force() const { return cable_; }

  void rest(double time_step) {
    relax_gap(time_step);
    remember(first_, 0.0, time_step);
    remember(second_, 0.0, time_step);
    time_ += time_step;
  }

  /// Backward Euler for the holder: m dv/dt = cable - friction.
  void pull(double time_step) {
    relax_gap(time_step);
    pulled_ += time_step;
    const double speed = speed_after(time_step);
    remember(first_, speed, time_step);
    const double behind = taut() ? speed : second_speed(speed);
    remember(second_, behind, time_step);
    cable_ = cable(speed, time_step);
    displacement_ += speed * time_step;
    lag_ += (speed - behind) * time_step;
    speed_ = speed;
    time_ += time_step;
  }

  RigSample sample() const {
    const double normal = gap_.pressure * rig_.plate_area;
    const double film = first_.film_temperature;
    return {.time = time_,
            .displacement = displacement_,
            .pull_force = cable_,
            .normal_force = normal,
            .coefficient = normal > 0.0 ? effective_coefficient(cable_, normal) : 0.0,
            .film_temperature = film > 0.0 ? film : row_.fabric_temperature};
  }

 private:
  Context context_at(double speed, double time_step) const {
    Context context = contact_of(row_, rig_);
    context.pressure = gap_.pressure;
    context.slip_speed = speed;
    context.time_step = time_step;
    if (area_) std::tie(context.area_fraction, context.area_slope) = area_(context.pressure);
    return context;
  }

  /// Friction of one face, rising from nothing at rest as in the stamping solver.
  double face(const ContactState& state, double speed, double time_step) const {
    const double y = speed / smoothing_;
    const double ramp = y < 1.0 ? y * (2.0 - y) : 1.0;
    if (ramp == 0.0) return 0.0;
    return ramp * evaluate(model_, context_at(speed, time_step), state).mu * gap_.pressure * rig_.plate_area;
  }

  bool taut() const { return lag_ >= machine_.sample.slack; }
  double inner() const { return machine_.sample.inner_coefficient * gap_.pressure * rig_.plate_area; }

  double resistance(double speed, double time_step) const {
    const double first = face(first_, speed, time_step);
    if (!(machine_.sample.slack > 0.0)) return 2.0 * first;  // both plies have gone through the same
    const double second = face(second_, speed, time_step);
    return first + (taut() ? second : std::min(second, inner()));
  }

  /// Of a second ply with slack: the largest speed up to the first one's at which its plate does not hold it
  /// more than the inner interface draws it. The ply itself weighs nothing.
  double second_speed(double speed) const {
    if (face(second_, speed, 0.0) <= inner()) return speed;
    double low = 0.0, high = speed;
    for (int k = 0; k < 60; ++k) {
      const double middle = 0.5 * (low + high);
      (face(second_, middle, 0.0) <= inner() ? low : high) = middle;
    }
    return low;
  }

  /// A cable pulls and does not push.
  double cable(double speed, double time_step) const {
    const Drive& drive = machine_.drive;
    const double end = drawn(drive, row_.velocity, pulled_);
    const double end_speed = (end - drawn(drive, row_.velocity, pulled_ - time_step)) / time_step;
    const double stretch = end - displacement_ - speed * time_step;
    return stretch > 0.0 ? std::max(0.0, drive.stiffness * stretch + damping_ * (end_speed - speed)) : 0.0;
  }

  double speed_after(double time_step) const {
    const double mass = machine_.drive.holder_mass;
    const auto residual = [&](double speed) {
      return mass * (speed - speed_) / time_step - cable(speed, time_step) + resistance(speed, time_step);
    };
    // At rest nothing resists, so the residual is not positive there; at the free speed it is not negative.
    double low = 0.0, high = speed_ + cable(0.0, time_step) * time_step / mass;
    if (high <= 0.0) return 0.0;
    double at_low = residual(low), at_high = residual(high);
    if (at_low >= 0.0) return 0.0;
    // The speed hardly changes in a step: close in from where it was.
    const auto narrow = [&](double speed) {
      const double here = residual(speed);
      const bool below = here < 0.0;
      (below ? low : high) = speed;
      (below ? at_low : at_high) = here;
      return below;
    };
    if (speed_ > low && speed_ < high) {
      const bool rises = narrow(speed_);
      for (double reach = 1e-3 * speed_; reach < speed_; reach *= 10.0) {
        const double next = speed_ + (rises ? reach : -reach);
        if (!(next > low && next < high) || narrow(next) != rises) break;
      }
    }
    // False position with the Illinois weights, and bisection where that crawls.
    for (int k = 0; k < 200 && high - low > 1e-12 * high; ++k) {
      double middle = k % 3 == 2 ? 0.5 * (low + high) : (low * at_high - high * at_low) / (at_high - at_low);
      if (!(middle > low && middle < high)) middle = 0.5 * (low + high);
      (narrow(middle) ? at_high : at_low) *= 0.5;
    }
    return 0.5 * (low + high);
  }

  void relax_gap(double time_step) {
    if (machine_.cam) gap_ = relax(*machine_.cam, start_, gap_, time_step);
  }

  void remember(ContactState& state, double speed, double time_step) {
    const double friction = face(state, speed, time_step);
    state = evaluate(model_, context_at(speed, time_step), state).state;
    state.slip += speed * time_step;
    state.dwell += time_step;
    state.work_per_area += friction * speed * time_step / rig_.plate_area;
  }

  const Model& model_;
  const FrictionTestRow& row_;
  const FrictionRig& rig_;
  const Machine& machine_;
  const AreaFunction& area_;
  const GapState start_;
  GapState gap_;
  double smoothing_, damping_ = 0.0, longest_step_ = 0.0;  ///< [m/s], [N s/m], [s]
  double time_ = 0.0, pulled_ = 0.0;                       ///< since closing, since the drive went on [s]
  double displacement_ = 0.0, speed_ = 0.0;                ///< of the holder and the first ply
  double lag_ = 0.0;                                       ///< of the second ply behind it [m]
  double cable_ = 0.0;                                     ///< [N]
  ContactState first_, second_;
};

/// Mean over the samples of the last fifth of the pull.
template <class Value>
double late_mean(const RigRun& run, double pull_length, Value value) {
  double sum = 0.0;
  int count = 0;
  for (const RigSample& sample : run.samples)
    if (sample.displacement >= 0.8 * pull_length) {
      sum += value(sample);
      ++count;
    }
  return sum / count;
}

}  // namespace

RigRun run_machine(const Model& model, const FrictionTestRow& row, const FrictionRig& rig,
                   const Machine& machine, const AreaFunction& area) {
  RigRun run;
  Rig state(model, row, rig, machine, area);
  run.samples.push_back(state.sample());
  const double interval = 1.0 / machine.sampling_rate;
  const auto part = [](double time, double longest) {
    return std::max(1, static_cast<int>(std::ceil(time / longest)));
  };
  // Rest: steps of a sample; the drive then starts with a sample of its own.
  const int rests = rig.dwell_before > 0.0 ? part(rig.dwell_before, interval) : 0;
  for (int k = 0; k < rests; ++k) {
    state.rest(rig.dwell_before / rests);
    run.samples.push_back(state.sample());
  }
  // A drive that never gets there would be a mistake of ours: the pull force then exceeds any friction.
  const double give_up =
      10.0 * ((rig.pull_length + machine.drive.backlash + row.normal_force / machine.drive.stiffness) /
                  row.velocity +
              row.velocity / machine.drive.acceleration);
  for (double pulled = 0.0; state.displacement() < rig.pull_length; pulled += interval) {
    if (pulled > give_up)
      throw NumericalError(fmt::format("friction rig, row {}: the sample has moved {} m of {} m after {} s",
                                       row.name, state.displacement(), rig.pull_length, pulled));
    const int steps = part(interval, state.longest_step());
    for (int k = 0; k < steps && state.displacement() < rig.pull_length; ++k) {
      state.pull(interval / steps);
      if (state.pull_force() > run.peak_force) {
        run.peak_force = state.pull_force();
        run.peak_displacement = state.displacement();
      }
    }
    run.samples.push_back(state.sample());
  }
  run.steady_force = late_mean(run, rig.pull_length, [](const RigSample& s) { return s.pull_force; });
  run.steady_coefficient = late_mean(run, rig.pull_length, [](const RigSample& s) { return s.coefficient; });
  run.force_loss = 1.0 - run.samples.back().normal_force / run.samples.front().normal_force;
  return run;
}

}  // namespace heddle::friction
