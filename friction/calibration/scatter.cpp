#include "friction/calibration/scatter.h"

#include <algorithm>
#include <cmath>
#include <map>
#include <stdexcept>
#include <utility>
#include <vector>

namespace heddle::friction {

namespace {

struct Sample {
  std::size_t condition, day;
  double log_mu = 0.0;  ///< mean over its rows
  int rows = 0;
};

std::vector<Sample> samples_of(const CouponData& data, int faces) {
  std::vector<Sample> samples(data.samples.size());
  for (const CouponRow& row : data.rows) {
    Sample& sample = samples[row.sample];
    sample.condition = row.condition;
    sample.day = row.day;
    sample.log_mu += std::log(measured_coefficient(row, faces));
    ++sample.rows;
  }
  for (Sample& sample : samples) sample.log_mu /= sample.rows;
  return samples;
}

/// Samples of one condition on one day.
struct Cell {
  std::vector<double> log_mu;
  double readings = 0.0;  ///< sum over samples of 1 / rows, where there are several

  double mean() const {
    double sum = 0.0;
    for (const double value : log_mu) sum += value;
    return sum / static_cast<double>(log_mu.size());
  }
  double squares() const {
    double sum = 0.0;
    for (const double value : log_mu) sum += (value - mean()) * (value - mean());
    return sum;
  }
};
using Cells = std::map<std::pair<std::size_t, std::size_t>, Cell>;  // by condition and day

Cells cells_of(const CouponData& data, int faces) {
  Cells cells;
  for (const Sample& sample : samples_of(data, faces)) {
    Cell& cell = cells[{sample.condition, sample.day}];
    cell.log_mu.push_back(sample.log_mu);
    if (sample.rows > 1) cell.readings += 1.0 / sample.rows;
  }
  return cells;
}

}  // namespace

const char* in_words(Scatter::Source source) {
  switch (source) {
    case Scatter::Source::given:
      return "given";
    case Scatter::Source::replicates:
      return "from replicates";
    case Scatter::Source::residuals:
      return "from the residuals of the fit";
    case Scatter::Source::anchors:
      return "from repeated anchors";
    case Scatter::Source::assumed:
      return "assumed";
    case Scatter::Source::unknown:
      return "not known";
  }
  throw std::logic_error("no such source");
}

std::optional<Scatter> scatter_of_samples(const CouponData& data, int faces, double reading) {
  double squares = 0.0, of_readings = 0.0;
  int degrees_of_freedom = 0, samples = 0;
  for (const auto& [place, cell] : cells_of(data, faces)) {
    if (cell.log_mu.size() < 2) continue;
    squares += cell.squares();
    degrees_of_freedom += static_cast<int>(cell.log_mu.size()) - 1;
    samples += static_cast<int>(cell.log_mu.size());
    of_readings += cell.readings;
  }
  if (degrees_of_freedom == 0) return {};
  const double variance = squares / degrees_of_freedom - reading * reading * of_readings / samples;
  return Scatter{std::sqrt(std::max(variance, 0.0)), Scatter::Source::replicates, degrees_of_freedom};
}

std::optional<Scatter> scatter_of_days(const CouponData& data, int faces, double sample_sd) {
  std::map<std::size_t, std::vector<Cell>> by_condition;
  for (const auto& [place, cell] : cells_of(data, faces)) by_condition[place.first].push_back(cell);
  if (by_condition.empty()) return {};
  const auto anchor =
      std::max_element(by_condition.begin(), by_condition.end(),
                       [](const auto& a, const auto& b) { return a.second.size() < b.second.size(); });
  const std::vector<Cell>& days = anchor->second;
  if (days.size() < 3) return {};
  const auto count = static_cast<double>(days.size());
  double mean = 0.0, squares = 0.0, of_samples = 0.0;
  for (const Cell& day : days) mean += day.mean() / count;
  for (const Cell& day : days) {
    squares += (day.mean() - mean) * (day.mean() - mean);
    of_samples += sample_sd * sample_sd / static_cast<double>(day.log_mu.size()) / count;
  }
  return Scatter{std::sqrt(std::max(squares / (count - 1.0) - of_samples, 0.0)), Scatter::Source::anchors,
                 static_cast<int>(days.size()) - 1};
}

}  // namespace heddle::friction
