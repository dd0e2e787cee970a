#include <catch2/catch.hpp>

#include <cmath>
#include <filesystem>
#include <numbers>

#include "core/text_file.h"
#include "pipeline/case.h"
#include "pipeline/discover/coordinates.h"
#include "pipeline/discover/discovery.h"
#include "pipeline/discover/random.h"
#include "pipeline/discover/stamping_campaign.h"
#include "pipeline/discover/stamping_surrogate.h"
#include "pipeline/discover_stamping.h"
#include "tests/source_dir.h"

using namespace heddle;
using namespace heddle::discover;

namespace {

const std::string header =
    "condition_id,sample_id,day_id,speed_scale,binder_force_N,tool_temperature_C,blank_temperature_C,"
    "orientation_deg,punch_displacement_mm,punch_force_N\n";

using Ids = std::vector<std::string>;

Ids problems_of(const std::string& text, std::string* words = nullptr) {
  try {
    parse_stampings(text, "x.csv", {});
  } catch (const InputError& error) {
    Ids ids;
    for (const Problem& problem : error.problems()) ids.push_back(problem.id.text());
    if (words != nullptr) *words = error.what();
    return ids;
  }
  return {};
}

/// A blank of five points, F = 4 N/mm of stroke.
std::string curve(const std::string& condition, const std::string& sample, const std::string& speed,
                  double gain = 1.0) {
  std::string text;
  for (const int depth : {5, 15, 25, 40, 50})
    text += condition + "," + sample + ",d1," + speed + ",650,85,180,0," + std::to_string(depth) + "," +
            std::to_string(4.0 * gain * depth) + "\n";
  return text;
}

/// A model of two numbers and three effects that costs nothing: what a press would show of them over speed
/// (0.5, 1, 2) and stroke. `bend` curves the second effect.
struct StandIn {
  double bend = 0.0;
  std::vector<double> speeds{0.5, 1.0, 2.0};
  std::vector<double> stroke{10, 14, 18, 22, 26, 30, 34, 38, 42, 46, 50};

