#include "engine/fourier/real_fft.hpp"

#include <cstddef>
#include <mutex>
#include <new>
#include <stdexcept>

#include <fftw3.h>

namespace touchtrial {
namespace {

/// The names of FFTW's two libraries, by precision.
template <typename Real>
struct Fftw;

template <>
struct Fftw<double> {
  using Complex = fftw_complex;
  using Plan = fftw_plan;
  static constexpr auto* allocate = &fftw_malloc;
  static constexpr auto* release = &fftw_free;
  static constexpr auto* plan_forward = &fftw_plan_dft_r2c_2d;
  static constexpr auto* plan_inverse = &fftw_plan_dft_c2r_2d;
  static constexpr auto* execute = &fftw_execute;
  static constexpr auto* destroy = &fftw_destroy_plan;
};

template <>
struct Fftw<float> {
  using Complex = fftwf_complex;
  using Plan = fftwf_plan;
  static constexpr auto* allocate = &fftwf_malloc;
  static constexpr auto* release = &fftwf_free;
  static constexpr auto* plan_forward = &fftwf_plan_dft_r2c_2d;
  static constexpr auto* plan_inverse = &fftwf_plan_dft_c2r_2d;
  static constexpr auto* execute = &fftwf_execute;
  static constexpr auto* destroy = &fftwf_destroy_plan;
};

/// FFTW's planner keeps global state: only executing a plan is thread-safe.
std::mutex& planner_mutex() {
  static std::mutex mutex;
  return mutex;
}

/// Memory with the alignment that FFTW's plans count on.
template <typename Real, typename Element>
class FftwBuffer {
 public:
  explicit FftwBuffer(std::size_t size)
      : size_(size),
        elements_(static_cast<Element*>(Fftw<Real>::allocate(size * sizeof(Element)))) {
    if (elements_ == nullptr) throw std::bad_alloc();
  }
  ~FftwBuffer() { Fftw<Real>::release(elements_); }
  FftwBuffer(const FftwBuffer&) = delete;
  FftwBuffer& operator=(const FftwBuffer&) = delete;

  [[nodiscard]] Element* data() const noexcept { return elements_; }
  [[nodiscard]] std::span<Element> span() const noexcept { return {elements_, size_}; }

 private:
  std::size_t size_;
  Element* elements_;
};

}  // namespace

template <typename Real>
struct RealFft<Real>::State {
  State(int height, int width)
      : plane(static_cast<std::size_t>(height) * static_cast<std::size_t>(width)),
        spectrum(static_cast<std::size_t>(height) * static_cast<std::size_t>(width / 2 + 1)) {
    // std::complex<Real> is laid out as FFTW's pair of reals (C++ standard, [complex.numbers]).
    auto* coefficients = reinterpret_cast<typename Fftw<Real>::Complex*>(spectrum.data());
    const std::lock_guard lock(planner_mutex());
    forward = Fftw<Real>::plan_forward(height, width, plane.data(), coefficients, FFTW_ESTIMATE);
    inverse = Fftw<Real>::plan_inverse(height, width, coefficients, plane.data(), FFTW_ESTIMATE);
  }
  ~State() {
    const std::lock_guard lock(planner_mutex());
    Fftw<Real>::destroy(forward);
    Fftw<Real>::destroy(inverse);
  }
  State(const State&) = delete;
  State& operator=(const State&) = delete;

  FftwBuffer<Real, Real> plane;
  FftwBuffer<Real, std::complex<Real>> spectrum;
  typename Fftw<Real>::Plan forward = nullptr;
  typename Fftw<Real>::Plan inverse = nullptr;
};

template <typename Real>
RealFft<Real>::RealFft(int height, int width) : state_(std::make_unique<State>(height, width)) {
  if (state_->forward == nullptr || state_->inverse == nullptr) {
    throw std::invalid_argument("no Fourier transform for this size of plane");
  }
}

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
void RealFft<Real>::forward() noexcept {
  Fftw<Real>::execute(state_->forward);
}

template <typename Real>
void RealFft<Real>::inverse() noexcept {
  Fftw<Real>::execute(state_->inverse);
}

template class RealFft<float>;
template class RealFft<double>;

}  // namespace touchtrial
