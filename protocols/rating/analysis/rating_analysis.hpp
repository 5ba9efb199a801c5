/// \file The analysis of ratings. Source: docs/rating.md.
#pragma once

#include "analysis/report/results.hpp"

namespace touchtrial::analysis::rating {

/// The analysis of the protocol "rating".
[[nodiscard]] const ProtocolAnalysis& rating_analysis();

}  // namespace touchtrial::analysis::rating