  Eigen::VectorXd operator()(const Trial& trial) const {
    double rate = 0.0, mass = 1.0, grid = 0.0;
    for (const auto& [effect, values] : trial.effects)
      (effect == 0 ? rate : effect == 1 ? mass : grid) = values[0];
    Eigen::VectorXd values(std::ssize(speeds) * std::ssize(stroke));
    Eigen::Index at = 0;
    for (const double speed : speeds)
      for (const double s : stroke) {
        const double x = s / 50.0, m = mass - 1.0;
        values[at++] =
            std::log(3.3 * s) + 3.0 * x * (trial.baseline[0] - 0.3) +
            0.4 * (1.0 - x) * (trial.baseline[1] - 0.2) + rate * 0.1 * std::pow(speed, 0.38) * (1.2 - x) +
            1e-4 * speed * speed * (m + bend * m * m) * (1.1 - x) + grid * 0.06 * std::cos(5.0 * x);
      }
    return values;
  }
};

ForwardModel stand_in(double bend = 0.0) {
  ForwardModel model;
  model.baseline = {{.key = "friction.coefficient",
                     .unit = "",
                     .prior = {.kind = Prior::Kind::normal, .centre = 0.3, .scale = 0.05}},
                    {.key = "forming.tow_friction",
                     .unit = "",
                     .prior = {.kind = Prior::Kind::log_normal, .centre = 0.2, .scale = 1.5, .low = 0.0}}};
  const auto candidate = [&](const char* id, Kind kind, Prior prior) {
    model.candidates.push_back(
        {.id = id,
         .kind = kind,
         .numbers = {{.key = std::string("effects.") + id, .unit = "", .prior = prior}},
         .look_alikes = {},
         .form = "",
         .source = ""});
  };
  candidate("shear_rate", Kind::physics, {.kind = Prior::Kind::half_normal, .scale = 1.0, .low = 0.0});
  candidate("inertia", Kind::physics, {.kind = Prior::Kind::log_normal, .centre = 1.0, .scale = 10.0});
  candidate("discretisation", Kind::numerics, {.kind = Prior::Kind::half_normal, .scale = 1.0, .low = 0.0});
  model.predict = StandIn{.bend = bend};
  return model;
}

Trial trial_of(double mu, double tow_friction, std::vector<std::pair<std::size_t, double>> effects = {}) {
  Trial trial{.baseline = Eigen::Vector2d(mu, tow_friction), .effects = {}};
  for (const auto& [effect, amplitude] : effects)
    trial.effects.emplace_back(effect, Eigen::VectorXd::Constant(1, amplitude));
  return trial;
}

double worst(const Eigen::VectorXd& a, const Eigen::VectorXd& b) {
  return (a - b).cwiseAbs().maxCoeff();
}

/// Curves of the stand-in with scatter, as a table, through the reader to findings.
CouponFindings found_in(const Trial& truth, std::uint64_t seed) {
  const StandIn model;
  const Eigen::VectorXd values = model(truth);
  Random random(seed);
  std::string text = header;
  for (std::size_t c = 0; c < model.speeds.size(); ++c)
    for (int sample = 0; sample < 5; ++sample) {
      const double gain = 0.025 * random.normal();
      for (std::size_t k = 0; k < model.stroke.size(); ++k) {
        const double force = values[static_cast<Eigen::Index>(c * model.stroke.size() + k)];
        text += "V" + std::to_string(model.speeds[c]) + "," + std::to_string(10 * c + sample) + ",d1," +
                std::to_string(model.speeds[c]) + ",650,85,180,0," + std::to_string(model.stroke[k]) + "," +
                std::to_string(std::exp(force + gain + 0.01 * random.normal())) + "\n";
      }
    }
  const int bins = 10;
  const StampingData data = parse_stampings(text, "x.csv", {.bins = bins, .stroke = 0.05});
  // What the stand-in says of the bins: its values between the depths, as the reader cuts them.
  const auto binned = [data](const Eigen::VectorXd& all) {
    const StandIn shape;
    std::vector<double> depth, force;
    Eigen::VectorXd cut(bins * 3);
    for (const double s : shape.stroke) depth.push_back(1e-3 * s);
    for (Eigen::Index c = 0; c < 3; ++c) {
      force.clear();
      for (Eigen::Index k = 0; k < std::ssize(depth); ++k)
        force.push_back(std::exp(all[c * std::ssize(depth) + k]));
      const std::vector<double> means = bin_means(depth, force, data.edges);
      for (Eigen::Index k = 0; k < bins; ++k)
        cut[c * bins + k] = std::log(means[static_cast<std::size_t>(k)]);
    }
    return cut;
  };
  CouponFindings found;
  found.campaign = campaign_of(data.curves, bins);
  found.training = found.campaign.cells;
  CouponQuestion question;
  question.noise.day = 0.0;
  found.noise = noise_of(found.campaign, data.curves, question.noise, 1);
  ForwardModel dear = stand_in();
  dear.predict = [binned](const Trial& trial) { return binned(StandIn{}(trial)); };
  found.forward = affine_surrogate(dear).model;
  Observations observations;
  observations.value =
      of_points(found.training, [](const CouponCell&, const CouponPoint& point) { return point.log_force; });
  observations.covariance = covariance_of(found.noise, found.training, {});
  observations.coordinates = form_coordinates(found.training, question.noise.effect_form_length);
  judge(found, observations, question);
  return found;
}

}  // namespace

TEST_CASE("a bin of stroke holds the exact mean of a curve that is straight between its points",
          "[pipeline][discover]") {
  const std::vector<double> stroke{0.0, 0.01, 0.03}, force{0.0, 10.0, 20.0};
  const std::vector<double> means = bin_means(stroke, force, {0.0, 0.01, 0.02, 0.03});
  CHECK(means[0] == Approx(5.0));
  CHECK(means[1] == Approx(12.5));
  CHECK(means[2] == Approx(17.5));
  const std::vector<double> across = bin_means(stroke, force, {0.005, 0.02, 0.04});
  CHECK(across[0] == Approx((7.5 * 0.005 + 12.5 * 0.01) / 0.015));
  CHECK(std::isnan(across[1]));
}

