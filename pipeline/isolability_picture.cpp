#include "pipeline/isolability_picture.h"

#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <cmath>

namespace heddle::pipeline {

namespace {

constexpr double cell = 21.0, left = 168.0, top = 150.0;
constexpr double far_apart = 6.0;  // standard deviations at which two colours no longer differ

void fill(Canvas& canvas, double x, double y, Colour colour) {
  const std::array<Point, 4> corners{Point{x, y}, {x + cell, y}, {x + cell, y + cell}, {x, y + cell}};
  canvas.coloured_path(path_data(corners, Closure::closed), colour);
}

}  // namespace

Canvas draw(const discover::ForwardModel& forward, const discover::Isolability& isolability) {
  const std::size_t count = isolability.effects.size();
  const double size = cell * static_cast<double>(count);
  Canvas canvas(left + size + 84.0, top + size + 8.0,
                "How far each effect, if it were true, lies from each other effect in this campaign");
  for (std::size_t k = 0; k < count; ++k) {
    const discover::EffectSight& sight = isolability.effects[k];
    const std::string& id = forward.candidates[sight.effect].id;
    const std::string style = sight.seen ? "" : "faint";
    const double middle = (static_cast<double>(k) + 0.5) * cell;
    canvas.text({left - 6.0, top + middle + 4.0}, id, Anchor::end, style);
    canvas.begin_group(
        fmt::format("transform=\"translate({:.1f} {:.1f}) rotate(-60)\"", left + middle + 4.0, top - 6.0));
    canvas.text({0.0, 0.0}, id, Anchor::start, style);
    canvas.end_group();
    for (std::size_t m = 0; m < count; ++m) {
      if (m == k) continue;
      const double lambda = isolability.lambda(static_cast<Eigen::Index>(k), static_cast<Eigen::Index>(m));
      const double x = left + static_cast<double>(m) * cell, y = top + static_cast<double>(k) * cell;
      const double share = std::min(std::sqrt(lambda) / far_apart, 1.0);
      fill(canvas, x, y, colour_of(ColourMap::height, share));
      const int percent = static_cast<int>(std::lround(100.0 * discover::swap_rate(lambda)));
      if (percent < 2) continue;
      canvas.text({x + 0.5 * cell, y + 0.5 * cell + 4.0}, std::to_string(percent), Anchor::middle,
                  share < 0.5 ? "on-dark" : "on-light");
    }
  }
  return canvas;
}

}  // namespace heddle::pipeline
