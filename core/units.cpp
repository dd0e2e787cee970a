#include "core/units.h"

#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <charconv>
#include <cmath>
#include <cstdlib>
#include <numbers>
#include <optional>

namespace heddle {
namespace {

/// Unit as dimension and size: one of it is `factor` * 10^`power_of_ten` in SI.
struct Unit {
  Dimension dimension;
  int power_of_ten = 0;
  double factor = 1.0;  ///< 1 for every decimal unit
};

struct Symbol {
  std::string_view name;
  Unit unit;
};

constexpr Dimension mass{.mass = 1};
constexpr Dimension length{.length = 1};
constexpr Dimension duration{.time = 1};
constexpr Dimension temperature{.temperature = 1};
constexpr Dimension angle{.angle = 1};
constexpr Dimension amount{.amount = 1};
constexpr Dimension force{.mass = 1, .length = 1, .time = -2};
constexpr Dimension pressure{.mass = 1, .length = -1, .time = -2};
constexpr Dimension energy{.mass = 1, .length = 2, .time = -2};
constexpr Dimension power{.mass = 1, .length = 2, .time = -3};
constexpr Dimension linear_density{.mass = 1, .length = -1};

constexpr std::array symbols{
    Symbol{"kg", {mass, 0}},
    Symbol{"g", {mass, -3}},
    Symbol{"mg", {mass, -6}},
    Symbol{"t", {mass, 3}},
    Symbol{"m", {length, 0}},
    Symbol{"km", {length, 3}},
    Symbol{"cm", {length, -2}},
    Symbol{"mm", {length, -3}},
    Symbol{"um", {length, -6}},
    Symbol{"in", {length, -4, 254.0}},
    Symbol{"s", {duration, 0}},
    Symbol{"ms", {duration, -3}},
    Symbol{"us", {duration, -6}},
    Symbol{"min", {duration, 0, 60.0}},
    Symbol{"h", {duration, 0, 3600.0}},
    Symbol{"K", {temperature, 0}},
    Symbol{"rad", {angle, 0}},
    Symbol{"mrad", {angle, -3}},
    Symbol{"deg", {angle, 0, std::numbers::pi / 180.0}},
    Symbol{"mol", {amount, 0}},
    Symbol{"N", {force, 0}},
    Symbol{"mN", {force, -3}},
    Symbol{"kN", {force, 3}},
    Symbol{"MN", {force, 6}},
    Symbol{"Pa", {pressure, 0}},
    Symbol{"kPa", {pressure, 3}},
    Symbol{"MPa", {pressure, 6}},
    Symbol{"GPa", {pressure, 9}},
    Symbol{"bar", {pressure, 5}},
    Symbol{"mbar", {pressure, 2}},
    Symbol{"J", {energy, 0}},
    Symbol{"mJ", {energy, -3}},
    Symbol{"kJ", {energy, 3}},
    Symbol{"MJ", {energy, 6}},
    Symbol{"W", {power, 0}},
    Symbol{"mW", {power, -3}},
    Symbol{"kW", {power, 3}},
    Symbol{"Hz", {Dimension{.time = -1}, 0}},
    Symbol{"tex", {linear_density, -6}},
    Symbol{"dtex", {linear_density, -7}},
};

struct NamedDimension {
  std::string_view name;
  std::string_view unit;  ///< in SI
  Dimension dimension;
};

constexpr std::array named_dimensions{
    NamedDimension{"a length", "m", length},
    NamedDimension{"an area", "m^2", {.length = 2}},
    NamedDimension{"a mass", "kg", mass},
    NamedDimension{"a time", "s", duration},
    NamedDimension{"a temperature difference", "K", temperature},
    NamedDimension{"an angle", "rad", angle},
    NamedDimension{"a force", "N", force},
    NamedDimension{"a pressure", "Pa", pressure},
    NamedDimension{"an energy", "J", energy},
    NamedDimension{"a power", "W", power},
    NamedDimension{"a speed", "m/s", {.length = 1, .time = -1}},
    NamedDimension{"a density", "kg/m^3", {.mass = 1, .length = -3}},
    NamedDimension{"a mass per length", "kg/m", linear_density},
    NamedDimension{"a mass per area", "kg/m^2", {.mass = 1, .length = -2}},
    NamedDimension{"a force per length", "N/m", {.mass = 1, .time = -2}},
    NamedDimension{"a rate", "1/s", {.time = -1}},
    NamedDimension{"a change per kelvin", "1/K", {.temperature = -1}},
    NamedDimension{"an energy per amount", "J/mol", {.mass = 1, .length = 2, .time = -2, .amount = -1}},
    NamedDimension{
        "a power-law consistency", "Pa s^n", {.mass = 1, .length = -1, .time = -2, .symbolic_time = 1}},
    NamedDimension{"a damping per area", "N s/m^3", {.mass = 1, .length = -2, .time = -1}},
};

struct UnitFault {
  std::string fault;
  std::string way_out;
};

/// Raised inside the parser only; read_quantity turns it into a Reading.
[[noreturn]] void refuse(std::string fault, std::string way_out) {
  throw UnitFault{std::move(fault), std::move(way_out)};
}

void multiply(Unit& product, const Unit& unit, int exponent) {
  product.dimension.mass += exponent * unit.dimension.mass;
  product.dimension.length += exponent * unit.dimension.length;
  product.dimension.time += exponent * unit.dimension.time;
  product.dimension.temperature += exponent * unit.dimension.temperature;
  product.dimension.angle += exponent * unit.dimension.angle;
  product.dimension.amount += exponent * unit.dimension.amount;
  product.dimension.symbolic_time += exponent * unit.dimension.symbolic_time;
  product.power_of_ten += exponent * unit.power_of_ten;
  for (int i = 0; i < std::abs(exponent); ++i) {
    product.factor = exponent > 0 ? product.factor * unit.factor : product.factor / unit.factor;
  }
}

constexpr int percent_power = -2;
constexpr const char* example_of_units =
    "Known are for instance mm, kg/m^3, N s/m^3, kPa, degC, deg, %, tex.";

bool is_letter(char c) {
  return (c >= 'a' && c <= 'z') || (c >= 'A' && c <= 'Z') || c == '%';
}
bool is_digit(char c) {
  return c >= '0' && c <= '9';
}

std::string_view trim(std::string_view text) {
  while (!text.empty() && (text.front() == ' ' || text.front() == '\t')) text.remove_prefix(1);
  while (!text.empty() && (text.back() == ' ' || text.back() == '\t')) text.remove_suffix(1);
  return text;
}

/// Recursive descent over
///     unit    = product [ "/" divisor ]
///     divisor = power | "(" product ")"
///     product = power { [ " " | "*" ] power }
///     power   = symbol [ "^" integer ] | "1" | "s^n"
/// One "/" only: a/b c and a/b/c mean different things to different readers (ISO 80000-1, 7.3.3).
/// degC and % have an offset or no dimension to multiply, so they stand alone and never reach this parser
/// rightly.
class UnitParser {
 public:
  explicit UnitParser(std::string_view text) : text_(text) {}

