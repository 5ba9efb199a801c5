/// \file Tracks of an observer whose psychometric function is known, for tests and for the table of
/// docs/procedures-recovery.md.
#pragma once

#include "protocols/procedures/estimates.hpp"
#include "protocols/procedures/tracks.hpp"

#include <cstdint>
#include <span>
#include <string>
#include <vector>

namespace touchtrial::tracked {

/// Whole decibels from `low` to `high`.
[[nodiscard]] std::vector<double> decibels(int low, int high, int step = 1);

/// Levels of -40 .. 0 dB and the beliefs of docs/thresholds.md, "Defaults"; a two-interval task.
[[nodiscard]] procedures::TrackSettings usual_track(const std::string& procedure, int trials);

/// The trials of a track that this observer answers.
/// \param drift_db  by how much the threshold rises over the track; the observer's own is the mean
[[nodiscard]] std::vector<procedures::TrackTrial> answered_track(
    const procedures::TrackSettings& settings, const procedures::Observer& observer,
    std::uint64_t seed, double drift_db = 0.0);

/// The estimate from a track, of which this is the observer, and from a tenth as many asymptotic
/// trials, at least six.
[[nodiscard]] procedures::ThresholdEstimate estimate_of(
    const procedures::TrackSettings& settings, std::span<const procedures::TrackTrial> trials,
    const procedures::Observer& observer, std::uint64_t seed);

/// Thresholds of -24 .. -14 dB, slopes of 2 .. 6 and lapses of 0 .. 0.05.
[[nodiscard]] procedures::Observer some_observer(std::uint64_t seed);

}  // namespace touchtrial::tracked
