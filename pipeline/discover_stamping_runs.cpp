#include "pipeline/discover_stamping_runs.h"

#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <limits>
#include <optional>

#include "core/units.h"
#include "friction/calibration/model_numbers.h"
#include "friction/parameters.h"
#include "macroscale/punch_profile.h"
#include "mesoscale/cell.h"
#include "pipeline/discover/coupon_forward.h"
#include "pipeline/discover/discovery.h"
#include "pipeline/interrupt.h"
#include "pipeline/stage_keys.h"
#include "pipeline/stages.h"
#include "pipeline/stamping_record.h"

namespace heddle::pipeline {

namespace {

using discover::Candidate;
using discover::EffectFile;
using discover::Prior;
using discover::StampingCondition;
using discover::Trial;
using discover::Unknown;

constexpr const char* discretisation = "discretisation";

std::string set_text(const std::string& key, double value) {
  const Key* known = find_key(key);
  return fmt::format("{}={}", key, write_quantity(value, known != nullptr ? known->unit : ""));
}

/// The constants of the law as discovery in coupons moves them, and the level of the shear without rate.
std::vector<Unknown> baseline_of(const Case& a_case, const DiscoverSpec& spec, Problems& problems) {
  const std::vector<friction::ModelNumber> numbers = friction::numbers_of(a_case.friction->model);
  std::vector<std::string> keys = spec.numbers;
  if (keys.empty())
    for (const friction::Parameter& parameter : friction::parameters_of(a_case.friction->model))
      keys.push_back(parameter.key);
  std::vector<Unknown> baseline;
  for (const std::string& key : keys) {
    const auto number = std::ranges::find(numbers, key, &friction::ModelNumber::key);
    if (number == numbers.end()) {
      problems.push_back({"discover.stampings.parameters"_rule, "discover.parameters", key,
                          "is no number of this case's friction",
                          "Name numbers of the law that the case has."});
      continue;
    }
    Prior prior = discover::usual_prior(*number);
    if (const auto given = spec.priors.find(key); given != spec.priors.end()) {
      prior.kind = Prior::Kind::normal;
      prior.centre = given->second[0];
      prior.scale = given->second[1];
    }
    baseline.push_back({.key = key, .unit = number->unit, .prior = prior});
  }
  // A prior of the mesoscale (docs/theory/mesoscale.md), so a factor of 1.5 is one standard deviation.
  const double tow_friction = a_case.settings.number("forming.tow_friction");
  if (tow_friction > 0.0 && tow_friction < 1.0)  // far enough from the ends of its range to be moved
    baseline.push_back({.key = "forming.tow_friction",
                        .unit = "",
                        .prior = {.kind = Prior::Kind::log_normal,
                                  .centre = tow_friction,
                                  .scale = 1.5,
                                  .low = 0.0,
                                  .high = 1.5}});
  return baseline;
}

/// One candidate a value of the effect's second number.
std::vector<Candidate> choices_of(const EffectFile& effect) {
  Candidate candidate = effect.candidate();
  for (std::size_t k = 2; k < candidate.numbers.size(); ++k) {
    Prior& prior = candidate.numbers[k].prior;
    prior = {.kind = Prior::Kind::fixed, .centre = prior.value_at(0.0)};
  }
  if (candidate.numbers.size() < 2 || !candidate.numbers[1].prior.is_free()) return {candidate};
  // Gauss and Hermite's three points of a standard normal.
  constexpr std::array points{std::pair{0.0, 2.0 / 3.0}, std::pair{-1.7320508075688772, 1.0 / 6.0},
                              std::pair{1.7320508075688772, 1.0 / 6.0}};
  std::vector<Candidate> choices;
  for (const auto& [z, weight] : points) {
    Candidate choice = candidate;
    Unknown& number = choice.numbers[1];
    number.prior = {.kind = Prior::Kind::fixed, .centre = number.prior.value_at(z)};
    choice.log_weight = std::log(weight);
    choice.detail = fmt::format("{} = {} {}", number.key, number.prior.centre, si_unit(number.unit));
    choices.push_back(std::move(choice));
  }
  return choices;
}

/// The amplitude of an effect of forming in a case; none for the name of another one.
std::optional<double> forming_number(const std::string& id, const macroscale::StampingSpec& stamping) {
  const macroscale::FabricEffects& effects = stamping.effects;
  const std::map<std::string, double> amplitudes{
      {"shear_locking", effects.shear_locking.amplitude},
      {"tension_shear_coupling", effects.tension_coupling.amplitude},
      {"bending", effects.bending},
      {"tow_rate_stiffening", effects.tow_viscosity},
      {"crimp_straightening", effects.crimp_stretch},
      {"shear_thermal_softening", effects.softening.rate},
      {"blank_cooling", stamping.process.cooling_rate},
      {"inertia", effects.inertia},
      {"binder_force_level", stamping.process.press.binder_force_error}};
  const auto found = amplitudes.find(id);
  return found == amplitudes.end() ? std::nullopt : std::optional(found->second);
}

/// Why an effect beside friction cannot be tried in this case; "" where it can.
std::string refusal_of(const EffectFile& effect, const Case& a_case) {
  if (effect.id == "shear_rate")
    return a_case.stamping->shear_rate > 0.0 ? "is in the case already (fabric.shear_rate)" : "";
  if (effect.id == "inertia" && a_case.stamping->artefact.mass_scaling != 1.0)
    return "is in the case already (artefact.mass_scaling)";
  const macroscale::PressSpec& press = a_case.stamping->process.press;
  if (effect.id == "press_compliance")
    return press.compliance > 0.0 ? "is in the case already (effects.press_compliance)" : "";
  if (effect.id == "punch_misalignment" || effect.id == "binder_tilt")
    return "moves the punch force in second order alone: its sign is told by the draw-in of opposite sides";
  if (effect.id == "initial_orientation")
    return "moves the punch force in second order alone: its sign is told by where the edge has gone";
  if (effect.id == "blank_cooling" && a_case.stamping->thermal)
    return "has no place beside `thermal`, which cools the blank by conduction";
  if (effect.id == "tension_shear_coupling" && a_case.shear_friction.on())
    return "has no place beside fabric.shear_hysteresis";
  if (effect.id == "binder_force_level" && a_case.stamping->binder.control == macroscale::BinderControl::gap)
    return "has no place where stops hold the binder";
  if (const auto number = forming_number(effect.id, *a_case.stamping))
    return *number == effect.off.front() ? "" : fmt::format("is in the case already (effects.{})", effect.id);
  if (effect.id == discretisation) return "";
  if (effect.stage == "rig") return "is a fault of the friction rig, which no press has";
  return "has no term in the stamping";
}

/// Of the stroke: rows of a dwell stand at its end and would be taken for one more place.
ForceCurve curve_of(const std::vector<macroscale::HistoryRow>& history, bool completed) {
  ForceCurve curve;
  for (const macroscale::HistoryRow& row : history) {
    if (!curve.stroke.empty() && row.punch_displacement <= curve.stroke.back()) break;
    curve.stroke.push_back(row.punch_displacement);
    curve.force.push_back(row.punch_force);
  }
  curve.completed = completed;
  return curve;
}

/// ln of the means over the bins; NaN where the stamping did not come to its end.
Eigen::VectorXd log_bins(const ForceCurve& curve, const std::vector<double>& edges) {
  Eigen::VectorXd values =
      Eigen::VectorXd::Constant(std::ssize(edges) - 1, std::numeric_limits<double>::quiet_NaN());
  if (!curve.completed) return values;
  const std::vector<double> means = discover::bin_means(curve.stroke, curve.force, edges);
  for (std::size_t k = 0; k < means.size(); ++k)
    values[static_cast<Eigen::Index>(k)] = means[k] > 0.0 ? std::log(means[k]) : values[0];
  return values;
}

std::vector<std::string> joined(std::vector<std::string> keys, const std::vector<std::string>& more) {
  keys.insert(keys.end(), more.begin(), more.end());
  return keys;
}

Eigen::VectorXd log_forces(StampingRuns& runs, const std::vector<StampingCondition>& conditions,
                           const std::vector<std::string>& keys, const std::vector<double>& edges) {
  const Eigen::Index bins = std::ssize(edges) - 1;
  Eigen::VectorXd values(bins * std::ssize(conditions));
  Eigen::Index at = 0;
  for (const StampingCondition& condition : conditions) {
    values.segment(at, bins) = log_bins(runs(joined(keys_of(condition), keys)), edges);
    at += bins;
  }
  return values;
}

}  // namespace

StampingRuns::StampingRuns(std::filesystem::path file, std::vector<std::string> assignments,
                           const Cache& cache, std::function<void(const std::string&)> done)
    : file_(std::move(file)), assignments_(std::move(assignments)), cache_(cache), done_(std::move(done)) {}

Case StampingRuns::case_with(const std::vector<std::string>& keys) const {
  return read_case(file_, joined(assignments_, keys));
}

const ForceCurve& StampingRuns::operator()(const std::vector<std::string>& keys) {
  const std::string name = fmt::format("{}", fmt::join(keys, " "));
  if (const auto known = curves_.find(name); known != curves_.end()) return known->second;
  const ForceCurve& curve = curves_.emplace(name, stamp(keys)).first->second;
  done_(name);
  return curve;
}

const mesoscale::FabricProperties& StampingRuns::fabric_of(const Case& a_case) {
  const std::string key = inputs_of(ChainStage::mesoscale, a_case).key();
  if (const auto known = fabrics_.find(key); known != fabrics_.end()) return known->second;
  return fabrics_.emplace(key, analyse_cell(*a_case.cell, a_case.fabric).fabric).first->second;
}

ForceCurve StampingRuns::stamp(const std::vector<std::string>& keys) {
  Case a_case = case_with(keys);
  StampingRecord record;
  // A key of its own: no pictures are kept, and `heddle run` wants them.
  StageInputs inputs = inputs_of(ChainStage::macroscale, a_case);
  inputs.inputs.push_back({"discover.stamping", "force"});
  record.key = inputs.key();
  record.inputs = inputs.text();
  record.steps = macroscale::all_steps(a_case.stamping->process);
  if (const auto found = cache_.find(record.key, read_stamping_record); found && found->complete())
    return curve_of(found->at.history, true);
  load_tools(a_case);
  macroscale::StampingControl control;
  control.stop = InterruptGuard::interrupted;
  control.keep = [&](const macroscale::StampingCheckpoint& checkpoint, bool last) {
    if (last && checkpoint.step == record.steps) record.at = checkpoint;
  };
  const macroscale::StampingResult result =
      macroscale::run_stamping(*a_case.stamping, fabric_of(a_case), a_case.friction->model, control);
  if (result.summary.stopped) throw StampingsInterrupted();
  if (result.summary.completed) cache_.store(record.key, bytes_of(record));
  return curve_of(result.history, result.summary.completed);
}

StampingLibrary stamping_library(const Case& a_case, const std::vector<EffectFile>& effects) {
  StampingLibrary library;
  Problems problems;
  if (a_case.friction->calibrated())
    problems.push_back({"discover.stampings.calibrated"_rule, "friction.calibration.data", "",
                        "fits the law's constants, which discovery in stampings moves",
                        "Give the constants: calibrate first, then write what it found."});
  else
    library.baseline = baseline_of(a_case, a_case.discover.value_or(DiscoverSpec{}), problems);
  if (!problems.empty()) throw InputError(std::move(problems));
  std::vector<EffectFile> of_friction;
  for (const EffectFile& effect : effects)
    if (effect.stage == "film" || effect.stage == "area" || effect.stage == "coefficient")
      of_friction.push_back(effect);
  const std::vector<EffectFile> usable =
      discover::usable_effects(a_case.friction->model, of_friction, &library.refused);
  for (const EffectFile& effect : effects) {
    const bool friction = std::ranges::count(of_friction, effect.id, &EffectFile::id) > 0;
    if (friction && std::ranges::count(usable, effect.id, &EffectFile::id) == 0) continue;
    if (std::string why = friction ? "" : refusal_of(effect, a_case); !why.empty()) {
      library.refused.emplace_back(effect.id, std::move(why));
      continue;
    }
    const std::vector<Candidate> choices = choices_of(effect);
    library.candidates.insert(library.candidates.end(), choices.begin(), choices.end());
  }
  return library;
}

std::vector<std::string> keys_of(const StampingCondition& condition) {
  return {set_text("process.punch.speed_scale", condition.speed_scale),
          set_text("process.binder_force", condition.binder_force),
          set_text("process.tool_temperature", condition.tool_temperature),
          set_text("process.blank_temperature", condition.blank_temperature),
          set_text("blank.orientation", condition.orientation)};
}

std::vector<std::string> keys_of(const discover::ForwardModel& library, const Trial& trial) {
  std::vector<std::string> keys;
  for (std::size_t k = 0; k < library.baseline.size(); ++k)
    keys.push_back(set_text(library.baseline[k].key, trial.baseline[static_cast<Eigen::Index>(k)]));
  for (const auto& [effect, values] : trial.effects) {
    const Candidate& candidate = library.candidates[effect];
    if (candidate.id == discretisation) continue;
    if (candidate.id == "shear_rate") keys.emplace_back("fabric.shear_rate=on");
    for (std::size_t k = 0; k < candidate.numbers.size(); ++k)
      keys.push_back(set_text(candidate.numbers[k].key, values[static_cast<Eigen::Index>(k)]));
  }
  return keys;
}

Eigen::VectorXd grid_change(StampingRuns& runs, const std::vector<StampingCondition>& conditions,
                            const std::vector<double>& edges) {
  const Case coarse = runs.case_with({});
  const macroscale::StampingSpec& spec = *coarse.stamping;
  const std::vector<std::string> finer{set_text("blank.spacing", spec.blank.spacing / 1.5),
                                       fmt::format("process.steps={}", (3 * spec.process.steps + 1) / 2)};
  return log_forces(runs, conditions, finer, edges) - log_forces(runs, conditions, {}, edges);
}

discover::ForwardModel stamping_forward(StampingRuns& runs, const StampingLibrary& library,
                                        const std::vector<StampingCondition>& conditions,
                                        const std::vector<double>& edges) {
  discover::ForwardModel forward{
      .baseline = library.baseline, .candidates = library.candidates, .predict = {}};
  forward.predict = [&runs, numbers = forward, conditions, edges](const Trial& trial) {
    Eigen::VectorXd values = log_forces(runs, conditions, keys_of(numbers, trial), edges);
    for (const auto& [effect, amplitude] : trial.effects)
      if (numbers.candidates[effect].id == discretisation && amplitude[0] != 0.0)
        values += amplitude[0] * grid_change(runs, conditions, edges);
    return values;
  };
  return forward;
}

}  // namespace heddle::pipeline
