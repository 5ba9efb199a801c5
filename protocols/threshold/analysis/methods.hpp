/// \file What the methods of a report say of thresholds.
#pragma once

#include "analysis/report/methods.hpp"
#include "protocols/threshold/analysis/report.hpp"

namespace touchtrial::analysis::threshold {

/// \param report  of these outcomes
[[nodiscard]] ProtocolMethods protocol_methods(const ThresholdReport& report);

}  // namespace touchtrial::analysis::threshold
