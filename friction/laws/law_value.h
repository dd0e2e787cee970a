#pragma once

namespace heddle::friction {

/// mu of a law that sees nothing but the Hersey number, and its slope.
struct LawValue {
  double mu;               ///< [-]
  double dmu_dlog_hersey;  ///< d mu / d ln Hs [-]
};

}  // namespace heddle::friction
