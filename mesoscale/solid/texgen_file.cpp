#include "mesoscale/solid/texgen_file.h"

#include <algorithm>
#include <cctype>
#include <charconv>
#include <cmath>
#include <set>
#include <string_view>
#include <tuple>

#include <fmt/format.h>

#include "core/text_file.h"

namespace heddle::mesoscale::solid {

namespace {

constexpr int unknown = -2, matrix = -1;  // yarn of an element

struct Node {
  long id;
  Eigen::Vector3d place;  // in the length unit of the deck
};

struct Element {
  long id;
  std::array<long, 8> nodes;
  int yarn;
};

struct Deck {
  std::vector<Node> nodes;        // by id
  std::vector<Element> elements;  // by id
};

std::string_view trimmed(std::string_view text) {
  while (!text.empty() && std::isspace(static_cast<unsigned char>(text.front())) != 0) text.remove_prefix(1);
  while (!text.empty() && std::isspace(static_cast<unsigned char>(text.back())) != 0) text.remove_suffix(1);
  return text;
}

std::string lower(std::string_view text) {
  std::string small(text);
  std::transform(small.begin(), small.end(), small.begin(),
                 [](unsigned char c) { return static_cast<char>(std::tolower(c)); });
  return small;
}

// Lines that say something, with their number.
class Lines {
 public:
  explicit Lines(std::string_view text) : text_(text) {}

  bool next(std::string_view& line) {
    while (at_ < text_.size()) {
      const std::size_t end = std::min(text_.find('\n', at_), text_.size());
      line = trimmed(text_.substr(at_, end - at_));
      at_ = end + 1;
      ++number_;
      if (!line.empty() && !line.starts_with("**")) return true;
    }
    return false;
  }
  int number() const { return number_; }

 private:
  std::string_view text_;
  std::size_t at_ = 0;
  int number_ = 0;
};

// The numbers of a line, separated by commas; a comma may stand at its end.
bool read_numbers(std::string_view line, std::vector<double>& numbers) {
  numbers.clear();
  if (line.ends_with(',')) line.remove_suffix(1);
  while (true) {
    const std::size_t comma = line.find(',');
    const std::string_view field = trimmed(line.substr(0, comma));
    double value = 0.0;
    const auto [end, error] = std::from_chars(field.data(), field.data() + field.size(), value);
    if (error != std::errc() || end != field.data() + field.size() || !std::isfinite(value)) return false;
    numbers.push_back(value);
    if (comma == std::string_view::npos) return true;
    line.remove_prefix(comma + 1);
  }
}

// Ids are whole and positive, and short of what a double counts exactly.
bool is_id(double value) {
  return value >= 1.0 && value <= 1e15 && value == std::floor(value);
}

// "elset" of "*ElSet, ElSet=Yarn0, Generate" in lower case; a parameter without a value gives "yes".
std::string parameter(std::string_view keyword, std::string_view name) {
  while (true) {
    const std::size_t comma = keyword.find(',');
    const std::string_view field = trimmed(keyword.substr(0, comma));
    const std::size_t equals = field.find('=');
    if (lower(trimmed(field.substr(0, equals))) == name)
      return equals == std::string_view::npos ? "yes" : lower(trimmed(field.substr(equals + 1)));
    if (comma == std::string_view::npos) return "";
    keyword.remove_prefix(comma + 1);
  }
}

// Yarn that a set of elements stands for, if it stands for one.
int yarn_of_set(const std::string& name) {
  if (name == "matrix") return matrix;
  int yarn = unknown;
  if (!name.starts_with("yarn")) return unknown;
  const auto [end, error] = std::from_chars(name.data() + 4, name.data() + name.size(), yarn);
  return error == std::errc() && end == name.data() + name.size() && yarn >= 0 ? yarn : unknown;
}

template <class Item>
const Item* by_id(const std::vector<Item>& items, long id) {
  const auto at = std::lower_bound(items.begin(), items.end(), id,
                                   [](const Item& item, long wanted) { return item.id < wanted; });
  return at != items.end() && at->id == id ? &*at : nullptr;
}

template <class Item>
void sort_by_id(std::vector<Item>& items) {
  std::stable_sort(items.begin(), items.end(), [](const Item& a, const Item& b) { return a.id < b.id; });
}

constexpr const char* export_again =
    "Write it with TexGen's voxel export for Abaqus, matrix and yarns, elements C3D8 or C3D8R.";

Problem not_a_deck(const VoxelFileSpec& spec, const std::string& rule) {
  return {"cell.voxels.file.deck"_rule, "cell.voxels.file", spec.file.filename().string(), rule,
          export_again};
}

/// Reads a deck section by section.
class DeckReader {
 public:
  DeckReader(const VoxelFileSpec& spec, Problems& problems) : spec_(spec), problems_(problems) {}

