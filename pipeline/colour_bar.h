#pragma once

#include "pipeline/picture.h"

/// What the coloured pictures share: steps of colour, the bar that explains them, and the bar of length.
namespace heddle::pipeline {

/// Colours come in so many steps, few enough that neighbours often share one and are written as one path.
inline constexpr int colour_steps = 64;
/// Right of a picture, for its colour bar [px].
inline constexpr double colour_bar_room = 74.0;
/// Above a picture, for the name of the colour bar [px].
inline constexpr double title_room = 34.0;

/// Step of a value, 0 to colour_steps - 1; the ends are held.
int colour_step(const ColourScale& scale, double value);
Colour colour_at(const ColourScale& scale, int step);

void draw_colour_bar(Canvas& canvas, const ColourScale& scale, double top, double bottom);
/// A bar of a round length, about a fifth of the room.
/// @param zoom  [px/m]
void draw_scale_bar(Canvas& canvas, double zoom, Point left_end, double room);

}  // namespace heddle::pipeline
