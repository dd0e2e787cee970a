#include "pipeline/discover/coordinates.h"

#include <cmath>
#include <map>

namespace heddle::discover {

namespace {

bool to_unit_range(Eigen::VectorXd& values) {
  const double low = values.minCoeff(), range = values.maxCoeff() - low;
  if (!(range > 1e-6 * (1.0 + std::abs(low)))) return false;
  values = (values.array() - low) / range;
  return true;
}

}  // namespace

Eigen::VectorXd of_points(const std::vector<CouponCell>& cells,
                          const std::function<double(const CouponCell&, const CouponPoint&)>& value) {
  std::vector<double> values;
  for (const CouponCell& cell : cells)
    for (const CouponPoint& point : cell.points) values.push_back(value(cell, point));
  return Eigen::Map<const Eigen::VectorXd>(values.data(), std::ssize(values));
}

std::vector<Coordinate> coordinates_of(const std::vector<CouponCell>& cells) {
  std::vector<Coordinate> coordinates;
  for (const Factor& factor : factors()) {
    if (std::string(factor.name) == "day") continue;
    Coordinate one{factor.name, of_points(cells, [&](const CouponCell& cell, const CouponPoint&) {
                     return factor.of(cell);
                   })};
    if (to_unit_range(one.at)) coordinates.push_back(std::move(one));
  }
  Coordinate slip{"slip", of_points(cells, [](const CouponCell&, const CouponPoint& point) {
                    return point.slip > 0.0 ? std::log(point.slip) : 0.0;
                  })};
  if (to_unit_range(slip.at)) coordinates.push_back(std::move(slip));
  return coordinates;
}

double gaussian(double distance, double length) {
  const double x = distance / length;
  return std::exp(-0.5 * x * x);
}

std::vector<FormCoordinate> form_coordinates(const std::vector<CouponCell>& cells, double length,
                                             Eigen::Index centred_over) {
  std::vector<FormCoordinate> coordinates;
  for (const Coordinate& c : coordinates_of(cells)) {
    FormCoordinate form;
    std::map<long, int> levels;
    for (const double at : c.at)
      form.level.push_back(
          levels.try_emplace(std::lround(50.0 * at), static_cast<int>(levels.size())).first->second);
    const Eigen::Index size = c.at.size();
    form.likeness.resize(size, size);
    for (Eigen::Index j = 0; j < size; ++j)
      form.likeness.col(j) = ((c.at.array() - c.at[j]).square() * (-0.5 / (length * length))).exp();
    // What is the same everywhere is the amplitude's own.
    const Eigen::Index over = centred_over > 0 ? centred_over : size;
    form.likeness.rowwise() -= form.likeness.topRows(over).colwise().mean().eval();
    form.likeness.colwise() -= form.likeness.leftCols(over).rowwise().mean().eval();
    coordinates.push_back(std::move(form));
  }
  return coordinates;
}

}  // namespace heddle::discover