  Deck read() {
    const std::string text = read_text_file(spec_.file);
    Lines lines(text);
    for (std::string_view line; problems_.empty() && lines.next(line);) {
      if (line.front() == '*')
        open(line, lines.number());
      else
        take(line, lines.number());
    }
    if (problems_.empty() && (deck_.nodes.empty() || deck_.elements.empty()))
      problems_.push_back(not_a_deck(spec_, "must hold *Node and *Element blocks, but has no elements"));
    sort_by_id(deck_.nodes);
    sort_by_id(deck_.elements);
    return problems_.empty() ? with_yarns() : Deck{};
  }

 private:
  enum class Section { other, nodes, elements, set };

  void open(std::string_view keyword, int number) {
    const std::string name = lower(trimmed(keyword.substr(0, keyword.find(','))));
    section_ = Section::other;
    if (name == "*node" && parameter(keyword, "nset").empty()) section_ = Section::nodes;
    if (name == "*element") {
      const std::string type = parameter(keyword, "type");
      if (type != "c3d8" && type != "c3d8r")
        problems_.push_back(not_a_deck(
            spec_, fmt::format("must hold elements C3D8 or C3D8R, but has {} in line {}", type, number)));
      section_ = Section::elements;
    }
    if (name == "*elset" && yarn_of_set(parameter(keyword, "elset")) != unknown) {
      section_ = Section::set;
      yarn_ = yarn_of_set(parameter(keyword, "elset"));
      generate_ = !parameter(keyword, "generate").empty();
    }
  }

  void take(std::string_view line, int number) {
    if (section_ == Section::other) return;
    bool good = read_numbers(line, numbers_);
    if (good && section_ == Section::nodes) good = take_node();
    if (good && section_ == Section::elements) good = take_element();
    if (good && section_ == Section::set) good = take_set();
    if (!good)
      problems_.push_back(
          not_a_deck(spec_, fmt::format("must hold numbers separated by commas, but line {} reads \"{}\"",
                                        number, line.substr(0, 60))));
  }

  bool take_node() {
    if (numbers_.size() != 4 || !is_id(numbers_[0])) return false;
    deck_.nodes.push_back({static_cast<long>(numbers_[0]), {numbers_[1], numbers_[2], numbers_[3]}});
    return true;
  }

  bool take_element() {
    if (numbers_.size() != 9 || !std::all_of(numbers_.begin(), numbers_.end(), is_id)) return false;
    Element element{static_cast<long>(numbers_[0]), {}, unknown};
    for (std::size_t i = 0; i < 8; ++i) element.nodes[i] = static_cast<long>(numbers_[i + 1]);
    deck_.elements.push_back(element);
    return true;
  }

  bool take_set() {
    if (!std::all_of(numbers_.begin(), numbers_.end(), is_id)) return false;
    if (!generate_) {
      for (const double id : numbers_) members_.push_back({static_cast<long>(id), yarn_});
      return true;
    }
    if (numbers_.size() < 2 || numbers_.size() > 3) return false;
    const long last = static_cast<long>(numbers_[1]);
    const long step = numbers_.size() == 3 ? static_cast<long>(numbers_[2]) : 1;
    // A range longer than the deck has elements outside of it.
    if (last / step > 8L * static_cast<long>(deck_.elements.size()) + 8) return false;
    for (long id = static_cast<long>(numbers_[0]); id <= last; id += step) members_.push_back({id, yarn_});
    return true;
  }

