/// \file What of a visit's schedule affects how a simulated participant answers later trials of it.
#pragma once

#include "study/schedule.hpp"

#include <string>
#include <vector>

namespace touchtrial::study {
struct Study;
}

namespace touchtrial::simulation {

/// One presentation, apart from what is felt of it.
struct TrialPlace {
  int block = 0;
  /// false: a plane without texture, after which nothing of the trial before is left.
  bool carries_over = true;
  /// Of the presented class; empty if it is not known. For what follows the answer alone.
  std::string label;
};

/// By presentation of one visit.
using TrialCourse = std::vector<TrialPlace>;

[[nodiscard]] TrialCourse course_of(const study::Study& study, const study::Schedule& schedule);

}  // namespace touchtrial::simulation
