#include <cstddef>
#include <cstdint>
#include <cstring>

#include "mesoscale/solid/element.h"
#include "mesoscale/solid/pack.h"

namespace heddle::mesoscale::solid {

namespace {

// The four nodes of a face across x: sums over them with the signs of 1, eta, zeta, eta zeta.
// Mode m of component i stands at 3 m + i.
template <int cases>
struct Face {
  Pack<cases> mode[12];
};

// Node rows at (eta, zeta) = (-,-), (+,-), (-,+), (+,+).
struct Rows {
  const double* u[4];
  double* f[4];
};

template <int cases>
HEDDLE_INLINE void gather(Face<cases>& face, const Rows& rows, std::ptrdiff_t at) {
#pragma GCC unroll 12
  for (int i = 0; i < 3; ++i) {
    Pack<cases> u[4], low_sum, low_gap, high_sum, high_gap;
#pragma GCC unroll 12
    for (int n = 0; n < 4; ++n) load(u[n], rows.u[n] + at + cases * i);
    set_sum(low_sum, u[0], u[1]);
    set_difference(low_gap, u[1], u[0]);
    set_sum(high_sum, u[2], u[3]);
    set_difference(high_gap, u[3], u[2]);
    set_sum(face.mode[i], low_sum, high_sum);
    set_sum(face.mode[3 + i], low_gap, high_gap);
    set_difference(face.mode[6 + i], high_sum, low_sum);
    set_difference(face.mode[9 + i], high_gap, low_gap);
  }
}

// The transpose: forces of the modes become forces of the nodes.
template <int cases>
HEDDLE_INLINE void scatter(const Face<cases>& force, const Rows& rows, std::ptrdiff_t at) {
#pragma GCC unroll 12
  for (int i = 0; i < 3; ++i) {
    Pack<cases> low_even, low_odd, high_even, high_odd, f[4];
    set_difference(low_even, force.mode[i], force.mode[6 + i]);
    set_difference(low_odd, force.mode[3 + i], force.mode[9 + i]);
    set_sum(high_even, force.mode[i], force.mode[6 + i]);
    set_sum(high_odd, force.mode[3 + i], force.mode[9 + i]);
    set_difference(f[0], low_even, low_odd);
    set_sum(f[1], low_even, low_odd);
    set_difference(f[2], high_even, high_odd);
    set_sum(f[3], high_even, high_odd);
#pragma GCC unroll 12
    for (int n = 0; n < 4; ++n) {
      Pack<cases> sum;
      load(sum, rows.f[n] + at + cases * i);
      add(sum, f[n]);
      store(rows.f[n] + at + cases * i, sum);
    }
  }
}

template <int size, int cases>
HEDDLE_INLINE void multiply(const double* table, const Pack<cases>* x, Pack<cases>* y) {
#pragma GCC unroll 12
  for (int row = 0; row < size; ++row) {
    set_product(y[row], table[size * row], x[0]);
#pragma GCC unroll 9
    for (int column = 1; column < size; ++column) add_product(y[row], table[size * row + column], x[column]);
  }
}

// Forces of the two faces of a voxel. `left` is added to, `right` is set.
template <int cases>
HEDDLE_INLINE void voxel(const ElementTable& table, const Face<cases>& l, const Face<cases>& r,
                         Face<cases>& left, Face<cases>& right) {
  // Even in xi: eta, zeta, eta zeta. Odd: xi, xi eta, xi zeta, xi eta zeta.
  Pack<cases> linear[9], bilinear[9], trilinear[3], force[9];
#pragma GCC unroll 12
  for (int i = 0; i < 3; ++i) {
    set_difference(linear[i], r.mode[i], l.mode[i]);
    set_sum(linear[3 + i], r.mode[3 + i], l.mode[3 + i]);
    set_sum(linear[6 + i], r.mode[6 + i], l.mode[6 + i]);
    set_difference(bilinear[i], r.mode[3 + i], l.mode[3 + i]);
    set_difference(bilinear[3 + i], r.mode[6 + i], l.mode[6 + i]);
    set_sum(bilinear[6 + i], r.mode[9 + i], l.mode[9 + i]);
    set_difference(trilinear[i], r.mode[9 + i], l.mode[9 + i]);
  }
  multiply<9>(table.linear.data(), linear, force);
#pragma GCC unroll 12
  for (int i = 0; i < 3; ++i) {
    set_difference(left.mode[i], left.mode[i], force[i]);
    right.mode[i] = force[i];
    add(left.mode[3 + i], force[3 + i]);
    right.mode[3 + i] = force[3 + i];
    add(left.mode[6 + i], force[6 + i]);
    right.mode[6 + i] = force[6 + i];
  }
  multiply<9>(table.bilinear.data(), bilinear, force);
#pragma GCC unroll 12
  for (int i = 0; i < 3; ++i) {
    set_difference(left.mode[3 + i], left.mode[3 + i], force[i]);
    add(right.mode[3 + i], force[i]);
    set_difference(left.mode[6 + i], left.mode[6 + i], force[3 + i]);
    add(right.mode[6 + i], force[3 + i]);
    add(left.mode[9 + i], force[6 + i]);
    right.mode[9 + i] = force[6 + i];
  }
  multiply<3>(table.trilinear.data(), trilinear, force);
#pragma GCC unroll 12
  for (int i = 0; i < 3; ++i) {
    set_difference(left.mode[9 + i], left.mode[9 + i], force[i]);
    add(right.mode[9 + i], force[i]);
  }
}

// u . f over the four nodes, in modes.
template <int cases>
HEDDLE_INLINE void add_energy(Pack<cases>& energy, const Face<cases>& u, const Face<cases>& f) {
#pragma GCC unroll 12
  for (int m = 0; m < 12; ++m) add_product(energy, u.mode[m], f.mode[m]);
}

// One row of voxels along x. Each face is gathered once and scattered once, for both its voxels.
template <int cases>
HEDDLE_INLINE void apply_row(const ElementTable* tables, const std::uint16_t* material, int nx,
                             const Rows& rows, Pack<cases>& energy) {
  constexpr std::ptrdiff_t node = 3 * cases;
  Face<cases> first, l, force, first_force;
  gather(first, rows, 0);
  l = first;
  std::memset(&force, 0, sizeof force);
  std::memset(&first_force, 0, sizeof first_force);
  for (int i = 0; i < nx; ++i) {
    Face<cases> r, next;
    if (i + 1 < nx)
      gather(r, rows, node * (i + 1));
    else
      r = first;
    voxel(tables[material[i]], l, r, force, next);
    if (i == 0) {
      first_force = force;
    } else {
      add_energy(energy, l, force);
      scatter(force, rows, node * i);
    }
    force = next;
    l = r;
  }
#pragma GCC unroll 12
  for (int m = 0; m < 12; ++m) add(first_force.mode[m], force.mode[m]);
  add_energy(energy, first, first_force);
  scatter(first_force, rows, 0);
}

template <int cases>
HEDDLE_INLINE void apply(const VoxelLayer& layer, double* energies) {
  Pack<cases> energy;
  std::memset(&energy, 0, sizeof energy);
  const std::ptrdiff_t row = static_cast<std::ptrdiff_t>(3 * cases) * layer.nx;
  for (int j = 0; j < layer.ny; ++j) {
    const std::ptrdiff_t here = row * j, next = row * ((j + 1) % layer.ny);
    const Rows rows{{layer.lower + here, layer.lower + next, layer.upper + here, layer.upper + next},
                    {layer.force_lower + here, layer.force_lower + next, layer.force_upper + here,
                     layer.force_upper + next}};
    apply_row(layer.tables, layer.material + static_cast<std::ptrdiff_t>(layer.nx) * j, layer.nx, rows,
              energy);
  }
  store(energies, energy);
}

template <int cases>
void apply_plain(const VoxelLayer& layer, double* energies) {
  apply<cases>(layer, energies);
}
template <int cases>
__attribute__((target("avx2,fma"))) void apply_avx2(const VoxelLayer& layer, double* energies) {
  apply<cases>(layer, energies);
}
template <int cases>
__attribute__((target("avx2,fma,avx512f,avx512vl"))) void apply_avx512(const VoxelLayer& layer,
                                                                       double* energies) {
  apply<cases>(layer, energies);
}

template <int cases>
void apply_by(Instructions instructions, const VoxelLayer& layer, double* energies) {
  switch (instructions) {
    case Instructions::plain:
      return apply_plain<cases>(layer, energies);
    case Instructions::avx2:
      return apply_avx2<cases>(layer, energies);
    case Instructions::avx512:
      return apply_avx512<cases>(layer, energies);
  }
}

}  // namespace

namespace {

Instructions ask_processor() {
  if (__builtin_cpu_supports("avx512vl") && __builtin_cpu_supports("avx512f")) return Instructions::avx512;
  if (__builtin_cpu_supports("avx2") && __builtin_cpu_supports("fma")) return Instructions::avx2;
  return Instructions::plain;
}

}  // namespace

Instructions best_instructions() {
  static const Instructions best = ask_processor();
  return best;
}

CaseNumbers apply_layer(const VoxelLayer& layer, Instructions instructions) {
  CaseNumbers energies{};
  if (layer.cases == loads)
    apply_by<loads>(instructions, layer, energies.data());
  else
    apply_by<pair_of_loads>(instructions, layer, energies.data());
  return energies;
}

CaseNumbers apply_layer(const VoxelLayer& layer) {
  return apply_layer(layer, best_instructions());
}

}  // namespace heddle::mesoscale::solid
