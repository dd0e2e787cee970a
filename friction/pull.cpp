#include "friction/pull.h"

namespace heddle::friction {

std::vector<PullPoint> pull_history(const Model& model, const FrictionTestRow& row, const FrictionRig& rig,
                                    int steps, const AreaFunction& area) {
  Context context = contact_of(row, rig, area);
  ContactState state = state_after_rest(model, context, rig.dwell_before);
  const double slip_step = rig.pull_length / steps;
  const double time_step = slip_step / row.velocity;
  std::vector<PullPoint> points;
  for (int i = 0; i <= steps; ++i) {
    context.time_step = 0.0;
    const double mu = evaluate(model, context, state).mu;
    points.push_back(
        {.time = i * time_step, .slip = i * slip_step, .mu = mu, .force = 2.0 * mu * row.normal_force});
    context.time_step = time_step;
    state = evaluate(model, context, state).state;
    state.dwell += time_step;
    state.slip += slip_step;
  }
  return points;
}

std::optional<Sawtooth> sawtooth(const Model& model, const FrictionTestRow& row, const FrictionRig& rig,
                                 double stiffness, const AreaFunction& area) {
  Context context = contact_of(row, rig, area);
  const ContactState state = state_after_pull(model, context, rig);
  const double kinetic = 2.0 * evaluate(model, context, state).mu * row.normal_force;
  context.slip_speed = 0.0;
  const double still = 2.0 * evaluate(model, context, state).mu * row.normal_force;
  if (!(still > kinetic)) return {};
  const double drop = 2.0 * (still - kinetic);
  return Sawtooth{.upper_force = still,
                  .lower_force = still - drop,
                  .slip_jump = drop / stiffness,
                  .period = drop / (stiffness * row.velocity)};
}

}  // namespace heddle::friction
