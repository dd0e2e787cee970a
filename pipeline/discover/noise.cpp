#include "pipeline/discover/noise.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>

namespace heddle::discover {

namespace {

using Source = friction::Scatter::Source;

/// Gain shared by all stretches of a piece, and the reading of each.
Eigen::MatrixXd gain_and_reading(Eigen::Index stretches, double gain, double reading) {
  Eigen::MatrixXd matrix = Eigen::MatrixXd::Constant(stretches, stretches, gain * gain);
  if (stretches > 1) matrix.diagonal().array() += reading * reading;
  return matrix;
}

/// The two moments of a pooled covariance: mean of its entries off the diagonal, and what its diagonal has
/// more.
Eigen::MatrixXd structured(const Eigen::MatrixXd& pooled) {
  const Eigen::Index size = pooled.rows();
  const double trace = pooled.trace() / static_cast<double>(size);
  if (size == 1) return pooled;
  const double off = std::max((pooled.sum() - pooled.trace()) / static_cast<double>(size * (size - 1)), 0.0);
  return gain_and_reading(size, std::sqrt(off), std::sqrt(std::max(trace - off, 1e-6)));
}

void set_sample(CouponNoise& noise, const CouponCampaign& campaign, const NoiseWish& wish) {
  const auto q = static_cast<Eigen::Index>(campaign.stretches);
  const int freedom = campaign.degrees_of_freedom;
  if (wish.sample) {
    noise.sample = gain_and_reading(q, *wish.sample, wish.reading);
    noise.sample_source = Source::given;
    return;
  }
  if (freedom < 2) {
    noise.sample = gain_and_reading(q, wish.sample_assumed, wish.reading);
    noise.sample_source = Source::assumed;
    noise.notes.push_back(fmt::format(
        "No condition was pulled twice on one day: a scatter of {:g} % from sample to sample is ASSUMED, so "
        "no "
        "effect is given as the one name. Repeat at least one condition, or give discover.noise.sample.",
        100.0 * wish.sample_assumed));
    return;
  }
  noise.sample_source = Source::replicates;
  noise.sample_freedom = freedom;
  // A full covariance of q stretches takes some q samples before it is better than its two moments.
  const bool full = freedom >= 4 * static_cast<int>(q) && q > 1;
  noise.sample = full ? campaign.pooled : structured(campaign.pooled);
  const double parameters = full ? static_cast<double>(q) : std::min<double>(static_cast<double>(q), 2.0);
  if (freedom > parameters + 2.0) noise.sample *= freedom / (freedom - parameters - 1.0);
  noise.sample.diagonal().array() += 1e-8;  // a replicate that is a copy has no scatter at all
}

void set_day(CouponNoise& noise, const friction::CouponData& data, const NoiseWish& wish, int faces) {
  if (wish.day) {
    noise.day = *wish.day;
    noise.day_source = Source::given;
    return;
  }
  noise.day = wish.day_assumed;
  noise.day_source = Source::assumed;
  if (const auto anchors = friction::scatter_of_days(data, faces, noise.sample_sd())) {
    // As if three more days had scattered as is assumed: few anchors alone may show none by chance.
    constexpr double prior_days = 3.0;
    const auto freedom = static_cast<double>(anchors->degrees_of_freedom);
    noise.day =
        std::sqrt((freedom * anchors->sd * anchors->sd + prior_days * wish.day_assumed * wish.day_assumed) /
                  (freedom + prior_days));
    noise.day_source = Source::anchors;
    noise.day_freedom = anchors->degrees_of_freedom;
    return;
  }
  noise.notes.push_back(fmt::format(
      "No condition was repeated on three days or more: a scatter of {:g} % from day to day is ASSUMED. "
      "Replicates of one day do not see it.",
      100.0 * wish.day_assumed));
}

}  // namespace

double CouponNoise::sample_sd() const {
  return std::sqrt(std::max(sample.mean(), 0.0));
}

CouponNoise noise_of(const CouponCampaign& campaign, const friction::CouponData& data, const NoiseWish& wish,
                     int faces) {
  CouponNoise noise;
  noise.form = wish.form;
  noise.form_length = wish.form_length;
  noise.history = wish.history;
  set_sample(noise, campaign, wish);
  set_day(noise, data, wish, faces);
  return noise;
}

Eigen::MatrixXd covariance_of(const CouponNoise& noise, const std::vector<CouponCell>& cells,
                              const std::vector<double>& hersey) {
  std::vector<Eigen::Index> first;
  Eigen::Index size = 0;
  for (const CouponCell& cell : cells) {
    first.push_back(size);
    size += std::ssize(cell.points);
  }
  Eigen::MatrixXd covariance = Eigen::MatrixXd::Zero(size, size);
  for (std::size_t a = 0; a < cells.size(); ++a)
    for (std::size_t b = 0; b <= a; ++b) {
      double shared = cells[a].day == cells[b].day ? noise.day * noise.day : 0.0;
      if (!hersey.empty() && noise.form > 0.0) {
        const double distance = std::log(hersey[a] / hersey[b]) / noise.form_length;
        shared += noise.form * noise.form * std::exp(-0.5 * distance * distance);
      }
      for (Eigen::Index i = 0; i < std::ssize(cells[a].points); ++i)
        for (Eigen::Index j = 0; j < std::ssize(cells[b].points); ++j) {
          const CouponPoint &at = cells[a].points[static_cast<std::size_t>(i)],
                            &other = cells[b].points[static_cast<std::size_t>(j)];
          double value = shared;
          if (at.slip > 0.0 && other.slip > 0.0) {
            const double distance = std::log(at.slip / other.slip);
            value += noise.history * noise.history * std::exp(-0.5 * distance * distance);
          }
          if (a == b) value += noise.sample(at.stretch, other.stretch) / cells[a].samples;
          covariance(first[a] + i, first[b] + j) = value;
          covariance(first[b] + j, first[a] + i) = value;
        }
    }
  return covariance;
}

std::vector<Eigen::Index> rows_of(const std::vector<CouponCell>& all, const std::vector<std::size_t>& cells) {
  std::vector<Eigen::Index> first, rows;
  Eigen::Index size = 0;
  for (const CouponCell& cell : all) {
    first.push_back(size);
    size += std::ssize(cell.points);
  }
  for (const std::size_t cell : cells)
    for (Eigen::Index i = 0; i < std::ssize(all[cell].points); ++i) rows.push_back(first[cell] + i);
  return rows;
}

}  // namespace heddle::discover
