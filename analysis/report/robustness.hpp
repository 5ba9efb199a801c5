/// \file Results with and without what could be left out: whether the headline depends on it.
#pragma once

#include "analysis/outcomes.hpp"
#include "analysis/statistics/participant_mean.hpp"
#include "analysis/statistics/proportion.hpp"

#include <vector>

namespace touchtrial::analysis {

enum class TrialSubset {
  counted,                ///< the headline: missing responses are wrong
  answered,               ///< trials without a response left out
  valid,                  ///< trials that do not meet the study's validity rule left out
  with_excluded_sessions  ///< excluded participants' completed sessions put back
};

struct SubsetAccuracy {
  TrialSubset subset{};
  Proportion pooled;
  MeanEstimate mean;
};

/// "counted", "answered", "valid", "with_excluded_sessions"
[[nodiscard]] std::string name_of(TrialSubset subset);

/// One method's, the headline first; a subset that is the same trials as the headline is there too.
[[nodiscard]] std::vector<SubsetAccuracy> robustness(const Outcomes& outcomes, int method);

}  // namespace touchtrial::analysis
