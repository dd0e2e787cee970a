#include "mesoscale/crossover.h"

#include <algorithm>
#include <cmath>

#include "mesoscale/quadrature.h"

namespace heddle::mesoscale {

namespace {

double fibre_fraction_at(const CrossingGeometry& unsheared, double shear_angle) {
  return sheared(unsheared, shear_angle).fibre_fraction;
}

}  // namespace

CrossoverContact::CrossoverContact(const CrossingGeometry& unsheared, double shear_angle,
                                   const CompactionLaw& law)
    : squeeze_(law, unsheared.section.thickness, fibre_fraction_at(unsheared, shear_angle)),
      shear_angle_(shear_angle) {
  const double edge = 0.5 * unsheared.section.width;
  const double wrap = std::clamp(unsheared.path.wrap(), 0.25 * edge, edge);
  const double stretch = sheared(unsheared, shear_angle).section.width / unsheared.section.width;
  // Fixed points keep energy, force and stiffness exact derivatives of each other. Two panels in the
  // conformal part and two outside.
  const auto add_panels = [&](double from, double to) {
    for (int panel = 0; panel < 2; ++panel)
      for (std::size_t q = 0; q < 6; ++q) {
        const double u = from + 0.5 * (to - from) * (panel + 0.5 * (1.0 + GaussSix::point[q]));
        place_.push_back(stretch * u);
        weight_.push_back(stretch * 0.25 * (to - from) * GaussSix::weight[q]);
        // Rounding can leave -1e-19 where the faces coincide.
        gap_.push_back(std::max(unsheared.section.drop(u) - unsheared.path.drop(u), 0.0));
      }
  };
  add_panels(0.0, wrap);
  if (edge > wrap) add_panels(wrap, edge);
}

CrossoverContact::Value CrossoverContact::evaluate(double approach) const {
  Value sum{0.0, 0.0, 0.0};
  if (approach <= 0.0) return sum;
  for (std::size_t i = 0; i < gap_.size(); ++i)
    for (std::size_t j = 0; j < gap_.size(); ++j) {
      const TowSqueeze::Value at = squeeze_.evaluate(0.5 * (approach - gap_[i] - gap_[j]));
      const double weight = weight_[i] * weight_[j];
      sum.energy += weight * 2.0 * at.energy;
      sum.force += weight * at.stress;
      sum.stiffness += weight * 0.5 * at.slope;
    }
  const double area = 4.0 * std::cos(shear_angle_);  // four quarters, true area
  return {area * sum.energy, area * sum.force, area * sum.stiffness};
}

double CrossoverContact::force(double approach) const {
  if (approach <= 0.0) return 0.0;
  double sum = 0.0;
  for (std::size_t i = 0; i < gap_.size(); ++i)
    for (std::size_t j = 0; j < gap_.size(); ++j)
      sum += weight_[i] * weight_[j] * squeeze_.stress(0.5 * (approach - gap_[i] - gap_[j]));
  return 4.0 * std::cos(shear_angle_) * sum;
}

double CrossoverContact::arm(double approach) const {
  const double twist = std::sin(shear_angle_);
  double force = 0.0, moment = 0.0;
  for (std::size_t i = 0; i < gap_.size(); ++i)
    for (std::size_t j = 0; j < gap_.size(); ++j) {
      const double x = place_[i], y = place_[j];
      const double stress = approach > 0.0 ? squeeze_.stress(0.5 * (approach - gap_[i] - gap_[j])) : 1.0;
      const double load = weight_[i] * weight_[j] * stress;
      const double square = x * x + y * y, skew = 2.0 * x * y * twist;
      force += load;
      moment += load * 0.5 * (std::sqrt(square + skew) + std::sqrt(square - skew));
    }
  return moment / force;
}

}  // namespace heddle::mesoscale
