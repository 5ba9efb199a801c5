/// \file The parts of the report on methods, and the warnings against misreading it. Private to
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

/// Every pair of methods, in the order of methods. With three or more methods, the p values are
/// adjusted.
[[nodiscard]] std::vector<MethodPair> method_pairs(int classes, const CountedTrials& counted);

/// The proportions of correct answers with the two methods, for each participant who felt both.
[[nodiscard]] std::vector<std::pair<Proportion, Proportion>> paired_proportions(
    const CountedTrials& counted, int first, int second);

/// All methods compared at once.
/// \return nothing if there are fewer than three methods, or no occasion on which they differ
[[nodiscard]] std::optional<MethodsTogether> methods_together(int classes,
                                                              const CountedTrials& counted);

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
