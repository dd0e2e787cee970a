#pragma once

#include <vector>

#include "pipeline/discover/planned.h"

namespace heddle::discover {

/// Numbers of a condition that a lab sets.
struct Knob {
  const char* column;  ///< of tables: "tool_temperature_C"
  double (*get)(const CouponCell&);
  void (*set)(CouponCell&, double);
};
const std::vector<Knob>& knobs();

/// Levels of each knob that cells use, rising, in the order of knobs().
std::vector<std::vector<double>> levels_of(const std::vector<CouponCell>& cells);

/// Cells with the same settings of every knob get one number of condition, in order of appearance.
void number_conditions(std::vector<CouponCell>& cells);

struct ExchangeOptions {
  int stretches = 3;   ///< of each pull while searching: a coarse look at its history
  int passes = 6;      ///< over all cells at most
  double gain = 1e-4;  ///< of the criterion below which an exchange is not worth it
};

struct Exchange {
  std::vector<CouponCell> cells;  ///< as many, with as many samples each, on the same days
  int exchanges = 0;
  double before = 0.0, after = 0.0;  ///< of the criterion
};

/// What the exchange climbs: mean over effects of Phi(length - 3), that it is seen, times the product over
/// its rivals of 1 - swap rate. Smooth, with no draws; a bound from below for the rate of right names, not
/// that rate.
double criterion_of(const std::vector<Fingerprint>& prints);

/// Coordinate exchange (Meyer and Nachtsheim): every cell in turn tries every level of every knob that the
/// design names, and takes the best. The first cell stays, and so does a condition that three days or more
/// repeat: it tells the scatter of days.
Exchange exchanged_design(const CouponQuestion& question, std::vector<CouponCell> cells,
                          const ExchangeOptions& options = {});

}  // namespace heddle::discover
