#include <algorithm>
#include <cmath>

#include "campaign.h"

namespace blindgen {

namespace {

constexpr int samples_a_cell = 5;
constexpr int cells_a_day = 6;
constexpr double correlated_noise = 0.015, correlation = 0.7;  // along a pull, from point to point
constexpr double white_noise = 0.010;
constexpr double force_bias = 0.010, force_bias_of_day = 0.005;          // of N
constexpr double temperature_bias = 2.0, temperature_bias_of_day = 1.0;  // [K]
constexpr double force_cell_noise = 0.003;                               // of the measured N

/// What the settings truly give.
struct Bias {
  double load = 0, tool = 0, fabric = 0;  ///< [-], [K], [K]
};

Bias draw_bias(Stream& stream, double load, double temperature) {
  return {load * stream.normal(), temperature * stream.normal(), temperature * stream.normal()};
}

struct Run {
  int condition, day;  ///< numbers from 1
};

/// Distinct conditions in the order in which they are first run, and the runs of all days.
struct Schedule {
  std::vector<Condition> conditions;
  std::vector<Run> runs;
  int days = 0;
};

int number_of(Schedule& schedule, const Condition& condition) {
  const auto found = std::ranges::find(schedule.conditions, condition);
  const int place = static_cast<int>(found - schedule.conditions.begin());
  if (found == schedule.conditions.end()) schedule.conditions.push_back(condition);
  return place + 1;
}

Schedule plan_days(Design design, Stream& stream) {
  std::vector<Cell> cells = cells_of(design);
  cells.erase(cells.begin());  // the baseline is run every day
  stream.shuffle(cells);
  std::ranges::stable_sort(cells, {}, &Cell::round);
  Schedule schedule;
  for (std::size_t i = 0; i < cells.size(); ++i) {
    if (i % cells_a_day == 0) schedule.runs.push_back({number_of(schedule, baseline()), ++schedule.days});
    schedule.runs.push_back({number_of(schedule, cells[i].condition), schedule.days});
  }
  return schedule;
}

/// In one case of ten up to one cell in twelve was never run; the baseline always was.
std::vector<int> drop_cells(Schedule& schedule, Stream& stream) {
  const bool any = stream.uniform() < 0.10;
  const int conditions = static_cast<int>(schedule.conditions.size());
  const int count = 1 + stream.index(std::max(1, conditions / 12));
  std::vector<int> missing;
  while (any && static_cast<int>(missing.size()) < count) {
    const int candidate = 2 + stream.index(conditions - 1);
    if (std::ranges::find(missing, candidate) == missing.end()) missing.push_back(candidate);
  }
  std::erase_if(schedule.runs,
                [&](const Run& run) { return std::ranges::find(missing, run.condition) != missing.end(); });
  std::ranges::sort(missing);
  return missing;
}

std::vector<double> logged_slips(Stream& stream) {
  const int count = 12 + stream.index(9);
  std::vector<double> slips;
  for (int i = 0; i < count; ++i) slips.push_back(0.3e-3 * std::pow(200.0, i / (count - 1.0)));
  return slips;
}

/// Two conditions whose plain forces differ by 15 to 40 %, so that nobody sees the exchange at once.
std::vector<int> choose_swap(const World& world, const Schedule& schedule, Stream& stream) {
  const std::vector<double> middle{30e-3};
  const auto log_force = [&](int number) {
    return std::log(pull(world, schedule.conditions[static_cast<std::size_t>(number - 1)], middle)[0]);
  };
  std::vector<std::vector<int>> pairs;
  const auto run = [&](int number) {
    return std::ranges::find(schedule.runs, number, &Run::condition) != schedule.runs.end();
  };
  const int count = static_cast<int>(schedule.conditions.size());
  for (int i = 2; i <= count; ++i) {
    for (int j = i + 1; j <= count; ++j) {
      const double apart = std::abs(log_force(i) - log_force(j));
      if (apart > std::log(1.15) && apart < std::log(1.40) && run(i) && run(j)) pairs.push_back({i, j});
    }
  }
  return pairs.at(static_cast<std::size_t>(stream.index(static_cast<int>(pairs.size()))));
}

/// Gain that drifts from the first day to the last, zero at the middle of the two.
double drift_gain(const Drift& drift, int day, int days) {
  const double place = days > 1 ? (day - 1.0) / (days - 1.0) : 0.5;
  return std::exp(drift.sign * drift.span * (std::pow(place, drift.power) - 0.5));
}

Condition true_condition(const Condition& set, const Bias& a, const Bias& b) {
  Condition condition = set;
  condition.normal_force *= 1.0 + a.load + b.load;
  condition.tool_temperature += a.tool + b.tool;
  condition.fabric_temperature += a.fabric + b.fabric;
  return condition;
}

/// All that goes wrong between the film and the file.
struct Disturbance {
  Stream gain, points, cell;
  double sample_scatter;

