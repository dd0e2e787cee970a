#include "pipeline/interrupt.h"

#include <signal.h>

#include <atomic>

namespace heddle::pipeline {

namespace {

std::atomic<bool> noted{false};
static_assert(std::atomic<bool>::is_always_lock_free, "a signal handler may only touch lock-free atomics");
struct sigaction previous_interrupt,
    previous_terminate;  // a signal handler knows no object: this must be global

void note(int) {
  noted.store(true);
}

}  // namespace

InterruptGuard::InterruptGuard() {
  noted.store(false);
  struct sigaction action {};
  action.sa_handler = note;
  sigemptyset(&action.sa_mask);
  action.sa_flags = static_cast<int>(SA_RESETHAND | SA_RESTART);
  sigaction(SIGINT, &action, &previous_interrupt);
  sigaction(SIGTERM, &action, &previous_terminate);
}

InterruptGuard::~InterruptGuard() {
  sigaction(SIGINT, &previous_interrupt, nullptr);
  sigaction(SIGTERM, &previous_terminate, nullptr);
}

bool InterruptGuard::interrupted() {
  return noted.load();
}

}  // namespace heddle::pipeline
