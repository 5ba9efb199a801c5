/// \file Intervals for a published share of right answers under an assumed spread between people.
/// The spread is an assumption because papers often publish only shares. Source:
/// docs/statistics.md, "Participants as clusters".
#pragma once

#include "analysis/statistics/proportion.hpp"

namespace touchtrial::analysis {

/// A study in which all people have the same number of trials.
struct AssumedStudy {
  int people = 0;  ///< >= 2
  int trials = 0;  ///< per person, >= 1
};

/// The largest possible standard deviation of people's probabilities of a right answer with this
/// mean: each person is always right or always wrong.
[[nodiscard]] double largest_spread(double mean);

/// The 95 % t interval over people around a mean share, with the expected variance of people's
/// shares: spread^2 + (mean (1 - mean) - spread^2) / trials. It is clipped to [0, 1].
/// \param mean  in [0, 1]
/// \param spread  standard deviation of people's probabilities, 0 .. largest_spread(mean)
/// \throws std::invalid_argument if an argument is out of range
[[nodiscard]] Interval assumed_interval(double mean, double spread, AssumedStudy study);

/// The difference of the mean shares of two methods felt by the same people.
struct AssumedDifference {
  Interval difference;  ///< 95 % t interval over people of the difference of shares
  Interval decibel;     ///< the same for 10 log10 of the ratio of shares, to first order
};

/// \param first,second  mean shares of the methods, in (0, 1)
/// \param spread  standard deviation of people's differences, >= 0; each method contributes half of
///   its variance
/// \param study  trials per method
/// \throws std::invalid_argument if an argument is out of range
[[nodiscard]] AssumedDifference assumed_difference(double first, double second, double spread,
                                                   AssumedStudy study);

}  // namespace touchtrial::analysis
