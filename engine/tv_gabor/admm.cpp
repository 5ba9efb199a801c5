#include "engine/tv_gabor/admm.hpp"

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
/// Initial z, as a share of the image's gradient.
constexpr double kInitialShare = 0.5;

/// The first `count` eigenvalues of the negative second difference on a ring of n samples.
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

/// Observes nothing.
struct NoObserver {
  struct Sums {
    Sums& operator+=(const Sums&) noexcept { return *this; }
  };

  explicit NoObserver(std::size_t, double) {}
  template <typename Real>
  void on_step_start(const AdmmRow<Real>&) {}
  template <typename Real>
  void on_step_end(const AdmmRow<Real>&) {}

  Sums sums;
};

/// A row of z, split into the scaled multiplier b and w.
template <typename Real>
struct SplitRow {
  explicit SplitRow(std::size_t width) : b_x(width), b_y(width), w_x(width), w_y(width) {}

  void split(const AdmmRow<Real>& row, double penalty) {
    row_kernels<Real>().clip(row.z_x, row.z_y, b_x.size(), static_cast<Real>(penalty), b_x.data(),
                             b_y.data());
    const auto unit = static_cast<Real>(1.0 / penalty);
    for (std::size_t x = 0; x < b_x.size(); ++x) {
      b_x[x] *= unit;
      b_y[x] *= unit;
      w_x[x] = row.z_x[x] - b_x[x];
      w_y[x] = row.z_y[x] - b_y[x];
    }
  }

  std::vector<Real> b_x, b_y, w_x, w_y;
};

/// Sums squared norms of a step over rows.
template <typename Real>
class StepNorms {
 public:
  struct Sums {
    double w = 0.0, b = 0.0, change_of_w = 0.0, change_of_b = 0.0, image = 0.0;

    Sums& operator+=(const Sums& other) noexcept {
      w += other.w;
      b += other.b;
      change_of_w += other.change_of_w;
      change_of_b += other.change_of_b;
      image += other.image;
      return *this;
    }
  };

  StepNorms(std::size_t width, double penalty)
      : penalty_(penalty), start_row_(width), end_row_(width) {}

  void on_step_start(const AdmmRow<Real>& row) { start_row_.split(row, penalty_); }
  void on_step_end(const AdmmRow<Real>& row) {
    end_row_.split(row, penalty_);
    const auto squared = [](double x, double y) { return x * x + y * y; };
    for (std::size_t i = 0; i < end_row_.w_x.size(); ++i) {
      sums.w += squared(end_row_.w_x[i], end_row_.w_y[i]);
      sums.b += squared(end_row_.b_x[i], end_row_.b_y[i]);
      sums.change_of_w +=
          squared(end_row_.w_x[i] - start_row_.w_x[i], end_row_.w_y[i] - start_row_.w_y[i]);
      sums.change_of_b +=
          squared(end_row_.b_x[i] - start_row_.b_x[i], end_row_.b_y[i] - start_row_.b_y[i]);
      const Real right = row.image[i + 1 == end_row_.w_x.size() ? 0 : i + 1];
      sums.image += squared(right - row.image[i], row.image_below[i] - row.image[i]);
    }
  }

  Sums sums;

 private:
  double penalty_;
  SplitRow<Real> start_row_, end_row_;
};

double ratio_of_norms(double squared, double reference_squared) {
  return std::sqrt(squared / std::max(reference_squared, std::numeric_limits<double>::min()));
}

}  // namespace

template <typename Real>
TvGaborAdmm<Real>::TvGaborAdmm(const TvGaborProblem<Real>& problem, TorusPlane<Real>& plane)
    : problem_(problem),
      plane_(plane),
      laplacian_y_(ring_laplacian<Real>(problem.image.height(), problem.image.height())),
      laplacian_x_(ring_laplacian<Real>(problem.image.width(), problem.image.width())),
      factors_(problem.factors.size()),
      z_(problem.image.height(), problem.image.width()),
      previous_map_(problem.image.height(), problem.image.width()) {
  plane_.for_each_block([this](const RowBlock& block) {
    for (int y = block.begin; y < block.end; ++y) {
      const auto x_row = z_.x.row(y), y_row = z_.y.row(y);
      gradient_of_row<Real>(problem_.image.row(y), problem_.image.row(row_below(y)), x_row, y_row);
      for (Real& sample : x_row) sample *= static_cast<Real>(kInitialShare);
      for (Real& sample : y_row) sample *= static_cast<Real>(kInitialShare);
    }
  });
}

