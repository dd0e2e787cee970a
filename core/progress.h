#pragma once

#include <chrono>
#include <functional>
#include <iosfwd>
#include <string>

namespace heddle {

/// How progress is shown.
enum class ProgressStyle {
  terminal,  ///< one line, written over and over
  plain,     ///< a new line now and then, for files and pipes
  quiet      ///< nothing
};

/// `terminal` if standard error is one, else `plain`; `quiet` when asked for.
ProgressStyle progress_style_of_standard_error(bool quiet);

/// "42 s", "3 min 05 s", "2 h 10 min"
/// @param seconds  >= 0
std::string format_duration(double seconds);

/// Says how far a loop of known length has come and how long the rest will take at the pace so far.
/// Text only: results never depend on it. Not for use from several threads at once.
class Progress {
 public:
  using Clock = std::function<double()>;  ///< seconds since any fixed instant

  /// @param title   what is being done, for instance "stamping"
  /// @param total   number of steps, > 0
  /// @param out     usually std::cerr; must outlive this object
  /// @param clock   replaced in tests
  Progress(std::string title, int total, ProgressStyle style, std::ostream& out,
           Clock clock = steady_seconds);
  ~Progress();
  Progress(const Progress&) = delete;
  Progress& operator=(const Progress&) = delete;

  /// @param done  steps finished so far, 0..total
  /// @param note  a few words on the state, for instance "punch 41 mm"
  void update(int done, const std::string& note = "");
  /// Ends the rewritten line and says how long it all took. Called by the destructor if it was not called
  /// before.
  void finish(const std::string& note = "");

  static double steady_seconds();

 private:
  std::string line(int done, double now, const std::string& note) const;
  bool due(int done, double now) const;
  void write(const std::string& text);

  std::string title_;
  int total_;
  ProgressStyle style_;
  std::ostream& out_;
  Clock clock_;
  double start_;
  double last_time_;
  int last_done_ = 0;
  std::size_t shown_width_ = 0;  ///< of the line on the terminal, to blank what a shorter one leaves
  bool finished_ = false;
};

}  // namespace heddle
