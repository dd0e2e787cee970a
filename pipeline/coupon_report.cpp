#include "pipeline/coupon_report.h"

#include <algorithm>
#include <cmath>

#include <fmt/format.h>

#include "core/units.h"
#include "pipeline/chart.h"
#include "pipeline/outputs.h"
#include "pipeline/page.h"
#include "pipeline/report_figures.h"

namespace heddle::pipeline {

namespace {

using mesoscale::CouponPoint;
using mesoscale::CouponPull;
using mesoscale::FabricProperties;

constexpr std::array<double, 3> speeds{0.0, 1e-3, 10e-3};  // [m/s]; 0: without the rate's part

CouponPull pull_of(const FabricProperties& fabric, double speed) {
  const double end = std::asin(std::min(fabric.shear_stress.x().back(), 1.0));
  return {speed, fabric.shear_rate.reference_temperature, std::min(end, 60.0 / degrees), 121};
}

// One test at each speed.
template <class Test>
std::string csv_of(const FabricProperties& fabric, const Test& test) {
  std::string out =
      "crosshead_speed_mm_s,displacement_mm,shear_angle_deg,shear_rate_1_s,force_N,shear_force_N_per_mm\n";
  for (const double speed : speeds)
    for (const CouponPoint& p : test(pull_of(fabric, speed)))
      out += fmt::format("{},{},{},{},{},{}\n", shortest(1e3 * speed), shortest(1e3 * p.displacement),
                         shortest(degrees * p.shear_angle), shortest(p.shear_rate), shortest(p.force),
                         shortest(1e-3 * p.normalised));
  return out;
}

std::string name_of(double speed) {
  return speed == 0.0 ? "rate-free" : fmt::format("{:g} mm/s", 1e3 * speed);
}

// Shear force per width over the angle. Behind it what literature recalls of plain weaves of this kind in
// frames at room temperature (0.01 N/mm at 10 to 20 deg, 0.05 to 0.15 at 40), and a half to a tenth of it
// molten.
Canvas frame_chart(const FabricProperties& fabric) {
  LineChart chart;
  chart.label = "Shear force per width of a picture frame over the shear angle";
  chart.x = {"Shear angle", "°", Scale::linear, 0.0, 60.0};
  chart.y = {"Shear force", "N/mm", Scale::logarithmic};
  chart.ribbons = {{{10.0, 20.0, 40.0}, {0.001, 0.001, 0.005}, {0.005, 0.005, 0.075}}};
  for (const double speed : speeds) {
    Series series{name_of(speed), {}, {}};
    for (const CouponPoint& p : mesoscale::picture_frame(fabric, {}, pull_of(fabric, speed))) {
      if (p.shear_angle == 0.0) continue;
      series.x.push_back(degrees * p.shear_angle);
      series.y.push_back(1e-3 * p.normalised);
    }
    chart.series.push_back(std::move(series));
  }
  chart.series.push_back({"room (recalled)", {10.0, 20.0, 40.0, 40.0}, {0.01, 0.01, 0.05, 0.15}, true});
  chart.width = half_width;
  chart.height = 340.0;
  chart.label_room = 122.0;
  return draw(chart);
}

Series series_of(const ShearLoop::Way& way, const char* name) {
  Series series{name, {}, {}};
  for (const double angle : way.angle) series.x.push_back(degrees * angle);
  for (const double force : way.force) series.y.push_back(1e-3 * force);
  return series;
}

std::string loop_figure(const ShearLoop& loop) {
  LineChart chart;
  chart.label = "Shear force per width of a picture frame that goes to and fro";
  chart.x = {"Shear angle", "°"};
  chart.y = {"Shear force", "N/mm"};
  chart.series = {series_of(loop.cycles, "to and fro"), series_of(loop.first, "first loading")};
  chart.label_room = 110.0;
  return figure(
      draw(chart),
      fmt::format("The frame to 20° and to 40° and to both sides, without the rate's part: {:g} % of the "
                  "resistance is friction between tows and turns round with the shear. The first "
                  "loading is the fabric's curve whatever that share is. The share is a prior: no "
                  "unloading of this fabric is at hand.",
                  100.0 * loop.share));
}

Canvas strip_chart(const FabricProperties& fabric) {
  LineChart chart;
  chart.label = "Force of a bias extension over the displacement of its crosshead";
  chart.x = {"Displacement", "mm"};
  chart.y = {"Force", "N"};
  for (const double speed : speeds) {
    Series series{name_of(speed), {}, {}};
    for (const CouponPoint& p : mesoscale::bias_extension(fabric, {}, pull_of(fabric, speed))) {
      if (p.shear_angle > 50.0 / degrees) break;  // beyond, strips slip and wrinkle
      series.x.push_back(1e3 * p.displacement);
      series.y.push_back(p.force);
    }
    chart.series.push_back(std::move(series));
  }
  chart.width = half_width;
  chart.height = 340.0;
  chart.label_room = 80.0;
  return draw(chart);
}

}  // namespace

std::string picture_frame_csv(const FabricProperties& fabric) {
  return csv_of(fabric, [&](const CouponPull& pull) { return mesoscale::picture_frame(fabric, {}, pull); });
}

std::string bias_extension_csv(const FabricProperties& fabric) {
  return csv_of(fabric, [&](const CouponPull& pull) { return mesoscale::bias_extension(fabric, {}, pull); });
}

std::string coupon_section(const FabricProperties& fabric, const std::optional<ShearLoop>& loop) {
  if (fabric.shear_stress.empty()) return "";
  const mesoscale::PictureFrame frame;
  const mesoscale::BiasExtension strip;
  return pair(
             figure(
                 frame_chart(fabric),
                 fmt::format(
                     "Picture frame, {:g} mm, filled: shear force per width, at three speeds of the "
                     "crosshead. Dots: what is recalled of plain glass and polypropylene weaves in frames at "
                     "room temperature; band: a half to a tenth of that, as recalled of the molten fabric. "
                     "Neither is a validation: laboratories differ by 2 to 5 times, and pretension "
                     "raises the force as much.",
                     1e3 * frame.side)),
             figure(
                 strip_chart(fabric),
                 fmt::format(
                     "Bias extension of a strip of {:g} x {:g} mm, up to 50° in its middle, by the zones of "
                     "ideal trellis shear.",
                     1e3 * strip.length, 1e3 * strip.width))) +
         (loop ? loop_figure(*loop) : "");
}

}  // namespace heddle::pipeline
