#include "pipeline/discover/coupon_forward.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <limits>
#include <optional>
#include <set>

#include "friction/calibration/model_numbers.h"
#include "friction/combinations.h"

namespace heddle::discover {

namespace {

/// Numbers of the rig effects, by the keys of their files.
struct RigEffects {
  double loss = 0.0, loss_time = 1.0;            // R1
  double offset = 0.0;                           // R2 [N]
  double drift = 0.0;                            // R3
  double backlash = 0.0, backlash_length = 1.0;  // R4
  double contrast = 0.0;                         // R5
  /// R6: a cell, the condition that its forces belong to, and the cell that has the label of that one where
  /// two labels are exchanged; none: negative.
  double from = -1.0, truly = -1.0, partner = -1.0;

  double* find(std::string_view key) {
    if (key == "rig.normal_force_relaxation.loss") return &loss;
    if (key == "rig.normal_force_relaxation.time") return &loss_time;
    if (key == "rig.load_cell_offset.force") return &offset;
    if (key == "rig.gain_drift.drift") return &drift;
    if (key == "rig.drive_backlash.loss") return &backlash;
    if (key == "rig.drive_backlash.length") return &backlash_length;
    if (key == "rig.nonuniform_pressure.contrast") return &contrast;
    return nullptr;
  }
};

/// Puts an effect there with its off value, so that its numbers can be reached.
void switch_on(friction::Model& model, std::string_view term) {
  friction::for_each_effect(model.effects, [&]<class E>(std::optional<E>& effect) {
    if (!effect && friction::About<E>::id == term) effect.emplace();
  });
}

bool is_rig_key(const std::string& key) {
  return key.starts_with("rig.");
}

class CouponPredictor {
 public:
  /// @param others  conditions that a wrong label may stand for; they come after the cells
  CouponPredictor(CouponRig rig, std::vector<CouponCell> cells, const std::vector<CouponCell>& others,
                  std::size_t days)
      : rig_(std::move(rig)), cells_(std::move(cells)), predicted_(cells_.size()), days_(days) {
    for (const CouponCell& cell : cells_) size_ += std::ssize(cell.points);
    cells_.insert(cells_.end(), others.begin(), others.end());
    for (const CouponCell& cell : cells_)
      contexts_.push_back(friction::contact_of(cell.pull, rig_.rig, rig_.area));
  }

  Eigen::VectorXd operator()(const friction::Model& model, const RigEffects& rig) const {
    const bool memory = friction::has_memory(model);
    Eigen::VectorXd log_force(size_);
    Eigen::Index at = 0;
    for (std::size_t c = 0; c < predicted_; ++c) {
      const std::size_t acting = acting_on(c, rig);
      std::optional<double> steady;                  // mu of the cell, where the point does not matter
      std::optional<friction::ContactState> rested;  // what all points of the cell start from
      const friction::ContactState unloaded;
      for (const CouponPoint& point : cells_[c].points) {
        // A cell that carries the label of another was pressed with the other's load.
        const double load = acting == c ? point.normal_force : cells_[acting].pull.normal_force;
        const bool relaxing = rig.loss != 0.0 && !cells_[c].load_measured;
        const bool special = memory || relaxing || rig.contrast != 0.0;
        double force;
        if (!special) {
          if (!steady) steady = coefficient(model, acting, cells_[acting].pull.normal_force, point, {});
          force = rig_.faces * *steady * load;
        } else {
          const double time = cells_[acting].dwell + slip_of(point) / cells_[acting].pull.velocity;
          const double acts =
              relaxing ? load * (1.0 - rig.loss * (1.0 - std::exp(-time / rig.loss_time))) : load;
          if (memory && !rested)
            rested = friction::state_after_rest(model, contexts_[acting], cells_[acting].dwell);
          const friction::ContactState& start = rested ? *rested : unloaded;
          force = rig.contrast == 0.0 ? rig_.faces * coefficient(model, acting, acts, point, start) * acts
                                      : uneven_force(model, rig, acting, acts, point, start);
        }
        log_force[at++] = std::log(force + rig.offset) + gain(rig, c, point);
      }
    }
    return log_force;
  }

