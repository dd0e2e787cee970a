#pragma once

#include <Eigen/Core>
#include <vector>

#include "pipeline/discover/map_fit.h"

namespace heddle::discover {

/// Observations whitened once more, for what the baseline's own numbers may do, each as far as its prior lets
/// it: seen from the prior mean the residual has the covariance I + J J^T, J the slopes of the baseline in z.
/// A direction that the baseline can take up shrinks; noise alone is white.
class BesideBaseline {
 public:
  explicit BesideBaseline(const Eigen::MatrixXd& slopes);
  /// (I + J J^T)^(-1/2) of changes at fixed numbers of the baseline.
  Eigen::MatrixXd operator()(const Eigen::MatrixXd& columns) const;
  /// The residual of a fit as it is seen from the prior mean: (I + J J^T)^(-1/2) (r - J z), J its slopes.
  /// Standard normal where nothing is missing. At the most probable numbers this is (I + J J^T)^(1/2) r, but
  /// not where a number lies at its bound.
  Eigen::VectorXd gap_of(const MapFit& fit) const;

 private:
  Eigen::MatrixXd directions_;  ///< left singular vectors of J
  Eigen::VectorXd shrink_;      ///< by how much each shrinks, less 1
};

/// Change of the whitened observations per unit of an effect's amplitude coordinate, at the baseline.
struct Signature {
  std::size_t effect = 0;
  Eigen::VectorXd shape;      ///< coordinates of the effect's free numbers beside the amplitude
  double amplitude = 0.0;     ///< coordinate at which the difference was taken
  Eigen::VectorXd direction;  ///< whitened, beside the baseline
  Eigen::VectorXd change;     ///< of the observations themselves, d ln F per unit of the coordinate
  /// What the residual says of the amplitude: standard normal if the effect is not there.
  double score = 0.0;
};

/// Signatures of one effect over its shapes at -1, 0 and 1 of each (the others at 0), of both signs of the
/// amplitude where it has two. Shapes without a finite prediction are left out.
/// @param baseline  fit of the empty hypothesis
/// @param gap       its residual beside the baseline
std::vector<Signature> signatures_of(const ForwardModel& model, const Whitened& data, const MapFit& baseline,
                                     const BesideBaseline& beside, const Eigen::VectorXd& gap,
                                     std::size_t effect);

/// The largest |score| among signatures; null where there are none.
const Signature* strongest(const std::vector<Signature>& signatures);

/// Where a fit of the baseline with this effect may start: from the baseline's own numbers with the amplitude
/// that the score asks for.
Eigen::VectorXd start_from(const ForwardModel& model, const MapFit& baseline, const Signature& signature);

}  // namespace heddle::discover
