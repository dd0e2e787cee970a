// Writes configs/tools/*.step from configs/tools/make_tools.geo: ninja make_tools && build/.../make_tools
#include <filesystem>
#include <string>

#include "macroscale/cad.h"

int main() {
  const std::filesystem::path folder = std::filesystem::path(HEDDLE_SOURCE_DIR) / "configs/tools";
  int tool = 0;
  for (const char* name : {"punch", "die", "binder"})
    heddle::macroscale::write_step(folder / "make_tools.geo", ++tool, folder / (std::string(name) + ".step"));
}
