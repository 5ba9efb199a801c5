/// \file How sure participants were of their answers, if the study asks.
#pragma once

#include "analysis/outcomes.hpp"
#include "analysis/statistics/descriptive.hpp"
#include "analysis/statistics/proportion.hpp"

#include <optional>
#include <vector>

namespace touchtrial::analysis::identification {

/// Answers that were rated alike.
struct RatedAccuracy {
  int rating = 1;
  Proportion accuracy;  ///< all participants' answers pooled
  MeanEstimate mean;    ///< of the own accuracies of those who gave this rating
};

struct ConfidenceReport {
  std::vector<RatedAccuracy> ratings;  ///< from 1 (a guess) to the study's highest
  MeanEstimate area;                   ///< of participants' own type-2 areas
  int without_area = 0;                ///< participants whose answers are all right, or all wrong
};

/// One method's counted trials with a response and a rating.
/// \return nothing if the study does not ask for confidence
[[nodiscard]] std::optional<ConfidenceReport> confidence_of(const Outcomes& outcomes, int method);

}  // namespace touchtrial::analysis::identification
