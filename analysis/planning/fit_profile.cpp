#include "analysis/planning/fit_profile.hpp"

#include <algorithm>
#include <cmath>

namespace touchtrial::planning {
namespace {

/// Square root of 3.84, the 95 % point of chi-square with one degree of freedom.
constexpr double kRoot = 1.959964;
constexpr double kCloseEnough = 0.02;
constexpr int kMostFits = 12;
/// Nearer to a bound, an end is the bound's and not the data's.
constexpr double kHair = 1e-6;
/// Standard errors; so near to the best point only failed fits end.
constexpr double kCollapsed = 1e-3;

/// The best with one number held, and how far below the overall best that is, as a root.
struct Held {
  std::vector<double> at;
  double root = 0.0;
};

Held fitted_with(const FitProblem& problem, const Optimum& best, std::size_t number, double value,
                 const std::vector<double>& start, const std::vector<double>& covariance) {
  Bounds bounds = problem.bounds();
  bounds.lower[number] = value;
  bounds.upper[number] = value;
  const SmoothFunction function = [&](std::span<const double> at, std::span<double> slopes) {
    return problem.value(at, slopes);
  };
  OptimiserOptions options{.tolerance = 1e-5, .most_evaluations = 40};
  for (std::size_t i = 0; i < start.size(); ++i) {
    options.scales.push_back(std::sqrt(covariance[i * start.size() + i]));
  }
  const Optimum held = maximise(function, start, bounds, options);
  return {held.at, std::sqrt(std::max(0.0, 2.0 * (best.value - held.value)))};
}

/// Where the others go when one number moves, by the covariance.
std::vector<double> moved(const std::vector<double>& at, std::size_t number, double value,
                          const std::vector<double>& covariance) {
  const std::size_t n = at.size();
  std::vector<double> start = at;
  const double variance = covariance[number * n + number];
  for (std::size_t i = 0; i < n; ++i) {
    start[i] += covariance[i * n + number] / variance * (value - at[number]);
  }
  start[number] = value;
  return start;
}

/// A search that begins badly ends below what the best point's own numbers have.
Held best_with(const FitProblem& problem, const Optimum& best, std::size_t number, double value,
               const std::vector<double>& start, const std::vector<double>& covariance) {
  const Held held = fitted_with(problem, best, number, value, start, covariance);
  if (held.root < 2.0 * kRoot) return held;
  std::vector<double> plain = best.at;
  plain[number] = value;
  const Held again = fitted_with(problem, best, number, value, plain, covariance);
  return again.root < held.root ? again : held;
}

/// The roots are nearly straight lines of the value: secants from the best point. Nothing, too,
/// where that finds no end between the best point and the bound.
std::optional<double> end_of(const FitProblem& problem, const Optimum& best, std::size_t number,
                             const std::vector<double>& covariance, double bound, double sign) {
  const double middle = best.at[number];
  const double deviation = std::sqrt(covariance[number * best.at.size() + number]);
  const auto inside = [&](double value) {
    return sign > 0.0 ? std::min(value, bound) : std::max(value, bound);
  };
  const auto is_end = [&](double value) {
    return std::abs(value - bound) > kHair && std::abs(value - middle) > kCollapsed * deviation;
  };
  double near = middle;
  double near_root = 0.0;
  double value = inside(middle + sign * kRoot * deviation);
  std::vector<double> start = moved(best.at, number, value, covariance);
  for (int fit = 0; fit < kMostFits; ++fit) {
    const Held held = best_with(problem, best, number, value, start, covariance);
    if (std::abs(held.root - kRoot) < kCloseEnough) {
      return is_end(value) ? std::optional(value) : std::nullopt;
    }
    if (held.root < kRoot && value == bound) return std::nullopt;
    const double rise = (held.root - near_root) / (value - near);
    const double farthest = middle + 3.0 * (value - middle) + sign * 0.1 * deviation;
    double next = sign * rise > 0.0 ? value + (kRoot - held.root) / rise : farthest;
    if (sign * (next - farthest) > 0.0) next = farthest;
    if (sign * (next - middle) <= 0.0) next = 0.5 * (middle + value);
    start = held.at;
    near = value;
    near_root = held.root;
    value = inside(next);
    start[number] = value;
  }
  return std::nullopt;
}

}  // namespace

NumberInterval profile_interval(const FitProblem& problem, const Optimum& best, std::size_t number,
                                const std::vector<double>& covariance) {
  const auto end = [&](double bound, double sign) -> std::optional<double> {
    if (best.at[number] == bound) return std::nullopt;
    return end_of(problem, best, number, covariance, bound, sign);
  };
  return {end(problem.bounds().lower[number], -1.0), end(problem.bounds().upper[number], 1.0)};
}

}  // namespace touchtrial::planning
