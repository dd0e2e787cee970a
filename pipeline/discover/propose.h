#pragma once

#include <cstdint>
#include <string>
#include <utility>
#include <vector>

#include "pipeline/discover/discovery.h"

namespace heddle::discover {

struct ProposeOptions {
  std::size_t count = 3;       ///< of conditions to propose
  double rival = 0.02;         ///< probability above which an answer is a rival
  std::size_t rivals_min = 4;  ///< the most probable so many count in any case
  std::size_t rivals_max = 8;
  int outcomes = 200;          ///< simulated, of the proposed pulls
  double separable = 0.7;      ///< rate of right choices between two below which they are not apart
  std::size_t shortlist = 48;  ///< conditions that are looked at closely
  std::uint64_t seed = 1;
};

/// An answer that more pulls may confirm or refute.
struct Rival {
  Hypothesis hypothesis;
  std::string name;          ///< "none", or ids joined by +
  double probability = 0.0;  ///< among the rivals
};

/// A pair of rivals, by their numbers.
using RivalPair = std::pair<std::size_t, std::size_t>;

/// One condition to pull next.
struct ProposedPull {
  CouponCell cell;
  double right = 0.0;  ///< expected probability of the right answer with this and the ones before
  double gain = 0.0;   ///< by how much that grew
  std::vector<RivalPair> separates;  ///< pairs that it tells apart on its own, else the one it tells best
};

struct Proposal {
  std::vector<Rival> rivals;                     ///< most probable first
  std::vector<ProposedPull> pulls;               ///< in the order they were chosen
  double right_before = 0.0, right_after = 0.0;  ///< expected probability of the right answer
  std::vector<RivalPair> inseparable;            ///< that no `count` of the candidates tell apart
};

/// Conditions that may be pulled next: lowest, usual and highest level of every factor of the campaign,
/// crossed, without what is measured already. Inside the campaign's hull, where its fits hold.
std::vector<CouponCell> candidate_grid(const CouponCampaign& campaign);

/// Chooses, one by one, the conditions after which the right answer is expected to be most probable: mean
/// over simulated outcomes of the largest probability. Where that is equal, by the criterion of
/// Buzzi-Ferraris and Forzatti (1984) of the whole set,
///
///     sum over pairs P_i P_j (D^T V^-1 D + tr(2 N V^-1)),  V = S_i + S_j,
///
/// D the difference of what they predict after the data, N the covariance of noise, S_i what a rival's forces
/// would scatter by: noise, its numbers as the data left them (linear about the fit), and the errors of form
/// of law and effect, all conditioned on the data. What one condition would tell is in S_i already when the
/// next is chosen. All of them are pulled on one new day. The criterion alone, which never has enough of
/// a pair that is apart already, chose no better than chance (docs/decisions/isolability.md).
/// @param candidates  as candidate_grid makes them, or a pool of one's own
Proposal propose(const CouponQuestion& question, const CouponFindings& findings,
                 const std::vector<CouponCell>& candidates, const ProposeOptions& options = {});

}  // namespace heddle::discover
