#pragma once

#include <memory>
#include <optional>
#include <string>
#include <variant>

#include <Eigen/Core>

#include "friction/model.h"
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
  /// Lowest point of a bowl of the opening's radius that closes it below, from the face [m]; 0 = open. Only
  /// where `up`, and at least radius + fillet.
  double bowl_depth = 0.0;
};

/// One of several equal sectors of a plate with a round opening, solid above z = level: those of polar angle
/// `from` to `to` (counter-clockwise, at most half a turn apart), beyond the opening. All edges are rounded
/// alike: d is exact where they meet square (C1 everywhere).
struct SectorShape {
  double level = 0.0;           ///< z of the flat face [m]
  double opening_radius = 1.0;  ///< [m]
  double fillet = 0.1;          ///< [m]
  double from = 0.0, to = 1.0;  ///< [rad]
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

using Shape = std::variant<PlaneShape, CylinderShape, HemisphereShape, RingShape, SectorShape,
                           CurvedPlateShape, BandShape>;

Distance distance(const Shape& shape, const Eigen::Vector3d& x);

/// How a tool moves: along z only. `driven` follows a prescribed position, `loaded` is a rigid body pressed
/// down by a force (and a spring), `sprung` hangs on a spring whose other end follows a prescribed position.
enum class Motion { fixed, driven, loaded, sprung };

enum class Role { punch, die, binder };
std::string name_of(Role role);  ///< as in the configuration

/// A shape turned about a point that moves with the tool.
struct Turn {
  Eigen::Matrix3d rotation =
      Eigen::Matrix3d::Identity();                  ///< from the shape as drawn to the tool as it stands
  Eigen::Vector3d pivot = Eigen::Vector3d::Zero();  ///< [m]
};

/// A tool that tilts as the fabric below it asks: free to turn about level axes through a point of its own.
/// Its unknowns are what a point at `arm` is lifted, and its mass and springs are spread so that there they
/// count in full: `arm` is their radius of gyration.
struct Tilt {
  Eigen::Vector3d pivot = Eigen::Vector3d::Zero();  ///< [m]
  double arm = 1.0;                                 ///< [m]
};

struct Tool {
  Role role = Role::die;
  Shape shape;
  Motion motion = Motion::fixed;
  double force = 0.0;      ///< downwards, for Motion::loaded [N]
  double mass = 0.0;       ///< for Motion::loaded [kg]
  double weight = 0.0;     ///< downwards besides, of gravity, for Motion::loaded [N]
  double stiffness = 0.0;  ///< of its spring; 0 = none (loaded) [N/m]
  double yield = 0.0;      ///< force at which the spring of a sprung tool yields to a push; 0 = never [N]
  std::optional<Turn> turn = {};
  std::optional<Tilt> tilt = {};  ///< for Motion::loaded; absent: stays level
  /// Its own law and effects, in place of those of the scene; absent: the scene's.
  std::optional<friction::Model> friction = {};
};

bool has_unknown(const Tool& tool);  ///< loaded and sprung tools have one of their own along z
int unknowns_of(const Tool& tool);   ///< 0 or 1 along z, 2 more where it tilts

/// Distance to the tool where it stands before it moves.
Distance distance(const Tool& tool, const Eigen::Vector3d& x);

}  // namespace heddle::macroscale
