#include "pipeline/colour_bar.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>

namespace heddle::pipeline {

int colour_step(const ColourScale& scale, double value) {
  const double share = (value - scale.low) / (scale.high - scale.low);
  if (!std::isfinite(share)) return 0;
  return static_cast<int>(std::lround(std::clamp(share, 0.0, 1.0) * (colour_steps - 1)));
}

Colour colour_at(const ColourScale& scale, int step) {
  return colour_of(scale.map, static_cast<double>(step) / (colour_steps - 1));
}

namespace {

std::string rectangle(double left, double top, double width, double height) {
  const std::array<Point, 4> corners{
      {{left, top}, {left + width, top}, {left + width, top + height}, {left, top + height}}};
  return path_data(corners, Closure::closed);
}

}  // namespace

void draw_colour_bar(Canvas& canvas, const ColourScale& scale, double top, double bottom) {
  const double left = canvas.width() - colour_bar_room + 22.0;
  constexpr double width = 14.0;
  const double step = (bottom - top) / colour_steps;
  canvas.begin_group("shape-rendering=\"crispEdges\"");
  for (int i = 0; i < colour_steps; ++i) {
    // Each cell reaches half a pixel under the next, so that no line shows between them.
    canvas.coloured_path(rectangle(left, bottom - step * (i + 1), width, step + (i > 0 ? 0.5 : 0.0)),
                         colour_at(scale, i));
  }
  canvas.end_group();
  canvas.path(rectangle(left, top, width, bottom - top), "frame");
  const std::vector<double> ticks = nice_ticks(scale.low, scale.high, 5);
  const double tick_step = ticks.size() > 1 ? ticks[1] - ticks[0] : 1.0;
  for (const double tick : ticks) {
    const double share = (tick - scale.low) / (scale.high - scale.low);
    if (share < -1e-9 || share > 1.0 + 1e-9) continue;
    const double at = bottom - share * (bottom - top);
    canvas.line({left + width, at}, {left + width + 4, at}, "axis");
    canvas.text({left + width + 8, at + 4}, tick_text(tick, tick_step), Anchor::start, "faint");
  }
  const std::string name =
      scale.unit.empty() ? scale.quantity : fmt::format("{} ({})", scale.quantity, scale.unit);
  canvas.text({canvas.width() - 2, 18.0}, name, Anchor::end, "title");
}

void draw_scale_bar(Canvas& canvas, double zoom, Point left_end, double room) {
  if (!(zoom > 0.0)) return;
  const double wanted = 0.2 * room / zoom;
  const double decade = std::pow(10.0, std::floor(std::log10(wanted)));
  const double share = wanted / decade;
  const double length = decade * (share < 2.0 ? 1.0 : share < 5.0 ? 2.0 : 5.0);
  const Point right_end{left_end.x + zoom * length, left_end.y};
  const std::array<Point, 4> bar{
      {{left_end.x, left_end.y - 4}, left_end, right_end, {right_end.x, right_end.y - 4}}};
  canvas.polyline(bar, "scale");
  canvas.text({right_end.x + 8, right_end.y + 3}, fmt::format("{:g} mm", 1e3 * length), Anchor::start,
              "faint");
}

}  // namespace heddle::pipeline
