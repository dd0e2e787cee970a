#include "core/text_file.h"

#include <fstream>
#include <sstream>

#include "core/problem.h"

namespace heddle {

namespace {

[[noreturn]] void refuse(Rule id, const std::filesystem::path& path, const char* rule, const char* way_out) {
  throw InputError({{id, "", "", rule, way_out, path.string(), 0}});
}

}  // namespace

std::string read_text_file(const std::filesystem::path& path) {
  std::error_code unknown;  // a file that cannot be looked at is told apart by the attempt to read it
  if (!std::filesystem::exists(path, unknown) && !unknown)
    refuse("file.missing"_rule, path, "does not exist", "Check the path.");
  if (std::filesystem::is_directory(path, unknown))
    refuse("file.folder"_rule, path, "is a folder", "Name a file in it.");
  std::ifstream stream(path, std::ios::binary);
  std::ostringstream text;
  if (stream) text << stream.rdbuf();
  if (!stream) refuse("file.unreadable"_rule, path, "cannot be read", "Check its permissions.");
  return text.str();
}

}  // namespace heddle
