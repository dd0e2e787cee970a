#include "pipeline/calibration_record.h"

#include <fmt/format.h>

#include <cmath>
#include <nlohmann/json.hpp>

#include "core/units.h"
#include "pipeline/json_text.h"

namespace heddle::pipeline {

namespace {

using Json = nlohmann::ordered_json;
using friction::FittedNumber;

/// Quoted where the separator makes it necessary (RFC 4180).
std::string csv_text(const std::string& text) {
  if (text.find_first_of(",\"\n") == std::string::npos) return text;
  std::string out = "\"";
  for (const char c : text) out += c == '"' ? std::string("\"\"") : std::string(1, c);
  return out + '"';
}

std::string cell(const std::optional<double>& value) {
  return value ? shortest(*value) : "";
}

Json matrix_json(const Eigen::MatrixXd& matrix) {
  Json rows = Json::array();
  for (Eigen::Index i = 0; i < matrix.rows(); ++i) {
    Json row = Json::array();
    for (Eigen::Index j = 0; j < matrix.cols(); ++j) row.push_back(matrix(i, j));
    rows.push_back(std::move(row));
  }
  return rows;
}

Json scatter_json(const friction::Scatter& scatter) {
  Json out{{"source", friction::in_words(scatter.source)}};
  if (scatter.source != friction::Scatter::Source::unknown) out["sd_ln_F"] = scatter.sd;
  if (scatter.estimated()) out["degrees_of_freedom"] = scatter.degrees_of_freedom;
  return out;
}

Json number_json(const CalibrationFindings& findings, std::size_t k) {
  const FittedNumber& number = findings.fit.numbers[k];
  Json out{{"key", number.key}, {"unit", si_unit(number.unit)}, {"value", number.value}};
  if (number.sd) out["sd"] = *number.sd;
  if (number.interval) {
    out["interval"] = {(*number.interval)[0], (*number.interval)[1]};
    if (number.degrees_of_freedom > 0.0) out["interval_degrees_of_freedom"] = number.degrees_of_freedom;
  }
  if (number.prior) out["prior"] = {{"mean", number.prior->mean}, {"sd", number.prior->sd}};
  out["told_apart_by_the_data"] = number.told_apart;
  out["at_bound"] = number.at_bound;
  out["slope"] = number.exact_slope ? "exact" : "by differences";
  if (findings.plate_area) {
    out["at_plate_area_band"] = {findings.plate_area->low.numbers[k].value,
                                 findings.plate_area->high.numbers[k].value};
    out["fixed_by_assumed_plate_area"] = static_cast<bool>(findings.plate_area->moves[k]);
  }
  return out;
}

Json confusions_json(const std::vector<friction::Confusion>& confusions) {
  Json out = Json::array();
  for (const friction::Confusion& confusion : confusions)
    out.push_back({{"keys", confusion.keys},
                   {"relative_change", confusion.change},
                   {"total", confusion.total},
                   {"words", confusion.words}});
  return out;
}

std::string loss_name(friction::Loss loss) {
  return loss == friction::Loss::none ? "none" : loss == friction::Loss::huber ? "huber" : "cauchy";
}

}  // namespace

std::string calibration_json(const CalibrationFindings& findings) {
  const friction::CouponFit& fit = findings.fit;
  Json numbers = Json::array(), words = Json::array(), days = Json::object();
  for (std::size_t k = 0; k < fit.numbers.size(); ++k) numbers.push_back(number_json(findings, k));
  for (const Verdict& verdict : calibration_verdicts(findings)) words.push_back(verdict.text);
  for (std::size_t d = 0; d < fit.day_shifts.size(); ++d)
    days[findings.data.days[d].empty() ? "(all)" : findings.data.days[d]] = fit.day_shifts[d];
  const friction::CalibrationBox& box = fit.model.box;
  Json out{{"case", findings.name},
           {"data", findings.data_file},
           {"law", findings.law},
           {"converged", fit.summary.converged},
           {"reason", fit.summary.reason},
           {"iterations", fit.summary.iterations},
           {"samples", findings.data.samples.size()},
           {"conditions", findings.data.conditions},
           {"degrees_of_freedom", fit.degrees_of_freedom},
           {"degrees_of_freedom_from_priors", fit.from_priors},
           {"saturated", fit.saturated()},
           {"rms_error", fit.rms_error},
           {"loss", loss_name(findings.spec.loss)},
           {"confidence", findings.spec.confidence},
           {"numbers", std::move(numbers)},
           {"scatter", {{"sample", scatter_json(fit.noise.sample)}, {"day", scatter_json(fit.noise.day)}}},
           {"day_shift_ln_F", std::move(days)},
           {"covariance_keys", fit.keys},
           {"covariance", matrix_json(fit.covariance)},
           {"correlation", matrix_json(fit.correlation)},
           {"confusions", confusions_json(fit.confusions)},
           {"box",
            {{"hersey", {box.hersey_low, box.hersey_high}},
             {"pressure_Pa", {box.pressure_low, box.pressure_high}},
             {"speed_m_s", {box.speed_low, box.speed_high}}}},
           {"words", std::move(words)},
           {"notes", findings.notes}};
  return json_text(out);
}

std::string calibration_numbers_csv(const CalibrationFindings& findings) {
  std::string out =
      "key,unit,value,sd,interval_low,interval_high,prior_mean,prior_sd,told_apart,at_bound,"
      "at_smallest_plate_area,at_largest_plate_area,fixed_by_assumed_plate_area\n";
  for (std::size_t k = 0; k < findings.fit.numbers.size(); ++k) {
    const FittedNumber& number = findings.fit.numbers[k];
    const auto end = [&](std::size_t i) {
      return number.interval ? std::optional((*number.interval)[i]) : std::nullopt;
    };
    const auto& area = findings.plate_area;
    out += fmt::format(
        "{},{},{},{},{},{},{},{},{},{},{},{},{}\n", number.key, si_unit(number.unit), shortest(number.value),
        cell(number.sd), cell(end(0)), cell(end(1)), number.prior ? shortest(number.prior->mean) : "",
        number.prior ? shortest(number.prior->sd) : "", number.told_apart ? 1 : 0, number.at_bound ? 1 : 0,
        area ? shortest(area->low.numbers[k].value) : "", area ? shortest(area->high.numbers[k].value) : "",
        area ? (area->moves[k] ? "1" : "0") : "");
  }
  return out;
}

std::string calibration_residuals_csv(const CalibrationFindings& findings) {
  std::string out =
      "case,sample,day,velocity_mm_s,normal_force_N,tool_temperature_C,fabric_temperature_C,orientation_deg,"
      "hersey_number,friction_coefficient,pull_force_N,force_measured_N,ln_error,standardised_error,weight\n";
  for (std::size_t i = 0; i < findings.data.rows.size(); ++i) {
    const friction::CouponRow& row = findings.data.rows[i];
    const friction::CouponResidual& at = findings.fit.rows[i];
    out += csv_text(row.pull.name) + ',' + csv_text(findings.data.samples[row.sample]) + ',' +
           csv_text(findings.data.days[row.day]);
    for (const double value :
         {1e3 * row.pull.velocity, row.pull.normal_force, row.pull.tool_temperature - zero_celsius,
          row.pull.fabric_temperature - zero_celsius, degrees * row.pull.orientation, at.hersey, at.mu,
          at.pull_force, *row.pull.measured_force, at.log_error, at.standardised, at.weight})
      out += ',' + shortest(value);
    out += '\n';
  }
  return out;
}

}  // namespace heddle::pipeline
