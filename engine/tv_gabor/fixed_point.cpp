#include "engine/tv_gabor/fixed_point.hpp"

#include "engine/tv_gabor/row_kernels.hpp"

#include <cstddef>

namespace touchtrial::engine {

template <typename Real>
TvGaborFixedPoint<Real>::TvGaborFixedPoint(const TvGaborProblem<Real>& problem, RealFft<Real>& fft)
    : slope_(problem, fft),
      q_(problem.image.height(), problem.image.width()),
      norms_(static_cast<std::size_t>(problem.image.width())) {}

template <typename Real>
void TvGaborFixedPoint<Real>::step() {
  const auto tau = static_cast<Real>(kLongestDualStep);
  slope_.at(q_);
  for (int y = 0; y < q_.x.height(); ++y) {
    slope_.go_to_row(y);
    const auto w_x = slope_.x(), w_y = slope_.y();
    norm_row(w_x.data(), w_y.data(), norms_.size(), norms_.data());
    const auto q_x = q_.x.row(y), q_y = q_.y.row(y);
    for (std::size_t x = 0; x < norms_.size(); ++x) {
      const Real share = Real{1} / (Real{1} + tau * norms_[x]);
      q_x[x] = share * (q_x[x] - tau * w_x[x]);
      q_y[x] = share * (q_y[x] - tau * w_y[x]);
    }
  }
}

template class TvGaborFixedPoint<float>;
template class TvGaborFixedPoint<double>;

}  // namespace touchtrial::engine