  Deck with_yarns() {
    std::stable_sort(members_.begin(), members_.end());
    std::size_t member = 0, without = 0;
    long first_without = 0;
    for (Element& element : deck_.elements) {
      while (member < members_.size() && members_[member].first < element.id) ++member;
      for (; member < members_.size() && members_[member].first == element.id; ++member) {
        if (element.yarn != unknown && element.yarn != members_[member].second && problems_.empty())
          problems_.push_back(set_problem(
              fmt::format("must put each element in one of the sets Matrix, Yarn0, Yarn1 ..., but element "
                          "{} is in two of them",
                          element.id)));
        element.yarn = members_[member].second;
      }
      if (element.yarn == unknown && ++without == 1) first_without = element.id;
    }
    if (without > 0)
      problems_.push_back(
          set_problem(fmt::format("must put each element in one of the sets Matrix, Yarn0, Yarn1 ..., but {} "
                                  "of {} are in none, first element {}",
                                  without, deck_.elements.size(), first_without)));
    return std::move(deck_);
  }

  Problem set_problem(const std::string& rule) const {
    return {"cell.voxels.file.sets"_rule, "cell.voxels.file", spec_.file.filename().string(), rule,
            export_again};
  }

  const VoxelFileSpec& spec_;
  Problems& problems_;
  Deck deck_;
  std::vector<std::pair<long, int>> members_;
  std::vector<double> numbers_;
  Section section_ = Section::other;
  int yarn_ = unknown;
  bool generate_ = false;
};

/// The lattice on which the nodes stand.
struct Box {
  std::array<int, 3> count{};
  Eigen::Vector3d low, step;
};

// Coordinates are printed with six digits: equal planes print alike, but steps scatter by the last digit.
constexpr double print_scatter = 0.05;  // of a voxel

// Planes of nodes across an axis: how many, if they are evenly spaced.
int even_planes(const std::set<double>& places) {
  const double low = *places.begin(), high = *places.rbegin();
  const auto planes = static_cast<int>(places.size());
  if (planes < 2) return 0;
  const double step = (high - low) / (planes - 1);
  int k = 0;
  for (const double place : places)
    if (std::abs(place - low - step * k++) > print_scatter * step) return 0;
  return planes;
}

Problem no_box(const VoxelFileSpec& spec, const std::string& but) {
  return {"cell.voxels.file.box"_rule, "cell.voxels.file", spec.file.filename().string(),
          "must hold the equal voxels of an upright box, one element in each, but " + but,
          "Sheared, rotated and octree meshes, and exports of the yarns alone, are not read."};
}

Box box_of(const VoxelFileSpec& spec, const Deck& deck, Problems& problems) {
  Box box;
  std::array<std::set<double>, 3> places;
  for (const Element& element : deck.elements)
    for (const long id : element.nodes) {
      const Node* node = by_id(deck.nodes, id);
      if (node == nullptr) {
        problems.push_back(
            not_a_deck(spec, fmt::format("must hold the nodes of its elements, but has no node {}", id)));
        return box;
      }
      for (std::size_t axis = 0; axis < 3; ++axis)
        places[axis].insert(node->place[static_cast<Eigen::Index>(axis)]);
    }
  for (std::size_t axis = 0; axis < 3; ++axis) {
    const int planes = even_planes(places[axis]);
    if (planes == 0) {
      problems.push_back(no_box(spec, fmt::format("its nodes are not evenly spaced along {}", "xyz"[axis])));
      return box;
    }
    const auto i = static_cast<Eigen::Index>(axis);
    box.count[axis] = planes - 1;
    box.low[i] = *places[axis].begin();
    box.step[i] = (*places[axis].rbegin() - box.low[i]) / box.count[axis];
  }
  const std::size_t voxels = static_cast<std::size_t>(box.count[0]) * static_cast<std::size_t>(box.count[1]) *
                             static_cast<std::size_t>(box.count[2]);
  if (voxels != deck.elements.size())
    problems.push_back(
        no_box(spec, fmt::format("has {} elements for {} x {} x {} voxels", deck.elements.size(),
                                 box.count[0], box.count[1], box.count[2])));
  return box;
}

// Place of the voxel that an element is, x fastest, or the number of voxels if it is none.
std::size_t voxel_of(const Box& box, const Deck& deck, const Element& element) {
  const auto [nx, ny, nz] = box.count;
  const auto none =
      static_cast<std::size_t>(nx) * static_cast<std::size_t>(ny) * static_cast<std::size_t>(nz);
  std::array<Eigen::Vector3d, 8> corner;
  Eigen::Vector3d low = Eigen::Vector3d::Constant(1e300);
  for (std::size_t c = 0; c < 8; ++c) {
    corner[c] = (by_id(deck.nodes, element.nodes[c])->place - box.low).cwiseQuotient(box.step);
    low = low.cwiseMin(corner[c]);
  }
  int seen = 0;  // a bit a corner of the voxel
  for (const Eigen::Vector3d& place : corner) {
    int which = 0;
    for (Eigen::Index axis = 0; axis < 3; ++axis) {
      const double from = place[axis] - std::round(low[axis]);
      if (std::abs(from) > 0.5) which |= 1 << axis;
      if (std::abs(from) > 0.5 ? std::abs(from - 1.0) > print_scatter : std::abs(from) > print_scatter)
        return none;
    }
    seen |= 1 << which;
  }
  if (seen != 255) return none;
  const auto at = [&](Eigen::Index axis) { return static_cast<std::size_t>(std::lround(low[axis])); };
  return (at(2) * static_cast<std::size_t>(ny) + at(1)) * static_cast<std::size_t>(nx) + at(0);
}

struct Direction {
  long id;
  Eigen::Vector3d fibre;
};

Problem no_direction(const VoxelFileSpec& spec, const std::string& rule) {
  return {"cell.voxels.orientations.fibre"_rule, "cell.voxels.orientations",
          spec.orientations.filename().string(), rule,
          "TexGen writes it beside the deck, with the ending .ori."};
}

std::vector<Direction> read_directions(const VoxelFileSpec& spec, Problems& problems) {
  const std::string text = read_text_file(spec.orientations);
  std::vector<Direction> directions;
  std::vector<double> numbers;
  Lines lines(text);
  for (std::string_view line; lines.next(line);) {
    if (line.front() == ',' || line.front() == '*') continue;  // Abaqus' default
    if (!read_numbers(line, numbers) || numbers.size() != 7 || !is_id(numbers[0])) {
      problems.push_back(no_direction(
          spec, fmt::format("must hold an element and two vectors a line, but line {} reads \"{}\"",
                            lines.number(), line.substr(0, 60))));
      return {};
    }
    directions.push_back({static_cast<long>(numbers[0]), {numbers[1], numbers[2], numbers[3]}});
  }
  sort_by_id(directions);
  return directions;
}

// Directions to a 256th, of either sense, so that many voxels share one.
std::tuple<int, int, int> rounded(const Eigen::Vector3d& fibre) {
  const Eigen::Vector3d unit = fibre.normalized();
  std::array<int, 3> r{};
  for (Eigen::Index i = 0; i < 3; ++i)
    r[static_cast<std::size_t>(i)] = static_cast<int>(std::lround(256.0 * unit[i]));
  const int lead = r[0] != 0 ? r[0] : r[1] != 0 ? r[1] : r[2];
  const int sense = lead < 0 ? -1 : 1;
  return {sense * r[0], sense * r[1], sense * r[2]};
}

/// Puts the elements into the voxels.
class CellFiller {
 public:
  CellFiller(VoxelCell& cell) : cell_(cell) {
    cell_.contents.push_back({{{0, 0, 1.0}}, Eigen::Vector3d::UnitZ()});
  }

