#pragma once

#include <optional>
#include <string>
#include <string_view>
#include <vector>

#include "core/problem.h"
#include "friction/friction_test.h"

namespace heddle::friction {

/// One force that a fit is held to: the steady part of a pull, or one stretch of it. SI units.
struct CouponRow {
  FrictionTestRow pull;             ///< conditions with the normal force as measured, and the measured force
  std::optional<double> slip = {};  ///< at which the force was read [m]; empty: steady
  double dwell = 0.0;               ///< rest under load before the pull [s]
  std::size_t condition = 0;        ///< rows with one number were meant to be alike
  std::size_t sample = 0;           ///< rows with one number come from one piece of fabric
  std::size_t day = 0;
  int stretch = 0;             ///< which of CouponReduction::stretches it is
  bool load_measured = false;  ///< the normal force is a measured one, not the nominal
  int line = 0;                ///< of the first line of the table behind it
};

/// Measured friction coupons. Rows of a sample follow each other.
struct CouponData {
  std::string file;
  std::vector<CouponRow> rows;
  std::vector<std::string> samples;     ///< names, by CouponRow::sample
  std::vector<std::string> days;        ///< names, by CouponRow::day; one, "", where the table has none
  std::size_t conditions = 0;           ///< how many differ
  std::vector<std::string> notes = {};  ///< what was reduced, what looks odd

  bool has_days() const { return days.size() > 1 || !days.front().empty(); }
};

struct CouponReduction {
  /// Stretches of slip of one pull, even in their logarithm, that are kept apart; 1: the steady half alone.
  int stretches = 1;
  /// Cut every pull at the same slips, from the table's shortest to its longest, so that stretches of
  /// different pulls can be compared. Else each pull between its own ends.
  bool same_stretches = false;
  int faces = 2;  ///< faces of the fabric that slide: 2 between plates, 1 under a sled
};

/// Reads measured coupons. Either one line a pull, as the friction-test table has it, or a history of lines
/// that share sample_id, day_id and condition, with displacement_mm.
///
/// Columns: velocity_mm_s, normal_force_N, tool_temperature_C, fabric_temperature_C, and force_measured_N or
/// pull_force_N; if wanted case, condition_id, sample_id, day_id, orientation_deg, dwell_s, time_s,
/// displacement_mm, normal_force_measured_N (used in place of the nominal one). Any order. Columns that a
/// friction test writes are passed over.
/// A history is cut to the second half of its displacement (the mean force there), or to stretches.
/// @throws InputError  with every problem and its line: columns, numbers, forces that suggest another unit
CouponData parse_coupons(std::string_view text, const std::string& file, const CouponReduction& reduction);
CouponData read_coupons(const std::string& path, const CouponReduction& reduction = {});

/// Measured coefficient of a row, F/(faces N).
double measured_coefficient(const CouponRow& row, int faces);

}  // namespace heddle::friction
