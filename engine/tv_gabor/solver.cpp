#include "engine/tv_gabor/solver.hpp"

#include "engine/tv_gabor/row_kernels.hpp"

#include <algorithm>
#include <cmath>
#include <cstddef>
#include <vector>

namespace touchtrial::engine {

/// With q = -p and u = f - v, the primal value is the sum of |grad u| + <q, grad v> / 2, and primal
/// minus dual is the sum of |grad u| - <q, grad u>: no term is negative, so nothing cancels between
/// pixels and the gap keeps its digits.
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
    GapSums of_block;
    for (int y = block.begin; y < block.end; ++y) {
      v.go_to(y);
      row_kernels<Real>().clip(field.x.row(y).data(), field.y.row(y).data(), width,
                               static_cast<Real>(scale), q_x.data(), q_y.data());
      of_block +=
          row_kernels<Real>().gap({.image = problem.image.row(y).data(),
                                   .image_below = problem.image.row((y + 1) % height).data(),
                                   .texture = v.row(),
                                   .texture_below = v.below(),
                                   .q_x = q_x.data(),
                                   .q_y = q_y.data()},
                                  width);
    }
    return of_block;
  });
  return sums.primal > 0.0 ? sums.difference / sums.primal : 0.0;
}

template double certified_gap(const TvGaborProblem<float>&, const VectorField<float>&, double,
                              TorusPlane<float>&, double);
template double certified_gap(const TvGaborProblem<double>&, const VectorField<double>&, double,
                              TorusPlane<double>&, double);

namespace {

/// First penalty, in units of the inverse mean gradient.
constexpr double kFirst = 6.0;
constexpr double kFall = 0.86;
constexpr int kChecksOfFall = 20;

/// Primal residuals count six times: equal residuals leave the penalty too small for the gap.
constexpr double kPrimalEmphasis = 6.0;
/// Ratios of residuals up to this count as balanced.
constexpr double kDeadBand = 1.2;
/// One correction changes the penalty at most by this factor.
constexpr double kMaxChange = 4.0;
/// The penalty stays within this factor of the first, either way.
constexpr double kRange = 1e4;

/// Momentum pauses after a check that finds more than this share of the last gap left.
constexpr double kSlowProgress = 0.95;

/// A solver stalls unless the gap falls to this share of itself within this many checks.
constexpr double kShareLeft = 0.7;
constexpr std::size_t kChecksToFall = 5;

}  // namespace

PenaltySchedule::PenaltySchedule(double mean_gradient)
    : first_penalty_(kFirst / mean_gradient), penalty_(first_penalty_) {}

bool PenaltySchedule::wants_residuals() const noexcept {
  return checks_ >= kChecksOfFall;
}

void PenaltySchedule::next(double gap, const AdmmResiduals& residuals) {
  ++checks_;
  pace_ = checks_ > 1 && gap > kSlowProgress * last_gap_ ? AdmmPace::cautious : AdmmPace::eager;
  last_gap_ = gap;
  if (checks_ <= kChecksOfFall) {
    penalty_ *= kFall;
  } else {
    balance(residuals);
  }
}

void PenaltySchedule::balance(const AdmmResiduals& residuals) {
  const double ratio = kPrimalEmphasis * residuals.primal / residuals.dual;
  if (!(ratio > kDeadBand || ratio < 1.0 / kDeadBand)) return;  // balanced, or not a number
  const double factor = std::clamp(std::sqrt(ratio), 1.0 / kMaxChange, kMaxChange);
  penalty_ = std::clamp(penalty_ * factor, first_penalty_ / kRange, first_penalty_ * kRange);
}

template <typename Real>
TvGaborSolver<Real>::TvGaborSolver(const GreyImage& image, const TvGaborOptions& options, int jobs)
    : height_(image.height()),
      width_(image.width()),
      wanted_gap_(options.gap),
      problem_(tv_gabor_problem<Real>(image, options)),
      plane_(problem_.image.height(), problem_.image.width(), jobs),
      schedule_(mean_gradient(problem_.image)),
      admm_(problem_, plane_) {}

template <typename Real>
SolverStop TvGaborSolver<Real>::run(int max_steps, Patience patience) {
  while (steps_ < max_steps) {
    step_to_check(max_steps);
    if (gap_ <= wanted_gap_) return SolverStop::converged;
    // Without steps left the run is exhausted, not stalled.
    const bool may_stall = patience == Patience::limited && steps_ < max_steps;
    if (may_stall && is_stalled()) return SolverStop::stalled;
  }
  return SolverStop::exhausted;
}

/// Certifies after every tenth step, because it costs as much as one; only then does the penalty
/// change.
template <typename Real>
void TvGaborSolver<Real>::step_to_check(int last) {
  const int left = PenaltySchedule::kStepsBetweenChecks;
  const int check = std::min(last, steps_ + left - steps_ % left);
  admm_.start_again(schedule_.penalty());
  for (; steps_ < check - 1; ++steps_) admm_.step(schedule_.pace());
  AdmmResiduals residuals;
  if (schedule_.wants_residuals()) {
    residuals = admm_.measured_last_step();
  } else {
    admm_.last_step();  // uninterrupted momentum can cycle
  }
  ++steps_;
  // The plane holds -div b, and -p = penalty b.
  gap_ = certified_gap(problem_, admm_.z(), admm_.penalty(), plane_, 1.0 / admm_.penalty());
  gaps_.push_back(gap_);
  schedule_.next(gap_, residuals);
}

/// The plane still holds what the last check filtered.
template <typename Real>
Plane<Real> TvGaborSolver<Real>::texture() const {
  return cropped_texture(plane_, admm_.penalty() / problem_.lambda, height_, width_);
}

template <typename Real>
bool TvGaborSolver<Real>::is_stalled() const {
  return gaps_.size() > kChecksToFall &&
         gaps_.back() > kShareLeft * gaps_[gaps_.size() - 1 - kChecksToFall];
}

template class TvGaborSolver<float>;
template class TvGaborSolver<double>;

}  // namespace touchtrial::engine
