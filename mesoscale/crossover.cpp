#include "mesoscale/crossover.h"

#include <algorithm>
#include <cmath>

#include "mesoscale/quadrature.h"

namespace heddle::mesoscale {

namespace {

TowSqueeze squeeze_of(const CrossingGeometry& unsheared, double shear_angle, const CompactionLaw& law,
                      std::size_t tow) {
  return {law, thickness(unsheared.tow[tow].section),
          sheared(unsheared, shear_angle).tow[tow].fibre_fraction};
}

}  // namespace

CrossoverContact::CrossoverContact(const CrossingGeometry& unsheared, double shear_angle,
                                   const CompactionLaw& law, const QuarterShares& quarters)
    : squeeze_(squeeze_of(unsheared, shear_angle, law, 0), squeeze_of(unsheared, shear_angle, law, 1),
               unsheared.balanced()),
      shear_angle_(shear_angle),
      kinds_(quarter_kinds(quarters,
                           faces_alike(unsheared.tow[0].section) && faces_alike(unsheared.tow[1].section))),
      line_{line_along(unsheared, shear_angle, 0), line_along(unsheared, shear_angle, 1)} {}

CrossoverContact::Line CrossoverContact::line_along(const CrossingGeometry& unsheared, double shear_angle,
                                                    std::size_t tow) {
  const ArcPath& path = unsheared.tow[tow].path;
  const TowGeometry& other = unsheared.tow[1 - tow];
  const double edge = 0.5 * width(other.section);
  const double wrap = std::clamp(path.wrap(), 0.25 * edge, edge);
  const double stretch = oblique_width(other, shear_angle).width / width(other.section);
  Line line;
  // Fixed points keep energy, force and stiffness exact derivatives of each other. Two panels in the
  // conformal part and two outside.
  const auto add_panels = [&](double from, double to) {
    for (int panel = 0; panel < 2; ++panel)
      for (std::size_t q = 0; q < 6; ++q) {
        const double u = from + 0.5 * (to - from) * (panel + 0.5 * (1.0 + GaussSix::point[q]));
        line.place.push_back(stretch * u);
        line.weight.push_back(stretch * 0.25 * (to - from) * GaussSix::weight[q]);
        for (const std::size_t top : {std::size_t{0}, std::size_t{1}}) {
          const double fallen = drop(other.section, top == tow ? Face::upper : Face::lower, u);
          // Rounding can leave -1e-19 where the faces coincide.
          line.gap[top][0].push_back(std::max(fallen - path.drop(u), 0.0));
          line.gap[top][1].push_back(fallen);
        }
      }
  };
  add_panels(0.0, wrap);
  if (edge > wrap) add_panels(wrap, edge);
  return line;
}

// add(share of the kind of quarter, weight, squeeze, {i, j}) over all kinds and places.
template <class Add>
void CrossoverContact::for_each_place(double approach, const Add& add) const {
  for (const auto& [top, floats, share] : kinds_) {
    const std::vector<double>&along = line_[0].gap[top][floats[0]], &across = line_[1].gap[top][floats[1]];
    for (std::size_t i = 0; i < along.size(); ++i)
      for (std::size_t j = 0; j < across.size(); ++j)
        add(share * (line_[0].weight[i] * line_[1].weight[j]), approach - along[i] - across[j], i, j);
  }
}

CrossoverContact::Value CrossoverContact::evaluate(double approach) const {
  Value sum{0.0, 0.0, 0.0};
  if (approach <= 0.0) return sum;
  for_each_place(approach, [&](double weight, double squeeze, std::size_t, std::size_t) {
    const TowSqueeze::Value at = squeeze_.evaluate(squeeze);
    sum.energy += weight * at.energy;
    sum.force += weight * at.stress;
    sum.stiffness += weight * at.slope;
  });
  const double area = 4.0 * std::cos(shear_angle_);  // four quarters, true area
  return {area * sum.energy, area * sum.force, area * sum.stiffness};
}

double CrossoverContact::force(double approach) const {
  if (approach <= 0.0) return 0.0;
  double sum = 0.0;
  for_each_place(approach, [&](double weight, double squeeze, std::size_t, std::size_t) {
    sum += weight * squeeze_.stress(squeeze);
  });
  return 4.0 * std::cos(shear_angle_) * sum;
}

double CrossoverContact::arm(double approach) const {
  const double twist = std::sin(shear_angle_);
  double force = 0.0, moment = 0.0;
  for_each_place(approach, [&](double weight, double squeeze, std::size_t i, std::size_t j) {
    const double x = line_[0].place[i], y = line_[1].place[j];
    const double stress = approach > 0.0 ? squeeze_.stress(squeeze) : 1.0;
    const double load = weight * stress;
    const double square = x * x + y * y, skew = 2.0 * x * y * twist;
    force += load;
    moment += load * 0.5 * (std::sqrt(square + skew) + std::sqrt(square - skew));
  });
  return moment / force;
}

}  // namespace heddle::mesoscale
