#include "engine/reference/tv_gabor_course.hpp"

#include "engine/fourier/real_fft.hpp"
#include "engine/reference/tv_gabor_certificate.hpp"
#include "engine/tv_gabor/problem.hpp"
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

/// p <- (p + tau w) / (1 + tau |w|), with tau = 1/8 and w = grad(M div p - lambda f), from p = 0.
template <typename Real>
class TvGaborCourse<Real>::FixedPoint final : public Solver {
 public:
  FixedPoint(const GreyImage& image, const engine::TvGaborOptions& options)
      : problem_(engine::tv_gabor_problem<Real>(image, options)),
        spectrum_(converted<Real>(engine::gabor_spectrum(
            options.components, problem_.image.height(), problem_.image.width()))),
        fft_(problem_.image.height(), problem_.image.width()),
        q_(problem_.image.height(), problem_.image.width()),
        w_x_(static_cast<std::size_t>(problem_.image.width())),
        w_y_(w_x_.size()) {}

  void advance(int steps) override {
    for (int step = 0; step < steps; ++step) take_step();
  }
  TvGaborCertificate<Real> certificate(int height, int width) override {
    return cropped(certificate_of(problem_, q_, 1.0), height, width);
  }

 private:
  /// Leaves M div p - lambda f in the transform's plane.
  void take_slope() {
    negative_divergence(q_, fft_.plane());
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

  void take_step() {
    take_slope();
    constexpr auto kTau = static_cast<Real>(kLongestDualStep);
    const std::size_t width = w_x_.size();
    const int height = q_.x.height();
    const auto row = [&](int y) {
      return std::span<const Real>(fft_.plane())
          .subspan(static_cast<std::size_t>(y) * width, width);
    };
    for (int y = 0; y < height; ++y) {
      engine::gradient_of_row<Real>(row(y), row((y + 1) % height), w_x_, w_y_);
      const auto q_x = q_.x.row(y), q_y = q_.y.row(y);
      for (std::size_t x = 0; x < width; ++x) {
        const Real norm = std::sqrt(w_x_[x] * w_x_[x] + w_y_[x] * w_y_[x]);
        const Real share = Real{1} / (Real{1} + kTau * norm);
        q_x[x] = share * (q_x[x] - kTau * w_x_[x]);
        q_y[x] = share * (q_y[x] - kTau * w_y_[x]);
      }
    }
  }

  engine::TvGaborProblem<Real> problem_;
  Plane<Real> spectrum_;
  engine::RealFft<Real> fft_;
  engine::VectorField<Real> q_;  ///< -p, with vectors of length at most 1
  std::vector<Real> w_x_, w_y_;  ///< of a row
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
    case TvGaborAlgorithm::fixed_point:
      solver_ = std::make_unique<FixedPoint>(image, all);
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
