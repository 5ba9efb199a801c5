#include "engine/tv_gabor/course.hpp"

#include "engine/tv_gabor/certificate.hpp"
#include "engine/tv_gabor/domain.hpp"
#include "engine/tv_gabor/fista.hpp"
#include "engine/tv_gabor/fixed_point.hpp"
#include "engine/tv_gabor/solver.hpp"
#include "engine/tv_gabor/spectral_peak.hpp"

#include <algorithm>
#include <stdexcept>

namespace touchtrial::engine {
namespace {

TvGaborOptions with_components(const GreyImage& image, TvGaborOptions options) {
  if (options.automatic) options.components = {strongest_component(image)};
  return options;
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
  [[nodiscard]] virtual TvGaborCertificate<Real> certificate() = 0;
};

template <typename Real>
class TvGaborCourse<Real>::Admm final : public Solver {
 public:
  Admm(const GreyImage& image, const TvGaborOptions& options) : solver_(image, options) {
    solver_.check_the_start();
  }
  void advance(int steps) override { solver_.advance(steps); }
  TvGaborCertificate<Real> certificate() override { return solver_.certificate(); }

 private:
  TvGaborSolver<Real> solver_;
};

template <typename Real>
template <typename Method>
class TvGaborCourse<Real>::OnDual final : public Solver {
 public:
  OnDual(const GreyImage& image, const TvGaborOptions& options)
      : problem_(tv_gabor_problem<Real>(image, options)),
        fft_(problem_.image.height(), problem_.image.width(), FftPlan::measured),
        method_(problem_, fft_) {}

  void advance(int steps) override {
    for (int step = 0; step < steps; ++step) method_.step();
  }
  TvGaborCertificate<Real> certificate() override {
    return certify(problem_, method_.q(), 1.0, fft_);
  }

 private:
  TvGaborProblem<Real> problem_;
  RealFft<Real> fft_;
  Method method_;
};

template <typename Real>
TvGaborCourse<Real>::TvGaborCourse(const GreyImage& image, const TvGaborOptions& options,
                                   TvGaborAlgorithm algorithm)
    : height_(image.height()), width_(image.width()) {
  refuse_flat(image);
  const TvGaborOptions all = with_components(image, options);
  switch (algorithm) {
    case TvGaborAlgorithm::admm:
      solver_ = std::make_unique<Admm>(image, all);
      break;
    case TvGaborAlgorithm::fista:
      solver_ = std::make_unique<OnDual<TvGaborFista<Real>>>(image, all);
      break;
    case TvGaborAlgorithm::fixed_point:
      solver_ = std::make_unique<OnDual<TvGaborFixedPoint<Real>>>(image, all);
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
  const TvGaborCertificate<Real> certificate = solver_->certificate();
  return {steps_, certificate.gap, cropped_from_torus(certificate.texture, height_, width_)};
}

template class TvGaborCourse<float>;
template class TvGaborCourse<double>;

}  // namespace touchtrial::engine
