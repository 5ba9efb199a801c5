/// \file What the methods of a report say of ratings.
#pragma once

#include "analysis/report/methods.hpp"
#include "protocols/rating/analysis/report.hpp"

namespace touchtrial::analysis::rating {

/// \param report  of these outcomes
[[nodiscard]] ProtocolMethods protocol_methods(const RatingReport& report,
                                               const Outcomes& outcomes);

}  // namespace touchtrial::analysis::rating
