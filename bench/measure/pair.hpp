/// \file The time of a piece of work beside that of its peer.
#pragma once

#include "bench/case.hpp"
#include "bench/measure/effort.hpp"

namespace touchtrial::bench {

/// Medians over all rounds; the ratio is the median of the rounds' ratios, not the ratio of the
/// medians, so that a machine whose speed drifts does less harm.
struct PairTimes {
  double ours_us = kNotTaken;
  double peer_us = kNotTaken;
  double ratio = kNotTaken;  ///< ours / peer
};

/// Ours and the peer's by turns. A turn takes some milliseconds of one of them, after a run that is
/// not timed: each finds the caches as it would leave them itself.
[[nodiscard]] PairTimes time_pair(const Case& ours, const Case& peer, const Effort& effort);

/// The same for work without a peer: `ours_us` alone.
[[nodiscard]] PairTimes time_alone(const Case& ours, const Effort& effort);

}  // namespace touchtrial::bench
