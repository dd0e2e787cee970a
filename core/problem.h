#pragma once

#include <stdexcept>
#include <string>
#include <vector>

namespace heddle {

/// One thing wrong with what the user gave: where, what, the rule, the way out.
/// A free `check(const T&)` beside each specification returns these; the pipeline adds file and line.
struct Problem {
  std::string id;         ///< stable name of the rule, for instance "weave.gap.range"
  std::string key;        ///< dotted path of the key, for instance "weave.gap"
  std::string value;      ///< the value as written, or formatted with its unit; may be empty
  std::string rule;       ///< "must satisfy 0 <= gap < 0.1 m"
  std::string way_out;    ///< "Table 1 gives 0.75 mm; write 0.75 mm."
  std::string file = {};  ///< filled in by the reader
  int line = 0;           ///< 1-based; 0 = not tied to a line
};

using Problems = std::vector<Problem>;

/// The whole list as the user reads it, one block a file, problems in order of line.
std::string format(const Problems& problems);

/// Everything wrong with an input, thrown once. Exit code 2.
class InputError : public std::runtime_error {
 public:
  explicit InputError(Problems problems);
  const Problems& problems() const { return problems_; }

 private:
  Problems problems_;
};

/// A value that is not finite, or a system that cannot be solved; names node, step and quantity. Exit code 1.
class NumericalError : public std::runtime_error {
 public:
  using std::runtime_error::runtime_error;
};

}  // namespace heddle
