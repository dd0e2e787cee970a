#include "pipeline/discover/prior.h"

#include <fmt/format.h>

#include <cmath>
#include <numbers>
#include <vector>

#include "core/units.h"

namespace heddle::discover {

namespace {

std::string_view trimmed(std::string_view text) {
  while (!text.empty() && text.front() == ' ') text.remove_prefix(1);
  while (!text.empty() && text.back() == ' ') text.remove_suffix(1);
  return text;
}

std::vector<std::string_view> parts_of(std::string_view text) {
  std::vector<std::string_view> parts;
  for (std::size_t start = 0; start <= text.size();) {
    const std::size_t comma = std::min(text.find(',', start), text.size());
    parts.push_back(trimmed(text.substr(start, comma - start)));
    start = comma + 1;
  }
  return parts;
}

/// ln(1 - Phi(z)) of a large z, by the continued fraction of Mills' ratio.
double log_tail(double z) {
  if (z < 5.0) return std::log(0.5 * std::erfc(z / std::numbers::sqrt2));
  double ratio = z;
  for (int k = 60; k > 0; --k) ratio = z + k / ratio;
  return -0.5 * z * z - 0.5 * std::log(2.0 * std::numbers::pi) - std::log(ratio);
}

class PriorReader {
 public:
  PriorReader(std::string unit, std::string& fault) : unit_(std::move(unit)), fault_(fault) {}

  std::optional<Prior> read(std::string_view text) {
    const std::vector<std::string_view> parts = parts_of(trimmed(text.substr(0, text.find(';'))));
    Prior prior;
    if (parts[0] == "fixed") return fixed(parts);
    if (parts[0] == "normal") {
      prior.kind = Prior::Kind::normal;
      // A spread in kelvin belongs to a temperature in degC.
      if (!number(parts, 1, "mean", unit_, prior.centre) || !number(parts, 2, "sd", step_unit(), prior.scale))
        return {};
    } else if (parts[0] == "half-normal") {
      prior.kind = Prior::Kind::half_normal;
      prior.low = 0.0;
      if (!number(parts, 1, "scale", step_unit(), prior.scale)) return {};
    } else if (parts[0] == "log-normal") {
      prior.kind = Prior::Kind::log_normal;
      if (!number(parts, 1, "median", unit_, prior.centre) || !number(parts, 2, "factor", "", prior.scale))
        return {};
    } else {
      return failed(fmt::format("begins with '{}'; known: fixed, normal, half-normal, log-normal", parts[0]));
    }
    const std::size_t next = prior.kind == Prior::Kind::half_normal ? 2 : 3;
    if (parts.size() > next && !range(parts[next], prior)) return {};
    if (parts.size() > next + 1) return failed(fmt::format("has more than it needs: '{}'", parts[next + 1]));
    return sound(prior);
  }

 private:
  std::string step_unit() const { return unit_ == "degC" ? "K" : unit_; }

  std::nullopt_t failed(std::string text) {
    fault_ = std::move(text);
    return std::nullopt;
  }

  std::optional<Prior> fixed(const std::vector<std::string_view>& parts) {
    Prior prior;
    if (parts.size() != 2) return failed("must be 'fixed, VALUE'");
    const Reading reading = read_quantity(parts[1], unit_);
    if (!reading.ok()) return failed(fmt::format("'{}' {}", parts[1], reading.fault));
    prior.centre = reading.value;
    return prior;
  }

  bool number(const std::vector<std::string_view>& parts, std::size_t at, std::string_view name,
              const std::string& unit, double& value) {
    if (at >= parts.size() || !parts[at].starts_with(name)) {
      failed(fmt::format("lacks '{} VALUE' as its part {}", name, at + 1));
      return false;
    }
    return read(parts[at].substr(name.size()), unit, value);
  }

  bool range(std::string_view part, Prior& prior) {
    const std::size_t middle = part.find(" to ");
    if (!part.starts_with("within ") || middle == std::string_view::npos) {
      failed(fmt::format("has '{}' where 'within LOW to HIGH' may stand", part));
      return false;
    }
    return read(part.substr(7, middle - 7), unit_, prior.low) &&
           read(part.substr(middle + 4), unit_, prior.high);
  }