  /// ln of the factor at each point of a sample
  std::vector<double> draw(std::size_t count) {
    const double level = sample_scatter * gain.normal();
    std::vector<double> errors;
    double correlated = correlated_noise * points.normal();
    for (std::size_t i = 0; i < count; ++i) {
      if (i > 0) {
        correlated = correlation * correlated +
                     correlated_noise * std::sqrt(1.0 - correlation * correlation) * points.normal();
      }
      errors.push_back(level + correlated + white_noise * points.normal());
    }
    return errors;
  }
};

struct Day {
  Bias bias;
  double gain = 1.0;
};

std::vector<Day> draw_days(const Spec& spec, const World& world, int count, Stream& stream) {
  std::vector<Day> days;
  for (int day = 1; day <= count; ++day) {
    const Bias bias = draw_bias(stream, force_bias_of_day, temperature_bias_of_day);
    days.push_back(
        {bias, std::exp(spec.day_scatter * stream.normal()) * drift_gain(world.drift, day, count)});
  }
  return days;
}

/// One sample: the condition that is run, and the one that its label says.
struct Pull {
  int sample, day;
  int run, label;  ///< numbers of conditions
};

/// Labels of two conditions may be exchanged as a whole; one sample may have been run as another condition.
std::vector<Pull> plan_pulls(const Schedule& schedule, const std::vector<int>& swap) {
  std::vector<Pull> pulls;
  for (const Run& run : schedule.runs) {
    int label = run.condition;
    if (!swap.empty() && label == swap[0]) {
      label = swap[1];
    } else if (!swap.empty() && label == swap[1]) {
      label = swap[0];
    }
    for (int k = 0; k < samples_a_cell; ++k) {
      pulls.push_back({static_cast<int>(pulls.size()) + 1, run.day, run.condition, label});
    }
  }
  return pulls;
}

/// In one case of twenty one sample was run as another condition than its label says.
/// @return its number, or 0
int mistake_one(std::vector<Pull>& pulls, const Schedule& schedule, Stream& stream) {
  const bool any = stream.uniform() < 0.05;
  Pull& pull = pulls[static_cast<std::size_t>(stream.index(static_cast<int>(pulls.size())))];
  const int run = 1 + stream.index(static_cast<int>(schedule.conditions.size()));
  if (!any || run == pull.run) return 0;
  pull.run = run;
  return pull.sample;
}

/// The conditions of one more day, with the baseline again, numbered on.
void add_day(const std::vector<Condition>& extra, Schedule& schedule, std::vector<Pull>& pulls) {
  if (extra.empty()) return;
  ++schedule.days;
  std::vector<int> numbers{number_of(schedule, baseline())};
  for (const Condition& condition : extra) numbers.push_back(number_of(schedule, condition));
  for (const int number : numbers) {
    for (int k = 0; k < samples_a_cell; ++k) {
      pulls.push_back({static_cast<int>(pulls.size()) + 1, schedule.days, number, number});
    }
  }
}

bool swaps_labels(const Case& hidden) {
  return std::ranges::any_of(hidden.hidden, [](const Hidden& h) { return h.id == "mislabelled_condition"; });
}

/// The readings of one sample. A wrong label does not touch the clock and the load cell: they log what was
/// run.
void read(const World& world, const Pull& pull, const Schedule& schedule, const Bias& bias, const Day& day,
          const std::vector<double>& slips, bool load_is_logged, Disturbance& noise, std::vector<Row>& rows) {
  const Condition& set = schedule.conditions[static_cast<std::size_t>(pull.run - 1)];
  const Condition& nominal = schedule.conditions[static_cast<std::size_t>(pull.label - 1)];
  const std::vector<double> forces = blindgen::pull(world, true_condition(set, bias, day.bias), slips);
  const std::vector<double> errors = noise.draw(slips.size());
  for (std::size_t i = 0; i < slips.size(); ++i) {
    const double measured = set.normal_force * (1.0 + force_cell_noise * noise.cell.normal());
    rows.push_back({pull.label, pull.sample, pull.day, nominal, slips[i] / set.velocity, slips[i],
                    forces[i] * day.gain * std::exp(errors[i]),
                    load_is_logged ? std::optional(measured) : std::nullopt});
  }
}

}  // namespace

Campaign measure(const Spec& spec, const Case& hidden) {
  const auto stream = [&](const std::string& what) {
    return Stream(
        spec.seed, static_cast<std::uint64_t>(spec.case_number),
        what + " of " + std::string(name_of(spec.kind)) + " on " + std::string(name_of(spec.design)));
  };
  Stream layout = stream("layout"), mistakes = stream("mistakes"), rig = stream("rig");
  Campaign campaign;
  Schedule schedule = plan_days(spec.design, layout);
  const std::vector<double> slips = logged_slips(layout);
  const bool load_is_logged = layout.uniform() < 0.3 && hidden.world.relaxation.loss == 0.0;
  campaign.missing_conditions = drop_cells(schedule, mistakes);
  if (swaps_labels(hidden)) campaign.swapped_conditions = choose_swap(hidden.world, schedule, mistakes);
  std::vector<Pull> pulls = plan_pulls(schedule, campaign.swapped_conditions);
  campaign.mislabelled_sample = mistake_one(pulls, schedule, mistakes);
  add_day(spec.extra, schedule, pulls);
  campaign.days = schedule.days;

  const Bias bias = draw_bias(rig, force_bias, temperature_bias);
  const std::vector<Day> days = draw_days(spec, hidden.world, schedule.days, rig);
  Disturbance noise{stream("gain"), stream("points"), stream("cell"), spec.sample_scatter};
  for (const Pull& pull : pulls) {
    const Day& day = days[static_cast<std::size_t>(pull.day - 1)];
    read(hidden.world, pull, schedule, bias, day, slips, load_is_logged, noise, campaign.rows);
  }
  return campaign;
}

}  // namespace blindgen
