/// \file The analysis of identification studies: confusions, accuracies, comparisons of methods, and
/// ideal observers.
#pragma once

#include "analysis/report/results.hpp"

namespace touchtrial::analysis::identification {

/// The analysis of both protocols, classification and comparison.
[[nodiscard]] const ProtocolAnalysis& identification_analysis();

}  // namespace touchtrial::analysis::identification
