#pragma once

#include <memory>
#include <vector>

namespace heddle::mesoscale::solid {

/// Discrete Fourier transforms of `width` complex signals that lie side by side: number n of signal s stands
/// at n stride + s. In place, without a factor: there and back multiplies by the length.
///
/// FFTW does the work. Its plans are estimated, not measured, so that the same numbers come out of every run;
/// estimated plans are slow beyond its largest straight-line codes (192: 3.7 ns a number, measured 1.5), so
/// long transforms are taken apart here, n = n1 n2, and their waves left in the order k1 + n1 k2 at n2 k1 +
/// k2. Who works on each wave by itself does not mind.
class PencilFft {
 public:
  PencilFft(int length, int width, int stride);
  ~PencilFft();
  PencilFft(PencilFft&&) noexcept;
  PencilFft& operator=(PencilFft&&) noexcept;

  /// @param data  real and imaginary parts in turn, length x stride of them, on a 16-byte border; what stands
  ///              between width and stride may be overwritten. Safe from any number of threads
  void forward(double* data) const;   ///< e^(-2 pi i k n / length)
  void backward(double* data) const;  ///< e^(+2 pi i k n / length)

  /// Which wave k stands at each place after `forward`; the first is 0.
  const std::vector<int>& waves() const;

 private:
  struct Plans;
  std::unique_ptr<Plans> plans_;
};

}  // namespace heddle::mesoscale::solid
