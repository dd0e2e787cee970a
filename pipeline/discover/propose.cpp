#include "pipeline/discover/propose.h"

#include <fmt/format.h>
#include <tbb/parallel_for.h>

#include <algorithm>
#include <cmath>
#include <map>
#include <set>

#include "pipeline/discover/coordinates.h"
#include "pipeline/discover/random.h"

namespace heddle::discover {

namespace {

using Rows = std::vector<Eigen::Index>;

/// What one rival expects of new pulls.
struct Outlook {
  Eigen::VectorXd mean;
  Eigen::MatrixXd covariance;  ///< with noise
};

/// Candidates' cells with points like the campaign's, on a day of their own.
std::vector<CouponCell> dressed(const std::vector<CouponCell>& candidates, const CouponFindings& findings) {
  std::map<int, std::pair<double, int>> slips;
  std::map<int, int> samples;
  bool steady = true;
  for (const CouponCell& cell : findings.training) {
    ++samples[cell.samples];
    for (const CouponPoint& point : cell.points) {
      slips[point.stretch].first += point.slip;
      ++slips[point.stretch].second;
      steady = steady && point.steady;
    }
  }
  const int usual = std::ranges::max_element(samples, {}, [](const auto& s) { return s.second; })->first;
  std::vector<CouponCell> cells = candidates;
  for (CouponCell& cell : cells) {
    cell.day = findings.campaign.days.size();
    cell.samples = usual;
    cell.load_measured = findings.training.front().load_measured;
    cell.points.clear();
    for (const auto& [stretch, slip] : slips)
      cell.points.push_back({.stretch = stretch,
                             .steady = steady,
                             .slip = slip.first / slip.second,
                             .normal_force = cell.pull.normal_force});
  }
  return cells;
}

/// Rivals' forces on cells that nobody pulled.
class Elsewhere {
 public:
  Elsewhere(const CouponQuestion& question, const CouponFindings& findings,
            const std::vector<CouponCell>& cells)
      : findings_(findings),
        forward_(coupon_forward(question.base, question.rig, cells, question.baseline,
                                usable_effects(question.base, question.effects),
                                findings.campaign.days.size())) {}

  Eigen::VectorXd predict(const Hypothesis& hypothesis, const Eigen::VectorXd& z) const {
    return forward_.predict(here(trial_at(findings_.forward, hypothesis, z)));
  }

  Eigen::MatrixXd slopes(const MapFit& fit, const Eigen::VectorXd& at) const {
    constexpr double step = 1e-3;
    Eigen::MatrixXd slopes(at.size(), fit.z.size());
    const std::vector<const Unknown*> numbers = free_numbers(findings_.forward, fit.hypothesis);
    for (Eigen::Index k = 0; k < fit.z.size(); ++k) {
      const double high = numbers[static_cast<std::size_t>(k)]->prior.bounds()[1];
      const double h = fit.z[k] + step <= high ? step : -step;
      Eigen::VectorXd moved = fit.z;
      moved[k] += h;
      slopes.col(k) = (predict(fit.hypothesis, moved) - at) / h;
    }
    return slopes;
  }

  /// What each effect of a fit does to ln F.
  std::vector<Eigen::VectorXd> shares(const MapFit& fit, const Eigen::VectorXd& whole) const {
    std::vector<Eigen::VectorXd> shares;
    for (std::size_t k = 0; k < fit.trial.effects.size(); ++k) {
      Trial without = fit.trial;
      without.effects.erase(without.effects.begin() + static_cast<std::ptrdiff_t>(k));
      shares.push_back(whole - forward_.predict(here(std::move(without))));
    }
    return shares;
  }

 private:
  /// A wrong label belongs to the cell that carries it.
  Trial here(Trial trial) const {
    std::erase_if(trial.effects,
                  [&](const auto& effect) { return effect.first >= forward_.candidates.size(); });
    return trial;
  }

