#pragma once

#include <string>
#include <utility>

#include "core/problem.h"

namespace heddle::macroscale {

/// Collects what is wrong with one input.
class Findings {
 public:
  /// @param key   in names of rules
  /// @param path  of the setting
  /// @param file  that it names; "" if none
  Findings(std::string key, std::string path, std::string file)
      : key_(std::move(key)), path_(std::move(path)), file_(std::move(file)) {}
  void add(RuleFamily id, std::string rule, std::string way_out) {
    problems_.push_back({id.of(key_), path_, "", std::move(rule), std::move(way_out), file_});
  }
  bool any() const { return !problems_.empty(); }
  Problems take() { return std::move(problems_); }

 private:
  std::string key_, path_, file_;
  Problems problems_;
};

}  // namespace heddle::macroscale
