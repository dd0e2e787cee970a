#pragma once

#include <iterator>
#include <string>
#include <utility>
#include <vector>

#include "pipeline/config_schema.h"

/// What tables of keys are put together with.
namespace heddle::pipeline {

inline constexpr auto required = Presence::required;
inline constexpr auto defaulted = Presence::defaulted;
inline constexpr auto optional = Presence::optional;

inline void append(std::vector<Key>& keys, std::vector<Key> more) {
  keys.insert(keys.end(), std::make_move_iterator(more.begin()), std::make_move_iterator(more.end()));
}

/// A key that is known and not in this version: asking for it says so.
inline Key later(std::string path, std::string help) {
  return {.path = std::move(path), .presence = Presence::later, .help = std::move(help)};
}

}  // namespace heddle::pipeline
