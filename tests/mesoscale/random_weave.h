#pragma once

#include <array>
#include <random>
#include <string>
#include <utility>

#include "mesoscale/cell_spec.h"
#include "mesoscale/weave.h"

namespace heddle::test {

inline double uniform(std::mt19937& random, double low, double high) {
  return low + (high - low) * static_cast<double>(random()) / 4294967296.0;
}

inline int whole(std::mt19937& random, int low, int high) {
  return low + static_cast<int>(random() % static_cast<unsigned>(high - low + 1));
}

// A matrix of up to 6 x 6 that holds together.
inline std::string random_matrix(std::mt19937& random) {
  for (;;) {
    const int warps = whole(random, 2, 6), wefts = whole(random, 2, 6);
    std::string text = "matrix ";
    for (int i = 0; i < warps; ++i) {
      if (i > 0) text += '/';
      for (int j = 0; j < wefts; ++j) text += random() % 2 == 0 ? '0' : '1';
    }
    if (mesoscale::parse_weave(text).fault.empty()) return text;
  }
}

// Any weave of any tows that the rules let pass.
inline mesoscale::WeaveSpec random_weave(std::mt19937& random) {
  for (;;) {
    mesoscale::CellSpec spec;
    spec.weave.pattern = random_matrix(random);
    double thickness = 0.0;
    for (mesoscale::OwnTow& own : spec.weave.own) {
      own.tow_width = uniform(random, 1e-3, 6e-3);
      own.gap = uniform(random, 0.0, 0.8) * *own.tow_width;
      own.tow_thickness = *own.tow_width / uniform(random, 3.0, 15.0);
      // Fills a third to nine tenths of a lens.
      own.linear_density = uniform(random, 0.2, 0.6) * *own.tow_width * *own.tow_thickness * 1480.0;
      thickness += *own.tow_thickness;
    }
    spec.weave.fabric_thickness = thickness;
    if (check(spec).empty()) return spec.weave;
  }
}

// The same tows with unlike halves of any shape.
inline mesoscale::WeaveSpec with_random_halves(mesoscale::WeaveSpec weave, std::mt19937& random) {
  using mesoscale::SectionShape;
  weave.section = SectionShape::hybrid;
  weave.upper_share = uniform(random, 0.1, 0.9);
  for (mesoscale::HalfSpec* half : {&weave.upper, &weave.lower}) {
    half->section = std::array{SectionShape::lens, SectionShape::ellipse, SectionShape::power_ellipse,
                               SectionShape::capped_lens}[random() % 4];
    half->section_power = uniform(random, 0.2, 4.0);
    half->section_cap = uniform(random, 0.1, 1.0);
  }
  return weave;
}

// With halves of one thickness that are no fuller than the lens: these stay clear of each other at any angle.
inline mesoscale::WeaveSpec with_slim_halves(mesoscale::WeaveSpec weave, std::mt19937& random) {
  weave = with_random_halves(weave, random);
  weave.upper_share = 0.5;
  weave.upper.section = mesoscale::SectionShape::lens;
  weave.lower.section = mesoscale::SectionShape::capped_lens;
  if (random() % 2 == 0) std::swap(weave.upper, weave.lower);
  return weave;
}

}  // namespace heddle::test
