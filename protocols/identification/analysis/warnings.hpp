/// \file The warnings against misreading a report. Private to protocols/identification.
#pragma once

#include "analysis/outcomes/outcomes.hpp"
#include "protocols/identification/analysis/report.hpp"

#include <string>
#include <vector>

namespace touchtrial::analysis::identification {

/// The warnings, of one or two sentences each, the gravest first.
/// \param report  complete except for its warnings
[[nodiscard]] std::vector<std::string> report_warnings(const Outcomes& outcomes,
                                                       const StudyReport& report);

/// Warnings about the numbers of single methods: chance, d', matching, choice model, validity,
/// small cells.
[[nodiscard]] std::vector<std::string> figure_warnings(const Outcomes& outcomes,
                                                       const StudyReport& report);

/// Warnings about comparisons of methods, and about what the design cannot show.
[[nodiscard]] std::vector<std::string> comparison_warnings(const Outcomes& outcomes,
                                                           const StudyReport& report);

}  // namespace touchtrial::analysis::identification
