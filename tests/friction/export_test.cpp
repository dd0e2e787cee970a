#include <dlfcn.h>
#include <unistd.h>

#include <array>
#include <catch2/catch.hpp>
#include <cmath>
#include <cstdlib>
#include <filesystem>
#include <fstream>
#include <memory>
#include <random>
#include <set>
#include <sstream>

#include "friction/combinations.h"
#include "friction/export/fortran_text.h"
#include "friction/export/fric_coef.h"
#include "friction/export/law_table.h"
#include "tests/friction/every_model.h"

using namespace heddle;
using namespace heddle::friction;
namespace fs = std::filesystem;

namespace {

bool have_gfortran() {
  return std::system("command -v gfortran >/dev/null 2>&1") == 0;
}

/// The interface of Abaqus as a compiler of Fortran passes it: all by reference, lengths of texts last.
using FricCoef = void (*)(double*, double*, const int*, const int*, const int*, const int*, const int*,
                          const double*, const char*, const char*, const char*, const double*, const double*,
                          const double*, const double*, const double*, std::size_t, std::size_t, std::size_t);

/// An exported routine, compiled and loaded.
class Compiled {
 public:
  explicit Compiled(const std::string& text) : folder_(make_folder()) {
    std::ofstream(folder_ / "friction.f") << text;
    // What Abaqus calls by this name says the same of double precision.
    std::ofstream(folder_ / "aba_param.inc")
        << "      implicit real*8(a-h,o-z)\n      parameter (nprecd=2)\n";
    const std::string command = "cd '" + folder_.string() +
                                "' && gfortran -O1 -shared -fPIC -Wline-truncation -Werror=line-truncation "
                                "-o friction.so friction.f 2>log.txt";
    if (std::system(command.c_str()) != 0) {
      std::ifstream log(folder_ / "log.txt");
      std::stringstream words;
      words << log.rdbuf();
      FAIL(words.str());
    }
    library_ = dlopen((folder_ / "friction.so").c_str(), RTLD_NOW | RTLD_LOCAL);
    REQUIRE(library_ != nullptr);
    routine_ = reinterpret_cast<FricCoef>(dlsym(library_, "fric_coef_"));
    REQUIRE(routine_ != nullptr);
  }
  ~Compiled() {
    if (library_ != nullptr) dlclose(library_);
    std::error_code ignored;  // a folder that stays behind is no failure of the test
    fs::remove_all(folder_, ignored);
  }
  Compiled(const Compiled&) = delete;
  Compiled& operator=(const Compiled&) = delete;

  struct Points {
    std::vector<double> mu,
        slopes;  ///< slopes: all to the slip rate, all to the pressure, all to the temperature
  };
  Points run(const std::array<double, 5>& properties, const std::vector<double>& rate,
             const std::vector<double>& pressure, const std::vector<double>& temperature) const {
    const int count = static_cast<int>(rate.size()), properties_count = 5, fields = 0;
    const int with_temperature = temperature.empty() ? 0 : 1;
    const std::vector<int> flags(3, 1);
    const std::vector<double> data(3, 0.0), field(1, 0.0);
    const std::string name(80, ' ');
    Points out{std::vector<double>(rate.size()), std::vector<double>(3 * rate.size())};
    routine_(out.mu.data(), out.slopes.data(), &count, &properties_count, &with_temperature, &fields,
             flags.data(), data.data(), name.data(), name.data(), name.data(), properties.data(), rate.data(),
             pressure.data(), temperature.empty() ? field.data() : temperature.data(), field.data(), 80, 80,
             80);
    return out;
  }

