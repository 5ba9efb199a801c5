/// \file One method's part of the report. Private to analysis/report.
#pragma once

#include "analysis/report/counted_trials.hpp"
#include "analysis/report/report.hpp"

namespace touchtrial::analysis {

[[nodiscard]] MethodReport method_report(const Outcomes& outcomes, int method,
                                         const CountedTrials& counted);

}  // namespace touchtrial::analysis
