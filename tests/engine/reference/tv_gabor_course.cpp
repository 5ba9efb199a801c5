#include "engine/reference/tv_gabor_course.hpp"

#include "engine/fourier/real_fft.hpp"
#include "engine/reference/tv_gabor_certificate.hpp"
#include "engine/tv_gabor/problem.hpp"
#include "engine/tv_gabor/row_kernels.hpp"
#include "engine/tv_gabor/solver.hpp"
#include "engine/tv_gabor/tv_gabor.hpp"

#include <algorithm>
#include <cmath>
#include <cstddef>
#include <span>
#include <stdexcept>
#include <utility>
#include <vector>

namespace touchtrial::reference {
namespace {

/// out = -div field.
/// \param out  height x width samples, row-major
template <typename Real>
void negative_divergence(const engine::VectorField<Real>& field, std::span<Real> out) noexcept {
  const int height = field.x.height();
  for (int y = 0; y < height; ++y) {
    const auto x = field.x.row(y), here = field.y.row(y);
    const auto above = field.y.row(y == 0 ? height - 1 : y - 1);
    Real* const row = out.data() + static_cast<std::size_t>(y) * x.size();
    row[0] = (x.back() - x[0]) + (above[0] - here[0]);
    for (std::size_t i = 1; i < x.size(); ++i) row[i] = (x[i - 1] - x[i]) + (above[i] - here[i]);
  }
}

/// Steps of the projected gradient up to this length converge: |grad M div| <= 8.
constexpr double kLongestDualStep = 0.125;

/// The slope of TV-Gabor's dual, which both slower solvers follow.
template <typename Real>
class DualSlope {
 public:
  /// Keeps references to all; the transform has the image's size.
  /// \param spectrum  of M, in the layout of the transform's
  DualSlope(const engine::TvGaborProblem<Real>& problem, const Plane<Real>& spectrum,
            engine::RealFft<Real>& fft)
      : problem_(problem),
        spectrum_(spectrum),
        fft_(fft),
        x_(static_cast<std::size_t>(problem.image.width())),
        y_(x_.size()) {}

  /// Prepares the rows of w = grad(M div p - lambda f).
  /// \param q  -p
  void at(const engine::VectorField<Real>& q) {
    negative_divergence(q, fft_.plane());
    fft_.forward();
    const auto spectrum = fft_.spectrum();
    const auto scale = Real{1} / static_cast<Real>(problem_.image.size());
    for (std::size_t i = 0; i < spectrum.size(); ++i) {
      spectrum[i] *= scale * spectrum_.samples()[i];
    }
    fft_.inverse();
    const auto lambda = static_cast<Real>(problem_.lambda);
    const auto plane = fft_.plane();
    for (std::size_t i = 0; i < plane.size(); ++i) plane[i] -= lambda * problem_.image.samples()[i];
  }

  /// Computes w of one row of the torus, for x() and y().
  void go_to_row(int y) {
    const int below = y + 1 == problem_.image.height() ? 0 : y + 1;
    const auto row = [this](int index) {
      return std::span<const Real>(fft_.plane())
          .subspan(static_cast<std::size_t>(index) * x_.size(), x_.size());
    };
    engine::gradient_of_row<Real>(row(y), row(below), x_, y_);
  }
  [[nodiscard]] std::span<const Real> x() const noexcept { return x_; }
  [[nodiscard]] std::span<const Real> y() const noexcept { return y_; }

 private:
  const engine::TvGaborProblem<Real>& problem_;
  const Plane<Real>& spectrum_;
  engine::RealFft<Real>& fft_;
  std::vector<Real> x_, y_;
};

/// Accelerated projected gradient: steps of 1/8 from p = 0.
template <typename Real>
class Fista {
 public:
  /// Keeps references to all; others may use the transform between steps.
  Fista(const engine::TvGaborProblem<Real>& problem, const Plane<Real>& spectrum,
        engine::RealFft<Real>& fft)
      : slope_(problem, spectrum, fft),
        q_(problem.image.height(), problem.image.width()),
        ahead_(problem.image.height(), problem.image.width()),
        next_x_(static_cast<std::size_t>(problem.image.width())),
        next_y_(next_x_.size()) {}

  void step() {
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
      engine::row_kernels<Real>().clip(next_x_.data(), next_y_.data(), next_x_.size(), Real{1},
                                       next_x_.data(), next_y_.data());
      for (std::size_t x = 0; x < next_x_.size(); ++x) {
        ahead_x[x] = next_x_[x] + momentum * (next_x_[x] - q_x[x]);
        ahead_y[x] = next_y_[x] + momentum * (next_y_[x] - q_y[x]);
        q_x[x] = next_x_[x];
        q_y[x] = next_y_[x];
      }
    }
    t_ = next_t;
  }
  /// q = -p, with vectors of length at most 1.
  [[nodiscard]] const engine::VectorField<Real>& q() const noexcept { return q_; }

 private:
  DualSlope<Real> slope_;
  engine::VectorField<Real> q_;
  engine::VectorField<Real> ahead_;    // where the slope is taken
  std::vector<Real> next_x_, next_y_;  // rows
  double t_ = 1.0;
};

/// p <- (p + tau w) / (1 + tau |w|), with tau = 1/8, from p = 0.
template <typename Real>
class FixedPoint {
 public:
  /// Keeps references to all; others may use the transform between steps.
  FixedPoint(const engine::TvGaborProblem<Real>& problem, const Plane<Real>& spectrum,
             engine::RealFft<Real>& fft)
      : slope_(problem, spectrum, fft), q_(problem.image.height(), problem.image.width()) {}

