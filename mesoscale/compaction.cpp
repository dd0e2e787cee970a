#include "mesoscale/compaction.h"

#include <algorithm>
#include <cmath>

namespace heddle::mesoscale {

namespace {

// V^n; whole exponents, which the theory of random networks asks for, are five times faster by products.
double power(double v, double n) {
  if (n != std::floor(n) || n > 16.0) return std::pow(v, n);
  double product = 1.0;
  for (int k = static_cast<int>(n); k > 0; --k) product *= v;
  return product;
}

// Integral of K (V/Vp - 1)^2 / V^2 from Vp to V; zero below Vp.
double packing_work(const CompactionLaw& law, double v) {
  const double p = law.packing;
  if (v <= p) return 0.0;
  const auto primitive = [p](double x) { return x / (p * p) - 2.0 * std::log(x) / p - 1.0 / x; };
  return law.packing_modulus * (primitive(v) - primitive(p));
}

// Gutowski's law up to where it goes on straight.
CompactionLaw::Value gutowski(const CompactionLaw& law, double v, double v0) {
  const double rise = std::sqrt(v / v0), room = std::sqrt(law.available / v);
  const double left = room - 1.0, left2 = left * left;
  const double stress = law.spring * (rise - 1.0) / (left2 * left2);
  // d rise / dV = rise / 2V, d room / dV = - room / 2V.
  const double slope = law.spring * (0.5 * rise + 2.0 * (rise - 1.0) * room / left) / (left2 * left2 * v);
  return {stress, slope};
}

// Integral of Gutowski's stress over V^2. With x = sqrt V it is 2 A (x^2 / x0 - x) / (xa - x)^4 dx, and in
// s = xa - x a sum of powers.
double gutowski_primitive(const CompactionLaw& law, double v, double v0) {
  const double xa = std::sqrt(law.available), x0 = std::sqrt(v0), s = xa - std::sqrt(v);
  const double c0 = xa * xa / x0 - xa, c1 = 1.0 - 2.0 * xa / x0, c2 = 1.0 / x0;
  return 2.0 * law.spring * ((c0 / (3.0 * s) + 0.5 * c1) / s + c2) / s;
}

// The tangent at V_c takes over beyond it.
double straight_from(double v0) {
  return std::max(packed_fibre_fraction, v0);
}

}  // namespace

CompactionLaw::Value CompactionLaw::evaluate(double fibre_fraction, double stress_free) const {
  if (form == CompactionForm::gutowski) {
    if (fibre_fraction <= stress_free) return {0.0, 0.0};
    const double last = straight_from(stress_free);
    if (fibre_fraction <= last) return gutowski(*this, fibre_fraction, stress_free);
    const Value at_last = gutowski(*this, last, stress_free);
    return {at_last.stress + at_last.slope * (fibre_fraction - last), at_last.slope};
  }
  const double bed = modulus * power(fibre_fraction, exponent);
  const double excess = std::max(fibre_fraction / packing - 1.0, 0.0);
  return {bed + packing_modulus * excess * excess,
          exponent * bed / fibre_fraction + 2.0 * packing_modulus * excess / packing};
}

double CompactionLaw::work(double stress_free, double fibre_fraction) const {
  const double v0 = stress_free, v = fibre_fraction;
  if (form == CompactionForm::gutowski) {
    const double last = straight_from(v0), upto = std::min(v, last);
    double sum = gutowski_primitive(*this, upto, v0) - gutowski_primitive(*this, v0, v0);
    if (v <= last) return sum;
    const Value at_last = gutowski(*this, last, v0);
    return sum + (at_last.stress - at_last.slope * last) * (1.0 / last - 1.0 / v) +
           at_last.slope * std::log(v / last);
  }
  const double n = exponent;
  const double bed = modulus * (power(v, n - 1.0) - power(v0, n - 1.0)) / (n - 1.0);
  const double packed = packing_work(*this, v) - packing_work(*this, v0);
  return bed + packed;
}

TowSqueeze::TowSqueeze(const CompactionLaw& law, double thickness, double fibre_fraction)
    : law_(law),
      thickness_(thickness),
      fibre_fraction_(fibre_fraction),
      start_(law.evaluate(fibre_fraction, fibre_fraction)) {}

TowSqueeze::Value TowSqueeze::evaluate(double squeeze) const {
  if (squeeze <= 0.0) return {0.0, 0.0, 0.0};
  const double v0 = fibre_fraction_, left = thickness_ - squeeze;
  const double v = v0 * thickness_ / left;
  const CompactionLaw::Value now = law_.evaluate(v, v0);
  // d delta = V0 t dV / V^2 turns the work into integrals over V^2.
  return {v0 * thickness_ * law_.work(v0, v) - start_.stress * squeeze, now.stress - start_.stress,
          now.slope * v / left};
}

double TowSqueeze::stress(double squeeze) const {
  if (squeeze <= 0.0) return 0.0;
  return law_.evaluate(fibre_fraction_ * thickness_ / (thickness_ - squeeze), fibre_fraction_).stress -
         start_.stress;
}

double TowSqueeze::squeeze_at(double fibre_fraction_reached) const {
  return thickness_ * (1.0 - fibre_fraction_ / fibre_fraction_reached);
}

PairSqueeze::PairSqueeze(const TowSqueeze& first, const TowSqueeze& second, bool alike)
    : first_(first), second_(second), alike_(alike) {}

TowSqueeze::Value PairSqueeze::evaluate(double squeeze) const {
  if (squeeze <= 0.0) return {0.0, 0.0, 0.0};
  if (alike_) {
    const TowSqueeze::Value each = first_.evaluate(0.5 * squeeze);
    return {2.0 * each.energy, each.stress, 0.5 * each.slope};
  }
  const double own = share_of_first(squeeze);
  const TowSqueeze::Value a = first_.evaluate(own), b = second_.evaluate(squeeze - own);
  // Springs in series.
  return {a.energy + b.energy, a.stress, a.slope * (b.slope / (a.slope + b.slope))};
}

double PairSqueeze::stress(double squeeze) const {
  if (squeeze <= 0.0) return 0.0;
  return first_.stress(alike_ ? 0.5 * squeeze : share_of_first(squeeze));
}

double PairSqueeze::squeeze_at(double fibre_fraction_reached) const {
  return first_.squeeze_at(fibre_fraction_reached) + second_.squeeze_at(fibre_fraction_reached);
}

// Newton's method on s1(x) = s2(delta - x), kept in its bracket; the difference grows with x.
double PairSqueeze::share_of_first(double squeeze) const {
  const double both = first_.thickness() + second_.thickness();
  double low = std::max(squeeze - second_.thickness(), 0.0), high = std::min(squeeze, first_.thickness());
  double x = squeeze * first_.thickness() / both;
  for (int k = 0; k < 100; ++k) {
    const TowSqueeze::Value a = first_.evaluate(x), b = second_.evaluate(squeeze - x);
    const double excess = a.stress - b.stress;
    if (std::abs(excess) <= 1e-14 * (a.stress + b.stress)) break;
    (excess > 0.0 ? high : low) = x;
    const double next = x - excess / (a.slope + b.slope);
    const double moved = next > low && next < high ? next : 0.5 * (low + high);
    if (moved == x) break;
    x = moved;
  }
  return x;
}

}  // namespace heddle::mesoscale
