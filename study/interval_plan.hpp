/// \file How a trial goes that presents several planes one after the other. Source:
/// docs/thresholds.md, "Intervals".
#pragma once

#include <string>

namespace touchtrial::study {

/// What the hand must do for an interval's clock to run. Speed and force are those of the hand: the
/// force is what the wall without texture would answer, so that the clock tells nothing of the
/// texture.
struct IntervalWindows {
  double slowest_mm_s = 20.0;  ///< along the plane
  double fastest_mm_s = 300.0;
  double lightest_n = 0.15;
  double strongest_n = 2.5;

  friend bool operator==(const IntervalWindows&, const IntervalWindows&) = default;
};

/// A stylus that is so far above the plane has lifted off, mm.
inline constexpr double kLiftedMm = 1.0;

/// An interval ends when its clock, which runs in contact and inside the windows alone, has reached
/// `seconds`; then the hand lifts off, and the next plane comes on. A trial with an interval whose
/// clock has not got there within the study's explore_limit_s comes again.
struct IntervalPlan {
  int count = 2;         ///< planes of a trial, 2 or 3
  double seconds = 2.5;  ///< of exploration, > 0
  IntervalWindows windows{};
  std::string question;        ///< key of the answer's title in the section "screens" of the texts
  bool feedback = false;       ///< after each answer, whether it was right
  int practice_criterion = 0;  ///< right answers that end the practice
  int practice_rounds = 0;     ///< at most
};

}  // namespace touchtrial::study
