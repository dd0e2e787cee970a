#include "pipeline/painter.h"

#include <catch2/catch.hpp>
#include <cmath>

#include "pipeline/chart.h"
#include "pipeline/picture.h"

using namespace heddle::pipeline;
using Catch::Matchers::Contains;

namespace {

/// CIE lightness of a colour, 0 black to 100 white.
double lightness(Colour colour) {
  const auto linear = [](int channel) {
    const double c = channel / 255.0;
    return c <= 0.04045 ? c / 12.92 : std::pow((c + 0.055) / 1.055, 2.4);
  };
  const double y = 0.2126 * linear(colour[0]) + 0.7152 * linear(colour[1]) + 0.0722 * linear(colour[2]);
  return 116.0 * std::cbrt(y) - 16.0;
}

/// Square of side 1 at height z with its corner at (x, y), appended to a picture.
void add_square(MeshPicture& picture, double x, double y, double z, double value) {
  const int first = static_cast<int>(picture.points.size());
  for (const auto& [dx, dy] : {std::pair{0.0, 0.0}, {1.0, 0.0}, {1.0, 1.0}, {0.0, 1.0}}) {
    picture.points.push_back({x + dx, y + dy, z});
    picture.value.push_back(value);
  }
  picture.quads.push_back({first, first + 1, first + 2, first + 3});
}

}  // namespace

TEST_CASE("both colour maps grow lighter all the way, so that they read in grey", "[painter]") {
  for (const ColourMap map : {ColourMap::angle, ColourMap::height}) {
    for (int i = 0; i < 63; ++i) {
      CAPTURE(i);
      CHECK(lightness(colour_of(map, (i + 1) / 63.0)) > lightness(colour_of(map, i / 63.0)));
    }
  }
  CHECK(hex(colour_of(ColourMap::angle, 0.0)) == "#440154");
  CHECK(hex(colour_of(ColourMap::angle, 2.0)) == "#fde725");  // held beyond the end
}

TEST_CASE("equal steps of value are nearly equal steps of lightness", "[painter]") {
  const double whole =
      lightness(colour_of(ColourMap::angle, 1.0)) - lightness(colour_of(ColourMap::angle, 0.0));
  for (int i = 0; i < 9; ++i) {
    const double step = lightness(colour_of(ColourMap::angle, (i + 1) / 9.0)) -
                        lightness(colour_of(ColourMap::angle, i / 9.0));
    CAPTURE(i, step);
    CHECK(step / whole == Approx(1.0 / 9.0).margin(0.03));
  }
}

TEST_CASE("ticks are round and cover the range", "[painter]") {
  CHECK(nice_ticks(0.0, 70.0, 7) == std::vector<double>{0, 10, 20, 30, 40, 50, 60, 70});
  const std::vector<double> force = nice_ticks(-12.0, 1328.0, 6);
  CHECK(force.front() == -200.0);
  CHECK(force.back() == 1400.0);
  CHECK(nice_ticks(3.0, 3.0, 5).size() > 1);  // a constant still gets an axis
  CHECK(decade_ticks(0.5, 20.0) == std::vector<double>{0.5, 1, 2, 5, 10, 20});
  CHECK(decade_ticks(1.0, 1e4) == std::vector<double>{1, 10, 100, 1000, 10000});
}

TEST_CASE("numbers read as people write them", "[painter]") {
  CHECK(tick_text(0.30000000000000004, 0.05) == "0.30");
  CHECK(tick_text(-5.0, 5.0) == "\u22125");
  CHECK(tick_text(12000.0, 1000.0) == "12\u2009000");
  CHECK(tick_text(-1e-18, 0.1) == "0");
  CHECK(decade_text(1e-5) == "10⁻⁵");
  CHECK(decade_text(0.05) == "0.05");
  CHECK(decade_text(2e6) == "2·10⁶");
  CHECK(significant(843.27, 3) == "843");
  CHECK(significant(0.070312, 3) == "0.0703");
  CHECK(significant(9.996, 3) == "10.0");
  CHECK(significant(0.0, 3) == "0");
}

TEST_CASE("a path is exact to a tenth of a pixel however long it is", "[painter]") {
  std::vector<Point> points;
  for (int i = 0; i <= 1000; ++i) points.push_back({0.04 * i, 0.0});
  // Steps of 0.04 would all round to nothing; 400 tenths must remain.
  const std::string data = path_data(points, Closure::open);
  std::size_t steps = 0;
  for (std::size_t at = data.find(".1 0"); at != std::string::npos; at = data.find(".1 0", at + 1)) ++steps;
  CHECK(steps == 400);
  const std::vector<Point> square{{1.0, 2.0}, {3.55, 2.0}, {3.55, -4.0}};
  CHECK(path_data(square, Closure::closed) == "M1 2l2.6 0 0-6z");
}

