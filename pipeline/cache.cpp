#include "pipeline/cache.h"

#include <unistd.h>

#include <algorithm>
#include <vector>

#include <fmt/format.h>

#include "pipeline/outputs.h"

namespace heddle::pipeline {

namespace fs = std::filesystem;

Cache::Cache(fs::path folder, Log log, std::uintmax_t limit)
    : folder_(std::move(folder)), log_(std::move(log)), limit_(limit) {}

std::optional<std::string> Cache::load(const std::string& key) const {
  std::error_code error;
  if (folder_.empty() || !fs::is_regular_file(folder_ / key, error)) return std::nullopt;
  try {
    std::string bytes = read_file(folder_ / key);
    // Its time says when it was last of use; an entry in a folder that cannot be written to only ages sooner.
    fs::last_write_time(folder_ / key, fs::file_time_type::clock::now(), error);
    return bytes;
  } catch (const OutputError& failure) {
    refuse(key, failure.what());
    return std::nullopt;
  }
}

void Cache::refuse(const std::string& key, const std::string& why) const {
  log_(fmt::format("cache: entry {:.16}... is not used: it {}", key, why));
}

void Cache::store(const std::string& key, std::string_view bytes) const {
  if (folder_.empty()) return;
  try {
    // A name of this process alone: two programs may store the same key at once, and each then renames a
    // whole file.
    const fs::path own = folder_ / fmt::format("{}.{}", key, getpid());
    write_file(own, bytes);
    fs::rename(own, folder_ / key);
    prune(key);
  } catch (const std::exception& failure) {  // a disk that is full, a folder that is read-only
    log_(fmt::format("cache: nothing was kept: {}", failure.what()));
  }
}

void Cache::prune(const std::string& newest) const {
  struct Entry {
    fs::path path;
    std::uintmax_t size;
    fs::file_time_type time;
  };
  std::vector<Entry> entries;
  std::uintmax_t total = 0;
  for (const auto& file : fs::directory_iterator(folder_)) {
    std::error_code gone;  // another program may prune as well
    const Entry entry{file.path(), file.file_size(gone), file.last_write_time(gone)};
    if (gone || !file.is_regular_file(gone)) continue;
    total += entry.size;
    if (entry.path.filename() != newest) entries.push_back(entry);
  }
  std::sort(entries.begin(), entries.end(), [](const Entry& a, const Entry& b) { return a.time < b.time; });
  for (const Entry& entry : entries) {
    if (total <= limit_) return;
    std::error_code gone;
    fs::remove(entry.path, gone);
    total -= entry.size;
  }
}

}  // namespace heddle::pipeline
