#pragma once

#include <vector>

#include "mesoscale/fabric_properties.h"

/// What the two usual shear tests of a fabric would show, from its forming laws alone.
namespace heddle::mesoscale {

/// A frame of four hinged bars that shears the fabric clamped in it.
struct PictureFrame {
  double side = 0.2;         ///< L, hinge to hinge [m]; ours
  double fabric_side = 0.2;  ///< L_f of the fabric that shears [m]; ours
};

/// A strip cut at 45 degrees to its tows and pulled. Its middle shears by g, the quarters beside it by g / 2,
/// its ends not at all.
struct BiasExtension {
  double length = 0.3;  ///< H_s between the clamps, at least twice the width [m]; ours
  double width = 0.1;   ///< W [m]; ours
};

/// One moment of such a test. SI units.
struct CouponPoint {
  double displacement = 0.0;  ///< of the crosshead [m]
  double shear_angle = 0.0;   ///< g of the fabric, or of the strip's middle [rad]
  double shear_rate = 0.0;    ///< dg/dt there [1/s]
  double force = 0.0;         ///< of the crosshead [N]
  double normalised = 0.0;    ///< shear force per width F_s = T_s(g) / cos g, which labs compare [N/m]
};

/// T_s: power per initial area and shear rate, from the elastic law and the rate's dissipation [N/m].
double shear_flow(const FabricProperties& fabric, double shear_angle, double shear_rate, double temperature);

/// How the crosshead moves and how hot the fabric is.
struct CouponPull {
  double speed = 0.0;           ///< of the crosshead [m/s]; 0: without the rate's part
  double temperature = 453.15;  ///< [K]
  double highest = 1.0;         ///< shear angle at the end [rad]
  int points = 101;
};

/// Power balance F dx = T_s dg L_f^2 with x = 2 L cos(phi), phi = pi/4 - g/2 half the angle of the frame:
///     F = T_s L_f^2 / (L sin phi)
/// With L_f = L this is F_s = F / (2 L cos phi). Source: the usual reduction (Peng et al. 2004; recalled).
std::vector<CouponPoint> picture_frame(const FabricProperties& fabric, const PictureFrame& frame,
                                       const CouponPull& pull);

/// Power balance over the zones, D = H_s - W, x + D = D (cos(g/2) + sin(g/2)):
///     F D (cos(g/2) - sin(g/2)) = W (2 H_s - 3 W) T_s(g) + W^2 T_s(g/2)
/// The middle alone is reported as `normalised`. Source: Harrison et al. 2004 (recalled); zones without slip.
std::vector<CouponPoint> bias_extension(const FabricProperties& fabric, const BiasExtension& strip,
                                        const CouponPull& pull);

}  // namespace heddle::mesoscale
