#pragma once

#include <array>
#include <cstdint>
#include <functional>
#include <string>
#include <vector>

#include "mesoscale/film_flow.h"

namespace heddle::mesoscale {

/// One repeat of a film, periodic along both edges of a parallelogram: columns x rows elements, as many
/// nodes, row-major (first edge fastest). Gaps stand at the 2 x 2 Gauss points of the elements, so a step on
/// a grid line is a step.
struct FilmMap {
  int columns = 0, rows = 0;
  Eigen::Vector2d first{}, second{};          ///< edges of the repeat [m]
  std::vector<std::array<double, 4>> gap;     ///< h of each element's Gauss points [m], > 0
  std::vector<std::array<uint8_t, 4>> resin;  ///< 1 where resin fills the gap, 0 where air does
  std::vector<uint8_t> wet;                   ///< per node: 1 in the resin, 0 open to the air (p = 0)

  /// Per node, 0 to 1: how far it stands into the air. Where the resin's edge passes between nodes, those
  /// near it are tied to zero pressure the more the farther out they are, so that the load moves without
  /// jumps as the edge does. Empty: the edge follows the nodes.
  std::vector<double> openness;

  int elements() const { return columns * rows; }
  double element_area() const;  ///< [m^2]
};

/// Gauss points of the unit element, in the order of FilmMap::gap: {along first, along second}, 0 to 1.
extern const std::array<std::array<double, 2>, 4> film_points;

/// A map from functions of the place in the repeat, 0 to 1 along each edge.
/// @param gap  h [m] at a Gauss point
/// @param wet  whether a node is in the resin; Gauss points hold resin if any corner of their element is wet
FilmMap film_map(int columns, int rows, const Eigen::Vector2d& first, const Eigen::Vector2d& second,
                 const std::function<double(double, double)>& gap,
                 const std::function<bool(int column, int row)>& wet);

/// What a film does that is pulled below the pressure of the air.
enum class Rupture {
  at_zero_pressure,  ///< it breaks: p >= 0, div q >= 0, p div q = 0
  never              ///< it stands tension: div q = 0 wherever there is resin
};

struct ReynoldsOptions {
  Rupture rupture = Rupture::at_zero_pressure;
  /// Largest violation of complementarity against the largest flow U h/2 puts into a node. Newton's last step
  /// usually ends far below; pressures then change by less than their 1e-6.
  double tolerance = 1e-8;
  int iterations = 200;  ///< a break moves by a layer of nodes an iteration at worst
};

struct FilmPressure {
  bool converged = false;
  std::string reason;  ///< why not; empty if converged
  int iterations = 0;
  double residual = 0.0;         ///< as ReynoldsOptions::tolerance
  std::vector<double> pressure;  ///< per node, over the air's [Pa]
  double load = 0.0;             ///< mean pressure over the repeat [Pa]
  Eigen::Vector2d traction =
      Eigen::Vector2d::Zero();  ///< mean stress the film puts against the tool's sliding [Pa]
  Eigen::Vector2d ruptured_traction =
      Eigen::Vector2d::Zero();  ///< part of it where the film has broken, taken as full [Pa]
  double dissipation = 0.0;  ///< mean power turned to heat in the film [W/m^2]; U . traction if all is well
  double resin_share = 0.0;  ///< share of the repeat with resin [-]
  double ruptured_share = 0.0;  ///< with resin but no pressure [-]
  /// Resin drawn in where the film begins, room that opens where it breaks, and film with its room that
  /// leaves at the end, per area of the repeat [m/s]: intake + voids = outflow.
  double intake = 0.0, voids = 0.0, outflow = 0.0;
};

/// Film between a resting fabric and a tool that slides over it (Reynolds' equation, generalised Newtonian):
///
///     q = U h / 2 - Q(grad p),   div q >= 0,   p >= 0,   p div q = 0 in the resin;   p = 0 in the air
///
/// the minimum over p >= 0 of the convex energy int Psi(grad p) - (h/2) U . grad p. Bilinear elements, 2 x 2
/// Gauss points; primal-dual active set (a semismooth Newton method) with line search on the energy, linear
/// systems by sparse Cholesky. Where the film has broken resin is let go, and where it closes again resin is
/// there to be taken in: the break conserves mass, the closing supposes it supplied (Swift and Stieber).
///
/// @param sliding  velocity of the tool U [m/s]
/// @param start    pressures to start from (empty: those of the film that never breaks, cut off at zero)
/// @throws InputError  if no node is open to the air: a closed film carries any load
/// @throws NumericalError  if a value is not finite
FilmPressure solve_reynolds(const FilmMap& map, const FilmFluid& fluid, const Eigen::Vector2d& sliding,
                            const ReynoldsOptions& options = {}, std::vector<double> start = {});

/// Pressures of a grid of half the spacing, bilinear between those of `coarse`.
std::vector<double> refine_pressure(const FilmMap& coarse, const std::vector<double>& pressure);

}  // namespace heddle::mesoscale
