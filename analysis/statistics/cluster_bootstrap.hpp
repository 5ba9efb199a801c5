/// \file Bootstrap intervals over participants: a study samples participants, not trials, so whole
/// participants are drawn with replacement. Sources: docs/statistics.md, "Participants as
/// clusters"; Davison, Hinkley 1997, section 5.2 (percentiles); Hesterberg 2015 (which
/// percentiles).
#pragma once

#include "analysis/statistics/proportion.hpp"

#include <cstddef>
#include <cstdint>
#include <optional>
#include <span>
#include <vector>

namespace touchtrial::analysis {

inline constexpr int kBootstrapDraws = 9999;

/// The ends of a bootstrap interval: expanded percentiles. Plain percentiles treat the spread
/// between participants as known; expanded ones lie further out, at Phi(-t sqrt(n / (n - 1))) on
/// either side with Student's t of n - 1 degrees, and hold their level from about eight
/// participants on.
/// \param draws  of a statistic, in any order, at least one
/// \param participants  n, >= 2
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

/// The interval of the mean of one number per participant, for instance of a difference, by the
/// same method.
/// \param index  chooses the stream of random numbers
/// \param draws  >= 1
/// \return nothing with fewer than two values
/// \throws std::invalid_argument if a value is not finite, or an argument is out of range
[[nodiscard]] std::optional<Interval> bootstrap_mean(std::span<const double> values,
                                                     std::uint64_t index = 0,
                                                     int draws = kBootstrapDraws,
                                                     double level = kConfidenceLevel);

}  // namespace touchtrial::analysis
