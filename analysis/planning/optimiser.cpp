#include "analysis/planning/optimiser.hpp"

#include <algorithm>
#include <cmath>
#include <exception>
#include <limits>
#include <memory>
#include <stdexcept>

#include <nlopt.h>

namespace touchtrial::planning {
namespace {

using Solver = std::unique_ptr<nlopt_opt_s, decltype(&nlopt_destroy)>;

/// State passed through the C library, which works with numbers divided by their scales.
struct Search {
  const SmoothFunction& function;
  std::vector<double> scales;
  nlopt_opt solver = nullptr;
  Optimum best{};
  std::exception_ptr failure{};
};

double evaluate_scaled(Search& search, std::span<const double> scaled, std::span<double> slopes) {
  std::vector<double> point(scaled.begin(), scaled.end());
  for (std::size_t i = 0; i < point.size(); ++i) point[i] *= search.scales[i];
  const double value = search.function(point, slopes);
  for (std::size_t i = 0; i < slopes.size(); ++i) slopes[i] *= search.scales[i];
  if (value > search.best.value) {
    search.best.value = value;
    search.best.point = std::move(point);
  }
  return value;
}

double evaluate(unsigned count, const double* point, double* slopes, void* data) noexcept {
  Search& search = *static_cast<Search*>(data);
  try {
    return evaluate_scaled(search, {point, count}, {slopes, slopes != nullptr ? count : 0});
  } catch (...) {
    search.failure = std::current_exception();
    nlopt_force_stop(search.solver);
    return 0.0;
  }
}

std::vector<double> quotients(std::vector<double> numbers, const std::vector<double>& scales) {
  for (std::size_t i = 0; i < numbers.size(); ++i) numbers[i] /= scales[i];
  return numbers;
}

}  // namespace

Optimum maximise(const SmoothFunction& function, std::vector<double> start, const Bounds& bounds,
                 const OptimiserOptions& options) {
  for (std::size_t i = 0; i < start.size(); ++i) {
    start[i] = std::clamp(start[i], bounds.lower[i], bounds.upper[i]);
  }
  if (start.empty()) return {start, function(start, {})};
  const Solver solver(nlopt_create(NLOPT_LD_SLSQP, static_cast<unsigned>(start.size())),
                      &nlopt_destroy);
  if (!solver) throw std::bad_alloc();
  Search search{function,
                options.scales.empty() ? std::vector<double>(start.size(), 1.0) : options.scales,
                solver.get(),
                {start, -std::numeric_limits<double>::infinity()},
                {}};
  nlopt_set_lower_bounds(solver.get(), quotients(bounds.lower, search.scales).data());
  nlopt_set_upper_bounds(solver.get(), quotients(bounds.upper, search.scales).data());
  nlopt_set_max_objective(solver.get(), &evaluate, &search);
  nlopt_set_ftol_rel(solver.get(), options.tolerance);
  nlopt_set_maxeval(solver.get(), options.max_evaluations);
  std::vector<double> scaled = quotients(start, search.scales);
  double value = 0.0;
  // The best point is the answer, whether the search converged or not.
  static_cast<void>(nlopt_optimize(solver.get(), scaled.data(), &value));
  if (search.failure) std::rethrow_exception(search.failure);
  return search.best;
}

}  // namespace touchtrial::planning
