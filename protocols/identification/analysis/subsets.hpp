/// \file Accuracy of subsets of trials: by place, by what came before, with and without what may be
/// left out; and reaction times.
#pragma once

#include "analysis/outcomes.hpp"
#include "analysis/statistics/descriptive.hpp"
#include "analysis/statistics/proportion.hpp"

#include <string>
#include <vector>

namespace touchtrial::analysis::identification {

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

enum class TrialSubset {
  counted,                ///< the headline: missing responses are wrong
  answered,               ///< trials without a response left out
  valid,                  ///< trials that do not meet the study's validity rule left out
  with_excluded_sessions  ///< excluded participants' completed sessions put back
};

struct SubsetAccuracy {
  TrialSubset subset{};
  Proportion pooled;
  MeanEstimate mean;
};

/// "counted", "answered", "valid", "with_excluded_sessions"
[[nodiscard]] std::string name_of(TrialSubset subset);

/// One method's, the headline first; a subset that is the same trials as the headline is there too.
[[nodiscard]] std::vector<SubsetAccuracy> robustness(const Outcomes& outcomes, int method);

/// Of trials with a response, in seconds, on the servo's monotonic clock.
struct ReactionTimes {
  Quartiles from_plane_on;        ///< from the moment the plane can be felt to the answer
  Quartiles from_contact;         ///< from first contact to the answer
  std::vector<double> seconds{};  ///< from plane-on, rising: for the figure
};

/// One method's, by class; the last entry is all classes together.
[[nodiscard]] std::vector<ReactionTimes> reaction_times(const Outcomes& outcomes, int method);

}  // namespace touchtrial::analysis::identification
