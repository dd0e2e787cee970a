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

/// What one family of tows brings to the tension of the fabric.
struct TensionTow {
  double spacing = 0.0;      ///< middle to middle of neighbours [m]
  double step = 0.0;         ///< p: from crossing to crossing along the tow, the spacing of the other [m]
  double rest_height = 0.0;  ///< h0: crowns of crossing tows just touch [m]
  double interlacing = 1.0;  ///< share of steps with a change of side; the rest is straight [-]
  LengthLaw length;
  double rest_length = 0.0;      ///< l0 of one step, crimp included [m]
  TowStretch stretch{};          ///< of one tow
  TowStretch compression{};      ///< per width, of the fabric shortened along the tow
  double crimp_stiffness = 0.0;  ///< k_b: tow bending against a change of crimp height [N/m]

  /// At a fabric strain and crimp height, per step.
  struct State {
    double energy;            ///< of stretch [J]
    double force;             ///< N along the tow [N]
    double fabric_force;      ///< N cos th, averaged over changing and floating steps [N]
    double lift, lift_slope;  ///< dF/dh and d2F/dh2 of stretch and bending [N], [N/m]
    double bending_energy;    ///< k_b/2 (h - h0)^2 [J]
  };
  State evaluate(double strain, double height) const;
};

/// Biaxial tension of the fabric with crimp exchange, per crossing (initial area p1 p2).
///
///     F(h1, h2; e1, e2) = sum_i [l0 phi(l_i / l0 - 1) + k_b/2 (h_i - h0_i)^2] + U_c(h0_1 + h0_2 - h1 - h2)
///     w(e1, e2) = min_h F / (p1 p2) + compression(e1) + compression(e2)
///     n_i = dw/de_i = N_i cos th_i / spacing_i
///
/// l_i(p (1 + e_i), h_i) is jointly convex, phi convex and non-decreasing, the rest convex in h; so F is
/// jointly convex, and its minimum over h is convex in (e1, e2). The vertical balance N_i sin th_i = V/2 is
/// dF/dh = 0. In a weave with floats l_i is the mean over its steps, and all crowns of a family keep one
/// height: floats do not lift off. Source: Kawabata 1973, Hearle & Shanahan 1978 (energy form);
/// docs/theory/mesoscale.md.
struct TensionModel {
  std::array<TensionTow, 2> tow;  ///< {warp, weft}
  Curve crossover_force;          ///< V against approach c [N against m]

  double area() const { return tow[0].spacing * tow[1].spacing; }  ///< of one crossing [m^2]

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

/// Length law of a tow that goes round the tows of the other family.
LengthLaw length_law(const TowGeometry& own, const TowGeometry& other, PathForm form);

struct TensionOptions {
  PathForm form = PathForm::arc;
  double fibre_modulus = 72.4e9;              ///< [Pa]
  double compression_ratio = 0.01;            ///< [-]
  std::array<double, 2> bending_stiffness{};  ///< of the fabric along {warp, weft}, per width [N m]
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
