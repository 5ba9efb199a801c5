#include "engine/tv_gabor/fista.hpp"

#include "engine/tv_gabor/row_kernels.hpp"

#include <cmath>
#include <cstddef>

namespace touchtrial::engine {

template <typename Real>
TvGaborFista<Real>::TvGaborFista(const TvGaborProblem<Real>& problem, RealFft<Real>& fft)
    : slope_(problem, fft),
      q_(problem.image.height(), problem.image.width()),
      ahead_(problem.image.height(), problem.image.width()),
      next_x_(static_cast<std::size_t>(problem.image.width())),
      next_y_(next_x_.size()) {}

template <typename Real>
void TvGaborFista<Real>::step() {
  const double next_t = (1.0 + std::sqrt(1.0 + 4.0 * t_ * t_)) / 2.0;
  const auto momentum = static_cast<Real>((t_ - 1.0) / next_t);
  const auto tau = static_cast<Real>(kLongestDualStep);
  slope_.at(ahead_);
  for (int y = 0; y < q_.x.height(); ++y) {
    slope_.go_to_row(y);
    const auto w_x = slope_.x(), w_y = slope_.y();
    const auto q_x = q_.x.row(y), q_y = q_.y.row(y);
    const auto ahead_x = ahead_.x.row(y), ahead_y = ahead_.y.row(y);
    for (std::size_t x = 0; x < next_x_.size(); ++x) {
      next_x_[x] = ahead_x[x] - tau * w_x[x];
      next_y_[x] = ahead_y[x] - tau * w_y[x];
    }
    clip_row(next_x_.data(), next_y_.data(), next_x_.size(), Real{1}, next_x_.data(),
             next_y_.data());
    for (std::size_t x = 0; x < next_x_.size(); ++x) {
      ahead_x[x] = next_x_[x] + momentum * (next_x_[x] - q_x[x]);
      ahead_y[x] = next_y_[x] + momentum * (next_y_[x] - q_y[x]);
      q_x[x] = next_x_[x];
      q_y[x] = next_y_[x];
    }
  }
  t_ = next_t;
}

template class TvGaborFista<float>;
template class TvGaborFista<double>;

}  // namespace touchtrial::engine