  void fill(std::size_t voxel, const Element& element, const Eigen::Vector3d& fibre) {
    cell_.content[voxel] = element.yarn == matrix ? std::uint16_t{0} : content_along(fibre);
  }
  std::size_t contents() const { return contents_.size() + 1; }

 private:
  std::uint16_t content_along(const Eigen::Vector3d& fibre) {
    const auto key = rounded(fibre);
    const auto [at, fresh] = contents_.try_emplace(key, static_cast<std::uint16_t>(cell_.contents.size()));
    if (fresh && cell_.contents.size() < 65535) {
      const auto [x, y, z] = key;
      const auto direction = static_cast<std::uint16_t>(cell_.directions.size());
      cell_.directions.push_back(Eigen::Vector3d(x, y, z).normalized());
      cell_.contents.push_back({{{1, direction, 1.0}}, Eigen::Vector3d::UnitZ()});
    }
    return at->second;
  }

  VoxelCell& cell_;
  std::map<std::tuple<int, int, int>, std::uint16_t> contents_;
};

VoxelCell cell_of(const VoxelFileSpec& spec, Problems& problems) {
  VoxelCell cell;
  const Deck deck = DeckReader(spec, problems).read();
  if (!problems.empty()) return cell;
  const Box box = box_of(spec, deck, problems);
  const std::vector<Direction> directions = read_directions(spec, problems);
  if (!problems.empty()) return cell;
  cell.count = box.count;
  cell.edges = Eigen::Vector3d(spec.length_unit * box.step[0] * box.count[0],
                               spec.length_unit * box.step[1] * box.count[1],
                               spec.length_unit * box.step[2] * box.count[2])
                   .asDiagonal();
  cell.content.assign(deck.elements.size(), 0);
  std::vector<bool> taken(deck.elements.size(), false);
  CellFiller filler(cell);
  for (const Element& element : deck.elements) {
    const std::size_t voxel = voxel_of(box, deck, element);
    if (voxel == deck.elements.size() || taken[voxel]) {
      problems.push_back(no_box(
          spec,
          fmt::format("element {} is {}", element.id,
                      voxel == deck.elements.size() ? "no voxel of it" : "in the place of another one")));
      return cell;
    }
    taken[voxel] = true;
    const Direction* direction = by_id(directions, element.id);
    const bool needed = element.yarn != matrix;
    if (needed && (direction == nullptr || !(direction->fibre.norm() > 1e-9))) {
      problems.push_back(no_direction(
          spec, fmt::format("must hold the direction of each element of a yarn, but has none of element {}",
                            element.id)));
      return cell;
    }
    filler.fill(voxel, element, needed ? direction->fibre : Eigen::Vector3d::UnitX());
  }
  if (filler.contents() > 65535)
    problems.push_back(no_direction(spec, "must hold at most 65535 different directions"));
  return cell;
}

void check_materials(Problems& problems, const VoxelFileSpec& spec) {
  if (spec.phases.count(0) == 0)
    problems.push_back({"cell.phases.missing"_rule, "cell.phases", "",
                        "has no phase 0, the matrix of the deck",
                        "Add 0: {bulk_modulus: ..., shear_modulus: ...}."});
  const TransverseIsotropy& t = spec.tow;
  const double nu = t.transverse_poisson();
  const bool positive =
      t.axial_modulus > 0.0 && t.transverse_modulus > 0.0 && t.axial_shear > 0.0 && t.transverse_shear > 0.0;
  // The compliance is positive definite.
  const bool stable =
      positive && nu > -1.0 && nu < 1.0 &&
      t.axial_modulus * (1.0 - nu) > 2.0 * t.transverse_modulus * t.axial_poisson * t.axial_poisson;
  if (!stable)
    problems.push_back(
        {"cell.tow.stable"_rule, "cell.tow",
         fmt::format("{:g}, {:g}, {:g}, {:g} GPa and {:g}", 1e-9 * t.axial_modulus,
                     1e-9 * t.transverse_modulus, 1e-9 * t.axial_shear, 1e-9 * t.transverse_shear,
                     t.axial_poisson),
         "must be the constants of a stable material: moduli above zero, -1 < E_T / (2 G_TT) - 1 "
         "< 1, and E_L (1 - nu_TT) > 2 E_T nu_LT^2",
         "A tow of glass and polypropylene with 60 % of fibres has 44 GPa, 6.2 GPa, 2.2 GPa, "
         "2.2 GPa and 0.29."});
}

}  // namespace

Problems check_texgen(const VoxelFileSpec& spec) {
  Problems problems;
  check_materials(problems, spec);
  Problems of_files;
  cell_of(spec, of_files);
  problems.insert(problems.end(), of_files.begin(), of_files.end());
  return problems;
}

ReadVoxels read_texgen(const VoxelFileSpec& spec) {
  Problems problems;
  check_materials(problems, spec);
  ReadVoxels read;
  if (problems.empty()) read.cell = cell_of(spec, problems);
  if (!problems.empty()) throw InputError(std::move(problems));
  const PhaseModuli& resin = spec.phases.at(0);
  read.phases = {isotropic_stiffness(resin.bulk, resin.shear), stiffness(spec.tow)};
  return read;
}

}  // namespace heddle::mesoscale::solid
