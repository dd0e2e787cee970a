#pragma once

#include <array>
#include <filesystem>
#include <optional>
#include <string>
#include <vector>

#include "core/problem.h"
#include "mesoscale/cell_spec.h"

/// What the user knows of a fabric, in place of what its weave gives: the one step between unit cell and
/// stamping.
namespace heddle::pipeline {

/// Areal density, thickness, contact area and the rate of shear stay those of the weave.
struct FabricOverride {
  std::filesystem::path shear;                     ///< table of a picture frame; empty: the weave's curve
  std::filesystem::path tension;                   ///< table of tensions of warp and weft; empty: the weave's
  std::filesystem::path compaction;                ///< table of pressure over thickness; empty: the weave's
  std::array<std::optional<double>, 2> bending{};  ///< B {along warp, along weft} [N m]
  double shear_scale = 1.0;                        ///< on the rate-free shear resistance [-]
  double tension_scale = 1.0;                      ///< on the tension energy [-]
};

/// What is given, one line each: "shear: frame.csv", "tension: times 0.1". Files by their names alone.
std::vector<std::string> in_words(const FabricOverride& given);

/// What is wrong with the tables, each with its line; empty where none is given.
/// @param thickness  of the weave without pressure, where a table of compaction must begin [m]
Problems check(const FabricOverride& given, double thickness);

/// The fabric with everything given in its place; priors that no law reads any more are no longer named.
/// Nothing given: the same bits.
/// The summary stays that of the weave, its locking angle as well.
///
///     shear       dPsi/ds(sin gamma) = F_s, the normalised force of a picture frame
///     (mesoscale/coupon_curves.h) tension     w(e1, e2) = W_1(e1) + W_2(e2), W_i' = n_i of the table, each
///     tow by itself; the weave's own
///                 curve where the tow is shortened
///     compaction  p(d), d = (H - h) / 2, at every shear angle
///
/// Beyond a table its curve goes on straight (against sin gamma, d), tension with its last stiffness.
/// @throws InputError  with every problem of the tables
mesoscale::CellResult with_given(mesoscale::CellResult weave, const FabricOverride& given);

/// The unit cell, with everything given in its place.
/// @throws InputError  as above
mesoscale::CellResult analyse_cell(const mesoscale::CellSpec& cell, const FabricOverride& given);

}  // namespace heddle::pipeline