  const CouponFindings& findings_;
  ForwardModel forward_;
};

std::vector<double> hersey_of(const CouponQuestion& question, const CouponFindings& findings,
                              const std::vector<CouponCell>& cells) {
  const friction::Model fitted =
      patched_model(question.base, findings.forward, findings.result.baseline.trial);
  return hersey_numbers(fitted, question.rig, cells);
}

/// Covariances that rivals share, of the training cells and then the candidates.
struct Shared {
  Eigen::MatrixXd covariance;
  std::vector<FormCoordinate> coordinates;
  Eigen::MatrixXd noise;  ///< of the candidates alone
  Eigen::Index measured = 0;
};

Shared shared_of(const CouponQuestion& question, const CouponFindings& findings,
                 const std::vector<CouponCell>& cells) {
  std::vector<CouponCell> all = findings.training;
  all.insert(all.end(), cells.begin(), cells.end());
  CouponNoise noise_alone = findings.noise;
  noise_alone.form = noise_alone.history = 0.0;
  Shared shared{.covariance = covariance_of(findings.noise, all, hersey_of(question, findings, all)),
                .coordinates = {},
                .noise = covariance_of(noise_alone, cells, {}),
                .measured = findings.result.baseline.residual.size()};
  shared.coordinates = form_coordinates(all, question.noise.effect_form_length, shared.measured);
  return shared;
}

/// A rival's numbers and errors of form after the data, carried to the candidates.
Outlook outlook_of(const CouponQuestion& question, const Shared& shared, const MapFit& fit,
                   const Elsewhere& at_training, const Elsewhere& elsewhere) {
  const Eigen::Index n = shared.measured, size = shared.covariance.rows(), c = size - n;
  const Eigen::VectorXd here = at_training.predict(fit.hypothesis, fit.z),
                        there = elsewhere.predict(fit.hypothesis, fit.z);
  Eigen::MatrixXd covariance = shared.covariance;
  const auto here_shares = at_training.shares(fit, here), there_shares = elsewhere.shares(fit, there);
  for (std::size_t k = 0; k < here_shares.size(); ++k) {
    Eigen::VectorXd share(size);
    share << here_shares[k], there_shares[k];
    covariance += form_covariance(share, shared.coordinates, fit.form_share * question.noise.effect_form);
  }
  const Whitened data(Eigen::VectorXd::Zero(n), covariance.topLeftCorner(n, n));
  const Eigen::VectorXd residual = data(fit.data->unwhitened(fit.residual));
  const Eigen::MatrixXd jacobian = data(fit.data->unwhitened(fit.jacobian));
  const Eigen::MatrixXd cross = data(covariance.topRightCorner(n, c));
  const Eigen::MatrixXd carried = elsewhere.slopes(fit, there) - cross.transpose() * jacobian;
  const Eigen::MatrixXd curvature =
      jacobian.transpose() * jacobian + Eigen::MatrixXd::Identity(jacobian.cols(), jacobian.cols());
  // The residual is model less measured.
  Outlook outlook{.mean = there - cross.transpose() * residual, .covariance = {}};
  outlook.covariance = covariance.bottomRightCorner(c, c) - cross.transpose() * cross +
                       carried * curvature.llt().solve(carried.transpose());
  return outlook;
}

/// Rivals' outlooks on a list of cells, and what sets of these cells would tell.
class Contest {
 public:
  Contest(std::vector<Outlook> outlooks, Eigen::MatrixXd noise, std::vector<Rival> rivals, Eigen::Index each,
          const ProposeOptions& options)
      : outlooks_(std::move(outlooks)), noise_(std::move(noise)), rivals_(std::move(rivals)), each_(each) {
    Random random(options.seed);
    for (int k = 0; k < options.outcomes; ++k) {
      truths_.push_back(random.uniform());
      draws_.push_back(random.normals(each * static_cast<Eigen::Index>(options.count)));
    }
  }

  Rows rows_of(const std::vector<std::size_t>& cells) const {
    Rows rows;
    for (const std::size_t cell : cells)
      for (Eigen::Index k = 0; k < each_; ++k) rows.push_back(static_cast<Eigen::Index>(cell) * each_ + k);
    return rows;
  }

  /// Buzzi-Ferraris' criterion of a set.
  double criterion(const Rows& rows) const {
    const Eigen::MatrixXd twice_noise = 2.0 * noise_(rows, rows);
    double sum = 0.0;
    for (std::size_t i = 0; i < outlooks_.size(); ++i)
      for (std::size_t j = 0; j < i; ++j) {
        const Eigen::LLT<Eigen::MatrixXd> root = root_of({j, i}, rows);
        const Eigen::VectorXd away = root.matrixL().solve(difference({j, i}, rows));
        sum += rivals_[i].probability * rivals_[j].probability *
               (away.squaredNorm() + root.solve(twice_noise).trace());
      }
    return sum;
  }

  /// Rate of right choices between two rivals, where only these are asked: Phi(d/2), d their distance in
  /// standard deviations.
  double right_of_two(const RivalPair& pair, const Rows& rows) const {
    const Eigen::VectorXd away = root_of(pair, rows).matrixL().solve(difference(pair, rows));
    return normal_probability(0.5 * std::sqrt(2.0 * away.squaredNorm()));
  }

