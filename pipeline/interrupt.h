#pragma once

namespace heddle::pipeline {

/// While it lives, the first SIGINT or SIGTERM is only noted, so that a run can leave a checkpoint; a second
/// one of the same kind ends the program as usual. The handlers that were there before come back at the end.
/// One at a time.
class InterruptGuard {
 public:
  InterruptGuard();
  ~InterruptGuard();
  InterruptGuard(const InterruptGuard&) = delete;
  InterruptGuard& operator=(const InterruptGuard&) = delete;

  /// Whether a signal has come since the guard was set. Cheap, and safe from any thread.
  static bool interrupted();
};

}  // namespace heddle::pipeline
