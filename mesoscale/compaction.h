#pragma once

namespace heddle::mesoscale {

enum class CompactionForm { power, gutowski };

/// Tables end where stress-free tows would be packed to this: past V_p, where the law is steep, and short of
/// what parallel fibres can reach (0.907).
inline constexpr double packed_fibre_fraction = 0.82;

/// Pressure that a bundle of fibres carries across, against its fibre volume fraction.
///
/// power:  sigma(V) = k E V^n + K <V / V_p - 1>^2,   <.> = max(., 0)
///
/// First term: a random network, n = 3 by van Wyk 1946, 5 for planar ones by Toll 1998. Its stress stays
/// below k E at any packing, so the second term stands for fibres that touch along their length: it starts
/// with zero value and slope at V_p and rises steeply but finitely. k E, n, V_p and K are priors.
///
/// gutowski:  sigma(V) = A_s (sqrt(V / V_0) - 1) / (sqrt(V_a / V) - 1)^4,   V >= V_0
///
/// Slightly wavy fibres that are nearly parallel, as beams between ever more contacts: nothing at V_0,
/// without bound at V_a. V_0 is the stress-free fraction of the tow. Beyond V = packed_fibre_fraction the law
/// goes on straight, so that searches may look there. Source: Gutowski et al. 1987 (recalled); A_s and V_a
/// are priors.
///
/// Drained: the resin has gone, so only the fibres carry.
struct CompactionLaw {
  double modulus;                ///< k E [Pa], > 0
  double exponent;               ///< n [-], > 1
  double packing = 0.75;         ///< V_p [-]: between square (0.785) and what bundles reach; < 1
  double packing_modulus = 6e9;  ///< K [Pa]: transverse modulus of a tow at V = 0.6 (Chamis)
  CompactionForm form = CompactionForm::power;
  double spring = 3e3;      ///< A_s [Pa]
  double available = 0.85;  ///< V_a [-], > packed_fibre_fraction

  struct Value {
    double stress;  ///< sigma [Pa]
    double slope;   ///< d sigma / dV [Pa]
  };
  /// @param stress_free  V_0, below V_a; counts in Gutowski's law alone: the network's stress is absolute
  Value evaluate(double fibre_fraction, double stress_free) const;
  /// Integral of sigma / V^2 over V from V_0 to V, in closed form: work of squeezing, per V_0 t [Pa].
  double work(double stress_free, double fibre_fraction) const;
};

/// A tow of thickness t and fibre fraction V0 squeezed by delta, with the stress-free part taken off:
///     s(delta) = sigma(V0 t / (t - delta)) - sigma(V0),   0 <= delta < t
class TowSqueeze {
 public:
  /// @param thickness  t [m], > 0
  /// @param fibre_fraction  V0 [-], > 0
  TowSqueeze(const CompactionLaw& law, double thickness, double fibre_fraction);

  double thickness() const { return thickness_; }

  struct Value {
    double energy;  ///< integral of the stress over delta, closed form [J/m^2]
    double stress;  ///< s [Pa]
    double slope;   ///< ds / d delta [Pa/m]
  };
  /// delta < 0 gives zeros.
  Value evaluate(double squeeze) const;
  double stress(double squeeze) const;
  /// Squeeze at which the fibre fraction is V [m].
  double squeeze_at(double fibre_fraction_reached) const;

 private:
  CompactionLaw law_;
  double thickness_, fibre_fraction_;
  CompactionLaw::Value start_;  ///< of the stress-free tow
};

/// Two tows squeezed together by delta in all: each gives way until both carry the same stress, so that the
/// stress is the slope of the energy. Tows that are alike give way by half each.
class PairSqueeze {
 public:
  PairSqueeze(const TowSqueeze& first, const TowSqueeze& second, bool alike);

  /// Energy of both tows; delta < 0 gives zeros.
  TowSqueeze::Value evaluate(double squeeze) const;
  double stress(double squeeze) const;
  /// Squeeze at which the fibres of each tow reach volume fraction V [m].
  double squeeze_at(double fibre_fraction_reached) const;

 private:
  double share_of_first(double squeeze) const;  ///< what the first tow gives way [m]

  TowSqueeze first_, second_;
  bool alike_;
};

}  // namespace heddle::mesoscale
