/// \file The registered question about thresholds: a mean, the difference of two standards, or the
/// equality of standards. Source: docs/statistics.md and docs/thresholds.md, "The registered
/// question".
#pragma once

#include "analysis/report/registered.hpp"
#include "protocols/threshold/analysis/report.hpp"

#include <optional>

namespace touchtrial::analysis::threshold {

/// The answer for every selection of sessions and trials, with the decision.
/// \param report  with tracks and standards
/// \param jobs  threads for tracks that are not in the report; 0: one for each core
/// \return nothing if the study registers no question
[[nodiscard]] std::optional<PrimaryResult> primary_result(const Outcomes& outcomes,
                                                          const ThresholdReport& report,
                                                          int jobs = 0);

}  // namespace touchtrial::analysis::threshold
