/// \file The spread of sensory noise between participants, estimated from each participant's own
/// answers. Source: docs/planning.md, "Spread between people"; Self, Liang 1987 (the test of no
/// difference).
#pragma once

#include "analysis/planning/fit_evidence.hpp"

#include <optional>
#include <span>
#include <vector>

namespace touchtrial::planning {

/// An interval; an end that the data do not determine is missing.
struct OpenInterval {
  std::optional<double> lower;
  std::optional<double> upper;
};

/// Probabilities of answers without lapses, for evenly spaced amounts of noise.
struct NoiseAnswers {
  double min_log_noise = 0.0;  ///< ln of the first amount
  double step = 0.25;          ///< of ln noise, > 0
  std::size_t classes = 0;
  std::vector<Cells> answers;  ///< [amount][layout][stimulus x classes + answer], 4 or more
};

/// The start of the search, and the parameters besides the spread that may be estimated.
struct SpreadStart {
  double log_noise = 0.0;
  double lapse = 0.0;
  double spread = 0.0;  ///< the spread to test against the participants' answers, >= 0
  bool noise_is_free = true;
  bool lapse_is_free = true;
};

struct PeopleSpread {
  double spread = 0.0;    ///< standard deviation of ln noise between people
  OpenInterval interval;  ///< 95 %, by the profile likelihood
  double log_noise = 0.0;
  double lapse = 0.0;
  double equal_p = 1.0;    ///< of a spread of 0, by the likelihood ratio
  double assumed_p = 1.0;  ///< of SpreadStart::spread
};

/// The maximum number of people whose answers are used; larger samples are thinned evenly.
inline constexpr std::size_t kMaxPeopleOfSpread = 400;

/// Maximises the likelihood of all participants' answers. Each participant has one noise in all
/// trials, whose logarithm is normally distributed over people; all have the same lapse rate. Cost:
/// under 1 s for 20 people.
/// \return nothing with fewer than two people
/// \throws std::invalid_argument if an argument is out of range
[[nodiscard]] std::optional<PeopleSpread> people_spread(const NoiseAnswers& answers,
                                                        std::span<const CountedPerson> people,
                                                        const SpreadStart& start);

}  // namespace touchtrial::planning