  /// Mean over simulated outcomes of the probability that the best answer has after them.
  double right(const Rows& rows) const {
    std::vector<Eigen::LLT<Eigen::MatrixXd>> roots;
    std::vector<double> log_weight;
    for (std::size_t k = 0; k < outlooks_.size(); ++k) {
      roots.emplace_back(Eigen::MatrixXd(outlooks_[k].covariance(rows, rows)));
      log_weight.push_back(std::log(rivals_[k].probability) -
                           roots.back().matrixLLT().diagonal().array().log().sum());
    }
    double sum = 0.0;
    for (std::size_t outcome = 0; outcome < truths_.size(); ++outcome) {
      const std::size_t truth = truth_of(truths_[outcome]);
      const Eigen::VectorXd draws = draws_[outcome].head(std::ssize(rows));
      const Eigen::VectorXd forces = outlooks_[truth].mean(rows) + roots[truth].matrixL() * draws;
      std::vector<double> weights;
      for (std::size_t k = 0; k < outlooks_.size(); ++k)
        weights.push_back(
            log_weight[k] -
            0.5 * roots[k].matrixL().solve(forces - Eigen::VectorXd(outlooks_[k].mean(rows))).squaredNorm());
      const double top = std::ranges::max(weights);
      double total = 0.0;
      for (const double weight : weights) total += std::exp(weight - top);
      sum += 1.0 / total;
    }
    return sum / static_cast<double>(truths_.size());
  }

 private:
  Eigen::LLT<Eigen::MatrixXd> root_of(const RivalPair& pair, const Rows& rows) const {
    return Eigen::LLT<Eigen::MatrixXd>(outlooks_[pair.first].covariance(rows, rows) +
                                       outlooks_[pair.second].covariance(rows, rows));
  }
  Eigen::VectorXd difference(const RivalPair& pair, const Rows& rows) const {
    return outlooks_[pair.first].mean(rows) - outlooks_[pair.second].mean(rows);
  }
  std::size_t truth_of(double uniform) const {
    for (std::size_t k = 0; k + 1 < rivals_.size(); ++k) {
      if (uniform < rivals_[k].probability) return k;
      uniform -= rivals_[k].probability;
    }
    return rivals_.size() - 1;
  }

