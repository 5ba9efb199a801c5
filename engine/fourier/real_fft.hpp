/// \file Two-dimensional Fourier transforms of real planes in float or double, by FFTW.
#pragma once

#include <complex>
#include <memory>
#include <span>

namespace touchtrial::engine {

/// A transform of one size with its buffers. Real is float or double. Plans are estimated, never
/// measured, so that the results are the same in every run on a machine. Not thread-safe, but
/// different objects may be created, used and destroyed concurrently.
template <typename Real>
class RealFft {
 public:
  /// \param height,width  samples, >= 1
  /// \throws std::bad_alloc if there is no memory for the buffers
  /// \throws std::invalid_argument if FFTW has no transform of this size
  RealFft(int height, int width);
  ~RealFft();
  RealFft(const RealFft&) = delete;
  RealFft& operator=(const RealFft&) = delete;

  /// height x width samples, row-major.
  [[nodiscard]] std::span<Real> plane() noexcept;
  /// height x (width / 2 + 1) coefficients, row-major; the others follow by conjugate symmetry.
  [[nodiscard]] std::span<std::complex<Real>> spectrum() noexcept;

  /// plane -> spectrum, unscaled; the plane keeps its values.
  /// \throws std::bad_alloc if FFTW is out of memory
  void forward();
  /// spectrum -> plane, unscaled: forward and inverse multiply by height * width. Destroys the
  /// spectrum.
  /// \throws std::bad_alloc if FFTW is out of memory
  void inverse();

 private:
  struct State;
  std::unique_ptr<State> state_;
};

}  // namespace touchtrial::engine
