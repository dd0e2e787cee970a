#include "pipeline/json_text.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <nlohmann/json.hpp>

#include "pipeline/outputs.h"

namespace heddle::pipeline {

namespace {

using Json = nlohmann::ordered_json;

/// A whole double keeps its point, so that readers see a real number and "-0.0" keeps its sign.
std::string real_text(double value, const std::string& place) {
  if (!std::isfinite(value)) throw OutputError(fmt::format("{} is {}, not a number to write", place, value));
  std::string text = shortest(value);
  if (text.find_first_of(".e") == std::string::npos) text += ".0";
  return text;
}

bool is_plain(const Json& array) {
  return std::none_of(array.begin(), array.end(), [](const Json& entry) { return entry.is_structured(); });
}

/// JSON as text: an object has a line for each key, a list of numbers stays on one line.
std::string text_of(const Json& node, const std::string& place, int depth) {
  if (node.is_number_float()) return real_text(node.get<double>(), place);
  if (!node.is_structured()) return node.dump();
  const bool object = node.is_object();
  const bool broken = object || !is_plain(node);
  const std::string indent = broken ? "\n" + std::string(2 * (static_cast<std::size_t>(depth) + 1), ' ') : "";
  std::string out = object ? "{" : "[";
  std::size_t i = 0;
  for (const auto& [key, value] : node.items()) {
    if (i++ > 0) out += broken ? "," : ", ";
    const std::string inner = (place.empty() ? "" : place + ".") + key;
    out += indent + (object ? Json(key).dump() + ": " : "") + text_of(value, inner, depth + 1);
  }
  if (broken && i > 0) out += "\n" + std::string(2 * static_cast<std::size_t>(depth), ' ');
  return out + (object ? "}" : "]");
}

}  // namespace

std::string file_text(const Json& root) {
  return text_of(root, "", 0) + "\n";
}

}  // namespace heddle::pipeline
