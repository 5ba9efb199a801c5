/// \file What goes into docs/benchmarks.
#pragma once

#include "bench/goals/goal.hpp"
#include "bench/machine.hpp"
#include "bench/measure/rows.hpp"

#include <filesystem>
#include <vector>

namespace touchtrial::bench {

/// Writes the table of goals into README.md, the figures, and results.json.
/// \param folder  where README.md lies
/// \throws Error or FileError if a file or one of README.md's sections is missing, or gnuplot is
void publish(const Machine& machine, const std::vector<GoalResult>& goals,
             const std::vector<Row>& rows, const std::filesystem::path& folder);

}  // namespace touchtrial::bench