TEST_CASE("a table of stampings becomes curves over bins of stroke that all blanks share",
          "[pipeline][discover]") {
  const StampingData data = parse_stampings(
      header + curve("slow", "a", "0.5") + curve("slow", "b", "0.5", 1.02) + curve("fast", "c", "2", 1.1),
      "x.csv", {.bins = 4, .start = 0.2, .stroke = 0.045, .punch_speed = 0.16});
  REQUIRE(data.edges.size() == 5);
  CHECK(data.edges.front() == Approx(0.009));
  CHECK(data.edges.back() == Approx(0.045));
  REQUIRE(data.curves.rows.size() == 12);
  CHECK(data.conditions.size() == 2);
  CHECK(data.conditions[1].speed_scale == 2.0);
  CHECK(data.curves.rows[8].pull.velocity == Approx(0.32));
  CHECK(data.curves.rows[8].pull.normal_force == 650.0);
  CHECK(data.curves.rows[8].pull.fabric_temperature == Approx(453.15));
  // The force is linear in stroke, so the mean of a bin is the force of its middle.
  CHECK(*data.curves.rows[8].pull.measured_force == Approx(4.4 * 1e3 * *data.curves.rows[8].slip));
  CHECK(is_stamping_table(header));
  CHECK_FALSE(is_stamping_table("velocity_mm_s,pull_force_N\n"));
}

TEST_CASE("a table of stampings is refused with every problem and its line",
          "[pipeline][discover][wrong input]") {
  const std::string slow = curve("slow", "a", "0.5"), fast = curve("fast", "b", "2");
  std::string words;
  CHECK(problems_of("condition_id,sample_id,speed,punch_force_N\na,b,1,2\n", &words) ==
        Ids{"discover.stampings.column.unknown", "discover.stampings.column.missing",
            "discover.stampings.column.missing", "discover.stampings.column.missing",
            "discover.stampings.column.missing", "discover.stampings.column.missing"});
  CHECK(words.find("punch_displacement_mm") != std::string::npos);
  CHECK(problems_of("sample_id," + header + "a,slow,a,d1,1,650,85,180,0,5,20\n") ==
        Ids{"discover.stampings.column.twice"});
  CHECK(problems_of(header) == Ids{"discover.stampings.empty"});
  CHECK(problems_of(header + "slow,a,d1,1,650,warm,180,0,5,nan\n") ==
        Ids{"discover.stampings.number", "discover.stampings.number"});
  CHECK(problems_of(header + slow + fast + "slow,a,d1,0.5,0,85,180,0,60,300\n") ==
        Ids{"discover.stampings.positive", "discover.stampings.condition"});
  CHECK(problems_of(header + slow + fast + "slow,a,d1,0.5,650,85,453,0,60,300\n") ==
        Ids{"discover.stampings.unit.temperature", "discover.stampings.condition"});
  CHECK(problems_of(header + slow + fast + slow) == Ids{"discover.stampings.curve"});
  CHECK(problems_of(header + slow + fast + "fast,c,d1,2,650,85,180,0,5,20\n", &words) ==
        Ids{"discover.stampings.short"});
  CHECK(words.find("four points") != std::string::npos);
  CHECK(problems_of(header + slow) == Ids{"discover.stampings.alike"});
  std::string metres = header, kilonewtons = header;
  for (const char* condition : {"slow,a,d1,0.5", "fast,b,d1,2"})
    for (int k = 1; k < 6; ++k) {
      const std::string set = std::string(condition) + ",650,85,180,0,";
      metres += set + "0.0" + std::to_string(k) + "," + std::to_string(40 * k) + "\n";
      kilonewtons += set + std::to_string(10 * k) + ",0.0" + std::to_string(4 * k) + "\n";
    }
  CHECK(problems_of(metres, &words) == Ids{"discover.stampings.unit.stroke"});
  CHECK(words.find("metres") != std::string::npos);
  CHECK(problems_of(kilonewtons, &words) == Ids{"discover.stampings.unit.force"});
  CHECK(words.find("kN") != std::string::npos);
  CHECK(problems_of(header + slow + curve("fast", "b", "2", -1.0)) == Ids{"discover.stampings.force"});
  std::string late = header + slow;
  for (int depth = 60; depth < 65; ++depth)
    late += "fast,b,d1,2,650,85,180,0," + std::to_string(depth) + ",200\n";
  CHECK(problems_of(late) == Ids{"discover.stampings.overlap"});
}