 private:
  static fs::path make_folder() {
    static int number = 0;
    const fs::path folder = fs::temp_directory_path() /
                            ("heddle-export-" + std::to_string(getpid()) + "-" + std::to_string(++number));
    fs::create_directories(folder);
    return folder;
  }
  fs::path folder_;
  void* library_ = nullptr;
  FricCoef routine_ = nullptr;
};

/// Largest difference of two numbers as a share of the larger, where one is more than `nothing`.
double gap(double a, double b, double nothing) {
  return std::abs(a - b) / std::max({std::abs(a), std::abs(b), nothing});
}

struct Gaps {
  double mu = 0.0, speed = 0.0, pressure = 0.0, temperature = 0.0;
};

/// The routine against the law at random states: the campaign's range and beyond, at rest and without load
/// too. The tool is held at one temperature, as the routine has it.
Gaps gaps(const ExportedLaw& law, const Compiled& routine, std::size_t count) {
  std::mt19937 generator(7);
  std::uniform_real_distribution<double> share(0.0, 1.0);
  const double tool = 371.25;
  std::vector<double> rate, pressure, temperature;
  for (std::size_t i = 0; i < count; ++i) {
    rate.push_back(i % 100 == 0 ? 0.0 : std::pow(10.0, -5.0 + 5.0 * share(generator)));
    pressure.push_back(i % 100 == 50 ? 0.0 : std::pow(10.0, 1.0 + 5.5 * share(generator)));
    temperature.push_back(0.5 * (tool + 430.0 + 50.0 * share(generator)));
  }
  const Compiled::Points out = routine.run({1.0, 1.0, 0.0, tool, 453.15}, rate, pressure, temperature);
  Gaps worst;
  for (std::size_t i = 0; i < count; ++i) {
    const Friction f = evaluate_unchecked(
        law.model, context_of(law, rate[i], pressure[i], 2.0 * temperature[i] - tool, tool), {});
    worst.mu = std::max(worst.mu, gap(out.mu[i], f.mu, 1e-3));
    // Slopes in changes of mu per e-fold of speed and load, and per kelvin.
    const double u = std::max(rate[i], 1e-4), p = std::max(pressure[i], 1.0);
    worst.speed = std::max(worst.speed, gap(out.slopes[i] * u, f.dmu_dspeed * u, 1e-3));
    worst.pressure = std::max(worst.pressure, gap(out.slopes[count + i] * p, f.dmu_dpressure * p, 1e-3));
    worst.temperature =
        std::max(worst.temperature, gap(out.slopes[2 * count + i], 2.0 * f.dmu_dfabric_temperature, 1e-5));
  }
  return worst;
}

void check_alike(const ExportedLaw& law, std::size_t count = 10000) {
  const Compiled routine(fric_coef_fortran(law));
  const Gaps found = gaps(law, routine, count);
  CHECK(found.mu < 1e-12);
  CHECK(found.speed < 1e-12);
  CHECK(found.pressure < 1e-12);
  CHECK(found.temperature < 1e-11);  // a difference of kelvins of 450 K
}

ExportedLaw exported(const Law& law, const Rheology& rheology = {}) {
  return {.name = "test",
          .model = {.law = law,
                    .film = {},
                    .effects = {},
                    .box = {.hersey_low = 0.05, .hersey_high = 1.0},
                    .rheology = rheology}};
}

bool can_be_exported(const Law& law) {
  return check_export(exported(law).model).empty();
}

#define NEEDS_GFORTRAN                                                        \
  if (!have_gfortran()) {                                                     \
    WARN("gfortran is not installed: the exported routine was not compiled"); \
    return;                                                                   \
  }

}  // namespace

TEST_CASE("the Abaqus routine of every law without memory is the law and its slopes over ten thousand states",
          "[friction][export]") {
  NEEDS_GFORTRAN
  int laws = 0;
  for (const Law& law : heddle::test::every_law()) {
    if (!can_be_exported(law)) continue;
    CAPTURE(id_of(law));
    check_alike(exported(law));
    ++laws;
  }
  CHECK(laws == 9);
}

TEST_CASE("the Abaqus routine holds every rheology and every effect without memory", "[friction][export]") {
  NEEDS_GFORTRAN
  for (const Rheology& rheology : heddle::test::every_rheology()) {
    ExportedLaw law = exported(HerseyPower{.scale = 0.325, .exponent = 0.136}, rheology);
    // As many effects as stand beside each other and leave mu positive: a shift as a factor.
    for (const auto& effect : heddle::test::every_effect()) {
      ExportedLaw with = law;
      effect.set(with.model.effects, effect.usual);
      if (effect.id == "tool_temperature_film") with.model.effects.tool_temperature_film->settling = 0.0;
      if (effect.id == "tool_temperature_shift")
        with.model.effects.tool_temperature_shift->form = ToolTemperatureShift::Form::factor;
      if (check_export(with.model).empty() && check_combinations(with.model).empty()) law = with;
    }
    CAPTURE(rheology.flow.index(), rheology.temperature.index());
    CHECK(is_on(law.model.effects.shear_heating));
    check_alike(law, 2000);
  }
  ExportedLaw term = exported(HerseyPower{.scale = 0.325, .exponent = 0.136});
  term.model.effects.tool_temperature_shift = ToolTemperatureShift{.slope = -9e-4};
  check_alike(term, 2000);
}

TEST_CASE("the Abaqus routine reads the contact area of a weave from its curve", "[friction][export]") {
  NEEDS_GFORTRAN
  ExportedLaw law = exported(HerseyPower{.scale = 0.325, .exponent = 0.136});
  // Rises to the whole plate at 1.8 MPa, beyond which it stays.
  law.log_area = Curve({2.3, 6.9, 9.2, 11.5, 12.7, 13.8}, {-4.0, -2.5, -1.6, -0.9, -0.5, -0.2});
  check_alike(law);
}

TEST_CASE("the Abaqus routine gives the same mu in millimetres, megapascals and degrees",
          "[friction][export][invariant]") {
  NEEDS_GFORTRAN
  ExportedLaw law = exported(HerseyPower{.scale = 0.325, .exponent = 0.136});
  law.model.effects.tool_temperature_shift = ToolTemperatureShift{.slope = -9e-4};
  const Compiled routine(fric_coef_fortran(law));
  const auto si = routine.run({1.0, 1.0, 0.0, 358.15, 453.15}, {16.67e-3}, {150e3}, {});
  const auto mm = routine.run({1e-3, 1e6, 273.15, 85.0, 180.0}, {16.67}, {0.15}, {});
  const auto warm = routine.run({1e-3, 1e6, 273.15, 85.0, -1e3}, {16.67}, {0.15}, {132.5});
  CHECK(mm.mu[0] == Approx(si.mu[0]).epsilon(1e-13));
  CHECK(warm.mu[0] == Approx(si.mu[0]).epsilon(1e-13));
  CHECK(mm.slopes[0] == Approx(1e-3 * si.slopes[0]).epsilon(1e-12));
  CHECK(mm.slopes[1] == Approx(1e6 * si.slopes[1]).epsilon(1e-12));
  CHECK(mm.slopes[2] == 0.0);  // a model without temperature
  CHECK(warm.slopes[2] < 0.0);
}

