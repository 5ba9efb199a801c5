/// \file What goes into docs/benchmarks.
#pragma once

#include "bench/goals/goal.hpp"
#include "bench/machine.hpp"
#include "bench/measure/rows.hpp"
#include "bench/measure/tv_gabor_courses.hpp"

#include <filesystem>
#include <vector>

namespace touchtrial::bench {

/// All that was measured.
struct Results {
  std::vector<GoalResult> goals;
  std::vector<Row> rows;
  std::vector<SolverCourse> courses;  ///< of TV-Gabor, on the usual picture
};

/// Writes the table of goals into README.md, the figures, and results.json.
/// \param folder  where README.md lies
/// \throws Error or FileError if a file or one of README.md's sections is missing, or gnuplot is
void publish(const Machine& machine, const Results& results, const std::filesystem::path& folder);

}  // namespace touchtrial::bench
