#include "engine/fourier/real_fft.hpp"

#include "engine/fourier/fftw.hpp"

#include <cstddef>
#include <string>
#include <vector>

namespace touchtrial::engine {

template <typename Real>
struct RealFft<Real>::State {
  State(int rows, int columns)
      : height(rows),
        width(columns),
        plane(static_cast<std::size_t>(height) * static_cast<std::size_t>(width)),
        spectrum(static_cast<std::size_t>(height) * static_cast<std::size_t>(width / 2 + 1)),
        plans(std::to_string(height) + 'x' + std::to_string(width), height, width, [this] {
          auto* const coefficients = as_fftw(spectrum.data());
          return std::vector{Fftw<Real>::plan_real_forward(height, width, plane.data(),
                                                           coefficients, kPlannerFlags),
                             Fftw<Real>::plan_real_inverse(height, width, coefficients,
                                                           plane.data(), kPlannerFlags)};
        }) {}

  /// Small transforms need next to no memory of their own, and are many.
  void ask_memory() const {
    if (!FftwPlans<Real>::is_small(height, width)) ask_memory_to_execute(height, width);
  }

  int height;
  int width;
  FftwBuffer<Real> plane;
  FftwBuffer<std::complex<Real>> spectrum;
  FftwPlans<Real> plans;  // forward, inverse
};

template <typename Real>
RealFft<Real>::RealFft(int height, int width) : state_(std::make_unique<State>(height, width)) {}

template <typename Real>
RealFft<Real>::~RealFft() = default;

template <typename Real>
std::span<Real> RealFft<Real>::plane() noexcept {
  return state_->plane.span();
}

template <typename Real>
std::span<std::complex<Real>> RealFft<Real>::spectrum() noexcept {
  return state_->spectrum.span();
}

template <typename Real>
void RealFft<Real>::forward() {
  state_->ask_memory();
  Fftw<Real>::real_forward(state_->plans[0], state_->plane.data(),
                           as_fftw(state_->spectrum.data()));
}

template <typename Real>
void RealFft<Real>::inverse() {
  state_->ask_memory();
  Fftw<Real>::real_inverse(state_->plans[1], as_fftw(state_->spectrum.data()),
                           state_->plane.data());
}

template class RealFft<float>;
template class RealFft<double>;

}  // namespace touchtrial::engine
