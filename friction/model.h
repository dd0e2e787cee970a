#pragma once

#include <optional>
#include <span>

#include "core/problem.h"
#include "friction/contact_point.h"
#include "friction/effects.h"
#include "friction/film/film_conduction.h"
#include "friction/laws.h"
#include "friction/power_law_film.h"
#include "friction/rheology/rheology.h"

namespace heddle::friction {

/// A friction law with its film and effects: a value type with value and slopes.
///
///     film (F1, F14, F9, F12) -> area (F6) -> Hs -> law -> F2, F3, F4, F5, F7, F8, F10, F11, F13, F15
///
/// With the film's own power law and no effect on the film this is mu = law(Hs) of friction/hersey.h.
struct Model {
  Law law = Coulomb{};
  PowerLawFilm film;
  Effects effects;
  CalibrationBox box;
  Rheology rheology = {};  ///< how the film's resin flows; as it stands, the film's own power law
  /// Heat of the film, on which F1, F11 and F12 then draw; absent = their own closed forms.
  std::optional<FilmConduction> conduction = {};
};

/// Whether mu depends on what the contact went through, so that a friction test must follow the pull.
bool has_memory(const Model& model);

/// @throws NumericalError  if mu or a slope is not finite, or mu is negative; the message names the quantity
/// and the
///                         contact point's numbers
Friction evaluate(const Model& model, const Context& context, const ContactState& state);

/// The same whatever comes out: negative or not finite is the caller's to judge (a search may pass through
/// it).
Friction evaluate_unchecked(const Model& model, const Context& context, const ContactState& state);

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
/// Effects that cannot be combined with the law, the rheology or each other are among the problems
/// (friction/combinations.h).
Problems check(const Model& model);

}  // namespace heddle::friction
