/// \file Methods held against each other. Private to analysis/report.
#pragma once

#include "analysis/report/counted_trials.hpp"
#include "analysis/report/report.hpp"

namespace touchtrial {

/// Every two methods, in the order of methods, p values adjusted if there are three or more.
[[nodiscard]] std::vector<MethodPair> method_pairs(int classes, const CountedTrials& counted);

/// All at once. \return nothing with fewer than three methods, or no occasion on which they differ
[[nodiscard]] std::optional<MethodsTogether> methods_together(int classes,
                                                              const CountedTrials& counted);

}  // namespace touchtrial
