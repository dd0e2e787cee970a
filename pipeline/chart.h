#pragma once

#include <optional>
#include <string>
#include <vector>

#include "pipeline/painter.h"

namespace heddle::pipeline {

enum class Scale { linear, logarithmic };

/// One axis of a chart. Values arrive in the unit that `unit` names.
struct Axis {
  std::string quantity;  ///< "Punch displacement"
  std::string unit;      ///< "mm"; may be empty
  Scale scale = Scale::linear;
  std::optional<double> low = {}, high = {};  ///< as shown; otherwise from the data
};

struct Series {
  std::string name;  ///< written at the end of its line
  std::vector<double> x,
      y;  ///< same size; points that are not finite, or not > 0 on a logarithmic axis, are left out
  bool dots = false;  ///< single points instead of a line
};

/// A soft band behind the lines, from low to high: what noise alone would do, or how far a curve is known.
struct Ribbon {
  std::vector<double> x, low, high;  ///< same size
};

/// Lines over a common abscissa, each named at its right end in its own colour and dash.
struct LineChart {
  std::string label;  ///< what the chart shows, for readers who cannot see it
  Axis x, y;
  std::vector<Series> series;
  std::vector<Ribbon> ribbons = {};
  double width = 720.0, height = 360.0;  ///< [px]
  double label_room = 130.0;             ///< right of the plot, for the names [px]
};

Canvas draw(const LineChart& chart);

/// Bands stacked on one another, in order, with lines above them; every band is named in a key with its last
/// value.
struct StackedChart {
  std::string label;
  Axis x, y;
  std::vector<double> at;       ///< abscissa of all bands
  std::vector<Series> bands;    ///< y as `at`; x unused
  std::vector<int> band_style;  ///< style number of each band, 0..band_styles - 1
  std::vector<Series> lines;    ///< y as `at`; x unused
  double width = 720.0, height = 400.0;
  double key_room = 210.0;  ///< right of the plot, for the key [px]
};

Canvas draw(const StackedChart& chart);

}  // namespace heddle::pipeline
