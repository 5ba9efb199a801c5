/// \file Parts of a subject model: how participants learn the classes, how they change from trial to
/// trial, and how long they think. Source: docs/planning.md.
#pragma once

namespace touchtrial::simulation {

/// How participants learn which picture belongs to which texture.
enum class Training {
  shared,  ///< all participants remember the same explorations of each stimulus
  own,     ///< each participant remembers different explorations
};

/// Noise is larger at first, and its logarithm falls exponentially with the presentations felt.
struct Learning {
  double factor = 1.0;   ///< on the noise of the first presentation, >= 1
  double trials = 50.0;  ///< presentations after which ln(factor) has fallen to 1/e, > 0
  double forgotten =
      0.0;  ///< share of the felt presentations that is forgotten after each visit, 0 .. 1
  /// Differences between participants: ln(factor) times exp(spread * z), z standard normal.
  double spread = 0.0;

  friend bool operator==(const Learning&, const Learning&) = default;
};

/// Support that the previous trial adds to pictures, log odds: > 0 attracts, < 0 repels.
struct SerialDependence {
  double answer = 0.0;  ///< for the picture chosen in the previous trial
  double answer_spread = 0.0;
  double stimulus = 0.0;  ///< for the picture of the class presented in the previous trial
  double stimulus_spread = 0.0;

  [[nodiscard]] bool is_on() const noexcept {
    return answer != 0.0 || answer_spread != 0.0 || stimulus != 0.0 || stimulus_spread != 0.0;
  }

  friend bool operator==(const SerialDependence&, const SerialDependence&) = default;
};

/// Effects of each minute of exploring since the visit began. A break reduces the minutes.
struct Fatigue {
  double noise_per_min = 0.0;  ///< to the natural logarithm of the noise, >= 0
  double lapse_per_min = 0.0;  ///< to the log odds of a lapse, >= 0
  double recovered = 1.0;      ///< share by which a break reduces the minutes, 0 .. 1

  friend bool operator==(const Fatigue&, const Fatigue&) = default;
};

/// An observer who answers by a psychometric function of the level, independent of what is felt. It
/// serves to check procedures and analyses. The shape is that of the study's grid.
struct GivenFunction {
  double threshold = 0.0;      ///< median over participants, in units of the level
  double spread = 0.0;         ///< standard deviation of the threshold between participants, >= 0
  double slope = 1.0;          ///< > 0
  double lapse = 0.0;          ///< in [0, 0.5)
  double standard_step = 0.0;  ///< difference of the thresholds of successive standards
  double standard_spread =
      0.0;  ///< standard deviation of a participant's deviation at each standard

  friend bool operator==(const GivenFunction&, const GivenFunction&) = default;
};

/// Time from the end of the exploration to the answer: a shifted lognormal, whose median above the
/// shift falls exponentially with the difference between the two strongest supports.
struct ThoughtTime {
  double shift_s = 0.4;  ///< minimum, >= 0
  double easy_s = 0.8;   ///< median above the shift if one picture clearly has most support, > 0
  double hard_s = 2.4;   ///< median above the shift if two pictures are equal, >= easy_s
  double margin = 3.0;   ///< log odds at which the surplus of hard_s has fallen to 1/e, > 0
  double spread = 0.4;   ///< standard deviation of the logarithm, >= 0
  double max_s = 30.0;   ///< maximum, > shift_s

  friend bool operator==(const ThoughtTime&, const ThoughtTime&) = default;
};

}  // namespace touchtrial::simulation
