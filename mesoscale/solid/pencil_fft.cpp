#include "mesoscale/solid/pencil_fft.h"

#include <fftw3.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <mutex>
#include <numbers>
#include <stdexcept>

namespace heddle::mesoscale::solid {

namespace {

// FFTW plans and destroys under one global state; only execution is safe from several threads.
std::mutex& planner() {
  static std::mutex mutex;
  return mutex;
}

fftw_complex* as_complex(double* data) {
  return reinterpret_cast<fftw_complex*>(data);
}

// Lengths for which FFTW has straight-line code in SIMD.
constexpr std::array<int, 20> direct{1, 2, 3, 4, 5, 6, 7, 8, 9, 10, 11, 12, 13, 14, 15, 16, 20, 25, 32, 64};

bool is_direct(int n) {
  return std::find(direct.begin(), direct.end(), n) != direct.end();
}

// The first factor of a length to be taken apart, as near the root as may be; 1: leave it whole.
int first_factor(int length) {
  if (length <= 64) return 1;
  int best = 1;
  for (const int n : direct)
    if (length % n == 0 && is_direct(length / n) && n <= length / n) best = std::max(best, n);
  return best;
}

class Plan {
 public:
  Plan(int length, int width, int stride, int sign, double* scratch) {
    const std::lock_guard lock(planner());
    fftw_complex* data = as_complex(scratch);
    plan_ = fftw_plan_many_dft(1, &length, width, data, nullptr, stride, 1, data, nullptr, stride, 1, sign,
                               FFTW_ESTIMATE);
    if (!plan_) throw std::runtime_error("FFTW gave no plan");
  }
  ~Plan() {
    const std::lock_guard lock(planner());
    fftw_destroy_plan(plan_);
  }
  Plan(const Plan&) = delete;
  Plan& operator=(const Plan&) = delete;

  void execute(double* data) const { fftw_execute_dft(plan_, as_complex(data), as_complex(data)); }

 private:
  fftw_plan plan_;
};

struct Scratch {
  explicit Scratch(std::size_t numbers) : data(fftw_alloc_real(2 * numbers)) {}
  ~Scratch() { fftw_free(data); }
  Scratch(const Scratch&) = delete;
  Scratch& operator=(const Scratch&) = delete;
  double* data;
};

}  // namespace

struct PencilFft::Plans {
  Plans(int length, int signals, int step, const Scratch& scratch)
      : n1(first_factor(length)),
        n2(length / n1),
        width(signals),
        stride(step),
        // All of the second index and the signals lie side by side, what is between them included.
        outer_forward(n1, n2 * step, n2 * step, FFTW_FORWARD, scratch.data),
        outer_backward(n1, n2 * step, n2 * step, FFTW_BACKWARD, scratch.data),
        inner_forward(n2, signals, step, FFTW_FORWARD, scratch.data),
        inner_backward(n2, signals, step, FFTW_BACKWARD, scratch.data) {
    for (int p = 0; p < length; ++p) order.push_back(p / n2 + n1 * (p % n2));
    for (int k1 = 0; k1 < n1; ++k1)
      for (int j2 = 0; j2 < n2; ++j2) {
        const double angle = -2.0 * std::numbers::pi * k1 * j2 / length;
        twiddle.push_back({std::cos(angle), std::sin(angle)});
      }
  }
  Plans(int length, int signals, int step)
      : Plans(length, signals, step,
              Scratch(static_cast<std::size_t>(length) * static_cast<std::size_t>(step))) {}

  // sign +1: the factors between the two passes; -1: their conjugates.
  void twist(double* data, double sign) const {
    for (std::size_t p = static_cast<std::size_t>(n2); p < twiddle.size(); ++p) {
      const double c = twiddle[p][0], s = sign * twiddle[p][1];
      double* row = data + 2 * p * static_cast<std::size_t>(stride);
      for (int i = 0; i < 2 * width; i += 2) {
        const double re = row[i], im = row[i + 1];
        row[i] = c * re - s * im;
        row[i + 1] = c * im + s * re;
      }
    }
  }
  void inner(const Plan& plan, double* data) const {
    const std::size_t step = 2 * static_cast<std::size_t>(n2) * static_cast<std::size_t>(stride);
    for (std::size_t k1 = 0; k1 < static_cast<std::size_t>(n1); ++k1) plan.execute(data + step * k1);
  }

  int n1, n2, width, stride;
  Plan outer_forward, outer_backward, inner_forward, inner_backward;
  std::vector<int> order;
  std::vector<std::array<double, 2>> twiddle;  // [k1][j2]
};

PencilFft::PencilFft(int length, int width, int stride)
    : plans_(std::make_unique<Plans>(length, width, stride)) {}
PencilFft::~PencilFft() = default;
PencilFft::PencilFft(PencilFft&&) noexcept = default;
PencilFft& PencilFft::operator=(PencilFft&&) noexcept = default;

void PencilFft::forward(double* data) const {
  if (plans_->n1 > 1) {
    plans_->outer_forward.execute(data);
    plans_->twist(data, 1.0);
  }
  plans_->inner(plans_->inner_forward, data);
}

void PencilFft::backward(double* data) const {
  plans_->inner(plans_->inner_backward, data);
  if (plans_->n1 > 1) {
    plans_->twist(data, -1.0);
    plans_->outer_backward.execute(data);
  }
}

const std::vector<int>& PencilFft::waves() const {
  return plans_->order;
}

}  // namespace heddle::mesoscale::solid
