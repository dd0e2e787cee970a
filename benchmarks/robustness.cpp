// 200 random stampings (tests/macroscale/random_stampings.h says of what): how many come to their end, with
// what energy residual, how deep on the compaction table, at what cost.
//
//     benchmark_robustness [--from 0] [--to 200] [--part 0/1] [--file NAME] [--limit 900]
//
// One row a case in benchmarks/results/robustness.csv, written as soon as the case has ended; cases that have
// a row are passed over, so an interrupted run goes on where it stopped. --part k/n takes every n-th case,
// for several processes side by side with a file each. --limit: CPU seconds after which a case is given up,
// and has not finished. Ends with a summary of all rows. Judges nothing: the tests run 20 of the cases with
// limits.
#include <fmt/format.h>
#include <tbb/global_control.h>

#include <algorithm>
#include <cstdlib>
#include <filesystem>
#include <set>
#include <string>

#include "benchmarks/measure.h"
#include "core/csv.h"
#include "tests/macroscale/random_stampings.h"

using namespace heddle;

namespace {

constexpr const char* header =
    "case,law,mu,binder_force_N,speed_mm_s,orientation_deg,spacing_mm,blank_mm,round,stroke_mm,tension_"
    "factor,"
    "shear_factor,thermal,free_tilt,nodes,finished,steps,rejected,newton,peak_force_N,shear_max_deg,energy_"
    "residual,"
    "force_balance,"
    "crush_share,friction_swing,cpu_s,failure";

std::string row_of(int number, const test::RandomStamping& c, const test::RobustnessVerdict& v, double cpu) {
  constexpr double degrees = 180.0 / std::numbers::pi;
  const auto& blank = c.spec.blank;
  const bool round = blank.shape == macroscale::BlankShape::circle;
  std::string failure = v.failure;
  std::replace(failure.begin(), failure.end(), ',', ';');
  return fmt::format(
      "{},{},{:.4g},{:.5g},{:.4g},{:.2f},{:.3f},{:.1f},{},{:.2f},{:.3g},{:.3g},{},{},{},{},{},{},{},"
      "{:.5g},{:.2f},{:.3g},{:.3g},{:.3g},{:.3g},{:.1f},{}",
      number, friction::id_of(c.friction.law), c.coefficient, c.spec.process.binder_force, 1e3 * c.speed,
      degrees * blank.orientation, 1e3 * blank.spacing, 1e3 * (round ? 2.0 * blank.radius : blank.size[0]),
      round ? 1 : 0, 1e3 * c.spec.process.stroke, c.tension_factor, c.shear_factor, c.thermal ? 1 : 0,
      c.spec.binder.free_tilt ? 1 : 0, v.summary.nodes, v.finished ? 1 : 0, v.summary.steps,
      v.summary.rejected_steps, v.summary.newton_iterations, v.summary.peak_punch_force,
      degrees * v.summary.shear_angle_max, v.energy_residual, v.force_balance, v.penetration,
      v.summary.friction_swing, cpu, failure.empty() ? "-" : failure);
}

std::filesystem::path path_of(const std::string& name) {
  return std::filesystem::path(HEDDLE_SOURCE_DIR) / "benchmarks/results" / (name + ".csv");
}

std::size_t column(const CsvTable& table, const std::string& name) {
  const auto& names = table.header.cells;
  return static_cast<std::size_t>(std::find(names.begin(), names.end(), name) - names.begin());
}

void summarise(const std::string& name) {
  const CsvTable table = read_csv(path_of(name));
  const auto number = [&](const CsvRow& row, const char* what) {
    return std::stod(row.cells[column(table, what)]);
  };
  std::size_t finished = 0;
  double energy = 0.0, pressure = 0.0, cpu = 0.0;
  for (const CsvRow& row : table.rows) {
    cpu += number(row, "cpu_s");
    if (number(row, "finished") != 1.0) {
      fmt::print("  case {}: {}\n", row.cells.front(), row.cells.back());
      continue;
    }
    ++finished;
    energy = std::max(energy, number(row, "energy_residual"));
    pressure = std::max(pressure, number(row, "crush_share"));
  }
  fmt::print(
      "{} of {} cases finished; largest energy residual {:.3g} %; largest pressure {:.3g} of the "
      "compaction table's last; {:.0f} CPU s\n",
      finished, table.rows.size(), 100.0 * energy, pressure, cpu);
}

}  // namespace

int main(int argc, char** argv) {
  int from = 0, to = 200, part = 0, parts = 1;
  std::string name = "robustness";
  double limit = 900.0;
  for (int k = 1; k + 1 < argc; k += 2) {
    const std::string option = argv[k], value = argv[k + 1];
    if (option == "--from") from = std::stoi(value);
    if (option == "--to") to = std::stoi(value);
    if (option == "--file") name = value;
    if (option == "--limit") limit = std::stod(value);
    if (option == "--part") {
      part = std::stoi(value);
      parts = std::stoi(value.substr(value.find('/') + 1));
    }
  }
  const tbb::global_control one_thread(tbb::global_control::max_allowed_parallelism, 1);

  std::set<std::string> done;
  if (std::filesystem::exists(path_of(name)))
    for (const CsvRow& row : read_csv(path_of(name)).rows) done.insert(row.cells.front());
  const mesoscale::FabricProperties fabric = mesoscale::analyse(mesoscale::CellSpec{}).fabric;
  for (int number = from; number < to; ++number) {
    if (number % parts != part || done.contains(std::to_string(number))) continue;
    const test::RandomStamping c = test::random_stamping(number, fabric);
    test::RobustnessVerdict verdict;
    const std::clock_t begin = std::clock();
    const auto over = [&] { return static_cast<double>(std::clock() - begin) / CLOCKS_PER_SEC > limit; };
    const benchmark::Time time = benchmark::time_of([&] { verdict = test::run(c, over); });
    const std::string row = row_of(number, c, verdict, time.cpu);
    fmt::print("{}\n", row);
    std::fflush(stdout);
    if (!benchmark::append_row(name, header, row)) return 1;
  }
  summarise(name);
}
