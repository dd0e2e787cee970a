#include "mesoscale/reynolds.h"

#include <algorithm>
#include <cmath>
#include <memory>

#include <fmt/format.h>
#include <tbb/parallel_for.h>
#include <Eigen/LU>

#include "core/problem.h"
#include "core/sparse_solver.h"

namespace heddle::mesoscale {

namespace {

using Eigen::Matrix2d;
using Eigen::Vector2d;
using Eigen::Vector4d;

constexpr double low_point = 0.211324865405187118, high_point = 0.788675134594812882;

// Nodes of an element, anticlockwise from its corner.
std::array<int, 4> corners(const FilmMap& map, int element) {
  const int j = element % map.columns, i = element / map.columns;
  const int right = (j + 1) % map.columns, up = (i + 1) % map.rows;
  return {i * map.columns + j, i * map.columns + right, up * map.columns + right, up * map.columns + j};
}

Matrix2d element_edges(const FilmMap& map) {
  Matrix2d edges;
  edges << map.first / map.columns, map.second / map.rows;
  return edges;
}

// Gradients of the four shapes at the four Gauss points, in the fabric plane [1/m].
using Gradients = Eigen::Matrix<double, 2, 4>;
std::array<Gradients, 4> shape_gradients(const FilmMap& map) {
  const Matrix2d to_plane = element_edges(map).inverse().transpose();
  std::array<Gradients, 4> result;
  for (std::size_t g = 0; g < 4; ++g) {
    const auto [x, y] = film_points[g];
    Gradients unit;
    unit << -(1 - y), 1 - y, y, -y, -(1 - x), -x, x, 1 - x;
    result[g] = to_plane * unit;
  }
  return result;
}

struct ElementTerms {
  double energy = 0.0, size = 0.0;  // size: sum of absolute energies, to judge rounding by
  Vector4d residual = Vector4d::Zero();
  Eigen::Matrix4d stiffness = Eigen::Matrix4d::Zero();
};

class FilmSystem {
 public:
  FilmSystem(const FilmMap& map, const FilmFluid& fluid, const Vector2d& sliding)
      : map_(map),
        fluid_(fluid),
        sliding_(sliding),
        gradients_(shape_gradients(map)),
        weight_(0.25 * map.element_area()) {
    number_unknowns();
    for (int e = 0; e < map_.elements(); ++e)
      if (touches_resin(e)) live_.push_back(e);
    terms_.resize(live_.size());
    stress_.resize(live_.size());
    for (std::size_t k = 0; k < live_.size(); ++k)
      for (std::size_t g = 0; g < 4; ++g) stress_[k][g] = drag_stress(fluid_, gap(k, g), sliding_);
    build_pattern();
  }

  int unknowns() const { return static_cast<int>(node_.size()); }
  const std::vector<int>& nodes() const { return node_; }
  const std::vector<double>& residual() const { return residual_; }
  double diagonal(int unknown) const { return stiffness_[diagonal_[unknown]]; }
  double energy() const { return energy_; }
  double rounding() const { return 1e-13 * size_; }

  /// Energy, its slope (div q over each node's patch) and stiffness at nodal pressures.
  void evaluate(const std::vector<double>& pressure);
  /// Newton's step with the pressures of `held` unknowns going to zero; false if not positive definite.
  bool step(const std::vector<double>& unknown_pressure, const std::vector<uint8_t>& held,
            std::vector<double>& result);
  void summarise(const std::vector<double>& pressure, FilmPressure& result) const;

 private:
  double gap(std::size_t live, std::size_t g) const { return map_.gap[live_[live]][g]; }
  bool touches_resin(int element) const {
    for (const int node : corners(map_, element))
      if (map_.wet[node]) return true;
    return false;
  }
  void number_unknowns();
  void build_pattern();
  void add_ties(const std::vector<double>& pressure);
  Vector4d corner_values(std::size_t live, const std::vector<double>& pressure) const;
  ElementTerms element_terms(std::size_t live, const Vector4d& pressure);