  void step() {
    const auto tau = static_cast<Real>(kLongestDualStep);
    slope_.at(q_);
    for (int y = 0; y < q_.x.height(); ++y) {
      slope_.go_to_row(y);
      const auto w_x = slope_.x(), w_y = slope_.y();
      const auto q_x = q_.x.row(y), q_y = q_.y.row(y);
      for (std::size_t x = 0; x < q_x.size(); ++x) {
        const Real share = Real{1} / (Real{1} + tau * std::sqrt(w_x[x] * w_x[x] + w_y[x] * w_y[x]));
        q_x[x] = share * (q_x[x] - tau * w_x[x]);
        q_y[x] = share * (q_y[x] - tau * w_y[x]);
      }
    }
  }
  /// q = -p, with vectors of length at most 1.
  [[nodiscard]] const engine::VectorField<Real>& q() const noexcept { return q_; }

 private:
  DualSlope<Real> slope_;
  engine::VectorField<Real> q_;
};

engine::TvGaborOptions with_components(const GreyImage& image, engine::TvGaborOptions options) {
  if (options.automatic) options.components = {engine::strongest_component(image)};
  return options;
}

template <typename Real>
TvGaborCertificate<Real> cropped(const TvGaborCertificate<Real>& certificate, int height,
                                 int width) {
  return {cropped_from_torus(certificate.texture, height, width), certificate.gap};
}

void refuse_flat(const GreyImage& image) {
  const auto samples = image.samples();
  const auto differs = [&](auto sample) { return sample != samples.front(); };
  if (!std::any_of(samples.begin(), samples.end(), differs)) {
    throw std::invalid_argument("TvGaborCourse: the image is empty or flat");
  }
}

}  // namespace

template <typename Real>
class TvGaborCourse<Real>::Solver {
 public:
  virtual ~Solver() = default;
  virtual void advance(int steps) = 0;
  /// Of an image of this shape, without the torus' margins.
  [[nodiscard]] virtual TvGaborCertificate<Real> certificate(int height, int width) = 0;
};

template <typename Real>
class TvGaborCourse<Real>::Admm final : public Solver {
 public:
  Admm(const GreyImage& image, const engine::TvGaborOptions& options)
      : image_(image), options_(without_end(options)), solver_(image_, options_) {}

  void advance(int steps) override {
    static_cast<void>(solver_.run(solver_.steps() + steps, engine::Patience::unlimited));
  }
  /// The solver checks only after its first steps, so the start is certified here.
  TvGaborCertificate<Real> certificate(int height, int width) override {
    if (solver_.steps() > 0) return {solver_.texture(), solver_.gap()};
    const auto problem = engine::tv_gabor_problem<Real>(image_, options_);
    const engine::TvGaborState<Real> state = solver_.state();
    return cropped(certificate_of(problem, state.z, state.schedule.penalty()), height, width);
  }

 private:
  static engine::TvGaborOptions without_end(engine::TvGaborOptions options) {
    options.gap = -1.0;  // which no gap reaches
    return options;
  }

  GreyImage image_;
  engine::TvGaborOptions options_;
  engine::TvGaborSolver<Real> solver_;
};

template <typename Real>
template <typename Method>
class TvGaborCourse<Real>::OnDual final : public Solver {
 public:
  OnDual(const GreyImage& image, const engine::TvGaborOptions& options)
      : problem_(engine::tv_gabor_problem<Real>(image, options)),
        spectrum_(converted<Real>(engine::gabor_spectrum(
            options.components, problem_.image.height(), problem_.image.width()))),
        fft_(problem_.image.height(), problem_.image.width()),
        method_(problem_, spectrum_, fft_) {}

  void advance(int steps) override {
    for (int step = 0; step < steps; ++step) method_.step();
  }
  TvGaborCertificate<Real> certificate(int height, int width) override {
    return cropped(certificate_of(problem_, method_.q(), 1.0), height, width);
  }

 private:
  engine::TvGaborProblem<Real> problem_;
  Plane<Real> spectrum_;
  engine::RealFft<Real> fft_;
  Method method_;
};

template <typename Real>
TvGaborCourse<Real>::TvGaborCourse(const GreyImage& image, const engine::TvGaborOptions& options,
                                   TvGaborAlgorithm algorithm)
    : height_(image.height()), width_(image.width()) {
  refuse_flat(image);
  const engine::TvGaborOptions all = with_components(image, options);
  switch (algorithm) {
    case TvGaborAlgorithm::admm:
      solver_ = std::make_unique<Admm>(image, all);
      break;
    case TvGaborAlgorithm::fista:
      solver_ = std::make_unique<OnDual<Fista<Real>>>(image, all);
      break;
    case TvGaborAlgorithm::fixed_point:
      solver_ = std::make_unique<OnDual<FixedPoint<Real>>>(image, all);
      break;
  }
}

template <typename Real>
TvGaborCourse<Real>::~TvGaborCourse() = default;

template <typename Real>
void TvGaborCourse<Real>::advance(int steps) {
  solver_->advance(steps);
  steps_ += steps;
}

template <typename Real>
TvGaborPoint<Real> TvGaborCourse<Real>::point() {
  TvGaborCertificate<Real> certificate = solver_->certificate(height_, width_);
  return {steps_, certificate.gap, std::move(certificate.texture)};
}

template class TvGaborCourse<float>;
template class TvGaborCourse<double>;

}  // namespace touchtrial::reference
