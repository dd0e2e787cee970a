#include "pipeline/discover_keys.h"

#include <fmt/format.h>

#include <algorithm>

#include "friction/calibration/model_numbers.h"

namespace heddle::pipeline {

namespace {

Key quantity(const char* name, const char* unit, const char* standard, const char* range, const char* help,
             std::vector<std::string> choices = {}) {
  return {.path = fmt::format("discover.{}", name),
          .type = KeyType::quantity,
          .unit = unit,
          .presence = Presence::defaulted,
          .default_text = standard,
          .range = range,
          .choices = std::move(choices),
          .stage = Stage::discover,
          .help = help};
}

Key choice(const char* name, std::vector<std::string> choices, const char* help) {
  return {.path = fmt::format("discover.{}", name),
          .type = KeyType::choice,
          .presence = Presence::defaulted,
          .default_text = choices.front(),
          .choices = choices,
          .stage = Stage::discover,
          .help = help};
}

Key whole(const char* name, const char* standard, const char* range, const char* help) {
  return {.path = fmt::format("discover.{}", name),
          .type = KeyType::integer,
          .presence = Presence::defaulted,
          .default_text = standard,
          .range = range,
          .stage = Stage::discover,
          .help = help};
}

}  // namespace

std::vector<Key> discover_keys() {
  std::vector<std::string> numbers;
  for (const friction::ModelNumber& number : friction::all_numbers()) numbers.push_back(number.key);
  std::vector<Key> keys{
      {.path = "discover.parameters",
       .type = KeyType::names,
       .presence = Presence::optional,
       .choices = std::move(numbers),
       .stage = Stage::discover,
       .help =
           "Keys of the numbers that the model may move before an effect counts as missing. Not given: the "
           "law's constants, and of the film power_index and activation_energy."},
      {.path = "discover.effects",
       .type = KeyType::text,
       .presence = Presence::defaulted,
       .default_text = "all",
       .stage = Stage::discover,
       .help = "Ids of the effects to try, apart by blanks; all: the whole library (configs/effects)."},
      quantity("noise.sample", "%", "estimated", "(0, 1]",
               "Standard deviation of ln F from sample to sample; estimated: from replicates.",
               {"estimated"}),
      quantity(
          "noise.day", "%", "estimated", "[0, 1]",
          "The same from day to day; estimated: from a condition repeated on three days or more. 0 is off.",
          {"estimated"}),
      quantity("noise.sample_assumed", "%", "5 %", "(0, 1]", "Where no replicates tell it; prior."),
      quantity("noise.day_assumed", "%", "2 %", "[0, 1]", "Where no anchors tell it; prior."),
      quantity("noise.reading", "%", "1.5 %", "(0, 1]",
               "Of one stretch of a pull beside the next, where replicates do not tell it; prior."),
      quantity(
          "noise.form", "%", "2 %", "[0, 1]",
          "How far the law's own curve over ln Hs may be off before that counts as a missing effect; prior."),
      quantity("noise.form_length", "", "1.5", "(0, 100]",
               "Over how much of ln Hs its error wanders; prior."),
      quantity("noise.history", "%", "1 %", "[0, 1]",
               "How far a pull may be from even along its slip, alike in all conditions, before that counts; "
               "prior."),
      quantity("noise.effect_form", "%", "25 %", "[0, 1]",
               "How far the form of a library effect may be off, as share of what it does to ln F; prior."),
      quantity("noise.effect_form_length", "", "0.5", "(0, 100]",
               "Over what share of the range of each factor that error wanders; prior."),
      choice("search.evidence", {"laplace", "akaike"},
             "What hypotheses are weighed by; akaike, of the forms as they are, is there to see what "
             "evidence is worth."),
      whole("search.pairs_of", "4", "[0, 20]", "Of how many single effects, the best, pairs are tried."),
      quantity("verdict.gate", "%", "1 %", "(0, 1]",
               "Share of campaigns without a gap in which the gate may open."),
      quantity("verdict.stability", "%", "80 %", "[0, 1]", "Share of half-samples in which a name must win."),
      choice("verdict.unknown", {"on", "off"},
             "Whether a free shape may say that no name will do; off is there to see what that is worth."),
      quantity("held_out", "%", "25 %", "[0, 0.5]", "Share of the conditions that no fit sees."),
      whole("stretches", "8", "[1, 40]",
            "Stretches of slip, even in its logarithm, into which a pull is cut."),
      whole("faces", "2", "[1, 2]", "Faces that slide: 2 between plates, 1 under a sled."),
      whole("seed", "1", "[0, 2000000000]", "Of every draw."),
      quantity("tow_pitch", "mm", "5.39 mm", "[0 mm, 100 mm)",
               "Of the fabric, at whose period a ripple is looked for; 0 mm: not at all.")};
  for (const friction::ModelNumber& number : friction::all_numbers())
    keys.push_back({.path = fmt::format("discover.prior.{}", number.key),
                    .type = KeyType::pair,
                    .unit = number.unit,
                    .presence = Presence::optional,
                    .stage = Stage::discover,
                    .help = "[mean, standard deviation] of a number that the model may move.",
                    .family = "discover.prior.KEY"});
  return keys;
}

DiscoverSpec discover_of(const Settings& settings) {
  DiscoverSpec spec;
  const auto take = [&](const char* name, double& value) {
    const std::string path = fmt::format("discover.{}", name);
    if (settings.has(path)) value = settings.number(path);
  };
  const auto take_scatter = [&](const char* name, std::optional<double>& value) {
    const std::string path = fmt::format("discover.{}", name);
    if (settings.has(path) && !settings.is(path, "estimated")) value = settings.number(path);
  };
  const auto take_whole = [&](const char* name, int& value) {
    const std::string path = fmt::format("discover.{}", name);
    if (settings.has(path)) value = settings.integer(path);
  };
  if (settings.has("discover.parameters")) spec.numbers = settings.names("discover.parameters");
  for (const friction::ModelNumber& number : friction::all_numbers())
    if (const std::string path = "discover.prior." + number.key; settings.has(path))
      spec.priors[number.key] = settings.pair(path);
  if (settings.has("discover.effects") && settings.text("discover.effects") != "all") {
    const std::string& text = settings.text("discover.effects");
    for (std::size_t start = 0; start < text.size();) {
      const std::size_t end = std::min(text.find(' ', start), text.size());
      if (end > start) spec.effects.push_back(text.substr(start, end - start));
      start = end + 1;
    }
  }
  take_scatter("noise.sample", spec.noise.sample);
  take_scatter("noise.day", spec.noise.day);
  take("noise.sample_assumed", spec.noise.sample_assumed);
  take("noise.day_assumed", spec.noise.day_assumed);
  take("noise.reading", spec.noise.reading);
  take("noise.form", spec.noise.form);
  take("noise.form_length", spec.noise.form_length);
  take("noise.history", spec.noise.history);
  take("noise.effect_form", spec.noise.effect_form);
  take("noise.effect_form_length", spec.noise.effect_form_length);
  const auto chosen = [&](const char* name, const char* value) {
    const std::string path = fmt::format("discover.{}", name);
    return settings.has(path) && settings.is(path, value);
  };
  spec.search.akaike = chosen("search.evidence", "akaike");
  int pairs_of = static_cast<int>(spec.search.pairs_of);
  take_whole("search.pairs_of", pairs_of);
  spec.search.pairs_of = static_cast<std::size_t>(pairs_of);
  take("verdict.gate", spec.verdict.gate);
  take("verdict.stability", spec.verdict.stability);
  spec.verdict.unknown = !chosen("verdict.unknown", "off");
  take("held_out", spec.held_out);
  take_whole("stretches", spec.stretches);
  take_whole("faces", spec.faces);
  take_whole("seed", spec.seed);
  take("tow_pitch", spec.tow_pitch);
  return spec;
}

Problems check_discover(const DiscoverSpec& spec, const Settings& settings) {
  Problems problems;
  for (const auto& [key, prior] : spec.priors) {
    const std::string path = "discover.prior." + key;
    if (!(prior[1] > 0.0))
      problems.push_back({"discover.prior.spread"_rule, path, "", "must have a standard deviation above 0",
                          "Write [mean, standard deviation]."});
    if (settings.has("discover.parameters") && std::ranges::count(spec.numbers, key) == 0)
      problems.push_back({"discover.prior.not_moved"_rule,
                          path,
                          "",
                          "is of a number that the model may not move",
                          "Add it to discover.parameters, or leave this out.",
                          "",
                          0,
                          {"discover.parameters"}});
  }
  return problems;
}

}  // namespace heddle::pipeline
