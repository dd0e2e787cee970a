#include "macroscale/outline_file.h"

#include <algorithm>
#include <array>
#include <cctype>
#include <charconv>
#include <cmath>
#include <cstddef>
#include <fstream>
#include <map>
#include <numbers>
#include <optional>
#include <string_view>
#include <system_error>
#include <utility>
#include <vector>

#include <fmt/format.h>

#include "macroscale/cad.h"
#include "macroscale/input_text.h"

namespace heddle::macroscale {
namespace {

constexpr double pi = std::numbers::pi;

/// A drawing of a blank takes some kilobytes.
constexpr std::uintmax_t largest_drawing = 64u << 20;

/// Points in order; `line` is where its entity stands in the file (0: no text).
struct Chain {
  Ring points;
  int line = 0;
};

class OutlineSource {
 public:
  OutlineSource(const OutlineFile& outline, const std::string& key) : outline_(outline), key_(key) {}
  [[noreturn]] void refuse(RuleFamily id, int line, std::string rule, std::string way_out) const {
    throw InputError({{id.of(key_), key_ + ".file", "", std::move(rule), std::move(way_out),
                       outline_.file.string(), line}});
  }
  const OutlineFile& outline() const { return outline_; }
  const std::string& key() const { return key_; }

 private:
  const OutlineFile& outline_;
  const std::string& key_;
};

/// One pair of a DXF file: a code on one line, its value on the next.
struct Group {
  int code;
  std::string value;
  int line;  ///< of the value
};

std::string_view trimmed(std::string_view text) {
  const std::size_t first = text.find_first_not_of(" \t\r");
  if (first == std::string_view::npos) return {};
  return text.substr(first, text.find_last_not_of(" \t\r") - first + 1);
}

template <class Number>
std::optional<Number> parse(std::string_view text) {
  if (text.starts_with('+')) text.remove_prefix(1);
  Number value{};
  const auto [end, error] = std::from_chars(text.data(), text.data() + text.size(), value);
  return error == std::errc{} && end == text.data() + text.size() ? std::optional(value) : std::nullopt;
}

std::vector<Group> read_groups(const OutlineSource& source) {
  std::ifstream stream(source.outline().file);
  std::vector<Group> groups;
  int line = 0;
  std::string code_text, value;
  bool ended = false;
  while (!ended && std::getline(stream, code_text)) {
    ++line;
    if (line == 1 && code_text.starts_with("AutoCAD Binary DXF"))
      source.refuse("*.file.binary"_family, 1, "must be a DXF file in text form; this one is binary",
                    "Save it as ASCII DXF.");
    const auto code = parse<int>(trimmed(code_text));
    if (!code) {
      source.refuse("*.file.format"_family, line,
                    fmt::format("must have a DXF group code (a whole number) here; it has `{}`",
                                code_text.substr(0, 40)),
                    "It is no DXF file, or a line is missing above: export it again.");
    }
    if (!std::getline(stream, value)) break;
    ++line;
    groups.push_back({*code, std::string(trimmed(value)), line});
    ended = *code == 0 && groups.back().value == "EOF";
  }
  if (!ended)
    source.refuse("*.file.cut_off"_family, line, "must end with EOF",
                  "It was cut off: copy or export it again.");
  return groups;
}

/// An entity: its name and groups.
struct Entity {
  std::string name;
  int line = 0;
  std::vector<Group> groups;

  std::optional<Group> find(int code) const {
    const auto it =
        std::find_if(groups.begin(), groups.end(), [&](const Group& g) { return g.code == code; });
    return it == groups.end() ? std::nullopt : std::optional(*it);
  }
};

class Drawing {
 public:
  explicit Drawing(const OutlineSource& source) : source_(source) {
    std::string section;
    std::vector<Group> groups = read_groups(source);
    for (std::size_t i = 0; i < groups.size(); ++i) {
      const Group& g = groups[i];
      if (g.code == 0 && g.value == "SECTION") {
        section = i + 1 < groups.size() && groups[i + 1].code == 2 ? groups[i + 1].value : "";
        ++i;
      } else if (g.code == 0 && g.value == "ENDSEC") {
        section.clear();
      } else if (section == "HEADER") {
        if (g.code == 9) variable_ = g.value;
        if (variable_ == "$INSUNITS" && g.code == 70) units_ = g;
      } else if (section == "ENTITIES" && g.code == 0) {
        entities_.push_back({g.value, g.line, {}});
      } else if (section == "ENTITIES" && !entities_.empty()) {
        entities_.back().groups.push_back(g);
      }
    }
  }

