// The page that tells a person what discovery found: its numbers in closed form, and the page of every
// answer.
#include "pipeline/discover_report.h"

#include <fmt/format.h>

#include <catch2/catch.hpp>
#include <cmath>
#include <string>

#include "friction/calibration/coupon_data.h"
#include "pipeline/discover/random.h"
#include "pipeline/discover_report_gap.h"
#include "pipeline/discover_report_pictures.h"
#include "tests/source_dir.h"

using namespace heddle;
using Catch::Matchers::Contains;
using discover::Answer;
namespace fs = std::filesystem;

namespace {

const fs::path source = heddle::test::source_dir;

discover::CouponCell cell_at(double velocity, double load, std::size_t condition, std::size_t day,
                             int samples, int stretches) {
  discover::CouponCell cell;
  cell.pull.velocity = velocity;
  cell.pull.normal_force = load;
  cell.condition = condition;
  cell.day = day;
  cell.samples = samples;
  for (int k = 0; k < stretches; ++k)
    cell.points.push_back(
        {.stretch = k, .steady = false, .slip = 1e-3 * (k + 1.0), .normal_force = load, .log_force = 0.0});
  return cell;
}

/// Findings of which only cells, noise and a model that predicts ln F = 0 are there.
discover::CouponFindings flat_findings(std::vector<discover::CouponCell> cells, int stretches, double sample,
                                       double day) {
  discover::CouponFindings findings;
  findings.training = cells;
  findings.campaign.cells = cells;
  findings.campaign.stretches = stretches;
  findings.noise.sample = Eigen::MatrixXd::Constant(stretches, stretches, sample * sample);
  findings.noise.day = day;
  const Eigen::Index points = std::ssize(cells) * stretches;
  findings.forward.predict = [points](const discover::Trial&) -> Eigen::VectorXd {
    return Eigen::VectorXd::Zero(points);
  };
  return findings;
}

constexpr auto every = [](std::size_t) { return true; };

/// The shipped case on the four forces of Table 4, once for all tests.
const pipeline::DiscoveryRecord& table4_record() {
  static const pipeline::DiscoveryRecord record =
      pipeline::discover_case_in(pipeline::read_case(source / "configs/discover/friction.yaml"),
                                 source / "configs/data/friction_table4.csv");
  return record;
}

/// Made pulls, F = 2 mu N with a static peak of 40 % over 2 mm of slip; 3 % from piece to piece.
std::string made_pulls() {
  discover::Random random(11);
  std::string text =
      "condition_id,sample_id,day_id,velocity_mm_s,normal_force_N,tool_temperature_C,fabric_temperature_C,"
      "displacement_mm,"
      "pull_force_N\n";
  int condition = 0, sample = 0;
  for (const double velocity : {1.66, 8.3, 16.7, 83.3})
    for (const double load : {343.0, 1500.0, 4000.0}) {
      ++condition;
      for (int replicate = 0; replicate < 3; ++replicate) {
        const double gain = std::exp(0.03 * random.normal());
        ++sample;
        for (const double slip : {0.5, 1.0, 3.0, 8.0, 20.0, 50.0}) {
          const double mu = 0.28 * std::pow(velocity / 16.7, 0.046) * std::pow(load / 1500.0, -0.12) *
                            (1.0 + 0.4 * std::exp(-slip / 2.0));
          text +=
              fmt::format("c{},s{},d{},{},{},85,180,{},{:.3f}\n", condition, sample, 1 + condition % 3,
                          velocity, load, slip, 2.0 * mu * load * gain * std::exp(0.005 * random.normal()));
        }
      }
    }
  return text;
}

const pipeline::DiscoveryRecord& peak_record() {
  static const pipeline::DiscoveryRecord record = [] {
    pipeline::DiscoveryRecord made = table4_record();
    made.data_file = "made <pulls>.csv";
    const friction::CouponData data = friction::parse_coupons(
        made_pulls(), "made.csv", {.stretches = 3, .same_stretches = true, .faces = 2});
    made.findings = discover::discover_in_coupons(made.question, data);
    return made;
  }();
  return record;
}

std::size_t count(const std::string& text, const std::string& what) {
  std::size_t found = 0;
  for (std::size_t at = text.find(what); at != std::string::npos; at = text.find(what, at + 1)) ++found;
  return found;
}

std::string page_with(pipeline::DiscoveryRecord record, Answer answer) {
  record.findings.decision.answer = answer;
  return pipeline::discover_html(record);
}

}  // namespace

