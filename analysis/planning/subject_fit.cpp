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
constexpr double kSearchShare = 0.3;
constexpr double kProfileShare = 0.9;

/// Moves numbers that end very close to a bound onto it.
void snap_to_bounds(std::vector<double>& point, const Bounds& bounds) {
  constexpr double kSnapDistance = 1e-6;
  for (std::size_t i = 0; i < point.size(); ++i) {
    if (point[i] - bounds.lower[i] < kSnapDistance) point[i] = bounds.lower[i];
    if (bounds.upper[i] - point[i] < kSnapDistance) point[i] = bounds.upper[i];
  }
}

FittedProblem fit_at_maximum(const FitProblem& problem, const FitCounts& counts,
                             const simulation::SubjectModel& subject) {
  Optimum best = problem.maximise_from(problem.numbers_of(subject), problem.bounds(),
                                       {.tolerance = 1e-9, .scales = problem.scales()});
  snap_to_bounds(best.point, problem.bounds());
  best.value = problem.value(best.point, {});
  return fitted_problem(problem, counts, std::move(best));
}

/// A number in reported units.
double in_reported_units(const Parameter& parameter, double number) {
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
OpenInterval in_reported_units(const Parameter& parameter, OpenInterval interval) {
  if (interval.lower) interval.lower = in_reported_units(parameter, *interval.lower);
  if (interval.upper) interval.upper = in_reported_units(parameter, *interval.upper);
  if (parameter.kind == ParameterKind::lapse && !interval.lower) interval.lower = 0.0;
  return interval;
}

ParameterEstimate estimate_of(const FittedProblem& fitted, std::size_t number,
                              double monte_carlo_error) {
  const Parameter& parameter = fitted.problem.parameters()[number];
  const double value = fitted.best.point[number];
  ParameterEstimate estimate;
  estimate.name = name_of(parameter);
  if (parameter.kind == ParameterKind::class_bias) {
    estimate.label = fitted.counts.classes[parameter.class_index];
  }
  estimate.value = in_reported_units(parameter, value);
  const Bounds& bounds = fitted.problem.bounds();
  estimate.at_bound = value == bounds.lower[number] || value == bounds.upper[number];
  if (fitted.identifiable) {
    const std::size_t n = fitted.best.point.size();
    estimate.standard_error = std::sqrt(fitted.covariance[number * n + number]);
  }
  estimate.profile = in_reported_units(parameter, profile_interval(fitted, number));
  estimate.monte_carlo_error = monte_carlo_error;
  return estimate;
}

/// The estimate's value in a bootstrap draw. The bias of the eliminated class is minus the sum of
/// the other biases.
double reported_value_of(const FittedProblem& fitted, const ParameterEstimate& estimate,
                         const std::vector<double>& numbers) {
  double other_biases = 0.0;
  for (std::size_t i = 0; i < numbers.size(); ++i) {
    const Parameter& parameter = fitted.problem.parameters()[i];
    const bool is_class = parameter.kind == ParameterKind::class_bias;
    const std::string label = is_class ? fitted.counts.classes[parameter.class_index] : "";
    if (estimate.name == name_of(parameter) && estimate.label == label) {
      return in_reported_units(parameter, numbers[i]);
    }
    if (is_class) other_biases += numbers[i];
  }
  return -other_biases;
}

void add_bootstrap(const FittedProblem& fitted, const FitBootstrap& bootstrap, SubjectFit& fit) {
  fit.bootstraps = static_cast<int>(bootstrap.g_squared.size());
  if (fit.bootstraps == 0) return;
  const auto exceedances = std::ranges::count_if(
      bootstrap.g_squared, [&](double value) { return value >= fit.g_squared; });
  fit.p = (1.0 + static_cast<double>(exceedances)) / (1.0 + fit.bootstraps);
  for (const std::vector<double>& numbers : bootstrap.numbers) {
    fit.draws.push_back(fitted.problem.subject_at(numbers));
  }
  for (ParameterEstimate& estimate : fit.estimates) {
    std::vector<double> values;
    for (const std::vector<double>& numbers : bootstrap.numbers) {
      values.push_back(reported_value_of(fitted, estimate, numbers));
    }
    std::ranges::sort(values);
    estimate.bootstrap = {analysis::quantile(values, kLowTail).value(),
                          analysis::quantile(values, kHighTail).value()};
  }
}

std::optional<double> correlation(const FittedProblem& fitted) {
  const auto& parameters = fitted.problem.parameters();
  const std::size_t n = parameters.size();
  const bool has_noise_and_lapse = n >= 2 && parameters[0].kind == ParameterKind::feature_noise &&
                                   parameters[1].kind == ParameterKind::lapse;
  if (!has_noise_and_lapse || !fitted.identifiable) return std::nullopt;
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

SubjectFit fit_with_counts(const FitCounts& counts) {
  SubjectFit fit;
  fit.participants = static_cast<int>(counts.people.size());
  fit.trials = counts.trials;
  fit.no_response = counts.no_response;
  fit.classes = counts.classes;
  fit.methods = counts.methods;
  fit.observed = observed_confusions(counts, counts.people);
  return fit;
}

/// Estimates the spread of noise between people; all other values of the subject are fixed.
std::optional<PeopleSpread> estimate_spread(const AnswerModel& model, const FitCounts& counts,
                                            const simulation::SubjectModel& subject,
                                            const FreeParameters& used) {
  if (counts.people.size() < 2) return std::nullopt;
  constexpr double kMinNoise = 0.01;
  constexpr double kMaxNoise = 10.0;
  NoiseAnswers answers{std::log(kMinNoise), 0.25, counts.classes.size(), {}};
  simulation::SubjectModel person = subject;
  person.feature_noise_spread = 0.0;
  person.lapse = 0.0;
  person.lapse_spread = 0.0;
  for (double log_noise = answers.min_log_noise; log_noise <= std::log(kMaxNoise);
       log_noise += answers.step) {
    person.feature_noise = std::exp(log_noise);
    answers.answers.push_back(cells_of(model.answers(person, counts.layouts), counts));
  }
  return people_spread(answers, counts.people,
                       {std::log(subject.feature_noise), std::min(mean_lapse(subject), kMaxLapse),
                        subject.feature_noise_spread, used.feature_noise, used.lapse});
}

/// Whether the answers reject the assumed spread.
bool is_spread_rejected(const PeopleSpread& people) {
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
void add_estimates(const FittedProblem& fitted, const FittedProblem& alternative,
                   const FitProgress& progress, SubjectFit& fit) {
  const auto add = [&](const FittedProblem& source, std::size_t number,
                       const std::vector<double>& errors) {
    fit.estimates.push_back(estimate_of(source, number, errors[number]));
    const double share = static_cast<double>(fit.estimates.size()) /
                         (static_cast<double>(fitted.best.point.size()) + 1.0);
    if (progress) progress(kSearchShare + (kProfileShare - kSearchShare) * share);
  };
  const std::vector<double> errors = monte_carlo_errors(fitted);
  const std::vector<double> alternative_errors = monte_carlo_errors(alternative);
  const auto& alternative_parameters = alternative.problem.parameters();
  const auto eliminated =
      std::ranges::find(alternative_parameters, Parameter{ParameterKind::class_bias, 0});
  bool is_first_class = true;
  for (std::size_t i = 0; i < fitted.best.point.size(); ++i) {
    const bool is_class = fitted.problem.parameters()[i].kind == ParameterKind::class_bias;
    if (is_class && is_first_class && eliminated != alternative_parameters.end()) {
      add(alternative, static_cast<std::size_t>(eliminated - alternative_parameters.begin()),
          alternative_errors);
      is_first_class = false;
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
  SubjectFit fit = fit_with_counts(counts);
  fit.assumed_spread = subject.feature_noise_spread;
  fit.people = estimate_spread(model, counts, search.subject, used);
  fit.spread_replaced = used.spread && fit.people && is_spread_rejected(*fit.people);
  const simulation::SubjectModel start =
      fit.spread_replaced ? with_spread(search.subject, *fit.people, used) : search.subject;
  if (progress) progress(kSearchShare);
  const FitProblem problem(model, evidence, start, used);
  const FitProblem alternative(model, evidence, start, used, 1);
  const FittedProblem fitted = fit_at_maximum(problem, counts, start);
  fit.subject = problem.subject_at(fitted.best.point);
  const FittedProblem fitted_alternative =
      fitted_problem(alternative, counts, {alternative.numbers_of(fit.subject), fitted.best.value});
  fit.swaps = search.candidates;
  fit.swap_threshold = search.threshold;
  fit.log_likelihood = fitted.best.value;
  fit.expected = expected_confusions(counts, fitted.tangent.table);
  fit.g_squared = g_squared(fit.observed, fit.expected);
  fit.degrees_of_freedom = degrees_of_freedom(fit.observed, fitted.best.point.size());
  fit.noise_lapse_correlation = correlation(fitted);
  add_estimates(fitted, fitted_alternative, progress, fit);
  add_bootstrap(fitted, bootstrap_fit(fitted, options.bootstraps, options.seed, options.jobs), fit);
  fit.warnings = fit_warnings(counts, fit, options.free, used);
  if (progress) progress(1.0);
  return fit;
}

}  // namespace touchtrial::planning
