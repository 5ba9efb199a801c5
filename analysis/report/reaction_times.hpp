/// \file How long participants took, by class presented: medians and quartiles.
#pragma once

#include "analysis/outcomes.hpp"
#include "analysis/statistics/quantiles.hpp"

#include <vector>

namespace touchtrial::analysis {

/// Of trials with a response, in seconds, on the servo's monotonic clock.
struct ReactionTimes {
  Quartiles from_plane_on;        ///< from the moment the plane can be felt to the answer
  Quartiles from_contact;         ///< from first contact to the answer
  std::vector<double> seconds{};  ///< from plane-on, rising: for the figure
};

/// One method's, by class; the last entry is all classes together.
[[nodiscard]] std::vector<ReactionTimes> reaction_times(const Outcomes& outcomes, int method);

}  // namespace touchtrial::analysis