TEST_CASE("replicates narrow a mean of the gap, but pulls of one day share its shift",
          "[pipeline][discover][report]") {
  const double sample = 0.05, day = 0.02;
  const auto noise_with_days = [&](std::size_t second_day) {
    const auto findings = flat_findings(
        {cell_at(0.01, 1000, 0, 0, 4, 2), cell_at(0.02, 1000, 1, second_day, 2, 2)}, 2, sample, day);
    const pipeline::GapTable table = pipeline::gap_table(findings);
    return mean_of(table, table.gap, weights_of(table, "whole pull", every)).noise;
  };
  // Half of each cell: (s^2/4 + s^2/2)/4 of samples, the whole day or half of the square of two.
  const double samples = 0.25 * sample * sample * (0.25 + 0.5);
  CHECK(noise_with_days(0) == Approx(std::sqrt(samples + day * day)).epsilon(1e-12));
  CHECK(noise_with_days(1) == Approx(std::sqrt(samples + 0.5 * day * day)).epsilon(1e-12));
}

TEST_CASE("a gap that is the same all along the pull has no trend", "[pipeline][discover][report]") {
  const auto findings =
      flat_findings({cell_at(0.01, 1000, 0, 0, 1, 8), cell_at(0.02, 1000, 1, 0, 1, 8)}, 8, 0.05, 0.02);
  const pipeline::GapTable table = pipeline::gap_table(findings);
  const Eigen::VectorXd even = Eigen::VectorXd::Constant(16, 0.07);
  Eigen::VectorXd rising(16);
  for (Eigen::Index i = 0; i < 16; ++i) rising[i] = 0.01 * static_cast<double>(i % 8);
  const Eigen::VectorXd trend = weights_of(table, "trend", every);
  CHECK(mean_of(table, even, trend).value == Approx(0.0).margin(1e-15));
  CHECK(mean_of(table, rising, trend).value == Approx(0.04));  // mean of 4..7 less mean of 0..3, hundredths
  // What all stretches of a piece share, its gain and its day, falls out of a trend.
  CHECK(mean_of(table, even, trend).noise == Approx(0.0).margin(1e-12));
  CHECK(mean_of(table, even, weights_of(table, "start", every)).value == Approx(0.07));
  CHECK(mean_of(table, rising, weights_of(table, "start", every)).value == Approx(0.01));  // of 0, 1, 2
}

TEST_CASE("loads that differ by a sensor's error are one level, and many levels are cut into even parts",
          "[pipeline][discover][report]") {
  const auto near = flat_findings(
      {cell_at(0.01, 1000, 0, 0, 1, 1), cell_at(0.01, 1012, 1, 0, 1, 1), cell_at(0.01, 2000, 2, 0, 1, 1)}, 1,
      0.05, 0.02);
  const auto levels = all_levels(pipeline::gap_table(near), 8);
  REQUIRE(levels.size() == 1);  // speed and temperatures have one value
  CHECK(levels[0].title() == "Normal force (N)");
  CHECK(levels[0].of == std::vector<std::size_t>{0, 0, 1});
  CHECK(pipeline::constant_factors(near).front() == "tool temperature 85 °C");

  std::vector<discover::CouponCell> many;
  for (std::size_t k = 0; k < 1000; ++k)
    many.push_back(cell_at(0.001 * std::pow(100.0, 1e-3 * static_cast<double>(k)), 1000, k, 0, 1, 1));
  const auto cut = all_levels(pipeline::gap_table(flat_findings(many, 1, 0.05, 0.02)), 8);
  REQUIRE(cut.size() == 1);
  REQUIRE(cut[0].count() == 8);
  for (std::size_t level = 0; level < 8; ++level)  // even parts of ln U hold as many
    CHECK(std::abs(std::count(cut[0].of.begin(), cut[0].of.end(), level) - 125) <= 1);
}

