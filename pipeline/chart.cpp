#include "pipeline/chart.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <numeric>

namespace heddle::pipeline {

namespace {

struct Range {
  double low, high;
};

/// One axis laid out: where a value stands, and which ticks it has.
struct Ruler {
  Scale scale;
  Range values, pixels;
  std::vector<double> ticks;
  double step = 1.0;  ///< between ticks of a linear axis

  double at(double value) const {
    const double low = scale == Scale::linear ? values.low : std::log(values.low);
    const double high = scale == Scale::linear ? values.high : std::log(values.high);
    const double here = scale == Scale::linear ? value : std::log(value);
    return pixels.low + (here - low) / (high - low) * (pixels.high - pixels.low);
  }
  bool shows(double value) const { return std::isfinite(value) && (scale == Scale::linear || value > 0.0); }
  std::string text(double tick) const {
    return scale == Scale::linear ? tick_text(tick, step) : decade_text(tick);
  }
};

using Values = std::vector<const std::vector<double>*>;

Range range_of(const Values& columns, const Axis& axis) {
  double low = 1e300, high = -1e300;
  for (const auto* column : columns) {
    for (const double value : *column) {
      if (!std::isfinite(value) || (axis.scale == Scale::logarithmic && !(value > 0.0))) continue;
      low = std::min(low, value);
      high = std::max(high, value);
    }
  }
  if (low > high) low = axis.scale == Scale::linear ? 0.0 : 1.0, high = low + 1.0;
  low = axis.low.value_or(low);
  high = axis.high.value_or(high);
  if (high > low) return {low, high};
  return axis.scale == Scale::linear ? Range{low, low + 1.0} : Range{0.5 * low, 2.0 * low};
}

/// How far the data range is opened to a round number: the abscissa ends where the data end.
enum class Ends { data, rounded };

Ruler ruler(const Axis& axis, const Values& columns, Range pixels, int wanted, Ends ends) {
  Ruler out{axis.scale, range_of(columns, axis), pixels, {}};
  if (axis.scale == Scale::logarithmic) {
    if (ends == Ends::rounded) {
      out.values.low *= 0.9;
      out.values.high *= 1.1;
    }
    out.ticks = decade_ticks(out.values.low, out.values.high);
    return out;
  }
  out.ticks = nice_ticks(out.values.low, out.values.high, wanted);
  out.step = out.ticks.size() > 1 ? out.ticks[1] - out.ticks[0] : 1.0;
  if (ends == Ends::rounded) {
    out.values = {out.ticks.front(), out.ticks.back()};
  } else {
    std::erase_if(out.ticks, [&](double tick) {
      return tick < out.values.low - 1e-9 * out.step || tick > out.values.high + 1e-9 * out.step;
    });
  }
  return out;
}

/// An abscissa whose numbers stand clear of each other.
Ruler abscissa(const Axis& axis, const Values& columns, Range pixels) {
  constexpr double character = 7.0, clear = 8.0;  // [px]
  for (int wanted = 7;; --wanted) {
    Ruler out = ruler(axis, columns, pixels, wanted, Ends::data);
    if (axis.scale == Scale::logarithmic || wanted == 1) return out;
    bool crowded = false;
    for (std::size_t k = 1; k < out.ticks.size(); ++k) {
      const auto letters =
          static_cast<double>(out.text(out.ticks[k - 1]).size() + out.text(out.ticks[k]).size());
      crowded =
          crowded || out.at(out.ticks[k]) - out.at(out.ticks[k - 1]) < 0.5 * character * letters + clear;
    }
    if (!crowded) return out;
  }
}

std::string title(const Axis& axis) {
  return axis.unit.empty() ? axis.quantity : fmt::format("{} ({})", axis.quantity, axis.unit);
}

struct Frame {
  double left, right, top, bottom;  ///< of the plot [px]
};

void draw_axes(Canvas& canvas, const Frame& frame, const Ruler& x, const Ruler& y, const Axis& x_axis,
               const Axis& y_axis) {
  for (const double tick : y.ticks) {
    const double at = y.at(tick);
    canvas.line({frame.left, at}, {frame.right, at}, "grid");
    canvas.text({frame.left - 8, at + 4}, y.text(tick), Anchor::end, "faint");
  }
  for (const double tick : x.ticks) {
    const double at = x.at(tick);
    canvas.line({at, frame.bottom}, {at, frame.bottom + 5}, "axis");
    canvas.text({at, frame.bottom + 19}, x.text(tick), Anchor::middle, "faint");
  }
  const double zero = y.scale == Scale::linear && y.values.low < 0.0 ? y.at(0.0) : frame.bottom;
  canvas.line({frame.left, frame.bottom}, {frame.right, frame.bottom}, "axis");
  if (zero < frame.bottom) canvas.line({frame.left, zero}, {frame.right, zero}, "axis");
  canvas.text({frame.right, frame.bottom + 38}, title(x_axis), Anchor::end, "faint");
  canvas.text({frame.left, frame.top - 14}, title(y_axis), Anchor::start, "title");
}

std::vector<Point> pixels_of(const Series& series, const Ruler& x, const Ruler& y) {
  std::vector<Point> points;
  for (std::size_t i = 0; i < std::min(series.x.size(), series.y.size()); ++i) {
    if (x.shows(series.x[i]) && y.shows(series.y[i]))
      points.push_back({x.at(series.x[i]), y.at(series.y[i])});
  }
  return points;
}

/// Heights of labels moved apart until none touches its neighbour, each as near to its line as that allows.
std::vector<double> spread(std::vector<double> wanted, double gap, Range within) {
  std::vector<std::size_t> order(wanted.size());
  std::iota(order.begin(), order.end(), std::size_t{0});
  std::stable_sort(order.begin(), order.end(),
                   [&](std::size_t a, std::size_t b) { return wanted[a] < wanted[b]; });
  for (std::size_t i = 1; i < order.size(); ++i) {
    wanted[order[i]] = std::max(wanted[order[i]], wanted[order[i - 1]] + gap);
  }
  double ceiling = within.high;
  for (std::size_t i = order.size(); i-- > 0; ceiling -= gap) {
    wanted[order[i]] = std::min(wanted[order[i]], ceiling);
    ceiling = std::min(ceiling, wanted[order[i]]);
  }
  return wanted;
}

std::string series_style(std::string_view kind, std::size_t index) {
  return fmt::format("{} s{}", kind, index % series_styles);
}

void label_lines(Canvas& canvas, const Frame& frame, const std::vector<Series>& series,
                 const std::vector<std::vector<Point>>& lines) {
  std::vector<double> wanted;
  for (const auto& line : lines) wanted.push_back(line.empty() ? frame.bottom : line.back().y);
  const std::vector<double> heights = spread(wanted, 15.0, {frame.top, frame.bottom});
  for (std::size_t i = 0; i < series.size(); ++i) {
    if (lines[i].empty()) continue;
    const Point end = lines[i].back();
    const double left = frame.right + 18.0;
    // A thin lead joins a label that had to move, or that belongs to a line ending early, to its line.
    if (std::abs(heights[i] - end.y) > 2.0 || frame.right - end.x > 2.0) {
      const std::array<Point, 3> lead{
          {{end.x + 2, end.y}, {frame.right + 6, heights[i]}, {left - 3, heights[i]}}};
      canvas.polyline(lead, "grid");
    }
    canvas.text({left, heights[i] + 4}, series[i].name, Anchor::start, series_style("label", i));
  }
}

}  // namespace

Canvas draw(const LineChart& chart) {
  Canvas canvas(chart.width, chart.height, chart.label);
  const bool named =
      std::any_of(chart.series.begin(), chart.series.end(), [](const Series& s) { return !s.name.empty(); });
  const Frame frame{62.0, chart.width - (named ? chart.label_room : 16.0), 34.0, chart.height - 48.0};
  Values x_columns, y_columns;
  for (const Series& series : chart.series) {
    x_columns.push_back(&series.x);
    y_columns.push_back(&series.y);
  }
  for (const Ribbon& ribbon : chart.ribbons) {
    x_columns.push_back(&ribbon.x);
    y_columns.insert(y_columns.end(), {&ribbon.low, &ribbon.high});
  }
  const Ruler x = abscissa(chart.x, x_columns, {frame.left, frame.right});
  const int rows = std::max(2, static_cast<int>((frame.bottom - frame.top) / 52.0));
  const Ruler y = ruler(chart.y, y_columns, {frame.bottom, frame.top}, rows, Ends::rounded);
  for (const Ribbon& ribbon : chart.ribbons) {
    std::vector<Point> outline = pixels_of({"", ribbon.x, ribbon.high}, x, y);
    const std::vector<Point> low = pixels_of({"", ribbon.x, ribbon.low}, x, y);
    outline.insert(outline.end(), low.rbegin(), low.rend());
    canvas.polygon(outline, "ribbon");
  }
  draw_axes(canvas, frame, x, y, chart.x, chart.y);

  std::vector<std::vector<Point>> lines;
  for (std::size_t i = 0; i < chart.series.size(); ++i) {
    lines.push_back(pixels_of(chart.series[i], x, y));
    if (!chart.series[i].dots) canvas.polyline(lines.back(), series_style("line", i));
    for (std::size_t k = 0; chart.series[i].dots && k < lines.back().size(); ++k)
      canvas.disc(lines.back()[k], 3.5, series_style("dot", i));
  }
  if (named) label_lines(canvas, frame, chart.series, lines);
  return canvas;
}

namespace {

/// Running sums of the bands: level[k] is the top of the first k bands.
std::vector<std::vector<double>> levels(const StackedChart& chart) {
  std::vector<std::vector<double>> out(1, std::vector<double>(chart.at.size(), 0.0));
  for (const Series& band : chart.bands) {
    std::vector<double> next = out.back();
    for (std::size_t i = 0; i < next.size(); ++i) next[i] += band.y[i];
    out.push_back(std::move(next));
  }
  return out;
}

std::string band_style_name(const StackedChart& chart, std::size_t index) {
  return fmt::format("edge b{}", chart.band_style[index] % band_styles);
}

void draw_key(Canvas& canvas, const Frame& frame, const StackedChart& chart) {
  const double left = frame.right + 22.0, right = chart.width - 4.0;
  double row = frame.top + 4.0;
  canvas.text({right, row - 18}, fmt::format("at the end ({})", chart.y.unit), Anchor::end, "faint");
  const auto write = [&](const Series& series) {
    canvas.text({left + 24, row + 4}, series.name, Anchor::start, "label");
    canvas.text({right, row + 4}, series.y.empty() ? "" : significant(series.y.back(), 3), Anchor::end,
                "faint");
    row += 18.0;
  };
  for (std::size_t i = 0; i < chart.lines.size(); ++i) {
    canvas.line({left, row}, {left + 16, row}, "line total");
    write(chart.lines[i]);
  }
  for (std::size_t i = chart.bands.size(); i-- > 0;) {
    const std::array<Point, 4> swatch{
        {{left, row - 6}, {left + 16, row - 6}, {left + 16, row + 6}, {left, row + 6}}};
    canvas.polygon(swatch, band_style_name(chart, i));
    write(chart.bands[i]);
  }
}

}  // namespace

Canvas draw(const StackedChart& chart) {
  Canvas canvas(chart.width, chart.height, chart.label);
  const Frame frame{62.0, chart.width - chart.key_room, 34.0, chart.height - 48.0};
  const auto level = levels(chart);
  Values y_columns;
  for (const auto& column : level) y_columns.push_back(&column);
  for (const Series& line : chart.lines) y_columns.push_back(&line.y);
  const Ruler x = ruler(chart.x, {&chart.at}, {frame.left, frame.right}, 6, Ends::data);
  const Ruler y = ruler(chart.y, y_columns, {frame.bottom, frame.top}, 6, Ends::rounded);
  draw_axes(canvas, frame, x, y, chart.x, chart.y);

  for (std::size_t band = 0; band < chart.bands.size(); ++band) {
    std::vector<Point> outline;
    for (std::size_t i = 0; i < chart.at.size(); ++i)
      outline.push_back({x.at(chart.at[i]), y.at(level[band + 1][i])});
    for (std::size_t i = chart.at.size(); i-- > 0;)
      outline.push_back({x.at(chart.at[i]), y.at(level[band][i])});
    canvas.polygon(outline, band_style_name(chart, band));
  }
  for (std::size_t i = 0; i < chart.lines.size(); ++i) {
    canvas.polyline(pixels_of({"", chart.at, chart.lines[i].y}, x, y), "line total");
  }
  draw_key(canvas, frame, chart);
  return canvas;
}

}  // namespace heddle::pipeline