  const std::vector<Entity>& entities() const { return entities_; }

  /// Agreement with the stated unit, where the file states one.
  void require_unit() const {
    static const std::map<int, double> metres{{1, 0.0254}, {2, 0.3048}, {4, 1e-3}, {5, 1e-2},
                                              {6, 1.0},    {13, 1e-6},  {14, 0.1}};
    if (!units_) return;
    const auto code = parse<int>(units_->value);
    if (code && *code == 0) return;  // "unitless": the file says nothing
    const auto unit = code ? metres.find(*code) : metres.end();
    if (unit == metres.end()) {
      source_.refuse(
          "*.file.unit"_family, units_->line,
          fmt::format("must state a unit this reader knows in $INSUNITS; it has {}", units_->value),
          "1 inch, 2 foot, 4 mm, 5 cm, 6 m; 0 says nothing.");
    }
    const double stated = source_.outline().length_unit;
    if (std::abs(stated - unit->second) <= 1e-9 * unit->second) return;
    const std::string name = source_.outline().file.filename().string();
    throw InputError(
        {{"*.length_unit.stated"_family.of(source_.key()), source_.key() + ".length_unit", unit_name(stated),
          fmt::format("must be the unit that {} states: {} ($INSUNITS, its line {})", name,
                      unit_name(unit->second), units_->line),
          fmt::format("Write length_unit: {}, or export the file in {}.", unit_name(unit->second),
                      unit_name(stated))}});
  }

 private:
  const OutlineSource& source_;
  std::string variable_;
  std::optional<Group> units_;
  std::vector<Entity> entities_;
};

/// Turns entities into chains, in metres.
class Tracer {
 public:
  explicit Tracer(const OutlineSource& source) : source_(source) {}

  std::vector<Chain> trace(const std::vector<Entity>& entities) {
    for (std::size_t i = 0; i < entities.size(); ++i) {
      const Entity& e = entities[i];
      if (whole(e, 67, 0) == 1) continue;  // paper space
      if (e.name == "LINE") {
        add({{number(e, 10), number(e, 20)}, {number(e, 11), number(e, 21)}}, e, false);
      } else if (e.name == "CIRCLE") {
        const Point2 centre{number(e, 10), number(e, 20)};
        const double radius = radius_of(e);
        Ring points = arc(centre, radius, 0.0, 2.0 * pi);
        points.pop_back();
        add(std::move(points), e, true);
      } else if (e.name == "ARC") {
        const double from = number(e, 50) * pi / 180.0;
        double to = number(e, 51) * pi / 180.0;
        while (to <= from) to += 2.0 * pi;
        add(arc({number(e, 10), number(e, 20)}, radius_of(e), from, to), e, false);
      } else if (e.name == "LWPOLYLINE") {
        light_polyline(e);
      } else if (e.name == "POLYLINE") {
        i = polyline(entities, i);
      } else if (!passed_over(e.name)) {
        source_.refuse(
            "*.file.entity"_family, e.line,
            fmt::format("must consist of LINE, ARC, CIRCLE, LWPOLYLINE and POLYLINE; here stands {}", e.name),
            "Explode blocks and turn curves into arcs or polylines in the drawing program.");
      }
    }
    return std::move(chains_);
  }

 private:
  struct Corner {
    Point2 p;
    double bulge;  ///< tan of a quarter of the arc's angle to the next corner, counter-clockwise positive
  };

  static bool passed_over(const std::string& name) {
    static const std::array<const char*, 9> names{"TEXT",  "MTEXT",    "DIMENSION", "LEADER",   "MULTILEADER",
                                                  "POINT", "VIEWPORT", "ATTDEF",    "TOLERANCE"};
    return std::find(names.begin(), names.end(), name) != names.end();
  }

