/// \file What could be taken wrongly of single figures. Private to analysis/report.
#pragma once

#include "analysis/outcomes.hpp"
#include "analysis/report/report.hpp"

#include <string>
#include <vector>

namespace touchtrial::analysis {

/// Of methods' own figures: chance, d', matching, choice model, validity, small cells.
[[nodiscard]] std::vector<std::string> figure_warnings(const Outcomes& outcomes,
                                                       const StudyReport& report);

/// Of methods held against each other, and what the design cannot show.
[[nodiscard]] std::vector<std::string> comparison_warnings(const Outcomes& outcomes,
                                                           const StudyReport& report);

}  // namespace touchtrial::analysis
