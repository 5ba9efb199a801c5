/// \file All cases, each with its time and its error.
#pragma once

#include "bench/case.hpp"
#include "bench/measure/effort.hpp"

#include <functional>
#include <vector>

namespace touchtrial::bench {

struct Row {
  Case what;                 ///< without its `make`
  double us = kNotTaken;     ///< of one operation, median of the repetitions
  double error = kNotTaken;  ///< against double; taken once, outside the timed loop
};

using Progress = std::function<void(int done, int of)>;

/// The error of one run. \throws Error if it is beyond the case's tolerance: such a peer computes
/// something else, and its time means nothing
[[nodiscard]] double error_of(const Case& one);

/// Errors first, case by case; then times by Google Benchmark, repetitions of all cases in an order
/// drawn at random, so that what the machine does meanwhile hits all alike.
/// \throws Error as error_of does
[[nodiscard]] std::vector<Row> measure_rows(const Cases& cases, const Effort& effort,
                                            const Progress& progress);

}  // namespace touchtrial::bench
