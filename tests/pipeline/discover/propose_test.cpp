// What to pull next.
#include "pipeline/discover/propose.h"

#include <catch2/catch.hpp>
#include <set>

#include "made_campaign.h"

using namespace heddle;
using namespace heddle::discover;

namespace {

std::size_t candidate_of(const ForwardModel& forward, const std::string& id) {
  for (std::size_t k = 0; k < forward.candidates.size(); ++k)
    if (forward.candidates[k].id == id) return k;
  throw std::runtime_error("no effect " + id);
}

CouponCampaign campaign_with(const std::vector<CouponCell>& cells) {
  CouponCampaign campaign;
  campaign.cells = cells;
  return campaign;
}

/// Which of some cells these pulls are.
std::vector<std::size_t> places(const Proposal& proposal, const std::vector<CouponCell>& candidates) {
  std::vector<std::size_t> found;
  for (const ProposedPull& next : proposal.pulls)
    for (std::size_t k = 0; k < candidates.size(); ++k)
      if (candidates[k].pull.velocity == next.cell.pull.velocity &&
          candidates[k].pull.normal_force == next.cell.pull.normal_force &&
          candidates[k].pull.tool_temperature == next.cell.pull.tool_temperature &&
          candidates[k].pull.fabric_temperature == next.cell.pull.fabric_temperature &&
          candidates[k].pull.orientation == next.cell.pull.orientation &&
          candidates[k].dwell == next.cell.dwell)
        found.push_back(k);
  return found;
}

}  // namespace

TEST_CASE("conditions that may follow lie inside the campaign's hull and are not measured yet",
          "[discover][propose]") {
  const std::vector<CouponCell> cells = test::paper_cells();
  const std::vector<CouponCell> grid = candidate_grid(campaign_with(cells));
  // Three levels of temperatures, load, speed and sin^2 of twice the angle; eleven of them are measured.
  CHECK(grid.size() == 243 - 11);
  for (const Factor& factor : factors()) {
    const auto [low, high] = std::ranges::minmax(cells, {}, factor.of);
    for (const CouponCell& cell : grid) {
      CHECK(factor.of(cell) >= factor.of(low) - 1e-9);
      CHECK(factor.of(cell) <= factor.of(high) + 1e-9);
    }
  }
}

TEST_CASE("more pulls are expected to help, the same ones for one seed", "[discover][propose]") {
  const std::vector<CouponCell> cells = test::paper_cells();
  const std::vector<CouponCell> grid = candidate_grid(campaign_with(cells));
  test::MadeWorld world(test::shipped_question(), cells, grid, 1);
  Random random(3);
  world.draw(candidate_of(world.forward(), "pressure_dependent_area"), random);
  const CouponFindings findings = world.analysed(world.measured());
  const Proposal proposal = propose(world.question(), findings, grid);
  REQUIRE(proposal.pulls.size() == 3);
  REQUIRE(proposal.rivals.size() >= 4);
  double sum = 0.0;
  for (const Rival& rival : proposal.rivals) sum += rival.probability;
  CHECK(sum == Approx(1.0));
  CHECK(proposal.right_before == proposal.rivals.front().probability);
  CHECK(proposal.right_after == proposal.pulls.back().right);
  CHECK(proposal.right_after > proposal.right_before);
  CHECK(proposal.pulls[0].gain > 0.0);
  for (const ProposedPull& next : proposal.pulls) CHECK_FALSE(next.separates.empty());

  const Proposal again = propose(world.question(), findings, grid);
  CHECK(again.right_after == proposal.right_after);
  CHECK(places(again, grid) == places(proposal, grid));
}

TEST_CASE("where no condition could tell two answers apart, that is said", "[discover][propose]") {
  // Another orientation alone: a cooled film and a shifted curve do there what they do at the baseline.
  std::vector<CouponCell> turned;
  for (const double degrees : {10.0, 20.0}) turned.push_back(test::cell_at(85, 1500, 16.6, 180, degrees));
  CouponQuestion question = test::shipped_question();
  std::erase_if(question.effects, [](const EffectFile& effect) {
    return effect.id != "tool_temperature_film" && effect.id != "tool_temperature_shift";
  });
  test::MadeWorld world(question, test::paper_cells(), turned, 1);
  Random random(3);
  world.draw(candidate_of(world.forward(), "tool_temperature_film"), random);
  const CouponFindings findings = world.analysed(world.measured());
  const auto apart = [&](const Proposal& proposal, const std::string& a, const std::string& b) {
    return std::ranges::none_of(proposal.inseparable, [&](const RivalPair& pair) {
      const std::set<std::string> names{proposal.rivals[pair.first].name, proposal.rivals[pair.second].name};
      return names == std::set<std::string>{a, b};
    });
  };
  const Proposal useless = propose(question, findings, turned);
  CHECK(useless.pulls.size() == 2);
  CHECK_FALSE(apart(useless, "tool_temperature_film", "tool_temperature_shift"));
  CHECK(useless.right_after < useless.right_before + 0.05);
  const Proposal useful = propose(question, findings, candidate_grid(campaign_with(test::paper_cells())));
  CHECK(apart(useful, "tool_temperature_film", "tool_temperature_shift"));
  CHECK(propose(question, findings, {}).pulls.empty());
}

TEST_CASE("three proposed conditions name look-alikes more often than three drawn at random",
          "[discover][propose][slow]") {
  CouponQuestion question = test::shipped_question();
  const std::vector<CouponCell> cells = test::paper_cells();
  const std::vector<CouponCell> candidates = candidate_grid(campaign_with(cells));
  test::MadeWorld world(question, cells, candidates, 2);
  Random random(2026);
  int cases = 0, before = 0, proposed = 0, by_chance = 0;
  const auto named = [](const CouponFindings& findings, const Hypothesis& truth) {
    return test::first_name(findings) == truth ? 1 : 0;
  };
  for (const char* id : {"tool_temperature_film", "tool_temperature_shift", "pressure_dependent_area",
                         "adhesion", "shear_heating"}) {
    const Hypothesis truth{candidate_of(world.forward(), id)};
    for (int k = 0; k < 30; ++k) {
      world.draw(truth.front(), random);
      const CouponFindings first = world.analysed(world.measured());
      const Proposal proposal = propose(question, first, candidates);
      const std::vector<std::size_t> chosen = places(proposal, candidates);
      REQUIRE(chosen.size() == 3);
      std::set<std::size_t> drawn;
      while (drawn.size() < 3) drawn.insert(random.below(candidates.size()));
      before += named(first, truth);
      proposed += named(world.analysed(world.measured(chosen)), truth);
      by_chance += named(world.analysed(world.measured({drawn.begin(), drawn.end()})), truth);
      ++cases;
    }
  }
  WARN(before << " names right before, " << proposed << " with three proposed conditions, " << by_chance
              << " with three random ones, of " << cases);
  CHECK(proposed > by_chance);
  CHECK(proposed >= before + cases / 20);
}
