#include "engine/tv_gabor/solver.hpp"

#include <algorithm>
#include <cstddef>

namespace touchtrial::engine {
namespace {

/// The gap should fall to this share of itself within this many checks.
constexpr double kShareLeft = 0.7;
constexpr std::size_t kChecksToFall = 5;

}  // namespace

template <typename Real>
TvGaborSolver<Real>::TvGaborSolver(const GreyImage& image, const TvGaborOptions& options)
    : wanted_gap_(options.gap),
      problem_(tv_gabor_problem<Real>(image, options)),
      fft_(problem_.image.height(), problem_.image.width(), FftPlan::measured),
      schedule_(mean_gradient(problem_.image)),
      admm_(problem_, fft_, schedule_.penalty()) {
  admm_.start_again();
}

template <typename Real>
SolverStop TvGaborSolver<Real>::run(int max_steps, Patience patience) {
  while (steps_ < max_steps) {
    step_to_check(max_steps);
    if (certificate_.gap <= wanted_gap_) return SolverStop::converged;
    // Without steps left there is nothing to go on with, so this is the end, not a stall.
    const bool may_stall = patience == Patience::limited && steps_ < max_steps;
    if (may_stall && is_stalled()) return SolverStop::stalled;
  }
  return SolverStop::exhausted;
}

/// Certifying costs as much as a step; the penalty changes only then.
template <typename Real>
void TvGaborSolver<Real>::step_to_check(int last) {
  const int left = PenaltySchedule::kStepsBetweenChecks;
  const int check = std::min(last, steps_ + left - steps_ % left);
  for (; steps_ < check - 1; ++steps_) admm_.step(schedule_.pace());
  AdmmResiduals residuals;
  if (schedule_.wants_residuals()) {
    residuals = admm_.measured_step();
  } else {
    admm_.step(AdmmPace::cautious);  // momentum without a pause can go round in circles
  }
  ++steps_;
  certificate_ = certify(problem_, admm_.z(), admm_.penalty(), fft_);
  gaps_.push_back(certificate_.gap);
  schedule_.next(certificate_.gap, residuals);
  if (schedule_.penalty() != admm_.penalty()) admm_.set_penalty(schedule_.penalty());
  admm_.start_again();
}

template <typename Real>
bool TvGaborSolver<Real>::is_stalled() const {
  return gaps_.size() > kChecksToFall &&
         gaps_.back() > kShareLeft * gaps_[gaps_.size() - 1 - kChecksToFall];
}

template class TvGaborSolver<float>;
template class TvGaborSolver<double>;

}  // namespace touchtrial::engine
