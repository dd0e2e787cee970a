#include "pipeline/shear_tests.h"

#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <map>
#include <numbers>
#include <optional>
#include <tuple>

#include "core/measured_table.h"
#include "core/units.h"

namespace heddle::pipeline {

namespace {

/// One line of the table; what is not there is 0.
struct Line {
  int line = 0;
  std::string test, condition, sample, day;
  double frame_side = 0.0, fabric_side = 0.0, strip_length = 0.0, strip_width = 0.0;
  double speed = 0.0, temperature = 0.0, displacement = 0.0, force = 0.0;
  std::optional<double> angle;
};

using Column = TableColumn<Line>;
constexpr std::array columns{Column{"test", "", &Line::test, true},
                             Column{"condition_id", "", &Line::condition, true},
                             Column{"sample_id", "", &Line::sample, true},
                             Column{"day_id", "", &Line::day},
                             Column{"speed_mm_s", "mm/s", &Line::speed, true},
                             Column{"fabric_temperature_C", "degC", &Line::temperature, true},
                             Column{"displacement_mm", "mm", &Line::displacement, true},
                             Column{"force_N", "N", &Line::force, true},
                             Column{"frame_side_mm", "mm", &Line::frame_side},
                             Column{"fabric_side_mm", "mm", &Line::fabric_side},
                             Column{"strip_length_mm", "mm", &Line::strip_length},
                             Column{"strip_width_mm", "mm", &Line::strip_width},
                             Column{"shear_angle_deg", "deg", &Line::angle}};
constexpr TableRules rules{.what = "a table of shear tests",
                           .unknown = "discover.shear.column.unknown"_rule,
                           .missing = "discover.shear.column.missing"_rule,
                           .twice = "discover.shear.column.twice"_rule,
                           .number = "discover.shear.number"_rule};

/// What the first line of a curve says of all of it.
void check_test(const Line& line, TableProblems& problems) {
  const auto size = [&](double value, std::string_view column) {
    if (!(value > 0.0))
      problems.add("discover.shear.size"_rule, column, write_quantity(value, "mm"),
                   fmt::format("must be positive in a {}", line.test),
                   "Give the size of frame or strip in mm.", line.line);
    return value > 0.0;
  };
  if (line.test == "picture_frame") {
    if (size(line.frame_side, "frame_side_mm") && line.fabric_side > line.frame_side)
      problems.add("discover.shear.fabric"_rule, "fabric_side_mm", write_quantity(line.fabric_side, "mm"),
                   "is larger than the frame between its hinges", "Give the side of the fabric that shears.",
                   line.line);
  } else if (line.test == "bias_extension") {
    const bool both = size(line.strip_length, "strip_length_mm") && size(line.strip_width, "strip_width_mm");
    if (both && line.strip_length < 2.0 * line.strip_width)
      problems.add(
          "discover.shear.strip"_rule, "strip_length_mm", write_quantity(line.strip_length, "mm"),
          fmt::format("must be at least twice strip_width_mm ({}): else no part of the strip shears freely",
                      write_quantity(line.strip_width, "mm")),
          "Leave the sample out.", line.line);
  } else {
    problems.add("discover.shear.test"_rule, "test", line.test, "must be picture_frame or bias_extension",
                 "Other tests are not read.", line.line);
  }
  if (!(line.speed > 0.0))
    problems.add("discover.shear.speed"_rule, "speed_mm_s", write_quantity(line.speed, "mm/s"),
                 "must be positive", "Give the speed of the crosshead.", line.line);
}

void check_curve(const std::vector<const Line*>& curve, TableProblems& problems) {
  for (std::size_t k = 1; k < curve.size(); ++k)
    if (!(curve[k]->displacement > curve[k - 1]->displacement)) {
      problems.add(
          "discover.shear.curve"_rule, "displacement_mm", write_quantity(curve[k]->displacement, "mm"),
          fmt::format("must be larger than on the line before it of sample {}", curve[k]->sample),
          "Loading only, in the order of the crosshead; each piece its own sample_id.", curve[k]->line);
      return;
    }
  if (curve.size() < 4)
    problems.add(
        "discover.shear.short"_rule, "sample_id", curve.front()->sample,
        fmt::format("has {} {} only, which is no curve", curve.size(), curve.size() == 1 ? "line" : "lines"),
        "Give at least four points of each piece.", curve.front()->line);
}

void check_reach(const Line& line, double most, TableProblems& problems) {
  if (line.displacement >= most)
    problems.add("discover.shear.reach"_rule, "displacement_mm", write_quantity(line.displacement, "mm"),
                 fmt::format("is beyond {:.4g} mm, where the tows would lie along the pull", 1e3 * most),
                 "Correct the displacement or the size of frame or strip.", line.line);
}

/// Said once of the table, where its largest values look like another unit.
void check_units(const std::vector<Line>& lines, TableProblems& problems) {
  double way = 0.0, force = 0.0;
  for (const Line& line : lines) {
    way = std::max(way, line.displacement);
    force = std::max(force, line.force);
  }
  if (way < 1e-3)
    problems.add("discover.shear.unit.displacement"_rule, "displacement_mm", write_quantity(way, "mm"),
                 "is the largest of the table, which shears nothing; is it in metres?", "Write it in mm.", 0);
  if (force < 0.05)
    problems.add("discover.shear.unit.force"_rule, "force_N", write_quantity(force, "N"),
                 "is the largest of the table, less than any fabric asks for; is it in kN?", "Write it in N.",
                 0);
}

using Lines = std::vector<const Line*>;

std::vector<Lines> pieces_of(const std::vector<Line>& lines) {
  std::vector<Lines> pieces;
  std::map<std::tuple<std::string, std::string, std::string, std::string>, std::size_t> place;
  for (const Line& line : lines) {
    const auto [at, fresh] =
        place.try_emplace({line.test, line.condition, line.day, line.sample}, pieces.size());
    if (fresh) pieces.emplace_back();
    pieces[at->second].push_back(&line);
  }
  return pieces;
}

/// Shear angle where the crosshead has gone x: cos(phi) of half the frame's angle, or (x + D)/D of the strip.
double crosshead_angle(const ShearCurve& curve, double x) {
  if (curve.test == ShearTest::picture_frame)
    return 0.5 * std::numbers::pi -
           2.0 * std::acos(std::min(std::numbers::sqrt2 / 2.0 + 0.5 * x / curve.frame.side, 1.0));
  const double between = curve.strip.length - curve.strip.width;
  // cos(g/2) + sin(g/2) = sqrt(1 + sin g)
  const double root = 1.0 + x / between;
  return std::asin(std::min(root * root - 1.0, 1.0));
}

/// dx/dg of the crosshead.
double reach(const ShearCurve& curve, double angle) {
  if (curve.test == ShearTest::picture_frame)
    return curve.frame.side * std::sin(0.25 * std::numbers::pi - 0.5 * angle);
  return 0.5 * (curve.strip.length - curve.strip.width) * (std::cos(0.5 * angle) - std::sin(0.5 * angle));
}

/// T_s at an angle among the points so far, straight from one to the next and from rest.
double flow_at(const std::vector<ShearPoint>& points, double angle) {
  double from = 0.0, flow = 0.0;
  for (const ShearPoint& point : points) {
    if (point.shear_angle >= angle)
      return flow + (point.flow - flow) * (angle - from) / (point.shear_angle - from);
    from = point.shear_angle;
    flow = point.flow;
  }
  return flow;
}

ShearPoint reduced(const ShearCurve& curve, const Line& line) {
  ShearPoint point{.displacement = line.displacement, .force = line.force};
  point.shear_angle = line.angle.value_or(crosshead_angle(curve, line.displacement));
  const double arm = reach(curve, point.shear_angle);
  point.shear_rate = curve.speed / arm;
  if (curve.test == ShearTest::picture_frame) {
    point.flow = line.force * arm / (curve.frame.fabric_side * curve.frame.fabric_side);
    return point;
  }
  const double w = curve.strip.width, middle = 0.5 * w * (2.0 * curve.strip.length - 3.0 * w),
               quarters = 0.5 * w * w;
  // Near rest the flow grows with the angle: until there are points, the quarters have half the middle's.
  const double half = 0.5 * point.shear_angle;
  if (curve.points.empty() || curve.points.back().shear_angle < half)
    point.flow = line.force * arm / (middle + 0.5 * quarters);
  else
    point.flow = (line.force * arm - quarters * flow_at(curve.points, half)) / middle;
  return point;
}

ShearCurve curve_of(const Lines& lines) {
  const Line& first = *lines.front();
  ShearCurve curve{
      .test = first.test == "picture_frame" ? ShearTest::picture_frame : ShearTest::bias_extension,
      .condition = first.condition,
      .sample = first.sample,
      .day = first.day,
      .frame = {first.frame_side, first.fabric_side > 0.0 ? first.fabric_side : first.frame_side},
      .strip = {first.strip_length, first.strip_width},
      .speed = first.speed,
      .temperature = first.temperature,
      .points = {}};
  for (const Line* line : lines)
    if (line->displacement > 0.0) curve.points.push_back(reduced(curve, *line));
  return curve;
}

/// Crosshead's way until the tows would lie along the pull.
double furthest(const Line& line) {
  return line.test == "picture_frame" ? (2.0 - std::numbers::sqrt2) * line.frame_side
                                      : (std::numbers::sqrt2 - 1.0) * (line.strip_length - line.strip_width);
}

}  // namespace

const char* name_of(ShearTest test) {
  return test == ShearTest::picture_frame ? "picture_frame" : "bias_extension";
}

bool is_shear_table(std::string_view text) {
  return has_column(parse_csv(text, ""), "test");
}

std::vector<ShearCurve> parse_shear_tests(std::string_view text, const std::string& file) {
  TableProblems problems{file};
  const std::vector<Line> lines = read_rows(parse_csv(text, file), columns, rules, problems);
  if (lines.empty())
    problems.add("discover.shear.empty"_rule, "data", "", "must hold at least one curve",
                 "One line a point of a curve, after the header line.", 0);
  problems.throw_if_any();
  check_units(lines, problems);
  const std::vector<Lines> pieces = pieces_of(lines);
  for (const Lines& piece : pieces) {
    const std::size_t before = problems.list.size();
    check_test(*piece.front(), problems);
    check_curve(piece, problems);
    if (problems.list.size() == before) check_reach(*piece.back(), furthest(*piece.front()), problems);
  }
  problems.throw_if_any();
  std::vector<ShearCurve> curves;
  for (const Lines& piece : pieces) curves.push_back(curve_of(piece));
  return curves;
}

}  // namespace heddle::pipeline