  Unit parse() {
    Unit unit = product();
    if (take('/')) {
      const bool bracket = take('(');
      const Unit divisor = bracket ? product() : symbol_to_a_power();
      if (bracket && !take(')'))
        refuse(fmt::format("has an open bracket in \"{}\"", text_), "Close it with \")\".");
      multiply(unit, divisor, -1);
    }
    skip_blanks();
    if (position_ < text_.size()) refuse_rest();
    return unit;
  }

 private:
  Unit product() {
    Unit unit = symbol_to_a_power();
    while (take('*') || at_letter()) multiply(unit, symbol_to_a_power(), 1);
    return unit;
  }

  Unit symbol_to_a_power() {
    if (take('1')) return {};
    skip_blanks();
    const std::string_view name = word();
    if (name.empty())
      refuse(fmt::format("has the unit \"{}\", which cannot be read", text_), example_of_units);
    const Unit base = look_up(name);
    if (!take('^')) return base;
    Unit unit;
    if (take('n')) {
      if (name != "s")
        refuse(fmt::format("has the power {}^n", name), "Only s^n may carry the power-law index n.");
      unit.dimension.symbolic_time = 1;
    } else {
      multiply(unit, base, whole_exponent(name));
    }
    return unit;
  }

  int whole_exponent(std::string_view name) {
    const int sign = take('-') ? -1 : 1;
    if (position_ >= text_.size() || !is_digit(text_[position_])) {
      refuse(fmt::format("has no whole number after {}^", name), "Write for instance m^2.");
    }
    return sign * (text_[position_++] - '0');  // no unit in use has a power of two digits
  }

