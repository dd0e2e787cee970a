#pragma once

#include <span>

#include "core/problem.h"
#include "friction/contact_point.h"
#include "friction/effects.h"
#include "friction/laws.h"
#include "friction/power_law_film.h"

namespace heddle::friction {

/// A friction law with its film and effects: a value type with value and slopes.
///
///     mu = law(Hs) -> effects in library order
struct Model {
  Law law = Coulomb{};
  PowerLawFilm film;
  Effects effects;
  CalibrationBox box;
};

/// @throws NumericalError  if mu or a slope is not finite, or mu is negative; the message names the quantity
/// and the
///                         contact point's numbers
Friction evaluate(const Model& model, const Context& context, const ContactState& state);

/// The same for many points; one dispatch on the law for the whole batch, no virtual call a point.
/// @param contexts, states, out  one entry a point, equal in size
/// @throws NumericalError  as above, with the number of the point
void evaluate(const Model& model, std::span<const Context> contexts, std::span<const ContactState> states,
              std::span<Friction> out);

/// Friction traction tau = mu p of one face (paper, Eqs 7 and 8, per area).
struct Traction {
  double value;           ///< tau [Pa], 0 without load
  double dtau_dspeed;     ///< [Pa s/m]
  double dtau_dpressure;  ///< d tau / d p = mu + p dmu/dp [-], finite at p = 0 as well
  Friction friction;      ///< what it was built from
};
Traction traction(const Model& model, const Context& context, const ContactState& state);

/// Keys are dotted paths of the configuration file. Parameters the chosen law does not use are not looked at.
Problems check(const Model& model);

}  // namespace heddle::friction