TEST_CASE("a routine of another law is told apart: the comparison can fail", "[friction][export]") {
  NEEDS_GFORTRAN
  const ExportedLaw law = exported(HerseyPower{.scale = 0.325, .exponent = 0.136});
  ExportedLaw other = law;
  std::get<HerseyPower>(other.model.law).exponent *= 1.0 + 1e-9;
  const Gaps found = gaps(law, Compiled(fric_coef_fortran(other)), 1000);
  CHECK(found.mu > 1e-11);
  CHECK(found.speed > 1e-11);
}

TEST_CASE("laws with a memory or a direction are refused with the reason, all at once",
          "[friction][export][wrong input]") {
  Model model = exported(StaticKinetic{}).model;
  model.effects.orientation = Orientation{.amplitude = 0.1};
  model.effects.wear = Wear{.amplitude = 0.2};
  std::vector<std::string> ids, keys;
  for (const Problem& problem : check_export(model)) {
    ids.push_back(problem.id.text());
    keys.push_back(problem.key);
    CHECK_FALSE(problem.way_out.empty());
  }
  CHECK(ids == std::vector<std::string>{"export.memory", "export.memory", "export.direction"});
  CHECK(keys == std::vector<std::string>{"friction.law", "effects.wear", "effects.orientation"});
  Model heated = exported(HerseyPower{.scale = 0.325, .exponent = 0.136}).model;
  heated.effects.tool_temperature_film = ToolTemperatureFilm{.weight = 0.9};
  CHECK(check_export(heated).empty());
  heated.conduction = film_conduction({}, heated.film.thickness);  // takes its time
  REQUIRE(check_export(heated).size() == 1);
  CHECK(check_export(heated)[0].key == "friction.film_temperature");
  CHECK_THROWS_AS(fric_coef_fortran({.name = "x", .model = model}), InputError);
  CHECK_THROWS_AS(law_table({.name = "x", .model = model}), InputError);
  // Every effect is either in the routine or refused: has_memory and the refusals agree.
  for (const auto& effect : heddle::test::every_effect()) {
    Model one = exported(HerseyPower{.scale = 0.325, .exponent = 0.136}).model;
    effect.set(one.effects, effect.usual);
    CAPTURE(effect.id);
    CHECK(check_export(one).empty() == (!has_memory(one) && effect.id != "orientation"));
  }
}

TEST_CASE("numbers are written into Fortran bit for bit", "[friction][export]") {
  CHECK(fortran_number(0.325) == "0.325D0");
  CHECK(fortran_number(6790.0) == "6790D0");
  CHECK(fortran_number(-9.27e-4) == "(-0.000927D0)");
  CHECK(fortran_number(1e-13) == "1D-13");
}

TEST_CASE("the table of the law is the law at its points, and says how far a linear interpolation is off",
          "[friction][export]") {
  ExportedLaw law = exported(HerseyPower{.scale = 0.325, .exponent = 0.136});
  law.model.effects.tool_temperature_shift = ToolTemperatureShift{.slope = -9e-4};
  const LawTable table = law_table(law);
  CHECK(table.mu.size() == 25 * 33 * 7 * 3);
  CHECK(table.mu.front() == evaluate(law.model, context_of(law, 1e-4, 1e3, 433.15, 293.15), {}).mu);
  // mu = C Hs^s over cells of a decade / 8: the chord of an exponential lies (s ln 10/8)^2/8 above its
  // middle, each for load and for speed, and Arrhenius adds its own.
  CHECK(table.middle_error > 1e-4);
  CHECK(table.middle_error < 3e-3);
  LawTable fine = usual_grid();
  for (auto* axis : {&fine.pressures, &fine.speeds}) {
    std::vector<double> halved;
    for (std::size_t k = 0; k + 1 < axis->size(); ++k) {
      halved.push_back((*axis)[k]);
      halved.push_back(std::sqrt((*axis)[k] * (*axis)[k + 1]));
    }
    *axis = halved;
  }
  fine.fabric_temperatures = {453.15};
  LawTable coarse = usual_grid();
  coarse.fabric_temperatures = {453.15};
  fine.tool_temperatures = coarse.tool_temperatures = {358.15};
  // Second order in the step.
  CHECK(law_table(law, coarse).middle_error / law_table(law, fine).middle_error == Approx(4.0).epsilon(0.1));
  const std::string csv = law_table_csv(table);
  CHECK(csv.starts_with(
      "pressure_Pa,slip_speed_mm_s,tool_temperature_C,fabric_temperature_C,friction_coefficient\n"
      "1000,0.1,20,160,"));
}
