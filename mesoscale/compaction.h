#pragma once

namespace heddle::mesoscale {

/// Pressure that a bundle of fibres carries across, against its fibre volume fraction.
///
///     sigma(V) = k E V^n + K <V / V_p - 1>^2,   <.> = max(., 0)
///
/// First term: Toll's power law. Its stress stays below k E at any packing, so the second term stands for
/// fibres that touch along their length: it starts with zero value and slope at V_p and rises steeply but
/// finitely. Drained: the resin has gone, so only the fibres carry. Source: Toll 1998 (form); k E, n, V_p and
/// K are priors.
struct CompactionLaw {
  double modulus;                ///< k E [Pa], > 0
  double exponent;               ///< n [-], > 1
  double packing = 0.75;         ///< V_p [-]: between square (0.785) and what bundles reach; < 1
  double packing_modulus = 6e9;  ///< K [Pa]: transverse modulus of a tow at V = 0.6 (Chamis)

  struct Value {
    double stress;  ///< sigma [Pa]
    double slope;   ///< d sigma / dV [Pa]
  };
  Value evaluate(double fibre_fraction) const;
};

/// Tables end where stress-free tows would be packed to this: past V_p, where the law is steep, and short of
/// what parallel fibres can reach (0.907).
inline constexpr double packed_fibre_fraction = 0.82;

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
