#pragma once

#include <span>
#include <string_view>

#include "core/problem.h"
#include "friction/model.h"

namespace heddle::friction {

/// An effect that cannot stand beside a law or a rheology, and why. Ids as in the configuration; the law
/// `no_hersey_number` stands for every law that reads none.
struct Refusal {
  std::string_view effect;
  std::string_view with;
  std::string_view reason;
};
inline constexpr std::string_view no_hersey_number = "no_hersey_number";

std::span<const Refusal> refusals();

/// One problem for each refused pair; effects at their off value go with everything.
Problems check_combinations(const Model& model);

}  // namespace heddle::friction
