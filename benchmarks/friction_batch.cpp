// Friction points a second on one core, beside a bare std::pow loop in the same run. CPU time of this thread,
// so a busy machine does not count. Prints; judges nothing.
#include <fmt/format.h>
#include <time.h>

#include <algorithm>
#include <cmath>
#include <cstdlib>
#include <filesystem>
#include <fstream>
#include <new>
#include <random>
#include <vector>

#include "friction/model.h"

namespace {
long allocations = 0;
}

void* operator new(std::size_t size) {
  ++allocations;
  if (void* memory = std::malloc(size)) return memory;
  throw std::bad_alloc();
}
void operator delete(void* memory) noexcept {
  std::free(memory);
}
void operator delete(void* memory, std::size_t) noexcept {
  std::free(memory);
}

namespace {

using namespace heddle::friction;

constexpr std::size_t points = 4096;  // about what stays in the second-level cache
constexpr int repetitions = 15, batches = 60;

double cpu_seconds() {
  timespec now{};
  clock_gettime(CLOCK_THREAD_CPUTIME_ID, &now);
  return static_cast<double>(now.tv_sec) + 1e-9 * static_cast<double>(now.tv_nsec);
}

/// Best of the repetitions [million points/s].
template <class Batch>
double rate(const Batch& batch) {
  double best = 0.0;
  for (int r = 0; r < repetitions; ++r) {
    const double start = cpu_seconds();
    for (int b = 0; b < batches; ++b) batch();
    best = std::max(best, 1e-6 * static_cast<double>(points) * batches / (cpu_seconds() - start));
  }
  return best;
}

}  // namespace

int main() {
  std::mt19937 generator(3);
  std::uniform_real_distribution<double> share(0.0, 1.0);
  std::vector<Context> contexts(points);
  for (Context& context : contexts) {
    context.slip_speed = 1e-3 + 0.3 * share(generator);
    context.pressure = 5e3 + 4e5 * share(generator);
    context.tool_temperature = 294.0 + 119.0 * share(generator);
    context.fabric_temperature = 433.0 + 40.0 * share(generator);
  }
  const std::vector<ContactState> states(points);
  std::vector<Friction> out(points);
  std::vector<double> powers(points);

  Effects shift;
  shift.tool_temperature_shift = ToolTemperatureShift{.slope = -9.27e-4};
  Effects peak = shift;
  peak.static_peak = StaticPeak{.amplitude = 0.3};
  struct Row {
    const char* name;
    Model model;
  };
  const CalibrationBox box{.hersey_low = 0.02, .hersey_high = 2.0};
  const std::vector<Row> rows{
      {"coulomb", {.law = Coulomb{}, .film = {}, .effects = {}, .box = {}}},
      {"power + shift", {.law = HerseyPower{0.325, 0.136}, .film = {}, .effects = shift, .box = box}},
      {"three_branch + shift", {.law = StribeckCurve{}, .film = {}, .effects = shift, .box = box}},
      {"power + shift + static_peak",
       {.law = HerseyPower{0.325, 0.136}, .film = {}, .effects = peak, .box = box}}};

  const double bare = rate([&] {
    for (std::size_t i = 0; i < points; ++i)
      powers[i] = std::pow(contexts[i].slip_speed, 1e-6 * contexts[i].pressure);
  });
  fmt::print("{:<30}{:>8.1f} M/s\n", "std::pow", bare);
  const std::filesystem::path results = HEDDLE_SOURCE_DIR "/benchmarks/results/friction_batch.csv";
  std::filesystem::create_directories(results.parent_path());
  const bool fresh = !std::filesystem::exists(results);
  std::ofstream file(results, std::ios::app);
  if (fresh) file << "model,points_M_s,pow_M_s,ratio,allocations\n";
  for (const Row& row : rows) {
    const auto batch = [&] { evaluate(row.model, contexts, states, out); };
    const long before = allocations;
    batch();
    const long allocated = allocations - before;
    const double found = rate(batch);
    fmt::print("{:<30}{:>8.1f} M/s  {:>5.2f} of std::pow, {} allocations a batch\n", row.name, found,
               found / bare, allocated);
    file << fmt::format("{},{:.2f},{:.2f},{:.3f},{}\n", row.name, found, bare, found / bare, allocated);
  }
  // What came out is used, so nothing of it can be left out.
  double sum = 0.0;
  for (std::size_t i = 0; i < points; ++i) sum += out[i].mu + powers[i];
  return std::isfinite(sum) ? 0 : 1;
}
