#pragma once

#include <filesystem>
#include <optional>
#include <string>
#include <vector>

#include "pipeline/case.h"
#include "pipeline/commands.h"
#include "pipeline/discover/discovery.h"
#include "pipeline/discover/propose.h"

namespace heddle::pipeline {

/// A discovery with what it rests on.
struct DiscoveryRecord {
  std::string name;             ///< of the case
  std::string data_file;        ///< its name, without the folder
  std::string rig, provenance;  ///< of the sidecar; may be empty
  int seed = 1;
  friction::Model base;
  discover::CouponRig coupon_rig;
  discover::CouponQuestion question;
  discover::CouponFindings findings;
  discover::Proposal proposal;  ///< what to pull next
  std::vector<std::string> notes;
};

/// FILE.yaml beside FILE.csv: what the table itself cannot say.
struct Sidecar {
  std::optional<double> plate_area;  ///< [m^2]
  std::optional<int> faces;
  std::string rig, provenance;
};
/// Empty where there is none. What is wrong with it goes to `problems`.
Sidecar read_sidecar(const std::filesystem::path& data, Problems& problems);

/// The effects that the case asks for: of the library, with the user's own in it.
std::vector<discover::EffectFile> library_of(const DiscoverSpec& spec,
                                             const std::vector<std::filesystem::path>& own_effects,
                                             Problems& problems);

/// Verdict, reasons, gap and notes on standard output.
void print_discovery(const DiscoveryRecord& record, const std::filesystem::path& folder);

/// Looks for what the case's model misses in measured coupons.
/// @param own_effects  effect files beside the library
/// @throws InputError  with every problem of data, sidecar, wish and effect files
DiscoveryRecord discover_case_in(const Case& a_case, const std::filesystem::path& data,
                                 const std::vector<std::filesystem::path>& own_effects = {});

/// The case without its stamping.
/// @throws InputError  if it has no friction
Case read_friction_part(const RunOptions& options);

/// What the case asks of coupons that this rig pulls.
/// @param problems  numbers and effects that are not known are added
discover::CouponQuestion question_of(const Case& a_case, const discover::CouponRig& rig,
                                     const std::vector<std::filesystem::path>& own_effects,
                                     Problems& problems);

/// The settings with the baseline as it was fitted and, where one name was given, the effect it names.
Settings discovered_settings(const Case& a_case, const DiscoveryRecord& record);

/// discover/report.json (docs/discover.md lists its keys).
std::string discovery_json(const DiscoveryRecord& record);
/// One row a held-out condition: before, after, noise.
std::string gap_csv(const DiscoveryRecord& record);
/// The conditions to pull next, in the columns of a coupon table.
std::string next_experiments_csv(const DiscoveryRecord& record);
/// The best smooth gap that has no name, point by point.
std::string shape_csv(const DiscoveryRecord& record);

}  // namespace heddle::pipeline
