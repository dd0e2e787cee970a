#include "pipeline/discover_command.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <numbers>

#include "core/text_file.h"
#include "core/units.h"
#include "friction/calibration/model_numbers.h"
#include "friction/parameters.h"
#include "pipeline/config_tree.h"
#include "pipeline/discover/contrasts.h"
#include "pipeline/discover_report.h"
#include "pipeline/discover_shear.h"
#include "pipeline/discover_stamping.h"
#include "pipeline/run_folder.h"
#include "pipeline/stages.h"
#include "pipeline/threads.h"

namespace heddle::pipeline {

namespace {

namespace fs = std::filesystem;

/// The law's constants, and of its film what rheology knows only so well.
std::vector<std::string> usual_numbers(const friction::Model& model) {
  std::vector<std::string> keys;
  for (const friction::Parameter& parameter : friction::parameters_of(model)) keys.push_back(parameter.key);
  if (!friction::reads_hersey_number(model.law)) return keys;
  for (const friction::ModelNumber& number : friction::numbers_of(model))
    if (number.key == "resin.power_index" || number.key == "resin.activation_energy")
      keys.push_back(number.key);
  return keys;
}

std::vector<discover::Unknown> baseline_of(const friction::Model& model, const DiscoverSpec& spec,
                                           Problems& problems) {
  const std::vector<std::string> keys = spec.numbers.empty() ? usual_numbers(model) : spec.numbers;
  const std::vector<friction::ModelNumber> numbers = friction::numbers_of(model);
  std::vector<discover::Unknown> baseline;
  for (const std::string& key : keys) {
    const auto number = std::ranges::find(numbers, key, &friction::ModelNumber::key);
    if (number == numbers.end()) {
      std::vector<std::string> known;
      for (const friction::ModelNumber& one : numbers) known.push_back(one.key);
      problems.push_back({"discover.parameters.acts"_rule, "discover.parameters", key,
                          "is no number of this case's model",
                          fmt::format("Those that act: {}.", fmt::join(known, ", "))});
      continue;
    }
    discover::Prior prior = discover::usual_prior(*number);
    if (const auto given = spec.priors.find(key); given != spec.priors.end()) {
      prior.kind = discover::Prior::Kind::normal;
      prior.centre = given->second[0];
      prior.scale = given->second[1];
    }
    baseline.push_back({.key = key, .unit = number->unit, .prior = prior});
  }
  return baseline;
}

}  // namespace

std::vector<discover::EffectFile> library_of(const DiscoverSpec& spec,
                                             const std::vector<fs::path>& own_effects, Problems& problems) {
  std::vector<discover::EffectFile> all = discover::built_in_effects();
  for (const fs::path& file : own_effects) {
    try {
      discover::EffectFile effect = discover::read_effect(read_text_file(file), file.string());
      std::erase_if(all, [&](const discover::EffectFile& known) { return known.id == effect.id; });
      all.push_back(std::move(effect));
    } catch (const InputError& error) {
      problems.insert(problems.end(), error.problems().begin(), error.problems().end());
    }
  }
  if (spec.effects.empty()) return all;
  std::vector<discover::EffectFile> chosen;
  for (const std::string& id : spec.effects) {
    const auto at = std::ranges::find(all, id, &discover::EffectFile::id);
    if (at != all.end()) {
      chosen.push_back(*at);
      continue;
    }
    std::vector<std::string> known;
    for (const discover::EffectFile& effect : all) known.push_back(effect.id);
    problems.push_back({"discover.effects.known"_rule, "discover.effects", id, "is no effect of the library",
                        fmt::format("Known: {}.", fmt::join(known, ", "))});
  }
  return chosen;
}

namespace {

std::string in_one_line(const ConfigNode& node) {
  if (node.kind == ConfigNode::Kind::scalar) return node.text;
  std::vector<std::string> parts;
  for (const ConfigNode& item : node.items) parts.push_back(in_one_line(item));
  for (const ConfigNode::Entry& entry : node.entries)
    parts.push_back(fmt::format("{} {}", entry.key, in_one_line(entry.value)));
  return fmt::format("{}", fmt::join(parts, ", "));
}

}  // namespace

Sidecar read_sidecar(const fs::path& data, Problems& problems) {
  Sidecar sidecar;
  const fs::path file = fs::path(data).replace_extension(".yaml");
  if (!fs::exists(file)) return sidecar;
  ParsedConfig parsed = parse_config(read_text_file(file), file.string());
  problems.insert(problems.end(), parsed.problems.begin(), parsed.problems.end());
  const auto add = [&](RuleId id, const ConfigNode& node, const std::string& key, std::string rule,
                       std::string way_out) {
    problems.push_back(
        {std::move(id), key, node.text, std::move(rule), std::move(way_out), file.string(), node.line});
  };
  for (const ConfigNode::Entry& entry : parsed.root.entries)
    if (entry.key != "rig" && entry.key != "provenance")
      problems.push_back({"discover.sidecar.unknown"_rule, entry.key, "", "is no key of a table's sidecar",
                          "Known: rig, provenance.", file.string(), entry.line});
  if (const ConfigNode* area = parsed.root.find_path("rig.plate_area")) {
    const Reading reading = read_quantity(area->text, "m^2");
    if (reading.ok() && reading.value > 0.0)
      sidecar.plate_area = reading.value;
    else
      add("discover.sidecar.plate_area"_rule, *area, "rig.plate_area",
          reading.ok() ? "must be positive" : reading.fault, "For instance 0.01 m^2.");
  }
  if (const ConfigNode* faces = parsed.root.find_path("rig.faces")) {
    if (faces->text == "1" || faces->text == "2")
      sidecar.faces = faces->text == "1" ? 1 : 2;
    else
      add("discover.sidecar.faces"_rule, *faces, "rig.faces", "must be 1 or 2",
          "2 between plates, 1 under a sled.");
  }
  if (const ConfigNode* rig = parsed.root.find("rig")) sidecar.rig = in_one_line(*rig);
  if (const ConfigNode* provenance = parsed.root.find("provenance"))
    sidecar.provenance = in_one_line(*provenance);
  return sidecar;
}

namespace {

/// A table that holds another model's forces beside the measured ones: what that model has the wrong sign of.
std::vector<std::string> notes_on_other_model(const fs::path& data) {
  const std::string text = read_text_file(data);
  const std::string_view header = std::string_view(text).substr(0, text.find('\n'));
  if (header.find("force_paper_model_N") == std::string_view::npos) return {};
  std::vector<friction::FrictionTestRow> rows = friction::parse_friction_table(text, data.string());
  std::erase_if(rows, [](const auto& row) { return !row.measured_force || !row.paper_model_force; });
  std::vector<double> measured, modelled;
  for (const friction::FrictionTestRow& row : rows) {
    measured.push_back(*row.measured_force);
    modelled.push_back(*row.paper_model_force);
  }
  const discover::Sensitivities nature = discover::sensitivities_of(rows, measured),
                                other = discover::sensitivities_of(rows, modelled);
  std::vector<std::string> notes;
  const auto compare = [&](const char* name, const std::optional<double>& a, const std::optional<double>& b) {
    if (a && b && *a * *b < 0.0)
      notes.push_back(
          fmt::format("The model in column force_paper_model_N has the wrong sign in {}: slope of ln mu "
                      "{:+.3g}, measured {:+.3g}.",
                      name, *b, *a));
  };
  compare("ln velocity", nature.velocity, other.velocity);
  compare("ln normal force", nature.normal_force, other.normal_force);
  compare("tool temperature", nature.tool_temperature, other.tool_temperature);
  if (nature.can_be_hersey() && !other.can_be_hersey())
    notes.push_back(
        fmt::format("Its slopes would ask for a power-law index of {:.2f}, which no law of one Hersey "
                    "number has; the measured ones ask for {:.2f}.",
                    *other.implied_index(), nature.implied_index().value_or(0.0)));
  return notes;
}

void demand_variety(const friction::CouponData& data, Problems& problems) {
  if (data.conditions >= 2) return;
  problems.push_back({"discover.data.alike"_rule, "data", "",
                      "holds one condition only, which cannot tell one effect from another",
                      "Vary at least one of speed, load, temperatures, orientation and dwell.", data.file});
}

}  // namespace

Case read_friction_part(const RunOptions& options) {
  Case a_case = read_case(options.file, options.assignments);
  a_case.stamping.reset();
  a_case.orientation_study.reset();
  a_case.grid_error = false;
  if (a_case.friction) return a_case;
  throw InputError(
      {{"discover.friction"_rule, "friction", "", "is missing, and discovery in coupons needs it",
        "Add `friction:`; configs/discover/friction.yaml shows one.", options.file.string()}});
}

discover::CouponQuestion question_of(const Case& a_case, const discover::CouponRig& rig,
                                     const std::vector<fs::path>& own_effects, Problems& problems) {
  const DiscoverSpec spec = a_case.discover.value_or(DiscoverSpec{});
  discover::CouponQuestion question;
  question.base = model_of_run(*a_case.friction, rig.area);
  question.rig = rig;
  question.baseline = baseline_of(question.base, spec, problems);
  question.effects = library_of(spec, own_effects, problems);
  question.noise = spec.noise;
  question.search = spec.search;
  question.verdict = spec.verdict;
  question.held_out = spec.held_out;
  question.seed = static_cast<std::uint64_t>(spec.seed);
  question.tow_pitch = spec.tow_pitch;
  return question;
}

namespace {

void set_number(Settings& settings, const std::string& path, double value) {
  const Key* key = find_key(path);
  if (key == nullptr) return;
  Setting setting;
  if (const Setting* known = settings.find(path)) setting = *known;
  setting.key = key;
  setting.values = {value, 0.0};
  setting.text.clear();
  settings.add(std::move(setting));
}

/// Without the last digits that the way from degC to K and back leaves.
double rounded(double value) {
  return std::round(1e6 * value) / 1e6;
}

void print_next(const discover::Proposal& proposal) {
  if (proposal.pulls.empty()) return;
  std::vector<std::string> rivals;
  for (const discover::Rival& rival : proposal.rivals)
    rivals.push_back(fmt::format("{} ({:.2f})", rival.name, rival.probability));
  fmt::print("Next, to tell {}; the right answer from {:.2f} to {:.2f}:\n", fmt::join(rivals, ", "),
             proposal.right_before, proposal.right_after);
  for (const discover::ProposedPull& next : proposal.pulls)
    fmt::print("  {:g} mm/s, {:g} N, tool {:g} degC, fabric {:g} degC, {:g} deg, rest {:g} s\n",
               rounded(1e3 * next.cell.pull.velocity), rounded(next.cell.pull.normal_force),
               rounded(next.cell.pull.tool_temperature - zero_celsius),
               rounded(next.cell.pull.fabric_temperature - zero_celsius),
               rounded(next.cell.pull.orientation * 180.0 / std::numbers::pi), next.cell.dwell);
  for (const auto& [i, j] : proposal.inseparable)
    fmt::print("  no three conditions within the campaign's levels tell {} and {} apart\n",
               proposal.rivals[i].name, proposal.rivals[j].name);
}

}  // namespace

void print_discovery(const DiscoveryRecord& record, const fs::path& folder) {
  const discover::CouponFindings& f = record.findings;
  fmt::print("{}", in_words(f.decision.answer));
  if (f.decision.answer == discover::Answer::named ||
      f.decision.answer == discover::Answer::named_incomplete) {
    std::vector<std::string> ids;
    for (const std::size_t effect : f.decision.named) ids.push_back(f.forward.candidates[effect].id);
    fmt::print(" {}", fmt::join(ids, " and "));
  } else if (!f.decision.candidate_set.empty()) {
    fmt::print(" {{{}}}", fmt::join(f.decision.candidate_set, ", "));
  }
  if (!f.decision.group.empty()) fmt::print(": {}", f.decision.group);
  fmt::print("\n");
  for (const std::string& reason : f.decision.reasons) fmt::print("{}\n", reason);
  if (f.gap)
    fmt::print(
        "Held-out conditions: {:.1f} % of the force off before, {:.1f} % after, {:.1f} % is noise; shrink "
        "{:.0f} % "
        "({:.0f} to {:.0f}).\n",
        100.0 * f.gap->before, 100.0 * f.gap->after, 100.0 * f.gap->floor, 100.0 * f.gap->shrink,
        100.0 * f.gap->shrink_low, 100.0 * f.gap->shrink_high);
  print_next(record.proposal);
  for (const std::string& note : record.notes) fmt::print("{}\n", note);
  fmt::print("results {}\n", folder.string());
}

DiscoveryRecord discover_case_in(const Case& a_case, const fs::path& data,
                                 const std::vector<fs::path>& own_effects) {
  const DiscoverSpec spec = a_case.discover.value_or(DiscoverSpec{});
  DiscoveryRecord record;
  record.name = a_case.name;
  record.data_file = data.filename().string();
  record.seed = spec.seed;
  Problems problems;
  const Sidecar sidecar = read_sidecar(data, problems);
  record.rig = sidecar.rig;
  record.provenance = sidecar.provenance;
  record.coupon_rig.rig = a_case.friction->rig;
  if (sidecar.plate_area) record.coupon_rig.rig.plate_area = *sidecar.plate_area;
  record.coupon_rig.faces = sidecar.faces.value_or(spec.faces);
  record.coupon_rig.area = area_of_pulled_fabric(a_case);
  record.question = question_of(a_case, record.coupon_rig, own_effects, problems);
  record.base = record.question.base;
  friction::CouponData coupons;
  try {
    coupons = friction::read_coupons(
        data.lexically_normal().string(),
        {.stretches = spec.stretches, .same_stretches = true, .faces = record.coupon_rig.faces});
    demand_variety(coupons, problems);
  } catch (const InputError& error) {
    problems.insert(problems.end(), error.problems().begin(), error.problems().end());
  }
  if (!problems.empty()) throw InputError(std::move(problems));
  record.findings = discover::discover_in_coupons(record.question, coupons);
  record.proposal =
      discover::propose(record.question, record.findings, discover::candidate_grid(record.findings.campaign),
                        {.seed = record.question.seed});
  record.notes = notes_on_other_model(data);
  record.notes.insert(record.notes.end(), record.findings.notes.begin(), record.findings.notes.end());
  record.notes.insert(record.notes.end(), a_case.notes.begin(), a_case.notes.end());
  return record;
}

Settings discovered_settings(const Case& a_case, const DiscoveryRecord& record) {
  Settings settings = a_case.settings;
  settings.remove("friction.calibration.data");
  const discover::CouponFindings& found = record.findings;
  const bool named = found.decision.answer == discover::Answer::named ||
                     found.decision.answer == discover::Answer::named_incomplete;
  const discover::Scored* scored = named ? found.result.find(found.decision.named) : nullptr;
  const discover::MapFit& fit = scored != nullptr ? scored->numbers : found.result.baseline;
  const friction::Model patched = discover::patched_model(record.base, found.forward, fit.trial);
  // An effect of the user's own may move a number that every model has.
  const auto of_named = [&](const std::string& key) {
    return std::ranges::any_of(fit.hypothesis, [&](std::size_t effect) {
      return std::ranges::count(found.forward.candidates[effect].numbers, key, &discover::Unknown::key) > 0;
    });
  };
  for (const friction::ModelNumber& number : friction::numbers_of(patched)) {
    const bool of_law = number.key.starts_with("friction.");
    const bool moved =
        std::ranges::count(record.question.baseline, number.key, &discover::Unknown::key) > 0 ||
        of_named(number.key);
    const bool of_effect = number.key.starts_with("effects.");
    if (of_law || moved || of_effect) set_number(settings, number.key, number.value);
    if (of_effect) settings.blocks.insert(number.key.substr(0, number.key.rfind('.')));
  }
  return settings;
}

int discover_case(const DiscoverOptions& options) {
  const auto threads = limit_threads(options.run.threads);
  if (!options.design.empty()) return plan_coupons(options);
  const std::string table = read_text_file(options.data);
  if (discover::is_stamping_table(table)) return discover_stamping(options);
  if (is_shear_table(table)) return discover_shear(options);
  Case a_case = read_friction_part(options.run);
  if (!a_case.discover) a_case.discover.emplace();
  if (options.seed) a_case.discover->seed = *options.seed;
  const DiscoveryRecord record = discover_case_in(a_case, options.data, options.own_effects);
  RunFolder folder(a_case,
                   options.run.output.empty() ? fs::path("out/discover") / a_case.name : options.run.output,
                   options.run.force);
  folder.write("inputs/coupons.csv", read_text_file(options.data));
  folder.write("discover/report.json", discovery_json(record));
  folder.write("discover/report.html", discover_html(record));
  folder.write("discover/patched.yaml", resolved_yaml(discovered_settings(a_case, record)));
  folder.write("discover/gap.csv", gap_csv(record));
  folder.write("discover/shape.csv", shape_csv(record));
  folder.write("discover/next_experiments.csv", next_experiments_csv(record));
  for (const std::string& reason : record.findings.decision.reasons) folder.log(reason);
  folder.close(a_case, {});
  if (options.run.print) print_discovery(record, folder.path());
  return exit_done;
}

}  // namespace heddle::pipeline