  std::vector<Outlook> outlooks_;
  Eigen::MatrixXd noise_;
  std::vector<Rival> rivals_;
  Eigen::Index each_;
  std::vector<double> truths_;
  std::vector<Eigen::VectorXd> draws_;
};

std::vector<Rival> rivals_of(const CouponFindings& findings, const ProposeOptions& options) {
  std::vector<Rival> rivals;
  double total = 0.0;
  for (const Scored& one : findings.result.scored) {
    if (rivals.size() == options.rivals_max) break;
    if (!std::isfinite(one.fit.log_evidence)) continue;
    if (one.probability <= options.rival && rivals.size() >= options.rivals_min) break;
    std::vector<std::string> ids;
    for (const std::size_t effect : one.fit.hypothesis) ids.push_back(findings.forward.candidates[effect].id);
    rivals.push_back({.hypothesis = one.fit.hypothesis,
                      .name = ids.empty() ? "none" : fmt::format("{}", fmt::join(ids, "+")),
                      .probability = std::max(one.probability, 1e-6)});
    total += rivals.back().probability;
  }
  for (Rival& rival : rivals) rival.probability /= total;
  return rivals;
}

std::vector<RivalPair> pairs_of(std::size_t count) {
  std::vector<RivalPair> pairs;
  for (std::size_t i = 0; i < count; ++i)
    for (std::size_t j = i + 1; j < count; ++j) pairs.emplace_back(i, j);
  return pairs;
}

/// A first look at every candidate alone: differences of the fits against noise and the scatter of their
/// numbers, the data's hold on errors of form left out. Keeps the best of every pair in turn.
std::vector<std::size_t> shortlist_of(const CouponFindings& findings, const std::vector<Rival>& rivals,
                                      const std::vector<CouponCell>& cells, const Elsewhere& elsewhere,
                                      Eigen::Index each, std::size_t wanted) {
  std::vector<Eigen::VectorXd> means(rivals.size());
  std::vector<Eigen::MatrixXd> roots(rivals.size());
  tbb::parallel_for(std::size_t{0}, rivals.size(), [&](std::size_t k) {
    const MapFit& fit = findings.result.find(rivals[k].hypothesis)->fit;
    means[k] = elsewhere.predict(fit.hypothesis, fit.z);
    const Eigen::MatrixXd spread = fit.covariance.llt().matrixL();
    roots[k] = elsewhere.slopes(fit, means[k]) * spread;
  });
  const auto finite = [&](std::size_t c) {
    const auto at = static_cast<Eigen::Index>(c) * each;
    for (std::size_t k = 0; k < rivals.size(); ++k)
      if (!means[k].segment(at, each).allFinite() || !roots[k].middleRows(at, each).allFinite()) return false;
    return true;
  };
  const std::vector<RivalPair> pairs = pairs_of(rivals.size());
  std::vector<std::vector<std::pair<double, std::size_t>>> order(pairs.size());
  for (std::size_t c = 0; c < cells.size(); ++c) {
    if (!finite(c)) continue;
    const auto at = static_cast<Eigen::Index>(c) * each;
    const Eigen::MatrixXd noise = 2.0 * covariance_of(findings.noise, {cells[c]}, {});
    for (std::size_t p = 0; p < pairs.size(); ++p) {
      const auto [i, j] = pairs[p];
      const Eigen::MatrixXd of_i = roots[i].middleRows(at, each), of_j = roots[j].middleRows(at, each);
      const Eigen::LLT<Eigen::MatrixXd> root(noise + of_i * of_i.transpose() + of_j * of_j.transpose());
      const Eigen::VectorXd away =
          root.matrixL().solve(means[i].segment(at, each) - means[j].segment(at, each));
      order[p].emplace_back(-away.squaredNorm(), c);
    }
  }
  for (auto& one : order) std::ranges::sort(one);
  std::vector<std::size_t> kept;
  for (std::size_t rank = 0; rank < cells.size() && kept.size() < wanted; ++rank)
    for (const auto& one : order)
      if (rank < one.size() && kept.size() < wanted && std::ranges::count(kept, one[rank].second) == 0)
        kept.push_back(one[rank].second);
  return kept;
}

/// Adds the cell that makes most of `value`, until there are `count`.
template <class Value>
std::vector<std::size_t> chosen_one_by_one(std::size_t cells, std::size_t count, const Value& value) {
  std::vector<std::size_t> chosen;
  while (chosen.size() < std::min(count, cells)) {
    std::vector<double> values(cells, -1.0);
    tbb::parallel_for(std::size_t{0}, cells, [&](std::size_t c) {
      if (std::ranges::count(chosen, c) > 0) return;
      std::vector<std::size_t> set = chosen;
      set.push_back(c);
      values[c] = value(set);
    });
    chosen.push_back(static_cast<std::size_t>(std::ranges::max_element(values) - values.begin()));
  }
  return chosen;
}

double three_digits(double value) {
  const double unit = std::pow(10.0, std::floor(std::log10(value)) - 2.0);
  return unit * std::round(value / unit);
}

std::vector<RivalPair> separated_by(const Contest& contest, const std::vector<RivalPair>& pairs,
                                    std::size_t cell) {
  constexpr double clear = 0.8;  // rate of right choices that one condition alone may be credited with
  std::vector<RivalPair> separated;
  RivalPair best{};
  double most = 0.0;
  for (const RivalPair& pair : pairs) {
    const double right = contest.right_of_two(pair, contest.rows_of({cell}));
    if (right >= clear) separated.push_back(pair);
    if (right > most) {
      most = right;
      best = pair;
    }
  }
  if (separated.empty() && !pairs.empty()) separated.push_back(best);
  return separated;
}

}  // namespace

std::vector<CouponCell> candidate_grid(const CouponCampaign& campaign) {
  // Conditions alike in what a factor measures are one level: an orientation of 0 degrees and one of 90.
  const auto level = [](const Factor& factor, const CouponCell& cell) {
    return std::lround(20.0 * factor.of(cell));
  };
  const auto same_factors = [&](const CouponCell& a, const CouponCell& b) {
    return std::ranges::all_of(factors(), [&](const Factor& factor) {
      const std::string name = factor.name;
      return name == "day" || name == "warp_or_weft" || level(factor, a) == level(factor, b);
    });
  };
  std::vector<CouponCell> grid{campaign.cells.front()};
  const auto cross = [&](const Factor& factor, const auto& copy) {
    std::map<long, std::pair<int, const CouponCell*>> levels;
    for (const CouponCell& cell : campaign.cells) {
      auto& [times, first] = levels[level(factor, cell)];
      ++times;
      if (first == nullptr) first = &cell;
    }
    const auto usual = std::ranges::max_element(levels, {}, [](const auto& l) { return l.second.first; });
    std::set<long> kept{levels.begin()->first, usual->first, levels.rbegin()->first};
    if (kept.size() == 2 && levels.size() > 2)
      kept.insert(std::next(levels.begin(), std::ssize(levels) / 2)->first);
    std::vector<CouponCell> crossed;
    for (const CouponCell& cell : grid)
      for (const long one : kept) {
        crossed.push_back(cell);
        copy(crossed.back(), *levels.at(one).second);
      }
    grid = std::move(crossed);
  };
  const auto& all = factors();
  cross(all[0], [](CouponCell& to, const CouponCell& from) {
    to.pull.tool_temperature = from.pull.tool_temperature;
  });
  cross(all[1], [](CouponCell& to, const CouponCell& from) {
    to.pull.fabric_temperature = from.pull.fabric_temperature;
  });
  cross(all[2],
        [](CouponCell& to, const CouponCell& from) { to.pull.normal_force = from.pull.normal_force; });
  cross(all[3], [](CouponCell& to, const CouponCell& from) { to.pull.velocity = from.pull.velocity; });
  cross(all[4], [](CouponCell& to, const CouponCell& from) { to.pull.orientation = from.pull.orientation; });
  cross(all[5], [](CouponCell& to, const CouponCell& from) { to.dwell = from.dwell; });
  std::vector<CouponCell> fresh;
  for (const CouponCell& cell : grid)
    if (std::ranges::none_of(campaign.cells,
                             [&](const CouponCell& measured) { return same_factors(cell, measured); }))
      fresh.push_back(cell);
  for (CouponCell& cell : fresh) {
    cell.pull.name.clear();
    cell.pull.normal_force = three_digits(cell.pull.normal_force);  // the mean of what was measured
  }
  return fresh;
}

Proposal propose(const CouponQuestion& question, const CouponFindings& findings,
                 const std::vector<CouponCell>& candidates, const ProposeOptions& options) {
  Proposal proposal;
  proposal.rivals = rivals_of(findings, options);
  if (proposal.rivals.empty()) return proposal;
  proposal.right_before = proposal.right_after = proposal.rivals.front().probability;
  if (candidates.empty() || proposal.rivals.size() < 2) return proposal;

  std::vector<CouponCell> cells = dressed(candidates, findings);
  const auto each = std::ssize(cells.front().points);
  const std::vector<std::size_t> kept = shortlist_of(
      findings, proposal.rivals, cells, Elsewhere(question, findings, cells), each, options.shortlist);
  cells = pick(cells, kept);
  if (cells.empty()) return proposal;
  const Elsewhere at_training(question, findings, findings.training), elsewhere(question, findings, cells);
  const Shared shared = shared_of(question, findings, cells);
  std::vector<Outlook> outlooks(proposal.rivals.size());
  tbb::parallel_for(std::size_t{0}, outlooks.size(), [&](std::size_t k) {
    outlooks[k] = outlook_of(question, shared, findings.result.find(proposal.rivals[k].hypothesis)->fit,
                             at_training, elsewhere);
  });
  const Contest contest(std::move(outlooks), shared.noise, proposal.rivals, each, options);

  const std::vector<RivalPair> pairs = pairs_of(proposal.rivals.size());
  // What the criterion of distances leaves equal in the rate of right answers, it decides.
  const std::vector<std::size_t> chosen =
      chosen_one_by_one(cells.size(), options.count, [&](const std::vector<std::size_t>& set) {
        const Rows rows = contest.rows_of(set);
        const double distance = contest.criterion(rows);
        return contest.right(rows) + 1e-4 * distance / (1.0 + distance);
      });
  for (std::size_t k = 0; k < chosen.size(); ++k) {
    const std::vector<std::size_t> so_far(chosen.begin(),
                                          chosen.begin() + static_cast<std::ptrdiff_t>(k) + 1);
    const double right = contest.right(contest.rows_of(so_far));
    proposal.pulls.push_back({.cell = cells[chosen[k]],
                              .right = right,
                              .gain = right - proposal.right_after,
                              .separates = separated_by(contest, pairs, chosen[k])});
    proposal.right_after = right;
  }
  for (const RivalPair& pair : pairs) {
    const auto value = [&](const std::vector<std::size_t>& set) {
      return contest.right_of_two(pair, contest.rows_of(set));
    };
    if (value(chosen_one_by_one(cells.size(), options.count, value)) < options.separable)
      proposal.inseparable.push_back(pair);
  }
  return proposal;
}

}  // namespace heddle::discover
