#include "core/progress.h"

#include <fmt/format.h>
#include <unistd.h>

#include <algorithm>
#include <cmath>
#include <ostream>

namespace heddle {
namespace {

// A terminal line is cheap to rewrite, yet more than ten a second only flickers.
constexpr double terminal_interval = 0.1;  // [s]
// Plain lines stay in a log for good: one when 5 s AND a further tenth of the work have gone by since the
// last, so at most ten lines for a long run and none for a short one.
constexpr double plain_interval = 5.0;  // [s]
constexpr double plain_share = 0.1;

}  // namespace

ProgressStyle progress_style_of_standard_error(bool quiet) {
  if (quiet) return ProgressStyle::quiet;
  return isatty(STDERR_FILENO) != 0 ? ProgressStyle::terminal : ProgressStyle::plain;
}

std::string format_duration(double seconds) {
  const auto whole = static_cast<long long>(std::llround(std::max(seconds, 0.0)));
  if (whole < 60) return fmt::format("{} s", whole);
  if (whole < 3600) return fmt::format("{} min {:02} s", whole / 60, whole % 60);
  return fmt::format("{} h {:02} min", whole / 3600, whole % 3600 / 60);
}

double Progress::steady_seconds() {
  return std::chrono::duration<double>(std::chrono::steady_clock::now().time_since_epoch()).count();
}

Progress::Progress(std::string title, int total, ProgressStyle style, std::ostream& out, Clock clock)
    : title_(std::move(title)),
      total_(std::max(total, 1)),
      style_(style),
      out_(out),
      clock_(std::move(clock)),
      start_(clock_()),
      last_time_(start_) {}

Progress::~Progress() {
  finish();
}

void Progress::update(int done, const std::string& note) {
  if (finished_ || style_ == ProgressStyle::quiet) return;
  const double now = clock_();
  if (!due(done, now)) return;
  last_time_ = now;
  last_done_ = done;
  write(line(done, now, note));
}

void Progress::finish(const std::string& note) {
  if (finished_) return;
  finished_ = true;
  if (style_ == ProgressStyle::quiet) return;
  const std::string text = fmt::format("{}: {}", title_, format_duration(clock_() - start_));
  write(note.empty() ? text : text + ", " + note);
  if (style_ == ProgressStyle::terminal) out_ << std::endl;
}

std::string Progress::line(int done, double now, const std::string& note) const {
  std::string text = fmt::format("{}: {}/{} ({:.0f} %)", title_, done, total_, 100.0 * done / total_);
  if (done > 0) {
    const double left = (now - start_) / done * (total_ - done);
    text += fmt::format(", {} left", format_duration(left));
  }
  return note.empty() ? text : text + ", " + note;
}

bool Progress::due(int done, double now) const {
  const double waited = now - last_time_;
  if (style_ == ProgressStyle::terminal) return done == 0 || done >= total_ || waited >= terminal_interval;
  return waited >= plain_interval && done - last_done_ >= plain_share * total_;
}

void Progress::write(const std::string& text) {
  if (style_ == ProgressStyle::plain) {
    out_ << text << std::endl;
    return;
  }
  const std::size_t blanks = shown_width_ > text.size() ? shown_width_ - text.size() : 0;
  out_ << '\r' << text << std::string(blanks, ' ') << std::flush;
  shown_width_ = text.size();
}

}  // namespace heddle
