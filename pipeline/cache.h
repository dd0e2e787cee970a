#pragma once

#include <cstdint>
#include <filesystem>
#include <functional>
#include <optional>
#include <string>
#include <string_view>

#include "core/hdf5_file.h"

namespace heddle::pipeline {

/// Results of stages under the keys of their inputs, one file a key: FOLDER/KEY. Files are sealed HDF5
/// (core/hdf5_file.h) and hold their own key under "/key"; they appear by rename, so several programs may
/// share a folder. What cannot be trusted is passed over, never repaired. A cache never fails a run: what
/// goes wrong is a line for the log.
class Cache {
 public:
  static constexpr std::uintmax_t default_limit = 2'000'000'000;  ///< [byte]
  using Log = std::function<void(const std::string&)>;

  /// @param folder  empty: nothing is kept and nothing found
  /// @param limit   oldest entries beyond this size go when one is added [byte]
  explicit Cache(std::filesystem::path folder, Log log, std::uintmax_t limit = default_limit);

  /// The entry of this key as `read` understands it, or nothing: absent, damaged, of another key, or
  /// unreadable.
  /// @param read  Hdf5Reader -> T; may throw Hdf5Error
  template <class Read>
  auto find(const std::string& key, const Read& read) const
      -> std::optional<decltype(read(std::declval<const Hdf5Reader&>()))> {
    const std::optional<std::string> bytes = load(key);
    if (!bytes) return std::nullopt;
    try {
      const Hdf5Reader file(*bytes);
      if (file.text("/key") != key) throw Hdf5Error("is the entry of another key");
      return read(file);
    } catch (const std::exception& error) {
      refuse(key, error.what());
      return std::nullopt;
    }
  }

  /// @param bytes  a sealed HDF5 file with its key under "/key"
  void store(const std::string& key, std::string_view bytes) const;

 private:
  std::optional<std::string> load(const std::string& key) const;
  void refuse(const std::string& key, const std::string& why) const;
  void prune(const std::string& newest) const;

  std::filesystem::path folder_;
  Log log_;
  std::uintmax_t limit_;
};

}  // namespace heddle::pipeline
