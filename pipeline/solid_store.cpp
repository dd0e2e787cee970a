#include "pipeline/solid_store.h"

#include <algorithm>

#include <fmt/format.h>

namespace heddle::pipeline {

namespace {

namespace solid = mesoscale::solid;

template <class Matrix>
void write_matrix(Hdf5Writer& file, const std::string& path, const Matrix& matrix) {
  file.write(path, std::span<const double>(matrix.data(), static_cast<std::size_t>(matrix.size())));
}

template <class Matrix>
void read_matrix(const Hdf5Reader& file, const std::string& path, Matrix& matrix) {
  const std::vector<double> values = file.doubles(path);
  if (values.size() != static_cast<std::size_t>(matrix.size())) throw Hdf5Error(path + " has another size");
  std::copy(values.begin(), values.end(), matrix.data());
}

template <class Part>
void write_solution(Hdf5Writer& file, const std::string& group, const Part& part) {
  file.write(group + "/converged", part.solver.converged ? 1 : 0);
  file.write(group + "/reason", part.solver.reason);
  file.write(group + "/iterations", std::span<const int>(part.solver.iterations));
  file.write(group + "/residual", std::span<const double>(part.solver.residual));
  file.write(group + "/checks", std::vector<double>{part.checks.hill_mandel, part.checks.asymmetry});
  file.write(group + "/memory", static_cast<double>(part.memory));
}

template <class Part>
void read_solution(const Hdf5Reader& file, const std::string& group, Part& part) {
  part.solver.converged = file.integer(group + "/converged") != 0;
  part.solver.reason = file.text(group + "/reason");
  const std::vector<int> iterations = file.integers(group + "/iterations");
  const std::vector<double> residual = file.doubles(group + "/residual"),
                            checks = file.doubles(group + "/checks");
  if (iterations.size() != solid::loads || residual.size() != solid::loads || checks.size() != 2)
    throw Hdf5Error(group + " has another number of load cases");
  std::copy(iterations.begin(), iterations.end(), part.solver.iterations.begin());
  std::copy(residual.begin(), residual.end(), part.solver.residual.begin());
  part.checks = {checks[0], checks[1]};
  part.memory = static_cast<std::size_t>(file.number(group + "/memory"));
}

void write_vectors(Hdf5Writer& file, const std::string& path, const std::vector<solid::Vector6>& vectors) {
  std::vector<double> flat;
  for (const solid::Vector6& v : vectors) flat.insert(flat.end(), v.data(), v.data() + v.size());
  file.write(path + "/count", static_cast<int>(vectors.size()));
  if (!flat.empty()) file.write(path + "/values", flat);
}

std::vector<solid::Vector6> read_vectors(const Hdf5Reader& file, const std::string& path) {
  std::vector<solid::Vector6> vectors(static_cast<std::size_t>(file.integer(path + "/count")));
  if (vectors.empty()) return vectors;
  const std::vector<double> flat = file.doubles(path + "/values");
  if (flat.size() != 6 * vectors.size()) throw Hdf5Error(path + " has another size");
  for (std::size_t k = 0; k < vectors.size(); ++k) std::copy_n(flat.data() + 6 * k, 6, vectors[k].data());
  return vectors;
}

template <class Causes>
void read_causes(const Hdf5Reader& file, const std::string& path, Causes& causes) {
  const std::vector<solid::Vector6> vectors = read_vectors(file, path);
  if (vectors.size() != causes.size()) throw Hdf5Error(path + " has another number of causes");
  std::copy(vectors.begin(), vectors.end(), causes.begin());
}

}  // namespace

std::string bytes_of(const solid::SolidResult& result, const std::string& key) {
  Hdf5Writer file;
  file.write("/key", key);
  file.write("/kind", "solid");
  file.write("/voxels", std::span<const int>(result.voxels));
  file.write("/thickness", result.thickness);
  file.write("/tow_share", result.tow_share);
  file.write("/different_voxels", static_cast<double>(result.different_voxels));
  file.write("/balanced", result.balanced ? 1 : 0);
  if (result.tow) {
    std::vector<double> constants;
    for (const solid::TransverseIsotropy& t : *result.tow)
      constants.insert(constants.end(), {t.axial_modulus, t.transverse_modulus, t.axial_shear,
                                         t.transverse_shear, t.axial_poisson});
    file.write("/tow", constants);
  }
  if (result.plate) {
    write_solution(file, "/plate", *result.plate);
    write_matrix(file, "/plate/all", result.plate->all);
    write_matrix(file, "/plate/upper", result.plate->upper);
    write_vectors(file, "/plate/held", result.plate->held);
  }
  if (result.stack) {
    write_solution(file, "/stack", *result.stack);
    write_matrix(file, "/stack/stiffness", result.stack->stiffness);
    write_matrix(file, "/stack/voigt", result.stack->voigt);
    write_matrix(file, "/stack/reuss", result.stack->reuss);
    write_vectors(file, "/stack/held", result.stack->held);
  }
  if (result.laminate) {
    const solid::LaminateSolid& l = *result.laminate;
    file.write("/laminate/numbers", std::vector<double>{static_cast<double>(l.plies), l.thickness, l.swelling,
                                                        l.fibre_fraction, l.tow_share});
    file.write("/laminate/converged", l.converged ? 1 : 0);
    write_matrix(file, "/laminate/plate", l.plate);
    write_matrix(file, "/laminate/apart", l.apart);
  }
  file.write("/sheared/count", static_cast<int>(result.sheared.size()));
  for (std::size_t k = 0; k < result.sheared.size(); ++k) {
    const solid::ShearedSolid& s = result.sheared[k];
    const std::string group = fmt::format("/sheared/{:06d}", k);
    file.write(group + "/numbers", std::vector<double>{s.shear_angle, s.thickness, s.fibre_fraction});
    file.write(group + "/converged", s.converged ? 1 : 0);
    write_matrix(file, group + "/plate", s.plate);
    write_matrix(file, group + "/stack", s.stack);
    write_vectors(file, group + "/plate_held", {s.plate_held.begin(), s.plate_held.end()});
    write_vectors(file, group + "/stack_held", {s.stack_held.begin(), s.stack_held.end()});
  }
  return file.finish();
}

solid::SolidResult read_solid_result(const Hdf5Reader& file) {
  if (file.text("/kind") != "solid") throw Hdf5Error("is no result of the stage solid");
  solid::SolidResult result;
  const std::vector<int> voxels = file.integers("/voxels");
  if (voxels.size() != 3) throw Hdf5Error("/voxels has another size");
  std::copy(voxels.begin(), voxels.end(), result.voxels.begin());
  result.thickness = file.number("/thickness");
  result.tow_share = file.number("/tow_share");
  result.balanced = file.integer("/balanced") != 0;
  result.different_voxels = static_cast<std::size_t>(file.number("/different_voxels"));
  if (file.has("/tow")) {
    const std::vector<double> t = file.doubles("/tow");
    if (t.size() != 10) throw Hdf5Error("/tow has another size");
    result.tow = {solid::TransverseIsotropy{t[0], t[1], t[2], t[3], t[4]},
                  solid::TransverseIsotropy{t[5], t[6], t[7], t[8], t[9]}};
  }
  if (file.has("/plate")) {
    solid::PlateStiffness& plate = result.plate.emplace();
    read_solution(file, "/plate", plate);
    read_matrix(file, "/plate/all", plate.all);
    read_matrix(file, "/plate/upper", plate.upper);
    plate.held = read_vectors(file, "/plate/held");
    plate.set_parts();
  }
  if (file.has("/stack")) {
    solid::PeriodicStiffness& stack = result.stack.emplace();
    read_solution(file, "/stack", stack);
    read_matrix(file, "/stack/stiffness", stack.stiffness);
    read_matrix(file, "/stack/voigt", stack.voigt);
    read_matrix(file, "/stack/reuss", stack.reuss);
    stack.held = read_vectors(file, "/stack/held");
  }
  if (file.has("/laminate")) {
    solid::LaminateSolid& l = result.laminate.emplace();
    const std::vector<double> numbers = file.doubles("/laminate/numbers");
    if (numbers.size() != 5) throw Hdf5Error("/laminate/numbers has another size");
    l.plies = static_cast<int>(numbers[0]);
    l.thickness = numbers[1];
    l.swelling = numbers[2];
    l.fibre_fraction = numbers[3];
    l.tow_share = numbers[4];
    l.converged = file.integer("/laminate/converged") != 0;
    read_matrix(file, "/laminate/plate", l.plate);
    read_matrix(file, "/laminate/apart", l.apart);
  }
  result.sheared.resize(static_cast<std::size_t>(file.integer("/sheared/count")));
  for (std::size_t k = 0; k < result.sheared.size(); ++k) {
    solid::ShearedSolid& s = result.sheared[k];
    const std::string group = fmt::format("/sheared/{:06d}", k);
    const std::vector<double> numbers = file.doubles(group + "/numbers");
    if (numbers.size() != 3) throw Hdf5Error(group + "/numbers has another size");
    s.shear_angle = numbers[0];
    s.thickness = numbers[1];
    s.fibre_fraction = numbers[2];
    s.converged = file.integer(group + "/converged") != 0;
    read_matrix(file, group + "/plate", s.plate);
    read_matrix(file, group + "/stack", s.stack);
    read_causes(file, group + "/plate_held", s.plate_held);
    read_causes(file, group + "/stack_held", s.stack_held);
  }
  result.balance = solid::balance_of(result);
  return result;
}

}  // namespace heddle::pipeline
