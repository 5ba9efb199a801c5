/// \file Accuracy in subsets of trials (by image, place, visit, group, exclusion and confidence), and
/// reaction times.
#pragma once

#include "analysis/choices/people.hpp"

#include <optional>
#include <string>
#include <vector>

namespace touchtrial::choices {

enum class BreakdownKind {
  exemplar,     ///< groups are named "class: image"
  trial,        ///< place among a participant's scored trials of the method, from 1
  order_group,  ///< row of the Williams design of method blocks
  visit,        ///< in studies with several visits
  group         ///< of participants, as assigned
};

struct GroupAccuracy {
  std::string group;
  Proportion accuracy;
  Interval wilson;
  /// Mean over participants with Student's interval; only for visits and groups.
  std::optional<MeanEstimate> mean{};
};

struct Breakdown {
  BreakdownKind kind{};
  std::vector<GroupAccuracy> groups;  ///< in the order of the study; each has a trial
};

/// "exemplar", "trial", "order_group", "visit", "group"
[[nodiscard]] std::string name_of(BreakdownKind kind);

/// The breakdowns of one method's counted trials that have at least two groups.
[[nodiscard]] std::vector<Breakdown> breakdowns(const Outcomes& outcomes, int method);

enum class TrialSubset {
  counted,                ///< the main analysis; missing responses are wrong
  answered,               ///< trials with a response
  valid,                  ///< trials that satisfy the study's validity rule
  with_excluded_sessions  ///< also completed sessions of excluded participants
};

struct SubsetAccuracy {
  TrialSubset subset{};
  Proportion pooled;
  MeanEstimate mean;
};

/// "counted", "answered", "valid", "with_excluded_sessions"
[[nodiscard]] std::string name_of(TrialSubset subset);

/// The accuracy of one method in every TrialSubset, in their order.
[[nodiscard]] std::vector<SubsetAccuracy> robustness(const Outcomes& outcomes, int method);

/// Times of the trials with a response, in seconds on the servo's monotonic clock.
struct ReactionTimes {
  analysis::Quartiles from_plane_on;  ///< from rendering of the plane to the answer
  analysis::Quartiles from_contact;   ///< from first contact to the answer
  std::vector<double> seconds{};      ///< from plane-on, ascending; for the figure
  int paused = 0;                     ///< responses after a pause, without a time
};

/// The reaction times of one method, by class; the last entry pools all classes.
[[nodiscard]] std::vector<ReactionTimes> reaction_times(const Outcomes& outcomes, int method);

/// Accuracy of the answers with one confidence rating.
struct RatedAccuracy {
  int rating = 1;
  Proportion accuracy;  ///< all participants' answers pooled
  MeanEstimate mean;    ///< over participants who gave this rating
};

struct ConfidenceReport {
  std::vector<RatedAccuracy> ratings;  ///< from 1 (a guess) to the study's highest
  MeanEstimate area;                   ///< type-2 area, over participants
  int without_area = 0;                ///< participants whose answers are all right or all wrong
};

/// One method's counted trials with a response and a rating.
/// \return nothing if the study does not ask for confidence
[[nodiscard]] std::optional<ConfidenceReport> confidence_of(const Outcomes& outcomes, int method);

}  // namespace touchtrial::choices
