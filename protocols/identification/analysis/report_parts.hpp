/// \file Parts of the report on methods, and what a reader could misread in it. Private to
/// protocols/identification.
#pragma once

#include "analysis/outcomes.hpp"
#include "protocols/identification/analysis/counted_trials.hpp"
#include "protocols/identification/analysis/report.hpp"

#include <optional>
#include <string>
#include <utility>
#include <vector>

namespace touchtrial::analysis::identification {

[[nodiscard]] MethodReport method_report(const Outcomes& outcomes, int method,
                                         const CountedTrials& counted);

/// Every two methods, in the order of methods, p values adjusted if there are three or more.
[[nodiscard]] std::vector<MethodPair> method_pairs(int classes, const CountedTrials& counted);

/// Proportions right with the two methods, of each participant who felt both.
[[nodiscard]] std::vector<std::pair<Proportion, Proportion>> paired_proportions(
    const CountedTrials& counted, int first, int second);

/// All at once. \return nothing with fewer than three methods, or no occasion on which they differ
[[nodiscard]] std::optional<MethodsTogether> methods_together(int classes,
                                                              const CountedTrials& counted);

/// One sentence or two each, the gravest first. \param report  complete but for its warnings
[[nodiscard]] std::vector<std::string> report_warnings(const Outcomes& outcomes,
                                                       const StudyReport& report);

/// Of methods' own figures: chance, d', matching, choice model, validity, small cells.
[[nodiscard]] std::vector<std::string> figure_warnings(const Outcomes& outcomes,
                                                       const StudyReport& report);

/// Of methods held against each other, and what the design cannot show.
[[nodiscard]] std::vector<std::string> comparison_warnings(const Outcomes& outcomes,
                                                           const StudyReport& report);

}  // namespace touchtrial::analysis::identification