TEST_CASE("of two surfaces the nearer one is painted last", "[painter]") {
  MeshPicture picture;
  picture.colours = {0.0, 1.0, "value", ""};
  add_square(picture, 0.0, 0.0, 1.0, 1.0);  // above, light
  add_square(picture, 0.2, 0.2, 0.0, 0.0);  // below, dark
  const std::string light = "fill=\"#fde725\" d=\"M", dark = "fill=\"#440154\" d=\"M";
  const auto order = [&](const std::string& svg) { return svg.find(dark) < svg.find(light); };
  CHECK(order(draw(picture).inline_svg()));
  // Turned over, the lower one faces the viewer; the colour bar behind the mesh does not count.
  picture.camera.turned_over = true;
  CHECK_FALSE(order(draw(picture).inline_svg()));
}

TEST_CASE("a picture keeps proportions and stays on its sheet", "[painter]") {
  MeshPicture picture;
  picture.colours = {0.0, 1.0, "value", ""};
  add_square(picture, 0.0, 0.0, 0.0, 1.0);
  // Of 520 x 460 px the height limits: 392 px, and 0.35 px more on each side, where corners are pushed
  // outwards.
  CHECK_THAT(draw(picture).inline_svg(), Contains("d=\"M30.6 426.4l392.8 0 0-392.8-392.8 0z\""));
}

TEST_CASE("a node that has flown off to infinity is named, not drawn", "[painter]") {
  MeshPicture picture;
  add_square(picture, 0.0, 0.0, 0.0, 1.0);
  picture.points[2][1] = INFINITY;
  CHECK_THROWS_WITH(draw(picture), Contains("point 2 at (1, inf, 0)"));
}

TEST_CASE("a mesh that names missing points is refused", "[painter]") {
  MeshPicture picture;
  add_square(picture, 0.0, 0.0, 0.0, 1.0);
  picture.quads[0][2] = 4;
  CHECK_THROWS_WITH(draw(picture), Contains("names point 4 of 4"));
  picture.quads[0][2] = 2;
  picture.value.pop_back();
  CHECK_THROWS_WITH(draw(picture), Contains("3 values for 4 points"));
}

TEST_CASE("a grid is drawn with every cell covered once", "[painter]") {
  GridPicture picture;
  picture.nx = 5, picture.ny = 3;
  picture.spacing_x = picture.spacing_y = 1e-3;
  picture.colours = {0.0, 14.0, "height", "mm", ColourMap::height};
  for (int i = 0; i < 15; ++i) picture.value.push_back(i / 3);
  const std::string svg = draw(picture).inline_svg();
  const std::string cells = svg.substr(svg.find("<g "), svg.find("</g>") - svg.find("<g "));
  int covered = 0;
  for (std::size_t at = cells.find('h', cells.find("d=\"")); at != std::string::npos;
       at = cells.find('h', at + 1)) {
    if (std::isdigit(static_cast<unsigned char>(cells[at + 1]))) covered += std::stoi(cells.substr(at + 1));
  }
  CHECK(covered == 15);
  picture.value.pop_back();
  CHECK_THROWS_WITH(draw(picture), Contains("14 values for 5 x 3"));
}

TEST_CASE("a chart survives a constant, a single point and values that cannot be drawn", "[painter]") {
  LineChart chart;
  chart.x = {"time", "s"};
  chart.y = {"force", "N", Scale::logarithmic};
  chart.series = {{"constant", {0, 1}, {2, 2}},
                  {"point", {0.5}, {3.0}},
                  {"nothing", {}, {}},
                  {"not a number", {0, 1}, {NAN, -1}}};
  const std::string svg = draw(chart).inline_svg();
  CHECK(svg.find("nan") == std::string::npos);
  CHECK(svg.find("inf") == std::string::npos);
  CHECK_THAT(svg, Contains(">constant</text>"));
  CHECK(svg.find(">nothing</text>") == std::string::npos);
}

TEST_CASE("a picture of its own carries its style, and one in a page does not", "[painter]") {
  Canvas canvas(10.0, 10.0, "a \"label\"");
  canvas.line({0, 0}, {10, 10}, "line s0");
  CHECK_THAT(canvas.standalone_svg(),
             Contains("<style>") && Contains("prefers-color-scheme:dark") && Contains("xmlns"));
  CHECK(canvas.inline_svg().find("<style>") == std::string::npos);
  CHECK_THAT(canvas.inline_svg(), Contains("aria-label=\"a &quot;label&quot;\""));
}
