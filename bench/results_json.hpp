/// \file Everything that was measured, as one JSON object.
#pragma once

#include "bench/goals/goal.hpp"
#include "bench/machine.hpp"
#include "bench/measure/rows.hpp"

#include <string>
#include <vector>

namespace touchtrial::bench {

/// {"processor", .., "goals": [{"goal", "ours_us", "peer_us", "ratio", "target", "error", "met",
/// ..}], "rows": [{"work", "who", "input", "size_px", "radius", "us", "error", ..}]}. Figures that
/// were not taken are null.
[[nodiscard]] std::string results_json(const Machine& machine, const std::vector<GoalResult>& goals,
                                       const std::vector<Row>& rows);

}  // namespace touchtrial::bench
