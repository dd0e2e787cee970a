#pragma once

#include <cstdint>
#include <optional>
#include <string>
#include <utility>
#include <vector>

#include "friction/calibration/model_numbers.h"
#include "pipeline/discover/coupon_forward.h"
#include "pipeline/discover/isolability.h"
#include "pipeline/discover/locate.h"
#include "pipeline/discover/noise.h"
#include "pipeline/discover/search.h"
#include "pipeline/discover/shape.h"
#include "pipeline/discover/split.h"
#include "pipeline/discover/validate.h"
#include "pipeline/discover/verdict.h"

namespace heddle::discover {

/// What is looked for in measured coupons.
struct CouponQuestion {
  friction::Model base;
  CouponRig rig;
  std::vector<Unknown> baseline;    ///< numbers that every hypothesis moves
  std::vector<EffectFile> effects;  ///< the library
  NoiseWish noise;
  double held_out = 0.25;
  std::uint64_t seed = 1;
  double tow_pitch = 0.0;  ///< [m], 0 where it is not known
  SearchOptions search;
  VerdictOptions verdict;
};

/// All that was found. Indices of cells are those of `campaign`; rows of fits those of the training cells.
struct CouponFindings {
  CouponCampaign campaign;
  Split split;
  CouponNoise noise;
  std::vector<CouponCell> training;
  ForwardModel forward;  ///< of the training cells, with the pairs of R6 that were tried
  SearchResult result;
  std::vector<Contrast> contrasts;
  std::vector<Location> locations;
  std::vector<double> largest;  ///< of noise alone, for p-values
  double gate_statistic = 0.0;  ///< largest of contrasts and signatures
  std::string gate_from;        ///< which
  Evidence evidence;
  Decision decision;
  std::optional<Gap> gap;  ///< absent where nothing could be held out
  std::vector<HeldOut> held_out;
  bool saturated = false;   ///< as many numbers as conditions: a gap that shrinks says nothing
  Isolability isolability;  ///< of the training cells, at the fitted baseline
  std::vector<std::pair<std::string, std::string>> refused;  ///< effects not tried, and why
  std::vector<std::string> notes;

  /// The model with the best hypothesis in it; rig effects leave the base.
  friction::Model patched(const friction::Model& base) const;
};

/// Split, baseline, gate, locate, screen, score, name, validate.
/// @throws NumericalError  if the baseline itself has no finite prediction
CouponFindings discover_in_coupons(const CouponQuestion& question, const friction::CouponData& data);

/// Search, gate, location, stability and verdict, of training cells, noise and forward model that are there:
/// the part that assumes nothing of what was measured.
void judge(CouponFindings& findings, const Observations& observations, const CouponQuestion& question);

/// Prior of a number that the user says nothing of: positive numbers log-normal about the case's value with a
/// factor of 2, others normal with their own size or 0.1; power_index within 0.04 and activation_energy
/// within a tenth (what rheology knows: docs/theory/discovery.md).
Prior usual_prior(const friction::ModelNumber& number);

}  // namespace heddle::discover
