#include "protocols/procedures/estimates.hpp"

#include <algorithm>
#include <array>
#include <cmath>
#include <functional>
#include <limits>
#include <memory>
#include <new>
#include <numeric>
#include <stdexcept>

#include <nlopt.h>

namespace touchtrial::procedures {
namespace {

/// An observer as numbers: threshold, logarithm of the width, lapse rate.
constexpr std::size_t kParameters = 3;
using Parameters = std::array<double, kParameters>;

/// The log-likelihood of impossible answers, because NLopt does not accept an infinite value.
constexpr double kImpossible = -1e300;

struct SearchState {
  std::function<double(const double*)> value;
};

double value_of_state(unsigned /*count*/, const double* point, double* /*slopes*/, void* state) {
  return static_cast<SearchState*>(state)->value(point);
}

/// Searches with NLopt's Subplex (Rowan 1990), which needs no derivatives. The state stores the
/// best point, so the result code does not matter.
void search_subplex(SearchState& state, std::vector<double> start, const std::vector<double>& low,
                    const std::vector<double>& high, const std::vector<double>& step) {
  const std::unique_ptr<nlopt_opt_s, decltype(&nlopt_destroy)> solver(
      nlopt_create(NLOPT_LN_SBPLX, static_cast<unsigned>(start.size())), &nlopt_destroy);
  if (!solver) throw std::bad_alloc();
  nlopt_set_max_objective(solver.get(), &value_of_state, &state);
  nlopt_set_lower_bounds(solver.get(), low.data());
  nlopt_set_upper_bounds(solver.get(), high.data());
  nlopt_set_initial_step(solver.get(), step.data());
  nlopt_set_ftol_abs(solver.get(), 1e-11);
  nlopt_set_xtol_rel(solver.get(), 1e-8);
  nlopt_set_maxeval(solver.get(), 3000);
  double final_value = 0.0;
  nlopt_optimize(solver.get(), start.data(), &final_value);
}

/// Searches for the maximum of the likelihood of counts over the free parameters, within their
/// bounds.
class FitSearch {
 public:
  FitSearch(std::span<const LevelCounts> counts, const FitOptions& options);

  /// \param start  empty: the search starts from a coarse grid
  [[nodiscard]] Fit best(std::optional<Observer> start) const;

 private:
  [[nodiscard]] Observer observer_of(const Parameters& parameters) const;
  [[nodiscard]] Parameters parameters_of(const Observer& observer) const;
  /// Finds starting points on a coarse grid of thresholds and widths. Each width that fits better
  /// than the neighbouring widths gives one point, at its best threshold. A width of half the range
  /// always gives one, because the grid might miss a maximum near it.
  [[nodiscard]] std::vector<Parameters> coarse_starts(const Parameters& lower,
                                                      const Parameters& upper, double lapse) const;
  /// The likelihood of few answers has several maxima, often a steep one with lapses and a flat one
  /// without, so it is searched from several lapses and widths.
  [[nodiscard]] Fit search_all(const Parameters& lower, const Parameters& upper) const;
  [[nodiscard]] Fit search(Parameters start, Parameters lower, Parameters upper) const;

