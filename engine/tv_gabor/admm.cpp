#include "engine/tv_gabor/admm.hpp"

#include <algorithm>
#include <cmath>
#include <limits>
#include <numbers>

namespace touchtrial {
namespace {

constexpr double kOverRelaxation = 1.8;

/// Spectrum of minus the second difference on a ring of n samples, first `count` coefficients.
template <typename Real>
std::vector<Real> ring_laplacian(int n, int count) {
  std::vector<Real> spectrum(static_cast<std::size_t>(count));
  for (int i = 0; i < count; ++i) {
    const double half_angle = std::numbers::pi * i / n;
    spectrum[static_cast<std::size_t>(i)] =
        static_cast<Real>(4.0 * std::sin(half_angle) * std::sin(half_angle));
  }
  return spectrum;
}

double ratio_of_norms(double squared, double reference_squared) {
  return std::sqrt(squared / std::max(reference_squared, std::numeric_limits<double>::min()));
}

}  // namespace

/// Sums over the plane of squared norms: of grad f, grad u, w, b, grad u - w, the change of w.
template <typename Real>
struct TvGaborAdmm<Real>::Sums {
  double image = 0.0, cartoon = 0.0, w = 0.0, multiplier = 0.0, split = 0.0, change = 0.0;
};

template <typename Real>
TvGaborAdmm<Real>::TvGaborAdmm(const TvGaborProblem<Real>& problem, RealFft<Real>& fft,
                               double penalty)
    : problem_(problem),
      fft_(fft),
      penalty_(penalty),
      laplacian_y_(ring_laplacian<Real>(problem.image.height(), problem.spectrum.height())),
      laplacian_x_(ring_laplacian<Real>(problem.image.width(), problem.spectrum.width())),
      multiplier_(problem.image.height(), problem.image.width()),
      target_(problem.image.height(), problem.image.width()),
      image_(1, problem.image.width()),
      texture_(1, problem.image.width()),
      w_(1, problem.image.width()) {
  for (int y = 0; y < problem.image.height(); ++y) {
    gradient_of_row<Real>(problem.image.row(y), problem.image.row(row_below(y)), target_.x.row(y),
                          target_.y.row(y));
  }
}

template <typename Real>
void TvGaborAdmm<Real>::step() {
  update_texture();
  for (int y = 0; y < problem_.image.height(); ++y) update_row(y);
}

template <typename Real>
AdmmResiduals TvGaborAdmm<Real>::measured_step() {
  update_texture();
  Sums sums;
  for (int y = 0; y < problem_.image.height(); ++y) {
    update_row(y);
    add_residuals(y, sums);
  }
  return {ratio_of_norms(sums.split, std::max({sums.image, sums.cartoon, sums.w})),
          ratio_of_norms(sums.change, sums.multiplier)};
}

/// The u-step in terms of v = f - u: diagonal in the Fourier basis, and without K = M^-1, so that
/// frequencies which M removes are exact. Leaves v in the transform's plane.
template <typename Real>
void TvGaborAdmm<Real>::update_texture() {
  negative_divergence(target_, fft_.plane());
  fft_.forward();
  const auto lambda = static_cast<Real>(problem_.lambda);
  const auto penalty = static_cast<Real>(penalty_);
  const auto scale = Real{1} / static_cast<Real>(problem_.image.size());
  std::size_t i = 0;
  for (const Real laplacian_y : laplacian_y_) {
    for (const Real laplacian_x : laplacian_x_) {
      const Real weight = penalty * problem_.spectrum.samples()[i];
      const Real divisor = lambda + weight * (laplacian_y + laplacian_x);
      fft_.spectrum()[i] *= scale * weight / divisor;
      ++i;
    }
  }
  fft_.inverse();
}

/// The w-step (shrinkage by 1 / penalty) and the multiplier's, for one row.
template <typename Real>
void TvGaborAdmm<Real>::update_row(int y) {
  const int below = row_below(y);
  const auto f_x = image_.x.row(0), f_y = image_.y.row(0);
  const auto v_x = texture_.x.row(0), v_y = texture_.y.row(0);
  gradient_of_row<Real>(problem_.image.row(y), problem_.image.row(below), f_x, f_y);
  gradient_of_row<Real>(texture_row(y), texture_row(below), v_x, v_y);
  const auto relaxation = static_cast<Real>(kOverRelaxation);
  const auto threshold = static_cast<Real>(1.0 / penalty_);
  const auto b_x = multiplier_.x.row(y), b_y = multiplier_.y.row(y);
  const auto target_x = target_.x.row(y), target_y = target_.y.row(y);
  const auto w_x = w_.x.row(0), w_y = w_.y.row(0);
  for (std::size_t x = 0; x < f_x.size(); ++x) {
    w_x[x] = f_x[x] - target_x[x] + b_x[x];
    w_y[x] = f_y[x] - target_y[x] + b_y[x];
    const Real z_x = relaxation * (f_x[x] - v_x[x]) + (1 - relaxation) * w_x[x] + b_x[x];
    const Real z_y = relaxation * (f_y[x] - v_y[x]) + (1 - relaxation) * w_y[x] + b_y[x];
    const Real norm = std::sqrt(z_x * z_x + z_y * z_y);
    const Real share = threshold / std::max(norm, threshold);
    b_x[x] = share * z_x;
    b_y[x] = share * z_y;
    target_x[x] = f_x[x] - (z_x - 2 * b_x[x]);  // the new w is z - b
    target_y[x] = f_y[x] - (z_y - 2 * b_y[x]);
  }
}

template <typename Real>
void TvGaborAdmm<Real>::add_residuals(int y, Sums& sums) const {
  const auto squared = [](double a, double b) { return a * a + b * b; };
  const auto b_x = multiplier_.x.row(y), b_y = multiplier_.y.row(y);
  for (std::size_t x = 0; x < b_x.size(); ++x) {
    const double w_x = image_.x.row(0)[x] - target_.x.row(y)[x] + b_x[x];
    const double w_y = image_.y.row(0)[x] - target_.y.row(y)[x] + b_y[x];
    const double u_x = image_.x.row(0)[x] - texture_.x.row(0)[x];
    const double u_y = image_.y.row(0)[x] - texture_.y.row(0)[x];
    sums.image += squared(image_.x.row(0)[x], image_.y.row(0)[x]);
    sums.cartoon += squared(u_x, u_y);
    sums.w += squared(w_x, w_y);
    sums.multiplier += squared(b_x[x], b_y[x]);
    sums.split += squared(u_x - w_x, u_y - w_y);
    sums.change += squared(w_x - w_.x.row(0)[x], w_y - w_.y.row(0)[x]);
  }
}

template <typename Real>
void TvGaborAdmm<Real>::scale_penalty(double factor) {
  penalty_ *= factor;
  const auto kept = static_cast<Real>(1.0 / factor);
  const auto rescale = [kept](Plane<Real>& multiplier, Plane<Real>& target) {
    for (std::size_t i = 0; i < multiplier.size(); ++i) {
      const Real former = multiplier.samples()[i];
      multiplier.samples()[i] = kept * former;
      target.samples()[i] += multiplier.samples()[i] - former;
    }
  };
  rescale(multiplier_.x, target_.x);
  rescale(multiplier_.y, target_.y);
}

template <typename Real>
int TvGaborAdmm<Real>::row_below(int y) const noexcept {
  return y + 1 == problem_.image.height() ? 0 : y + 1;
}

template <typename Real>
std::span<const Real> TvGaborAdmm<Real>::texture_row(int y) const {
  const auto width = static_cast<std::size_t>(problem_.image.width());
  return fft_.plane().subspan(static_cast<std::size_t>(y) * width, width);
}

template class TvGaborAdmm<float>;
template class TvGaborAdmm<double>;

}  // namespace touchtrial
