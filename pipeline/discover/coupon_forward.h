#pragma once

#include <memory>
#include <optional>
#include <string>
#include <utility>
#include <vector>

#include "friction/friction_test.h"
#include "friction/model.h"
#include "pipeline/discover/coupon_campaign.h"
#include "pipeline/discover/effect_library.h"
#include "pipeline/discover/hypothesis.h"

namespace heddle::discover {

/// The friction test as discovery sees it.
struct CouponRig {
  friction::FrictionRig rig;
  friction::AreaFunction area;  ///< empty: nominal pressure
  int faces = 2;                ///< F = faces mu N
};

/// ln F of every point of the cells, in their order: the law with its effects, then what the rig does to it.
/// @param base      the model of the case, effects as it has them
/// @param baseline  numbers that every hypothesis moves; keys of numbers_of(base)
/// @param effects   that are tried; each of usable_effects
/// @param others    conditions that a wrong label may stand for (R6), numbered after the cells
ForwardModel coupon_forward(const friction::Model& base, const CouponRig& rig,
                            const std::vector<CouponCell>& cells, std::vector<Unknown> baseline,
                            const std::vector<EffectFile>& effects, std::size_t days,
                            const std::vector<CouponCell>& others = {});

/// Effects that this model can have: their numbers are there once their term is, no rule of
/// friction/combinations.h forbids them, and the case does not hold them already.
/// @param refused  of each effect left out: id and why
std::vector<EffectFile> usable_effects(const friction::Model& base, const std::vector<EffectFile>& effects,
                                       std::vector<std::pair<std::string, std::string>>* refused = nullptr);

/// The model with a trial's numbers in it; rig effects leave it as it is.
friction::Model patched_model(const friction::Model& base, const ForwardModel& forward, const Trial& trial);

/// R6: the forces of `cell` are those of condition `truly`, numbered as coupon_forward does; where two labels
/// are exchanged, those of cell `partner` are those of `cell`.
struct WrongLabel {
  std::size_t cell = 0, truly = 0;
  std::optional<std::size_t> partner = {};
};
/// @param words       which it is, for people
/// @param conditions  among which each pair is as probable as any other
Candidate mislabelled(const Candidate& library, const WrongLabel& label, const std::string& words,
                      std::size_t conditions);

/// Hersey number of each cell under the model; empty where the law has none.
std::vector<double> hersey_numbers(const friction::Model& model, const CouponRig& rig,
                                   const std::vector<CouponCell>& cells);

}  // namespace heddle::discover
