#pragma once

#include <array>
#include <span>
#include <string>
#include <string_view>
#include <vector>

/// A small painter of pictures as SVG text. Equal input gives equal bytes: coordinates are rounded to 0.1 px
/// and written as whole tenths, and no number passes through a locale. Colours are CSS classes, so that one
/// picture reads on a light and on a dark page (see `picture_style`).
namespace heddle::pipeline {

struct Point {
  double x = 0.0, y = 0.0;  ///< [px], y downwards
};

/// Red, green, blue of the sRGB space, 0..255.
using Colour = std::array<int, 3>;

/// `height` runs dark to light through warm greys, for relief; `angle` is a table like viridis (Smith & van
/// der Walt 2015): even steps of value look like even steps, also without colour vision and on paper.
enum class ColourMap { angle, height };

/// @param share  place in the map, 0..1; outside it the end colour is held
Colour colour_of(ColourMap map, double share);
std::string hex(Colour colour);

/// Round numbers that cover [low, high]: steps of 1, 2 or 5 times a power of ten, about `wanted` of them.
std::vector<double> nice_ticks(double low, double high, int wanted);
/// Ticks of a logarithmic axis inside [low, high], both > 0: decades, with 2 and 5 between them where fewer
/// than two and a half decades are shown.
std::vector<double> decade_ticks(double low, double high);
/// A tick as text, with as many decimals as the step needs: "0.05", "1 500", "10⁻⁵".
std::string tick_text(double value, double step);
std::string decade_text(double value);
/// Value to `digits` significant digits, without an exponent between 1e-4 and 1e6: "843", "0.0703",
/// "2.1e-07".
std::string significant(double value, int digits);
/// The same, or a dash for what is not known.
std::string significant_or_dash(double value, int digits);
/// Text made safe inside an element or a double-quoted attribute.
std::string escape(std::string_view text);

enum class Anchor { start, middle, end };
enum class Closure { open, closed };

/// SVG path of a polyline, with relative steps between rounded points so that rounding does not add up.
std::string path_data(std::span<const Point> points, Closure closure);

/// A sheet of width x height to draw on, in order; later strokes cover earlier ones.
class Canvas {
 public:
  /// @param label  what the picture shows, for readers who cannot see it
  Canvas(double width, double height, std::string label);

  /// @param style  CSS class names out of `picture_style`, for instance "grid" or "line s2"
  void line(Point from, Point to, std::string_view style);
  void path(std::string_view data, std::string_view style);
  void polyline(std::span<const Point> points, std::string_view style) {
    path(path_data(points, Closure::open), style);
  }
  void polygon(std::span<const Point> points, std::string_view style) {
    path(path_data(points, Closure::closed), style);
  }
  /// Filled with a colour out of a map rather than a class.
  void coloured_path(std::string_view data, Colour colour);
  void disc(Point centre, double radius, std::string_view style);
  void text(Point at, std::string_view content, Anchor anchor, std::string_view style);
  void text_upright(Point at, std::string_view content,
                    std::string_view style);  ///< turned by 90 degrees, centred
  void begin_group(std::string_view attributes);
  void end_group();

  double width() const { return width_; }
  double height() const { return height_; }
  /// For a page that carries `picture_style` itself.
  std::string inline_svg() const;
  /// A file of its own, with the style inside.
  std::string standalone_svg() const;

 private:
  std::string opening_tag(std::string_view attributes) const;
  double width_, height_;
  std::string label_, body_;
};

/// Number of distinct series styles "s0", "s1", ... (lines) and "b0", "b1", ... (bands).
inline constexpr int series_styles = 8;
inline constexpr int band_styles = 12;
/// And of fills for signed values, "d0" (far below zero) over "d4" (about zero) to "d8".
inline constexpr int signed_styles = 9;

/// CSS of every class the painter uses, for light pages, dark pages and print. Series colours after Okabe &
/// Ito (2008), lightened for dark pages; dashes tell them apart without colour.
std::string picture_style();

}  // namespace heddle::pipeline
