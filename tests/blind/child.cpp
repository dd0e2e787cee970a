#include "child.h"

#include <fcntl.h>
#include <sys/resource.h>
#include <sys/wait.h>
#include <unistd.h>

#include <cerrno>
#include <csignal>
#include <cstdlib>
#include <system_error>

namespace heddle::blind {

namespace {

constexpr int not_started = 127;

double seconds(const timeval& time) {
  return static_cast<double>(time.tv_sec) + 1e-6 * static_cast<double>(time.tv_usec);
}

/// Runs in the child, between fork and exec: system calls only but for the environment, as we have one
/// thread.
[[noreturn]] void become(const std::vector<std::string>& arguments, const std::filesystem::path& folder,
                         const std::vector<std::pair<std::string, std::string>>& environment,
                         const std::filesystem::path& log) {
  setpgid(0, 0);
  for (const auto& [name, value] : environment) setenv(name.c_str(), value.c_str(), 1);
  const int output = open(log.c_str(), O_WRONLY | O_CREAT | O_TRUNC, 0644);
  const int input = open("/dev/null", O_RDONLY);
  if (output < 0 || input < 0 || chdir(folder.c_str()) != 0) _exit(not_started);
  dup2(input, STDIN_FILENO);
  dup2(output, STDOUT_FILENO);
  dup2(output, STDERR_FILENO);
  std::vector<char*> words;
  for (const std::string& argument : arguments) words.push_back(const_cast<char*>(argument.c_str()));
  words.push_back(nullptr);
  execv(words[0], words.data());
  _exit(not_started);
}

}  // namespace

Child::Child(const std::vector<std::string>& arguments, const std::filesystem::path& folder,
             const std::vector<std::pair<std::string, std::string>>& environment,
             const std::filesystem::path& log) {
  id_ = fork();
  if (id_ < 0) throw std::system_error(errno, std::generic_category(), "cannot start " + arguments.at(0));
  if (id_ == 0) become(arguments, folder, environment, log);
}

Child::~Child() {
  if (id_ <= 0) return;
  kill();
  waitpid(id_, nullptr, 0);
}

std::optional<Ending> Child::poll() {
  int status = 0;
  rusage usage{};
  if (wait4(id_, &status, WNOHANG, &usage) != id_) return std::nullopt;
  id_ = -1;
  const int code = WIFSIGNALED(status) ? 128 + WTERMSIG(status) : WEXITSTATUS(status);
  return Ending{.exit_code = code,
                .cpu_time = seconds(usage.ru_utime) + seconds(usage.ru_stime),
                .peak_memory = static_cast<double>(usage.ru_maxrss) / 1024.0};
}

void Child::kill() {
  if (id_ > 0) ::kill(id_, SIGKILL);
}

}  // namespace heddle::blind
