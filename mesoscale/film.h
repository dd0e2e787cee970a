#pragma once

#include <optional>
#include <string>
#include <vector>

#include "mesoscale/contact.h"
#include "mesoscale/reynolds.h"

namespace heddle::mesoscale {

/// What a film between fabric and tool is made of. A study: the stamping keeps the paper's fixed h = 0.07 mm.
struct FilmSpec {
  FilmFluid fluid;      ///< at the temperature of the film
  double fill = 0.233;  ///< share of the gap under the tool that resin fills, narrowest places first [-]
  double roughness = 9.25e-6;      ///< h_r: film left where the tow is touched [m]; a fibre's radius, prior
  double boundary_friction = 0.2;  ///< mu_b of the touching fibres [-], prior
  int samples = 128;               ///< elements along each edge of the repeat; 16 times a power of two
};

/// Share of the room outside the glass that resin takes, spread evenly over tows, gaps and air: 0.233 for
/// Table 1.
double even_fill(const FabricGeometry& fabric);

/// The upper face of one repeat at one trellis angle, on grids of 16, 32, ... samples: depth of the face
/// below the crowns [m] at the Gauss points and at the nodes. Where there is no tow the depth is that of the
/// fabric.
struct FaceDepth {
  int samples = 0;
  std::vector<std::array<double, 4>> at_points;
  std::vector<double> at_nodes;
  std::vector<std::array<uint8_t, 4>> covered;  ///< 0 where there is no tow
  std::vector<uint8_t> covered_nodes;
};
FaceDepth face_depth(const UnitCell& cell, int samples);

/// The gap when the tool is `approach` below the touch of the crowns (negative: above it):
///
///     h = h_r + max(D - d, 0),   D = depth of the face
///
/// so a touched place keeps the film of its roughness. Resin fills the gap up to the width at which it takes
/// `fill` of the volume over the tows; wider places and openings between tows hold air.
FilmMap film_map(const UnitCell& cell, const FaceDepth& face, double approach, double roughness, double fill);

/// A tool that slides over the fabric under a nominal pressure.
struct FilmState {
  bool converged = false;
  std::string reason;                   ///< why not
  double approach = 0.0;                ///< d [m]; negative: the film alone carries, its least gap is h_r - d
  double least_gap = 0.0;               ///< [m]
  double film_load = 0.0;               ///< carried by the film [Pa of the cell]
  double solid_load = 0.0;              ///< by the touched tows [Pa of the cell]; 0 = the film carries all
  double touched_fraction = 0.0;        ///< phi [-]
  Eigen::Vector2d film_traction{};      ///< against the sliding [Pa of the cell]; x = warp
  double along = 0.0;                   ///< drag along the sliding, film and solid [Pa]
  double across = 0.0;                  ///< pull to the left of the sliding [Pa]
  double ruptured_share_of_drag = 0.0;  ///< of `along`, from film that has broken, taken as full [-]
  double resin_share = 0.0;             ///< share of the cell with resin [-]
  int solves = 0;                       ///< Reynolds solutions

  double pressure() const { return film_load + solid_load; }
  double friction() const { return along / pressure(); }  ///< mu [-]
  bool film_carries() const { return solid_load == 0.0; }
};

/// Film under one fabric at one trellis angle, ready for any pressure, speed and direction. Tows stand still
/// and are pressed flat by the tool alone, not by the film.
class FilmBearing {
 public:
  /// @throws InputError  for samples, fill or roughness outside their range
  FilmBearing(const FabricGeometry& fabric, const CompactionLaw& law, double shear_angle,
              const FilmSpec& spec);

  /// The film at a given approach [m], sliding U [m/s] in the fabric plane, x along the warp.
  FilmPressure film(double approach, const Eigen::Vector2d& sliding) const;
  FilmMap map(double approach) const;

  /// The approach at which film and touched tows together carry `pressure` (to 1e-4 of it). A film that
  /// cannot carry it alone is an answer: the tool then rests on the tows, which carry the rest.
  /// @param speed      [m/s], > 0
  /// @param direction  of the tool against the warp [rad]
  FilmState state(double pressure, double speed, double direction) const;

  const PlateContact& plate() const { return plate_; }

 private:
  UnitCell cell_;
  PlateContact plate_;
  FilmSpec spec_;
  std::vector<FaceDepth> faces_;  // coarse to fine
};

/// Friction against the direction of sliding. @param directions  against the warp [rad]
std::vector<FilmState> friction_by_direction(const FilmBearing& bearing, double pressure, double speed,
                                             const std::vector<double>& directions);
/// Largest over smallest of the drag along the sliding, less one [-].
double anisotropy(const std::vector<FilmState>& states);

}  // namespace heddle::mesoscale