  double value(const Group& g) const {
    const auto number = parse<double>(g.value);
    if (!number || !std::isfinite(*number)) {
      source_.refuse("*.file.number"_family, g.line,
                     fmt::format("must have a finite number here; it has `{}`", g.value.substr(0, 40)),
                     "Export the drawing again.");
    }
    return *number;
  }

  double number(const Entity& e, int code) const {
    const auto g = e.find(code);
    if (!g)
      source_.refuse("*.file.group"_family, e.line,
                     fmt::format("must have group {} in each {}", code, e.name), "Export the drawing again.");
    return value(*g);
  }

  double number(const Entity& e, int code, double otherwise) const {
    const auto g = e.find(code);
    return g ? value(*g) : otherwise;
  }

  int whole(const Entity& e, int code, int otherwise) const {
    const auto g = e.find(code);
    return g ? static_cast<int>(std::lround(value(*g))) : otherwise;
  }

  double radius_of(const Entity& e) const {
    const double radius = number(e, 40);
    if (!(radius > 0.0))
      source_.refuse("*.file.radius"_family, e.line,
                     fmt::format("must have a positive radius; this {} has {}", e.name, radius),
                     "Delete or correct it.");
    return radius;
  }

  /// Points from one angle to the other, both ends included [drawing units].
  Ring arc(const Point2& centre, double radius, double from, double to) const {
    const double error = source_.outline().chord_error / source_.outline().length_unit;
    const double step = 2.0 * std::acos(std::max(0.0, 1.0 - error / radius));  // a quarter turn at most half
    const double wanted = std::ceil(std::abs(to - from) / step);
    const int n = std::max(std::abs(to - from) > pi ? 8 : 2, static_cast<int>(std::min(wanted, 1e5)));
    Ring points;
    for (int i = 0; i <= n; ++i) {
      const double angle = from + (to - from) * i / n;
      points.push_back({centre[0] + radius * std::cos(angle), centre[1] + radius * std::sin(angle)});
    }
    return points;
  }

  /// Points along corners with bulges; a closed one comes back to its first point, which is not repeated.
  Ring along(const std::vector<Corner>& corners, bool closed) const {
    Ring points;
    const std::size_t n = corners.size();
    for (std::size_t i = 0; i < n; ++i) {
      points.push_back(corners[i].p);
      if (corners[i].bulge == 0.0 || (i + 1 == n && !closed)) continue;
      const Point2 &a = corners[i].p, &b = corners[(i + 1) % n].p;
      const double half_angle = 2.0 * std::atan(corners[i].bulge),
                   chord = std::hypot(b[0] - a[0], b[1] - a[1]);
      if (chord == 0.0) continue;
      const double radius = 0.5 * chord / std::abs(std::sin(half_angle));
      // The centre lies to the left of a -> b for a counter-clockwise arc below half a turn.
      const double height = 0.5 * chord / std::tan(half_angle);
      const Point2 centre{0.5 * (a[0] + b[0]) - height * (b[1] - a[1]) / chord,
                          0.5 * (a[1] + b[1]) + height * (b[0] - a[0]) / chord};
      const double from = std::atan2(a[1] - centre[1], a[0] - centre[0]);
      const Ring inner = arc(centre, radius, from, from + 2.0 * half_angle);
      points.insert(points.end(), inner.begin() + 1, inner.end() - 1);  // both ends are corners as written
    }
    return points;
  }

  void light_polyline(const Entity& e) {
    std::vector<Corner> corners;
    for (std::size_t i = 0; i < e.groups.size(); ++i) {
      const Group& g = e.groups[i];
      if (g.code == 10) corners.push_back({{value(g), 0.0}, 0.0});
      if (corners.empty()) continue;
      if (g.code == 20) corners.back().p[1] = value(g);
      if (g.code == 42) corners.back().bulge = value(g);
    }
    add_polyline(corners, e);
  }