TEST_CASE("stampings are held out between the others and never below three conditions",
          "[pipeline][discover]") {
  std::string text = header;
  for (const char* speed : {"0.5", "0.7", "1", "1.4", "2"})
    text += curve(speed, std::string("s") + speed, speed);
  const StampingData data = parse_stampings(text, "x.csv", {});
  const CouponCampaign campaign = campaign_of(data.curves, 12);
  for (std::uint64_t seed = 1; seed < 20; ++seed) {
    const Split split = split_stampings(campaign, 0.4, seed);
    REQUIRE(split.held_out.size() == 2);
    for (const std::size_t cell : split.held_out) {
      CHECK(campaign.cells[cell].pull.velocity > 0.09);
      CHECK(campaign.cells[cell].pull.velocity < 0.3);
    }
    CHECK(split_stampings(campaign, 0.9, seed).training.size() == 3);
    CHECK(split_stampings(campaign, 0.0, seed).held_out.empty());
  }
}

TEST_CASE("the affine model of an affine world is that world, near and far", "[pipeline][discover]") {
  const ForwardModel dear = stand_in();
  const Surrogate surrogate = affine_surrogate(dear);
  REQUIRE(surrogate.model.candidates.size() == 3);
  for (const SlopeCheck& check : surrogate.checks) {
    CAPTURE(check.key);
    CHECK(check.refused.empty());
    CHECK(check.disagreement < 1e-9);
  }
  // Mass shows only far from its off value: the step grows until it does.
  CHECK(surrogate.checks[3].step == Approx(99.0));
  const Trial far = trial_of(0.45, 0.31, {{0, 2.7}, {1, 800.0}, {2, 1.4}});
  CHECK(worst(surrogate.model.predict(far), dear.predict(far)) < 1e-9);
  CHECK(true_run(dear, surrogate, far).share() < 1e-9);
}

TEST_CASE("a slope that two step sizes do not agree on within a tenth is refused in words",
          "[pipeline][discover]") {
  // With a bend b the slopes at m and m/2 are 1 + b m and 1 + b m/2 of the true one.
  const auto disagreement = [](double b, double m) { return (0.5 * b * m) / (1.0 + 0.5 * b * m); };
  for (const double bend : {1e-3, 4e-3}) {
    const Surrogate surrogate = affine_surrogate(stand_in(bend));
    const SlopeCheck& inertia = surrogate.checks[3];
    CHECK(inertia.disagreement == Approx(disagreement(bend, inertia.step)).epsilon(1e-6));
    const bool kept = inertia.disagreement <= 0.1;
    CHECK(kept == (bend == 1e-3));
    // Refused, it stays a rival at the values that were run: three steps and their halves, less what is
    // unseen.
    CHECK(inertia.values == (kept ? 0 : 4));
    CHECK(surrogate.model.candidates.size() == (kept ? 3u : 6u));
    for (std::size_t c = 1; !kept && c < 5; ++c) {
      const double value = surrogate.model.candidates[c].numbers[0].prior.centre;
      const Trial there = trial_of(0.3, 0.2, {{c, value}});
      CHECK(worst(surrogate.model.predict(there), stand_in(bend).predict(surrogate.for_dear(there))) < 1e-9);
      CHECK(surrogate.model.candidates[c].log_weight == Approx(-std::log(4.0)));
    }
    CHECK((inertia.refused.find("differ by") != std::string::npos) == !kept);
    // The one after it in the list keeps its own name and slope.
    const Trial grid = trial_of(0.3, 0.2, {{surrogate.model.candidates.size() - 1, 1.0}});
    CHECK(worst(surrogate.model.predict(grid), stand_in(bend).predict(surrogate.for_dear(grid))) < 1e-9);
  }
}

