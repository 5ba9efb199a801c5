/// \file Power against the number of participants: a curve fitted to simulated studies, and its
/// figure. Source: docs/planning.md, "The power curve".
#pragma once

#include "analysis/report/figures/figure.hpp"
#include "analysis/statistics/proportion.hpp"

#include <optional>
#include <span>
#include <string>
#include <vector>

namespace touchtrial::planning {

/// The simulated studies of one size.
struct PowerPoint {
  int participants = 0;              ///< >= 2
  analysis::Proportion successes{};  ///< studies that reach the goal
};

struct PowerSeries {
  std::string name;                ///< "60 trials"; empty if the curve has one series
  std::vector<PowerPoint> points;  ///< by size, rising
};

struct PowerCurve {
  std::string study;
  std::string goal;  ///< what a study reaches: "significant difference"
  std::vector<PowerSeries> series;
};

/// power(n) = Phi(intercept + slope sqrt(n)), which is the power of a z test of a mean with slope
/// = effect / SD and intercept = -z of its level.
struct PowerFit {
  double intercept = 0.0;
  double slope = 0.0;  ///< >= 0

  [[nodiscard]] double power(double participants) const;
};

/// The maximum-likelihood fit, each size binomial.
/// \return nothing with fewer than two sizes, or if all studies or none reached the goal
[[nodiscard]] std::optional<PowerFit> fit_power(std::span<const PowerPoint> points);

/// The smallest size with this power by the fit, without extrapolation.
/// \param target  in (0, 1)
/// \return nothing if the first size exceeds the target already or the last does not reach it
[[nodiscard]] std::optional<int> size_with_power(const PowerFit& fit,
                                                 std::span<const PowerPoint> points, double target);

/// Plots the shares of simulated studies with Wilson's 95 % intervals, the fits, and the size with
/// 80 % power.
[[nodiscard]] analysis::Figure power_figure(const PowerCurve& curve);

}  // namespace touchtrial::planning
