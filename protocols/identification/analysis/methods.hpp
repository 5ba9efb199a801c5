/// \file What the methods of a report say of classification and comparison.
#pragma once

#include "analysis/report/methods.hpp"
#include "protocols/identification/analysis/report.hpp"

namespace touchtrial::analysis::identification {

/// \param report  of these outcomes
[[nodiscard]] ProtocolMethods protocol_methods(const StudyReport& report, const Outcomes& outcomes);

}  // namespace touchtrial::analysis::identification
