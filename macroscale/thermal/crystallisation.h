#pragma once

namespace heddle::macroscale::thermal {

/// A law's value and its slope in its argument.
struct Slope {
  double value = 0.0, slope = 0.0;
};

/// How fast a melt crystallises, and how far it has got: Nakamura's law with Ziabicki's bell for the rate,
///     x = 1 - exp(-P^n),   dP/dt = K(T) = K_max exp(-4 ln 2 (T - T_max)^2 / D^2)
/// x is the share of the crystals that form in the end. P = Int K dt is what a cell remembers: written in P
/// the law has no singular start (written in x it never begins), and x stays in 0..1 whatever the steps.
/// Crystals do not melt again: tools are colder than the blank.
/// Source: Nakamura et al. 1972, Ziabicki 1976. K_max and T_max are those of isotactic polypropylene
/// (recalled); D is set here so that a melt cooled by 10 K/min crystallises fastest at 118 degC, in the
/// middle of the 110 to 125 degC that such measurements give (recalled); a test measures it. None was
/// measured on this fabric.
struct Crystallisation {
  double rate = 0.55;                ///< K_max [1/s], >= 0; 0 = the melt stays a melt
  double peak_temperature = 338.15;  ///< T_max [K]
  double width = 49.3;               ///< D, width of the bell at half its height [K], > 0
  double exponent = 3.0;             ///< n [-], >= 1

  Slope rate_at(double temperature) const;  ///< K [1/s], dK/dT [1/(s K)]
  Slope degree_at(double progress) const;   ///< x [-], dx/dP [-]; P >= 0
  double steepest() const;                  ///< largest dK/dT [1/(s K)]
};

}  // namespace heddle::macroscale::thermal
