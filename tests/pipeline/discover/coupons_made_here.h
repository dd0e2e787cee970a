#pragma once

#include <fmt/format.h>

#include <functional>
#include <string>
#include <vector>

#include "core/text_file.h"
#include "friction/friction_test.h"
#include "pipeline/discover/random.h"
#include "shipped_question.h"

/// Coupons written as a laboratory would hand them over, made with the laws of this program: that a right
/// name is found in them says that the chain works, not that it would be found in nature. For that see
/// tests/blind.
namespace heddle::test {

/// Table 2 one factor at a time, and as many cells that cross load, speed and tool temperature.
inline std::vector<discover::CouponCell> both_designs() {
  std::vector<discover::CouponCell> cells = crossed_cells();
  for (const discover::CouponCell& cell : paper_cells()) cells.push_back(cell);
  return numbered(std::move(cells));
}

struct Campaign {
  friction::Model model;  ///< with the hidden effect
  std::vector<discover::CouponCell> cells = both_designs();
  int replicates = 5;
  double gain = 0.05, day = 0.02, reading = 0.01;
  std::uint64_t seed = 1;
  std::vector<double> slips{0.4, 0.7, 1.1, 1.8, 3.0, 5.0, 8.0, 13.0, 21.0, 34.0, 55.0};  // [mm]
};

inline friction::Model plain_stribeck() {
  friction::Model model;
  model.law = friction::HerseyPower{.scale = 0.31, .exponent = 0.12};
  model.film = {.consistency = 6500.0, .index = 0.39, .thickness = 7e-5};
  model.film.activation_energy = 41e3;
  return model;
}

/// The table; the first cell is repeated on every day.
inline std::string coupons_csv(const Campaign& campaign) {
  std::string text =
      "condition_id,sample_id,day_id,velocity_mm_s,normal_force_N,tool_temperature_C,fabric_temperature_C,"
      "orientation_deg,dwell_s,time_s,displacement_mm,pull_force_N,normal_force_measured_N\n";
  discover::Random random(campaign.seed);
  constexpr std::size_t cells_a_day = 5;
  const std::size_t days = (campaign.cells.size() + cells_a_day - 2) / (cells_a_day - 1);
  int sample = 0;
  for (std::size_t day = 0; day < days; ++day) {
    const double shift = campaign.day * random.normal();
    std::vector<std::size_t> today{0};
    for (std::size_t k = 1; k < cells_a_day; ++k)
      if (const std::size_t cell = day * (cells_a_day - 1) + k; cell < campaign.cells.size())
        today.push_back(cell);
    for (const std::size_t c : today)
      for (int replicate = 0; replicate < campaign.replicates; ++replicate) {
        const discover::CouponCell& cell = campaign.cells[c];
        const double gain = shift + campaign.gain * random.normal();
        ++sample;
        for (const double slip : campaign.slips) {
          friction::FrictionRig rig{
              .plate_area = 0.01, .pull_length = 1e-3 * slip, .dwell_before = cell.dwell};
          const double force = friction::run_friction_test(campaign.model, cell.pull, rig).pull_force *
                               std::exp(gain + campaign.reading * random.normal());
          text +=
              fmt::format("{},s{},d{},{:.6g},{:.6g},{:.6g},{:.6g},{:.6g},{:.6g},{:.6g},{:.6g},{:.6g},\n",
                          cell.pull.name, sample, day + 1, 1e3 * cell.pull.velocity, cell.pull.normal_force,
                          cell.pull.tool_temperature - 273.15, cell.pull.fabric_temperature - 273.15,
                          cell.pull.orientation * 180.0 / std::numbers::pi, cell.dwell,
                          cell.dwell + 1e-3 * slip / cell.pull.velocity, slip, force);
        }
      }
  }
  return text;
}

}  // namespace heddle::test
