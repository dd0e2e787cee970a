#include "pipeline/calibrate_command.h"

#include <fmt/format.h>

#include <algorithm>

#include "core/text_file.h"
#include "core/units.h"
#include "friction/calibration/model_numbers.h"
#include "friction/parameters.h"
#include "pipeline/run_folder.h"
#include "pipeline/stages.h"

namespace heddle::pipeline {

namespace {

const std::string shift_slope = "effects.tool_temperature_shift.slope";

/// What a run would fit.
std::vector<std::string> usual_numbers(const friction::Model& model) {
  std::vector<std::string> keys;
  for (const friction::Parameter& parameter : friction::parameters_of(model)) keys.push_back(parameter.key);
  return keys;
}

friction::CouponData read_data(const std::filesystem::path& file, const CalibrateSpec& wish) {
  return friction::read_coupons(file.lexically_normal().string(), wish.reduction);
}

std::string held_numbers(const friction::CouponFit& fit) {
  std::vector<std::string> held;
  for (const friction::ModelNumber& number : friction::numbers_of(fit.model))
    if (std::ranges::count(fit.keys, number.key) == 0)
      held.push_back(fmt::format("{} = {}", number.key, write_quantity(number.value, number.unit)));
  return held.empty() ? "Every number of the model that acts was fitted."
                      : fmt::format("Held as the case gives them: {}.", fmt::join(held, ", "));
}

/// Whether mu sees the pressure at all; without it no plate area matters.
bool sees_pressure(const friction::Model& model) {
  return !std::holds_alternative<friction::Coulomb>(model.law) ||
         friction::stages_of(model.effects).coefficient;
}

void set_value(Settings& settings, const std::string& path, std::array<double, 2> values) {
  Setting setting;
  if (const Setting* known = settings.find(path)) setting = *known;
  setting.key = find_key(path);
  setting.values = values;
  setting.text.clear();
  settings.add(std::move(setting));
}

void print(const CalibrationFindings& findings, const std::filesystem::path& folder) {
  fmt::print("{:<44}{:>16}{:>12}   {:g} % interval\n", "number", "value", "sd",
             100.0 * findings.spec.confidence);
  for (const friction::FittedNumber& number : findings.fit.numbers) {
    const std::string unit = number.unit == "degC" ? "K" : number.unit;
    fmt::print("{:<44}{:>16}{:>12}   {}\n", number.key, quantity_text(number.value, number.unit, 5),
               number.sd ? quantity_text(*number.sd, unit, 2) : "-",
               number.interval ? fmt::format("{} to {}", quantity_text((*number.interval)[0], number.unit, 4),
                                             quantity_text((*number.interval)[1], number.unit, 4))
                               : "-");
  }
  for (const Verdict& verdict : calibration_verdicts(findings)) fmt::print("{}\n", verdict.text);
  for (const std::string& note : findings.data.notes) fmt::print("{}\n", note);
  fmt::print("results {}, the case with these numbers {}\n", folder.string(),
             (folder / "patched.yaml").string());
}

Case read_friction_part(const RunOptions& options) {
  Case a_case = read_case(options.file, options.assignments);
  a_case.stamping.reset();
  a_case.orientation_study.reset();
  a_case.grid_error = false;
  if (a_case.friction) return a_case;
  throw InputError({{"calibrate.friction"_rule, "friction", "", "is missing, and a calibration needs it",
                     "Add `friction:`; configs/calibrate.yaml shows one.", options.file.string()}});
}

/// Problems of the wish lie in the configuration, those of the table in the table.
void demand_sound(const friction::Model& start, const CalibrationFindings& findings,
                  const Settings& settings) {
  Problems problems = friction::check_fit(start, findings.data, findings.spec);
  for (Problem& problem : problems) {
    const Setting* place = settings.find(problem.key);
    if (!problem.file.empty() || place == nullptr) continue;
    problem.file = place->file;
    problem.line = place->line;
  }
  if (!problems.empty()) throw InputError(std::move(problems));
}

}  // namespace

CalibrationFindings calibrate(const Case& a_case, const std::filesystem::path& data) {
  const FrictionSpec& spec = *a_case.friction;
  const CalibrateSpec wish = a_case.calibrate.value_or(CalibrateSpec{});
  const friction::AreaFunction area = area_of_pulled_fabric(a_case);
  const friction::Model start = model_of_run(spec, area);
  CalibrationFindings findings;
  findings.name = a_case.name;
  findings.data_file = data.filename().string();
  findings.law = friction::id_of(start.law);
  findings.data = read_data(data, wish);
  findings.spec = fit_spec_of(wish, wish.numbers.empty() ? usual_numbers(start) : wish.numbers);
  findings.rig = spec.rig;
  findings.plate_area_given = spec.has_plate_area || !sees_pressure(start);
  if (!spec.has_plate_area) findings.rig.plate_area_band = friction::FrictionRig{}.plate_area_band;
  demand_sound(start, findings, a_case.settings);
  findings.fit = friction::fit_coupons(start, findings.data, findings.rig, area, findings.spec);
  const auto [low, high] = findings.rig.plate_area_band;
  if (low < high && sees_pressure(start))
    findings.plate_area =
        friction::plate_area_effect(start, findings.data, findings.rig, area, findings.spec, findings.fit);
  findings.notes = findings.data.notes;
  findings.notes.push_back(held_numbers(findings.fit));
  findings.notes.insert(findings.notes.end(), a_case.notes.begin(), a_case.notes.end());
  return findings;
}

Settings patched_settings(const Case& a_case, const CalibrationFindings& findings) {
  Settings settings = a_case.settings;
  settings.remove("friction.calibration.data");
  const std::vector<std::string>& fitted = findings.fit.keys;
  for (const friction::ModelNumber& number : friction::numbers_of(findings.fit.model)) {
    // A run that fits takes the law's constants from its table: here they are numbers of the case.
    const bool of_law = number.key.starts_with("friction.") || number.key == shift_slope;
    if (of_law || std::ranges::count(fitted, number.key) > 0)
      set_value(settings, number.key, {number.value, 0.0});
  }
  const friction::CalibrationBox& box = findings.fit.model.box;
  if (friction::reads_hersey_number(findings.fit.model.law))
    set_value(settings, "friction.box.hersey", {box.hersey_low, box.hersey_high});
  set_value(settings, "friction.box.pressure", {box.pressure_low, box.pressure_high});
  set_value(settings, "friction.box.speed", {box.speed_low, box.speed_high});
  return settings;
}

int calibrate_case(const CalibrateOptions& options) {
  const Case a_case = read_friction_part(options.run);
  const CalibrationFindings findings = calibrate(a_case, options.data);
  RunFolder folder(a_case,
                   options.run.output.empty() ? std::filesystem::path("out/calibration") / a_case.name
                                              : options.run.output,
                   options.run.force);
  folder.write("inputs/coupons.csv", read_text_file(options.data));
  folder.write("patched.yaml", resolved_yaml(patched_settings(a_case, findings)));
  folder.write("calibration.json", calibration_json(findings));
  folder.write("calibration/numbers.csv", calibration_numbers_csv(findings));
  folder.write("calibration/residuals.csv", calibration_residuals_csv(findings));
  folder.write("report.html", calibration_html(findings));
  for (const Verdict& verdict : calibration_verdicts(findings)) folder.log(verdict.text);
  folder.close(a_case, {});
  if (options.run.print) print(findings, folder.path());
  return findings.fit.summary.converged ? exit_done : exit_failed;
}

}  // namespace heddle::pipeline
