#include "engine/fourier/real_fft.hpp"

#include "engine/fourier/fftw.hpp"

#include <cstddef>
#include <new>
#include <string>
#include <vector>

namespace touchtrial::engine {

template <typename Real>
struct RealFft<Real>::State {
  State(int height, int width)
      : plane(static_cast<std::size_t>(height) * static_cast<std::size_t>(width)),
        spectrum(static_cast<std::size_t>(height) * static_cast<std::size_t>(width / 2 + 1)),
        plans(std::to_string(height) + 'x' + std::to_string(width), plane.span().size(), [=, this] {
          auto* const coefficients = as_fftw(spectrum.data());
          return std::vector{Fftw<Real>::plan_real_forward(height, width, plane.data(),
                                                           coefficients, kPlannerFlags),
                             Fftw<Real>::plan_real_inverse(height, width, coefficients,
                                                           plane.data(), kPlannerFlags)};
        }) {}

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
  Fftw<Real>::real_forward(state_->plans[0], state_->plane.data(),
                           as_fftw(state_->spectrum.data()));
}

template <typename Real>
void RealFft<Real>::inverse() {
  Fftw<Real>::real_inverse(state_->plans[1], as_fftw(state_->spectrum.data()),
                           state_->plane.data());
}

// These replace FFTW's functions of the same names, which FFTW calls when it is out of memory and
// which would terminate the program.
extern "C" [[gnu::visibility("default")]] void fftw_assertion_failed(const char* /*what*/,
                                                                     int /*line*/,
                                                                     const char* /*file*/) {
  out_of_memory_flag() = true;
  throw std::bad_alloc();
}
extern "C" [[gnu::visibility("default")]] void fftwf_assertion_failed(const char* /*what*/,
                                                                      int /*line*/,
                                                                      const char* /*file*/) {
  out_of_memory_flag() = true;
  throw std::bad_alloc();
}

template class RealFft<float>;
template class RealFft<double>;

}  // namespace touchtrial::engine
