#pragma once

#include <sys/types.h>

#include <filesystem>
#include <optional>
#include <string>
#include <utility>
#include <vector>

namespace heddle::blind {

/// How a program ended.
struct Ending {
  int exit_code = 0;       ///< 128 + signal if one ended it
  double cpu_time = 0;     ///< user and system [s]
  double peak_memory = 0;  ///< [MB]
};

/// A program started on its own, in its own process group: Ctrl-C in the terminal reaches it through us only.
/// One that still runs when this object goes is killed.
class Child {
 public:
  /// @param arguments    the program first
  /// @param environment  set on top of ours
  /// @param log          takes standard output and error
  /// @throws std::system_error  it could not be started
  Child(const std::vector<std::string>& arguments, const std::filesystem::path& folder,
        const std::vector<std::pair<std::string, std::string>>& environment,
        const std::filesystem::path& log);
  ~Child();
  Child(Child&& other) noexcept : id_(std::exchange(other.id_, -1)) {}
  Child& operator=(Child&& other) noexcept {
    std::swap(id_, other.id_);
    return *this;
  }

  /// Nothing while it still runs. After it has said how it ended it is gone.
  std::optional<Ending> poll();
  void kill();

 private:
  pid_t id_ = -1;
};

}  // namespace heddle::blind
