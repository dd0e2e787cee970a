#include "pipeline/discover_report_gap.h"

#include <fmt/format.h>

#include <Eigen/QR>
#include <algorithm>
#include <cctype>
#include <cmath>
#include <map>
#include <numbers>
#include <set>

#include "pipeline/painter.h"

namespace heddle::pipeline {

namespace {

using discover::CouponCell;
using discover::CouponFindings;
using discover::CouponPoint;

/// A factor as people read it off the machine, where contrasts see logarithms and angles see sines.
struct ShownFactor {
  std::string name, unit;
  bool logarithmic;
  double (*of)(const CouponCell&);
};
std::vector<ShownFactor> shown_factors() {
  std::vector<ShownFactor> all;
  for (const discover::Factor& factor : discover::factors()) {
    std::string name = factor.name, unit = factor.unit;
    if (name == "day" || name == "warp_or_weft") continue;
    const bool logarithmic = name == "normal_force" || name == "velocity";
    std::ranges::replace(name, '_', ' ');
    if (unit.starts_with("deg")) unit.replace(0, 3, "°");
    all.push_back({name, unit, logarithmic, factor.shown});
  }
  return all;
}

std::string value_text(double value, bool logarithmic) {
  return plain_number(std::abs(value) < 1e-9 ? 0.0 : value, logarithmic ? 3 : 4);
}

/// First value of each level. Measured loads of one nominal level differ in their last digits: 3 % is one
/// level.
std::vector<double> level_starts(std::vector<double> values, bool logarithmic, std::size_t most) {
  std::ranges::sort(values);
  const double low = values.front(), range = values.back() - low;
  const auto apart = [&](double from, double to) {
    return logarithmic ? to > 1.03 * from : to - from > 1e-3 * range && to - from > 1e-6;
  };
  std::vector<double> starts{low};
  for (const double value : values)
    if (apart(starts.back(), value)) starts.push_back(value);
  if (starts.size() <= most) return starts;
  starts.clear();
  for (std::size_t k = 0; k < most; ++k) {
    const double share = static_cast<double>(k) / static_cast<double>(most);
    starts.push_back(logarithmic ? low * std::pow(values.back() / low, share) : low + share * range);
  }
  return starts;
}

std::optional<Levels> levels_of(const std::vector<double>& values, const ShownFactor& factor,
                                std::size_t most) {
  const std::vector<double> starts = level_starts(values, factor.logarithmic, most);
  if (starts.size() < 2) return {};
  Levels levels{factor.name, factor.unit, factor.logarithmic, {}, {}, {}};
  struct Gathered {
    double sum = 0.0, low = 1e300, high = -1e300;
    int count = 0;
  };
  std::map<std::size_t, Gathered> gathered;
  std::vector<std::size_t> places;
  for (const double value : values) {
    const auto after = std::upper_bound(starts.begin() + 1, starts.end(), value);
    places.push_back(static_cast<std::size_t>(after - starts.begin()) - 1);
    Gathered& one = gathered[places.back()];
    one.sum += value;
    one.low = std::min(one.low, value);
    one.high = std::max(one.high, value);
    ++one.count;
  }
  std::map<std::size_t, std::size_t> number;  // parts of the range that hold no point are no level
  for (const auto& [place, one] : gathered) {
    number[place] = levels.at.size();
    levels.at.push_back(one.sum / one.count);
    const bool single = one.high - one.low <= (factor.logarithmic ? 0.031 * one.low : 1e-6);
    levels.text.push_back(single
                              ? value_text(levels.at.back(), factor.logarithmic)
                              : fmt::format("{}–{}", value_text(one.low, true), value_text(one.high, true)));
  }
  for (const std::size_t place : places) levels.of.push_back(number[place]);
  return levels;
}

Levels levels_of_slip(const GapTable& table) {
  Levels levels{"slip", "mm", true, {}, {}, {}};
  const auto count = static_cast<std::size_t>(table.findings->campaign.stretches);
  std::vector<double> sum(count, 0.0), points(count, 0.0);
  for (const CouponPoint& point : table.point) {
    const auto stretch = static_cast<std::size_t>(point.stretch);
    levels.of.push_back(stretch);
    sum[stretch] += 1e3 * point.slip;
    points[stretch] += 1.0;
  }
  for (std::size_t k = 0; k < count; ++k) {
    levels.at.push_back(sum[k] / std::max(points[k], 1.0));
    levels.text.push_back(value_text(levels.at.back(), true));
  }
  return levels;
}

/// +1 where a segment's mean counts a point, -1 where it is taken off, 0 elsewhere; segments as
/// discover::contrasts_of has them.
double sign_in(std::string_view segment, int stretch, int stretches) {
  if (stretches < 2) return 1.0;
  const double share = stretch / static_cast<double>(stretches - 1);
  if (segment == "start") return share < 0.3 ? 1.0 : 0.0;
  if (segment == "steady") return share > 0.55 ? 1.0 : 0.0;
  if (segment == "trend") return share > 0.5 ? 1.0 : -1.0;
  return 1.0;
}

}  // namespace

GapTable gap_table(const CouponFindings& findings) {
  GapTable table;
  table.findings = &findings;
  for (std::size_t c = 0; c < findings.training.size(); ++c)
    for (const CouponPoint& point : findings.training[c].points) {
      table.cell.push_back(c);
      table.point.push_back(point);
    }
  table.baseline = findings.forward.predict(findings.result.baseline.trial);
  table.gap = -table.baseline;
  for (std::size_t i = 0; i < table.point.size(); ++i)
    table.gap[static_cast<Eigen::Index>(i)] += table.point[i].log_force;
  return table;
}

Eigen::VectorXd added_by(const GapTable& table, const discover::Scored& scored) {
  return table.findings->forward.predict(scored.numbers.trial) - table.baseline;
}

std::string Levels::words(std::size_t level) const {
  return fmt::format("{} {}{}{}", name, text[level], unit == "°" ? "" : " ", unit);
}

std::string Levels::capital() const {
  std::string word = name;
  word[0] = static_cast<char>(std::toupper(static_cast<unsigned char>(word[0])));
  return word;
}

std::string Levels::title() const {
  return fmt::format("{} ({})", capital(), unit);
}

std::vector<Levels> all_levels(const GapTable& table, std::size_t most) {
  std::vector<Levels> all;
  for (const ShownFactor& factor : shown_factors()) {
    std::vector<double> values;
    for (const std::size_t cell : table.cell) values.push_back(factor.of(table.findings->training[cell]));
    if (auto levels = levels_of(values, factor, most)) all.push_back(std::move(*levels));
  }
  if (table.findings->campaign.stretches > 1) all.push_back(levels_of_slip(table));
  return all;
}

std::vector<std::string> constant_factors(const CouponFindings& findings) {
  std::vector<std::string> constant;
  for (const ShownFactor& factor : shown_factors()) {
    std::vector<double> values;
    for (const CouponCell& cell : findings.training) values.push_back(factor.of(cell));
    if (level_starts(values, factor.logarithmic, values.size()).size() > 1) continue;
    const Levels one{factor.name,
                     factor.unit,
                     factor.logarithmic,
                     {values.front()},
                     {value_text(values.front(), factor.logarithmic)},
                     {}};
    constant.push_back(one.words(0));
  }
  return constant;
}

Eigen::VectorXd weights_of(const GapTable& table, std::string_view segment,
                           const std::function<bool(std::size_t)>& take) {
  Eigen::VectorXd weights = Eigen::VectorXd::Zero(std::ssize(table.point));
  double added = 0.0, taken_off = 0.0;
  for (std::size_t i = 0; i < table.point.size(); ++i) {
    if (!take(i)) continue;
    const double sign = sign_in(segment, table.point[i].stretch, table.findings->campaign.stretches);
    weights[static_cast<Eigen::Index>(i)] = sign;
    (sign > 0.0 ? added : taken_off) += std::abs(sign);
  }
  const bool both_sides = segment == "trend" && table.findings->campaign.stretches > 1;
  if (added == 0.0 || (both_sides && taken_off == 0.0)) return Eigen::VectorXd::Zero(weights.size());
  for (double& weight : weights) weight /= weight > 0.0 ? added : std::max(taken_off, 1.0);
  return weights;
}

Eigen::MatrixXd noise_of(const GapTable& table, const Eigen::MatrixXd& weights) {
  const CouponFindings& findings = *table.findings;
  Eigen::MatrixXd covariance = Eigen::MatrixXd::Zero(weights.cols(), weights.cols());
  std::map<std::size_t, Eigen::RowVectorXd> of_day;  // points of one day share its shift
  for (std::size_t i = 0; i < table.cell.size();) {
    const CouponCell& cell = findings.training[table.cell[i]];
    const std::size_t begin = i;
    std::vector<Eigen::Index> stretches;
    for (; i < table.cell.size() && table.cell[i] == table.cell[begin]; ++i)
      stretches.push_back(table.point[i].stretch);
    const auto own = weights.middleRows(static_cast<Eigen::Index>(begin), std::ssize(stretches));
    if (own.isZero(0.0)) continue;
    covariance += own.transpose() * findings.noise.sample(stretches, stretches) * own / cell.samples;
    const auto [day, fresh] = of_day.try_emplace(cell.day, Eigen::RowVectorXd::Zero(weights.cols()));
    day->second += own.colwise().sum();
  }
  for (const auto& [day, sum] : of_day)
    covariance += findings.noise.day * findings.noise.day * sum.transpose() * sum;
  return covariance;
}

WeightedMean mean_of(const GapTable& table, const Eigen::VectorXd& values, const Eigen::VectorXd& weights) {
  std::set<std::size_t> cells;
  for (std::size_t i = 0; i < table.cell.size(); ++i)
    if (weights[static_cast<Eigen::Index>(i)] != 0.0) cells.insert(table.cell[i]);
  return {.value = values.dot(weights),
          .noise = std::sqrt(noise_of(table, weights)(0, 0)),
          .cells = static_cast<int>(cells.size())};
}

namespace {

Eigen::VectorXd weights_at(const GapTable& table, const std::vector<Levels>& levels, const Cut& cut,
                           std::size_t level) {
  return weights_of(table, "whole pull", [&](std::size_t i) {
    return levels[cut.along].of[i] == level && (!cut.at || levels[cut.at->first].of[i] == cut.at->second);
  });
}

/// Squared distance of the means along a cut, in standard deviations of their noise, which levels share in
/// part.
double separation_along(const GapTable& table, const std::vector<Levels>& levels, const Cut& cut,
                        const Eigen::VectorXd& difference) {
  Eigen::MatrixXd weights(difference.size(), 0);
  for (std::size_t level = 0; level < levels[cut.along].count(); ++level) {
    const Eigen::VectorXd one = weights_at(table, levels, cut, level);
    if (one.isZero(0.0)) continue;
    weights.conservativeResize(Eigen::NoChange, weights.cols() + 1);
    weights.rightCols(1) = one;
  }
  if (weights.cols() < 2) return 0.0;
  const Eigen::VectorXd means = weights.transpose() * difference;
  return means.dot(noise_of(table, weights).completeOrthogonalDecomposition().solve(means));
}

}  // namespace

std::vector<WeightedMean> means_along(const GapTable& table, const std::vector<Levels>& levels,
                                      const Cut& cut, const Eigen::VectorXd& values) {
  std::vector<WeightedMean> means;
  for (std::size_t level = 0; level < levels[cut.along].count(); ++level)
    means.push_back(mean_of(table, values, weights_at(table, levels, cut, level)));
  return means;
}

std::optional<Cut> cut_between(const GapTable& table, const std::vector<Levels>& levels,
                               const Eigen::VectorXd& one, const Eigen::VectorXd& other) {
  std::optional<Cut> best;
  const Eigen::VectorXd difference = one - other;
  const auto consider = [&](Cut cut) {
    cut.separation = separation_along(table, levels, cut, difference);
    // All conditions are easier to read than some: these must show the difference a fifth better.
    const bool narrows = best && cut.at && !best->at;
    if (cut.separation > (best ? (narrows ? 1.2 : 1.0) * best->separation : 0.0)) best = cut;
  };
  for (std::size_t along = 0; along < levels.size(); ++along) consider({.along = along, .at = {}});
  for (std::size_t along = 0; along < levels.size(); ++along)
    for (std::size_t other_factor = 0; other_factor < levels.size(); ++other_factor)
      for (std::size_t level = 0; other_factor != along && level < levels[other_factor].count(); ++level)
        consider({.along = along, .at = std::pair{other_factor, level}});
  return best;
}

std::string spaced(std::string_view id) {
  std::string text(id);
  std::ranges::replace(text, '_', ' ');
  return text;
}

std::string in_words(const discover::ForwardModel& forward, const discover::Hypothesis& hypothesis,
                     std::string_view between) {
  std::vector<std::string> names;
  for (const std::size_t effect : hypothesis) {
    const discover::Candidate& candidate = forward.candidates[effect];
    names.push_back(candidate.detail.empty()
                        ? spaced(candidate.id)
                        : fmt::format("{} ({})", spaced(candidate.id), candidate.detail));
  }
  return names.empty() ? "nothing missing" : fmt::format("{}", fmt::join(names, between));
}

std::string plain_number(double value, int digits) {
  std::string text = significant(value, digits);
  if (text.find('.') == std::string::npos || text.find('e') != std::string::npos) return text;
  text.erase(text.find_last_not_of('0') + 1);
  if (text.back() == '.') text.pop_back();
  return text;
}

}  // namespace heddle::pipeline
