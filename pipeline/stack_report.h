#pragma once

#include <string>
#include <vector>

#include "mesoscale/nesting.h"
#include "mesoscale/pictures.h"

/// Several plies on one another: the table of how two of them nest, and a section of the weave's report.
namespace heddle::pipeline {

struct StackView {
  mesoscale::StackSummary summary;
  std::vector<mesoscale::Outline> cut;  ///< along the lowest ply's first warp
  mesoscale::NestingMap nesting;        ///< of two plies, tows as they are in the lone ply
  double glass_of_two = 0.0;            ///< glass of two plies, spread evenly [m]
  bool consolidated = false;
};
StackView stack_view(const mesoscale::CellSpec& spec);

/// nesting.csv: shift along warp and weft, thickness of two plies, their glass by volume. A consolidated
/// stack has its thickness by mass; there the table is that of the tows before they swell.
std::string nesting_csv(const StackView& view);

/// Body of the section.
std::string stack_section(const StackView& view);

}  // namespace heddle::pipeline
