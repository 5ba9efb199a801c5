/// \file Means over participants: the unit of which a study has a sample. Pooling all trials as if
/// they were independent makes intervals too narrow. Source: docs/statistics.md, "Participants as
/// clusters".
#pragma once

#include "analysis/statistics/proportion.hpp"

#include <optional>
#include <span>

namespace touchtrial::analysis {

/// A mean and Student's t interval around it.
struct MeanEstimate {
  int participants = 0;
  std::optional<double> mean;  ///< nothing without participants
  Interval interval;           ///< the whole range with fewer than two participants
  std::optional<double> sd{};  ///< between participants, n - 1; nothing with fewer than two

  /// What may be shown: `interval`, or nothing with fewer than two participants.
  [[nodiscard]] std::optional<Interval> known_interval() const noexcept {
    return participants < 2 ? std::nullopt : std::optional(interval);
  }
};

/// The mean of one figure a participant.
/// \param range  which values are possible at all; the interval is cut to it
/// \param level  in (0, 1)
/// \throws std::invalid_argument if the level is not in (0, 1), or a value is not finite
[[nodiscard]] MeanEstimate participant_mean(std::span<const double> values,
                                            Interval range = {0.0, 1.0},
                                            double level = kConfidenceLevel);

}  // namespace touchtrial::analysis
