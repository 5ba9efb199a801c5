/// \file A subject model fitted to a study's answers, or to published accuracies.
/// Source: docs/planning.md.
#pragma once

#include "analysis/planning/fit_evidence.hpp"
#include "analysis/planning/fit_problem.hpp"
#include "analysis/planning/people_spread.hpp"
#include "analysis/statistics/proportion.hpp"

#include <cstdint>
#include <functional>
#include <optional>
#include <string>
#include <utility>
#include <vector>

namespace touchtrial::planning {

struct FitOptions {
  FreeParameters free{};
  int bootstraps = 499;    ///< studies simulated from the fit, for p and intervals; 0: none
  std::uint64_t seed = 1;  ///< of the simulated studies
  int jobs = 1;            ///< threads, >= 1; results do not depend on them
};

struct ParameterEstimate {
  std::string name;   ///< "feature_noise", "lapse", "position" or "class"
  std::string label;  ///< of the class; empty for the other parameters
  double value = 0.0;
  std::optional<double>
      standard_error;      ///< by Fisher's information; of ln(feature_noise) for feature_noise
  OpenInterval profile{};  ///< 95 %, by the profile likelihood
  std::optional<analysis::Interval> bootstrap;  ///< 95 % of the studies simulated from the fit
  double monte_carlo_error = 0.0;  ///< standard error that the bank's finite size leaves
  bool at_bound = false;           ///< the estimate lies at a bound of the search
};

/// A label swap that was considered.
struct SwapCandidate {
  std::pair<std::string, std::string> labels;
  double gain = 0.0;  ///< in log likelihood, with everything else refitted
  bool accepted = false;
};

struct SubjectFit {
  simulation::SubjectModel subject;  ///< fitted; fixed parameters keep the initial subject's values
  /// Refitted to each simulated study: the uncertainty that the answers leave.
  std::vector<simulation::SubjectModel> draws;
  std::vector<ParameterEstimate> estimates;
  std::vector<SwapCandidate> swaps;  ///< the most likely swaps, best first
  double swap_threshold = 0.0;       ///< gain that a swap needs
  double log_likelihood = 0.0;
  int participants = 0;
  int trials = 0;
  int no_response = 0;
  std::vector<std::string> classes;
  std::vector<std::string> methods;
  Confusions observed;
  Confusions expected;
  double g_squared = 0.0;      ///< of the confusions against the saturated model
  int degrees_of_freedom = 0;  ///< cells that are free to vary, minus estimated parameters
  std::optional<double> p;     ///< of g_squared, by bootstrap
  int bootstraps = 0;
  std::optional<double> noise_lapse_correlation;  ///< of the two estimates
  std::optional<PeopleSpread> people;             ///< nothing with one participant
  double assumed_spread = 0.0;        ///< of noise between people, in the initial subject
  bool spread_replaced = false;       ///< whether the estimate replaced the initial spread
  std::vector<std::string> warnings;  ///< one line each
};

/// Receives the finished share of a fit, 0 .. 1.
using FitProgress = std::function<void(double share)>;

/// Maximises the likelihood of the counts, from several fixed starts. A label swap is accepted if
/// its gain exceeds swap_threshold. Then the spread of noise between people is estimated from each
/// participant's own answers. If they reject the initial spread (p <= 0.05), everything is refitted
/// with the estimated one. Cost: 200 to 1,000 evaluations of the model; a bootstrap draw refits a
/// log-linear model with the fit's probabilities and slopes. The result depends only on the
/// arguments.
/// \param model  of the same study, with `subject`'s hand and training
/// \param subject  start of the search, and values of the fixed parameters
[[nodiscard]] SubjectFit fit_subject(const AnswerModel& model, const FitCounts& counts,
                                     const simulation::SubjectModel& subject,
                                     const FitOptions& options, const FitProgress& progress = {});

/// The keys of the model that a fit ignores because it treats all trials of all people alike,
/// separated by commas; "" if none.
[[nodiscard]] std::string keys_ignored_by_fits(const simulation::SubjectModel& subject);

/// What the data of a finished fit leave undetermined, one line each.
/// \param free  parameters that were to be estimated
/// \param used  parameters that could be estimated
[[nodiscard]] std::vector<std::string> fit_warnings(const FitCounts& counts, const SubjectFit& fit,
                                                    const FreeParameters& free,
                                                    const FreeParameters& used);

struct AccuracyFit {
  simulation::SubjectModel subject;
  std::vector<std::string> classes;
  std::vector<double> targets;              ///< by class, 0 .. 1
  std::vector<double> expected_accuracies;  ///< by class, expected from the fitted subject
  int parameters = 0;                       ///< number of estimated parameters
  double log_likelihood = 0.0;
  double best_log_likelihood = 0.0;  ///< of a model that reaches the accuracies exactly
  std::vector<std::string> warnings;
};

/// The maximum-likelihood subject for these accuracies, by a binomial likelihood with the same
/// number of trials for each class. With at least as many parameters as classes, usually many
/// subjects reach the accuracies exactly, and this is one of them. Label swaps are not searched.
/// Source: docs/planning.md, "Published accuracies".
/// \param targets  by class, 0 .. 1
/// \param layouts  of the participants
/// \throws std::invalid_argument unless there is one accuracy in range for each class
[[nodiscard]] AccuracyFit fit_accuracies(const AnswerModel& model, std::vector<double> targets,
                                         std::vector<PictureLayout> layouts,
                                         const simulation::SubjectModel& subject,
                                         const FreeParameters& free);

}  // namespace touchtrial::planning
