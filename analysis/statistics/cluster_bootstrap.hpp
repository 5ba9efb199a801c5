/// \file Bootstrap intervals over participants: a study samples participants, not trials, so whole
/// participants are drawn with replacement. Sources: docs/statistics.md, "Participants as
/// clusters"; Davison, Hinkley 1997, section 5.2 (percentiles); Hesterberg 2015 (which
/// percentiles).
#pragma once

#include "analysis/statistics/proportion.hpp"

#include <cstddef>
#include <cstdint>
#include <functional>
#include <optional>
#include <span>
#include <vector>

namespace touchtrial::analysis {

inline constexpr int kBootstrapDraws = 9999;
/// With fewer participants, the ends of a bootstrap interval are the most extreme draws.
inline constexpr std::size_t kMinBootstrapParticipants = 6;

/// The ends of a bootstrap interval: expanded percentiles. Plain percentiles treat the spread
/// between participants as known. Expanded ones lie further out, at Phi(-t sqrt(n / (n - 1))) on
/// either side with Student's t of n - 1 degrees; they keep their level from about eight
/// participants on.
/// \param draws  at least one draw of a statistic, in any order
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

/// A statistic of the participants with these indices; an index that appears twice counts twice.
using ResampledStatistic = std::function<double(std::span<const std::size_t> drawn)>;

/// The interval of any statistic over participants, by the same method.
/// \param participants  their number
/// \param index  chooses the stream of random numbers
/// \param draws  >= 1
/// \return nothing with fewer than two participants
/// \throws std::invalid_argument if a number is not finite, or an argument is out of range
[[nodiscard]] std::optional<Interval> bootstrap_statistic(std::size_t participants,
                                                          const ResampledStatistic& statistic,
                                                          std::uint64_t index = 0,
                                                          int draws = kBootstrapDraws,
                                                          double level = kConfidenceLevel);

/// One participant's part of a ratio of two sums.
struct Ratio {
  double above = 0.0;
  double below = 0.0;
};

/// The interval of sum(above) / sum(below), a ratio between 0 and infinity, by the same method.
/// \param participants  both numbers finite and >= 0
/// \param index  chooses the stream of random numbers
/// \param draws  >= 1
/// \return nothing with fewer than two participants, if an end would be 0 or infinite, or if both
///   sums are 0 in some draw
/// \throws std::invalid_argument if an argument is out of range
[[nodiscard]] std::optional<Interval> bootstrap_ratio(std::span<const Ratio> participants,
                                                      std::uint64_t index = 0,
                                                      int draws = kBootstrapDraws,
                                                      double level = kConfidenceLevel);

/// An estimate and its interval, both within the range of possible values.
struct JackknifeEstimate {
  double value = 0.0;
  Interval interval;
};

/// The jackknife over participants: an estimate without most of the bias that few participants give
/// a statistic, n full_sample - (n - 1) mean(leave_one_out), and Student's t interval of n - 1
/// degrees from the spread of `leave_one_out`. The estimate always lies in its interval. Source:
/// docs/statistics.md, "Participants as clusters"; Miller 1974.
/// \param full_sample  the statistic of all participants
/// \param leave_one_out  the n >= 2 statistics that each leave out one participant
/// \param range  of possible values, to which estimate and interval are cut
/// \throws std::invalid_argument if there are fewer than two, or a number is not finite
[[nodiscard]] JackknifeEstimate jackknife(double full_sample, std::span<const double> leave_one_out,
                                          const Interval& range, double level = kConfidenceLevel);

}  // namespace touchtrial::analysis
