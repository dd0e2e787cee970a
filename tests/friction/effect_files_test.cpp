#include <fmt/format.h>
#include <catch2/catch.hpp>
#include <filesystem>
#include <map>
#include <set>
#include <sstream>

#include "core/text_file.h"
#include "friction/effects.h"
#include "friction/laws.h"
#include "friction/rheology/rheology.h"
#include "tests/friction/every_model.h"
#include "tests/source_dir.h"

using namespace heddle::friction;

namespace {

const std::filesystem::path folder = std::string(heddle::test::source_dir) + "/configs/effects";

/// Top-level keys of the file and, below "parameters", name -> the rest of the line.
struct EffectFile {
  std::map<std::string, std::string> keys, parameters;
};

EffectFile read(const std::filesystem::path& path) {
  EffectFile file;
  std::istringstream lines(heddle::read_text_file(path.string()));
  for (std::string line; std::getline(lines, line);) {
    if (line.empty() || line[0] == '#') continue;
    const bool below = line.starts_with("  ");
    const auto colon = line.find(':');
    REQUIRE(colon != std::string::npos);
    const std::string key = line.substr(below ? 2 : 0, colon - (below ? 2 : 0));
    (below ? file.parameters : file.keys)[key] = line.substr(std::min(colon + 2, line.size()));
  }
  return file;
}

}  // namespace

TEST_CASE("each effect has a file that names its numbers, units and off value", "[friction][effects]") {
  std::set<std::string> ids;
  Effects effects;
  for_each_effect(effects, [&]<class E>(const std::optional<E>&) {
    const std::string id = About<E>::id;
    ids.insert(id);
    CAPTURE(id);
    const EffectFile file = read(folder / (id + ".yaml"));
    CHECK(file.keys.at("id") == id);
    for (const char* key : {"stage", "form", "parameters", "look_alikes", "source"})
      CHECK(file.keys.count(key) == 1);
    CHECK(file.keys.size() == 6);
    CHECK(file.parameters.size() == About<E>::fields.size());
    bool first = true;
    for (const Field<E>& field : About<E>::fields) {
      CAPTURE(field.name);
      REQUIRE(file.parameters.count(field.name) == 1);
      const std::string& text = file.parameters.at(field.name);
      CHECK(text.starts_with(fmt::format("{{unit: \"{}\", prior: \"", field.unit)));
      CHECK(text.ends_with(first ? "off: 0}" : "off: any}"));
      CHECK(field.range.contains(E{}.*(field.member)));
      if (first) CHECK(E{}.*(field.member) == 0.0);
      first = false;
    }
  });
  CHECK(ids.size() == 15);
  std::set<std::string> files;
  for (const auto& entry : std::filesystem::directory_iterator(folder)) {
    const std::string stem = entry.path().stem().string();
    if (ids.count(stem) == 1) files.insert(stem);
  }
  CHECK(files == ids);

  std::vector<std::string> listed;
  for (const auto& effect : heddle::test::every_effect()) listed.push_back(effect.id);
  CHECK(std::set<std::string>(listed.begin(), listed.end()) == ids);  // the tests leave none out
}

TEST_CASE("each law, rheology and effect says its equation and source in the theory", "[friction]") {
  const std::string page =
      heddle::read_text_file(std::string(heddle::test::source_dir) + "/docs/theory/friction.md");
  const auto told = [&]<class T>(const T&) {
    CAPTURE(About<T>::id);
    CHECK(page.find(fmt::format("| `{}` |", About<T>::id)) != std::string::npos);
    CHECK(std::string(About<T>::equation).size() > 5);
    CHECK(std::string(About<T>::source).size() > 5);
    for (const auto& field : About<T>::fields) {
      CAPTURE(field.name);
      CHECK(page.find(fmt::format("`{}`", field.name)) != std::string::npos);
    }
  };
  for (const Law& law : heddle::test::every_law()) std::visit(told, law);
  for (const Rheology& rheology : heddle::test::every_rheology()) {
    std::visit(told, rheology.flow);
    std::visit(told, rheology.temperature);
  }
  Effects effects;
  for_each_effect(effects, [&]<class E>(const std::optional<E>&) { told(E{}); });
}
