/// \file Planning of threshold studies.
#pragma once

#include "analysis/planning/planner.hpp"

namespace touchtrial::planning::threshold {

/// For planning::add_planner.
[[nodiscard]] const Planner& threshold_planner();

}  // namespace touchtrial::planning::threshold
