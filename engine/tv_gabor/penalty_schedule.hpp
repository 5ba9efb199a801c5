/// \file The penalty of the TV-Gabor iteration, check by check.
/// Source: docs/method.md, "TV-Gabor".
#pragma once

#include "engine/tv_gabor/admm.hpp"

namespace touchtrial::engine {

/// Starts high and falls by the same factor at every check for 20 checks, which suits photographs:
/// they converge meanwhile. What has not converged then, drawings mostly, has its residuals
/// balanced. (Balanced from the start, photographs take up to twice as many steps.)
class PenaltySchedule {
 public:
  static constexpr int kStepsBetweenChecks = 10;

  /// \param mean_gradient  of the image, > 0: the penalty's natural unit is its inverse
  explicit PenaltySchedule(double mean_gradient);

  /// After every check. \param gap  >= 0 \param residuals  of the last step
  void next(double gap, const AdmmResiduals& residuals);

  /// Whether the next check looks at the residuals.
  [[nodiscard]] bool wants_residuals() const noexcept;
  [[nodiscard]] double penalty() const noexcept { return penalty_; }
  /// Momentum, unless the last check showed hardly any progress.
  [[nodiscard]] AdmmPace pace() const noexcept { return pace_; }

 private:
  void balance(const AdmmResiduals& residuals);

  double first_penalty_;
  double penalty_;
  double last_gap_ = 0.0;
  AdmmPace pace_ = AdmmPace::eager;
  int checks_ = 0;
};

}  // namespace touchtrial::engine
