#pragma once

#include <string>
#include <vector>

#include "friction/friction_test.h"

namespace heddle::friction {

/// Factors of a test campaign that varies one at a time around a baseline (paper, Table 2). SI units; the
/// first level of each factor is its baseline.
struct TestDesign {
  std::vector<double> velocity;            ///< [m/s]
  std::vector<double> normal_force;        ///< [N]
  std::vector<double> tool_temperature;    ///< [K]
  std::vector<double> fabric_temperature;  ///< [K]
  std::vector<double> orientation;         ///< [rad]
  bool s_curve = false;                    ///< plates bent into an S as well as flat ones
};

/// The baseline, then each factor at each of its other levels. The plates are flat in all of them: a pull
/// between curved ones is a matter of the whole path (friction/rig/curved_plates.h).
std::vector<FrictionTestRow> one_at_a_time(const TestDesign& design);

/// Every combination of the levels of speed, load and temperatures; orientation stays at its baseline.
std::vector<FrictionTestRow> all_combinations(const TestDesign& design);

/// Reads a design: header `parameter,unit,baseline,additional`, one line a factor, additional levels
/// separated by ;. Parameters and units: velocity mm/s, normal_force N, tool_temperature C,
/// fabric_temperature C, orientation deg; and, if wanted, `bending,,flat,s_curve`.
/// @throws InputError  with every problem and its line
TestDesign parse_test_design(const std::string& text, const std::string& file);
TestDesign read_test_design(const std::string& path);

}  // namespace heddle::friction
