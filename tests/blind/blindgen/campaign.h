#pragma once

#include <cstdint>
#include <optional>
#include <string>
#include <vector>

#include "catalogue.h"

namespace blindgen {

enum class Kind { single, null, null_exact, pair, outside, rig };

std::optional<Kind> kind_named(std::string_view name);
std::string_view name_of(Kind kind);

/// Everything that decides a case. Equal specifications give equal bytes.
struct Spec {
  std::uint64_t seed = 1;
  int case_number = 0;  ///< >= 0; single and rig cases walk evenly through their effects
  Kind kind = Kind::single;
  Design design = Design::crossed48;
  std::vector<std::string> effects = {};  ///< empty: drawn
  double sample_scatter = 0.05;           ///< deviation of ln gain from sample to sample [-]
  double day_scatter = 0.02;              ///< the same from day to day [-]
  double amplitude = 1.0;                 ///< of what is hidden; 1 = 15 to 30 % of the force
  std::vector<Condition> extra = {};      ///< run on a day after all others; what came before keeps its bytes
};

/// What is hidden, and the world it is hidden in.
struct Case {
  World world;
  std::vector<Hidden> hidden;
};

/// @throws std::invalid_argument  an id is not in the catalogue, or not of the kind asked for
Case draw_case(const Spec& spec);

/// One reading.
struct Row {
  int condition = 0, sample = 0, day = 0;   ///< numbers from 1
  Condition nominal{};                      ///< as labelled
  double time = 0;                          ///< since the pull began [s]
  double slip = 0;                          ///< [m]
  double force = 0;                         ///< pull force [N]
  std::optional<double> normal_force = {};  ///< as measured [N]
};

/// A campaign on the rig: a few cells a day in random order, five samples a cell, and the baseline again each
/// day.
struct Campaign {
  std::vector<Row> rows;
  int days = 0;
  int mislabelled_sample = 0;  ///< 0: none
  std::vector<int> missing_conditions = {};
  std::vector<int> swapped_conditions = {};  ///< of the rig decoy: labels of these two are exchanged
};

Campaign measure(const Spec& spec, const Case& hidden);

std::string data_text(const Campaign& campaign);                                         ///< CSV
std::string sidecar_text();                                                              ///< YAML beside it
std::string truth_text(const Spec& spec, const Case& hidden, const Campaign& campaign);  ///< JSON

}  // namespace blindgen
