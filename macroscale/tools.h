#pragma once

#include <memory>
#include <string>
#include <variant>

#include <Eigen/Core>

#include "friction/rig/curved_plates.h"

namespace heddle::macroscale {

/// Signed distance to a rigid surface (positive outside the tool), its unit normal (gradient) and its
/// Hessian.
struct Distance {
  double distance;            ///< [m]
  Eigen::Vector3d normal;     ///< away from the tool
  Eigen::Matrix3d curvature;  ///< second derivative of the distance [1/m]
};

/// Half space below the plane through `point` with outward normal `normal` (unit).
struct PlaneShape {
  Eigen::Vector3d point = Eigen::Vector3d::Zero();
  Eigen::Vector3d normal = Eigen::Vector3d::UnitZ();
};

/// Infinite cylinder, axis along y.
struct CylinderShape {
  Eigen::Vector3d centre = Eigen::Vector3d::Zero();
  double radius = 1.0;  ///< [m]
};

/// Hemisphere with its apex down at `apex`, carried on by a cylinder above its centre. C1.
struct HemisphereShape {
  Eigen::Vector3d apex = Eigen::Vector3d::Zero();
  double radius = 1.0;  ///< [m]
};

/// Plate with a round opening and a rounded edge, C1. `up`: solid below the plane z = level (a die);
/// otherwise solid above it (a binder).
struct RingShape {
  double level = 0.0;           ///< z of the flat face [m]
  double opening_radius = 1.0;  ///< [m]
  double fillet = 0.1;          ///< [m]
  bool up = true;
};

/// One of two matched plates along y, bent as `path` from x = start on; the middle between them lies at z =
/// level before the bend. `up`: the lower plate, solid below. The distance is exact within the bend's radius
/// of the path.
struct CurvedPlateShape {
  friction::SCurve path;
  double start = 0.0;  ///< x where the first arc begins [m]
  double level = 0.0;  ///< z of the middle there [m]
  double gap = 0.0;    ///< between the plates, along their normal [m]
  bool up = true;
};

/// The path's middle at s from x = start on.
Eigen::Vector3d place_on(const CurvedPlateShape& plate, double s);

class ToolBand;

/// A tool from a file: the narrow band about its surface (macroscale/tool_band.h, which says what holds
/// beyond the band). Its normal is the gradient of an interpolated distance, of length 1 up to the
/// interpolation error.
struct BandShape {
  std::shared_ptr<const ToolBand> band;
  Eigen::Vector3d offset = Eigen::Vector3d::Zero();  ///< where the file's origin stands [m]
};

using Shape =
    std::variant<PlaneShape, CylinderShape, HemisphereShape, RingShape, CurvedPlateShape, BandShape>;

Distance distance(const Shape& shape, const Eigen::Vector3d& x);

/// How a tool moves: along z only. `driven` follows a prescribed position, `loaded` is a rigid body pressed
/// down by a constant force.
enum class Motion { fixed, driven, loaded };

enum class Role { punch, die, binder };
std::string name_of(Role role);  ///< as in the configuration

struct Tool {
  Role role = Role::die;
  Shape shape;
  Motion motion = Motion::fixed;
  double force = 0.0;  ///< downwards, for Motion::loaded [N]
  double mass = 0.0;   ///< for Motion::loaded [kg]
};

}  // namespace heddle::macroscale