TEST_CASE("a step grows past a jump near the off value until half of it says the same slope",
          "[pipeline][discover]") {
  ForwardModel dear = stand_in();
  dear.predict = [](const Trial& trial) {
    Eigen::VectorXd values = StandIn{}(trial);
    for (const auto& [effect, amplitude] : trial.effects)
      if (effect == 1 && amplitude[0] > 1.0 && amplitude[0] < 20.0) values.array() += 0.05;
    return values;
  };
  const Surrogate surrogate = affine_surrogate(dear);
  CHECK(surrogate.checks[3].refused.empty());
  CHECK(surrogate.checks[3].step == Approx(99.0));
  CHECK(surrogate.checks[3].disagreement < 1e-9);
}

TEST_CASE("an effect that moves nothing, or has no prediction, is not searched for", "[pipeline][discover]") {
  ForwardModel dear = stand_in();
  dear.predict = [](const Trial& trial) {
    Trial known = trial;
    for (auto& [effect, values] : known.effects) {
      if (effect == 1) values[0] = 1.0;
      if (effect == 2) return Eigen::VectorXd(Eigen::VectorXd::Constant(33, std::nan("")));
    }
    return StandIn{}(known);
  };
  const Surrogate surrogate = affine_surrogate(dear);
  REQUIRE(surrogate.model.candidates.size() == 1);
  CHECK(surrogate.checks[3].refused.find("not to be seen") != std::string::npos);
  CHECK(surrogate.checks[4].refused.find("no prediction") != std::string::npos);
  dear.candidates[0].numbers.push_back(dear.candidates[0].numbers.front());
  CHECK_THROWS_AS(affine_surrogate(dear), std::logic_error);
}

TEST_CASE("an affine model taken anew is exact where it was taken and knows the slopes there",
          "[pipeline][discover]") {
  const ForwardModel dear = stand_in(4e-4);
  const Surrogate surrogate = affine_surrogate(dear);
  const Trial at = trial_of(0.33, 0.25, {{1, 700.0}});
  const TrueRun run = true_run(dear, surrogate, at);
  CHECK(run.share() > 0.1);
  const ForwardModel anew = relinearised(dear, surrogate, at, run);
  CHECK(worst(anew.predict(at), dear.predict(at)) < 1e-12);
  const Trial near = trial_of(0.33, 0.25, {{1, 705.0}});
  const double moved = worst(dear.predict(near), dear.predict(at));
  CHECK(worst(anew.predict(near), dear.predict(near)) < 0.03 * moved);
  CHECK(worst(surrogate.model.predict(near) - surrogate.model.predict(at),
              dear.predict(near) - dear.predict(at)) > 0.1 * moved);
}

TEST_CASE("a hidden rate of shear is among the names given, and nothing hidden is no gap",
          "[pipeline][discover]") {
  const CouponFindings rate = found_in(trial_of(0.28, 0.24, {{0, 2.0}}), 7);
  CAPTURE(in_words(rate.decision.answer));
  CHECK((rate.decision.answer == Answer::named || rate.decision.answer == Answer::one_of));
  CHECK(std::ranges::count(rate.decision.candidate_set, "shear_rate") == 1);
  const CouponFindings none = found_in(trial_of(0.28, 0.24), 8);
  CHECK(none.decision.answer == Answer::no_gap);
  // A grid that errs is never physics.
  const CouponFindings grid = found_in(trial_of(0.28, 0.24, {{2, 1.5}}), 9);
  CHECK(std::ranges::count(grid.decision.candidate_set, "shear_rate") == 0);
  CHECK(std::ranges::count(grid.decision.candidate_set, "inertia") == 0);
}

