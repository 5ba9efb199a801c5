/// \file Sentences of the methods section for thresholds.
#pragma once

#include "analysis/report/methods.hpp"
#include "protocols/threshold/analysis/report.hpp"

namespace touchtrial::analysis::threshold {

[[nodiscard]] ProtocolMethods protocol_methods(const ThresholdReport& report);

}  // namespace touchtrial::analysis::threshold
