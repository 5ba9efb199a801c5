#include "engine/tv_gabor/dual_slope.hpp"

#include <cstddef>

namespace touchtrial::engine {

template <typename Real>
DualSlope<Real>::DualSlope(const TvGaborProblem<Real>& problem, RealFft<Real>& fft)
    : problem_(problem),
      fft_(fft),
      x_(static_cast<std::size_t>(problem.image.width())),
      y_(x_.size()) {}

template <typename Real>
void DualSlope<Real>::at(const VectorField<Real>& q) {
  negative_divergence(q, fft_.plane());
  fft_.forward();
  const auto spectrum = fft_.spectrum();
  const auto scale = Real{1} / static_cast<Real>(problem_.image.size());
  for (std::size_t i = 0; i < spectrum.size(); ++i) {
    spectrum[i] *= scale * problem_.spectrum.samples()[i];
  }
  fft_.inverse();
  const auto lambda = static_cast<Real>(problem_.lambda);
  const auto plane = fft_.plane();
  for (std::size_t i = 0; i < plane.size(); ++i) plane[i] -= lambda * problem_.image.samples()[i];
}

template <typename Real>
void DualSlope<Real>::go_to_row(int y) {
  const int below = y + 1 == problem_.image.height() ? 0 : y + 1;
  const auto row = [this](int index) {
    return std::span<const Real>(fft_.plane())
        .subspan(static_cast<std::size_t>(index) * x_.size(), x_.size());
  };
  gradient_of_row<Real>(row(y), row(below), x_, y_);
}

template class DualSlope<float>;
template class DualSlope<double>;

}  // namespace touchtrial::engine
