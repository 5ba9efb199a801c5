/// \file The analysis of thresholds. Source: docs/thresholds.md.
#pragma once

#include "analysis/report/results.hpp"

namespace touchtrial::analysis::threshold {

/// The analysis of the protocol "threshold".
[[nodiscard]] const ProtocolAnalysis& threshold_analysis();

}  // namespace touchtrial::analysis::threshold
