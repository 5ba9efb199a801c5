/// \file Methods compared, two by two and all at once. Private to protocols/identification.
#pragma once

#include "protocols/identification/analysis/counted_trials.hpp"
#include "protocols/identification/analysis/report.hpp"

#include <optional>
#include <vector>

namespace touchtrial::analysis::identification {

/// Every pair of methods, in the order of methods. With three or more methods, the p values are
/// adjusted.
[[nodiscard]] std::vector<MethodPair> method_pairs(int classes, const CountedTrials& counted);

/// All methods compared at once.
/// \return nothing if there are fewer than three methods, or no occasion on which they differ
[[nodiscard]] std::optional<MethodsTogether> methods_together(int classes,
                                                              const CountedTrials& counted);

}  // namespace touchtrial::analysis::identification
