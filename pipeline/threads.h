#pragma once

#include <tbb/global_control.h>

#include <memory>

namespace heddle::pipeline {

/// Keeps a command to so many threads for as long as the value lives; 0 or less: all there are.
inline std::unique_ptr<tbb::global_control> limit_threads(int threads) {
  if (threads <= 0) return nullptr;
  return std::make_unique<tbb::global_control>(tbb::global_control::max_allowed_parallelism, threads);
}

}  // namespace heddle::pipeline
