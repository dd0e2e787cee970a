#pragma once

#include <filesystem>
#include <string>

namespace heddle {

/// The bytes of a file that the user named.
/// @throws InputError  file.missing, file.folder or file.unreadable
std::string read_text_file(const std::filesystem::path& path);

}  // namespace heddle
