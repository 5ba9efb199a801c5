/// \file Accuracy by something that trials can be sorted by: an exemplar, the trial's number, what
/// came before it. Pooled over participants: for looking at, not for tests.
#pragma once

#include "analysis/outcomes.hpp"
#include "analysis/statistics/proportion.hpp"

#include <string>
#include <vector>

namespace touchtrial::analysis {

enum class BreakdownKind {
  exemplar,           ///< groups "class: image"
  trial,              ///< the place among a participant's scored trials of the method, from 1
  order_group,        ///< row of the Williams design of method blocks
  previous_stimulus,  ///< class of the presentation before, in the same block
  previous_response,  ///< class answered to it
};

struct GroupAccuracy {
  std::string group;
  Proportion accuracy;
  Interval wilson;
};

struct Breakdown {
  BreakdownKind kind{};
  std::vector<GroupAccuracy> groups;  ///< in a sensible order; none is empty
};

/// "exemplar", "trial", "order_group", "previous_stimulus", "previous_response"
[[nodiscard]] std::string name_of(BreakdownKind kind);

/// All kinds that tell anything (two groups or more) for one method's counted trials.
[[nodiscard]] std::vector<Breakdown> breakdowns(const Outcomes& outcomes, int method);

}  // namespace touchtrial::analysis