  const FilmMap& map_;
  const FilmFluid& fluid_;
  Vector2d sliding_;
  std::array<Gradients, 4> gradients_;
  double weight_;                                // area of a Gauss point
  std::vector<int> unknown_, node_;              // of each node, -1 in the air; of each unknown
  std::vector<int> live_;                        // elements with a wet corner
  std::vector<ElementTerms> terms_;              // of each live element
  std::vector<std::array<Vector2d, 4>> stress_;  // T last found, to start the next search from
  std::vector<std::array<int, 16>>
      place_;  // of each live element's entries in the stiffness; -1 = not stored
  std::vector<std::size_t> diagonal_;
  std::unique_ptr<SparseSolver> solver_;
  std::vector<double> residual_, stiffness_;
  std::vector<double> source_;  // int N div q of every node, those in the air too
  std::vector<double> tie_;     // of each unknown to zero pressure: energy tie p^2 / 2
  double energy_ = 0.0, size_ = 0.0;
};

void FilmSystem::number_unknowns() {
  unknown_.assign(map_.wet.size(), -1);
  for (std::size_t n = 0; n < map_.wet.size(); ++n)
    if (map_.wet[n]) {
      unknown_[n] = static_cast<int>(node_.size());
      node_.push_back(static_cast<int>(n));
    }
}

void FilmSystem::build_pattern() {
  std::vector<std::vector<int>> below(node_.size());  // rows of each column, at and below the diagonal
  for (const int element : live_) {
    const auto at = corners(map_, element);
    for (const int a : at)
      for (const int b : at) {
        const int row = unknown_[a], column = unknown_[b];
        if (column >= 0 && row >= column) below[column].push_back(row);
      }
  }
  SymmetricPattern pattern;
  pattern.size = unknowns();
  pattern.column_start.push_back(0);
  for (auto& rows : below) {
    std::sort(rows.begin(), rows.end());
    rows.erase(std::unique(rows.begin(), rows.end()), rows.end());
    diagonal_.push_back(pattern.row.size());
    pattern.row.insert(pattern.row.end(), rows.begin(), rows.end());
    pattern.column_start.push_back(static_cast<int>(pattern.row.size()));
  }
  place_.resize(live_.size());
  for (std::size_t k = 0; k < live_.size(); ++k) {
    const auto at = corners(map_, live_[k]);
    for (std::size_t a = 0; a < 4; ++a)
      for (std::size_t b = 0; b < 4; ++b) {
        const int row = unknown_[at[a]];
        const int column = unknown_[at[b]];
        int& place = place_[k][4 * a + b] = -1;
        if (column < 0 || row < column) continue;
        const auto begin = pattern.row.begin() + pattern.column_start[column];
        const auto end = pattern.row.begin() + pattern.column_start[column + 1];
        place = static_cast<int>(std::lower_bound(begin, end, row) - pattern.row.begin());
      }
  }
  stiffness_.assign(pattern.row.size(), 0.0);
  if (pattern.size > 0) solver_ = std::make_unique<SparseSolver>(std::move(pattern));
}

Vector4d FilmSystem::corner_values(std::size_t live, const std::vector<double>& pressure) const {
  const auto at = corners(map_, live_[live]);
  Vector4d values;
  for (int a = 0; a < 4; ++a) values[a] = pressure[static_cast<std::size_t>(at[a])];
  return values;
}

ElementTerms FilmSystem::element_terms(std::size_t live, const Vector4d& pressure) {
  ElementTerms sum;
  for (std::size_t g = 0; g < 4; ++g) {
    const Gradients& shape = gradients_[g];
    const Vector2d gradient = shape * pressure;
    const FilmFlow flow = film_flow(fluid_, gap(live, g), sliding_, gradient, stress_[live][g]);
    stress_[live][g] = flow.middle_stress;
    const Vector2d carried = 0.5 * gap(live, g) * sliding_;
    sum.energy += weight_ * (flow.potential - carried.dot(gradient));
    sum.size += weight_ * (std::abs(flow.potential) + std::abs(carried.dot(gradient)));
    sum.residual += weight_ * (shape.transpose() * (flow.pressure_flux - carried));
    sum.stiffness += weight_ * (shape.transpose() * flow.conductance * shape);
  }
  return sum;
}

void FilmSystem::evaluate(const std::vector<double>& pressure) {
  // Elements side by side, sums in their order: the same bytes on any number of threads.
  tbb::parallel_for(std::size_t{0}, live_.size(),
                    [&](std::size_t k) { terms_[k] = element_terms(k, corner_values(k, pressure)); });
  source_.assign(map_.wet.size(), 0.0);
  std::fill(stiffness_.begin(), stiffness_.end(), 0.0);
  energy_ = size_ = 0.0;
  for (std::size_t k = 0; k < live_.size(); ++k) {
    const ElementTerms& terms = terms_[k];
    energy_ += terms.energy;
    size_ += terms.size;
    const auto at = corners(map_, live_[k]);
    for (std::size_t a = 0; a < 4; ++a) {
      source_[at[a]] += terms.residual[static_cast<int>(a)];
      for (std::size_t b = 0; b < 4; ++b)
        if (place_[k][4 * a + b] >= 0)
          stiffness_[static_cast<std::size_t>(place_[k][4 * a + b])] +=
              terms.stiffness(static_cast<int>(a), static_cast<int>(b));
    }
  }
  residual_.resize(node_.size());
  for (std::size_t u = 0; u < node_.size(); ++u) residual_[u] = source_[node_[u]];
  add_ties(pressure);
  if (!std::isfinite(energy_))
    throw NumericalError("film: the energy of the pressure is not finite (a gap or a pressure is not)");
}

void FilmSystem::add_ties(const std::vector<double>& pressure) {
  if (map_.openness.empty()) return;
  if (tie_.empty())  // as stiff as the film itself half way out, rigid at the end
    for (std::size_t u = 0; u < node_.size(); ++u) {
      const double out = map_.openness[node_[u]];
      tie_.push_back(stiffness_[diagonal_[u]] * out / (1.0 - out));
    }
  for (std::size_t u = 0; u < node_.size(); ++u) {
    const double p = pressure[node_[u]];
    energy_ += 0.5 * tie_[u] * p * p;
    size_ += 0.5 * tie_[u] * p * p;
    residual_[u] += tie_[u] * p;
    stiffness_[diagonal_[u]] += tie_[u];
  }
}

// K_II dp_I = -R_I - K_IA dp_A with dp_A = -p_A.
bool FilmSystem::step(const std::vector<double>& unknown_pressure, const std::vector<uint8_t>& held,
                      std::vector<double>& result) {
  const SymmetricPattern& pattern = solver_->pattern();
  std::span<double> values = solver_->values();
  result.resize(node_.size());
  for (std::size_t u = 0; u < node_.size(); ++u) result[u] = held[u] ? -unknown_pressure[u] : -residual_[u];
  for (std::size_t column = 0; column < node_.size(); ++column) {
    const auto begin = static_cast<std::size_t>(pattern.column_start[column]);
    const auto end = static_cast<std::size_t>(pattern.column_start[column + 1]);
    for (std::size_t k = begin; k < end; ++k) {
      const auto row = static_cast<std::size_t>(pattern.row[k]);
      values[k] = stiffness_[k];
      if (row == column) {
        if (held[column]) values[k] = 1.0;
        continue;
      }
      if (!held[row] && !held[column]) continue;
      if (held[column] && !held[row]) result[row] += stiffness_[k] * unknown_pressure[column];
      if (held[row] && !held[column]) result[column] += stiffness_[k] * unknown_pressure[row];
      values[k] = 0.0;
    }
  }
  if (!solver_->factorise()) return false;
  solver_->solve(result);
  return true;
}

void FilmSystem::summarise(const std::vector<double>& pressure, FilmPressure& result) const {
  double sum = 0.0;
  for (const double p : pressure) sum += p;
  result.load = sum / static_cast<double>(pressure.size());
  const double share = 0.25 / map_.elements();
  for (std::size_t k = 0; k < live_.size(); ++k) {
    const Vector4d corner = corner_values(k, pressure);
    const auto& resin = map_.resin[live_[k]];
    for (std::size_t g = 0; g < 4; ++g) {
      if (!resin[g]) continue;
      const Vector2d gradient = gradients_[g] * corner;
      const FilmFlow flow = film_flow(fluid_, gap(k, g), sliding_, gradient, stress_[k][g]);
      const Vector2d traction = flow.middle_stress + 0.5 * gap(k, g) * gradient;
      result.traction += share * traction;
      result.dissipation += share * (flow.middle_stress.dot(sliding_) + gradient.dot(flow.pressure_flux));
      result.resin_share += share;
      if (corner.cwiseAbs().maxCoeff() > 0.0) continue;
      result.ruptured_traction += share * traction;
      result.ruptured_share += share;
    }
  }
  const double area = map_.element_area() * map_.elements();
  for (std::size_t n = 0; n < source_.size(); ++n) {
    const double source = source_[n] / area;
    if (source < 0.0)
      result.outflow -= source;
    else
      (map_.wet[n] ? result.voids : result.intake) += source;
  }
}

void require_an_opening(const FilmMap& map) {
  if (std::find(map.wet.begin(), map.wet.end(), uint8_t{0}) != map.wet.end()) return;
  throw InputError(
      {{"film.fill.closed"_rule, "fill", "",
        "must leave some of the gap to the air: a closed film carries any load", "Lower the fill level."}});
}

// Semismooth Newton on min(p, R / K_diagonal) = 0, safeguarded by the energy.
class ActiveSet {
 public:
  ActiveSet(FilmSystem& system, const ReynoldsOptions& options) : system_(system), options_(options) {}

