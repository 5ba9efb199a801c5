/// \file Which trial orders a study can have. Private to protocols/design.
#pragma once

#include "protocols/design/study.hpp"

#include <optional>
#include <string>

namespace touchtrial::design {

/// Why an order is impossible.
struct OrderObstacle {
  std::string key;  ///< the offender in "trials", as a JSON pointer: "/repeats"
  std::string what;
};

/// \return nothing if every participant's schedule can be made
[[nodiscard]] std::optional<OrderObstacle> obstacle_to_order(const Study& study);

/// Whether the study's limit of runs excludes an order that it would have otherwise.
[[nodiscard]] bool max_run_matters(const Study& study);

}  // namespace touchtrial::design
