/// \file Sentences of the methods section for classification and comparison.
#pragma once

#include "analysis/report/methods.hpp"
#include "protocols/identification/analysis/report.hpp"

namespace touchtrial::analysis::identification {

/// \param report  made from the outcomes
[[nodiscard]] ProtocolMethods protocol_methods(const StudyReport& report, const Outcomes& outcomes);

}  // namespace touchtrial::analysis::identification
