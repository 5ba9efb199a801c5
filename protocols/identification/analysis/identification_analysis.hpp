/// \file How well participants told the classes apart: confusions, accuracies, methods compared,
/// what ideal observers would have answered.
#pragma once

#include "analysis/results.hpp"

namespace touchtrial::analysis::identification {

/// Of classification and comparison alike.
[[nodiscard]] const ProtocolAnalysis& identification_analysis();

}  // namespace touchtrial::analysis::identification
