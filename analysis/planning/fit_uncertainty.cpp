#include "analysis/planning/fit_uncertainty.hpp"

#include "core/cholesky.hpp"

#include <algorithm>
#include <cmath>

namespace touchtrial::planning {
namespace {

/// Fisher's information about the numbers, row-major.
std::vector<double> information_of(const FitCounts& counts, const FitProblem::Tangent& tangent) {
  const Cells sums = counts_by_layout(counts, counts.people);
  const auto& [table, slopes] = tangent;
  const auto classes = static_cast<std::size_t>(table.classes());
  std::vector<double> information(slopes.size() * slopes.size(), 0.0);
  for (std::size_t layout = 0; layout < sums.size(); ++layout) {
    for (std::size_t cell = 0; cell < sums[layout].size(); ++cell) {
      const std::size_t row = cell - cell % classes;
      const double presented = presentations(sums[layout], row, classes);
      const auto answers =
          table.answers(static_cast<int>(layout), static_cast<int>(cell / classes));
      const double weight = presented / clamped_probability(answers[cell % classes]);
      for (std::size_t i = 0; i < slopes.size(); ++i) {
        for (std::size_t j = 0; j < slopes.size(); ++j) {
          information[i * slopes.size() + j] +=
              weight * slopes[i][layout][cell] * slopes[j][layout][cell];
        }
      }
    }
  }
  return information;
}

/// \param matrix  row-major, symmetric, n x n
/// \return nothing if it is not positive definite to about 10 digits
std::optional<std::vector<double>> inverse_of(std::vector<double> matrix, std::size_t n) {
  constexpr double kMinShare = 1e-10;
  if (!factorise(matrix, n, kMinShare)) return std::nullopt;
  std::vector<double> inverse(n * n, 0.0);
  for (std::size_t column = 0; column < n; ++column) {
    std::vector<double> x(n, 0.0);
    x[column] = 1.0;
    solve_lower(matrix, x);
    solve_upper(matrix, x);
    for (std::size_t i = 0; i < n; ++i) inverse[i * n + column] = x[i];
  }
  return inverse;
}

/// Square root of 3.84, the 95 % point of chi-square with one degree of freedom.
constexpr double kNormalQuantile = 1.959964;
constexpr double kRootTolerance = 0.02;
constexpr int kMaxFits = 12;
/// An end closer to a bound than this is the bound itself, and not determined by the data.
constexpr double kBoundTolerance = 1e-6;
/// In standard errors; only failed fits end closer to the best point.
constexpr double kMinEndDistance = 1e-3;

/// The best point with one number fixed. `root` is the square root of twice the loss of log
/// likelihood.
struct ConstrainedFit {
  std::vector<double> point;
  double root = 0.0;
};

ConstrainedFit constrained_fit(const FittedProblem& fitted, std::size_t number, double value,
                               const std::vector<double>& start) {
  Bounds bounds = fitted.problem.bounds();
  bounds.lower[number] = value;
  bounds.upper[number] = value;
  OptimiserOptions options{.tolerance = 1e-5, .max_evaluations = 40};
  for (std::size_t i = 0; i < start.size(); ++i) {
    options.scales.push_back(std::sqrt(fitted.covariance[i * start.size() + i]));
  }
  const Optimum constrained = fitted.problem.maximise_from(start, bounds, options);
  return {constrained.point,
          std::sqrt(std::max(0.0, 2.0 * (fitted.best.value - constrained.value)))};
}

/// The best point with one number changed and the others moved along by the covariance.
std::vector<double> start_along_covariance(const FittedProblem& fitted, std::size_t number,
                                           double value) {
  std::vector<double> start = fitted.best.point;
  const std::size_t n = start.size();
  const double variance = fitted.covariance[number * n + number];
  for (std::size_t i = 0; i < n; ++i) {
    start[i] += fitted.covariance[i * n + number] / variance * (value - fitted.best.point[number]);
  }
  start[number] = value;
  return start;
}

/// Refits from the best point if a bad start left the likelihood too low.
ConstrainedFit best_constrained_fit(const FittedProblem& fitted, std::size_t number, double value,
                                    const std::vector<double>& start) {
  ConstrainedFit constrained = constrained_fit(fitted, number, value, start);
  if (constrained.root < kNormalQuantile) return constrained;
  std::vector<double> best_start = fitted.best.point;
  best_start[number] = value;
  ConstrainedFit refit = constrained_fit(fitted, number, value, best_start);
  return refit.root < constrained.root ? refit : constrained;
}

/// Follows secants from the best point: the roots are nearly linear in the value.
/// \return nothing if there is no end between the best point and the bound
std::optional<double> interval_end(const FittedProblem& fitted, std::size_t number, double bound,
                                   double sign) {
  const double best_value = fitted.best.point[number];
  const double deviation = std::sqrt(fitted.covariance[number * fitted.best.point.size() + number]);
  const auto within_bound = [&](double value) {
    return sign > 0.0 ? std::min(value, bound) : std::max(value, bound);
  };
  const auto is_end = [&](double value) {
    return std::abs(value - bound) > kBoundTolerance &&
           std::abs(value - best_value) > kMinEndDistance * deviation;
  };
  double previous_value = best_value;
  double previous_root = 0.0;
  double value = within_bound(best_value + sign * kNormalQuantile * deviation);
  std::vector<double> start = start_along_covariance(fitted, number, value);
  for (int fit = 0; fit < kMaxFits; ++fit) {
    const ConstrainedFit constrained = best_constrained_fit(fitted, number, value, start);
    if (std::abs(constrained.root - kNormalQuantile) < kRootTolerance) {
      return is_end(value) ? std::optional(value) : std::nullopt;
    }
    if (constrained.root < kNormalQuantile && value == bound) return std::nullopt;
    const double rise = (constrained.root - previous_root) / (value - previous_value);
    const double farthest_step = best_value + 3.0 * (value - best_value) + sign * 0.1 * deviation;
    double next =
        sign * rise > 0.0 ? value + (kNormalQuantile - constrained.root) / rise : farthest_step;
    if (sign * (next - farthest_step) > 0.0) next = farthest_step;
    if (sign * (next - best_value) <= 0.0) next = 0.5 * (best_value + value);
    start = constrained.point;
    previous_value = value;
    previous_root = constrained.root;
    value = within_bound(next);
    start[number] = value;
  }
  return std::nullopt;
}

}  // namespace

FittedProblem fitted_problem(const FitProblem& problem, const FitCounts& counts, Optimum best) {
  FitProblem::Tangent tangent = problem.tangent(best.point);
  std::vector<double> information = information_of(counts, tangent);
  const std::size_t n = best.point.size();
  auto covariance = inverse_of(information, n);
  // In a direction without information, the profile's search begins ten units away.
  constexpr double kRidge = 0.01;
  for (std::size_t i = 0; i < n; ++i) information[i * n + i] += kRidge;
  auto regularised_inverse = inverse_of(std::move(information), n);
  return {problem,
          counts,
          std::move(best),
          std::move(tangent),
          covariance.has_value(),
          covariance ? std::move(*covariance)
                     : regularised_inverse.value_or(std::vector<double>(n * n, 0.0))};
}

OpenInterval profile_interval(const FittedProblem& fitted, std::size_t number) {
  const auto end = [&](double bound, double sign) -> std::optional<double> {
    if (fitted.best.point[number] == bound) return std::nullopt;
    return interval_end(fitted, number, bound, sign);
  };
  const Bounds& bounds = fitted.problem.bounds();
  return {end(bounds.lower[number], -1.0), end(bounds.upper[number], 1.0)};
}

std::vector<double> monte_carlo_errors(const FittedProblem& fitted) {
  constexpr int kBankParts = 8;
  const std::size_t n = fitted.best.point.size();
  std::vector<double> squares(n, 0.0);
  if (!fitted.identifiable) return squares;
  const FitProblem& problem = fitted.problem;
  const simulation::SubjectModel subject = problem.subject_at(fitted.best.point);
  const Cells counts = counts_by_layout(fitted.counts, fitted.counts.people);
  const std::size_t classes = fitted.counts.classes.size();
  for (int part = 0; part < kBankParts; ++part) {
    const AnswerTable part_table =
        problem.model().answers(subject, fitted.counts.layouts, false, {part, kBankParts});
    std::vector<double> score(n, 0.0);
    for (std::size_t layout = 0; layout < counts.size(); ++layout) {
      for (std::size_t cell = 0; cell < counts[layout].size(); ++cell) {
        const auto place = static_cast<int>(cell / classes);
        const std::size_t answer = cell % classes;
        const double presented = presentations(counts[layout], cell - answer, classes);
        const double p = fitted.tangent.table.answers(static_cast<int>(layout), place)[answer];
        const double difference = part_table.answers(static_cast<int>(layout), place)[answer] - p;
        const double weight = presented * difference / std::max(p, kMinProbability);
        for (std::size_t i = 0; i < n; ++i) {
          score[i] += weight * fitted.tangent.slopes[i][layout][cell];
        }
      }
    }
    for (std::size_t i = 0; i < n; ++i) {
      double shift = 0.0;
      for (std::size_t j = 0; j < n; ++j) shift += fitted.covariance[i * n + j] * score[j];
      squares[i] += shift * shift;
    }
  }
  for (double& value : squares) value = std::sqrt(value / (kBankParts * (kBankParts - 1.0)));
  return squares;
}

}  // namespace touchtrial::planning
