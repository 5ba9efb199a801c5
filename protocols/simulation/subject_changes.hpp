/// \file Parts of a subject model: training, changes from trial to trial, and thinking time.
/// Source: docs/planning.md.
#pragma once

namespace touchtrial::simulation {

/// The training in which participants learn the pictures of textures.
enum class Training {
  shared,  ///< all participants remember the same explorations of each stimulus
  own,     ///< each participant remembers different explorations
};

/// Noise is larger at first, and its logarithm falls exponentially with the number of
/// presentations.
struct Learning {
  double factor = 1.0;     ///< on the noise of the first presentation, >= 1
  double trials = 50.0;    ///< presentations after which ln(factor) has fallen to 1/e, > 0
  double forgotten = 0.0;  ///< share of presentations forgotten after each visit, 0 .. 1
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
  double noise_per_min = 0.0;  ///< added to the natural logarithm of the noise, >= 0
  double lapse_per_min = 0.0;  ///< added to the log odds of a lapse, >= 0
  double recovered = 1.0;      ///< share of the minutes that a break removes, 0 .. 1

  friend bool operator==(const Fatigue&, const Fatigue&) = default;
};

/// An observer who answers by a psychometric function of the level, independent of felt features,
/// for checks of procedures and analyses. The shape is that of the study's grid.
struct GivenFunction {
  double threshold = 0.0;        ///< median over participants, in units of the level
  double spread = 0.0;           ///< standard deviation of the threshold between participants, >= 0
  double slope = 1.0;            ///< > 0
  double lapse = 0.0;            ///< in [0, 0.5)
  double standard_step = 0.0;    ///< difference of the thresholds of successive standards
  double standard_spread = 0.0;  ///< standard deviation of participants' deviations at a standard

  friend bool operator==(const GivenFunction&, const GivenFunction&) = default;
};

/// Time from the end of the exploration to the answer: a shifted lognormal. Its median above the
/// shift falls exponentially with the difference between the two largest supports.
struct ThoughtTime {
  double shift_s = 0.4;  ///< minimum, >= 0
  double easy_s = 0.8;  ///< median above the shift if one picture clearly has the most support, > 0
  double hard_s = 2.4;  ///< median above the shift if two pictures are equal, >= easy_s
  double margin = 3.0;  ///< log odds at which the surplus of hard_s has fallen to 1/e, > 0
  double spread = 0.4;  ///< standard deviation of the logarithm, >= 0
  double max_s = 30.0;  ///< maximum, > shift_s

  friend bool operator==(const ThoughtTime&, const ThoughtTime&) = default;
};

}  // namespace touchtrial::simulation
