#include "pipeline/picture.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <map>
#include <stdexcept>

#include "pipeline/colour_bar.h"

namespace heddle::pipeline {

namespace {

/// Runs of equal colour along the rows of a grid, one path a colour, in units of cells.
std::map<int, std::string> runs_by_colour(const GridPicture& picture) {
  std::map<int, std::string> paths;
  for (int j = 0; j < picture.ny; ++j) {
    const auto step_at = [&](int i) {
      return colour_step(picture.colours, picture.value[static_cast<std::size_t>(j * picture.nx + i)]);
    };
    for (int i = 0; i < picture.nx;) {
      int end = i + 1;
      while (end < picture.nx && step_at(end) == step_at(i)) ++end;
      paths[step_at(i)] += fmt::format("M{} {}h{}v1h-{}", i, picture.ny - 1 - j, end - i, end - i);
      i = end;
    }
  }
  return paths;
}

}  // namespace

Canvas draw(const GridPicture& picture) {
  if (picture.nx <= 0 || picture.ny <= 0 ||
      picture.value.size() != static_cast<std::size_t>(picture.nx) * static_cast<std::size_t>(picture.ny)) {
    throw std::invalid_argument(fmt::format("grid picture: {} values for {} x {} cells", picture.value.size(),
                                            picture.nx, picture.ny));
  }
  for (std::size_t i = 0; i < picture.value.size(); ++i) {
    if (!std::isfinite(picture.value[i])) {
      throw std::invalid_argument(fmt::format("grid picture: value {} is {}", i, picture.value[i]));
    }
  }
  const double room = picture.width - colour_bar_room - 8.0;
  const double zoom = room / (picture.nx * picture.spacing_x);
  const double height = zoom * picture.ny * picture.spacing_y;
  Canvas canvas(picture.width, title_room + height + 34.0, picture.label);
  // The group moves whole cells to pixels; crisp edges leave no seams between them.
  canvas.begin_group(
      fmt::format("transform=\"translate(8 {:g}) scale({:.5g} {:.5g})\" shape-rendering=\"crispEdges\"",
                  title_room, room / picture.nx, height / picture.ny));
  for (const auto& [step, path] : runs_by_colour(picture))
    canvas.coloured_path(path, colour_at(picture.colours, step));
  canvas.end_group();
  draw_colour_bar(canvas, picture.colours, title_room, title_room + std::min(260.0, height));
  draw_scale_bar(canvas, zoom, {8.0, title_room + height + 24.0}, room);
  return canvas;
}

namespace {

/// A section at true proportions on the sheet.
struct SectionView {
  double left, right, low, high;                      ///< of the lines [m]
  double zoom;                                        ///< [px/m]
  static constexpr double margin = 62.0, top = 34.0;  ///< [px]

  double bottom() const { return top + zoom * (high - low); }
  Point pixel(double along, double height) const {
    return {margin + zoom * (along - left), bottom() - zoom * (height - low)};
  }
};

SectionView view_of(const SectionPicture& picture) {
  SectionView view{1e300, -1e300, 1e300, -1e300, 1.0};
  for (const SectionLine& line : picture.lines) {
    for (const auto& point : line.points) {
      view.left = std::min(view.left, point[0]), view.right = std::max(view.right, point[0]);
      view.low = std::min(view.low, point[1]), view.high = std::max(view.high, point[1]);
    }
  }
  if (!(view.right > view.left) || !(view.high > view.low)) {
    throw std::invalid_argument("section picture: the lines span no area");
  }
  view.zoom = (picture.width - SectionView::margin - 16.0) / (view.right - view.left);
  return view;
}

struct Ticks {
  std::vector<double> at;  ///< [mm]
  double step;             ///< [mm]
};

Ticks millimetre_ticks(double low, double high, int wanted) {
  Ticks ticks{nice_ticks(1e3 * low, 1e3 * high, wanted), 1.0};
  if (ticks.at.size() > 1) ticks.step = ticks.at[1] - ticks.at[0];
  std::erase_if(ticks.at, [&](double tick) { return tick < 1e3 * low - 1e-9 || tick > 1e3 * high + 1e-9; });
  return ticks;
}

void draw_rulers(Canvas& canvas, const SectionView& view, const std::string& along_name) {
  const double bottom = view.bottom();
  const Ticks along = millimetre_ticks(view.left, view.right, 8);
  for (const double tick : along.at) {
    const double x = view.pixel(1e-3 * tick, view.low).x;
    canvas.line({x, bottom + 6}, {x, bottom + 11}, "axis");
    canvas.text({x, bottom + 25}, tick_text(tick, along.step), Anchor::middle, "faint");
  }
  const int rows = std::clamp(static_cast<int>((bottom - SectionView::top) / 36.0), 2, 6);
  const Ticks heights = millimetre_ticks(view.low, view.high, rows);
  for (const double tick : heights.at) {
    const Point at = view.pixel(view.left, 1e-3 * tick);
    canvas.line({at.x - 11, at.y}, {at.x - 6, at.y}, "axis");
    canvas.text({at.x - 15, at.y + 4}, tick_text(tick, heights.step), Anchor::end, "faint");
  }
  canvas.text({canvas.width() - 16.0, bottom + 43}, along_name + " (mm)", Anchor::end, "faint");
  canvas.text({SectionView::margin, 20.0}, "Height (mm)", Anchor::start, "title");
}

}  // namespace

Canvas draw(const SectionPicture& picture) {
  const SectionView view = view_of(picture);
  Canvas canvas(picture.width, view.bottom() + 52.0, picture.label);
  for (const SectionLine& line : picture.lines) {
    std::vector<Point> points;
    for (const auto& point : line.points) points.push_back(view.pixel(point[0], point[1]));
    if (line.kind == SectionKind::outline) {
      canvas.polyline(points, "line total");
    } else {
      canvas.polygon(points, line.kind == SectionKind::warp ? "edge warp" : "edge weft");
    }
  }
  draw_rulers(canvas, view, picture.along);
  return canvas;
}

}  // namespace heddle::pipeline
