#pragma once

#include <cstddef>
#include <iosfwd>
#include <stdexcept>
#include <string>
#include <string_view>
#include <vector>

namespace heddle {

/// Stable name of a broken rule, for instance "weave.gap.range". It is made only from names written out in
/// the source, "..."_rule and "..."_family below: whoever reads the source has the list of all rules, and a
/// test reads it (tests/pipeline/rule_list_test.cpp). A name put together at run time does not compile.
class RuleId {
 public:
  RuleId() = default;
  const std::string& text() const { return text_; }
  /// As the source has it: "*.range" of a family.
  std::string_view name() const { return name_; }
  operator const std::string&() const { return text_; }
  friend bool operator==(const RuleId& id, std::string_view text) { return id.text_ == text; }

 private:
  friend class Rule;
  friend class RuleFamily;
  RuleId(std::string text, std::string_view name) : text_(std::move(text)), name_(name) {}
  std::string text_;
  std::string_view name_;  ///< of static storage
};

std::ostream& operator<<(std::ostream& stream, const RuleId& id);

/// One rule.
class Rule {
 public:
  operator RuleId() const { return {std::string(name_), name_}; }

 private:
  friend consteval Rule operator""_rule(const char* name, std::size_t size);
  constexpr explicit Rule(std::string_view name) : name_(name) {}
  std::string_view name_;
};

/// One rule that holds for several keys.
class RuleFamily {
 public:
  /// The rule for this key, which takes the place of the star: "*.range" of "weave.gap" is "weave.gap.range".
  /// Of no key at all (the file as a whole) the id is the rest of the name.
  RuleId of(std::string_view key) const;

 private:
  friend consteval RuleFamily operator""_family(const char* name, std::size_t size);
  constexpr explicit RuleFamily(std::string_view name) : name_(name) {}
  std::string_view name_;
};

/// How many stars the name of a rule has. What is no such name does not compile.
consteval int stars_in_rule_name(std::string_view name) {
  int stars = 0;
  for (const char c : name) {
    const bool letter = (c >= 'a' && c <= 'z') || (c >= '0' && c <= '9') || c == '_' || c == '.';
    if (!letter && c != '*') throw "a rule is named by small letters, digits, _ and .";
    if (c == '*') ++stars;
  }
  if (name.empty() || name.front() == '.' || name.back() == '.') throw "a rule has a name";
  return stars;
}

consteval Rule operator""_rule(const char* name, std::size_t size) {
  if (stars_in_rule_name({name, size}) != 0) throw "a name with a star is a \"...\"_family";
  return Rule({name, size});
}

consteval RuleFamily operator""_family(const char* name, std::size_t size) {
  if (stars_in_rule_name({name, size}) != 1) throw "the name of a family has one star, where the key stands";
  return RuleFamily({name, size});
}

/// One thing wrong with what the user gave: where, what, the rule, the way out.
/// A free `check(const T&)` beside each specification returns these; the pipeline adds file and line.
struct Problem {
  RuleId id;              ///< "weave.gap.range"
  std::string key;        ///< dotted path of the key, for instance "weave.gap"
  std::string value;      ///< the value as written, or formatted with its unit; may be empty
  std::string rule;       ///< "must satisfy 0 <= gap < 0.1 m"
  std::string way_out;    ///< "Table 1 gives 0.75 mm; write 0.75 mm."
  std::string file = {};  ///< filled in by the reader
  int line = 0;           ///< 1-based; 0 = not tied to a line
  /// Other keys the rule looks at: where one of them could not be read, nothing is known of the rule.
  std::vector<std::string> others = {};
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