  void solve(std::vector<double>& pressure, FilmPressure& result) {
    system_.evaluate(std::vector<double>(pressure.size(), 0.0));
    scale_ = 0.0;
    for (const double r : system_.residual()) scale_ = std::max(scale_, std::abs(r));
    if (start_missing_) guess(pressure);
    system_.evaluate(pressure);
    for (result.iterations = 0;; ++result.iterations) {
      result.residual = scale_ > 0.0 ? violation(pressure) / scale_ : 0.0;
      result.converged = result.residual <= options_.tolerance;
      if (result.converged) return;
      if (result.iterations == options_.iterations) {
        result.reason = fmt::format("{} iterations were not enough", options_.iterations);
        return;
      }
      if (!advance(pressure)) {
        result.reason = "no step lowers the energy further";
        return;
      }
    }
  }
  void start_from_unbroken() { start_missing_ = true; }

 private:
  bool may_break() const { return options_.rupture == Rupture::at_zero_pressure; }

  double violation(const std::vector<double>& pressure) const {
    double worst = 0.0;
    for (int u = 0; u < system_.unknowns(); ++u) {
      const double r = system_.residual()[u];
      const bool broken = may_break() && at(pressure, u) <= 0.0;
      worst = std::max(worst, broken ? -r : std::abs(r));
    }
    return worst;
  }
  double at(const std::vector<double>& pressure, int u) const {
    return pressure[static_cast<std::size_t>(system_.nodes()[u])];
  }
  std::vector<double> gather(const std::vector<double>& pressure) const {
    std::vector<double> values;
    for (const int node : system_.nodes()) values.push_back(pressure[node]);
    return values;
  }
  std::vector<double> moved(const std::vector<double>& pressure, const std::vector<double>& step,
                            double share) const {
    std::vector<double> result = pressure;
    for (std::size_t u = 0; u < step.size(); ++u) {
      double& p = result[static_cast<std::size_t>(system_.nodes()[u])];
      p += share * step[u];
      if (may_break()) p = std::max(p, 0.0);
    }
    return result;
  }

