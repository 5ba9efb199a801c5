/// \file A subject model fitted to a study's answers. Source: docs/fitting.md.
#pragma once

#include "analysis/planning/fit_counts.hpp"
#include "analysis/planning/fit_problem.hpp"
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
  std::uint64_t seed = 1;  ///< of theirs
  int jobs = 1;            ///< threads, >= 1; results do not depend on them
};

/// An end of an interval, or nothing where the data set none.
struct OpenInterval {
  std::optional<double> lower;
  std::optional<double> upper;
};

/// One estimated parameter.
struct ParameterEstimate {
  std::string name;   ///< "weber", "lapse", "position"; of a class bias "class"
  std::string label;  ///< of the class, else empty
  double value = 0.0;
  std::optional<double> standard_error;         ///< by Fisher's information; of weber, of ln(weber)
  OpenInterval profile{};                       ///< 95 % by the profile of the likelihood
  std::optional<analysis::Interval> bootstrap;  ///< 95 % of the studies simulated from the fit
  double monte_carlo_error = 0.0;  ///< standard error that the bank's finite size leaves
  bool at_bound = false;           ///< the largest likelihood lies at a bound of the search
};

/// A label swap that was considered.
struct SwapCandidate {
  std::pair<std::string, std::string> labels;
  double gain = 0.0;  ///< log likelihood over that without it, all else fitted anew
  bool taken = false;
};

struct SubjectFit {
  session::SubjectModel subject;  ///< fitted; what is fixed is the given one's
  std::vector<ParameterEstimate> estimates;
  std::vector<SwapCandidate> swaps;  ///< the most likely ones, best first
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
  int degrees_of_freedom = 0;  ///< cells free to vary, less estimated parameters
  std::optional<double> p;     ///< of g_squared, by bootstrap
  int bootstraps = 0;
  std::optional<double> weber_lapse_correlation;  ///< of the two estimates
  std::vector<std::string> warnings;              ///< what these data cannot tell
};

/// Stages of a fit and how far they are, 0 .. 1.
using FitProgress = std::function<void(double share)>;

/// Maximum likelihood over the counts, from several fixed starts; a label swap is taken where it
/// makes the answers 20 times likelier than every other account, pairs sharing the odds. Cost: some
/// 200 to 1,000 evaluations of the model; a bootstrap draw refits a log-linear model that has the
/// fitted one's values and slopes. A function of its arguments.
/// \param model  made from the same study and from `subject`'s hand and training
/// \param subject  where the search starts, and what is fixed
[[nodiscard]] SubjectFit fit_subject(const AnswerModel& model, const FitCounts& counts,
                                     const session::SubjectModel& subject,
                                     const FitOptions& options, const FitProgress& progress = {});

/// The best of several deterministic starts: the subject itself, and a grid of noise and lapse.
[[nodiscard]] Optimum best_of_starts(const FitProblem& problem,
                                     const session::SubjectModel& subject);

}  // namespace touchtrial::planning
