#include "macroscale/blank.h"

#include <algorithm>
#include <cmath>

namespace heddle::macroscale {

namespace {

int cells(double size, double spacing) {
  // 1e-9: a size that is a whole number of spacings must not gain a cell by rounding.
  return std::max(1, static_cast<int>(std::ceil(size / spacing - 1e-9)));
}

std::vector<TowTriple> tow_triples(const Blank& blank) {
  std::vector<TowTriple> triples;
  for (int i = 0; i <= blank.nu; ++i) {
    for (int j = 0; j <= blank.nv; ++j) {
      const double edge_u = (j == 0 || j == blank.nv) ? 0.5 : 1.0;
      const double edge_v = (i == 0 || i == blank.nu) ? 0.5 : 1.0;
      if (i > 0 && i < blank.nu)
        triples.push_back(
            {blank.node(i - 1, j), blank.node(i, j), blank.node(i + 1, j), edge_u * blank.spacing[1], 0});
      if (j > 0 && j < blank.nv)
        triples.push_back(
            {blank.node(i, j - 1), blank.node(i, j), blank.node(i, j + 1), edge_v * blank.spacing[0], 1});
    }
  }
  return triples;
}

}  // namespace

std::array<Corner, 4> corners_of(const std::array<int, 4>& quad) {
  return {{{quad[0], quad[1], quad[3], +1},
           {quad[1], quad[0], quad[2], -1},
           {quad[2], quad[3], quad[1], +1},
           {quad[3], quad[2], quad[0], -1}}};
}

Blank make_blank(std::array<double, 2> size, double spacing, double orientation, double z) {
  Blank blank;
  blank.nu = cells(size[0], spacing);
  blank.nv = cells(size[1], spacing);
  blank.spacing = {size[0] / blank.nu, size[1] / blank.nv};
  const double c = std::cos(orientation), s = std::sin(orientation);
  for (int i = 0; i <= blank.nu; ++i) {
    for (int j = 0; j <= blank.nv; ++j) {
      // Written so that opposite nodes are exact mirror images: the symmetric part must not be tilted by
      // rounding.
      const double u = (i - 0.5 * blank.nu) * blank.spacing[0];
      const double v = (j - 0.5 * blank.nv) * blank.spacing[1];
      blank.reference.emplace_back(c * u - s * v, s * u + c * v, z);
    }
  }
  for (int i = 0; i < blank.nu; ++i)
    for (int j = 0; j < blank.nv; ++j)
      blank.quads.push_back(
          {blank.node(i, j), blank.node(i + 1, j), blank.node(i + 1, j + 1), blank.node(i, j + 1)});
  blank.node_area.assign(blank.reference.size(), 0.0);
  for (const auto& quad : blank.quads)
    for (int node : quad) blank.node_area[node] += blank.corner_area();
  blank.triples = tow_triples(blank);
  return blank;
}

}  // namespace heddle::macroscale
