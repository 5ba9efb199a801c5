/// \file Planning of the protocols classification and comparison.
#pragma once

#include "analysis/planning/planner.hpp"

namespace touchtrial::planning::identification {

/// For planning::add_planner.
[[nodiscard]] const Planner& identification_planner();

}  // namespace touchtrial::planning::identification
