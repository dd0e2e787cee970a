#pragma once

#include <array>
#include <map>
#include <string>
#include <vector>

#include "core/problem.h"
#include "pipeline/config_reader.h"
#include "pipeline/config_schema.h"
#include "pipeline/discover/noise_wish.h"
#include "pipeline/discover/options.h"

namespace heddle::pipeline {

/// What the block `discover` asks for. Numbers are matched to a model, effects to the library, when the data
/// are read.
struct DiscoverSpec {
  std::vector<std::string> numbers;                     ///< that the baseline may move; empty: the usual ones
  std::map<std::string, std::array<double, 2>> priors;  ///< {mean, standard deviation}
  std::vector<std::string> effects;                     ///< ids to try; empty: the whole library
  discover::NoiseWish noise;
  discover::SearchOptions search;
  discover::VerdictOptions verdict;
  double held_out = 0.25;
  int stretches = 8;
  int faces = 2;
  int seed = 1;
  double tow_pitch = 5.39e-3;  ///< [m]
};

std::vector<Key> discover_keys();
DiscoverSpec discover_of(const Settings& settings);
Problems check_discover(const DiscoverSpec& spec, const Settings& settings);

}  // namespace heddle::pipeline
