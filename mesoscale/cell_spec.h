#pragma once

#include <array>
#include <cstddef>
#include <optional>
#include <string>
#include <vector>

#include "core/problem.h"
#include "mesoscale/fabric_properties.h"

namespace heddle::mesoscale {

/// The tows of one direction. SI units.
struct TowSpec {
  double width;           ///< w [m]
  double gap;             ///< g, between neighbours [m]
  double thickness;       ///< t [m]
  double linear_density;  ///< of one commingled tow [kg/m]

  double pitch() const { return width + gap; }
};

/// What one direction has of its own; the rest is common to both.
struct OwnTow {
  std::optional<double> tow_width, gap, tow_thickness;  ///< [m]
  std::optional<double> linear_density;                 ///< [kg/m]

  bool operator==(const OwnTow&) const = default;
};

enum class SectionShape { lens, ellipse, power_ellipse, capped_lens, hybrid };

/// One half of a hybrid section: any shape but hybrid.
struct HalfSpec {
  SectionShape section = SectionShape::lens;
  double section_power = 0.5;  ///< n of the power ellipse [-]
  double section_cap = 0.6;    ///< arc of the capped lens over its width [-]

  bool operator==(const HalfSpec&) const = default;
};

/// What the user says of the weave (paper, Table 1). SI units.
struct WeaveSpec {
  std::string pattern = "plain";      ///< as parse_weave takes it
  double tow_width = 4.64e-3;         ///< w [m]
  double gap = 0.75e-3;               ///< g [m]
  double tow_thickness = 0.75e-3;     ///< t [m]
  double fabric_thickness = 1.5e-3;   ///< H [m]
  double linear_density = 1872e-6;    ///< of one commingled tow [kg/m]
  double fibre_mass_fraction = 0.60;  ///< glass / (glass + resin) [-]
  double fibre_density = 2550.0;      ///< [kg/m^3]
  double resin_density = 905.0;       ///< [kg/m^3]
  double fibre_modulus = 72.4e9;      ///< [Pa]
  double fibre_diameter = 18.5e-6;    ///< [m], recalled
  SectionShape section = SectionShape::lens;
  double section_power = 0.5;   ///< n of the power ellipse [-]
  double section_cap = 0.6;     ///< arc of the capped lens over its width [-]
  HalfSpec upper{}, lower{};    ///< of the hybrid section
  double upper_share = 0.5;     ///< upper half's thickness over the tow's [-]
  std::array<OwnTow, 2> own{};  ///< {warp, weft}
  /// h_warp / (h_warp + h_weft), of the crimp heights [-]; faces are flush unless it is given.
  std::optional<double> warp_crimp{};

  /// By how much the warp rises further than where faces are flush, h_warp - t_weft; the weft rises as much
  /// less. The fabric is thicker by its size [m].
  double crimp_excess() const;

  /// With what the direction has of its own. @param direction  0 = warp, 1 = weft
  TowSpec tow(std::size_t direction) const;

