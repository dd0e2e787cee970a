#pragma once

#include <string>

#include "pipeline/discover_command.h"
#include "pipeline/discover_report_gap.h"

/// The sections of report.html of a discovery, each HTML.
namespace heddle::pipeline {

/// A record with what several sections read off it.
struct DiscoveryPage {
  const DiscoveryRecord& record;
  const discover::CouponFindings& found;
  GapTable gap;
  std::vector<Levels> levels;  ///< at most eight a factor
  /// Up to three hypotheses with effects, of different names, best first.
  std::vector<const discover::Scored*> rivals;

  /// One name was given, whether or not something is left over.
  bool named() const;
  /// The name, or the best one where none was given.
  const discover::Scored* best() const { return rivals.empty() ? nullptr : rivals.front(); }
  std::string name_of(const discover::Scored& scored, std::string_view between = " and ") const {
    return in_words(found.forward, scored.fit.hypothesis, between);
  }
};
DiscoveryPage discovery_page(const DiscoveryRecord& record);

/// The answer in one sentence.
std::string verdict_sentence(const DiscoveryPage& page);

/// "16.7 mm/s, 1500 N, tool 85 °C, fabric 180 °C, 45°, dwell 10 s": the factors that the campaign varies.
std::string condition_words(const DiscoveryPage& page, const discover::CouponCell& cell);
/// "≤ 0.001" of a p-value that no draw reached.
std::string p_text(double p);

std::string where_section(const DiscoveryPage& page);
std::string what_section(const DiscoveryPage& page);
std::string proof_section(const DiscoveryPage& page);
std::string doubts_section(const DiscoveryPage& page);
std::string next_section(const DiscoveryPage& page);

}  // namespace heddle::pipeline