template <typename Real>
void TvGaborAdmm<Real>::restart(double penalty) {
  const RestartNumbers<Real> numbers{
      .previous_limit = static_cast<Real>(1.0 / (penalty_ > 0.0 ? penalty_ : penalty)),
      .limit = static_cast<Real>(1.0 / penalty)};
  penalty_ = penalty;
  set_factors();
  plane_.for_each_block([&](const RowBlock& block) {
    typename TorusPlane<Real>::DivergenceRows targets(plane_, block);
    for (int y = block.begin; y < block.end; ++y) {
      AdmmRow<Real> row = row_of(y);
      row.target_x = targets.along_x();
      row.target_y = targets.along_y();
      row_kernels<Real>().restart(row, plane_.width(), numbers);
      targets.next();
    }
  });
  plane_.finish_divergence();
  has_previous_ = false;
}

template <typename Real>
void TvGaborAdmm<Real>::step(AdmmPace pace) {
  apply_map<NoObserver>(pace, false);
}

template <typename Real>
void TvGaborAdmm<Real>::final_step() {
  apply_map<NoObserver>(AdmmPace::cautious, true);
}

template <typename Real>
AdmmResiduals TvGaborAdmm<Real>::measured_final_step() {
  const auto sums = apply_map<StepNorms<Real>>(AdmmPace::cautious, true);
  return {ratio_of_norms(sums.change_of_b, std::max(sums.w, sums.image)),
          ratio_of_norms(sums.change_of_w, sums.b)};
}

/// Takes one step. The u-step in terms of v = f - u is diagonal in the Fourier basis and does not
/// use K = M^-1, so it is exact at frequencies that M removes.
template <typename Real>
template <typename Observer>
typename Observer::Sums TvGaborAdmm<Real>::apply_map(AdmmPace pace, bool is_last) {
  plane_.filter(factors_);
  const bool is_eager = pace == AdmmPace::eager;
  const AdmmNumbers<Real> numbers{
      .relaxation = static_cast<Real>(is_eager ? kEagerRelaxation : kCautiousRelaxation),
      .limit = static_cast<Real>(1.0 / penalty_),
      .momentum = static_cast<Real>(is_eager && has_previous_ ? kEagerMomentum : 0.0),
      .store_previous = is_eager,
      .b_only = is_last};
  const auto sums =
      plane_.template sum_of_blocks<typename Observer::Sums>([&](const RowBlock& block) {
        typename TorusPlane<Real>::Rows texture(plane_, block);
        typename TorusPlane<Real>::DivergenceRows targets(plane_, block);
        Observer observer(plane_.width(), penalty_);
        for (int y = block.begin; y < block.end; ++y) {
          texture.go_to(y);
          AdmmRow<Real> row = row_of(y);
          row.texture = texture.row();
          row.texture_below = texture.row_below();
          row.target_x = targets.along_x();
          row.target_y = targets.along_y();
          observer.on_step_start(row);
          row_kernels<Real>().admm(row, plane_.width(), numbers);
          observer.on_step_end(row);
          targets.next();
        }
        return observer.sums;
      });
  plane_.finish_divergence();
  has_previous_ = is_eager;
  return sums;
}

template <typename Real>
void TvGaborAdmm<Real>::set_factors() {
  const auto lambda = static_cast<Real>(problem_.lambda);
  const auto penalty = static_cast<Real>(penalty_);
  const Real* const spectrum = problem_.factors.data();
  const Real* const along_y = laplacian_y_.data();
  Real* const factors = factors_.data();
  plane_.for_each_column_block([&](std::size_t block) {
    plane_.column_blocks().for_each(block, [&](std::size_t i, int y, int x) {
      const Real weight = penalty * spectrum[i];
      const Real laplacian = along_y[y] + laplacian_x_[static_cast<std::size_t>(x)];
      factors[i] = weight / (lambda + weight * laplacian);
    });
  });
}

template <typename Real>
int TvGaborAdmm<Real>::row_below(int y) const noexcept {
  return y + 1 == problem_.image.height() ? 0 : y + 1;
}

/// Leaves texture and targets empty.
template <typename Real>
AdmmRow<Real> TvGaborAdmm<Real>::row_of(int y) noexcept {
  return {.image = problem_.image.row(y).data(),
          .image_below = problem_.image.row(row_below(y)).data(),
          .texture = nullptr,
          .texture_below = nullptr,
          .z_x = z_.x.row(y).data(),
          .z_y = z_.y.row(y).data(),
          .previous_x = previous_map_.x.row(y).data(),
          .previous_y = previous_map_.y.row(y).data(),
          .target_x = nullptr,
          .target_y = nullptr};
}

template class TvGaborAdmm<float>;
template class TvGaborAdmm<double>;

}  // namespace touchtrial::engine
