/// \file Sentences of the methods section for ratings.
#pragma once

#include "analysis/report/methods.hpp"
#include "protocols/rating/analysis/report.hpp"

namespace touchtrial::analysis::rating {

/// \param report  made from the outcomes
[[nodiscard]] ProtocolMethods protocol_methods(const RatingReport& report,
                                               const Outcomes& outcomes);

}  // namespace touchtrial::analysis::rating
