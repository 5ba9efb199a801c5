#include "engine/tv_gabor/penalty_schedule.hpp"

#include <algorithm>
#include <cmath>

namespace touchtrial::engine {
namespace {

/// Times the inverse of the mean gradient.
constexpr double kFirst = 6.0;
constexpr double kFall = 0.86;
constexpr int kChecksOfFall = 20;

/// Primal residuals count six times. With the gap as stop, equal residuals leave the penalty too
/// small.
constexpr double kPrimalEmphasis = 6.0;
/// Ratios of residuals up to this are balanced enough; one correction changes at most this much.
constexpr double kDeadBand = 1.2;
constexpr double kMostChange = 4.0;
/// How far the penalty may wander from the first, either way.
constexpr double kRange = 1e4;

/// Momentum pauses where a check finds more than this share of the last gap left.
constexpr double kHardlyAnyProgress = 0.95;

}  // namespace

PenaltySchedule::PenaltySchedule(double mean_gradient)
    : first_penalty_(kFirst / mean_gradient), penalty_(first_penalty_) {}

bool PenaltySchedule::wants_residuals() const noexcept {
  return checks_ >= kChecksOfFall;
}

void PenaltySchedule::next(double gap, const AdmmResiduals& residuals) {
  ++checks_;
  pace_ =
      checks_ > 1 && gap > kHardlyAnyProgress * last_gap_ ? AdmmPace::cautious : AdmmPace::eager;
  last_gap_ = gap;
  if (checks_ <= kChecksOfFall) {
    penalty_ *= kFall;
  } else {
    balance(residuals);
  }
}

void PenaltySchedule::balance(const AdmmResiduals& residuals) {
  const double ratio = kPrimalEmphasis * residuals.primal / residuals.dual;
  if (!(ratio > kDeadBand || ratio < 1.0 / kDeadBand)) return;  // not a number: leave it as well
  const double factor = std::clamp(std::sqrt(ratio), 1.0 / kMostChange, kMostChange);
  penalty_ = std::clamp(penalty_ * factor, first_penalty_ / kRange, first_penalty_ * kRange);
}

}  // namespace touchtrial::engine