  /// POLYLINE, its VERTEX entities, SEQEND; the index of the last of them.
  std::size_t polyline(const std::vector<Entity>& entities, std::size_t i) {
    const Entity& head = entities[i];
    const int flags = whole(head, 70, 0);
    if ((flags & ~(1 | 128)) != 0) {
      source_.refuse(
          "*.file.polyline"_family, head.line,
          fmt::format(
              "must have flat polylines of lines and arcs; this one has flags {} (3D, mesh or fitted)",
              flags),
          "Flatten it in the drawing program.");
    }
    std::vector<Corner> corners;
    for (++i; i < entities.size() && entities[i].name == "VERTEX"; ++i)
      corners.push_back({{number(entities[i], 10), number(entities[i], 20)}, number(entities[i], 42, 0.0)});
    if (i >= entities.size() || entities[i].name != "SEQEND")
      source_.refuse("*.file.polyline"_family, head.line, "must end each POLYLINE with SEQEND",
                     "Export the drawing again.");
    add_polyline(corners, head);
    return i;
  }

  void add_polyline(std::vector<Corner> corners, const Entity& e) {
    bool closed = (whole(e, 70, 0) & 1) != 0;
    if (corners.size() > 1 && corners.front().p == corners.back().p) {
      corners.pop_back();
      closed = true;
    }
    if (corners.size() < 2)
      source_.refuse("*.file.polyline"_family, e.line,
                     fmt::format("must have two points or more a polyline; this one has {}", corners.size()),
                     "Delete it.");
    add(along(corners, closed), e, closed);
  }

  void add(Ring points, const Entity& e, bool closed) {
    // The plane an entity is drawn in (group 210 ff.): up, or down, which mirrors x; LINE stands in world
    // axes.
    const std::array<double, 3> up{number(e, 210, 0.0), number(e, 220, 0.0), number(e, 230, 1.0)};
    if (std::abs(up[0]) > 1e-9 || std::abs(up[1]) > 1e-9 || up[2] == 0.0)
      source_.refuse("*.file.plane"_family, e.line,
                     fmt::format("must be drawn in the xy plane; this {} is not", e.name),
                     "Rotate the drawing into the xy plane.");
    const double mirror = up[2] < 0.0 && e.name != "LINE" ? -1.0 : 1.0;
    const double unit = source_.outline().length_unit;
    for (Point2& p : points) p = {mirror * unit * p[0], unit * p[1]};
    if (closed) points.push_back(points.front());
    chains_.push_back({std::move(points), e.line});
  }

