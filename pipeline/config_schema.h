#pragma once

#include <optional>
#include <string>
#include <vector>

namespace heddle::pipeline {

enum class KeyType {
  word,      ///< letters, digits, _ and -: becomes part of a folder name
  text,      ///< any text, checked by the room that reads it
  choice,    ///< one of `choices`
  integer,   ///< whole number
  quantity,  ///< number with unit; or one of `choices` where there are any
  pair,      ///< two quantities in a list
  list,      ///< any number of quantities in a list, at least one
  rows,      ///< list of lists of `columns` quantities each
  bits,      ///< list of lists of 0 and 1; as text "10/01"
  names,     ///< list of some of `choices`, or of any words where there are none; at least one
  file       ///< path of a file that exists, relative to the configuration file
};

enum class Presence {
  required,   ///< when its stage runs and its conditions hold
  defaulted,  ///< takes `default_text`
  optional,   ///< absent means something of its own
  later       ///< known, not read by this version
};

/// What a key is for: keys are asked for only if their stage runs.
enum class Stage {
  always,
  cell,
  solid,
  voxels,
  friction,
  friction_test,
  stamping,
  grid_error,
  orientation_study,
  study,
  calibrate,
  discover
};

/// One key of the configuration. The table of these is the one source of validation, defaults and the
/// reference page.
struct Key {
  std::string path;  ///< dotted
  KeyType type = KeyType::text;
  std::string unit = {};  ///< an example unit as core/units.h takes it; "" for plain numbers
  Presence presence = Presence::required;
  std::string default_text = {};  ///< YAML text
  std::string range = {};         ///< interval with units, "(0 mm, 100 mm]"; "" = any
  std::vector<std::string> choices = {};
  int columns = 0;  ///< of rows
  Stage stage = Stage::always;
  /// Conditions joined by blanks, all of which must hold for the key to be used: "friction.law=stribeck",
  /// "friction.calibration.data" (given), "!friction.calibration.data" (not given); "!a.key=word" holds
  /// unless it is that word.
  std::string used_when = {};
  std::string help = {};    ///< one line
  std::string family = {};  ///< keys of one family share a row of the reference page, under this path
};

/// All keys, in the order in which files and pages list them.
const std::vector<Key>& schema();

/// The key of this path, or nullptr.
const Key* find_key(const std::string& path);

/// Whether some key lies below this path, as "weave" does above "weave.gap".
bool is_block(const std::string& path);

/// Names of the keys and blocks directly below a block ("" = top level), in schema order.
std::vector<std::string> names_below(const std::string& block);

/// Half-open, open or closed interval with its text, in SI.
struct Interval {
  double low = 0.0, high = 0.0;  ///< infinite where there is no bound
  bool low_open = true, high_open = true;
  std::string low_text, high_text;
  bool contains(double value) const;
  /// "0 mm < gap <= 100 mm"
  std::string rule(const std::string& name) const;
};

/// @param range  as in Key::range
/// @param unit   as in Key::unit
Interval interval_of(const std::string& range, const std::string& unit);

}  // namespace heddle::pipeline