 private:
  static std::size_t acting_on(std::size_t cell, const RigEffects& rig) {
    if (rig.truly < 0.0) return cell;
    if (cell == static_cast<std::size_t>(rig.from)) return static_cast<std::size_t>(rig.truly);
    if (rig.partner >= 0.0 && cell == static_cast<std::size_t>(rig.partner))
      return static_cast<std::size_t>(rig.from);
    return cell;
  }

  double slip_of(const CouponPoint& point) const { return point.steady ? rig_.rig.pull_length : point.slip; }

  /// mu of a point. The load of a point that relaxes differs from the one its rest was under by little: the
  /// rest is that of the cell.
  double coefficient(const friction::Model& model, std::size_t cell, double load, const CouponPoint& point,
                     const friction::ContactState& rested) const {
    friction::Context context = contexts_[cell];
    if (load != cells_[cell].pull.normal_force) {
      friction::FrictionTestRow pull = cells_[cell].pull;
      pull.normal_force = load;
      context = friction::contact_of(pull, rig_.rig, rig_.area);
    }
    if (!friction::has_memory(model)) return friction::evaluate_unchecked(model, context, {}).mu;
    const friction::ContactState state = friction::state_after_slip(model, context, rested, slip_of(point));
    return friction::evaluate_unchecked(model, context, state).mu;
  }

  /// Half of each plate takes more, half less.
  double uneven_force(const friction::Model& model, const RigEffects& rig, std::size_t cell, double load,
                      const CouponPoint& point, const friction::ContactState& rested) const {
    constexpr double baseline_load = 1500.0;  // [N] (paper, Table 2)
    const double share = std::min(rig.contrast * load / baseline_load, 0.95);
    double force = 0.0;
    for (const double factor : {1.0 + share, 1.0 - share})
      force += 0.5 * rig_.faces * coefficient(model, cell, factor * load, point, rested) * factor * load;
    return force;
  }

  double gain(const RigEffects& rig, std::size_t cell, const CouponPoint& point) const {
    double log_gain = 0.0;
    if (rig.drift != 0.0 && days_ > 1)
      log_gain +=
          rig.drift * (2.0 * static_cast<double>(cells_[cell].day) / static_cast<double>(days_ - 1) - 1.0);
    if (rig.backlash != 0.0)
      log_gain += std::log1p(-rig.backlash * std::exp(-slip_of(point) / rig.backlash_length));
    return log_gain;
  }

