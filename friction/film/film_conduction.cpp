#include "friction/film/film_conduction.h"

#include <algorithm>
#include <cmath>
#include <utility>
#include <vector>

namespace heddle::friction {

namespace {

/// Tool, film and ply from left to right.
struct Stack {
  ConductionGrid grid;
  std::size_t film_first = 0, film_count = 0;
  double film_thickness = 0.0;
};

Stack stack_of(const FilmConductionSpec& spec, double film_thickness, const FilmConductionOptions& options) {
  const Material tool{spec.tool_conductivity, spec.tool_heat_capacity};
  const Material film{spec.film_conductivity, spec.film_heat_capacity};
  const Material ply{spec.ply_conductivity, spec.ply_heat_capacity};
  // Cells of one age at a face: their widths go with sqrt(alpha).
  const double first = options.first_width * film_thickness;
  const auto beside = [&](const Material& material) {
    return first * std::sqrt(material.diffusivity() / film.diffusivity());
  };
  // Beyond 8 sqrt(alpha t) erfc is 2e-8: to the film the tool has no end.
  const double tool_depth = 8.0 * std::sqrt(tool.diffusivity() * options.last_time);
  std::vector<double> in_tool = growing_widths(tool_depth, beside(tool), options.growth);
  std::reverse(in_tool.begin(), in_tool.end());
  const std::vector<double> in_film = widths_from_both_faces(film_thickness, first, options.growth);

  Stack stack;
  append_layer(stack.grid, tool, in_tool);
  stack.film_first = stack.grid.size();
  stack.film_count = in_film.size();
  stack.film_thickness = film_thickness;
  append_layer(stack.grid, film, in_film, spec.contact_resistance);
  append_layer(stack.grid, ply, growing_widths(spec.ply_thickness, beside(ply), options.growth));
  return stack;
}

double film_mean(const Stack& stack, const std::vector<double>& temperature) {
  const double heat = heat_in(stack.grid, temperature, stack.film_first, stack.film_count);
  const std::vector<double> ones(temperature.size(), 1.0);
  return heat / heat_in(stack.grid, ones, stack.film_first, stack.film_count);
}

/// Temperature at each point of the film, between the middles of two cells or a cell and the tool's face.
std::array<double, film_points> at_points(const Stack& stack, const std::vector<double>& temperature,
                                          double face) {
  std::array<double, film_points> result{};
  double left = 0.0, left_value = face, start = 0.0;
  std::size_t p = 0;
  for (std::size_t i = stack.film_first; i < stack.film_first + stack.film_count && p < film_points; ++i) {
    const double width = stack.grid.width[i], middle = start + 0.5 * width;
    for (; p < film_points; ++p) {
      const double place = film_point_place[p] * stack.film_thickness;
      if (place > middle) break;
      result[p] = left_value + (temperature[i] - left_value) * (place - left) / (middle - left);
    }
    left = middle;
    left_value = temperature[i];
    start += width;
  }
  return result;
}

double film_face(const Stack& stack, const std::vector<double>& temperature) {
  const std::size_t i = stack.film_first;
  const double flow = flow_to_next(stack.grid, temperature, i - 1);
  return temperature[i] + flow * 0.5 * stack.grid.width[i] / stack.grid.conductivity[i];
}

Sensitive on_curve(const Curve& curve, double settling, const Sensitive& time) {
  const double touch = 1e-6 * settling;
  const Sensitive age = sqrt(time * time + touch * touch);
  const double at = std::log(age.value);
  if (at <= curve.x().front()) return curve.y().front();
  if (at >= curve.x().back()) return curve.y().back();
  const Curve::Value value = curve.evaluate(at);
  return age.mapped(value.y, value.slope / age.value);
}

}  // namespace

double FilmConduction::settling() const {
  return film_thickness * film_thickness * spec.film_heat_capacity / spec.film_conductivity;
}

FilmConduction film_conduction(const FilmConductionSpec& spec, double film_thickness,
                               const FilmConductionOptions& options) {
  FilmConduction film{.spec = spec, .film_thickness = film_thickness, .share = {}, .face = {}, .rise = {}};
  const Stack stack = stack_of(spec, film_thickness, options);
  const std::size_t cells = stack.grid.size();
  // The tool at 1, all else at 0; and 1 W/m^2 in the film, all at 0.
  std::vector<double> touched(cells, 0.0), heated(cells, 0.0), source(cells, 0.0);
  std::fill_n(touched.begin(), stack.film_first, 1.0);
  std::fill_n(source.begin() + static_cast<std::ptrdiff_t>(stack.film_first), stack.film_count,
              1.0 / film_thickness);
  const auto go_on = [&](double time_step) {
    conduct(stack.grid, {}, {}, time_step, touched);
    conduct(stack.grid, {}, source, time_step, heated);
  };

  const double first = options.first_time * film.settling();
  const int points =
      1 + static_cast<int>(std::ceil(std::log(options.last_time / first) * options.points_per_fold));
  const double fold = std::log(options.last_time / first) / (points - 1);
  const int steps = options.steps_per_point;
  std::vector<double> at, face, rise;
  std::array<std::vector<double>, film_points> share;
  for (int k = 0; k < points; ++k) {
    const double end = first * std::exp(fold * k), start = k == 0 ? 0.0 : first * std::exp(fold * (k - 1));
    const int these = k == 0 ? 16 * steps : steps;  // the jump of first touch is smoothed out by small steps
    for (int i = 0; i < these; ++i) go_on((end - start) / these);
    at.push_back(std::log(first) + fold * k);
    face.push_back(film_face(stack, touched));
    const auto here = at_points(stack, touched, face.back());
    for (std::size_t p = 0; p < film_points; ++p) share[p].push_back(here[p]);
    rise.push_back(film_mean(stack, heated) * spec.film_conductivity / film_thickness);
  }
  for (std::size_t p = 0; p < film_points; ++p) film.share[p] = Curve(at, std::move(share[p]));
  film.face = Curve(at, std::move(face));
  film.rise = Curve(std::move(at), std::move(rise));
  return film;
}

Sensitive point_share(const FilmConduction& film, std::size_t point, const Sensitive& time) {
  return on_curve(film.share[point], film.settling(), time);
}
Sensitive face_share(const FilmConduction& film, const Sensitive& time) {
  return on_curve(film.face, film.settling(), time);
}
Sensitive heating_rise(const FilmConduction& film, const Sensitive& time) {
  return on_curve(film.rise, film.settling(), time);
}

}  // namespace heddle::friction
