#include "pipeline/discover/coupon_campaign.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <map>
#include <numbers>
#include <utility>

namespace heddle::discover {

namespace {

using friction::CouponRow;

/// Rows of one piece of fabric.
struct SampleRows {
  std::vector<const CouponRow*> rows;
  double mean = 0.0;  ///< of ln F/N
};
using Cells = std::map<std::pair<std::size_t, std::size_t>, std::vector<SampleRows>>;

double log_ratio(const CouponRow& row) {
  return std::log(*row.pull.measured_force / row.pull.normal_force);
}

Cells cells_of(const friction::CouponData& data, std::vector<std::pair<std::size_t, std::size_t>>& order) {
  Cells cells;
  std::map<std::size_t, std::pair<std::pair<std::size_t, std::size_t>, std::size_t>> place;
  for (const CouponRow& row : data.rows) {
    const std::pair key{row.condition, row.day};
    auto& samples = cells[key];
    if (samples.empty()) order.push_back(key);
    const auto [at, fresh] = place.try_emplace(row.sample, key, samples.size());
    if (fresh) samples.emplace_back();
    cells[at->second.first][at->second.second].rows.push_back(&row);
  }
  for (auto& [key, samples] : cells)
    for (SampleRows& sample : samples) {
      for (const CouponRow* row : sample.rows) sample.mean += log_ratio(*row);
      sample.mean /= static_cast<double>(sample.rows.size());
    }
  return cells;
}

double median(std::vector<double> values) {
  if (values.empty()) return 0.0;
  std::ranges::sort(values);
  const std::size_t half = values.size() / 2;
  return values.size() % 2 == 1 ? values[half] : 0.5 * (values[half - 1] + values[half]);
}

/// Takes samples out that lie far from their cell's median.
void leave_out_outliers(Cells& cells, const friction::CouponData& data, double limit,
                        CouponCampaign& campaign) {
  std::vector<double> deviations;
  const auto centre = [](const std::vector<SampleRows>& samples) {
    std::vector<double> means;
    for (const SampleRows& sample : samples) means.push_back(sample.mean);
    return median(means);
  };
  for (const auto& [key, samples] : cells) {
    if (samples.size() < 4) continue;
    const double middle = centre(samples);
    // Deviations from a median of few: sqrt(r/(r-1)) makes up for the degree of freedom it takes.
    const auto r = static_cast<double>(samples.size());
    for (const SampleRows& sample : samples)
      deviations.push_back(std::abs(sample.mean - middle) * std::sqrt(r / (r - 1.0)));
  }
  if (deviations.size() < 8) return;
  const double sd = 1.4826 * median(deviations);
  for (auto& [key, samples] : cells) {
    if (samples.size() < 4 || !(sd > 0.0)) continue;
    const double middle = centre(samples);
    std::erase_if(samples, [&](const SampleRows& sample) {
      if (std::abs(sample.mean - middle) <= limit * sd) return false;
      campaign.outliers.push_back(
          fmt::format("{} of {}", data.samples[sample.rows.front()->sample], sample.rows.front()->pull.name));
      return true;
    });
  }
}

CouponCell cell_of(const std::vector<SampleRows>& samples, std::pair<std::size_t, std::size_t> key) {
  const CouponRow& first = *samples.front().rows.front();
  CouponCell cell{.pull = first.pull,
                  .dwell = first.dwell,
                  .condition = key.first,
                  .day = key.second,
                  .samples = static_cast<int>(samples.size()),
                  .load_measured = true,
                  .points = {}};
  std::map<int, std::vector<const CouponRow*>> by_stretch;
  double load = 0.0;
  int rows = 0;
  for (const SampleRows& sample : samples)
    for (const CouponRow* row : sample.rows) {
      by_stretch[row->stretch].push_back(row);
      cell.load_measured = cell.load_measured && row->load_measured;
      load += row->pull.normal_force;
      ++rows;
    }
  cell.pull.normal_force = load / rows;
  cell.pull.measured_force.reset();
  for (const auto& [stretch, list] : by_stretch) {
    const auto count = static_cast<double>(list.size());
    CouponPoint point{.stretch = stretch, .steady = !list.front()->slip.has_value()};
    double log_load = 0.0;
    for (const CouponRow* row : list) {
      point.slip += row->slip.value_or(0.0) / count;
      log_load += std::log(row->pull.normal_force) / count;
      point.log_force += std::log(*row->pull.measured_force) / count;
    }
    point.normal_force = std::exp(log_load);
    cell.points.push_back(point);
  }
  return cell;
}

/// Squares and products about the cell means, over samples that have every stretch.
void pool(const Cells& cells, CouponCampaign& campaign) {
  const auto size = static_cast<Eigen::Index>(campaign.stretches);
  campaign.pooled = Eigen::MatrixXd::Zero(size, size);
  for (const auto& [key, samples] : cells) {
    std::vector<Eigen::VectorXd> complete;
    for (const SampleRows& sample : samples) {
      if (std::ssize(sample.rows) != size) continue;
      Eigen::VectorXd values(size);
      for (const CouponRow* row : sample.rows) values[row->stretch] = log_ratio(*row);
      complete.push_back(std::move(values));
    }
    if (complete.size() < 2) continue;
    Eigen::VectorXd mean = Eigen::VectorXd::Zero(size);
    for (const Eigen::VectorXd& values : complete) mean += values / static_cast<double>(complete.size());
    for (const Eigen::VectorXd& values : complete)
      campaign.pooled += (values - mean) * (values - mean).transpose();
    campaign.degrees_of_freedom += static_cast<int>(complete.size()) - 1;
  }
  if (campaign.degrees_of_freedom > 0) campaign.pooled /= campaign.degrees_of_freedom;
}

}  // namespace

CouponCampaign campaign_of(const friction::CouponData& data, int stretches, double outlier) {
  CouponCampaign campaign{.cells = {},
                          .days = data.days,
                          .condition_names = {},
                          .stretches = stretches,
                          .pooled = {},
                          .notes = data.notes,
                          .outliers = {}};
  std::vector<std::pair<std::size_t, std::size_t>> order;
  Cells cells = cells_of(data, order);
  leave_out_outliers(cells, data, outlier, campaign);
  pool(cells, campaign);
  for (const auto& key : order) campaign.cells.push_back(cell_of(cells.at(key), key));
  campaign.condition_names.resize(data.conditions);
  for (const CouponCell& cell : campaign.cells) {
    std::string& name = campaign.condition_names[cell.condition];
    if (name.empty()) name = cell.pull.name.substr(0, cell.pull.name.find('/'));
  }
  if (!campaign.outliers.empty())
    campaign.notes.push_back(
        fmt::format("{} {} far from {} replicates and {} left out: {}.", campaign.outliers.size(),
                    campaign.outliers.size() == 1 ? "sample lies" : "samples lie",
                    campaign.outliers.size() == 1 ? "its" : "their",
                    campaign.outliers.size() == 1 ? "was" : "were", fmt::join(campaign.outliers, ", ")));
  return campaign;
}

const std::vector<Factor>& factors() {
  constexpr double kelvin = 273.15, degree = std::numbers::pi / 180.0;
  static const std::vector<Factor> all{
      {"tool_temperature", "degC", [](const CouponCell& cell) { return cell.pull.tool_temperature; },
       [](const CouponCell& cell) { return cell.pull.tool_temperature - kelvin; }},
      {"fabric_temperature", "degC", [](const CouponCell& cell) { return cell.pull.fabric_temperature; },
       [](const CouponCell& cell) { return cell.pull.fabric_temperature - kelvin; }},
      {"normal_force", "N", [](const CouponCell& cell) { return std::log(cell.pull.normal_force); },
       [](const CouponCell& cell) { return cell.pull.normal_force; }},
      {"velocity", "mm/s", [](const CouponCell& cell) { return std::log(cell.pull.velocity); },
       [](const CouponCell& cell) { return 1e3 * cell.pull.velocity; }},
      {"orientation", "deg",
       [](const CouponCell& cell) {
         const double s = std::sin(2.0 * cell.pull.orientation);
         return s * s;
       },
       [](const CouponCell& cell) { return cell.pull.orientation / degree; }},
      {"dwell", "s", [](const CouponCell& cell) { return std::log1p(cell.dwell); },
       [](const CouponCell& cell) { return cell.dwell; }},
      {"day", "", [](const CouponCell& cell) { return static_cast<double>(cell.day); },
       [](const CouponCell& cell) { return static_cast<double>(cell.day + 1); }},
      {"warp_or_weft", "deg", [](const CouponCell& cell) { return std::cos(2.0 * cell.pull.orientation); },
       [](const CouponCell& cell) { return cell.pull.orientation / degree; }}};
  return all;
}

}  // namespace heddle::discover
