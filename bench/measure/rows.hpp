/// \file The rows of the results: each case with its time and its error.
#pragma once

#include "bench/case.hpp"
#include "bench/measure/timing.hpp"

#include <functional>
#include <vector>

namespace touchtrial::bench {

struct Row {
  Case what;                 ///< without its `make`
  double us = kNotTaken;     ///< median time of one operation
  double error = kNotTaken;  ///< against double precision; taken once, outside the timed loop
};

using Progress = std::function<void(int done, int of)>;

/// The error of one run.
/// \throws Error if it exceeds the case's tolerance: such a peer computes something else, and its
///   time means nothing
[[nodiscard]] double error_of(const Case& one);

/// Takes the errors first, case by case, then the times by Google Benchmark. The repetitions of all
/// cases run in random order, so that other activity of the machine affects all alike. Call it once
/// per process.
/// \throws Error as error_of does
[[nodiscard]] std::vector<Row> measure_rows(const Cases& cases, const Effort& effort,
                                            const Progress& progress);

}  // namespace touchtrial::bench
