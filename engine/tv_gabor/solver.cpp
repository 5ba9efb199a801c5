#include "engine/tv_gabor/solver.hpp"

#include "engine/tv_gabor/row_kernels.hpp"

#include <algorithm>
#include <cmath>
#include <cstddef>
#include <vector>

namespace touchtrial::engine {

/// With q = -p and u = f - v, the primal value is the sum of |grad u| + <q, grad v> / 2, and the
/// gap is the sum of |grad u| - <q, grad u>. No term is negative, so there is no cancellation
/// between pixels.
template <typename Real>
double certified_gap(const TvGaborProblem<Real>& problem, const VectorField<Real>& field,
                     double scale, TorusPlane<Real>& plane, double gain) {
  const int height = plane.height();
  const std::size_t width = plane.width();
  const auto unit = static_cast<Real>(1.0 / (problem.lambda * gain));
  plane.filter(problem.factors);
  const GapSums sums = plane.template sum_of_blocks<GapSums>([&](const RowBlock& block) {
    typename TorusPlane<Real>::Rows v(plane, block, unit);
    std::vector<Real> q_x(width), q_y(width);
    GapSums block_sums;
    for (int y = block.begin; y < block.end; ++y) {
      v.go_to(y);
      row_kernels<Real>().clip(field.x.row(y).data(), field.y.row(y).data(), width,
                               static_cast<Real>(scale), q_x.data(), q_y.data());
      block_sums +=
          row_kernels<Real>().gap({.image = problem.image.row(y).data(),
                                   .image_below = problem.image.row((y + 1) % height).data(),
                                   .texture = v.row(),
                                   .texture_below = v.row_below(),
                                   .q_x = q_x.data(),
                                   .q_y = q_y.data()},
                                  width);
    }
    return block_sums;
  });
  return sums.primal > 0.0 ? sums.difference / sums.primal : 0.0;
}

template double certified_gap(const TvGaborProblem<float>&, const VectorField<float>&, double,
                              TorusPlane<float>&, double);
template double certified_gap(const TvGaborProblem<double>&, const VectorField<double>&, double,
                              TorusPlane<double>&, double);

namespace {

/// Initial penalty, in units of the inverse mean gradient.
constexpr double kInitialPenalty = 6.0;
constexpr double kPenaltyDecay = 0.86;
constexpr int kDecayChecks = 20;

/// Weight of primal residuals: with equal weights the penalty would be too small for the gap.
constexpr double kPrimalEmphasis = 6.0;
/// Residual ratios up to this are balanced.
constexpr double kDeadBand = 1.2;
/// The maximum change of the penalty in one correction, as a factor.
constexpr double kMaxChange = 4.0;
/// The maximum deviation of the penalty from its initial value, as a factor.
constexpr double kRange = 1e4;

/// Momentum pauses after a check at which the gap exceeds this share of the previous gap.
constexpr double kSlowProgress = 0.95;

/// A solver stalls unless the gap falls to this share within kStallChecks.
constexpr double kStallShare = 0.7;
constexpr std::size_t kStallChecks = 5;

}  // namespace

PenaltySchedule::PenaltySchedule(double mean_gradient)
    : initial_penalty_(kInitialPenalty / mean_gradient), penalty_(initial_penalty_) {}

bool PenaltySchedule::needs_residuals() const noexcept {
  return checks_ >= kDecayChecks;
}

void PenaltySchedule::next(double gap, const AdmmResiduals& residuals) {
  ++checks_;
  pace_ = checks_ > 1 && gap > kSlowProgress * previous_gap_ ? AdmmPace::cautious : AdmmPace::eager;
  previous_gap_ = gap;
  if (checks_ <= kDecayChecks) {
    penalty_ *= kPenaltyDecay;
  } else {
    balance(residuals);
  }
}

void PenaltySchedule::balance(const AdmmResiduals& residuals) {
  const double ratio = kPrimalEmphasis * residuals.primal / residuals.dual;
  if (!(ratio > kDeadBand || ratio < 1.0 / kDeadBand)) return;  // balanced, or not a number
  const double factor = std::clamp(std::sqrt(ratio), 1.0 / kMaxChange, kMaxChange);
  penalty_ = std::clamp(penalty_ * factor, initial_penalty_ / kRange, initial_penalty_ * kRange);
}

template <typename Real>
TvGaborSolver<Real>::TvGaborSolver(const GreyImage& image, const TvGaborOptions& options, int jobs)
    : height_(image.height()),
      width_(image.width()),
      target_gap_(options.gap),
      problem_(tv_gabor_problem<Real>(image, options)),
      plane_(problem_.image.height(), problem_.image.width(), jobs),
      schedule_(mean_gradient(problem_.image)),
      admm_(problem_, plane_) {}

template <typename Real>
SolverStop TvGaborSolver<Real>::run(int max_steps, Patience patience) {
  while (steps_ < max_steps) {
    step_to_check(max_steps);
    if (gap_ <= target_gap_) return SolverStop::converged;
    // At max_steps the run is exhausted, not stalled.
    const bool may_stall = patience == Patience::limited && steps_ < max_steps;
    if (may_stall && is_stalled()) return SolverStop::stalled;
  }
  return SolverStop::exhausted;
}

/// Certifies and updates the penalty only after every tenth step, because a check costs as much as
/// a step.
template <typename Real>
void TvGaborSolver<Real>::step_to_check(int last_step) {
  constexpr int kInterval = PenaltySchedule::kStepsBetweenChecks;
  const int check = std::min(last_step, steps_ + kInterval - steps_ % kInterval);
  admm_.restart(schedule_.penalty());
  for (; steps_ < check - 1; ++steps_) admm_.step(schedule_.pace());
  AdmmResiduals residuals;
  if (schedule_.needs_residuals()) {
    residuals = admm_.measured_final_step();
  } else {
    admm_.final_step();  // a step without momentum, because uninterrupted momentum can cycle
  }
  ++steps_;
  // The plane holds -div b, and -p = penalty b.
  gap_ = certified_gap(problem_, admm_.z(), admm_.penalty(), plane_, 1.0 / admm_.penalty());
  gaps_.push_back(gap_);
  schedule_.next(gap_, residuals);
}

/// The plane contains the texture of the last check.
template <typename Real>
Plane<Real> TvGaborSolver<Real>::texture() const {
  return cropped_texture(plane_, admm_.penalty() / problem_.lambda, height_, width_);
}

template <typename Real>
bool TvGaborSolver<Real>::is_stalled() const {
  return gaps_.size() > kStallChecks &&
         gaps_.back() > kStallShare * gaps_[gaps_.size() - 1 - kStallChecks];
}

template class TvGaborSolver<float>;
template class TvGaborSolver<double>;

}  // namespace touchtrial::engine
