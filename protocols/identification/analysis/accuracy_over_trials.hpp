/// \file Accuracy as a function of trial number: the mean of participants' smoothed curves.
#pragma once

#include "analysis/choices/people.hpp"
#include "analysis/statistics/descriptive.hpp"

#include <span>
#include <vector>

namespace touchtrial::analysis::identification {

struct AccuracyAtPlace {
  double place = 0.0;  ///< among a participant's trials, from 1
  MeanEstimate mean;   ///< over the participants with at least this many trials
};

struct AccuracyOverTrials {
  double width = 0.0;  ///< of the kernel: one standard deviation, trials
  std::vector<AccuracyAtPlace> points;
};

/// Each participant's right answers are smoothed by a Gaussian kernel, whose width is a tenth of
/// the largest number of trials, but at least two trials. Trials without an answer are wrong.
/// \param right  by participant and trial
[[nodiscard]] AccuracyOverTrials accuracy_over_trials(std::span<const std::vector<bool>> right);
/// \param people  with their trials in any order
[[nodiscard]] AccuracyOverTrials accuracy_over_trials(std::span<const choices::Person> people);

}  // namespace touchtrial::analysis::identification
