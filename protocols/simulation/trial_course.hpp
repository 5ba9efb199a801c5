/// \file The parts of a visit's schedule that affect a simulated participant's later answers.
#pragma once

#include "study/schedule.hpp"

#include <string>
#include <vector>

namespace touchtrial::study {
struct Study;
}

namespace touchtrial::simulation {

/// One presentation, without its stimulus.
struct TrialPlace {
  int block = 0;
  /// Whether the trial affects the next one. A plane without texture does not.
  bool carries_over = true;
  /// Label of the presented class; empty if unknown. It must affect only later trials.
  std::string label;
};

/// The presentations of one visit.
using TrialCourse = std::vector<TrialPlace>;

[[nodiscard]] TrialCourse course_of(const study::Study& study, const study::Schedule& schedule);

}  // namespace touchtrial::simulation
