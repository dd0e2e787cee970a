#include "pipeline/calibrate_keys.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>

#include "friction/calibration/model_numbers.h"

namespace heddle::pipeline {

namespace {

/// A pair for each number there is, [low, high] or [mean, standard deviation].
void add_pairs(std::vector<Key>& keys, const std::string& block, const char* help) {
  for (const friction::ModelNumber& number : friction::all_numbers())
    keys.push_back({.path = fmt::format("calibrate.{}.{}", block, number.key),
                    .type = KeyType::pair,
                    .unit = number.unit,
                    .presence = Presence::optional,
                    .stage = Stage::calibrate,
                    .help = help,
                    .family = fmt::format("calibrate.{}.KEY", block)});
}

Key scatter(const char* name, const char* range, const char* help) {
  return {.path = fmt::format("calibrate.noise.{}", name),
          .type = KeyType::quantity,
          .unit = "%",
          .presence = Presence::defaulted,
          .default_text = "estimated",
          .range = range,
          .choices = {"estimated"},
          .stage = Stage::calibrate,
          .help = help};
}

Key share(const char* name, const char* standard, const char* range, const char* help) {
  return {.path = fmt::format("calibrate.{}", name),
          .type = KeyType::quantity,
          .unit = "%",
          .presence = Presence::defaulted,
          .default_text = standard,
          .range = range,
          .stage = Stage::calibrate,
          .help = help};
}

std::vector<std::string> all_keys() {
  std::vector<std::string> keys;
  for (const friction::ModelNumber& number : friction::all_numbers()) keys.push_back(number.key);
  return keys;
}

}  // namespace

std::vector<Key> calibrate_keys() {
  std::vector<Key> keys{
      {.path = "calibrate.parameters",
       .type = KeyType::names,
       .presence = Presence::optional,
       .choices = all_keys(),
       .stage = Stage::calibrate,
       .help = "Keys of the numbers to fit, for instance [friction.scale, friction.exponent]; each starts at "
               "its value in the file. Not given: what a run fits."},
      {.path = "calibrate.loss",
       .type = KeyType::choice,
       .presence = Presence::defaulted,
       .default_text = "none",
       .choices = {"none", "huber", "cauchy"},
       .stage = Stage::calibrate,
       .help = "none: squares; huber, cauchy: samples far off count less."},
      {.path = "calibrate.loss_scale",
       .type = KeyType::quantity,
       .presence = Presence::defaulted,
       .default_text = "2",
       .range = "(0, 100]",
       .stage = Stage::calibrate,
       .help = "Standard deviations of a sample beyond which the loss counts less."},
      scatter("sample", "(0, 1]",
              "Standard deviation of ln F from sample to sample; estimated: from replicates, else "
              "from what the fit leaves over."),
      scatter("day", "[0, 1]",
              "The same from day to day, shared by the samples of a day; estimated: from a condition "
              "repeated on three days or more, else noise.day_assumed. 0 is off."),
      share("noise.day_assumed", "2 %", "[0, 1]", "Where no anchors tell it; prior."),
      share("noise.reading", "1 %", "(0, 1]", "Of one stretch of a pull beside the next; prior."),
      share("confidence", "95 %", "(0, 1)", "Of the intervals."),
      {.path = "calibrate.stretches",
       .type = KeyType::integer,
       .presence = Presence::defaulted,
       .default_text = "1",
       .range = "[1, 100]",
       .stage = Stage::calibrate,
       .help = "1: the second half of each history; more: stretches of slip, even in its logarithm, for laws "
               "and effects with a memory."},
      {.path = "calibrate.faces",
       .type = KeyType::integer,
       .presence = Presence::defaulted,
       .default_text = "2",
       .range = "[1, 2]",
       .stage = Stage::calibrate,
       .help = "Faces that slide: 2 between plates, 1 under a sled."}};
  add_pairs(keys, "bounds", "[low, high] of a number that is fitted.");
  add_pairs(keys, "prior", "[mean, standard deviation] of what is known of a number from elsewhere.");
  return keys;
}

CalibrateSpec calibrate_of(const Settings& settings) {
  CalibrateSpec spec;
  const auto number = [&](const char* path, double& value) {
    if (settings.has(path)) value = settings.number(path);
  };
  if (settings.has("calibrate.parameters")) spec.numbers = settings.names("calibrate.parameters");
  for (const friction::ModelNumber& known : friction::all_numbers()) {
    const std::string bounds = "calibrate.bounds." + known.key, prior = "calibrate.prior." + known.key;
    if (settings.has(bounds)) spec.bounds[known.key] = settings.pair(bounds);
    if (settings.has(prior)) spec.priors[known.key] = {settings.pair(prior)[0], settings.pair(prior)[1]};
  }
  if (settings.is("calibrate.loss", "huber")) spec.loss = friction::Loss::huber;
  if (settings.is("calibrate.loss", "cauchy")) spec.loss = friction::Loss::cauchy;
  number("calibrate.loss_scale", spec.loss_scale);
  const auto scatter = [&](const char* path, std::optional<double>& value) {
    if (settings.has(path) && !settings.is(path, "estimated")) value = settings.number(path);
  };
  scatter("calibrate.noise.sample", spec.noise.sample);
  scatter("calibrate.noise.day", spec.noise.day);
  number("calibrate.noise.day_assumed", spec.noise.day_assumed);
  number("calibrate.noise.reading", spec.noise.reading);
  number("calibrate.confidence", spec.confidence);
  if (settings.has("calibrate.stretches")) spec.reduction.stretches = settings.integer("calibrate.stretches");
  if (settings.has("calibrate.faces")) spec.reduction.faces = settings.integer("calibrate.faces");
  return spec;
}

Problems check_calibrate(const CalibrateSpec& spec, const Settings& settings) {
  Problems problems;
  if (!settings.has("calibrate.parameters")) return problems;
  const auto report = [&](const std::string& block, const std::string& key) {
    if (std::ranges::count(spec.numbers, key) > 0) return;
    const std::string path = fmt::format("calibrate.{}.{}", block, key);
    problems.push_back({"*.not_fitted"_family.of(path),
                        path,
                        "",
                        "is of a number that is not fitted",
                        "Add it to calibrate.parameters, or leave this out.",
                        "",
                        0,
                        {"calibrate.parameters"}});
  };
  for (const auto& [key, bounds] : spec.bounds) report("bounds", key);
  for (const auto& [key, prior] : spec.priors) report("prior", key);
  return problems;
}

friction::CouponFitSpec fit_spec_of(const CalibrateSpec& spec, const std::vector<std::string>& numbers) {
  friction::CouponFitSpec fit;
  for (const std::string& key : numbers) {
    friction::FreeNumber number{.key = key};
    const Key& written = *find_key(key);
    const Interval range = interval_of(written.range, written.unit);
    if (spec.bounds.contains(key)) number.bounds = spec.bounds.at(key);
    if (std::isfinite(range.low) || std::isfinite(range.high)) {
      const auto [low, high] = number.bounds.value_or(std::array{range.low, range.high});
      // An open end is none of the values allowed; the next number is.
      const double lowest = range.low_open ? std::nextafter(range.low, INFINITY) : range.low;
      const double highest = range.high_open ? std::nextafter(range.high, -INFINITY) : range.high;
      number.bounds = {std::max(low, lowest), std::min(high, highest)};
    }
    if (spec.priors.contains(key)) number.prior = spec.priors.at(key);
    fit.numbers.push_back(std::move(number));
  }
  fit.loss = spec.loss;
  fit.loss_scale = spec.loss_scale;
  fit.noise = spec.noise;
  fit.faces = spec.reduction.faces;
  fit.confidence = spec.confidence;
  return fit;
}

}  // namespace heddle::pipeline
