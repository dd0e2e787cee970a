#pragma once

#include <Eigen/Core>
#include <cmath>
#include <memory>

#include "pipeline/discover/map_fit.h"
#include "pipeline/discover/random.h"

/// A world small enough for closed forms: a straight line that may be bent.
namespace heddle::test {

inline discover::Prior normal(double mean, double sd) {
  return {.kind = discover::Prior::Kind::normal, .centre = mean, .scale = sd};
}
inline discover::Prior half_normal(double scale) {
  return {.kind = discover::Prior::Kind::half_normal, .scale = scale, .low = 0.0};
}

/// y = level + slope x, and an effect that adds amplitude f(x).
struct Line {
  Eigen::VectorXd x = Eigen::VectorXd::LinSpaced(12, -1.0, 1.0);
  discover::ForwardModel model(const discover::Prior& amplitude, bool curved) const {
    discover::ForwardModel forward;
    forward.baseline = {{"level", "", normal(0.0, 1.0)}, {"slope", "", normal(0.0, 0.5)}};
    discover::Candidate bend;
    bend.id = "bend";
    bend.numbers = {{"bend.amplitude", "", amplitude}};
    forward.candidates = {bend};
    forward.predict = [at = x, curved](const discover::Trial& trial) -> Eigen::VectorXd {
      Eigen::VectorXd y = trial.baseline[0] + (trial.baseline[1] * at.array());
      for (const auto& [effect, values] : trial.effects)
        for (Eigen::Index i = 0; i < y.size(); ++i) {
          const double added = values[0] * at[i] * at[i];
          y[i] += curved ? std::expm1(added) : added;
        }
      return y;
    };
    return forward;
  }
};

inline std::shared_ptr<const discover::Whitened> measured(const Line& line, double bend, double sd) {
  discover::Random random(3);
  Eigen::VectorXd y = 0.3 + 0.2 * line.x.array() + bend * line.x.array().square();
  for (double& value : y) value += sd * random.normal();
  return std::make_shared<const discover::Whitened>(y,
                                                    sd * sd * Eigen::MatrixXd::Identity(y.size(), y.size()));
}

}  // namespace heddle::test
