#include "pipeline/discover/effect_library.h"

#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <limits>

#include "core/units.h"
#include "pipeline/config_tree.h"

namespace heddle::discover {

namespace {

using pipeline::ConfigNode;

constexpr std::array stages{"film", "area", "coefficient", "fabric", "process", "rig", "numerics"};
constexpr std::array library_order{"tool_temperature_film",
                                   "tool_temperature_shift",
                                   "static_peak",
                                   "sliding_evolution",
                                   "stick_slip",
                                   "pressure_dependent_area",
                                   "orientation",
                                   "adhesion",
                                   "film_squeeze_out",
                                   "dwell_ageing",
                                   "solidification",
                                   "shear_heating",
                                   "wear",
                                   "viscosity_plateau",
                                   "boundary_lubrication",
                                   "normal_force_relaxation",
                                   "load_cell_offset",
                                   "gain_drift",
                                   "drive_backlash",
                                   "nonuniform_pressure",
                                   "mislabelled_condition",
                                   "shear_rate",
                                   "shear_locking",
                                   "tension_shear_coupling",
                                   "bending",
                                   "tow_rate_stiffening",
                                   "crimp_straightening",
                                   "shear_thermal_softening",
                                   "binder_tilt",
                                   "punch_misalignment",
                                   "blank_cooling",
                                   "press_compliance",
                                   "inertia",
                                   "binder_force_level",
                                   "initial_orientation",
                                   "discretisation"};

class EffectReader {
 public:
  EffectReader(std::string file, Problems& problems) : problems_(problems) { effect_.file = std::move(file); }

  EffectFile read(const ConfigNode& root) {
    for (const ConfigNode::Entry& entry : root.entries) read_entry(entry);
    for (const char* key : {"id", "stage", "form", "parameters", "source"})
      if (root.find(key) == nullptr)
        add("discover.effect.missing"_rule, key, "", "is missing from an effect file",
            "configs/effects/static_peak.yaml shows a whole one.", 0);
    if (root.find("term") == nullptr) effect_.term = effect_.id;
    give_keys();
    return std::move(effect_);
  }

 private:
  void read_entry(const ConfigNode::Entry& entry) {
    const ConfigNode& value = entry.value;
    if (entry.key == "id")
      effect_.id = value.text;
    else if (entry.key == "stage")
      read_stage(value);
    else if (entry.key == "term")
      effect_.term = value.text;
    else if (entry.key == "form")
      effect_.form = value.text;
    else if (entry.key == "source")
      effect_.source = value.text;
    else if (entry.key == "look_alikes")
      for (const ConfigNode& item : value.items) effect_.look_alikes.push_back(item.text);
    else if (entry.key == "parameters")
      for (const ConfigNode::Entry& number : value.entries) read_number(number);
    else
      add("discover.effect.unknown"_rule, entry.key, "", "is no key of an effect file",
          "Known: id, stage, term, form, parameters, look_alikes, source.", entry.line);
  }

  void read_stage(const ConfigNode& value) {
    effect_.stage = value.text;
    if (std::ranges::find(stages, value.text) == stages.end())
      add("discover.effect.stage"_rule, "stage", value.text, "is no stage",
          fmt::format("One of {}.", fmt::join(stages, ", ")), value.line);
  }

  void read_number(const ConfigNode::Entry& entry) {
    Unknown number{.key = entry.key, .unit = "", .prior = {}};
    double off = std::numeric_limits<double>::quiet_NaN();
    if (const ConfigNode* unit = entry.value.find("unit")) number.unit = unit->text;
    if (const ConfigNode* key = entry.value.find("key")) number.key = key->text;
    if (const ConfigNode* text = entry.value.find("off"); text != nullptr && text->text != "any")
      off = read_off(*text, number.unit, entry);
    std::string fault = "is missing";
    const ConfigNode* text = entry.value.find("prior");
    const auto prior = text != nullptr ? read_prior(text->text, number.unit, fault) : std::nullopt;
    if (!prior)
      add("discover.effect.prior"_rule, fmt::format("parameters.{}.prior", entry.key),
          text != nullptr ? text->text : "", fault,
          "For instance 'half-normal, scale 0.2' or 'log-normal, median 2e-3 m, factor 2'.", entry.line);
    else
      number.prior = *prior;
    effect_.numbers.push_back(std::move(number));
    effect_.off.push_back(off);
    if (effect_.numbers.size() == 1) check_amplitude(entry, prior.has_value());
  }

  double read_off(const ConfigNode& text, const std::string& unit, const ConfigNode::Entry& entry) {
    // A bare 0 is 0 of every unit.
    const Reading plain = read_quantity(text.text, "");
    if (plain.ok()) return plain.value;
    const Reading reading = read_quantity(text.text, unit);
    if (!reading.ok())
      add("discover.effect.off"_rule, fmt::format("parameters.{}.off", entry.key), text.text,
          fmt::format("{}", reading.fault), "Write the value at which the effect is not there, or any.",
          text.line);
    return reading.value;
  }

  void check_amplitude(const ConfigNode::Entry& entry, bool has_prior) {
    const std::string key = fmt::format("parameters.{}.off", entry.key);
    if (std::isnan(effect_.off[0]))
      return add("discover.effect.off"_rule, key, "", "is needed of the first number, the amplitude",
                 "Write off: 0, or the value at which the effect is not there.", entry.line);
    const Prior& prior = effect_.numbers[0].prior;
    if (has_prior && prior.is_free() && prior.coordinate_of(effect_.off[0]) != 0.0)
      add("discover.effect.centre"_rule, key, write_quantity(effect_.off[0], effect_.numbers[0].unit),
          "must be the centre of the amplitude's prior: 0 of half-normal, the mean or median of others",
          "Put the prior about the off value.", entry.line);
  }

  /// A number without a key of its own belongs to the effect's term.
  void give_keys() {
    for (Unknown& number : effect_.numbers)
      if (number.key.find('.') == std::string::npos)
        number.key =
            fmt::format("{}.{}.{}", effect_.stage == "rig" ? "rig" : "effects", effect_.term, number.key);
  }

  void add(RuleId id, std::string key, std::string value, std::string rule, std::string way_out, int line) {
    problems_.push_back({.id = std::move(id),
                         .key = std::move(key),
                         .value = std::move(value),
                         .rule = std::move(rule),
                         .way_out = std::move(way_out),
                         .file = effect_.file,
                         .line = line});
  }

  EffectFile effect_;
  Problems& problems_;
};

}  // namespace

Candidate EffectFile::candidate() const {
  const Kind kind = stage == "rig" ? Kind::rig : stage == "numerics" ? Kind::numerics : Kind::physics;
  return {
      .id = id, .kind = kind, .numbers = numbers, .look_alikes = look_alikes, .form = form, .source = source};
}

EffectFile read_effect(const std::string& text, const std::string& file) {
  pipeline::ParsedConfig parsed = pipeline::parse_config(text, file);
  Problems problems = std::move(parsed.problems);
  EffectFile effect = EffectReader(file, problems).read(parsed.root);
  if (!problems.empty()) throw InputError(std::move(problems));
  return effect;
}

std::vector<EffectFile> built_in_effects() {
  std::vector<EffectFile> effects;
  for (const auto& [name, text] : built_in_effect_texts())
    effects.push_back(read_effect(text, fmt::format("configs/effects/{}", name)));
  const auto place = [](const EffectFile& effect) {
    return std::ranges::find(library_order, effect.id) - library_order.begin();
  };
  std::ranges::sort(effects, {}, place);
  return effects;
}

}  // namespace heddle::discover
