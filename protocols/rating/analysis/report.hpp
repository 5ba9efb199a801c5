/// \file The numbers of a rating study, from counted outcomes. A trial without an answer has no
/// rating. Source: docs/rating.md, "What the report contains".
#pragma once

#include "analysis/outcomes/outcomes.hpp"
#include "analysis/outcomes/study_head.hpp"
#include "protocols/rating/analysis/rating_statistics.hpp"
#include "study/ask.hpp"

#include <optional>
#include <span>
#include <string>
#include <vector>

namespace touchtrial::analysis::rating {

/// The answers on one scale. Numbers by participant are in the order of RatingReport::people.
struct ScaleReport {
  study::Scale scale;
  RatingMeans means;
  std::vector<std::vector<double>> participant_means;  ///< by means.items and participant
  std::vector<MethodDifference> differences;
  Agreement agreement;
  /// By participant: the standard deviation of the item means after removing the effects of
  /// participant and item. Nothing for participants who did not rate all items.
  std::vector<std::optional<double>> scatter;
  RetestReliability retest;
  ScaleUses use;
  CatchComparison catches;
};

struct RatingReport : StudyHead {
  std::vector<std::string> methods;  ///< labels
  std::vector<std::string> people;   ///< with a counted session, in the order of sessions
  int without_answer = 0;            ///< counted trials without a rating
  std::vector<ScaleReport> scales;
};

/// A participant's trials with ratings: counted trials, and catch trials of counted sessions.
/// Pointers into the outcomes.
struct RatedTrials {
  std::string participant;
  std::vector<const TrialOutcome*> trials;  ///< by session and trial
};

/// \param outcomes  must outlive the result
/// \return in the order of sessions, including participants without a trial
[[nodiscard]] std::vector<RatedTrials> rated_trials(const Outcomes& outcomes);

[[nodiscard]] RatingReport make_report(const Outcomes& outcomes);

[[nodiscard]] Interval ends_of(const study::Scale& scale);

/// Warnings against misreading the report, the most serious first.
/// \param report  complete except for its warnings
[[nodiscard]] std::vector<std::string> rating_warnings(const RatingReport& report);

[[nodiscard]] std::string report_json(const RatingReport& report);

}  // namespace touchtrial::analysis::rating