TEST_CASE("the library of a stamping holds what its law admits and says what it leaves out",
          "[pipeline][discover]") {
  const std::filesystem::path file =
      std::filesystem::path(test::source_dir) / "configs/discover/stamping.yaml";
  const pipeline::Case a_case = pipeline::read_case(file);
  const pipeline::StampingLibrary library = pipeline::stamping_library(a_case, built_in_effects());
  REQUIRE(library.baseline.size() == 2);
  CHECK(library.baseline[0].key == "friction.coefficient");
  CHECK(library.baseline[1].key == "forming.tow_friction");
  double weight = 0.0;
  for (const Candidate& candidate : library.candidates)
    if (candidate.id == "stick_slip") weight += std::exp(candidate.log_weight);
  CHECK(weight == Approx(1.0));
  for (const char* id : {"shear_rate", "press_compliance", "inertia", "discretisation"})
    CHECK(std::ranges::count(library.candidates, id, &Candidate::id) == 1);
  const auto refused = [&](const std::string& id) {
    return std::ranges::any_of(library.refused, [&](const auto& one) { return one.first == id; });
  };
  CHECK(refused("boundary_lubrication"));  // no Hersey number in a Coulomb law
  CHECK(refused("gain_drift"));
  CHECK(refused("binder_tilt"));  // no force tells its sign
  // The keys of a trial read back to the numbers of the trial, bit for bit.
  const ForwardModel forward{.baseline = library.baseline, .candidates = library.candidates, .predict = {}};
  const auto at =
      std::ranges::find(library.candidates, "shear_rate", &Candidate::id) - library.candidates.begin();
  const Trial trial = trial_of(0.1 + 0.2, 0.2 / 3.0, {{static_cast<std::size_t>(at), 1.0 / 3.0}});
  std::vector<std::string> keys = pipeline::keys_of(forward, trial);
  const std::vector<std::string> set = pipeline::keys_of(
      StampingCondition{"fast", 1.4, 650.0, 358.15, 453.15, 10.0 * std::numbers::pi / 180.0});
  keys.insert(keys.end(), set.begin(), set.end());
  keys.emplace_back("blank.symmetry=none");  // the condition turns the blank
  const pipeline::Case moved = pipeline::read_case(file, keys);
  CHECK(std::get<friction::Coulomb>(moved.friction->model.law).coefficient == 0.1 + 0.2);
  CHECK(moved.stamping->shear_rate == 1.0 / 3.0);
  CHECK(moved.stamping->process.speed_scale == 1.4);
  CHECK(moved.stamping->process.blank_temperature == 453.15);
}

TEST_CASE("a case that cannot be asked about stampings is refused with the reason",
          "[pipeline][discover][wrong input]") {
  const std::filesystem::path configs = std::filesystem::path(test::source_dir) / "configs";
  const auto ids_of = [](const auto& ask) {
    Ids ids;
    try {
      ask();
    } catch (const InputError& error) {
      for (const Problem& problem : error.problems()) ids.push_back(problem.id.text());
    }
    return ids;
  };
  CHECK(ids_of([&] {
          pipeline::stamping_library(pipeline::read_case(configs / "thermostamping.yaml"), {});
        }) == Ids{"discover.stampings.calibrated"});
  pipeline::Case a_case = pipeline::read_case(configs / "discover/stamping.yaml");
  a_case.discover->numbers = {"friction.scale"};
  CHECK(ids_of([&] { pipeline::stamping_library(a_case, {}); }) == Ids{"discover.stampings.parameters"});
  pipeline::DiscoverOptions options;
  options.run.file = configs / "discover/friction.yaml";
  options.data = configs / "data/stamping_force.csv";
  CHECK(ids_of([&] { pipeline::discover_stamping(options); }) == Ids{"discover.stampings.case"});
}
