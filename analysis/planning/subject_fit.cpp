#include "analysis/planning/subject_fit.hpp"

#include "analysis/planning/fit_bootstrap.hpp"
#include "analysis/planning/fit_profile.hpp"
#include "analysis/planning/fit_swaps.hpp"
#include "analysis/planning/fit_warnings.hpp"
#include "analysis/planning/symmetric_matrix.hpp"
#include "analysis/statistics/quantiles.hpp"

#include <algorithm>
#include <array>
#include <cmath>

namespace touchtrial::planning {
namespace {

constexpr int kBankParts = 8;
constexpr double kLowTail = 0.025;
constexpr double kHighTail = 0.975;
// Shares of the time, by experience.
constexpr double kSearched = 0.3;
constexpr double kProfiled = 0.9;

/// What everything after the search starts from.
struct Fitted {
  const FitProblem& problem;
  const FitCounts& counts;
  Optimum best;
  FitProblem::Tangent tangent;
  bool informed = false;           ///< whether the answers tell of every number
  std::vector<double> covariance;  ///< of the numbers; vague where they do not
};

/// A search ends a hair from a bound that it means.
void snap_to_bounds(std::vector<double>& at, const Bounds& bounds) {
  constexpr double kHair = 1e-6;
  for (std::size_t i = 0; i < at.size(); ++i) {
    if (at[i] - bounds.lower[i] < kHair) at[i] = bounds.lower[i];
    if (bounds.upper[i] - at[i] < kHair) at[i] = bounds.upper[i];
  }
}

Fitted fitted_at(const FitProblem& problem, const FitCounts& counts, Optimum best) {
  FitProblem::Tangent tangent = problem.tangent(best.at);
  std::vector<double> information = problem.evidence().information(tangent.table, tangent.slopes);
  const std::size_t n = best.at.size();
  auto covariance = inverse_of(information, n);
  // Where nothing is known of a direction, begin to look ten units away.
  constexpr double kVague = 0.01;
  for (std::size_t i = 0; i < n; ++i) information[i * n + i] += kVague;
  auto vague = inverse_of(std::move(information), n);
  return {problem,
          counts,
          std::move(best),
          std::move(tangent),
          covariance.has_value(),
          covariance ? std::move(*covariance) : vague.value_or(std::vector<double>(n * n, 0.0))};
}

Fitted at_best(const FitProblem& problem, const FitCounts& counts,
               const session::SubjectModel& subject) {
  const SmoothFunction function = [&](std::span<const double> at, std::span<double> slopes) {
    return problem.value(at, slopes);
  };
  Optimum best = maximise(function, problem.numbers_of(subject), problem.bounds(),
                          {.tolerance = 1e-9, .scales = problem.scales()});
  snap_to_bounds(best.at, problem.bounds());
  best.value = problem.value(best.at, {});
  return fitted_at(problem, counts, std::move(best));
}

/// What a parameter is called, and its number as people read it.
double readable(const Parameter& parameter, double number) {
  return parameter.kind == ParameterKind::weber ? std::exp(number) : number;
}

std::string name_of(const Parameter& parameter) {
  switch (parameter.kind) {
    case ParameterKind::weber:
      return "weber";
    case ParameterKind::lapse:
      return "lapse";
    case ParameterKind::position:
      return "position";
    case ParameterKind::class_bias:
      return "class";
  }
  return "";
}

/// A lapse cannot be less than 0: that end is known, whatever the data.
OpenInterval readable(const Parameter& parameter, const NumberInterval& interval) {
  OpenInterval open;
  if (interval.lower) open.lower = readable(parameter, *interval.lower);
  if (interval.upper) open.upper = readable(parameter, *interval.upper);
  if (parameter.kind == ParameterKind::lapse && !open.lower) open.lower = 0.0;
  return open;
}

/// By how much the estimates would move if the bank were only its parts, as a standard error of the
/// whole: the parts' probabilities differ, and the score with them.
std::vector<double> monte_carlo_errors(const Fitted& fitted) {
  const std::size_t n = fitted.best.at.size();
  std::vector<double> squares(n, 0.0);
  if (!fitted.informed) return squares;
  const FitProblem& problem = fitted.problem;
  const session::SubjectModel subject = problem.subject_at(fitted.best.at);
  const std::vector<std::vector<double>> counts = by_layout(fitted.counts, fitted.counts.people);
  const int classes = fitted.counts.class_count();
  for (int part = 0; part < kBankParts; ++part) {
    const AnswerTable own =
        problem.model().answers(subject, fitted.counts.layouts, false, {part, kBankParts});
    std::vector<double> score(n, 0.0);
    for (std::size_t layout = 0; layout < counts.size(); ++layout) {
      for (std::size_t cell = 0; cell < counts[layout].size(); ++cell) {
        const auto place = static_cast<int>(cell) / classes;
        const int answer = static_cast<int>(cell) % classes;
        double presented = 0.0;
        for (int c = 0; c < classes; ++c) presented += counts[layout][place * classes + c];
        const double p = fitted.tangent.table.answers(static_cast<int>(layout), place)[answer];
        const double apart = own.answers(static_cast<int>(layout), place)[answer] - p;
        const double weight = presented * apart / std::max(p, kLeastProbability);
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

ParameterEstimate estimate_of(const Fitted& fitted, std::size_t number, double monte_carlo_error) {
  const Parameter& parameter = fitted.problem.parameters()[number];
  const double at = fitted.best.at[number];
  ParameterEstimate estimate;
  estimate.name = name_of(parameter);
  if (parameter.kind == ParameterKind::class_bias) {
    estimate.label = fitted.counts.classes[parameter.class_index];
  }
  estimate.value = readable(parameter, at);
  const Bounds& bounds = fitted.problem.bounds();
  estimate.at_bound = at == bounds.lower[number] || at == bounds.upper[number];
  if (fitted.informed) {
    const std::size_t n = fitted.best.at.size();
    estimate.standard_error = std::sqrt(fitted.covariance[number * n + number]);
  }
  estimate.profile =
      readable(parameter, profile_interval(fitted.problem, fitted.best, number, fitted.covariance));
  estimate.monte_carlo_error = monte_carlo_error;
  return estimate;
}

/// A number of a bootstrap's draw; the eliminated class's follows from the others.
double number_of(const Fitted& fitted, const ParameterEstimate& estimate,
                 const std::vector<double>& numbers) {
  double others = 0.0;
  for (std::size_t i = 0; i < numbers.size(); ++i) {
    const Parameter& parameter = fitted.problem.parameters()[i];
    const bool is_class = parameter.kind == ParameterKind::class_bias;
    const std::string label = is_class ? fitted.counts.classes[parameter.class_index] : "";
    if (estimate.name == name_of(parameter) && estimate.label == label) {
      return readable(parameter, numbers[i]);
    }
    if (is_class) others += numbers[i];
  }
  return -others;
}

void add_bootstrap(const Fitted& fitted, const FitBootstrap& bootstrap, SubjectFit& fit) {
  fit.bootstraps = static_cast<int>(bootstrap.g_squared.size());
  if (fit.bootstraps == 0) return;
  const auto at_least = std::ranges::count_if(bootstrap.g_squared,
                                              [&](double value) { return value >= fit.g_squared; });
  fit.p = (1.0 + static_cast<double>(at_least)) / (1.0 + fit.bootstraps);
  for (ParameterEstimate& estimate : fit.estimates) {
    std::vector<double> values;
    for (const std::vector<double>& numbers : bootstrap.numbers) {
      values.push_back(number_of(fitted, estimate, numbers));
    }
    std::ranges::sort(values);
    estimate.bootstrap = {analysis::quantile(values, kLowTail).value(),
                          analysis::quantile(values, kHighTail).value()};
  }
}

std::optional<double> correlation(const Fitted& fitted) {
  const auto& parameters = fitted.problem.parameters();
  const std::size_t n = parameters.size();
  const bool both = n >= 2 && parameters[0].kind == ParameterKind::weber &&
                    parameters[1].kind == ParameterKind::lapse;
  if (!both || !fitted.informed) return std::nullopt;
  return fitted.covariance[1] / std::sqrt(fitted.covariance[0] * fitted.covariance[n + 1]);
}

/// Cells of the confusions that were free to vary, less what was estimated.
int degrees_of_freedom(const Confusions& observed, std::size_t estimated) {
  int cells = 0;
  for (const auto& method : observed) {
    for (const std::vector<double>& row : method) {
      double presented = 0.0;
      for (const double count : row) presented += count;
      if (presented > 0.0) cells += static_cast<int>(row.size()) - 1;
    }
  }
  return std::max(0, cells - static_cast<int>(estimated));
}

SubjectFit described(const FitCounts& counts) {
  SubjectFit fit;
  fit.participants = static_cast<int>(counts.people.size());
  fit.trials = counts.trials;
  fit.no_response = counts.no_response;
  fit.classes = counts.classes;
  fit.methods = counts.methods;
  fit.observed = observed_confusions(counts, counts.people);
  return fit;
}

/// All estimates in the order of the parameters, and the eliminated class's before the others'.
void estimate(const Fitted& fitted, const Fitted& otherwise, const FitProgress& progress,
              SubjectFit& fit) {
  const auto add = [&](const Fitted& from, std::size_t number, const std::vector<double>& errors) {
    fit.estimates.push_back(estimate_of(from, number, errors[number]));
    const double share = static_cast<double>(fit.estimates.size()) /
                         (static_cast<double>(fitted.best.at.size()) + 1.0);
    if (progress) progress(kSearched + (kProfiled - kSearched) * share);
  };
  const std::vector<double> errors = monte_carlo_errors(fitted);
  const std::vector<double> other_errors = monte_carlo_errors(otherwise);
  const auto& others = otherwise.problem.parameters();
  const auto eliminated = std::ranges::find(others, Parameter{ParameterKind::class_bias, 0});
  bool first_class = true;
  for (std::size_t i = 0; i < fitted.best.at.size(); ++i) {
    const bool is_class = fitted.problem.parameters()[i].kind == ParameterKind::class_bias;
    if (is_class && first_class && eliminated != others.end()) {
      add(otherwise, static_cast<std::size_t>(eliminated - others.begin()), other_errors);
      first_class = false;
    }
    add(fitted, i, errors);
  }
}

}  // namespace

Optimum best_of_starts(const FitProblem& problem, const session::SubjectModel& subject) {
  constexpr std::array<double, 4> kWeber{0.1, 0.3, 0.8, 2.0};
  constexpr std::array<double, 2> kLapse{0.02, 0.2};
  std::vector<Optimum> starts;
  for (const double weber : kWeber) {
    for (const double lapse : kLapse) {
      session::SubjectModel start = subject;
      start.weber = weber;
      start.lapse = lapse;
      const std::vector<double> at = problem.numbers_of(start);
      starts.push_back({at, problem.value(at, {})});
    }
  }
  std::ranges::stable_sort(starts, std::ranges::greater{}, &Optimum::value);
  const SmoothFunction function = [&](std::span<const double> at, std::span<double> slopes) {
    return problem.value(at, slopes);
  };
  const OptimiserOptions coarse{.tolerance = 1e-6, .scales = problem.scales()};
  Optimum best = maximise(function, problem.numbers_of(subject), problem.bounds(), coarse);
  // The grid's best, and the best of another noise.
  const Optimum from_grid = maximise(function, starts.front().at, problem.bounds(), coarse);
  if (from_grid.value > best.value) best = from_grid;
  return best;
}

SubjectFit fit_subject(const AnswerModel& model, const FitCounts& counts,
                       const session::SubjectModel& subject, const FitOptions& options,
                       const FitProgress& progress) {
  const CountsEvidence evidence(counts, counts.people);
  FreeParameters used = options.free;
  if (counts.layouts.size() < 2 && used.classes) used.position = false;
  const SwapSearch search = search_swaps(model, evidence, subject, used);
  if (progress) progress(kSearched);
  const FitProblem problem(model, evidence, search.subject, used);
  const FitProblem otherwise(model, evidence, search.subject, used, 1);
  const Fitted fitted = at_best(problem, counts, search.subject);
  SubjectFit fit = described(counts);
  fit.subject = problem.subject_at(fitted.best.at);
  const Fitted other =
      fitted_at(otherwise, counts, {otherwise.numbers_of(fit.subject), fitted.best.value});
  fit.swaps = search.candidates;
  fit.swap_threshold = search.threshold;
  fit.log_likelihood = fitted.best.value;
  fit.expected = expected_confusions(counts, fitted.tangent.table);
  fit.g_squared = g_squared(fit.observed, fit.expected);
  fit.degrees_of_freedom = degrees_of_freedom(fit.observed, fitted.best.at.size());
  fit.weber_lapse_correlation = correlation(fitted);
  estimate(fitted, other, progress, fit);
  add_bootstrap(fitted,
                bootstrap_fit(problem, counts, fitted.best.at, options.bootstraps, options.seed,
                              options.jobs),
                fit);
  fit.warnings = fit_warnings(counts, fit, options.free, used);
  if (progress) progress(1.0);
  return fit;
}

}  // namespace touchtrial::planning