  const OutlineSource& source_;
  std::vector<Chain> chains_;
};

std::string in_mm(const Point2& p) {
  return fmt::format("({:.6g}, {:.6g}) mm", 1e3 * p[0] + 0.0, 1e3 * p[1] + 0.0);
}

double distance(const Point2& a, const Point2& b) {
  return std::hypot(a[0] - b[0], a[1] - b[1]);
}

double extent(const std::vector<Chain>& chains) {
  Point2 low = chains.front().points.front(), high = low;
  for (const Chain& chain : chains) {
    for (const Point2& p : chain.points) {
      for (int c = 0; c < 2; ++c) {
        low[c] = std::min(low[c], p[c]);
        high[c] = std::max(high[c], p[c]);
      }
    }
  }
  return distance(low, high);
}

/// Chains joined end to end into rings; the first chain of a ring gives its line.
std::vector<Ring> join(std::vector<Chain> chains, const OutlineSource& source) {
  const double tolerance = 1e-6 * extent(chains);
  std::vector<char> used(chains.size(), 0);
  std::vector<Ring> rings;
  for (std::size_t first = 0; first < chains.size(); ++first) {
    if (used[first]) continue;
    used[first] = 1;
    Ring ring = chains[first].points;
    while (distance(ring.front(), ring.back()) > tolerance || ring.size() < 3) {
      int next = -1, candidates = 0;
      bool reversed = false;
      double nearest = INFINITY;
      for (std::size_t i = 0; i < chains.size(); ++i) {
        if (used[i]) continue;
        for (bool backwards : {false, true}) {
          const double gap =
              distance(ring.back(), backwards ? chains[i].points.back() : chains[i].points.front());
          nearest = std::min(nearest, gap);
          if (gap > tolerance) continue;
          ++candidates;
          next = static_cast<int>(i);
          reversed = backwards;
        }
      }
      if (candidates == 0) {
        nearest = std::min(nearest, ring.size() > 2 ? distance(ring.front(), ring.back()) : INFINITY);
        source.refuse("*.file.open"_family, chains[first].line,
                      fmt::format("must have closed borders; one ends at {}{}", in_mm(ring.back()),
                                  std::isfinite(nearest)
                                      ? fmt::format(", {:.3g} mm from the nearest other end", 1e3 * nearest)
                                      : ""),
                      "Close the gap in the drawing; ends count as one within a millionth of its extent.");
      }
      if (candidates > 1) {
        source.refuse("*.file.branch"_family, chains[static_cast<std::size_t>(next)].line,
                      fmt::format("must have borders without branches; {} lines go on from {}", candidates,
                                  in_mm(ring.back())),
                      "Delete construction lines and lines drawn twice.");
      }
      used[next] = 1;
      Ring& more = chains[next].points;
      if (reversed) std::reverse(more.begin(), more.end());
      ring.insert(ring.end(), more.begin() + 1, more.end());
    }
    ring.pop_back();
    rings.push_back(std::move(ring));
  }
  return rings;
}

Outline sorted_rings(std::vector<Ring> rings) {
  const auto size = [](const Ring& ring) { return std::abs(area(polygon(ring))); };
  const auto largest = std::max_element(rings.begin(), rings.end(),
                                        [&](const Ring& a, const Ring& b) { return size(a) < size(b); });
  std::iter_swap(rings.begin(), largest);
  Ring outer = std::move(rings.front());
  rings.erase(rings.begin());
  return polygon(std::move(outer), std::move(rings));
}

std::vector<Chain> dxf_chains(const OutlineSource& source) {
  if (std::filesystem::file_size(source.outline().file) > largest_drawing)
    source.refuse("*.file.size"_family, 0, fmt::format("must have at most {} MB", largest_drawing >> 20),
                  "Export the blank's border alone.");
  const Drawing drawing(source);
  drawing.require_unit();
  return Tracer(source).trace(drawing.entities());
}

std::vector<Chain> step_chains(const OutlineSource& source) {
  const OutlineFile& outline = source.outline();
  require_step(outline.file, outline.length_unit, source.key());
  std::vector<Chain> chains;
  try {
    for (Polyline& line : step_face_curves(outline.file, outline.chord_error))
      chains.push_back({std::move(line), 0});
  } catch (const CadError& error) {
    source.refuse("*.file.cad"_family, 0, error.what(), error.way_out());
  }
  return chains;
}

}  // namespace

Outline read_outline(const OutlineFile& outline, const std::string& key) {
  const OutlineSource source(outline, key);
  const auto demand = [&](bool holds, const char* name, double value, const char* way_out) {
    const std::string of = key + "." + name;
    if (!holds)
      throw InputError({{"*.range"_family.of(of), of, fmt::format("{:g}", value), "must be > 0", way_out}});
  };
  demand(std::isfinite(outline.length_unit) && outline.length_unit > 0.0, "length_unit", outline.length_unit,
         "mm for most drawings.");
  demand(std::isfinite(outline.chord_error) && outline.chord_error > 0.0, "chord_error", outline.chord_error,
         "0.01 mm suits a blank of 0.3 m.");
  std::string extension = outline.file.extension().string();
  std::transform(extension.begin(), extension.end(), extension.begin(),
                 [](unsigned char c) { return static_cast<char>(std::tolower(c)); });
  const bool dxf = extension == ".dxf";
  if (!dxf && extension != ".step" && extension != ".stp") {
    throw InputError({{"*.file.type"_family.of(key), key + ".file", outline.file.string(),
                       "must end with .dxf, .step or .stp",
                       "Export the blank's border as ASCII DXF, or its flat face as STEP."}});
  }
  require_file(outline.file, key);
  std::vector<Chain> chains = dxf ? dxf_chains(source) : step_chains(source);
  if (chains.empty())
    source.refuse("*.file.no_border"_family, 0,
                  "must hold a closed border in its ENTITIES section; it holds none",
                  "Draw the blank in model space.");
  Outline result = sorted_rings(join(std::move(chains), source));
  Problems problems = check(result, key);
  for (Problem& problem : problems) problem.file = outline.file.string();
  if (!problems.empty()) throw InputError(std::move(problems));
  return result;
}

}  // namespace heddle::macroscale
