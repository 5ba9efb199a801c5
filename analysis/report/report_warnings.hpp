/// \file What a reader of a report could take a figure for, wrongly.
#pragma once

#include "analysis/outcomes.hpp"
#include "analysis/report/report.hpp"

#include <string>
#include <vector>

namespace touchtrial::analysis {

/// One sentence or two each, the gravest first. \param report  complete but for its warnings
[[nodiscard]] std::vector<std::string> report_warnings(const Outcomes& outcomes,
                                                       const StudyReport& report);

}  // namespace touchtrial::analysis
