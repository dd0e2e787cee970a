#include "macroscale/input_text.h"

#include <algorithm>
#include <charconv>
#include <cmath>
#include <fstream>
#include <map>
#include <optional>
#include <sstream>
#include <string_view>
#include <system_error>
#include <vector>

#include <fmt/format.h>

namespace heddle::macroscale {
namespace {

/// OpenCASCADE reads some megabytes a second; a tool made of a hundred faces takes 0.1 MB.
constexpr std::uintmax_t largest_step = 64u << 20;

[[noreturn]] void refuse(RuleFamily id, const std::string& key, const std::filesystem::path& file, int line,
                         std::string rule, std::string way_out) {
  throw InputError(
      {{id.of(key), key + ".file", "", std::move(rule), std::move(way_out), file.string(), line}});
}

/// "#12=(LENGTH_UNIT()...)" without blanks, and where it starts.
struct Statement {
  std::string text;
  int line;
};

/// Statements that speak of units. Strings keep their blanks, comments are dropped.
std::vector<Statement> unit_statements(const std::string& text) {
  std::vector<Statement> found;
  Statement now{"", 0};
  int line = 1;
  bool in_string = false;
  for (std::size_t i = 0; i < text.size(); ++i) {
    const char c = text[i];
    line += c == '\n';
    if (!in_string && text.compare(i, 2, "/*") == 0) {
      const std::size_t end = std::min(text.find("*/", i + 2), text.size());
      line += static_cast<int>(
          std::count(text.begin() + static_cast<long>(i) + 1, text.begin() + static_cast<long>(end), '\n'));
      i = end + 1;
      continue;
    }
    if (c == '\'') in_string = !in_string;
    if (!in_string && c == ';') {
      if (now.text.find("UNIT") != std::string::npos) found.push_back(now);
      now = {"", 0};
      continue;
    }
    if (!in_string && static_cast<unsigned char>(c) <= ' ') continue;
    if (now.text.empty()) now.line = line;
    now.text += c;
  }
  return found;
}

/// The number after the first `opening`, for instance "LENGTH_MEASURE(".
std::optional<double> number_after(const std::string& text, std::string_view opening) {
  const std::size_t at = text.find(opening);
  if (at == std::string::npos) return std::nullopt;
  double value = 0.0;
  const char* first = text.data() + at + opening.size();
  const auto [end, error] = std::from_chars(first, text.data() + text.size(), value);
  return error == std::errc{} ? std::optional(value) : std::nullopt;
}

/// Numbers of the entities a text refers to, in order.
std::vector<long> references(std::string_view text) {
  std::vector<long> ids;
  for (std::size_t i = text.find('#'); i != std::string_view::npos; i = text.find('#', i + 1)) {
    long id = 0;
    if (std::from_chars(text.data() + i + 1, text.data() + text.size(), id).ec == std::errc{})
      ids.push_back(id);
  }
  return ids;
}

std::optional<double> si_length(const std::string& text) {
  static const std::map<std::string_view, double> prefixes{
      {"$", 1.0},        {".KILO.", 1e3},   {".HECTO.", 1e2},  {".DECA.", 1e1}, {".DECI.", 1e-1},
      {".CENTI.", 1e-2}, {".MILLI.", 1e-3}, {".MICRO.", 1e-6}, {".NANO.", 1e-9}};
  const std::size_t open = text.find("SI_UNIT("), comma = text.find(',', open), close = text.find(')', open);
  if (open == std::string::npos || comma == std::string::npos || close == std::string::npos)
    return std::nullopt;
  const auto prefix = prefixes.find(std::string_view(text).substr(open + 8, comma - open - 8));
  if (prefix == prefixes.end() || text.substr(comma + 1, close - comma - 1) != ".METRE.") return std::nullopt;
  return prefix->second;
}

class Units {
 public:
  explicit Units(const std::vector<Statement>& statements) {
    for (const Statement& s : statements) {
      const std::vector<long> ids = references(s.text);
      if (s.text.starts_with('#') && !ids.empty()) entities_.emplace(ids.front(), s);
    }
  }

  /// Length units the contexts assign: metres and line.
  std::vector<std::pair<double, int>> assigned() const {
    std::vector<std::pair<double, int>> lengths;
    for (const auto& [id, s] : entities_) {
      const std::size_t at = s.text.find("GLOBAL_UNIT_ASSIGNED_CONTEXT(");
      if (at == std::string::npos) continue;
      const std::size_t end = s.text.find("))", at);
      for (long unit : references(std::string_view(s.text).substr(at, end - at))) {
        if (const auto metres = length(unit)) lengths.emplace_back(*metres, entities_.at(unit).line);
      }
    }
    return lengths;
  }

