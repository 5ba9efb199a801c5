#include "engine/tv_gabor/admm.hpp"

#include "engine/tv_gabor/row_kernels.hpp"

#include <algorithm>
#include <cmath>
#include <cstddef>
#include <limits>
#include <numbers>

namespace touchtrial::engine {
namespace {

constexpr double kCautiousRelaxation = 1.8;
constexpr double kEagerRelaxation = 1.5;
constexpr double kEagerMomentum = 0.3;
/// z starts as this share of the image's gradient.
constexpr double kFirstShare = 0.5;

/// The first `count` coefficients of the spectrum of minus the second difference on a ring of n
/// samples.
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

/// A row of z, split into the scaled multiplier b and w.
template <typename Real>
struct SplitRow {
  explicit SplitRow(std::size_t width) : b_x(width), b_y(width), w_x(width), w_y(width) {}

  void split(std::span<const Real> z_x, std::span<const Real> z_y, double penalty) {
    clip_row(z_x.data(), z_y.data(), z_x.size(), static_cast<Real>(penalty), b_x.data(),
             b_y.data());
    const auto unit = static_cast<Real>(1.0 / penalty);
    for (std::size_t x = 0; x < z_x.size(); ++x) {
      b_x[x] *= unit;
      b_y[x] *= unit;
      w_x[x] = z_x[x] - b_x[x];
      w_y[x] = z_y[x] - b_y[x];
    }
  }

  std::vector<Real> b_x, b_y, w_x, w_y;
};

/// Sums over the plane of squared norms.
struct Sums {
  double w = 0.0, b = 0.0, change_of_w = 0.0, change_of_b = 0.0;

