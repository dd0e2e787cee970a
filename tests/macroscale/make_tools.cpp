// Writes configs/tools/*.step from the scripts beside them: ninja make_tools && build/.../make_tools
#include <filesystem>
#include <string>
#include <vector>

#include "macroscale/cad.h"

namespace {

struct Script {
  std::string name, prefix;
  std::vector<std::string> tools;
};

}  // namespace

int main() {
  const std::filesystem::path folder = std::filesystem::path(HEDDLE_SOURCE_DIR) / "configs/tools";
  const std::vector<Script> scripts{{"make_tools.geo", "", {"punch", "die", "binder"}},
                                    {"double_dome.geo", "double_dome_", {"punch", "die", "binder"}},
                                    {"tetrahedron.geo", "tetrahedron_", {"punch", "die"}}};
  for (const Script& script : scripts)
    for (std::size_t k = 0; k < script.tools.size(); ++k)
      heddle::macroscale::write_step(folder / script.name, static_cast<int>(k) + 1,
                                     folder / (script.prefix + script.tools[k] + ".step"));
}