TEST_CASE("two explanations are shown where they differ", "[pipeline][discover][report]") {
  std::vector<discover::CouponCell> cells;
  for (const double velocity : {0.001, 0.01, 0.1})
    for (const double load : {300.0, 1000.0, 3000.0})
      cells.push_back(cell_at(velocity, load, cells.size(), 0, 2, 1));
  const auto findings = flat_findings(cells, 1, 0.05, 0.01);
  const pipeline::GapTable table = pipeline::gap_table(findings);
  const auto levels = all_levels(table, 8);
  REQUIRE(levels.size() == 2);
  const Eigen::VectorXd none = Eigen::VectorXd::Zero(9);
  Eigen::VectorXd at_high_load = none;  // opposite at the ends of speed, so the mean over speeds sees nothing
  at_high_load[2] = 0.1;
  at_high_load[8] = -0.1;
  const auto cut = cut_between(table, levels, at_high_load, none);
  REQUIRE(cut);
  CHECK(levels[cut->along].name == "velocity");
  REQUIRE(cut->at);
  CHECK(levels[cut->at->first].words(cut->at->second) == "normal force 3000 N");
  // The day, shared by all, falls out of a difference that sums to nothing.
  CHECK(cut->separation == Approx(2.0 * std::pow(0.1 / 0.05, 2) * 2.0));
  CHECK_FALSE(cut_between(table, levels, none, none));
}

TEST_CASE("a condition never measured is drawn empty, one within noise pale",
          "[pipeline][discover][report]") {
  using pipeline::MatrixField;
  const auto drawn = [](MatrixField field) {
    return draw(pipeline::MatrixPicture{.label = "x",
                                        .across = "a",
                                        .down = "b",
                                        .columns = {"1"},
                                        .rows = {"2"},
                                        .fields = {field},
                                        .full = 0.1})
        .inline_svg();
  };
  CHECK(count(drawn({0.1, 0.01, 3}), "\"d8\"") == 2);  // the field, and its place in the key
  CHECK_THAT(drawn({0.1, 0.01, 3}), Contains("+10"));
  CHECK(count(drawn({0.1, 0.2, 3}), "\"d8\"") == 1);
  CHECK_THAT(drawn({-0.1, 0.01, 3}), Contains("−10"));
  CHECK_THAT(drawn({0.1, 0.01, 0}), !Contains("+10 <") && Contains("<circle"));
}

TEST_CASE("four forces and four numbers: the page says that a saturated fit proves nothing",
          "[pipeline][discover][report]") {
  const std::string page = pipeline::discover_html(table4_record());
  CHECK_THAT(page, Contains("The fit is saturated") && Contains("Nothing could be held out: 4 conditions"));
  CHECK_THAT(page, !Contains("The gap shrinks"));
  CHECK_THAT(page, Contains("How samples scatter is assumed") && Contains("How much days differ is assumed"));
  CHECK_THAT(page, Contains("one line a pull: how the gap runs along the slip cannot be seen"));
  CHECK_THAT(page, Contains("Everything was pulled at orientation 0°"));
  CHECK_THAT(page, Contains("these data cannot say which"));
}

TEST_CASE("a peak at the start of every pull is told with its proof on conditions that no fit saw",
          "[pipeline][discover][report]") {
  const pipeline::DiscoveryRecord& record = peak_record();
  const discover::CouponFindings& found = record.findings;
  REQUIRE(found.gap);
  const std::string page = pipeline::discover_html(record);
  CHECK_THAT(page, Contains("static peak") && Contains("Along the pull") && Contains("Fingerprints"));
  CHECK_THAT(page, Contains(fmt::format("On {} conditions that no fit saw", found.gap->conditions)));
  CHECK_THAT(page, Contains("The gap shrinks by"));
  // One hollow mark a held-out condition and one in the key.
  CHECK(count(page, "\"hollow\"") == found.held_out.size() + 1);
  CHECK_THAT(page, Contains("made &lt;pulls&gt;.csv") && !Contains("<pulls>"));
}