  bool read(std::string_view text, const std::string& unit, double& value) {
    // A bare 0 is 0 of every unit but an absolute temperature.
    const Reading plain = read_quantity(trimmed(text), "");
    if (plain.ok() && plain.value == 0.0 && unit != "degC") {
      value = 0.0;
      return true;
    }
    const Reading reading = read_quantity(trimmed(text), unit);
    if (!reading.ok()) failed(fmt::format("'{}' {}", trimmed(text), reading.fault));
    value = reading.value;
    return reading.ok();
  }

  std::optional<Prior> sound(const Prior& prior) {
    const bool log = prior.kind == Prior::Kind::log_normal;
    if (!(prior.scale > (log ? 1.0 : 0.0)))
      return failed(log ? "needs a factor above 1" : "needs a scale or sd above 0");
    if (log && !(prior.centre > 0.0)) return failed("needs a median above 0");
    const auto [low, high] = prior.bounds();
    if (!(low < high)) return failed("leaves no room between its bounds");
    return prior;
  }

  std::string unit_;
  std::string& fault_;
};

}  // namespace

double Prior::value_at(double z) const {
  switch (kind) {
    case Kind::fixed:
      return centre;
    case Kind::normal:
      return centre + scale * z;
    case Kind::half_normal:
      return scale * z;
    case Kind::log_normal:
      return centre * std::pow(scale, z);
  }
  return centre;
}

double Prior::coordinate_of(double value) const {
  switch (kind) {
    case Kind::fixed:
      return 0.0;
    case Kind::normal:
      return (value - centre) / scale;
    case Kind::half_normal:
      return value / scale;
    case Kind::log_normal:
      return value > 0.0 ? std::log(value / centre) / std::log(scale)
                         : -std::numeric_limits<double>::infinity();
  }
  return 0.0;
}

std::array<double, 2> Prior::bounds() const {
  return {coordinate_of(low), std::isinf(high) ? high : coordinate_of(high)};
}

double Prior::log_mass() const {
  if (!is_free()) return 0.0;
  const auto [from, to] = bounds();
  return log_normal_mass(from, to);
}

std::optional<Prior> read_prior(std::string_view text, const std::string& unit, std::string& fault) {
  return PriorReader(unit, fault).read(text);
}

std::string write_prior(const Prior& prior, const std::string& unit) {
  const std::string step = unit == "degC" ? "K" : unit;
  const auto in = [](double value, const std::string& example) { return write_quantity(value, example); };
  std::string text;
  switch (prior.kind) {
    case Prior::Kind::fixed:
      return fmt::format("fixed, {}", in(prior.centre, unit));
    case Prior::Kind::normal:
      text = fmt::format("normal, mean {}, sd {}", in(prior.centre, unit), in(prior.scale, step));
      break;
    case Prior::Kind::half_normal:
      text = fmt::format("half-normal, scale {}", in(prior.scale, step));
      break;
    case Prior::Kind::log_normal:
      text = fmt::format("log-normal, median {}, factor {}", in(prior.centre, unit), in(prior.scale, ""));
      break;
  }
  if (std::isfinite(prior.low) && std::isfinite(prior.high))
    text += fmt::format(", within {} to {}", in(prior.low, unit), in(prior.high, unit));
  return text;
}

double normal_probability(double z) {
  return 0.5 * std::erfc(-z / std::numbers::sqrt2);
}

double log_normal_mass(double low, double high) {
  if (low > high) return -std::numeric_limits<double>::infinity();
  if (low < 0.0 && high <= 0.0) return log_normal_mass(-high, -low);  // the far tail keeps its digits
  if (low < 0.0) return std::log1p(-std::exp(log_tail(high)) - std::exp(log_tail(-low)));
  const double near = log_tail(low);
  return std::isinf(high) ? near : near + std::log1p(-std::exp(log_tail(high) - near));
}

}  // namespace heddle::discover
