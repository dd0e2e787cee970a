#include "pipeline/painter.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>

namespace heddle::pipeline {

namespace {

constexpr std::array<Colour, 10> angle_map{{{68, 1, 84},
                                            {72, 40, 120},
                                            {62, 74, 137},
                                            {49, 104, 142},
                                            {38, 130, 142},
                                            {31, 158, 137},
                                            {53, 183, 121},
                                            {110, 206, 88},
                                            {181, 222, 43},
                                            {253, 231, 37}}};

constexpr std::array<Colour, 6> height_map{
    {{33, 36, 48}, {76, 72, 84}, {125, 108, 101}, {178, 149, 118}, {222, 199, 158}, {250, 242, 222}}};

template <std::size_t N>
Colour blend(const std::array<Colour, N>& map, double share) {
  const double place = std::clamp(share, 0.0, 1.0) * static_cast<double>(N - 1);
  const std::size_t low = std::min(static_cast<std::size_t>(place), N - 2);
  const double part = place - static_cast<double>(low);
  Colour out{};
  for (std::size_t c = 0; c < 3; ++c) {
    out[c] = static_cast<int>(std::lround((1.0 - part) * map[low][c] + part * map[low + 1][c]));
  }
  return out;
}

/// Whole tenths of a pixel as text: 123 -> "12.3", 120 -> "12", 1 -> ".1".
std::string tenths_text(long tenths) {
  const long size = std::abs(tenths);
  const std::string_view sign = tenths < 0 ? "-" : "";
  if (size % 10 == 0) return fmt::format("{}{}", sign, size / 10);
  if (size < 10) return fmt::format("{}.{}", sign, size);
  return fmt::format("{}{}.{}", sign, size / 10, size % 10);
}

long tenths(double pixels) {
  return std::lround(10.0 * pixels);
}
std::string pixel_text(double pixels) {
  return tenths_text(tenths(pixels));
}

/// A pair of numbers with the blank left out where a sign separates them already.
std::string pair_text(long x, long y) {
  const std::string first = tenths_text(x), second = tenths_text(y);
  return second.front() == '-' ? first + second : first + " " + second;
}

/// 12345 -> "12 345" (thin blanks), from five digits on.
std::string grouped(std::string digits) {
  const std::size_t point = std::min(digits.find('.'), digits.size());
  const std::size_t first = digits.front() == '-' ? 1 : 0;
  if (point - first < 5) return digits;
  for (std::size_t at = point; at > first + 3;) {
    at -= 3;
    digits.insert(at, "\u2009");
  }
  return digits;
}

/// Upright minus, as wide as a plus.
std::string with_minus_sign(std::string text) {
  if (!text.empty() && text.front() == '-') text.replace(0, 1, "\u2212");
  return text;
}

std::string superscript(int number) {
  static constexpr std::array<std::string_view, 10> digits{"⁰", "¹", "²", "³", "⁴", "⁵", "⁶", "⁷", "⁸", "⁹"};
  std::string out = number < 0 ? "⁻" : "";
  for (const char c : std::to_string(std::abs(number))) out += digits[static_cast<std::size_t>(c - '0')];
  return out;
}

}  // namespace

Colour colour_of(ColourMap map, double share) {
  return map == ColourMap::angle ? blend(angle_map, share) : blend(height_map, share);
}

std::string hex(Colour colour) {
  return fmt::format("#{:02x}{:02x}{:02x}", colour[0], colour[1], colour[2]);
}

std::vector<double> nice_ticks(double low, double high, int wanted) {
  if (!(high > low)) high = low + 1.0;
  const double raw = (high - low) / std::max(wanted, 1);
  const double decade = std::pow(10.0, std::floor(std::log10(raw)));
  const double share = raw / decade;
  const double step = decade * (share < 1.5 ? 1.0 : share < 3.5 ? 2.0 : share < 7.5 ? 5.0 : 10.0);
  // The slack lets a bound that is a round number up to rounding be a tick itself.
  const double slack = 1e-9;
  const long first = std::lround(std::floor(low / step + slack));
  const long last = std::lround(std::ceil(high / step - slack));
  std::vector<double> ticks;
  for (long i = first; i <= last; ++i) ticks.push_back(static_cast<double>(i) * step);
  return ticks;
}

std::vector<double> decade_ticks(double low, double high) {
  const int first = static_cast<int>(std::floor(std::log10(low)));
  const int last = static_cast<int>(std::ceil(std::log10(high)));
  const bool between = high < 320.0 * low;
  std::vector<double> ticks;
  for (int decade = first; decade <= last; ++decade) {
    for (const int share : {1, 2, 5}) {
      const double tick = share * std::pow(10.0, decade);
      if ((share == 1 || between) && tick >= low * (1 - 1e-9) && tick <= high * (1 + 1e-9))
        ticks.push_back(tick);
    }
  }
  return ticks;
}

std::string tick_text(double value, double step) {
  if (std::abs(value) < 1e-9 * step) return "0";
  const double largest = std::max(std::abs(value), step);
  if (largest >= 1e6 || step < 1e-5) return with_minus_sign(fmt::format("{:.3g}", value));
  const int decimals = std::max(0, static_cast<int>(-std::floor(std::log10(step) + 1e-9)));
  return with_minus_sign(grouped(fmt::format("{:.{}f}", value, decimals)));
}

std::string decade_text(double value) {
  const int decade = static_cast<int>(std::floor(std::log10(value) + 1e-9));
  if (decade >= -2 && decade <= 3) return fmt::format("{:g}", value);
  const long share = std::lround(value / std::pow(10.0, decade));
  return (share == 1 ? "" : fmt::format("{}·", share)) + "10" + superscript(decade);
}

std::string significant(double value, int digits) {
  if (value == 0.0) return "0";
  const double size = std::abs(value);
  if (!std::isfinite(value) || size < 1e-4 || size >= 1e6) {
    return with_minus_sign(fmt::format("{:.{}g}", value, digits));
  }
  // Of the rounded number: 9.996 to three digits is 10.0, not 10.00.
  const std::string rounded = fmt::format("{:.{}e}", size, digits - 1);
  const int decade = std::stoi(rounded.substr(rounded.find('e') + 1));
  return with_minus_sign(grouped(fmt::format("{:.{}f}", value, std::max(0, digits - 1 - decade))));
}

std::string significant_or_dash(double value, int digits) {
  return std::isfinite(value) ? significant(value, digits) : "–";
}

std::string escape(std::string_view text) {
  std::string out;
  for (const char c : text) {
    switch (c) {
      case '&':
        out += "&amp;";
        break;
      case '<':
        out += "&lt;";
        break;
      case '>':
        out += "&gt;";
        break;
      case '"':
        out += "&quot;";
        break;
      default:
        out += c;
    }
  }
  return out;
}

std::string path_data(std::span<const Point> points, Closure closure) {
  if (points.empty()) return "";
  long x = tenths(points[0].x), y = tenths(points[0].y);
  std::string out = "M" + pair_text(x, y);
  bool stepping = false;
  for (const Point& point : points.subspan(1)) {
    const long next_x = tenths(point.x), next_y = tenths(point.y);
    if (next_x == x && next_y == y) continue;
    const std::string step = pair_text(next_x - x, next_y - y);
    out += stepping ? (step.front() == '-' ? "" : " ") : "l";
    out += step;
    stepping = true;
    x = next_x;
    y = next_y;
  }
  if (closure == Closure::closed) out += "z";
  return out;
}

Canvas::Canvas(double width, double height, std::string label)
    : width_(width), height_(height), label_(std::move(label)) {}

void Canvas::line(Point from, Point to, std::string_view style) {
  const std::array<Point, 2> points{from, to};
  polyline(points, style);
}

void Canvas::path(std::string_view data, std::string_view style) {
  if (!data.empty()) body_ += fmt::format("<path class=\"{}\" d=\"{}\"/>\n", style, data);
}

void Canvas::coloured_path(std::string_view data, Colour colour) {
  body_ += fmt::format("<path fill=\"{}\" d=\"{}\"/>\n", hex(colour), data);
}

void Canvas::disc(Point centre, double radius, std::string_view style) {
  body_ += fmt::format("<circle class=\"{}\" cx=\"{}\" cy=\"{}\" r=\"{}\"/>\n", style, pixel_text(centre.x),
                       pixel_text(centre.y), pixel_text(radius));
}

void Canvas::text(Point at, std::string_view content, Anchor anchor, std::string_view style) {
  static constexpr std::array<std::string_view, 3> names{"start", "middle", "end"};
  body_ += fmt::format("<text class=\"{}\" x=\"{}\" y=\"{}\" text-anchor=\"{}\">{}</text>\n", style,
                       pixel_text(at.x), pixel_text(at.y), names[static_cast<std::size_t>(anchor)],
                       escape(content));
}

void Canvas::text_upright(Point at, std::string_view content, std::string_view style) {
  body_ += fmt::format(
      "<text class=\"{}\" transform=\"translate({} {}) rotate(-90)\" text-anchor=\"middle\">{}</text>\n",
      style, pixel_text(at.x), pixel_text(at.y), escape(content));
}

void Canvas::begin_group(std::string_view attributes) {
  body_ += fmt::format("<g {}>\n", attributes);
}
void Canvas::end_group() {
  body_ += "</g>\n";
}

std::string Canvas::opening_tag(std::string_view attributes) const {
  const std::string width = pixel_text(width_), height = pixel_text(height_);
  return fmt::format(
      "<svg class=\"picture\" viewBox=\"0 0 {0} {1}\" width=\"{0}\" height=\"{1}\"{2} role=\"img\" "
      "aria-label=\"{3}\">\n",
      width, height, attributes, escape(label_));
}

std::string Canvas::inline_svg() const {
  return opening_tag("") + body_ + "</svg>\n";
}

std::string Canvas::standalone_svg() const {
  return opening_tag(" xmlns=\"http://www.w3.org/2000/svg\"") + "<style>" + picture_style() +
         "</style>\n<path class=\"sheet\" d=\"M0 0h" + pixel_text(width_) + "v" + pixel_text(height_) + "h-" +
         pixel_text(width_) + "z\"/>\n" + body_ + "</svg>\n";
}

}  // namespace heddle::pipeline