  bool operator==(const WeaveSpec&) const = default;
};

/// as_woven: as it leaves the loom; compacted: pressed to some thickness between the other two; consolidated:
/// so far that no void is left.
enum class CellState { as_woven, compacted, consolidated };

/// Melt of the resin between crossing tows: power law with an Arrhenius shift. SI units.
struct ResinSpec {
  double consistency = 6790.0;            ///< m [Pa s^n] at the reference temperature
  double power_index = 0.38;              ///< n [-]
  double film_thickness = 0.07e-3;        ///< h [m] (paper, section 2)
  double activation_energy = 42.0e3;      ///< [J/mol]
  double reference_temperature = 453.15;  ///< [K]
};

/// How the tows of plies lie that face each other (ply_facing.h): flat: each face as against a plate; shift:
/// by the same shift everywhere; mean: anyhow.
enum class Facing { flat, shift, mean };

/// The film for which friction's dependence on the direction of sliding is worked out (film_direction.h).
/// SI units.
struct FilmDirectionSpec {
  double speed = 50e-3;             ///< of the slip [m/s]
  double temperature = 453.15;      ///< of the film [K]
  std::optional<double> fill = {};  ///< share of the gap that resin fills [-]; absent: spread evenly (film.h)
  double roughness = 9.25e-6;       ///< film left where a tow is touched [m]; a fibre's radius, prior
  double boundary_friction = 0.2;   ///< of touching fibres [-], prior
  int samples = 64;                 ///< along each edge of the repeat: 64 or 128
};

/// Law of the tows' compaction (compaction.h). van_wyk is the network of exponent 3.
enum class CompactionChoice { toll, van_wyk, gutowski };

/// Constants of the forming laws that no source of ours measures: priors, each reported as unverified.
struct FormingSpec {
  CompactionChoice compaction = CompactionChoice::toll;
  double compaction_modulus = 3.2e6;  ///< k E of sigma = k E (V^n - V0^n) [Pa]
  double compaction_exponent = 5.0;   ///< n of Toll's law [-]; 5 planar networks, larger for bundles
  double gutowski_spring = 3e3;       ///< A_s [Pa]; as stiff as Toll's default where V = 0.4
  double gutowski_available = 0.85;   ///< V_a [-], between packed_fibre_fraction and hexagonal packing
  double tow_friction = 0.2;          ///< mu_t between crossing tows (lubricated) [-]
  double reference_tension = 800.0;   ///< tow tension per width at which the shear energy is taken [N/m]
  double in_tow_shear_share = 0.5;    ///< s_in: 0 = tows turn rigidly, 1 = they shear inside [-]
  double bonding = 0.3;               ///< chi: 0 = fibres slide freely in bending, 1 = bonded [-]
  double compression_ratio = 0.01;    ///< tangent in compression over tangent in tension [-]
};

/// Equal plies on one another, all turned alike. What they hold in common is a ply's; no forming law reads
/// this.
struct StackSpec {
  int plies = 1;
  /// Of each ply along warp and along weft, {xi, eta} of the weave [m]; as many as plies, or none: all on top
  /// of each other.
  std::vector<double> along_warp, along_weft;

  /// {along warp, along weft} of each ply [m].
  std::vector<std::array<double, 2>> shifts() const;
};
inline constexpr int most_plies = 8;

struct CellSpec {
  WeaveSpec weave;
  CellState state = CellState::as_woven;
  /// Of the compacted state, one of the two:
  std::optional<double> compacted_thickness;  ///< H [m]
  std::optional<double> compacted_pressure;   ///< of flat plates on both faces, which gives H [Pa]
  ResinSpec resin;
  FormingSpec forming;
  StackSpec stack;
  Facing facing = Facing::flat;
  std::array<double, 2> facing_shift{};        ///< of the upper ply, along warp and weft [m]
  std::optional<FilmDirectionSpec> film = {};  ///< absent: friction is alike in all directions
};

/// The first stage's answer: what the report shows of the cell.
struct CellSummary {
  double areal_density = 0.0;              ///< [kg/m^2]
  std::array<double, 2> crimp{};           ///< l/p - 1, {warp, weft} [-]
  std::array<double, 2> crimp_angle{};     ///< [rad]
  double gap_closure_angle = 0.0;          ///< trellis angle at which the first neighbours touch [rad]
  double locking_angle = 0.0;              ///< shear tangent 10 times its value at 20 deg [rad]
  double tow_fibre_volume_fraction = 0.0;  ///< [-]; of the fuller direction, as the next
  double tow_solid_volume_fraction = 0.0;  ///< glass and resin [-]
  double contact_area_fraction = 0.0;      ///< one face, depth 0.05 mm, gamma 0 [-]
  double tow_section_area = 0.0;           ///< vertical cut of a warp [m^2]
  double consolidated_thickness = 0.0;     ///< [m]
  double thickness = 0.0;                  ///< of the state [m]
  double tow_share = 0.0;                  ///< of the sheet's volume [-]
  double glass_share = 0.0, void_share = 0.0;
};

struct CellResult {
  CellSummary summary;
  FabricProperties fabric;
};

/// Everything wrong with the specification (keys are dotted paths of the configuration file).
Problems check(const CellSpec& spec);

/// The whole mesoscale stage: geometry, mass balance, forming laws, contact.
/// @throws InputError  if check(spec) finds something
CellResult analyse(const CellSpec& spec);

}  // namespace heddle::mesoscale
