/// \file The numbers of one method. Private to protocols/identification.
#pragma once

#include "analysis/outcomes/outcomes.hpp"
#include "protocols/identification/analysis/counted_trials.hpp"
#include "protocols/identification/analysis/report.hpp"

namespace touchtrial::analysis::identification {

[[nodiscard]] MethodReport method_report(const Outcomes& outcomes, int method,
                                         const CountedTrials& counted);

}  // namespace touchtrial::analysis::identification
