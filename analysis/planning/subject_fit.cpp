#include "analysis/planning/subject_fit.hpp"

#include "analysis/planning/fit_search.hpp"
#include "analysis/planning/fit_uncertainty.hpp"
#include "analysis/statistics/descriptive.hpp"

#include <algorithm>
#include <cmath>

namespace touchtrial::planning {
namespace {

constexpr double kLowTail = 0.025;
constexpr double kHighTail = 0.975;
// Empirical progress after each stage.
constexpr double kSearched = 0.3;
constexpr double kProfiled = 0.9;

/// Moves numbers that end very close to a bound onto it.
void snap_to_bounds(std::vector<double>& at, const Bounds& bounds) {
  constexpr double kBeside = 1e-6;
  for (std::size_t i = 0; i < at.size(); ++i) {
    if (at[i] - bounds.lower[i] < kBeside) at[i] = bounds.lower[i];
    if (bounds.upper[i] - at[i] < kBeside) at[i] = bounds.upper[i];
  }
}

Fitted at_best(const FitProblem& problem, const FitCounts& counts,
               const simulation::SubjectModel& subject) {
  Optimum best = problem.maximised(problem.numbers_of(subject), problem.bounds(),
                                   {.tolerance = 1e-9, .scales = problem.scales()});
  snap_to_bounds(best.at, problem.bounds());
  best.value = problem.value(best.at, {});
  return fitted_at(problem, counts, std::move(best));
}

/// A number in reported units.
double readable(const Parameter& parameter, double number) {
  return parameter.kind == ParameterKind::feature_noise ? std::exp(number) : number;
}

std::string name_of(const Parameter& parameter) {
  switch (parameter.kind) {
    case ParameterKind::feature_noise:
      return "feature_noise";
    case ParameterKind::lapse:
      return "lapse";
    case ParameterKind::position:
      return "position";
    case ParameterKind::class_bias:
      return "class";
  }
  return "";
}

/// An interval in reported units. A lapse cannot be below 0, so its lower end always exists.
OpenInterval readable(const Parameter& parameter, OpenInterval interval) {
  if (interval.lower) interval.lower = readable(parameter, *interval.lower);
  if (interval.upper) interval.upper = readable(parameter, *interval.upper);
  if (parameter.kind == ParameterKind::lapse && !interval.lower) interval.lower = 0.0;
  return interval;
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
  estimate.profile = readable(parameter, profile_interval(fitted, number));
  estimate.monte_carlo_error = monte_carlo_error;
  return estimate;
}

/// The estimate's value in a bootstrap draw; that of the eliminated class follows from the other
/// classes.
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
  for (const std::vector<double>& numbers : bootstrap.numbers) {
    fit.draws.push_back(fitted.problem.subject_at(numbers));
  }
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
  const bool both = n >= 2 && parameters[0].kind == ParameterKind::feature_noise &&
                    parameters[1].kind == ParameterKind::lapse;
  if (!both || !fitted.informed) return std::nullopt;
  return fitted.covariance[1] / std::sqrt(fitted.covariance[0] * fitted.covariance[n + 1]);
}

/// Cells of the confusions that are free to vary, minus estimated parameters.
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

/// The spread of noise between people, given everything else about a subject.
std::optional<PeopleSpread> spread_of(const AnswerModel& model, const FitCounts& counts,
                                      const simulation::SubjectModel& subject,
                                      const FreeParameters& used) {
  if (counts.people.size() < 2) return std::nullopt;
  constexpr double kMinNoise = 0.01;
  constexpr double kMaxNoise = 10.0;
  NoiseAnswers answers{std::log(kMinNoise), 0.25, counts.classes.size(), {}};
  simulation::SubjectModel one = subject;
  one.feature_noise_spread = 0.0;
  one.lapse = 0.0;
  one.lapse_spread = 0.0;
  for (double at = answers.min_log_noise; at <= std::log(kMaxNoise); at += answers.step) {
    one.feature_noise = std::exp(at);
    answers.answers.push_back(cells_of(model.answers(one, counts.layouts), counts));
  }
  return people_spread(answers, counts.people,
                       {std::log(subject.feature_noise), std::min(mean_lapse(subject), kMaxLapse),
                        subject.feature_noise_spread, used.feature_noise, used.lapse});
}

/// Whether the answers rule out the spread that a subject has.
bool rules_out(const PeopleSpread& people) {
  constexpr double kLevel = 0.05;
  return people.assumed_p <= kLevel;
}

simulation::SubjectModel with_spread(simulation::SubjectModel subject, const PeopleSpread& people,
                                     const FreeParameters& used) {
  subject.feature_noise_spread = people.spread;
  if (used.feature_noise) subject.feature_noise = std::exp(people.log_noise);
  if (used.lapse) subject.lapse = people.lapse;
  return subject;
}

/// Adds all estimates in the order of the parameters; the eliminated class comes first among the
/// classes.
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

SubjectFit fit_subject(const AnswerModel& model, const FitCounts& counts,
                       const simulation::SubjectModel& subject, const FitOptions& options,
                       const FitProgress& progress) {
  const CountsEvidence evidence(counts, counts.people);
  FreeParameters used = options.free;
  if (counts.layouts.size() < 2 && used.classes) used.position = false;
  const SwapSearch search = search_swaps(model, evidence, subject, used);
  SubjectFit fit = described(counts);
  fit.assumed_spread = subject.feature_noise_spread;
  fit.people = spread_of(model, counts, search.subject, used);
  fit.spread_replaced = used.spread && fit.people && rules_out(*fit.people);
  const simulation::SubjectModel start =
      fit.spread_replaced ? with_spread(search.subject, *fit.people, used) : search.subject;
  if (progress) progress(kSearched);
  const FitProblem problem(model, evidence, start, used);
  const FitProblem otherwise(model, evidence, start, used, 1);
  const Fitted fitted = at_best(problem, counts, start);
  fit.subject = problem.subject_at(fitted.best.at);
  const Fitted other =
      fitted_at(otherwise, counts, {otherwise.numbers_of(fit.subject), fitted.best.value});
  fit.swaps = search.candidates;
  fit.swap_threshold = search.threshold;
  fit.log_likelihood = fitted.best.value;
  fit.expected = expected_confusions(counts, fitted.tangent.table);
  fit.g_squared = g_squared(fit.observed, fit.expected);
  fit.degrees_of_freedom = degrees_of_freedom(fit.observed, fitted.best.at.size());
  fit.noise_lapse_correlation = correlation(fitted);
  estimate(fitted, other, progress, fit);
  add_bootstrap(fitted, bootstrap_fit(fitted, options.bootstraps, options.seed, options.jobs), fit);
  fit.warnings = fit_warnings(counts, fit, options.free, used);
  if (progress) progress(1.0);
  return fit;
}

}  // namespace touchtrial::planning
