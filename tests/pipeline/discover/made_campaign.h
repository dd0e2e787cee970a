#pragma once

#include <utility>
#include <vector>

#include "pipeline/discover/coordinates.h"
#include "pipeline/discover/propose.h"
#include "pipeline/discover/random.h"
#include "shipped_question.h"

namespace heddle::test {

/// A world in which the library's own forms hold up to the errors of form that discovery allows for: forces
/// for a campaign and for every condition that may follow it, with one draw of errors behind both.
class MadeWorld {
 public:
  MadeWorld(discover::CouponQuestion question, const std::vector<discover::CouponCell>& cells,
            const std::vector<discover::CouponCell>& candidates, int stretches)
      : question_(std::move(question)), measured_(cells.size()), stretches_(stretches) {
    std::vector<discover::CouponCell> all = cells;
    std::size_t days = 0;
    for (const discover::CouponCell& cell : cells) days = std::max(days, cell.day + 1);
    for (discover::CouponCell cell : candidates) {
      cell.day = days;
      cell.samples = cells.front().samples;
      all.push_back(cell);
    }
    days_ = days;
    plan_ = discover::planned_campaign(question_, all, stretches, days);
    for (const discover::FormCoordinate& c : plan_.observations.coordinates)
      modes_.push_back(question_.noise.effect_form * discover::smooth_modes(c.likeness));
  }

  const discover::ForwardModel& forward() const { return plan_.forward; }

  /// Measures everything once: one effect at a drawn amplitude and shape.
  void draw(std::size_t effect, discover::Random& random) {
    const auto count = std::ssize(discover::free_numbers(plan_.forward, {effect}));
    const auto base = plan_.baseline.z.size();
    Eigen::VectorXd z = 0.5 * random.normals(count);
    z[base] = 0.25 + 0.75 * random.uniform();  // of the usual amplitude
    const Eigen::VectorXd none = plan_.forward.predict(discover::trial_at(plan_.forward, {}, z.head(base)));
    const Eigen::VectorXd with = plan_.forward.predict(discover::trial_at(plan_.forward, {effect}, z));
    const Eigen::VectorXd share = with - none;
    force_ = with + plan_.baseline.data->unwhitened(random.normals(with.size()));
    // Errors of form over what the effect depends on, as discovery allows for them.
    const std::vector<double> weights = discover::form_weights(share, plan_.observations.coordinates);
    for (std::size_t k = 0; k < modes_.size(); ++k)
      force_ += std::sqrt(weights[k]) * share.cwiseProduct(modes_[k] * random.normals(modes_[k].cols()));
  }

  /// The campaign, and some of the candidates.
  std::vector<discover::CouponCell> measured(const std::vector<std::size_t>& more = {}) const {
    std::vector<std::size_t> which(measured_);
    for (std::size_t k = 0; k < measured_; ++k) which[k] = k;
    for (const std::size_t k : more) which.push_back(measured_ + k);
    std::vector<discover::CouponCell> cells;
    for (const std::size_t k : which) {
      cells.push_back(plan_.cells[k]);
      for (int s = 0; s < stretches_; ++s)
        cells.back().points[static_cast<std::size_t>(s)].log_force =
            force_[static_cast<Eigen::Index>(k) * stretches_ + s];
    }
    return cells;
  }

  /// Fits and scores, as discovery does once it has split and pooled.
  discover::CouponFindings analysed(const std::vector<discover::CouponCell>& cells) const {
    discover::PlannedCampaign plan = discover::planned_campaign(question_, cells, stretches_);
    discover::CouponFindings findings;
    findings.campaign.cells = findings.training = cells;
    findings.campaign.days.resize(days_);
    findings.noise = plan.noise;
    findings.forward = plan.forward;
    Eigen::Index row = 0;
    for (const discover::CouponCell& cell : cells)
      for (const discover::CouponPoint& point : cell.points) plan.observations.value[row++] = point.log_force;
    findings.result = discover::search(findings.forward, plan.observations, question_.search);
    return findings;
  }

  const discover::CouponQuestion& question() const { return question_; }

 private:
  discover::CouponQuestion question_;
  std::size_t measured_, days_ = 1;
  int stretches_;
  discover::PlannedCampaign plan_;
  std::vector<Eigen::MatrixXd> modes_;  ///< of the error of form over each coordinate
  Eigen::VectorXd force_;
};

/// The most probable answer that names something.
inline discover::Hypothesis first_name(const discover::CouponFindings& findings) {
  for (const discover::Scored& one : findings.result.scored)
    if (!one.fit.hypothesis.empty()) return one.fit.hypothesis;
  return {};
}

}  // namespace heddle::test
