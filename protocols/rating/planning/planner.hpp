/// \file Planning of rating studies.
#pragma once

#include "analysis/planning/planner.hpp"

namespace touchtrial::planning::rating {

/// For planning::add_planner.
[[nodiscard]] const Planner& rating_planner();

}  // namespace touchtrial::planning::rating
