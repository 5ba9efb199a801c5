/// \file Intervals that take participants, not trials, as what a study has a sample of: whole
/// participants are drawn again and again. Source: docs/statistics.md, "Participants as clusters";
/// Davison, Hinkley 1997, section 5.2 (percentiles); Hesterberg 2015 (which ones).
#pragma once

#include "analysis/statistics/proportion.hpp"

#include <cstddef>
#include <cstdint>
#include <optional>
#include <span>
#include <vector>

namespace touchtrial::analysis {

inline constexpr int kBootstrapDraws = 9999;

/// The ends of a bootstrap interval: expanded percentiles. Plain ones take the spread between
/// participants for known; these are further out, at Phi(-t sqrt(n / (n - 1))) on either side with
/// Student's t of n - 1 degrees, and hold their level from some eight participants on.
/// \param draws  of a statistic, in any order, >= 1 \param participants  n, >= 2
/// \throws std::invalid_argument if an argument is out of range
[[nodiscard]] Interval expanded_percentiles(std::vector<double> draws, std::size_t participants,
                                            double level = kConfidenceLevel);

/// The interval of sum(correct) / sum(n) over participants drawn with replacement, by expanded
/// percentiles.
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

}  // namespace touchtrial::analysis
