/// \file A fitted model's neighbourhood, for refitting it to many simulated studies in no time.
#pragma once

#include "analysis/planning/fit_counts.hpp"
#include "analysis/planning/fit_problem.hpp"
#include "analysis/planning/optimiser.hpp"

#include <span>
#include <vector>

namespace touchtrial::planning {

/// Log-linear in the parameters' changes, normalised: probabilities and their slopes at the fit are
/// the fitted model's, and the likelihood has one maximum. Immutable, thread-safe.
class LocalAnswers {
 public:
  /// \param fitted  of the counts' layouts and stimuli
  /// \param at  the fitted numbers  \param bounds  of them
  LocalAnswers(const FitCounts& counts, const FitProblem::Tangent& fitted, std::vector<double> at,
               Bounds bounds);

  /// The most likely numbers. \param counts  [layout][stimulus x classes + answer]
  [[nodiscard]] std::vector<double> fitted_to(const std::vector<std::vector<double>>& counts) const;

  /// Probabilities at some numbers.
  [[nodiscard]] AnswerTable at(std::span<const double> numbers) const;

 private:
  [[nodiscard]] double log_likelihood(const std::vector<std::vector<double>>& counts,
                                      std::span<const double> change,
                                      std::span<double> slopes) const;
  /// Probabilities of one layout and stimulus. \param answers  gets them
  void answers_at(std::size_t layout, std::size_t place, std::span<const double> change,
                  std::span<double> answers) const;

  std::size_t classes_;
  std::size_t stimuli_;
  std::vector<double> at_;
  Bounds changes_;
  std::vector<std::vector<double>> probability_;              ///< [layout][cell]
  std::vector<std::vector<std::vector<double>>> log_slopes_;  ///< [layout][cell][number]
};

}  // namespace touchtrial::planning
