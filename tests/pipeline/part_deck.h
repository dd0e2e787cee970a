#pragma once

#include <algorithm>
#include <array>
#include <cctype>
#include <cmath>
#include <map>
#include <sstream>
#include <string>
#include <vector>

#include <Eigen/Core>
#include <Eigen/Geometry>
#include <Eigen/LU>

/// A deck of a part, read back by its keywords: what a solver would take from it.
namespace heddle::test {

struct PartDeck {
  struct Element {
    std::string type, set;
    std::vector<int> nodes;
  };
  struct Section {
    std::string material, orientation;
  };
  std::map<int, Eigen::Vector3d> nodes;
  std::map<int, Element> elements;
  std::map<std::string, Section> sections;  // by set
  std::map<std::string, double> density;    // by material
  std::map<std::string, std::array<Eigen::Vector3d, 2>> orientations;
  std::map<std::string, std::vector<int>> node_sets;
};

inline std::string field_of(const std::string& line, const std::string& key) {
  const auto at = line.find(key + "=");
  if (at == std::string::npos) return "";
  const auto end = line.find(',', at);
  return line.substr(at + key.size() + 1, end == std::string::npos ? end : end - at - key.size() - 1);
}

inline std::vector<double> numbers_of(std::string line) {
  std::replace(line.begin(), line.end(), ',', ' ');
  std::istringstream fields(line);
  std::vector<double> values;
  for (double value = 0.0; fields >> value;) values.push_back(value);
  return values;
}

inline PartDeck read_deck(const std::string& text) {
  PartDeck deck;
  std::istringstream lines(text);
  std::string line, keyword, head, material;
  std::vector<double> element;
  while (std::getline(lines, line)) {
    if (line.starts_with("**")) continue;
    if (line.starts_with("*")) {
      head = line;
      keyword = line.substr(0, line.find(','));
      if (keyword == "*MATERIAL") material = field_of(line, "NAME");
      if (keyword == "*SOLID SECTION")
        deck.sections[field_of(line, "ELSET")] = {field_of(line, "MATERIAL"), field_of(line, "ORIENTATION")};
      continue;
    }
    const std::vector<double> v = numbers_of(line);
    if (keyword == "*NODE") deck.nodes[static_cast<int>(v[0])] = {v[1], v[2], v[3]};
    if (keyword == "*DENSITY") deck.density[material] = v[0];
    if (keyword == "*ORIENTATION" && v.size() == 6)
      deck.orientations[field_of(head, "NAME")] = {Eigen::Vector3d(v[0], v[1], v[2]),
                                                   Eigen::Vector3d(v[3], v[4], v[5])};
    if (keyword == "*NSET")
      for (const double n : v) deck.node_sets[field_of(head, "NSET")].push_back(static_cast<int>(n));
    if (keyword != "*ELEMENT") continue;
    element.insert(element.end(), v.begin(), v.end());
    if (line.back() == ',') continue;  // goes on
    auto& e = deck.elements[static_cast<int>(element[0])];
    e = {field_of(head, "TYPE"), field_of(head, "ELSET"), {}};
    for (std::size_t k = 1; k < element.size(); ++k) e.nodes.push_back(static_cast<int>(element[k]));
    element.clear();
  }
  return deck;
}

/// Volume of a brick or wedge with straight edges, by its corners: tetrahedra from the middle of the body to
/// the middle of each face and two corners of it.
inline double volume_of(const PartDeck& deck, const PartDeck::Element& element) {
  const std::size_t n = element.type == "C3D15" ? 3 : 4;
  std::vector<Eigen::Vector3d> x;
  Eigen::Vector3d middle = Eigen::Vector3d::Zero();
  for (std::size_t k = 0; k < 2 * n; ++k) {
    x.push_back(deck.nodes.at(element.nodes[k]));
    middle += x.back() / static_cast<double>(2 * n);
  }
  std::vector<std::vector<std::size_t>> faces(2);
  for (std::size_t k = 0; k < n; ++k) {
    faces[0].push_back(n - 1 - k);  // outwards
    faces[1].push_back(n + k);
    faces.push_back({k, (k + 1) % n, n + (k + 1) % n, n + k});
  }
  double volume = 0.0;
  for (const auto& face : faces) {
    Eigen::Vector3d centre = Eigen::Vector3d::Zero();
    for (const std::size_t k : face) centre += x[k] / static_cast<double>(face.size());
    for (std::size_t k = 0; k < face.size(); ++k)
      volume +=
          (x[face[k]] - middle).cross(x[face[(k + 1) % face.size()]] - middle).dot(centre - middle) / 6.0;
  }
  return volume;
}

}  // namespace heddle::test
