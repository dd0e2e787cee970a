#pragma once

#include <string>
#include <utility>
#include <vector>

#include "pipeline/discover/hypothesis.h"

/// A model whose every prediction is a run of minutes, made cheap enough to search with: affine in its
/// numbers, slopes by forward differences. A slope that two step sizes do not agree on is none.
namespace heddle::discover {

/// One slope, and how it was found.
struct SlopeCheck {
  std::string id;             ///< of the effect; "" of a number of the baseline
  std::string key;            ///< of the number that was moved
  std::string detail;         ///< which choice of the effect's other numbers
  double step = 0.0;          ///< of the number; the second size is half of it
  double change = 0.0;        ///< largest |change| of ln F at the step
  double disagreement = 0.0;  ///< |slope of the step - slope of half the step| / the latter, as lengths
  std::string refused;        ///< why an effect is not searched along its amplitude; "" where it is
  int values = 0;             ///< of an effect without a slope: at how many values it is tried
};

struct SurrogateOptions {
  double disagreement = 0.1;   ///< beyond which an effect's slope is refused
  double clear_change = 0.01;  ///< of ln F somewhere: the step grows until it makes as much and agrees ...
  double farthest = 3.0;       ///< ... or reaches this coordinate of the prior
  double smallest_change = 0.001;  ///< of ln F; an effect that makes less at the farthest step is not seen
};

/// Point and slopes of the affine model. Rows are observations.
struct AffineModel {
  Eigen::VectorXd value;          ///< at the point
  Eigen::VectorXd numbers;        ///< of the baseline there
  Eigen::MatrixXd number_slopes;  ///< a column a number of the baseline
  Eigen::VectorXd amplitudes;     ///< of each candidate there; its off value where it is not in the point
  Eigen::VectorXd off;            ///< off value of each candidate's amplitude
  Eigen::MatrixXd effect_slopes;  ///< a column a candidate, per unit of its amplitude
  Eigen::VectorXd operator()(const Trial& trial) const;
};

struct Surrogate {
  ForwardModel model;              ///< candidates whose slopes hold
  AffineModel affine;              ///< behind model.predict
  std::vector<std::size_t> dear;   ///< which candidate of the dear model each is
  std::vector<SlopeCheck> checks;  ///< numbers of the baseline, then candidates of the dear model

  /// A trial of the surrogate as the dear model numbers its candidates.
  Trial for_dear(Trial trial) const;
};

/// The affine model about the centres of the priors with every effect off.
/// @param dear  each candidate with one free number, its amplitude, off at the centre of its prior
/// @throws NumericalError    if there is no finite prediction at the centre or one step of a baseline number
///                           away
/// @throws std::logic_error  if a candidate has more free numbers than one
Surrogate affine_surrogate(const ForwardModel& dear, const SurrogateOptions& options = {});

/// What a true run says of a trial of the surrogate.
struct TrueRun {
  Eigen::VectorXd value;    ///< of the dear model
  double size = 0.0;        ///< rms change of ln F from the point of the surrogate
  double difference = 0.0;  ///< rms of true - affine
  bool finite = false;
  /// Share of the change that the affine model is off.
  double share() const { return size > 0.0 ? difference / size : 0.0; }
};
TrueRun true_run(const ForwardModel& dear, const Surrogate& surrogate, const Trial& trial);

/// The affine model about a trial of one hypothesis: exact there, slopes of the baseline and of the effects
/// in the trial taken there again. For the numbers of that hypothesis; what it says of others is worse than
/// before.
/// @param run  of the same trial
/// @throws NumericalError  if a prediction near the trial is not finite
ForwardModel relinearised(const ForwardModel& dear, const Surrogate& surrogate, const Trial& trial,
                          const TrueRun& run);

}  // namespace heddle::discover
