#include "pipeline/discover_stamping.h"

#include <fmt/format.h>

#include <Eigen/Cholesky>
#include <algorithm>
#include <array>
#include <cmath>
#include <iostream>
#include <memory>

#include "core/progress.h"
#include "core/text_file.h"
#include "pipeline/discover/coordinates.h"
#include "pipeline/interrupt.h"
#include "pipeline/run_folder.h"

namespace heddle::pipeline {

namespace {

namespace fs = std::filesystem;
using discover::CouponCell;
using discover::CouponFindings;
using discover::ForwardModel;
using discover::HeldOut;
using discover::MapFit;
using discover::StampingCondition;
using discover::StampingData;
using discover::Surrogate;
using discover::Trial;

/// Beyond this share of its size the affine model is taken anew about the trial.
constexpr double true_enough = 0.2;
constexpr int rounds_max = 2;

/// Error of the grid that is left beside the numbers and the share of one finer grid: as large as the change
/// that grid made, once over a third of the stroke alike and once over little more than a bin, since the
/// punch takes up node after node; priors. A grid knows nothing of speeds, so the error is the same at all
/// conditions.
constexpr std::array grid_lengths{0.3, 0.06};

/// @param change  rms of ln F
/// @param a, b    stroke of observations [m]
Eigen::MatrixXd grid_covariance(double change, const Eigen::VectorXd& a, const Eigen::VectorXd& b,
                                double stroke) {
  Eigen::MatrixXd covariance = Eigen::MatrixXd::Zero(a.size(), b.size());
  for (const double length : grid_lengths)
    for (Eigen::Index i = 0; i < a.size(); ++i)
      for (Eigen::Index j = 0; j < b.size(); ++j)
        covariance(i, j) += change * change * discover::gaussian(a[i] - b[j], length * stroke);
  return covariance;
}

Eigen::VectorXd strokes_of(const std::vector<CouponCell>& cells) {
  return discover::of_points(cells, [](const CouponCell&, const discover::CouponPoint& p) { return p.slip; });
}

std::vector<StampingCondition> conditions_of(const StampingData& data, const std::vector<CouponCell>& cells) {
  std::vector<StampingCondition> conditions;
  for (const CouponCell& cell : cells) conditions.push_back(data.conditions[cell.condition]);
  return conditions;
}

Eigen::VectorXd log_forces_of(const std::vector<CouponCell>& cells) {
  return discover::of_points(cells,
                             [](const CouponCell&, const discover::CouponPoint& p) { return p.log_force; });
}

std::string name_of(const ForwardModel& model, const discover::Hypothesis& hypothesis) {
  std::vector<std::string> ids;
  for (const std::size_t effect : hypothesis) ids.push_back(model.candidates[effect].id);
  return ids.empty() ? "none" : fmt::format("{}", fmt::join(ids, "+"));
}

/// Stamps what a fit found; where the affine model was too far off, takes it anew there and fits again.
MapFit settled(const ForwardModel& dear, const Surrogate& surrogate, MapFit fit,
               std::vector<TrueCheck>& checks) {
  ForwardModel model = surrogate.model;
  for (int round = 0;; ++round) {
    discover::TrueRun run = true_run(dear, surrogate, fit.trial);
    if (!run.finite)
      throw NumericalError(
          fmt::format("discover: the stamping with {} does not come to its end at what was fitted",
                      name_of(model, fit.hypothesis)));
    run.difference = (run.value - model.predict(fit.trial)).norm() / std::sqrt(run.value.size());
    checks.push_back({name_of(model, fit.hypothesis), round, run.size, run.difference});
    if (run.share() <= true_enough || round == rounds_max) return fit;
    model = relinearised(dear, surrogate, fit.trial, run);
    fit = map_fit(model, fit.data, fit.hypothesis, fit.z);
  }
}

/// What the training says of the grid's error on other conditions, given what a fit left over there.
Eigen::VectorXd grid_error_elsewhere(const StampingDiscovery& discovery, const std::vector<CouponCell>& cells,
                                     double stroke, const MapFit& fit) {
  const Eigen::MatrixXd shared = grid_covariance(discovery.grid_error, strokes_of(cells),
                                                 strokes_of(discovery.record.findings.training), stroke);
  const Eigen::MatrixXd covariance = fit.data->covariance();
  return -shared * covariance.ldlt().solve(fit.data->unwhitened(fit.residual)).eval();
}

/// Root mean squares of true model less measured, on conditions that no fit saw.
std::vector<HeldOut> held_out_of(const CouponFindings& found, const Eigen::VectorXd& before,
                                 const Eigen::VectorXd& after) {
  const std::vector<CouponCell> cells = pick(found.campaign.cells, found.split.held_out);
  const Eigen::VectorXd measured = log_forces_of(cells);
  std::vector<HeldOut> held_out;
  Eigen::Index row = 0;
  for (std::size_t c = 0; c < cells.size(); ++c) {
    const auto count = std::ssize(cells[c].points);
    const auto rms = [&](const Eigen::VectorXd& model) {
      return (model - measured).segment(row, count).norm() / std::sqrt(static_cast<double>(count));
    };
    const double noise =
        found.noise.sample.diagonal().mean() / cells[c].samples + found.noise.day * found.noise.day;
    held_out.push_back({.cell = found.split.held_out[c],
                        .before = rms(before),
                        .after = rms(after),
                        .noise = std::sqrt(noise)});
    row += count;
  }
  return held_out;
}

const discover::Scored* best_with_effects(const CouponFindings& found) {
  const auto best = std::ranges::find_if(
      found.result.scored, [](const discover::Scored& one) { return !one.fit.hypothesis.empty(); });
  return best == found.result.scored.end() ? nullptr : &*best;
}

void note_slopes(StampingDiscovery& discovery) {
  for (const discover::SlopeCheck& check : discovery.slopes) {
    if (check.id.empty() && check.disagreement > discover::SurrogateOptions{}.disagreement)
      discovery.record.notes.push_back(fmt::format(
          "The slope of {} differs by {:.0f} % between two step sizes: the affine model is rough in it.",
          check.key, 100.0 * check.disagreement));
    if (check.refused.empty()) continue;
    std::string why =
        check.detail.empty() ? check.refused : fmt::format("{}: {}", check.detail, check.refused);
    if (check.values > 0)
      discovery.record.notes.push_back(fmt::format(
          "{} is tried at the {} values alone that were stamped: {}.", check.id, check.values, why));
    else
      discovery.record.findings.refused.emplace_back(check.id, std::move(why));
  }
}

/// The numbers of the best hypothesis from true runs, and the gap on the conditions held out, before and
/// after.
void add_and_validate(StampingDiscovery& discovery, StampingRuns& runs, const StampingLibrary& library,
                      const StampingData& data, const ForwardModel& dear, const Surrogate& surrogate) {
  CouponFindings& found = discovery.record.findings;
  const MapFit baseline = settled(dear, surrogate, found.result.baseline, discovery.true_checks);
  const bool has_name = !found.decision.named.empty();
  const discover::Scored* best =
      has_name ? found.result.find(found.decision.named) : best_with_effects(found);
  MapFit after = baseline;
  if (best != nullptr) {
    after = settled(dear, surrogate, best->numbers, discovery.true_checks);
    if (has_name) found.result.find(found.decision.named)->numbers = after;
  }
  const bool named = found.decision.answer == discover::Answer::named ||
                     found.decision.answer == discover::Answer::named_incomplete;
  discovery.patch = keys_of(dear, surrogate.for_dear((named ? after : baseline).trial));
  if (found.split.held_out.empty() || !has_name) return;
  const ForwardModel elsewhere = stamping_forward(
      runs, library, conditions_of(data, pick(found.campaign.cells, found.split.held_out)), data.edges);
  const Eigen::VectorXd with = elsewhere.predict(surrogate.for_dear(after.trial));
  const Eigen::VectorXd without = elsewhere.predict(surrogate.for_dear(baseline.trial));
  if (!with.allFinite() || !without.allFinite()) {
    discovery.record.notes.emplace_back(
        "A held-out condition has no stamping that comes to its end: no gap is given.");
    return;
  }
  // Both carry the error of the grid as the training saw it beside each: it is no effect of speed.
  const std::vector<CouponCell> cells = pick(found.campaign.cells, found.split.held_out);
  const double stroke = data.edges.back();
  found.held_out = held_out_of(found, without + grid_error_elsewhere(discovery, cells, stroke, baseline),
                               with + grid_error_elsewhere(discovery, cells, stroke, after));
  found.gap = discover::gap_of(found.held_out, static_cast<std::uint64_t>(discovery.record.seed));
  if (found.gap->conditions < 4)
    discovery.record.notes.push_back(
        fmt::format("{} held-out {}: the interval of the shrink is that of so few and says little.",
                    found.gap->conditions, found.gap->conditions == 1 ? "condition" : "conditions"));
}

Case read_stamping_case(const RunOptions& options) {
  Case a_case = read_case(options.file, options.assignments);
  a_case.orientation_study.reset();
  a_case.grid_error = false;
  if (a_case.stamping && a_case.friction && a_case.cell) return a_case;
  throw InputError(
      {{"discover.stampings.case"_rule, "process", "",
        "is missing, and a table with punch_force_N needs a case that stamps",
        "Add weave, friction, process, blank and tools; configs/discover/stamping.yaml shows one.",
        options.file.string()}});
}

}  // namespace

StampingDiscovery discover_stamping_in(const Case& a_case, StampingRuns& runs, const fs::path& data_file,
                                       const std::vector<fs::path>& own_effects) {
  const DiscoverSpec spec = a_case.discover.value_or(DiscoverSpec{});
  StampingDiscovery discovery;
  DiscoveryRecord& record = discovery.record;
  record.name = a_case.name;
  record.data_file = data_file.filename().string();
  record.seed = spec.seed;
  record.base = a_case.friction->model;
  Problems problems;
  const Sidecar sidecar = read_sidecar(data_file, problems);
  record.rig = sidecar.rig;
  record.provenance = sidecar.provenance;
  record.question.base = record.base;
  record.question.effects = library_of(spec, own_effects, problems);
  const auto collect = [&](const InputError& error) {
    problems.insert(problems.end(), error.problems().begin(), error.problems().end());
  };
  StampingData data;
  StampingLibrary library;
  try {
    data = discover::parse_stampings(
        read_text_file(data_file), data_file.lexically_normal().string(),
        {.bins = spec.stretches,
         .stroke = a_case.stamping->process.stroke,
         .punch_speed = a_case.stamping->process.stroke / a_case.stamping->process.time});
  } catch (const InputError& error) {
    collect(error);
  }
  try {
    library = stamping_library(a_case, record.question.effects);
  } catch (const InputError& error) {
    collect(error);
  }
  if (!problems.empty()) throw InputError(std::move(problems));
  record.question.baseline = library.baseline;
  record.question.noise = spec.noise;
  record.question.search = spec.search;
  record.question.verdict = spec.verdict;
  record.question.held_out = spec.held_out;
  record.question.seed = static_cast<std::uint64_t>(spec.seed);

  CouponFindings& found = record.findings;
  found.campaign = discover::campaign_of(data.curves, spec.stretches);
  found.split = discover::split_stampings(found.campaign, spec.held_out, record.question.seed);
  found.training = pick(found.campaign.cells, found.split.training);
  found.noise = noise_of(found.campaign, data.curves, spec.noise, 1);
  record.notes = found.campaign.notes;
  record.notes.insert(record.notes.end(), found.noise.notes.begin(), found.noise.notes.end());
  found.refused = library.refused;

  const std::vector<StampingCondition> conditions = conditions_of(data, found.training);
  const ForwardModel dear = stamping_forward(runs, library, conditions, data.edges);
  const Surrogate surrogate = discover::affine_surrogate(dear);
  discovery.slopes = surrogate.checks;
  found.forward = surrogate.model;
  const Eigen::VectorXd change = grid_change(runs, conditions, data.edges);
  if (!change.allFinite())
    throw NumericalError("discover: the stamping on the finer grid does not come to its end");
  discovery.grid_error = change.norm() / std::sqrt(change.size());

  const Eigen::VectorXd strokes = strokes_of(found.training);
  discover::Observations observations;
  observations.value = log_forces_of(found.training);
  observations.covariance = covariance_of(found.noise, found.training, {}) +
                            grid_covariance(discovery.grid_error, strokes, strokes, data.edges.back());
  observations.form = spec.noise.effect_form;
  observations.coordinates = discover::form_coordinates(found.training, spec.noise.effect_form_length);
  judge(found, observations, record.question);
  add_and_validate(discovery, runs, library, data, dear, surrogate);
  note_slopes(discovery);
  const auto numbers = std::ssize(free_numbers(found.forward, found.decision.named));
  found.saturated = std::ssize(found.training) < 2 || observations.value.size() <= numbers;
  record.notes.insert(record.notes.end(), a_case.notes.begin(), a_case.notes.end());
  return discovery;
}

std::string slopes_csv(const StampingDiscovery& discovery) {
  std::string text = "effect,number,choice,step,log_force_change,disagreement,used\n";
  for (const discover::SlopeCheck& check : discovery.slopes)
    text += fmt::format("{},{},{},{:.6g},{:.5f},{:.4f},{}\n", check.id.empty() ? "baseline" : check.id,
                        check.key, check.detail, check.step, check.change, check.disagreement,
                        check.refused.empty() ? 1 : 0);
  return text;
}

namespace {

std::string true_runs_csv(const StampingDiscovery& discovery) {
  std::string text = "hypothesis,round,log_force_change,affine_error,share\n";
  for (const TrueCheck& check : discovery.true_checks)
    text += fmt::format("{},{},{:.5f},{:.5f},{:.4f}\n", check.name, check.round, check.size, check.difference,
                        check.size > 0.0 ? check.difference / check.size : 0.0);
  return text;
}

void print_stampings(const StampingDiscovery& discovery, std::size_t stampings) {
  fmt::print("{} stampings; the finer grid changes ln F by {:.2g} % rms.\n", stampings,
             100.0 * discovery.grid_error);
  for (const TrueCheck& check : discovery.true_checks)
    fmt::print("Stamped truly, {} changes ln F by {:.2g} % rms; the {} model is off by {:.0f} % of that.\n",
               check.name, 100.0 * check.size, check.round == 0 ? "affine" : "relinearised",
               check.size > 0.0 ? 100.0 * check.difference / check.size : 0.0);
  for (const auto& [id, why] : discovery.record.findings.refused)
    fmt::print("Not searched for: {} {}.\n", id, why);
}

}  // namespace

int discover_stamping(const DiscoverOptions& options) {
  Case a_case = read_stamping_case(options.run);
  if (!a_case.discover) a_case.discover.emplace();
  if (options.seed) a_case.discover->seed = *options.seed;
  std::vector<std::string> log;
  const Cache cache(options.run.cache, [&](const std::string& line) { log.push_back(line); });
  const InterruptGuard guard;
  // How many there will be is known only when they are done: as many as a search of the usual length needs.
  constexpr int usual = 80;
  Progress progress("stampings", usual, progress_style_of_standard_error(options.run.quiet), std::cerr);
  int done = 0;
  StampingRuns runs(options.run.file, options.run.assignments, cache, [&](const std::string& keys) {
    progress.update(std::min(++done, usual), keys.substr(0, 60));
    log.push_back("stamped: " + keys);
  });
  StampingDiscovery discovery;
  try {
    discovery = discover_stamping_in(a_case, runs, options.data, options.own_effects);
  } catch (const StampingsInterrupted&) {
    std::cerr << fmt::format(
        "heddle: interrupted after {} stampings; the same command with --resume goes on with the next{}\n",
        done, options.run.cache.empty() ? ", but HEDDLE_CACHE is off: it begins anew" : "");
    return exit_failed;
  }
  progress.finish();
  const DiscoveryRecord& record = discovery.record;
  RunFolder folder(a_case,
                   options.run.output.empty() ? fs::path("out/discover") / a_case.name : options.run.output,
                   options.run.force);
  folder.write("inputs/stampings.csv", read_text_file(options.data));
  folder.write("discover/report.json", discovery_json(record));
  folder.write("discover/patched.yaml", resolved_yaml(runs.case_with(discovery.patch).settings));
  folder.write("discover/gap.csv", gap_csv(record));
  folder.write("discover/shape.csv", shape_csv(record));
  folder.write("discover/slopes.csv", slopes_csv(discovery));
  folder.write("discover/true_runs.csv", true_runs_csv(discovery));
  for (const std::string& line : log) folder.log(line);
  for (const std::string& reason : record.findings.decision.reasons) folder.log(reason);
  folder.close(a_case, {});
  if (options.run.print) {
    print_stampings(discovery, runs.count());
    print_discovery(record, folder.path());
  }
  return exit_done;
}

}  // namespace heddle::pipeline
