#pragma once

#include <string>
#include <string_view>
#include <vector>

#include "mesoscale/coupon_curves.h"

/// Measured shear tests of a fabric: crosshead force against displacement, reduced to the shear flow T_s that
/// the fabric's laws predict.
namespace heddle::pipeline {

enum class ShearTest { picture_frame, bias_extension };
const char* name_of(ShearTest test);  ///< "picture_frame", "bias_extension"

/// One moment of a test, reduced.
struct ShearPoint {
  double displacement = 0.0;  ///< of the crosshead [m]
  double force = 0.0;         ///< of the crosshead [N]
  double shear_angle = 0.0;   ///< as measured, else from the crosshead [rad]
  double shear_rate = 0.0;    ///< dg/dt [1/s]
  double flow = 0.0;          ///< T_s: power per initial area and shear rate [N/m]
};

/// One piece of fabric.
struct ShearCurve {
  ShearTest test = ShearTest::picture_frame;
  std::string condition, sample, day;
  mesoscale::PictureFrame frame;   ///< of a picture frame
  mesoscale::BiasExtension strip;  ///< of a bias extension
  double speed = 0.0;              ///< of the crosshead [m/s]
  double temperature = 0.0;        ///< of the fabric [K]
  std::vector<ShearPoint> points;  ///< displacement rising
};

/// Whether the header of a table is one of shear tests (it has a column `test`).
bool is_shear_table(std::string_view text);

/// Reads measured shear tests, one row a sample point.
///
/// Columns: test (picture_frame or bias_extension), condition_id, sample_id, speed_mm_s,
/// fabric_temperature_C, displacement_mm, force_N; frame_side_mm and, where the fabric fills less of it,
/// fabric_side_mm of a picture frame; strip_length_mm (between clamps, twice the width or more) and
/// strip_width_mm of a bias extension; if wanted day_id and shear_angle_deg, which then takes the place of
/// the crosshead's. Any order.
///
/// Power balances of mesoscale/coupon_curves.h, solved for T_s: of a bias extension point by point, since its
/// quarters are at half the angle of its middle. They are taken to flow as the middle did at their angle, at
/// about twice their rate: of a fabric that flows as rate^0.4 that is 30 % of their part at most.
/// @throws InputError  with every problem and its line: columns, numbers, geometry, curves that go back or
/// are too short,
///                     numbers that suggest another unit
std::vector<ShearCurve> parse_shear_tests(std::string_view text, const std::string& file);

}  // namespace heddle::pipeline