 private:
  /// Metres of a unit entity, if it is a length.
  std::optional<double> length(long id) const {
    const auto it = entities_.find(id);
    if (it == entities_.end() || it->second.text.find("LENGTH_UNIT(") == std::string::npos)
      return std::nullopt;
    const std::string& text = it->second.text;
    const std::size_t conversion = text.find("CONVERSION_BASED_UNIT(");
    if (conversion == std::string::npos) return si_length(text);
    // CONVERSION_BASED_UNIT('INCH',#7), where #7=LENGTH_MEASURE_WITH_UNIT(LENGTH_MEASURE(25.4),#8)
    const std::vector<long> to = references(std::string_view(text).substr(conversion));
    const auto measure = to.empty() ? entities_.end() : entities_.find(to.front());
    if (measure == entities_.end()) return std::nullopt;
    const auto factor = number_after(measure->second.text, "LENGTH_MEASURE(");
    const std::vector<long> base = references(std::string_view(measure->second.text).substr(1));
    const auto unit = base.empty() ? entities_.end() : entities_.find(base.back());
    if (!factor || unit == entities_.end()) return std::nullopt;
    const auto metres = si_length(unit->second.text);
    return metres ? std::optional(*factor * *metres) : std::nullopt;
  }

  std::map<long, Statement> entities_;
};

bool same_length(double a, double b) {
  return std::abs(a - b) <= 1e-9 * std::abs(b);
}

}  // namespace

std::uintmax_t require_file(const std::filesystem::path& file, const std::string& key) {
  const auto refuse_path = [&](RuleFamily id, const char* rule, const char* way_out) {
    throw InputError({{id.of(key), key + ".file", file.string(), rule, way_out}});
  };
  std::error_code error;
  const auto status = std::filesystem::status(file, error);
  if (!std::filesystem::exists(status))
    refuse_path("*.file.missing"_family, "must be there; no such file",
                "Paths are taken from the folder of the case file.");
  if (!std::filesystem::is_regular_file(status))
    refuse_path("*.file.folder"_family, "must be a file", "Name the file itself.");
  const std::uintmax_t size = std::filesystem::file_size(file, error);
  if (error || !std::ifstream(file))
    refuse_path("*.file.unreadable"_family, "must be readable", "Check who may read it.");
  if (size == 0)
    refuse_path("*.file.empty"_family, "must not be empty; it holds 0 bytes", "Export it again.");
  return size;
}

std::string unit_name(double metres) {
  static const std::vector<std::pair<double, const char*>> names{
      {1.0, "m"}, {1e-1, "dm"}, {1e-2, "cm"}, {1e-3, "mm"}, {1e-6, "um"}, {0.0254, "in"}, {0.3048, "foot"}};
  for (const auto& [length, name] : names) {
    if (same_length(metres, length)) return name;
  }
  return fmt::format("{:g} m", metres);
}

void require_step(const std::filesystem::path& file, double length_unit, const std::string& key) {
  const std::uintmax_t size = require_file(file, key);
  if (size > largest_step) {
    refuse("*.file.size"_family, key, file, 0,
           fmt::format("must be a STEP file of at most {} MB; it has {}", largest_step >> 20, size >> 20),
           "Export only the faces that touch the blank, as surfaces and not as facets.");
  }
  std::ifstream stream(file, std::ios::binary);
  std::ostringstream buffer;
  buffer << stream.rdbuf();
  const std::string text = buffer.str();
  const std::size_t start = text.find_first_not_of(" \t\r\n");
  if (start == std::string::npos || text.compare(start, 13, "ISO-10303-21;") != 0) {
    refuse("*.file.format"_family, key, file, 1, "must start with ISO-10303-21; as STEP files do",
           "It is another kind of file: export the tool as STEP (AP203, AP214 or AP242).");
  }
  if (text.find("END-ISO-10303-21;") == std::string::npos) {
    refuse("*.file.cut_off"_family, key, file,
           static_cast<int>(std::count(text.begin(), text.end(), '\n')) + 1,
           "must end with END-ISO-10303-21;", "It was cut off: copy or export it again.");
  }
  const auto assigned = Units(unit_statements(text)).assigned();
  if (assigned.empty()) {
    refuse("*.file.unit"_family, key, file, 0,
           "must state its length unit (GLOBAL_UNIT_ASSIGNED_CONTEXT with a LENGTH_UNIT)",
           "Export it again with a unit.");
  }
  for (const auto& [metres, line] : assigned) {
    if (!same_length(metres, assigned.front().first)) {
      refuse("*.file.unit"_family, key, file, line,
             fmt::format("must state one length unit; it states {} and {}", unit_name(assigned.front().first),
                         unit_name(metres)),
             "Export the tool as one part.");
    }
  }
  const auto& [stated, line] = assigned.front();
  if (!same_length(stated, length_unit)) {
    throw InputError({{"*.length_unit.stated"_family.of(key), key + ".length_unit", unit_name(length_unit),
                       fmt::format("must be the unit that {} states: {} (its line {})",
                                   file.filename().string(), unit_name(stated), line),
                       fmt::format("Write length_unit: {}, or export the file in {}.", unit_name(stated),
                                   unit_name(length_unit))}});
  }
}

}  // namespace heddle::macroscale
