#include "macroscale/tool_file.h"

#include <algorithm>
#include <array>
#include <bit>
#include <charconv>
#include <cmath>
#include <cstdint>
#include <cstring>
#include <fstream>
#include <optional>
#include <string_view>
#include <system_error>
#include <unordered_map>
#include <vector>

#include <fmt/format.h>

#include "macroscale/cad.h"
#include "macroscale/input_text.h"
#include "macroscale/mesh_repair.h"

namespace heddle::macroscale {
namespace {

using Place = std::array<double, 3>;

/// File being read, for messages.
struct Source {
  const ToolFile& tool;
  const Expectation& expected;

  [[noreturn]] void refuse(RuleFamily id, int line, std::string rule, std::string way_out) const {
    throw InputError({{id.of(expected.key), expected.key + ".file", "", std::move(rule), std::move(way_out),
                       tool.file.string(), line}});
  }
  [[noreturn]] void refuse_count(std::uint64_t triangles, const char* more) const {
    refuse("*.file.triangles"_family, 0,
           fmt::format("must have at most {} triangles; it has {}{}", most_tool_triangles, more, triangles),
           "Coarsen it in the program that wrote it: 200000 triangles show a tool of half a metre to 1 mm.");
  }
};

/// Collects triangles, merging vertices that are equal in every bit (zero has one sign).
class Collector {
 public:
  int vertex(Place p) {
    for (double& x : p) x += 0.0;
    const auto [it, fresh] = number_.emplace(p, static_cast<int>(mesh_.vertices.size()));
    if (fresh) mesh_.vertices.push_back(p);
    return it->second;
  }
  void triangle(int a, int b, int c) { mesh_.triangles.push_back({a, b, c}); }
  std::size_t triangles() const { return mesh_.triangles.size(); }
  void reserve(std::size_t triangles) {
    mesh_.triangles.reserve(triangles);
    mesh_.vertices.reserve(triangles / 2 + 2);
    number_.reserve(triangles / 2 + 2);
  }
  TriangleMesh take() { return std::move(mesh_); }

 private:
  struct Hash {
    std::size_t operator()(const Place& p) const {
      std::uint64_t h = 0;
      for (double x : p) {
        h = (h ^ std::bit_cast<std::uint64_t>(x)) * 0x9E3779B97F4A7C15ULL;
        h ^= h >> 32;
      }
      return h;
    }
  };
  TriangleMesh mesh_;
  std::unordered_map<Place, int, Hash> number_;
};

/// Words of a line, lower case not assumed.
class Words {
 public:
  explicit Words(std::string_view line) : rest_(line) {}
  std::string_view next() {
    const std::size_t first = rest_.find_first_not_of(" \t\r");
    if (first == std::string_view::npos) return rest_ = {};
    const std::size_t last = std::min(rest_.find_first_of(" \t\r", first), rest_.size());
    const std::string_view word = rest_.substr(first, last - first);
    rest_.remove_prefix(last);
    return word;
  }

