#include <fmt/format.h>

#include "pipeline/painter.h"

namespace heddle::pipeline {

namespace {

/// Colours of one scheme, light or dark.
struct Scheme {
  std::string_view sheet, ink, faint, grid, axis;
  std::array<std::string_view, series_styles> series;
  std::array<std::string_view, band_styles> bands;
  std::string_view warp, weft, edge;
  std::string_view ribbon, bar;
  std::array<std::string_view, signed_styles> signs;  ///< from far below zero to far above; text reads on all
};

/// Bands come in three families: stored energies blue, friction orange, the rest green and grey.
constexpr Scheme light{
    "#ffffff",
    "#1f2328",
    "#5c636b",
    "#e8eaed",
    "#9aa1a9",
    {"#0072b2", "#d55e00", "#009e73", "#b0578d", "#a87500", "#3d9bd1", "#6b5bb5", "#55606b"},
    {"#0b3c5d", "#1f6a9a", "#4e97c4", "#86bbdc", "#b7d7ea", "#dcebf4", "#a63d00", "#dd7420", "#f3b47a",
     "#0f7f5f", "#6dbb9c", "#8d949c"},
    "#c98a4b",
    "#5b86a8",
    "#ffffff",
    "#eceef0",
    "#9db8cc",
    {"#5aa5d6", "#86bde1", "#b3d5ec", "#dcebf5", "#f4f5f6", "#fbe8d6", "#f7cfa8", "#f1b177", "#e8914a"}};

constexpr Scheme dark{
    "#15181c",
    "#e6e8eb",
    "#a0a7af",
    "#2a2f35",
    "#666e77",
    {"#4aa8e0", "#f08a3c", "#2fc498", "#dd8bbb", "#e2b13c", "#8fcdf2", "#a99be8", "#b3bbc4"},
    {"#1d5f8e", "#2f80b5", "#55a0d0", "#80bbe0", "#a9d2ec", "#d0e6f5", "#c24e0a", "#e8842f", "#f6bd86",
     "#1b9a75", "#78c8a8", "#8d949c"},
    "#d59a5c",
    "#6d9bc0",
    "#15181c",
    "#262b31",
    "#3f566a",
    {"#1d679c", "#1b5580", "#1b4462", "#1b3346", "#20252b", "#3d2c1d", "#5c3b1c", "#7d4a1a", "#9c5714"}};

std::string rules(const Scheme& scheme) {
  std::string out = fmt::format(
      ".sheet{{fill:{}}}.picture text{{fill:{}}}.picture text.faint{{fill:{}}}.grid{{stroke:{}}}"
      ".axis,.frame{{stroke:{}}}.outline{{stroke:{}}}.warp{{fill:{}}}.weft{{fill:{}}}.edge{{stroke:{}}}"
      ".scale,.line.total{{stroke:{}}}",
      scheme.sheet, scheme.ink, scheme.faint, scheme.grid, scheme.axis, scheme.faint, scheme.warp,
      scheme.weft, scheme.edge, scheme.ink);
  out += fmt::format(".ribbon{{fill:{}}}.bar{{fill:{}}}.hollow{{fill:{};stroke:{}}}", scheme.ribbon,
                     scheme.bar, scheme.sheet, scheme.faint);
  for (std::size_t i = 0; i < scheme.signs.size(); ++i)
    out += fmt::format(".d{}{{fill:{}}}", i, scheme.signs[i]);
  for (int i = 0; i < series_styles; ++i) {
    const std::string_view colour = scheme.series[static_cast<std::size_t>(i)];
    out +=
        fmt::format(".line.s{0}{{stroke:{1}}}.dot.s{0}{{fill:{1}}}.picture text.s{0}{{fill:{1}}}", i, colour);
  }
  for (int i = 0; i < band_styles; ++i) {
    out += fmt::format(".b{}{{fill:{}}}", i, scheme.bands[static_cast<std::size_t>(i)]);
  }
  return out;
}

}  // namespace

std::string picture_style() {
  static constexpr std::array<std::string_view, series_styles> dashes{"none", "7 3", "2 3", "9 3 2 3",
                                                                      "12 4", "4 2", "1 2", "6 2 2 2 2 2"};
  std::string out =
      ".picture{font-family:system-ui,-apple-system,'Segoe UI',Roboto,'Helvetica Neue',Arial,sans-serif;"
      "font-size:12px}.picture text{stroke:none}.picture .title{font-weight:600}"
      ".grid,.axis,.frame,.outline,.line,.scale{fill:none}.grid,.axis{stroke-width:1}.frame{stroke-width:.8}"
      ".outline{stroke-width:1;stroke-dasharray:5 4}.line{stroke-width:1.8;stroke-linejoin:round;"
      "stroke-linecap:round}.edge{stroke-width:.8;stroke-linejoin:round}.scale{stroke-width:1.6}"
      ".thread{fill:none;stroke:#fff;stroke-opacity:.5;stroke-width:.6}"
      ".picture text.on-dark{fill:#fff;font-size:10px}.picture text.on-light{fill:#1f2328;font-size:10px}";
  for (int i = 1; i < series_styles; ++i) {
    out += fmt::format(".line.s{}{{stroke-dasharray:{}}}", i, dashes[static_cast<std::size_t>(i)]);
  }
  // Paper is white whatever the screen likes, so the dark scheme is for screens only.
  return out + rules(light) + "@media screen and (prefers-color-scheme:dark){" + rules(dark) + "}";
}

}  // namespace heddle::pipeline
