#pragma once

#include <cstdint>
#include <optional>
#include <string>
#include <string_view>
#include <vector>

#include "blindgen/campaign.h"

/// The blind test of `heddle discover`: campaigns of made data, run case by case, then scored.
namespace heddle::blind {

/// Three more cells for a campaign that has been answered once.
enum class FollowUp {
  none,
  proposed,  ///< the experiments that the first answer asks for
  random     ///< drawn from the levels of Table 2
};

/// A part of the method that `discover` is asked to do without, to see what the part is worth.
struct Ablation {
  std::string_view without;            ///< in words
  std::vector<std::string_view> sets;  ///< settings, as after --set
};

/// The first leaves nothing out.
const std::vector<Ablation>& ablations();

/// A case under an opaque number. What is hidden in it follows from the specification alone.
struct PlannedCase {
  int number = 0;  ///< from 1, in an order that says nothing about the kind
  blindgen::Spec spec;
  FollowUp follow_up = FollowUp::none;
  std::size_t ablation = 0;  ///< in ablations()
  int first = 0;             ///< of a follow-up or an ablation: number of the case with the same world
};

/// What decides a campaign besides its name. Stored beside the reports, so that the scorer can plan it again.
struct Selection {
  std::uint64_t seed = 1;
  std::vector<blindgen::Kind> kinds = {};  ///< empty: all
  int limit = 0;                           ///< first cases of the shuffled order; 0: all
};

struct CampaignInfo {
  std::string_view name;
  std::string_view purpose;
};

/// development, acceptance, designs, cv10, amplitudes, proposals, ablations, smoke.
const std::vector<CampaignInfo>& campaigns();

/// The cases of a campaign, shuffled by its seed; follow-ups and ablations behind the case they follow.
/// @throws std::invalid_argument  no campaign of that name
std::vector<PlannedCase> plan(std::string_view campaign, const Selection& selection);

constexpr int follow_up_cells = 3;

/// Cells of a random follow-up: levels of tool temperature, N, U of Table 2 and rests of the designs,
/// crossed.
std::vector<blindgen::Condition> random_cells(const blindgen::Spec& spec);

/// Seed of an acceptance run: the first 8 hexadecimal digits of two git trees, the search and the laws, so
/// that nobody can choose it and results do not change it.
/// @param discover_tree, friction_tree  hexadecimal object names
/// @throws std::invalid_argument  not at least 8 hexadecimal digits
std::uint64_t acceptance_seed(std::string_view discover_tree, std::string_view friction_tree);

}  // namespace heddle::blind