  // The unbroken film to first order, cut off at zero: its high places are those of the broken film too.
  void guess(std::vector<double>& pressure) {
    const std::vector<uint8_t> none(system_.nodes().size(), 0);
    if (system_.step(gather(pressure), none, step_)) pressure = moved(pressure, step_, 1.0);
  }

  bool advance(std::vector<double>& pressure) {
    const std::vector<double> value = gather(pressure);
    const std::vector<double> residual = system_.residual();
    std::vector<uint8_t> held(value.size(), 0);
    if (may_break())
      for (int u = 0; u < system_.unknowns(); ++u) {
        const auto k = u;
        held[k] = residual[k] > 0.0 && value[k] - residual[k] / system_.diagonal(u) <= 0.0;
      }
    if (!system_.step(value, held, step_)) return false;
    const double energy = system_.energy();
    for (double share = 1.0; share > 1e-10; share *= 0.5) {
      const std::vector<double> trial = moved(pressure, step_, share);
      double slope = 0.0;
      for (std::size_t u = 0; u < value.size(); ++u)
        slope += residual[u] * (trial[static_cast<std::size_t>(system_.nodes()[u])] - value[u]);
      system_.evaluate(trial);
      if (system_.energy() - energy > 1e-4 * slope + system_.rounding()) continue;
      pressure = trial;
      return true;
    }
    system_.evaluate(pressure);
    return false;
  }

