#include "pipeline/discover/locate.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <functional>
#include <map>
#include <set>

#include "core/units.h"
#include "pipeline/discover/random.h"

namespace heddle::discover {

namespace {

/// How much of a contrast each stretch of the pull carries.
struct Segment {
  const char* name;
  double (*weight)(double share);  ///< of the way through the stretches, 0 first, 1 last
};
constexpr Segment segments[] = {{"whole pull", [](double) { return 1.0; }},
                                {"start", [](double share) { return share < 0.3 ? 1.0 : 0.0; }},
                                {"steady", [](double share) { return share > 0.55 ? 1.0 : 0.0; }},
                                {"trend", [](double share) { return share - 0.5; }}};

/// A number a cell, with the name a reader gives it.
struct CellContrast {
  std::string name;
  std::vector<double> values;
};

std::vector<double> centred(std::vector<double> values) {
  double mean = 0.0, square = 0.0;
  for (const double value : values) mean += value / static_cast<double>(values.size());
  for (double& value : values) {
    value -= mean;
    square += value * value;
  }
  if (square > 0.0)
    for (double& value : values) value /= std::sqrt(square);
  return values;
}

std::string level_text(const Factor& factor, const CouponCell& cell) {
  const std::string name = factor.name;
  if (name == "day") return fmt::format("{} {}", name, factor.shown(cell));
  const double value = factor.shown(cell);
  return fmt::format("{} = {:.4g} {}", name, name == "normal_force" ? std::round(value) : value, factor.unit);
}

/// Measured loads of one nominal level differ in their last digits: levels are told apart to 3 %.
bool same_level(const Factor& factor, double a, double b) {
  const std::string name = factor.name;
  return std::abs(a - b) < (name == "normal_force" || name == "velocity" ? 0.03 : 1e-6);
}

std::vector<CellContrast> cell_contrasts(const std::vector<CouponCell>& cells) {
  std::vector<CellContrast> contrasts;
  std::vector<std::pair<std::string, std::vector<double>>> varied;
  for (const Factor& factor : factors()) {
    std::vector<double> values, levels;
    for (const CouponCell& cell : cells) {
      values.push_back(factor.of(cell));
      const auto known = [&](double level) { return same_level(factor, level, values.back()); };
      if (std::ranges::none_of(levels, known)) levels.push_back(values.back());
    }
    if (levels.size() < 2) continue;
    const bool is_day = std::string(factor.name) == "day";
    contrasts.push_back({factor.name, centred(values)});
    if (is_day) continue;
    varied.emplace_back(factor.name, centred(values));
    if (levels.size() < 3) continue;
    for (const double level : levels) {
      std::vector<double> indicator;
      std::string name;
      for (std::size_t c = 0; c < cells.size(); ++c) {
        indicator.push_back(same_level(factor, level, values[c]) ? 1.0 : 0.0);
        if (name.empty() && indicator.back() == 1.0) name = level_text(factor, cells[c]);
      }
      contrasts.push_back({name, centred(indicator)});
    }
  }
  for (std::size_t a = 0; a < varied.size(); ++a)
    for (std::size_t b = a + 1; b < varied.size(); ++b) {
      std::vector<double> product;
      for (std::size_t c = 0; c < cells.size(); ++c)
        product.push_back(varied[a].second[c] * varied[b].second[c]);
      contrasts.push_back({fmt::format("{} x {}", varied[a].first, varied[b].first), centred(product)});
    }
  contrasts.push_back({"all conditions", std::vector<double>(cells.size(), 1.0)});
  return contrasts;
}

}  // namespace

std::vector<Contrast> contrasts_of(const std::vector<CouponCell>& cells, const Whitened& data,
                                   const BesideBaseline& beside) {
  int last = 0;
  for (const CouponCell& cell : cells)
    for (const CouponPoint& point : cell.points) last = std::max(last, point.stretch);
  std::vector<Contrast> contrasts;
  for (const CellContrast& cell_contrast : cell_contrasts(cells))
    for (const Segment& segment : segments) {
      if (last == 0 && &segment != segments) continue;
      // Over all conditions alike the baseline has its level: only what runs along the pull can be seen.
      Eigen::VectorXd direction(data.size());
      Eigen::Index at = 0;
      for (std::size_t c = 0; c < cells.size(); ++c)
        for (const CouponPoint& point : cells[c].points) {
          const double share = last == 0 ? 1.0 : point.stretch / static_cast<double>(last);
          direction[at++] = cell_contrast.values[c] * segment.weight(share);
        }
      const Eigen::VectorXd whitened = data(direction);
      Eigen::VectorXd remaining = beside(whitened);
      if (!(remaining.norm() > 0.2 * whitened.norm())) continue;
      remaining.normalize();
      contrasts.push_back({cell_contrast.name, segment.name, std::move(remaining)});
    }
  return contrasts;
}

std::vector<double> largest_of_noise(const std::vector<Contrast>& contrasts,
                                     const std::vector<Signature>& signatures, Eigen::Index size, int draws,
                                     std::uint64_t seed) {
  const auto count = std::ssize(contrasts) + std::ssize(signatures);
  Eigen::MatrixXd directions(size, count);
  Eigen::Index at = 0;
  for (const Contrast& contrast : contrasts) directions.col(at++) = contrast.direction;
  for (const Signature& signature : signatures) directions.col(at++) = signature.direction.normalized();
  Random random(seed);
  std::vector<double> largest;
  for (int draw = 0; draw < draws; ++draw)
    largest.push_back((directions.transpose() * random.normals(size)).cwiseAbs().maxCoeff());
  std::ranges::sort(largest);
  return largest;
}

double family_wise_p(const std::vector<double>& largest, double statistic) {
  const auto as_large = largest.end() - std::ranges::lower_bound(largest, std::abs(statistic));
  return (1.0 + static_cast<double>(as_large)) / (1.0 + static_cast<double>(largest.size()));
}

std::vector<Location> locate(const std::vector<Contrast>& contrasts, const Eigen::VectorXd& gap,
                             const std::vector<double>& largest) {
  std::map<std::string, Location> strongest;
  for (const Contrast& contrast : contrasts) {
    // Measured less model: a positive statistic is a force that the model misses.
    const double statistic = -contrast.direction.dot(gap);
    Location& best = strongest[contrast.factor];
    if (std::abs(statistic) <= std::abs(best.statistic)) continue;
    best = {contrast.factor, contrast.segment, statistic, family_wise_p(largest, statistic)};
  }
  std::vector<Location> locations;
  for (auto& [factor, location] : strongest) locations.push_back(std::move(location));
  std::ranges::stable_sort(locations, std::greater{},
                           [](const Location& l) { return std::abs(l.statistic); });
  return locations;
}

}  // namespace heddle::discover