  Unit look_up(std::string_view name) const {
    if (name == "%") refuse(fmt::format("has % inside the unit \"{}\"", text_), "Write the plain factor.");
    if (name == "degC") {
      refuse(fmt::format("has degC inside the unit \"{}\"", text_), "A temperature difference is in K.");
    }
    for (const Symbol& symbol : symbols) {
      if (symbol.name == name) return symbol.unit;
    }
    const bool degrees = name == "C" || name == "celsius" || name == "Celsius" || name == "Kelvin";
    refuse(fmt::format("has the unknown unit \"{}\"", name),
           degrees ? "Temperatures are in degC or K." : example_of_units);
  }

  [[noreturn]] void refuse_rest() const {
    const std::string_view rest = text_.substr(position_);
    if (is_digit(rest.front())) {
      refuse(fmt::format("has the unit \"{}\", which cannot be read at \"{}\"", text_, rest),
             "Powers are one digit after ^, as in m^2.");
    }
    if (rest.front() == '/' || is_letter(rest.front())) {
      refuse(fmt::format("has the unit \"{}\", which can be read in two ways", text_),
             "Use one \"/\" and brackets, as in W/(m K).");
    }
    refuse(fmt::format("has the unit \"{}\", which cannot be read at \"{}\"", text_, rest), example_of_units);
  }

  std::string_view word() {
    const std::size_t start = position_;
    while (position_ < text_.size() && is_letter(text_[position_])) ++position_;
    return text_.substr(start, position_ - start);
  }

  bool at_letter() {
    skip_blanks();
    return position_ < text_.size() && is_letter(text_[position_]);
  }

  bool take(char c) {
    skip_blanks();
    if (position_ >= text_.size() || text_[position_] != c) return false;
    ++position_;
    return true;
  }

  void skip_blanks() {
    while (position_ < text_.size() && text_[position_] == ' ') ++position_;
  }

