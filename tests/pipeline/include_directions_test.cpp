#include <catch2/catch.hpp>
#include <filesystem>
#include <fstream>
#include <map>
#include <string>
#include <vector>

#include "tests/source_dir.h"

namespace {

const std::filesystem::path source = heddle::test::source_dir;

/// What a room may include besides itself: whole rooms, or single headers.
const std::map<std::string, std::vector<std::string>> allowed{
    {"core", {}},
    {"friction", {"core/"}},
    {"mesoscale", {"core/"}},
    {"macroscale", {"core/", "friction/", "mesoscale/fabric_properties.h"}},
    {"pipeline", {"core/", "friction/", "mesoscale/", "macroscale/"}},
};

/// Path between the quotes of an #include line, or "" if the line is none.
std::string included_path(const std::string& line) {
  const std::size_t first = line.find_first_not_of(" \t");
  if (first == std::string::npos || line[first] != '#' || line.find("include") == std::string::npos)
    return "";
  const std::size_t open = line.find('"');
  const std::size_t close = line.find('"', open + 1);
  return open == std::string::npos || close == std::string::npos ? ""
                                                                 : line.substr(open + 1, close - open - 1);
}

/// Whether a file of `room` may have this line.
bool arrow_points_forward(const std::string& room, const std::string& line) {
  const std::string path = included_path(line);
  if (path.empty() || path.starts_with(room + "/")) return true;
  for (const std::string& target : allowed.at(room)) {
    if (target.back() == '/' ? path.starts_with(target) : path == target) return true;
  }
  return false;
}

bool is_source(const std::filesystem::path& path) {
  return path.extension() == ".h" || path.extension() == ".cpp";
}

}  // namespace

TEST_CASE("no room includes one that stands after it in the chain", "[pipeline][layout]") {
  int files = 0;
  for (const auto& [room, targets] : allowed) {
    for (const auto& entry : std::filesystem::recursive_directory_iterator(source / room)) {
      if (!is_source(entry.path())) continue;
      ++files;
      std::ifstream stream(entry.path());
      int number = 0;
      for (std::string line; std::getline(stream, line);) {
        INFO(room << "/" << entry.path().filename().string() << ":" << ++number << ": " << line);
        if (!arrow_points_forward(room, line)) FAIL_CHECK("an arrow drawn backwards");
      }
    }
  }
  CHECK(files > 30);
}

TEST_CASE("an arrow drawn backwards is seen", "[pipeline][layout]") {
  CHECK_FALSE(arrow_points_forward("core", "#include \"friction/model.h\""));
  CHECK_FALSE(arrow_points_forward("friction", "#include \"mesoscale/cell.h\""));
  CHECK_FALSE(arrow_points_forward("mesoscale", "  # include \"friction/model.h\""));
  CHECK_FALSE(arrow_points_forward("macroscale", "#include \"mesoscale/cell_spec.h\""));
  CHECK_FALSE(arrow_points_forward("macroscale", "#include \"pipeline/case.h\""));
  CHECK_FALSE(arrow_points_forward("core", "#include \"model.h\""));  // a path from the root says which room
  CHECK(arrow_points_forward("macroscale", "#include \"mesoscale/fabric_properties.h\""));
  CHECK(arrow_points_forward("pipeline", "#include \"macroscale/stamping.h\""));
  CHECK(arrow_points_forward("core", "#include <vector>"));
}

TEST_CASE("third parties stay behind the files that wall them off", "[pipeline][layout]") {
  const std::map<std::string, std::string> walls{{"yaml-cpp/", "pipeline/config_tree.cpp"},
                                                 {"CLI/", "pipeline/command_line.cpp"},
                                                 {"cholmod.h", "core/sparse_solver.cpp"},
                                                 {"ceres/", "friction/calibration/robust_fit.cpp"}};
  for (const auto& [room, targets] : allowed) {
    for (const auto& entry : std::filesystem::recursive_directory_iterator(source / room)) {
      if (!is_source(entry.path())) continue;
      const std::string name = std::filesystem::relative(entry.path(), source).generic_string();
      std::ifstream stream(entry.path());
      for (std::string line; std::getline(stream, line);) {
        for (const auto& [header, file] : walls) {
          INFO(name << ": " << line);
          const bool includes = line.starts_with("#include <" + header);
          if (includes && name != file) FAIL_CHECK("belongs in " << file);
        }
      }
    }
  }
}
