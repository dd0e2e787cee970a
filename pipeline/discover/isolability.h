#pragma once

#include <Eigen/Core>
#include <cstddef>
#include <cstdint>
#include <optional>
#include <vector>

#include "pipeline/discover/map_fit.h"
#include "pipeline/discover/search.h"

namespace heddle::discover {

/// How observations move with the baseline's numbers and with each effect, to first order. Rows can be
/// stacked from cell to cell.
struct Changes {
  Eigen::MatrixXd baseline;  ///< d ln F / d z, one column a free number of the baseline
  struct OfEffect {
    std::size_t effect = 0;
    Eigen::VectorXd own;     ///< of ln F, at one standard deviation of its amplitude's prior, usual shape
    Eigen::MatrixXd slopes;  ///< of `own` with each shape number, per standard deviation of its prior
  };
  std::vector<OfEffect> effects;  ///< candidates that have an amplitude, in their order
};

/// @param baseline  fit of the empty hypothesis, or planned_baseline
Changes changes_of(const ForwardModel& model, const MapFit& baseline);

/// What one effect looks like in a campaign, as far as the baseline's own numbers leave it. Whitened: noise
/// alone is white, lengths are standard deviations.
struct Fingerprint {
  std::size_t effect = 0;
  Eigen::VectorXd own;  ///< at one standard deviation of its amplitude's prior, usual shape
  /// Where else it may lie, one column a standard deviation of prior: `own` itself for the amplitude, slopes
  /// with shape numbers, error of form.
  Eigen::MatrixXd freedoms;
};

/// Rows of `likeness` as sums of few independent smooth errors: modes modes^T = likeness to `share` of its
/// largest variance (Cholesky with pivots).
Eigen::MatrixXd smooth_modes(const Eigen::MatrixXd& likeness, double share = 0.02);

/// Fingerprints of all effects whose changes are finite.
std::vector<Fingerprint> fingerprints_of(const Changes& changes, const Whitened& data,
                                         const Observations& observations);

/// How well a campaign tells a truth from one rival: the squared distance in standard deviations that is left
/// when the rival does its best and pays for it what its prior asks,
///
///     lambda = g^T (1 + D D^T)^-1 g = min over x of |g - D x|^2 + |x|^2,
///
/// g the truth's fingerprint, D the rival's freedoms. For a rival of one long direction it is
/// |g|^2 sin^2(angle). Without the price a rival too weak to be seen could stand for anything
/// (docs/decisions/isolability.md).
double separation(const Fingerprint& truth, const Fingerprint& rival);
/// The same for every pair {truth, rival}; 0 on the diagonal.
Eigen::MatrixXd separations(const std::vector<Fingerprint>& prints);

/// About how often the truth is taken for the rival, where only these two are asked: Phi(-sqrt(lambda)/2).
double swap_rate(double lambda);

/// One effect in one campaign.
struct EffectSight {
  std::size_t effect = 0;
  double length = 0.0;  ///< standard deviations that its usual amplitude makes beside the baseline
  /// Amplitude that makes 3 of them, as a value of its number [SI]; empty where none within its prior's
  /// bounds does.
  std::optional<double> detectable = {};
  bool seen = false;   ///< the usual amplitude makes 3 or more
  double right = 0.0;  ///< expected rate of its own name at the usual amplitude
};

/// What a campaign can tell apart. Rows and columns of `lambda` are those of `effects`.
struct Isolability {
  std::vector<EffectSight> effects;
  Eigen::MatrixXd lambda;                        ///< {truth, rival}; 0 on the diagonal
  std::vector<std::vector<std::size_t>> groups;  ///< of two or more effects that are seen, but not apart
  double right_names = 0.0;                      ///< mean of `right` over all effects
};

struct IsolabilityOptions {
  double visible = 3.0;  ///< standard deviations that count as seen, and as apart
  int draws = 200;       ///< of noise, shape and form for each effect
  std::uint64_t seed = 1;
  SearchOptions prior = {};  ///< probabilities before the data
};

/// Detectable amplitudes, separations, groups and expected rates of a campaign, measured or planned: nothing
/// measured enters but what the baseline and the covariance were taken from.
///
/// A group is a connected component of the graph that joins two seen effects when the one that is seen better
/// lies closer than `visible` to the other: a weak effect is close to everything, which confuses nothing.
/// Expected names: every hypothesis as a linear Gaussian model in amplitude, shapes and error of form; right
/// is what is most probable, no effect among the answers, at a ln Bayes factor above that of the search.
Isolability isolability_of(const ForwardModel& model, const MapFit& baseline,
                           const Observations& observations, const IsolabilityOptions& options = {});

/// The baseline of a campaign that nobody has measured: its prior's centre, with forces as it predicts them.
/// @throws NumericalError  if a force is not finite there
MapFit planned_baseline(const ForwardModel& model, const Eigen::MatrixXd& covariance);

}  // namespace heddle::discover
