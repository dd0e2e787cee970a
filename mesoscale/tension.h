#pragma once

#include <array>

#include "core/curve.h"
#include "core/surface.h"
#include "mesoscale/crossover.h"
#include "mesoscale/path.h"

namespace heddle::mesoscale {

/// Force along a tow against its strain: the glass only, EA, since the resin is molten. Fibres of a tow are
/// not all equally taut: the stiffness comes in over the strain eps_s as EA s^2 (3 - 2 s), s = eps / eps_s.
/// Nothing below zero strain, where tows wave. Energy is twice continuously differentiable, convex and
/// non-decreasing.
struct TowStretch {
  double stiffness;             ///< EA [N]; or [N/m] for a force per width
  double straightening = 1e-3;  ///< eps_s [-], prior

  struct Value {
    double energy, force, stiffness;  ///< per unit length [J/m], [N], [N]
  };
  Value evaluate(double strain) const;
};

/// Biaxial tension of the fabric with crimp exchange, per crossing (initial area p^2).
///
///     F(h1, h2; e1, e2) = sum_i l0 phi(l_i / l0 - 1) + k_b/2 (h_i - h0)^2  +  U_c(2 h0 - h1 - h2)
///     w(e1, e2) = min_h F / p^2 + compression(e1) + compression(e2),   n_i = dw/de_i = N_i cos th_i / p
///
/// l_i(p (1 + e_i), h_i) is jointly convex, phi convex and non-decreasing, the rest convex in h; so F is
/// jointly convex, and its minimum over h is convex in (e1, e2). The vertical balance N_i sin th_i = V/2 is
/// dF/dh = 0. Source: Kawabata 1973, Hearle & Shanahan 1978 (energy form); docs/theory/mesoscale.md.
struct TensionModel {
  double pitch = 0.0;        ///< p [m]
  double rest_height = 0.0;  ///< h0 = tow thickness: crowns of crossing tows just touch [m]
  std::array<double, 2> interlacing{1.0,
                                    1.0};  ///< share of steps with a change of side; the rest is straight [-]
  LengthLaw length;
  TowStretch stretch{};          ///< of one tow
  TowStretch compression{};      ///< per width, of the fabric shortened along a tow
  double crimp_stiffness = 0.0;  ///< k_b: tow bending against a change of crimp height [N/m]
  Curve crossover_force;         ///< V against approach c [N against m]

  double rest_length(int direction) const;  ///< l0 of one pitch, crimp included [m]

  struct State {
    double energy = 0.0;              ///< w [J/m^2]
    std::array<double, 2> tension{};  ///< n [N/m]
    std::array<double, 2> height{};   ///< h [m]
    double crossover_force = 0.0;     ///< V [N]
    int iterations = 0;
  };
  /// @param strain  engineering strains of the fabric {warp, weft} [-]
  /// @throws NumericalError  if the minimum is not found; names the strains
  State relax(const std::array<double, 2>& strain) const;
  /// The same from a guess of the crimp heights [m].
  State relax(const std::array<double, 2>& strain, std::array<double, 2> height) const;
};

struct TensionOptions {
  PathForm form = PathForm::arc;
  double fibre_modulus = 72.4e9;    ///< [Pa]
  double compression_ratio = 0.01;  ///< [-]
  double bending_stiffness = 0.0;   ///< of the fabric along a tow, per width [N m]
};
TensionModel tension_model(const FabricGeometry& fabric, const CompactionLaw& law,
                           const TensionOptions& options);

/// w on an even grid of strains; the spline's slopes are the tensions.
///
/// A spline THROUGH the samples has the curvature w'' - h^2/12 w'''', which is negative where stiffness sets
/// in. So the spline takes the samples as its B-spline coefficients instead: that adds h^2/6 times the
/// curvature of w, at most 1e-4 of the largest tension, and keeps it convex.
struct StrainGrid {
  double low = -0.02, high = 0.03;  ///< [-]
  int points = 301;                 ///< each way: a step of 1.67e-4, a sixth of eps_s
};
Surface tabulate(const TensionModel& model, const StrainGrid& grid = {});

}  // namespace heddle::mesoscale
