/// \file The times of many cases, by Google Benchmark.
#pragma once

#include "bench/case.hpp"
#include "bench/measure/effort.hpp"

#include <functional>
#include <vector>

namespace touchtrial::bench {

/// Median microseconds of one operation of each case, in the cases' order. Repetitions of all cases
/// come in an order drawn at random. To be called once in a process.
/// \param progress  called before each repetition; `of` is an estimate that `done` does not pass
[[nodiscard]] std::vector<double> interleaved_times_us(
    const Cases& cases, const Effort& effort,
    const std::function<void(int done, int of)>& progress);

}  // namespace touchtrial::bench
