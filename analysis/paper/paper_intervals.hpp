/// \file Intervals for a published share of right answers under an assumed spread between people.
/// The spread is an assumption because papers often publish only shares. Source:
/// docs/statistics.md, "Participants as clusters".
#pragma once

#include "analysis/statistics/proportion.hpp"

namespace touchtrial::analysis {

/// Equal numbers of trials of equal people.
struct AssumedStudy {
  int people = 0;  ///< >= 2
  int trials = 0;  ///< of each, >= 1
};

/// The largest possible standard deviation of people's own probabilities with this mean: each of
/// them is always right or always wrong.
[[nodiscard]] double widest_spread(double mean);

/// The 95 % t interval over people around a mean share, with the expected variance of people's
/// shares: spread^2 + (mean (1 - mean) - spread^2) / trials. It is cut to [0, 1].
/// \param mean  in [0, 1]
/// \param spread  standard deviation of people's own probabilities, 0 .. widest_spread(mean)
/// \throws std::invalid_argument if an argument is out of range
[[nodiscard]] Interval assumed_interval(double mean, double spread, AssumedStudy study);

/// The difference of two methods' means, felt by the same people.
struct AssumedDifference {
  Interval difference;  ///< of the shares; 95 % t interval over people
  Interval decibel;     ///< of 10 log10 of their ratio, to first order
};

/// \param first,second  mean shares of the methods, in (0, 1)
/// \param spread  standard deviation of people's own differences, >= 0; each method contributes
///   half of its variance
/// \param study  trials per method
/// \throws std::invalid_argument if an argument is out of range
[[nodiscard]] AssumedDifference assumed_difference(double first, double second, double spread,
                                                   AssumedStudy study);

}  // namespace touchtrial::analysis
