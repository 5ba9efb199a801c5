/// \file How the benchmark takes times: its clock, its effort, and pairs of a case and its peer.
#pragma once

#include "bench/case.hpp"

#include <algorithm>
#include <cstddef>
#include <vector>

namespace touchtrial::bench {

/// How long measuring may take.
struct Effort {
  int repetitions = 7;         ///< of each row; fewer for large images
  double repetition_s = 0.02;  ///< minimum, and at least one run
  double pair_s = 3.0;         ///< approximate time for one goal
  int least_rounds = 5;        ///< of each pair, however long they take
  int most_rounds = 41;
  int tv_gabor_pictures = 100;  ///< maximum; each takes seconds
  int study_rounds = 3;         ///< repetitions of a whole simulated study
};

/// The least effort that still runs everything.
[[nodiscard]] constexpr Effort quick_effort() {
  return {3, 0.002, 0.2, 3, 15, 2, 1};
}

/// Processor time of this process in all its threads, in microseconds; only differences have a
/// meaning. Other work on the machine does not count, except for its effect on the caches.
[[nodiscard]] double cpu_clock_us() noexcept;

/// The middle value, or the mean of the two middle values.
/// \pre not empty
[[nodiscard]] inline double median(std::vector<double> values) {
  std::sort(values.begin(), values.end());
  const std::size_t middle = values.size() / 2;
  return values.size() % 2 == 1 ? values[middle] : (values[middle - 1] + values[middle]) / 2.0;
}

/// Medians over all rounds. The ratio is the median of the rounds' ratios, not the ratio of the
/// medians: it suffers less on a machine whose speed drifts.
struct TimeBeside {
  double us = kNotTaken;
  double ratio = kNotTaken;  ///< of the first case to this one
};

/// Times all cases in alternating turns. A turn takes some milliseconds of one of them, after an
/// untimed run, so that each finds the caches as it leaves them itself.
/// \param cases  ours first
/// \return in the order of the cases
[[nodiscard]] std::vector<TimeBeside> time_in_turns(const Cases& cases, const Effort& effort);

}  // namespace touchtrial::bench
