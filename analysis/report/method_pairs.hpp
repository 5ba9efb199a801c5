/// \file Methods held against each other. Private to analysis/report.
#pragma once

#include "analysis/report/counted_trials.hpp"
#include "analysis/report/report.hpp"

#include <optional>
#include <utility>
#include <vector>

namespace touchtrial::analysis {

/// Every two methods, in the order of methods, p values adjusted if there are three or more.
[[nodiscard]] std::vector<MethodPair> method_pairs(int classes, const CountedTrials& counted);

/// Proportions right with the two methods, of each participant who felt both.
[[nodiscard]] std::vector<std::pair<Proportion, Proportion>> paired_proportions(
    const CountedTrials& counted, int first, int second);

/// All at once. \return nothing with fewer than three methods, or no occasion on which they differ
[[nodiscard]] std::optional<MethodsTogether> methods_together(int classes,
                                                              const CountedTrials& counted);

}  // namespace touchtrial::analysis
