#pragma once

#include <functional>
#include <span>
#include <string>
#include <string_view>
#include <vector>

#include "terms.h"

namespace blindgen {

/// Who would be to blame: friction itself, the rig, or something no library lists.
enum class Origin { friction, rig, outside };

/// One thing that can be hidden: how its shape is drawn, and where its strength stands.
struct Term {
  std::string_view id;
  Origin origin;
  std::function<void(Stream&, World&)> draw_shape;  ///< sets all but the strength
  std::function<double&(World&)> strength;          ///< absent: has no strength (a mislabelled condition)
  double limit;                                     ///< largest strength that makes sense
};

/// All of them: 15 of friction in the order F1 to F15, 6 of the rig (R1 to R6), 7 outside of the library.
const std::vector<Term>& catalogue();

/// Those of one origin, in order.
std::vector<const Term*> terms_of(Origin origin);

/// @return nullptr if there is no such id
const Term* term_named(std::string_view id);

/// A hidden term as it came out.
struct Hidden {
  std::string id;
  double asked = 0;     ///< size as drawn [-]
  double size = 0;      ///< size reached; less than asked where the strength met its limit [-]
  double strength = 0;  ///< in the unit of the term
};

/// Largest departure of ln F from the plain world on the axes of Table 2, with rests of 2 to 60 s, from 0.3
/// to 60 mm; counted from the middle of a baseline pull, as a fitted level would take away what is the same
/// everywhere.
/// @return [-], >= 0
double size_of(const World& plain, const World& changed);

/// Draws the shape of a term and its size, 15 to 30 % times `amplitude`, and sets the strength that reaches
/// it.
Hidden hide(const Term& term, double amplitude, Stream& stream, World& world);

/// Forces of one pull without noise, in fine steps of slip.
/// @param points  slips to read at [m], increasing, > 0
/// @return        pull force at each [N]
std::vector<double> pull(const World& world, const Condition& condition, std::span<const double> points);

}  // namespace blindgen
