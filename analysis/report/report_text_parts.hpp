/// \file Parts of the report for a terminal, each ending with a line feed or empty.
/// Private to analysis/report.
#pragma once

#include "analysis/report/report.hpp"

#include <string>

namespace touchtrial::analysis {

/// One line: how many enrolled, and where those went who are not analysed.
[[nodiscard]] std::string flow_text(const ParticipantFlow& flow);

/// A method's figures over all classes, indented.
[[nodiscard]] std::string overall_text(const MethodReport& method);

/// Every two methods of three or more, and all at once; empty with fewer.
[[nodiscard]] std::string pairs_text(const StudyReport& report);

/// A table of observers for each method, and what a reader could take wrongly in it.
[[nodiscard]] std::string cues_text(const CueReport& cues);

}  // namespace touchtrial::analysis
