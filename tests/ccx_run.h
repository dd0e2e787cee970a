#pragma once

#include <unistd.h>

#include <array>
#include <catch2/catch.hpp>
#include <cstdlib>
#include <filesystem>
#include <fstream>
#include <map>
#include <sstream>
#include <string>

#include "core/text_file.h"

/// CalculiX from a test, where it is installed.
namespace heddle::test {

inline bool ccx_is_there() {
  if (std::system("command -v ccx >/dev/null 2>&1") == 0) return true;
  WARN("ccx is not installed (package calculix-ccx): nothing was compared");
  return false;
}

/// Runs a deck in a folder of its own. @return  what CalculiX prints, its .dat file
inline std::string run_ccx(const std::string& deck) {
  namespace fs = std::filesystem;
  const fs::path folder = fs::temp_directory_path() / ("heddle-ccx-" + std::to_string(getpid()));
  fs::create_directories(folder);
  std::ofstream(folder / "case.inp") << deck;
  const int code =
      std::system(("cd '" + folder.string() + "' && OMP_NUM_THREADS=1 ccx -i case >ccx.log 2>&1").c_str());
  INFO(read_text_file(folder / "ccx.log"));
  REQUIRE(code == 0);
  std::string dat = read_text_file(folder / "case.dat");
  fs::remove_all(folder);
  return dat;
}

using Vectors = std::map<int, std::array<double, 3>>;  // by node

/// The last table of a quantity in what CalculiX prints: a head that names it, an empty line, a line a node.
inline Vectors last_table(const std::string& dat, const std::string& quantity) {
  std::istringstream lines(dat.substr(dat.rfind(quantity)));
  std::string line;
  std::getline(lines, line);
  std::getline(lines, line);
  Vectors rows;
  while (std::getline(lines, line)) {
    std::istringstream fields(line);
    int node = 0;
    std::array<double, 3> v{};
    if (!(fields >> node >> v[0] >> v[1] >> v[2])) break;
    rows[node] = v;
  }
  return rows;
}

}  // namespace heddle::test