  template <typename Real>
  void add(const SplitRow<Real>& before, const SplitRow<Real>& after) {
    const auto squared = [](double x, double y) { return x * x + y * y; };
    for (std::size_t i = 0; i < after.w_x.size(); ++i) {
      w += squared(after.w_x[i], after.w_y[i]);
      b += squared(after.b_x[i], after.b_y[i]);
      change_of_w += squared(after.w_x[i] - before.w_x[i], after.w_y[i] - before.w_y[i]);
      change_of_b += squared(after.b_x[i] - before.b_x[i], after.b_y[i] - before.b_y[i]);
    }
  }
};

double ratio_of_norms(double squared, double reference_squared) {
  return std::sqrt(squared / std::max(reference_squared, std::numeric_limits<double>::min()));
}

}  // namespace

template <typename Real>
TvGaborAdmm<Real>::TvGaborAdmm(const TvGaborProblem<Real>& problem, RealFft<Real>& fft,
                               double penalty)
    : problem_(problem),
      fft_(fft),
      penalty_(penalty),
      laplacian_y_(ring_laplacian<Real>(problem.image.height(), problem.spectrum.height())),
      laplacian_x_(ring_laplacian<Real>(problem.image.width(), problem.spectrum.width())),
      z_(problem.image.height(), problem.image.width()),
      former_(problem.image.height(), problem.image.width()),
      target_x_(static_cast<std::size_t>(problem.image.width())),
      target_y_(target_x_.size()),
      above_(target_x_.size()),
      first_(target_x_.size()) {
  for (int y = 0; y < problem.image.height(); ++y) {
    const auto x_row = z_.x.row(y), y_row = z_.y.row(y);
    gradient_of_row<Real>(problem.image.row(y), problem.image.row(row_below(y)), x_row, y_row);
    const auto halve = [this](Real& sample) {
      image_squared_ += static_cast<double>(sample) * sample;
      sample *= static_cast<Real>(kFirstShare);
    };
    std::for_each(x_row.begin(), x_row.end(), halve);
    std::for_each(y_row.begin(), y_row.end(), halve);
  }
}

/// Writes -div target into the transform's plane, row by row, each after it has been read; the last
/// row is above the first.
/// \param target_row  called as target_row(y) for every row, fills target_x_ and target_y_
template <typename Real>
template <typename TargetRow>
void TvGaborAdmm<Real>::load_targets(const TargetRow& target_row) {
  std::fill(above_.begin(), above_.end(), Real{0});
  for (int y = 0; y < problem_.image.height(); ++y) {
    target_row(y);
    negative_divergence_of_row<Real>(target_x_, target_y_, above_, plane_row(y));
    std::swap(above_, target_y_);
  }
  const auto row = plane_row(0);
  for (std::size_t x = 0; x < row.size(); ++x) row[x] += above_[x];
}

template <typename Real>
void TvGaborAdmm<Real>::start_again() {
  const auto limit = static_cast<Real>(1.0 / penalty_);
  load_targets([&](int y) {
    const AdmmRow<Real> row{.image = problem_.image.row(y).data(),
                            .image_below = problem_.image.row(row_below(y)).data(),
                            .texture = nullptr,
                            .texture_below = nullptr,
                            .z_x = z_.x.row(y).data(),
                            .z_y = z_.y.row(y).data(),
                            .former_x = nullptr,
                            .former_y = nullptr,
                            .target_x = target_x_.data(),
                            .target_y = target_y_.data()};
    admm_target_row(row, target_x_.size(), limit);
  });
  has_former_ = false;
}

template <typename Real>
void TvGaborAdmm<Real>::step(AdmmPace pace) {
  const auto row_alone = [](int, const auto& map_row) { map_row(); };
  if (pace == AdmmPace::eager) {
    map(kEagerRelaxation, has_former_ ? kEagerMomentum : 0.0, row_alone);
  } else {
    map(kCautiousRelaxation, 0.0, row_alone);
  }
}

template <typename Real>
AdmmResiduals TvGaborAdmm<Real>::measured_step() {
  SplitRow<Real> before(target_x_.size()), after(target_x_.size());
  Sums sums;
  map(kCautiousRelaxation, 0.0, [&](int y, const auto& map_row) {
    before.split(z_.x.row(y), z_.y.row(y), penalty_);
    map_row();
    after.split(z_.x.row(y), z_.y.row(y), penalty_);
    sums.add(before, after);
  });
  return {ratio_of_norms(sums.change_of_b, std::max(sums.w, image_squared_)),
          ratio_of_norms(sums.change_of_w, sums.b)};
}

/// One step.
/// \param around  called as around(y, map_row) for every row; calls map_row
template <typename Real>
template <typename Around>
void TvGaborAdmm<Real>::map(double relaxation, double momentum, const Around& around) {
  filter();
  const AdmmNumbers<Real> numbers{.relaxation = static_cast<Real>(relaxation),
                                  .limit = static_cast<Real>(1.0 / penalty_),
                                  .momentum = static_cast<Real>(momentum)};
  const auto first = plane_row(0);
  std::copy(first.begin(), first.end(), first_.begin());
  load_targets([&](int y) {
    const int below = row_below(y);
    const AdmmRow<Real> row{.image = problem_.image.row(y).data(),
                            .image_below = problem_.image.row(below).data(),
                            .texture = plane_row(y).data(),
                            .texture_below = below == 0 ? first_.data() : plane_row(below).data(),
                            .z_x = z_.x.row(y).data(),
                            .z_y = z_.y.row(y).data(),
                            .former_x = former_.x.row(y).data(),
                            .former_y = former_.y.row(y).data(),
                            .target_x = target_x_.data(),
                            .target_y = target_y_.data()};
    around(y, [&] { admm_row(row, target_x_.size(), numbers); });
  });
  has_former_ = true;
}

/// The u-step in terms of v = f - u: diagonal in the Fourier basis, and without K = M^-1, so that
/// frequencies that M removes are exact. Writes v into the transform's plane.
template <typename Real>
void TvGaborAdmm<Real>::filter() {
  fft_.forward();
  const auto lambda = static_cast<Real>(problem_.lambda);
  const auto penalty = static_cast<Real>(penalty_);
  const auto scale = Real{1} / static_cast<Real>(problem_.image.size());
  const auto spectrum = fft_.spectrum();
  std::size_t i = 0;
  for (const Real laplacian_y : laplacian_y_) {
    for (const Real laplacian_x : laplacian_x_) {
      const Real weight = penalty * problem_.spectrum.samples()[i];
      const Real divisor = lambda + weight * (laplacian_y + laplacian_x);
      spectrum[i] *= scale * weight / divisor;
      ++i;
    }
  }
  fft_.inverse();
}

template <typename Real>
void TvGaborAdmm<Real>::set_penalty(double penalty) {
  const auto former = static_cast<Real>(penalty_);
  const auto change = static_cast<Real>(1.0 / penalty - 1.0 / penalty_);
  penalty_ = penalty;
  for (int y = 0; y < z_.x.height(); ++y) {
    const auto z_x = z_.x.row(y), z_y = z_.y.row(y);
    clip_row(z_x.data(), z_y.data(), z_x.size(), former, target_x_.data(), target_y_.data());
    for (std::size_t x = 0; x < z_x.size(); ++x) {
      z_x[x] += change * target_x_[x];
      z_y[x] += change * target_y_[x];
    }
  }
}

template <typename Real>
int TvGaborAdmm<Real>::row_below(int y) const noexcept {
  return y + 1 == problem_.image.height() ? 0 : y + 1;
}

template <typename Real>
std::span<Real> TvGaborAdmm<Real>::plane_row(int y) const {
  const auto width = static_cast<std::size_t>(problem_.image.width());
  return fft_.plane().subspan(static_cast<std::size_t>(y) * width, width);
}

template class TvGaborAdmm<float>;
template class TvGaborAdmm<double>;

}  // namespace touchtrial::engine
