#include "pipeline/discover/shape.h"

#include <Eigen/Eigenvalues>
#include <algorithm>
#include <array>
#include <cmath>
#include <functional>
#include <map>
#include <numbers>

#include "pipeline/discover/coordinates.h"

namespace heddle::discover {

namespace {

constexpr std::array amplitudes{0.02, 0.05, 0.1, 0.2};
constexpr std::array lengths{0.2, 0.6};

/// Columns whose products make the kernel, as many as carry it to 1e-4. Observations that share their
/// coordinates share a row, so that only the different ones are decomposed.
Eigen::MatrixXd root_of(const std::function<double(Eigen::Index, Eigen::Index)>& kernel,
                        const std::vector<const Eigen::VectorXd*>& coordinates, Eigen::Index size) {
  std::map<std::vector<long>, Eigen::Index> place;
  std::vector<Eigen::Index> first, level(static_cast<std::size_t>(size));
  for (Eigen::Index i = 0; i < size; ++i) {
    std::vector<long> key;
    for (const Eigen::VectorXd* values : coordinates) key.push_back(std::lround(200.0 * (*values)[i]));
    const auto [at, fresh] = place.try_emplace(key, std::ssize(first));
    if (fresh) first.push_back(i);
    level[static_cast<std::size_t>(i)] = at->second;
  }
  const auto count = std::ssize(first);
  Eigen::MatrixXd matrix(count, count);
  for (Eigen::Index a = 0; a < count; ++a)
    for (Eigen::Index b = 0; b < count; ++b)
      matrix(a, b) = kernel(first[static_cast<std::size_t>(a)], first[static_cast<std::size_t>(b)]);
  const Eigen::SelfAdjointEigenSolver<Eigen::MatrixXd> eigen(matrix);
  Eigen::Index kept = 0;
  while (kept < count && eigen.eigenvalues()[count - 1 - kept] > 1e-4 * eigen.eigenvalues()[count - 1])
    ++kept;
  Eigen::MatrixXd root(size, kept);
  for (Eigen::Index i = 0; i < size; ++i)
    for (Eigen::Index k = 0; k < kept; ++k)
      root(i, k) = eigen.eigenvectors()(level[static_cast<std::size_t>(i)], count - 1 - k) *
                   std::sqrt(eigen.eigenvalues()[count - 1 - k]);
  return root;
}

/// A kernel of unit amplitude as columns, over some coordinates.
struct Kernel {
  std::string over;
  int factors = 1;
  double length = 0.0;
  Eigen::MatrixXd root;
};

std::vector<Kernel> kernels_of(const std::vector<CouponCell>& cells, Eigen::Index size, double pitch) {
  const std::vector<Coordinate> coordinates = coordinates_of(cells);
  std::vector<Kernel> kernels;
  for (const Coordinate& c : coordinates)
    for (const double length : lengths)
      kernels.push_back(
          {c.name, 1, length,
           root_of([&](auto i, auto j) { return gaussian(c.at[i] - c.at[j], length); }, {&c.at}, size)});
  for (std::size_t a = 0; a < coordinates.size(); ++a)
    for (std::size_t b = a + 1; b < coordinates.size(); ++b) {
      const Eigen::VectorXd &x = coordinates[a].at, &y = coordinates[b].at;
      const double length = lengths.back();
      kernels.push_back(
          {coordinates[a].name + " x " + coordinates[b].name, 2, length,
           root_of(
               [&](auto i, auto j) { return gaussian(x[i] - x[j], length) * gaussian(y[i] - y[j], length); },
               {&x, &y}, size)});
    }
  if (pitch > 0.0) {
    Kernel ripple{"tow pitch", 1, pitch, Eigen::MatrixXd(size, 2)};
    const Eigen::VectorXd phase = of_points(cells, [&](const CouponCell&, const CouponPoint& point) {
      return 2.0 * std::numbers::pi * point.slip / pitch;
    });
    ripple.root << phase.array().cos().matrix(), phase.array().sin().matrix();
    kernels.push_back(std::move(ripple));
  }
  return kernels;
}

}  // namespace

std::vector<Shape> shapes_of(const std::vector<CouponCell>& cells, const MapFit& fit, double pitch) {
  const Whitened& data = *fit.data;
  const BesideBaseline beside(fit.jacobian);
  const Eigen::VectorXd gap = -beside.gap_of(fit);  // measured less model
  std::map<std::string, std::vector<Shape>> found;
  for (const Kernel& kernel : kernels_of(cells, data.size(), pitch)) {
    const Eigen::MatrixXd seen = beside(data(kernel.root));
    const Eigen::SelfAdjointEigenSolver<Eigen::MatrixXd> eigen(seen.transpose() * seen);
    const Eigen::VectorXd along = eigen.eigenvectors().transpose() * (seen.transpose() * gap);
    for (const double amplitude : amplitudes) {
      const double square = amplitude * amplitude;
      const Eigen::ArrayXd weight = 1.0 + square * eigen.eigenvalues().array().max(0.0);
      Shape shape;
      shape.over = kernel.over;
      shape.factors = kernel.factors;
      shape.amplitude = amplitude;
      shape.length = kernel.length;
      shape.log_evidence = 0.5 * (square * along.array().square() / weight).sum() - 0.5 * weight.log().sum();
      const Eigen::MatrixXd modes = kernel.root * eigen.eigenvectors();
      shape.mean = modes * (square * along.array() / weight).matrix();
      shape.sd = (modes.array().square().rowwise() * (square / weight).transpose()).rowwise().sum().sqrt();
      found[kernel.over].push_back(std::move(shape));
    }
  }
  std::vector<Shape> shapes;
  for (auto& [over, grid] : found) {
    const auto best = std::ranges::max_element(grid, {}, &Shape::log_evidence);
    double sum = 0.0;
    for (const Shape& shape : grid) sum += std::exp(shape.log_evidence - best->log_evidence);
    const double mean = best->log_evidence + std::log(sum / static_cast<double>(grid.size()));
    shapes.push_back(std::move(*best));
    shapes.back().log_evidence = mean;
  }
  std::ranges::stable_sort(shapes, std::greater{}, &Shape::log_evidence);
  return shapes;
}

std::vector<ShapePoint> curve_of(const Shape& shape, const std::vector<CouponCell>& cells) {
  struct Sum {
    double at = 0.0, gap = 0.0, sd = 0.0, force = 0.0;
    int count = 0;
  };
  const std::string over = shape.over.substr(0, shape.over.find(" x "));
  const auto factor = std::ranges::find_if(factors(), [&](const Factor& f) { return over == f.name; });
  std::map<long, Sum> levels;
  Eigen::Index row = 0;
  for (const CouponCell& cell : cells)
    for (const CouponPoint& point : cell.points) {
      const double at = factor == factors().end() ? 1e3 * point.slip : factor->shown(cell);  // slip in mm
      Sum& sum = levels[std::lround(50.0 * std::log(std::max(at, 1e-3)))];
      sum.at += at;
      sum.gap += shape.mean[row];
      sum.sd += shape.sd[row];
      sum.force += std::exp(point.log_force);
      ++sum.count;
      ++row;
    }
  std::vector<ShapePoint> curve;
  for (const auto& [key, sum] : levels) {
    const double n = sum.count, gap = sum.gap / n, sd = sum.sd / n, force = sum.force / n;
    curve.push_back(
        {over, sum.at / n, gap, gap - 1.96 * sd, gap + 1.96 * sd, force * (1.0 - std::exp(-gap))});
  }
  return curve;
}

}  // namespace heddle::discover
