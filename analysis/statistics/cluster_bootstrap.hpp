/// \file Intervals that take participants, not trials, as what a study has a sample of: whole
/// participants are drawn again and again. Source: docs/statistics.md, "Participants as clusters";
/// Davison, Hinkley 1997, section 5.2 (percentiles).
#pragma once

#include "analysis/statistics/proportion.hpp"

#include <cstdint>
#include <optional>
#include <span>

namespace touchtrial {

inline constexpr int kBootstrapDraws = 9999;

/// The percentile interval of sum(correct) / sum(n) over participants drawn with replacement.
/// \param participants  each with n >= 1
/// \param index  chooses the stream of random numbers
/// \param draws  >= 1
/// \return nothing with fewer than two participants
/// \throws std::invalid_argument if a participant's n is below 1, or an argument is out of range
[[nodiscard]] std::optional<Interval> cluster_bootstrap(std::span<const Proportion> participants,
                                                        std::uint64_t index = 0,
                                                        int draws = kBootstrapDraws,
                                                        double level = kConfidenceLevel);

/// The same of the mean of one figure a participant, for instance of a difference.
/// \throws std::invalid_argument if a value is not finite, or an argument is out of range
[[nodiscard]] std::optional<Interval> bootstrap_mean(std::span<const double> values,
                                                     std::uint64_t index = 0,
                                                     int draws = kBootstrapDraws,
                                                     double level = kConfidenceLevel);

}  // namespace touchtrial