 private:
  std::string_view rest_;
};

/// Finite number, whole word.
std::optional<double> number(std::string_view word) {
  if (word.starts_with('+')) word.remove_prefix(1);
  double value = 0.0;
  const auto [end, error] = std::from_chars(word.data(), word.data() + word.size(), value);
  const bool whole = error == std::errc{} && end == word.data() + word.size() && !word.empty();
  return whole && std::isfinite(value) ? std::optional(value) : std::nullopt;
}

Place coordinates(Words& words, const Source& source, int line) {
  Place p{};
  for (double& x : p) {
    const std::string_view word = words.next();
    const auto value = number(word);
    if (!value) {
      source.refuse("*.file.number"_family, line,
                    fmt::format("must have three finite numbers here; it has `{}`", word.substr(0, 40)),
                    "The program that wrote it failed: export the tool again.");
    }
    x = *value;
  }
  return p;
}

bool same_word(std::string_view word, std::string_view lower) {
  return word.size() == lower.size() &&
         std::equal(word.begin(), word.end(), lower.begin(),
                    [](char a, char b) { return (a >= 'A' && a <= 'Z' ? a - 'A' + 'a' : a) == b; });
}

/// Lines that start with `word`; stops counting soon after `most`.
std::size_t count_lines(const std::filesystem::path& file, std::string_view word, std::size_t most) {
  std::ifstream stream(file, std::ios::binary);
  std::vector<char> block(1 << 20);
  std::size_t count = 0, matched = 0;  // matched: letters of the word seen on this line; npos: another line
  constexpr std::size_t other = static_cast<std::size_t>(-1);
  while (stream && count <= most) {
    stream.read(block.data(), static_cast<std::streamsize>(block.size()));
    const char* at = block.data();
    const char* const end = at + stream.gcount();
    while (at < end) {
      if (matched == other) {
        const void* line = std::memchr(at, '\n', static_cast<std::size_t>(end - at));
        if (line == nullptr) break;
        at = static_cast<const char*>(line) + 1;
        matched = 0;
        continue;
      }
      const char c = *at++;
      if (matched == word.size()) {
        count += c == ' ' || c == '\t';
        matched = c == '\n' ? 0 : other;
      } else if (c == word[matched] || c == word[matched] - 'a' + 'A') {
        ++matched;
      } else if (c == '\n') {
        matched = 0;
      } else if (matched > 0 || (c != ' ' && c != '\t')) {
        matched = other;
      }
    }
  }
  return count;
}

std::vector<char> first_bytes(const std::filesystem::path& file, std::size_t most) {
  std::ifstream stream(file, std::ios::binary);
  std::vector<char> bytes(most);
  stream.read(bytes.data(), static_cast<std::streamsize>(most));
  bytes.resize(static_cast<std::size_t>(stream.gcount()));
  return bytes;
}

bool looks_like_text(const std::vector<char>& bytes) {
  return std::none_of(bytes.begin(), bytes.end(),
                      [](char c) { return static_cast<unsigned char>(c) < 9 || (c > 13 && c < 32); });
}

TriangleMesh read_binary_stl(const Source& source, std::uint64_t count) {
  Collector collector;
  collector.reserve(count);
  std::ifstream stream(source.tool.file, std::ios::binary);
  stream.seekg(84);
  constexpr std::size_t record = 50;  // normal, three corners, two bytes of attributes
  std::vector<char> block(record * 4096);
  std::uint64_t done = 0;
  while (done < count) {
    const std::uint64_t n = std::min<std::uint64_t>(4096, count - done);
    stream.read(block.data(), static_cast<std::streamsize>(n * record));
    if (static_cast<std::uint64_t>(stream.gcount()) != n * record)
      source.refuse("*.file.cut_off"_family, 0, "must be readable to its end", "Copy it again.");
    for (std::uint64_t i = 0; i < n; ++i) {
      std::array<float, 9> values;
      std::memcpy(values.data(), &block[i * record + 12], sizeof values);
      std::array<int, 3> corner{};
      for (int k = 0; k < 3; ++k) {
        const Place p{values[3 * k], values[3 * k + 1], values[3 * k + 2]};
        if (!std::isfinite(p[0]) || !std::isfinite(p[1]) || !std::isfinite(p[2])) {
          source.refuse("*.file.number"_family, 0,
                        fmt::format("must have finite numbers; triangle {} has ({}, {}, {})", done + i + 1,
                                    p[0], p[1], p[2]),
                        "The program that wrote it failed: export the tool again.");
        }
        corner[k] = collector.vertex(p);
      }
      collector.triangle(corner[0], corner[1], corner[2]);
    }
    done += n;
  }
  return collector.take();
}

TriangleMesh read_text_stl(const Source& source) {
  const std::size_t count = count_lines(source.tool.file, "facet", most_tool_triangles);
  if (count > most_tool_triangles) source.refuse_count(most_tool_triangles, "more than ");
  Collector collector;
  collector.reserve(count);
  std::ifstream stream(source.tool.file);
  std::vector<int> corners;
  bool ended = false;
  int line = 0;
  for (std::string text; std::getline(stream, text);) {
    ++line;
    Words words(text);
    const std::string_view word = words.next();
    if (same_word(word, "vertex")) {
      corners.push_back(collector.vertex(coordinates(words, source, line)));
    } else if (same_word(word, "endfacet")) {
      if (corners.size() != 3) {
        source.refuse("*.file.facet"_family, line,
                      fmt::format("must have three corners a facet; this one has {}", corners.size()),
                      "STL holds triangles only: export the tool again.");
      }
      collector.triangle(corners[0], corners[1], corners[2]);
      corners.clear();
    } else if (same_word(word, "endsolid")) {
      ended = true;
    } else if (same_word(word, "solid")) {
      ended = false;
    } else if (!word.empty() && !same_word(word, "facet") && !same_word(word, "outer") &&
               !same_word(word, "endloop")) {
      source.refuse("*.file.format"_family, line,
                    fmt::format("must have a word of the STL format here; it has `{}`", word.substr(0, 40)),
                    "Words are solid, facet, outer, vertex, endloop, endfacet, endsolid.");
    }
  }
  if (!ended)
    source.refuse("*.file.cut_off"_family, line, "must end with endsolid",
                  "It was cut off: copy or export it again.");
  return collector.take();
}

TriangleMesh read_stl(const Source& source, std::uint64_t size) {
  const std::vector<char> head = first_bytes(source.tool.file, 1024);
  if (head.size() >= 84) {
    std::uint32_t count = 0;
    std::memcpy(&count, &head[80], sizeof count);  // little endian, as the machines this runs on
    const std::uint64_t needed = 84 + 50 * static_cast<std::uint64_t>(count);
    if (size == needed && !looks_like_text(head)) {
      if (count > most_tool_triangles) source.refuse_count(count, "");
      return read_binary_stl(source, count);
    }
    if (!looks_like_text(head)) {
      source.refuse("*.file.cut_off"_family, 0,
                    fmt::format("must have {} bytes for the {} triangles that its header promises; it has {}",
                                needed, count, size),
                    "It was cut off, or is no STL file: copy or export it again.");
    }
  }
  Words words(std::string_view(head.data(), head.size()));
  if (!looks_like_text(head) || !same_word(words.next().substr(0, 5), "solid"))
    source.refuse("*.file.format"_family, 1, "must be an STL file: text that starts with solid, or binary",
                  "Export the tool again.");
  return read_text_stl(source);
}

/// Newell's normal of triangle (a, b, c).
Place normal(const Place& a, const Place& b, const Place& c) {
  const Place u{b[0] - a[0], b[1] - a[1], b[2] - a[2]}, v{c[0] - a[0], c[1] - a[1], c[2] - a[2]};
  return {u[1] * v[2] - u[2] * v[1], u[2] * v[0] - u[0] * v[2], u[0] * v[1] - u[1] * v[0]};
}

double dot(const Place& a, const Place& b) {
  return a[0] * b[0] + a[1] * b[1] + a[2] * b[2];
}

/// Whether a fan from the first corner covers a polygon once: every corner turns the same way.
bool convex(const std::vector<Place>& corners) {
  const std::size_t n = corners.size();
  Place sum{};
  for (std::size_t i = 1; i + 1 < n; ++i) {
    const Place part = normal(corners[0], corners[i], corners[i + 1]);
    for (int c = 0; c < 3; ++c) sum[c] += part[c];
  }
  const double tolerance = 1e-9 * dot(sum, sum);
  for (std::size_t i = 0; i < n; ++i) {
    if (dot(normal(corners[i], corners[(i + 1) % n], corners[(i + 2) % n]), sum) < -tolerance) return false;
  }
  return true;
}

/// Position of an OBJ index ("7", "7/1/2", "-1") among `count` vertices so far.
std::optional<std::size_t> obj_index(std::string_view word, std::size_t count) {
  const std::string_view digits = word.substr(0, word.find('/'));
  long long index = 0;
  const auto [end, error] = std::from_chars(digits.data(), digits.data() + digits.size(), index);
  if (error != std::errc{} || end != digits.data() + digits.size()) return std::nullopt;
  const long long position = index < 0 ? static_cast<long long>(count) + index : index - 1;
  if (index == 0 || position < 0 || position >= static_cast<long long>(count)) return std::nullopt;
  return static_cast<std::size_t>(position);
}

TriangleMesh read_obj(const Source& source) {
  if (!looks_like_text(first_bytes(source.tool.file, 1024)))
    source.refuse("*.file.format"_family, 1, "must be text", "It is no OBJ file: export the tool again.");
  const std::size_t count = count_lines(source.tool.file, "f", most_tool_triangles);
  if (count > most_tool_triangles) source.refuse_count(most_tool_triangles, "more than ");
  Collector collector;
  collector.reserve(count);
  std::vector<Place> vertices;
  std::vector<int> merged;
  std::ifstream stream(source.tool.file);
  int line = 0;
  std::vector<int> face;
  std::vector<Place> corners;
  for (std::string text; std::getline(stream, text);) {
    ++line;
    Words words(text);
    const std::string_view word = words.next();
    if (word == "v") {
      vertices.push_back(coordinates(words, source, line));
      merged.push_back(collector.vertex(vertices.back()));
    } else if (word == "f") {
      face.clear();
      corners.clear();
      for (std::string_view corner = words.next(); !corner.empty(); corner = words.next()) {
        const auto index = obj_index(corner, vertices.size());
        if (!index) {
          source.refuse("*.file.index"_family, line,
                        fmt::format("must name one of the {} vertices above; it names `{}`", vertices.size(),
                                    corner.substr(0, 40)),
                        "Vertices count from 1, backwards from -1, and stand before the faces.");
        }
        face.push_back(merged[*index]);
        corners.push_back(vertices[*index]);
      }
      if (face.size() < 3)
        source.refuse("*.file.face"_family, line,
                      fmt::format("must have at least three corners a face; this one has {}", face.size()),
                      "Export the tool again.");
      if (face.size() > 3 && !convex(corners))
        source.refuse("*.file.convex"_family, line,
                      fmt::format("must have convex faces; this one of {} corners is not", face.size()),
                      "Export the tool as triangles.");
      for (std::size_t i = 1; i + 1 < face.size(); ++i) collector.triangle(face[0], face[i], face[i + 1]);
      if (collector.triangles() > most_tool_triangles) source.refuse_count(most_tool_triangles, "more than ");
    } else if (word == "curv" || word == "surf" || word == "cstype") {
      source.refuse("*.file.free_form"_family, line,
                    fmt::format("must consist of flat faces; `{}` is a free-form surface", word),
                    "Export the tool as triangles, or as STEP.");
    } else if (!word.empty() && word[0] != '#') {
      static const std::array<std::string_view, 12> ignored{"vn",     "vt",     "vp", "g", "o",   "s",
                                                            "mtllib", "usemtl", "l",  "p", "lod", "mg"};
      if (std::find(ignored.begin(), ignored.end(), word) == ignored.end())
        source.refuse("*.file.format"_family, line,
                      fmt::format("must have a word of the OBJ format here; it has `{}`", word.substr(0, 40)),
                      "Words read are v and f; normals, textures, groups and materials are skipped.");
    }
  }
  return collector.take();
}

struct Extent {
  Place low, high;
  double extent(int c) const { return high[c] - low[c]; }
  double largest() const { return std::max({extent(0), extent(1), extent(2)}); }
};

Extent box_of(const TriangleMesh& mesh) {
  Extent box{mesh.vertices.front(), mesh.vertices.front()};
  for (const Place& p : mesh.vertices) {
    for (int c = 0; c < 3; ++c) {
      box.low[c] = std::min(box.low[c], p[c]);
      box.high[c] = std::max(box.high[c], p[c]);
    }
  }
  return box;
}

std::string extents(const Extent& box, double factor) {
  return fmt::format("{:.4g} x {:.4g} x {:.4g} mm", 1e3 * factor * box.extent(0),
                     1e3 * factor * box.extent(1), 1e3 * factor * box.extent(2));
}

/// A unit slip is a factor 1000, 25.4 or 10; real tools lie well inside this window.
constexpr double most_blanks = 20.0, least_blanks = 1.0 / 50.0;

void require_size(const Extent& box, const ToolFile& tool, const Expectation& expected) {
  const double needed = std::max({expected.blank_size[0], expected.blank_size[1], expected.stroke});
  if (!(needed > 0.0)) return;
  const auto fits = [&](double extent) {
    return extent <= most_blanks * needed && extent >= least_blanks * needed;
  };
  if (fits(box.largest())) return;
  std::string way_out = "No usual unit makes it fit: check the file.";
  double best = INFINITY;
  for (double unit : {1.0, 1e-2, 1e-3, 1e-6, 0.0254}) {
    const double factor = unit / tool.length_unit;
    const double away = std::abs(std::log(factor * box.largest() / needed));
    if (!fits(factor * box.largest()) || away >= best) continue;
    best = away;
    way_out = fmt::format("length_unit: {} would make it {}.", unit_name(unit), extents(box, factor));
  }
  throw InputError(
      {{"*.length_unit.size"_family.of(expected.key), expected.key + ".length_unit",
        unit_name(tool.length_unit),
        fmt::format("must make {} as large as a tool: between 1/50 and 20 times blank and stroke ({:.4g} "
                    "mm); it is {}",
                    tool.file.filename().string(), 1e3 * needed, extents(box, 1.0)),
        way_out}});
}

enum class FileType { step, stl, obj };

FileType type_of(const ToolFile& tool, const Expectation& expected) {
  std::string extension = tool.file.extension().string();
  std::transform(extension.begin(), extension.end(), extension.begin(),
                 [](unsigned char c) { return static_cast<char>(std::tolower(c)); });
  if (extension == ".step" || extension == ".stp") return FileType::step;
  if (extension == ".stl") return FileType::stl;
  if (extension == ".obj") return FileType::obj;
  throw InputError({{"*.file.type"_family.of(expected.key), expected.key + ".file", tool.file.string(),
                     "must end with .step, .stp, .stl or .obj",
                     "Export the tool as one of these; STEP keeps its curves."}});
}

TriangleMesh read_step(const ToolFile& tool, const Expectation& expected) {
  require_step(tool.file, tool.length_unit, expected.key);
  try {
    // First: a tool a thousand times too large would take a million times too many triangles.
    const auto [low, high] = step_box(tool.file);
    require_size({low, high}, tool, expected);
    return step_surface(tool.file, {tool.mesh_size, tool.chord_error, most_tool_triangles});
  } catch (const CadError& error) {
    const bool of_file = error.key() == "file";
    const std::string key = expected.key + "." + error.key();
    throw InputError(
        {{"*.cad"_family.of(key), key, of_file ? "" : fmt::format("{:g} mm", 1e3 * tool.mesh_size),
          error.what(), error.way_out(), of_file ? tool.file.string() : ""}});
  }
}

Problems check_numbers(const ToolFile& tool, const Expectation& expected) {
  Problems problems;
  const auto demand = [&](bool holds, const char* name, double value, const char* rule, const char* way_out) {
    const std::string key = expected.key + "." + name;
    if (!holds)
      problems.push_back({"*.range"_family.of(key), key, fmt::format("{:g}", value), rule, way_out});
  };
  demand(std::isfinite(tool.length_unit) && tool.length_unit > 0.0, "length_unit", tool.length_unit,
         "must be > 0", "mm for most tools.");
  demand(std::isfinite(tool.mesh_size) && tool.mesh_size > 0.0, "mesh_size", tool.mesh_size, "must be > 0",
         "2 mm suits a part of 0.3 m.");
  demand(std::isfinite(tool.chord_error) && tool.chord_error > 0.0, "chord_error", tool.chord_error,
         "must be > 0", "0.05 mm is a thirtieth of the fabric's thickness.");
  return problems;
}

// Twice the signed area that a mesh shows from above: positive if its normals point up on the whole.
double seen_from_above(const TriangleMesh& mesh) {
  double sum = 0.0;
  for (const auto& t : mesh.triangles) {
    const Place &a = mesh.vertices[t[0]], &b = mesh.vertices[t[1]], &c = mesh.vertices[t[2]];
    sum += (b[0] - a[0]) * (c[1] - a[1]) - (b[1] - a[1]) * (c[0] - a[0]);
  }
  return sum;
}

// A sheet has no inside to tell how its normals should point: the fabric does.
void face_the_fabric(LoadedTool& loaded, const ToolFile& tool, const Expectation& expected, bool may_turn) {
  if (expected.fabric_side * seen_from_above(loaded.mesh) >= 0.0) return;
  const std::string key = expected.key + ".sheet";
  if (!may_turn)
    throw InputError({{"*.sheet.side"_family.of(expected.key), key, "on",
                       fmt::format("must have its normals {}, where the fabric is",
                                   expected.fabric_side > 0 ? "up" : "down"),
                       fmt::format("`{}.repair: on` turns it, or turn it in the file.", expected.key),
                       tool.file.string()}});
  for (auto& t : loaded.mesh.triangles) std::swap(t[1], t[2]);
  if (tool.repair)
    loaded.repairs += fmt::format("{}turns the sheet to the fabric", loaded.repairs.empty() ? "" : ", ");
}

}  // namespace

TriangleMesh read_tool(const ToolFile& tool, const Expectation& expected) {
  if (Problems problems = check_numbers(tool, expected); !problems.empty())
    throw InputError(std::move(problems));
  const FileType type = type_of(tool, expected);
  const std::uint64_t size = require_file(tool.file, expected.key);
  const Source source{tool, expected};
  TriangleMesh mesh;
  if (type == FileType::step) {
    mesh = read_step(tool, expected);
  } else {
    mesh = type == FileType::stl ? read_stl(source, size) : read_obj(source);
    for (Place& p : mesh.vertices) {
      for (double& x : p) x *= tool.length_unit;
    }
  }
  if (mesh.triangles.empty())
    source.refuse("*.file.no_triangles"_family, 0, "must hold triangles; it holds none",
                  "Export the tool again.");
  if (type != FileType::step) require_size(box_of(mesh), tool, expected);
  return mesh;
}

LoadedTool load_tool(const ToolFile& tool, const Expectation& expected) {
  LoadedTool loaded{read_tool(tool, expected), ""};
  const bool from_cad = type_of(tool, expected) == FileType::step;
  if (tool.repair || from_cad) {
    Repair repair = repaired(loaded.mesh);
    if (tool.repair && repair.changed()) loaded.repairs = summary(repair);
    loaded.mesh = std::move(repair.mesh);
  }
  Problems problems = check(loaded.mesh, expected.key, tool.file.string(), tool.topology);
  if (!problems.empty()) throw InputError(std::move(problems));
  if (tool.topology == TopologyRule::open_allowed)
    face_the_fabric(loaded, tool, expected, tool.repair || from_cad);
  return loaded;
}

}  // namespace heddle::macroscale
