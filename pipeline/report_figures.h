#pragma once

#include "pipeline/chart.h"
#include "pipeline/picture.h"
#include "pipeline/report.h"

/// The pictures of a report, from the data of a run. Each is drawn at the width at which the page shows it.
namespace heddle::pipeline {

inline constexpr double full_width = 1020.0;  ///< of a figure across the page [px]
inline constexpr double half_width = 496.0;   ///< of one of two figures side by side [px]

Canvas force_chart(const std::vector<macroscale::HistoryRow>& history);
Canvas draw_in_chart(const std::vector<macroscale::HistoryRow>& history);
Canvas shear_chart(const std::vector<macroscale::HistoryRow>& history);
Canvas ledger_chart(const std::vector<macroscale::HistoryRow>& history);
Canvas residual_chart(const std::vector<macroscale::HistoryRow>& history);
Canvas iteration_chart(const std::vector<macroscale::HistoryRow>& history);

Canvas height_picture(const HeightField& height);
Canvas section_picture(const std::vector<SectionLine>& section);
Canvas contact_chart(const mesoscale::ContactArea& contact);
/// Colours of the power of ten of the nominal pressure in kPa at which the tool first touches a place.
Canvas touched_picture(const mesoscale::TouchedFace& face);
enum class FrictionAbscissa { hersey, speed };
Canvas friction_chart(const std::vector<FrictionCurveRow>& rows, FrictionAbscissa abscissa);

/// @throws std::invalid_argument  if the blank holds fewer nodes or angles than its cells need
Canvas formed_picture(const macroscale::BlankState& blank);
/// @param largest_angle  upper end of the colour scale [rad]; 0: the blank's own largest
Canvas top_picture(const macroscale::BlankState& blank, double largest_angle = 0.0);

/// The same coloured by any values of the nodes.
Canvas top_picture(const macroscale::BlankState& blank, std::vector<double> value, ColourScale colours,
                   std::string label);

/// Share of the residual in the work the punch has done so far, by the measure of summary.json: the work
/// counts as at least 1 % of its final value, so that the first step does not divide by nothing.
std::vector<double> residual_shares(const std::vector<macroscale::HistoryRow>& history);

}  // namespace heddle::pipeline