  FilmSystem& system_;
  const ReynoldsOptions& options_;
  double scale_ = 0.0;
  bool start_missing_ = false;
  std::vector<double> step_;
};

}  // namespace

const std::array<std::array<double, 2>, 4> film_points{
    {{low_point, low_point}, {high_point, low_point}, {high_point, high_point}, {low_point, high_point}}};

double FilmMap::element_area() const {
  return std::abs(first.x() * second.y() - first.y() * second.x()) / elements();
}

FilmMap film_map(int columns, int rows, const Vector2d& first, const Vector2d& second,
                 const std::function<double(double, double)>& gap, const std::function<bool(int, int)>& wet) {
  FilmMap map{columns, rows, first, second, {}, {}, {}, {}};
  for (int i = 0; i < rows; ++i)
    for (int j = 0; j < columns; ++j) {
      map.wet.push_back(wet(j, i) ? 1 : 0);
      auto& here = map.gap.emplace_back();
      for (std::size_t g = 0; g < 4; ++g)
        here[g] = gap((j + film_points[g][0]) / columns, (i + film_points[g][1]) / rows);
    }
  for (int e = 0; e < map.elements(); ++e) {
    uint8_t any = 0;
    for (const int node : corners(map, e)) any |= map.wet[node];
    map.resin.push_back({any, any, any, any});
  }
  return map;
}

FilmPressure solve_reynolds(const FilmMap& map, const FilmFluid& fluid, const Vector2d& sliding,
                            const ReynoldsOptions& options, std::vector<double> start) {
  require_an_opening(map);
  FilmPressure result;
  FilmSystem system(map, fluid, sliding);
  ActiveSet search(system, options);
  if (start.empty()) search.start_from_unbroken();
  start.resize(map.wet.size(), 0.0);
  for (std::size_t n = 0; n < start.size(); ++n)
    if (!map.wet[n]) start[n] = 0.0;
  if (system.unknowns() > 0)
    search.solve(start, result);
  else
    result.converged = true;
  result.pressure = std::move(start);
  system.summarise(result.pressure, result);
  return result;
}

std::vector<double> refine_pressure(const FilmMap& coarse, const std::vector<double>& pressure) {
  const int columns = 2 * coarse.columns, rows = 2 * coarse.rows;
  std::vector<double> fine(columns * rows);
  const auto at = [&](int i, int j) {
    return pressure[static_cast<std::size_t>((i % coarse.rows) * coarse.columns + j % coarse.columns)];
  };
  for (int i = 0; i < rows; ++i)
    for (int j = 0; j < columns; ++j) {
      const int k = i / 2, l = j / 2, up = i % 2, right = j % 2;
      fine[static_cast<std::size_t>(i * columns + j)] =
          0.25 * (at(k, l) + at(k + up, l) + at(k, l + right) + at(k + up, l + right));
    }
  return fine;
}

}  // namespace heddle::mesoscale