  std::string_view text_;
  std::size_t position_ = 0;
};

/// The examples come from our own schema: one that cannot be read is our mistake.
Unit unit_of_example(std::string_view example) {
  if (example == "degC") return {temperature};
  if (example.empty() || example == "%") return {};
  return UnitParser(example).parse();
}

/// A decimal number in its written digits: `mantissa` * 10^`exponent`.
struct Decimal {
  std::string mantissa;  ///< "-9.27"
  int exponent = 0;
  int decimals() const {
    const std::size_t point = mantissa.find('.');
    return point == std::string::npos ? 0 : static_cast<int>(mantissa.size() - point - 1);
  }
};

struct NumberAndUnit {
  Decimal number;
  std::string_view digits;  ///< the number as written
  std::string_view unit;
};

[[noreturn]] void refuse_number(std::string_view text) {
  std::string lower(text);
  std::transform(lower.begin(), lower.end(), lower.begin(),
                 [](char c) { return c >= 'A' && c <= 'Z' ? static_cast<char>(c - 'A' + 'a') : c; });
  if (lower.find("nan") != std::string::npos || lower.find("inf") != std::string::npos) {
    refuse("is not finite", "Write a finite number.");
  }
  refuse("is not a number", "Write digits with a decimal point, as in 0.75 or -9.27e-4.");
}

std::size_t skip_digits(std::string_view text, std::size_t position) {
  while (position < text.size() && is_digit(text[position])) ++position;
  return position;
}

/// End of "e-4" at `position`, or `position` itself when there is no exponent.
std::size_t skip_exponent(std::string_view text, std::size_t position) {
  if (position >= text.size() || (text[position] != 'e' && text[position] != 'E')) return position;
  std::size_t digits = position + 1;
  if (digits < text.size() && (text[digits] == '+' || text[digits] == '-')) ++digits;
  const std::size_t end = skip_digits(text, digits);
  return end > digits ? end : position;
}

NumberAndUnit split(std::string_view text) {
  text = trim(text);
  const bool has_sign = !text.empty() && (text.front() == '+' || text.front() == '-');
  const std::size_t first = has_sign ? 1 : 0;
  std::size_t end = skip_digits(text, first);
  std::size_t digit_count = end - first;
  if (digit_count > 1 && text[first] == '0') {
    refuse("starts with a zero", "Some readers take it as octal; write it without leading zeros.");
  }
  if (end < text.size() && text[end] == '.') {
    const std::size_t after_point = end + 1;
    end = skip_digits(text, after_point);
    digit_count += end - after_point;
  }
  if (digit_count == 0) refuse_number(text);

  if (end + 1 < text.size() && text[end] == ',' && is_digit(text[end + 1])) {
    refuse("has a comma in its number",
           "The decimal sign is a point, as in 0.75; thousands are not separated.");
  }

  NumberAndUnit result;
  const std::size_t skip_plus = text.front() == '+' ? 1 : 0;
  result.number.mantissa = std::string(text.substr(skip_plus, end - skip_plus));
  const std::size_t exponent_end = skip_exponent(text, end);
  if (exponent_end > end) {
    const std::string exponent(text.substr(end + 1, std::min<std::size_t>(exponent_end - end - 1, 6)));
    result.number.exponent = std::atoi(exponent.c_str());
  }
  result.digits = text.substr(0, exponent_end);
  result.unit = trim(text.substr(exponent_end));
  return result;
}

/// The double nearest to mantissa * 10^(exponent + shift): one rounding in all.
double to_double(const Decimal& number, int shift = 0) {
  const std::string text = fmt::format("{}e{}", number.mantissa, number.exponent + shift);
  double value = 0.0;
  const auto [end, error] = std::from_chars(text.data(), text.data() + text.size(), value);
  const double zero_or_infinity = number.exponent + shift < 0 ? 0.0 : HUGE_VAL;
  if (error == std::errc::result_out_of_range) value = zero_or_infinity;
  if (!std::isfinite(value)) refuse("is not finite", "Write a finite number.");
  return value;
}

/// degC to K in decimal digits: the sum is written out with as many decimals as its parts have, then read
/// once, so that 85 degC has the bits of 358.15.
double celsius_to_kelvin(const Decimal& number) {
  const int decimals = std::clamp(number.decimals() - number.exponent, 2, 15);
  const long double sum =
      std::strtold(fmt::format("{}e{}", number.mantissa, number.exponent).c_str(), nullptr) + 273.15L;
  const std::string text = fmt::format("{:.{}f}", sum, decimals);
  return to_double({text, 0});
}

double read_plain_number(const NumberAndUnit& parts) {
  if (parts.unit == "%")
    refuse("has %, where a plain number is needed", "Write the factor itself, as in 0.6.");
  if (!parts.unit.empty()) {
    refuse(fmt::format("has the unit \"{}\", where a plain number is needed", parts.unit),
           "Leave the unit out.");
  }
  return to_double(parts.number);
}

double read_fraction(const NumberAndUnit& parts) {
  if (parts.unit.empty()) return to_double(parts.number);
  if (parts.unit == "%") return to_double(parts.number, percent_power);
  refuse(fmt::format("has the unit \"{}\", where a fraction is needed", parts.unit), "Write 60 % or 0.6.");
}

double read_with_unit(const NumberAndUnit& parts, std::string_view example) {
  const std::string wanted = dimension_name(example);
  if (parts.unit.empty()) {
    refuse(fmt::format("has no unit, where {} is needed", wanted),
           fmt::format("Write {} {}.", parts.digits, example));
  }
  if (parts.unit == "degC") {
    if (example == "degC") return celsius_to_kelvin(parts.number);
    refuse(
        fmt::format("has the unit degC, where {} is needed", wanted),
        example == "K" ? "A difference of 5 degC is written 5 K." : fmt::format("Write it in {}.", example));
  }
  if (parts.unit == "%") {
    refuse(fmt::format("has %, where {} is needed", wanted), fmt::format("Write it in {}.", example));
  }
  const Unit unit = UnitParser(parts.unit).parse();
  if (!(unit.dimension == unit_of_example(example).dimension)) {
    refuse(fmt::format("has the unit {}, where {} is needed", parts.unit, wanted),
           fmt::format("Write it in {}.", example));
  }
  const double value = to_double(parts.number, unit.power_of_ten);
  return unit.factor == 1.0 ? value : value * unit.factor;
}

/// The shortest decimal that reads back as `value`.
Decimal shortest_decimal(double value) {
  std::array<char, 64> buffer{};
  const auto result =
      std::to_chars(buffer.data(), buffer.data() + buffer.size(), value, std::chars_format::scientific);
  const std::string text(buffer.data(), result.ptr);
  const std::size_t e = text.find('e');
  return {text.substr(0, e), std::atoi(text.c_str() + e + 1)};
}

/// Digits with the point where a reader expects it: "0.75", "70", "1.5e-07". One digit stands before the
/// point of the mantissa.
std::string lay_out(const Decimal& number) {
  const bool negative = number.mantissa.front() == '-';
  std::string digits = number.mantissa.substr(negative ? 1 : 0);
  std::erase(digits, '.');
  const int exponent = number.exponent;
  const int count = static_cast<int>(digits.size());
  const std::string sign = negative ? "-" : "";
  if (exponent < -5 || exponent > 8) return fmt::format("{}e{}", number.mantissa, exponent);
  if (exponent < 0) return sign + "0." + std::string(static_cast<std::size_t>(-exponent - 1), '0') + digits;
  if (exponent + 1 >= count)
    return sign + digits + std::string(static_cast<std::size_t>(exponent + 1 - count), '0');
  return sign + digits.substr(0, exponent + 1) + "." + digits.substr(exponent + 1);
}

std::string join(const std::string& number, std::string_view unit) {
  return unit.empty() ? number : fmt::format("{} {}", number, unit);
}

/// In the example's own unit, not yet known to read back with the same bits.
std::string written_in_unit(double value, std::string_view example) {
  if (example == "degC") {
    std::string text = fmt::format("{:.9f}", value - 273.15);
    text.erase(text.find_last_not_of('0') + 1);
    if (text.back() == '.') text.pop_back();
    return join(text, example);
  }
  const Unit unit = unit_of_example(example);
  Decimal decimal = shortest_decimal(value / unit.factor);
  if (value != 0.0) decimal.exponent -= example == "%" ? percent_power : unit.power_of_ten;
  return join(lay_out(decimal), example);
}

}  // namespace

Reading read_quantity(std::string_view text, std::string_view example) {
  try {
    const NumberAndUnit parts = split(text);
    if (example.empty()) return {read_plain_number(parts), "", ""};
    if (example == "%") return {read_fraction(parts), "", ""};
    return {read_with_unit(parts, example), "", ""};
  } catch (const UnitFault& fault) {
    return {0.0, fault.fault, fault.way_out};
  }
}

std::string write_quantity(double value, std::string_view example) {
  const std::string text = written_in_unit(value, example);
  const Reading back = read_quantity(text, example);
  if (back.ok() && back.value == value) return text;
  return join(lay_out(shortest_decimal(value)), si_unit(example));
}

std::string si_unit(std::string_view example) {
  if (example.empty() || example == "%") return "";
  const Dimension dimension = unit_of_example(example).dimension;
  for (const NamedDimension& named : named_dimensions) {
    if (named.dimension == dimension) return std::string(named.unit);
  }
  std::string text;
  const auto append = [&](std::string_view symbol, int exponent) {
    if (exponent == 0) return;
    if (!text.empty()) text += " ";
    text += exponent == 1 ? std::string(symbol) : fmt::format("{}^{}", symbol, exponent);
  };
  append("kg", dimension.mass);
  append("m", dimension.length);
  append("s", dimension.time);
  append("K", dimension.temperature);
  append("rad", dimension.angle);
  append("mol", dimension.amount);
  if (dimension.symbolic_time == 1) append("s^n", 1);
  return text;
}

std::string dimension_name(std::string_view example) {
  if (example.empty()) return "a plain number";
  if (example == "%") return "a fraction";
  if (example == "degC") return "a temperature";
  const Dimension dimension = unit_of_example(example).dimension;
  for (const NamedDimension& named : named_dimensions) {
    if (named.dimension == dimension) return std::string(named.name);
  }
  return fmt::format("a quantity in {}", example);
}

}  // namespace heddle