TEST_CASE("each of the five answers has its sentence and the same chapters", "[pipeline][discover][report]") {
  const auto [answer, sentence] = GENERATE(table<Answer, std::string>(
      {{Answer::no_gap, "Nothing is missing that these data could show."},
       {Answer::named, "The model lacks static peak, with probability"},
       {Answer::one_of, "these data cannot say which."},
       {Answer::named_incomplete, "something more is missing, which shows over"},
       {Answer::unknown, "The model lacks something that no effect of the library explains"}}));
  const std::string page = page_with(peak_record(), answer);
  CAPTURE(sentence);
  CHECK_THAT(page, Contains(sentence));
  for (const char* chapter :
       {"Maps of the gap", "<h2>The proof</h2>", "<h2>Doubts</h2>", "What this campaign can see", "Not tried",
        "<h2>Next</h2>", "heddle friction discover/patched.yaml"})
    CHECK_THAT(page, Contains(chapter));
  CHECK(page == page_with(peak_record(), answer));  // same record, same bytes
  CHECK_THAT(page, !Contains("<script") && !Contains("http") && !Contains("nan") && !Contains("inf<"));
  CHECK(count(page, "<svg") == count(page, "aria-label=\""));
  CHECK(count(page, "aria-label=\"\"") == 0);
  const bool adds_physics = answer == Answer::named || answer == Answer::named_incomplete;
  CHECK((page.find("baseline as fitted and static peak in it") != std::string::npos) == adds_physics);
}

TEST_CASE("a fault of the rig is told as one, and the model stays as it is", "[pipeline][discover][report]") {
  pipeline::DiscoveryRecord record = peak_record();
  for (const std::size_t effect : record.findings.decision.named)
    record.findings.forward.candidates[effect].kind = discover::Kind::rig;
  const std::string page = page_with(std::move(record), Answer::named);
  CHECK_THAT(page, Contains("The measurement is at fault, not the model"));
  CHECK_THAT(page, Contains("the model stays as it is"));
}

TEST_CASE("an effect of the user's own that moves a number of the resin is in the patched case",
          "[pipeline][discover][report]") {
  const pipeline::Case a_case = pipeline::read_case(source / "configs/discover/friction.yaml");
  pipeline::DiscoveryRecord record = table4_record();
  std::erase_if(record.question.baseline,
                [](const discover::Unknown& number) { return number.key == "resin.activation_energy"; });
  record.question.effects = {
      discover::read_effect("id: other_grade\nstage: film\nterm: \"\"\nform: E of the grade\nparameters:\n"
                            "  energy: {unit: kJ/mol, key: resin.activation_energy, prior: \"normal, mean 42 "
                            "kJ/mol, sd 15 kJ/mol\", off: 42 kJ/mol}\n"
                            "look_alikes: []\nsource: prior\n",
                            "other_grade.yaml")};
  std::string pulls = made_pulls();  // one load colder, where the film's activation energy shows
  for (std::size_t at; (at = pulls.find(",1500,85,180,")) != std::string::npos;)
    pulls.replace(at, 13, ",1500,85,160,");
  const friction::CouponData data =
      friction::parse_coupons(pulls, "made.csv", {.stretches = 3, .same_stretches = true, .faces = 2});
  record.findings = discover::discover_in_coupons(record.question, data);
  REQUIRE(record.findings.forward.candidates.size() == 1);
  record.findings.decision.named = {0};
  record.findings.decision.answer = Answer::named;
  const discover::Trial& trial = record.findings.result.find({0})->numbers.trial;
  const double fitted = trial.effects.at(0).second[0];
  CHECK(fitted != Approx(42e3).epsilon(1e-6));
  CHECK(discovered_settings(a_case, record).number("resin.activation_energy") == fitted);
  record.findings.decision.answer = Answer::one_of;  // no name, no change
  CHECK(discovered_settings(a_case, record).number("resin.activation_energy") == Approx(42e3));
}
