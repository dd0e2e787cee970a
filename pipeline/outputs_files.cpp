#include <fmt/format.h>
#include <unistd.h>

#include <cerrno>
#include <cstdio>
#include <cstring>
#include <fstream>
#include <iterator>
#include <memory>

#include "pipeline/outputs.h"

namespace heddle::pipeline {

namespace {

[[noreturn]] void fail(const std::filesystem::path& path, std::string_view action, int error) {
  throw OutputError(fmt::format("{}: cannot {}: {}", path.string(), action, std::strerror(error)));
}

/// Removes the temporary file unless it has been moved into place.
struct TemporaryFile {
  std::filesystem::path path;
  bool kept = false;
  ~TemporaryFile() {
    std::error_code ignored;  // the failure that brings us here is already on its way to the caller
    if (!kept) std::filesystem::remove(path, ignored);
  }
};

using File = std::unique_ptr<std::FILE, int (*)(std::FILE*)>;

}  // namespace

void write_file(const std::filesystem::path& path, std::string_view bytes, bool durable) {
  std::error_code error;
  if (path.has_parent_path()) std::filesystem::create_directories(path.parent_path(), error);
  if (error) fail(path.parent_path(), "create the folder", error.value());
  TemporaryFile temporary{path.string() + ".part"};
  File file(std::fopen(temporary.path.c_str(), "wb"), &std::fclose);
  if (!file) {
    temporary.kept = true;  // nothing of ours is there to remove
    fail(path, "open it for writing", errno);
  }
  if (std::fwrite(bytes.data(), 1, bytes.size(), file.get()) != bytes.size()) fail(path, "write it", errno);
  if (durable && (std::fflush(file.get()) != 0 || fsync(fileno(file.get())) != 0))
    fail(path, "write it", errno);
  // A full disk may show only when the buffer is emptied.
  if (std::fclose(file.release()) != 0) fail(path, "write it", errno);
  std::filesystem::rename(temporary.path, path, error);
  if (error) fail(path, "put it in place", error.value());
  temporary.kept = true;
}

std::string read_file(const std::filesystem::path& path) {
  errno = 0;
  std::ifstream file(path, std::ios::binary);
  if (!file) fail(path, "open it for reading", errno);
  std::string bytes{std::istreambuf_iterator<char>(file), std::istreambuf_iterator<char>()};
  if (file.bad()) fail(path, "read it", errno);
  return bytes;
}

}  // namespace heddle::pipeline
