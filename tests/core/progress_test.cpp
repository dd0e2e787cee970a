#include "core/progress.h"

#include <algorithm>
#include <catch2/catch.hpp>
#include <sstream>

using heddle::Progress;
using heddle::ProgressStyle;

TEST_CASE("durations read as people say them", "[core][progress]") {
  CHECK(heddle::format_duration(0.2) == "0 s");
  CHECK(heddle::format_duration(59.4) == "59 s");
  CHECK(heddle::format_duration(185.0) == "3 min 05 s");
  CHECK(heddle::format_duration(7800.0) == "2 h 10 min");
}

TEST_CASE("plain progress writes few lines with the time left", "[core][progress]") {
  double now = 0.0;
  std::ostringstream out;
  {
    Progress progress("stamping", 100, ProgressStyle::plain, out, [&] { return now; });
    for (int step = 1; step <= 100; ++step) {
      now += 1.0;
      progress.update(step, "punch " + std::to_string(step) + " mm");
    }
  }
  const std::string text = out.str();
  CHECK(std::count(text.begin(), text.end(), '\n') == 11);  // one a tenth, and the last
  CHECK(text.find("stamping: 10/100 (10 %), 1 min 30 s left, punch 10 mm\n") == 0);
  CHECK(text.find("stamping: 1 min 40 s\n") != std::string::npos);
  CHECK(text.find('\r') == std::string::npos);
}

TEST_CASE("a short run leaves only its last line in a log", "[core][progress]") {
  double now = 0.0;
  std::ostringstream out;
  {
    Progress progress("weave", 10, ProgressStyle::plain, out, [&] { return now; });
    for (int step = 1; step <= 10; ++step) {
      now += 0.1;
      progress.update(step);
    }
  }
  CHECK(out.str() == "weave: 1 s\n");
}

TEST_CASE("terminal progress rewrites one line and blanks what a shorter one leaves", "[core][progress]") {
  double now = 0.0;
  std::ostringstream out;
  Progress progress("x", 4, ProgressStyle::terminal, out, [&] { return now; });
  now = 1.0;
  progress.update(1, "a long note");
  now = 1.01;
  progress.update(2);  // too soon to be seen
  now = 2.0;
  progress.update(2);
  progress.finish();
  CHECK(out.str() == "\rx: 1/4 (25 %), 3 s left, a long note\rx: 2/4 (50 %), 2 s left" +
                         std::string(13, ' ') + "\rx: 2 s" + std::string(17, ' ') + "\n");
}

TEST_CASE("quiet progress writes nothing", "[core][progress]") {
  std::ostringstream out;
  {
    Progress progress("x", 2, ProgressStyle::quiet, out);
    progress.update(1);
    progress.update(2);
  }
  CHECK(out.str().empty());
}