  std::span<const LevelCounts> counts_;
  FitOptions options_;
  double width_at_one_;
  double range_ = 0.0;
  Parameters lower_{};
  Parameters upper_{};
};

void require_fit(std::span<const LevelCounts> counts, const FitOptions& options) {
  double previous_level = -std::numeric_limits<double>::infinity();
  for (const LevelCounts& point : counts) {
    if (!std::isfinite(point.level) || point.level <= previous_level || point.n < 1 ||
        point.correct < 0 || point.correct > point.n) {
      throw std::invalid_argument("a fit needs ascending levels, each with 0 <= correct <= n");
    }
    previous_level = point.level;
  }
  if (counts.size() < 2) throw std::invalid_argument("a fit needs answers at two levels or more");
  const double max_lapse = options.lapse.value_or(options.max_lapse);
  require_possible({options.shape, 0.0, options.slope.value_or(1.0), options.guess, max_lapse});
}

FitSearch::FitSearch(std::span<const LevelCounts> counts, const FitOptions& options)
    : counts_(counts), options_(options), width_at_one_(width_at_slope_one(options.shape)) {
  require_fit(counts, options);
  range_ = counts.back().level - counts.front().level;
  double min_distance = range_;
  for (std::size_t i = 1; i < counts.size(); ++i) {
    min_distance = std::min(min_distance, counts[i].level - counts[i - 1].level);
  }
  lower_ = {counts.front().level - range_, std::log(min_distance / 4.0), 0.0};
  upper_ = {counts.back().level + range_, std::log(range_ * 5.0), options.max_lapse};
  if (options.slope) lower_[1] = upper_[1] = std::log(width_at_one_ / *options.slope);
  if (options.lapse) lower_[2] = upper_[2] = *options.lapse;
}

Observer FitSearch::observer_of(const Parameters& parameters) const {
  return {options_.shape, parameters[0], width_at_one_ / std::exp(parameters[1]), options_.guess,
          parameters[2]};
}

Parameters FitSearch::parameters_of(const Observer& observer) const {
  return {observer.threshold, std::log(width_at_one_ / observer.slope), observer.lapse};
}

std::vector<Parameters> FitSearch::coarse_starts(const Parameters& lower, const Parameters& upper,
                                                 double lapse) const {
  constexpr std::size_t kWidths = 7;
  const int thresholds = lower[0] < upper[0] ? 17 : 1;
  std::array<Parameters, kWidths> best{};
  std::array<double, kWidths> max{};
  for (std::size_t w = 0; w < kWidths; ++w) {
    const double width = range_ * std::pow(0.5, static_cast<double>(w));
    for (int t = 0; t < thresholds; ++t) {
      const double threshold = counts_.front().level + range_ * t / std::max(1, thresholds - 1);
      Parameters parameters{threshold, std::log(width), lapse};
      for (std::size_t i = 0; i < kParameters; ++i) {
        parameters[i] = std::clamp(parameters[i], lower[i], upper[i]);
      }
      const double value = log_likelihood(observer_of(parameters), counts_);
      if (t > 0 && !(value > max[w])) continue;
      max[w] = value;
      best[w] = parameters;
    }
  }
  std::vector<Parameters> starts;
  for (std::size_t w = 0; w < kWidths; ++w) {
    const bool beats_wider = w == 0 || max[w] > max[w - 1];
    const bool beats_narrower = w + 1 == kWidths || max[w] >= max[w + 1];
    if (beats_wider && beats_narrower) starts.push_back(best[w]);
  }
  starts.push_back(best[1]);
  return starts;
}

/// Searches over the free parameters, which are those whose bounds differ.
Fit FitSearch::search(Parameters start, Parameters lower, Parameters upper) const {
  std::vector<std::size_t> free;
  for (std::size_t i = 0; i < kParameters; ++i) {
    start[i] = std::clamp(start[i], lower[i], upper[i]);
    if (lower[i] < upper[i]) free.push_back(i);
  }
  Parameters best = start;
  double max = log_likelihood(observer_of(best), counts_);
  SearchState state{[&](const double* point) {
    Parameters parameters = start;
    for (std::size_t i = 0; i < free.size(); ++i) parameters[free[i]] = point[i];
    const double value = log_likelihood(observer_of(parameters), counts_);
    if (value > max) {
      max = value;
      best = parameters;
    }
    return std::max(value, kImpossible);
  }};
  if (!free.empty()) {
    std::vector<double> free_start;
    std::vector<double> low;
    std::vector<double> high;
    std::vector<double> step;
    for (const std::size_t i : free) {
      free_start.push_back(start[i]);
      low.push_back(lower[i]);
      high.push_back(upper[i]);
      step.push_back(i == 0 ? 0.1 * range_ : i == 1 ? 0.3 : 0.1 * (upper[i] - lower[i]));
    }
    search_subplex(state, std::move(free_start), low, high, step);
  }
  const Observer observer = observer_of(best);
  return {observer, max, procedures::deviance(observer, counts_)};
}

Fit FitSearch::search_all(const Parameters& lower, const Parameters& upper) const {
  std::optional<Fit> best;
  std::optional<double> previous_lapse;
  for (const double share : {0.0, 0.2, 1.0}) {
    const double lapse = std::clamp(share * options_.max_lapse, lower[2], upper[2]);
    if (previous_lapse == lapse) continue;
    previous_lapse = lapse;
    for (const Parameters& start : coarse_starts(lower, upper, lapse)) {
      const Fit fit = search(start, lower, upper);
      if (!best || fit.log_likelihood > best->log_likelihood) best = fit;
    }
  }
  return *best;
}

Fit FitSearch::best(std::optional<Observer> start) const {
  Fit fit = start ? search(parameters_of(*start), lower_, upper_) : search_all(lower_, upper_);
  // Subplex may stop on a ridge, so the search is restarted there.
  constexpr int kMaxRepeats = 4;
  constexpr double kGain = 1e-9;
  for (int repeat = 0; repeat < kMaxRepeats; ++repeat) {
    const double previous = fit.log_likelihood;
    fit = search(parameters_of(fit.observer), lower_, upper_);
    if (!(fit.log_likelihood > previous + kGain)) break;
  }
  return fit;
}

std::vector<LevelCounts> simulated_counts(const Observer& observer,
                                          std::span<const LevelCounts> observed,
                                          RandomStream& random) {
  std::vector<LevelCounts> counts(observed.begin(), observed.end());
  for (LevelCounts& point : counts) {
    const double share = shares_at(observer, point.level).correct;
    point.correct = 0;
    for (std::int64_t i = 0; i < point.n; ++i) point.correct += random.uniform() < share ? 1 : 0;
  }
  return counts;
}

}  // namespace

Fit fit_observer(std::span<const LevelCounts> counts, const FitOptions& options) {
  return FitSearch(counts, options).best(std::nullopt);
}

GoodnessOfFit goodness_of_fit(std::span<const LevelCounts> counts, const FitOptions& options,
                              int draws, RandomStream& random) {
  if (draws < 1) throw std::invalid_argument("goodness of fit needs at least one draw");
  const Fit fit = fit_observer(counts, options);
  GoodnessOfFit result{fit.deviance};
  int as_extreme = 0;
  for (int i = 0; i < draws; ++i) {
    const std::vector<LevelCounts> simulated = simulated_counts(fit.observer, counts, random);
    const Fit refit = FitSearch(simulated, options).best(fit.observer);
    if (refit.deviance >= fit.deviance) ++as_extreme;
    result.thresholds.push_back(refit.observer.threshold);
  }
  std::sort(result.thresholds.begin(), result.thresholds.end());
  result.p = (as_extreme + 1.0) / (draws + 1.0);
  return result;
}

}  // namespace touchtrial::procedures
