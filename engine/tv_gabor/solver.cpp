#include "engine/tv_gabor/solver.hpp"

#include "engine/tv_gabor/domain.hpp"
#include "engine/tv_gabor/gabor_spectrum.hpp"

#include <algorithm>
#include <cmath>
#include <cstddef>

namespace touchtrial {
namespace {

/// Certifying costs as much as a step; the penalty is only balanced then.
constexpr int kStepsBetweenChecks = 10;
/// The first penalty times the image's mean gradient: the first shrinkage is by half a gradient.
constexpr double kFirstPenalty = 2.0;
/// How far the penalty may wander from the first, either way.
constexpr double kPenaltyRange = 1e4;
/// Primal residuals count six times. With the gap as stop, equal residuals leave the penalty too
/// small: photographs and drawings alike take up to a third fewer steps this way.
constexpr double kPrimalEmphasis = 6.0;
/// Ratios of residuals up to this are balanced enough; one correction changes at most this much.
constexpr double kDeadBand = 1.2;
constexpr double kMostChange = 4.0;
/// The gap should halve within this many checks.
constexpr std::size_t kChecksToHalve = 5;

template <typename Real>
TvGaborProblem<Real> problem_of(const GreyImage& image, const TvGaborOptions& options) {
  const int height = torus_length(image.height());
  const int width = torus_length(image.width());
  return {extended_to_torus<Real>(image),
          converted<Real>(gabor_spectrum(options.components, height, width)), options.lambda};
}

template <typename Real>
double mean_gradient(const Plane<Real>& torus) {
  std::vector<Real> along_x(static_cast<std::size_t>(torus.width())), along_y(along_x.size());
  double sum = 0.0;
  for (int y = 0; y < torus.height(); ++y) {
    const int below = y + 1 == torus.height() ? 0 : y + 1;
    gradient_of_row<Real>(torus.row(y), torus.row(below), along_x, along_y);
    for (std::size_t x = 0; x < along_x.size(); ++x) sum += std::hypot(along_x[x], along_y[x]);
  }
  return sum / static_cast<double>(torus.size());
}

}  // namespace

template <typename Real>
TvGaborSolver<Real>::TvGaborSolver(const GreyImage& image, const TvGaborOptions& options)
    : options_(options),
      problem_(problem_of<Real>(image, options)),
      fft_(problem_.image.height(), problem_.image.width()),
      first_penalty_(kFirstPenalty / mean_gradient(problem_.image)),
      admm_(problem_, fft_, first_penalty_) {}

template <typename Real>
template <typename Other>
TvGaborSolver<Real>::TvGaborSolver(const GreyImage& image, const TvGaborOptions& options,
                                   const TvGaborSolver<Other>& former)
    : TvGaborSolver(image, options) {
  admm_.resume(former.admm());
  steps_ = former.steps();
}

template <typename Real>
SolverStop TvGaborSolver<Real>::run(Patience patience) {
  while (steps_ < options_.max_steps) {
    ++steps_;
    if (steps_ % kStepsBetweenChecks != 0 && steps_ != options_.max_steps) {
      admm_.step();
      continue;
    }
    const AdmmResiduals residuals = admm_.measured_step();
    check();
    if (certificate_.gap <= options_.gap) return SolverStop::converged;
    // Without steps left there is nothing to go on with, so this is the end, not a stall.
    const bool may_stall = patience == Patience::limited && steps_ < options_.max_steps;
    if (may_stall && is_stalled()) return SolverStop::stalled;
    balance(residuals);
  }
  return SolverStop::exhausted;
}

template <typename Real>
void TvGaborSolver<Real>::check() {
  certificate_ = certify(problem_, admm_.scaled_multiplier(), admm_.penalty(), fft_);
  gaps_.push_back(certificate_.gap);
}

template <typename Real>
bool TvGaborSolver<Real>::is_stalled() const {
  return gaps_.size() > kChecksToHalve &&
         gaps_.back() > 0.5 * gaps_[gaps_.size() - 1 - kChecksToHalve];
}

/// No fixed penalty suits all images: it follows the ratio of the residuals.
template <typename Real>
void TvGaborSolver<Real>::balance(const AdmmResiduals& residuals) {
  const double ratio = kPrimalEmphasis * residuals.primal / residuals.dual;
  if (!(ratio > kDeadBand || ratio < 1.0 / kDeadBand)) return;  // not a number: leave it as well
  const double factor = std::clamp(std::sqrt(ratio), 1.0 / kMostChange, kMostChange);
  const double penalty = std::clamp(admm_.penalty() * factor, first_penalty_ / kPenaltyRange,
                                    first_penalty_ * kPenaltyRange);
  admm_.scale_penalty(penalty / admm_.penalty());
}

template class TvGaborSolver<float>;
template class TvGaborSolver<double>;
template TvGaborSolver<double>::TvGaborSolver(const GreyImage&, const TvGaborOptions&,
                                              const TvGaborSolver<float>&);

}  // namespace touchtrial