  CouponRig rig_;
  std::vector<CouponCell> cells_;  ///< the predicted ones first
  std::size_t predicted_;
  std::size_t days_;
  std::vector<friction::Context> contexts_;
  Eigen::Index size_ = 0;
};

}  // namespace

friction::Model patched_model(const friction::Model& base, const ForwardModel& forward, const Trial& trial) {
  friction::Model model = base;
  for (std::size_t k = 0; k < forward.baseline.size(); ++k)
    friction::number_in(model, forward.baseline[k].key) = trial.baseline[static_cast<Eigen::Index>(k)];
  for (const auto& [effect, values] : trial.effects) {
    const std::vector<Unknown>& numbers = forward.candidates[effect].numbers;
    for (std::size_t k = 0; k < numbers.size(); ++k) {
      if (is_rig_key(numbers[k].key)) continue;
      if (numbers[k].key.starts_with("effects.")) {
        const std::size_t dot = numbers[k].key.find('.', 8);
        switch_on(model, std::string_view(numbers[k].key).substr(8, dot - 8));
      }
      friction::number_in(model, numbers[k].key) = values[static_cast<Eigen::Index>(k)];
    }
  }
  return model;
}

ForwardModel coupon_forward(const friction::Model& base, const CouponRig& rig,
                            const std::vector<CouponCell>& cells, std::vector<Unknown> baseline,
                            const std::vector<EffectFile>& effects, std::size_t days,
                            const std::vector<CouponCell>& others) {
  ForwardModel forward;
  forward.baseline = std::move(baseline);
  for (const EffectFile& effect : effects) forward.candidates.push_back(effect.candidate());
  const auto predictor = std::make_shared<const CouponPredictor>(rig, cells, others, days);
  // The candidates may grow after this (R6): a prediction looks at those it was made with, and a copy is
  // cheap.
  forward.predict = [predictor, base, numbers = forward](const Trial& trial) {
    RigEffects rig_effects;
    for (const auto& [effect, values] : trial.effects) {
      if (effect >= numbers.candidates.size()) {  // R6
        rig_effects.from = values[0];
        rig_effects.truly = values[1];
        rig_effects.partner = values[2];
        continue;
      }
      const std::vector<Unknown>& known = numbers.candidates[effect].numbers;
      for (std::size_t k = 0; k < known.size(); ++k)
        if (double* number = rig_effects.find(known[k].key); number != nullptr)
          *number = values[static_cast<Eigen::Index>(k)];
    }
    Trial physics = trial;
    std::erase_if(physics.effects,
                  [&](const auto& effect) { return effect.first >= numbers.candidates.size(); });
    return (*predictor)(patched_model(base, numbers, physics), rig_effects);
  };
  return forward;
}

std::vector<EffectFile> usable_effects(const friction::Model& base, const std::vector<EffectFile>& effects,
                                       std::vector<std::pair<std::string, std::string>>* refused) {
  std::vector<EffectFile> usable;
  const auto refuse = [&](const EffectFile& effect, std::string why) {
    if (refused != nullptr) refused->emplace_back(effect.id, std::move(why));
  };
  for (const EffectFile& effect : effects) {
    if (effect.id == "mislabelled_condition") continue;  // made of pairs of conditions
    friction::Model with = base;
    std::set<std::string> before, after;
    for (const friction::ModelNumber& number : friction::numbers_of(base)) before.insert(number.key);
    switch_on(with, effect.term);
    for (const friction::ModelNumber& number : friction::numbers_of(with)) after.insert(number.key);
    RigEffects rig;
    std::string missing;
    bool held = false;
    for (const Unknown& number : effect.numbers) {
      if (is_rig_key(number.key) ? rig.find(number.key) == nullptr : !after.contains(number.key))
        missing = number.key;
      held = held || (number.key.starts_with("effects.") && before.contains(number.key));
    }
    if (!missing.empty()) {
      refuse(effect, fmt::format("acts on {}, which friction coupons do not see", missing));
      continue;
    }
    if (held) {
      refuse(effect, "is in the case already");
      continue;
    }
    if (!is_rig_key(effect.numbers.front().key)) {
      friction::number_in(with, effect.numbers.front().key) = effect.numbers.front().prior.value_at(0.5);
      if (const Problems problems = friction::check_combinations(with); !problems.empty()) {
        refuse(effect, problems.front().rule);
        continue;
      }
    }
    usable.push_back(effect);
  }
  return usable;
}

Candidate mislabelled(const Candidate& library, const WrongLabel& label, const std::string& words,
                      std::size_t conditions) {
  Candidate candidate = library;
  const auto index = [](double k) { return Prior{.kind = Prior::Kind::fixed, .centre = k}; };
  candidate.numbers = {
      {.key = "rig.mislabelled_condition.from", .unit = "", .prior = index(static_cast<double>(label.cell))},
      {.key = "rig.mislabelled_condition.truly",
       .unit = "",
       .prior = index(static_cast<double>(label.truly))},
      {.key = "rig.mislabelled_condition.partner",
       .unit = "",
       .prior = index(label.partner ? static_cast<double>(*label.partner) : -1.0)}};
  const auto count = static_cast<double>(conditions);
  candidate.log_weight = -std::log(count * (count - 1.0));
  candidate.detail = words;
  return candidate;
}

std::vector<double> hersey_numbers(const friction::Model& model, const CouponRig& rig,
                                   const std::vector<CouponCell>& cells) {
  std::vector<double> numbers;
  if (!friction::reads_hersey_number(model.law)) return numbers;
  for (const CouponCell& cell : cells)
    numbers.push_back(
        friction::evaluate_unchecked(model, friction::contact_of(cell.pull, rig.rig, rig.area), {}).hersey);
  return numbers;
}

}  // namespace heddle::discover
