/// \file The numbers of a rating study, from the outcomes that count. A trial without an answer has
/// no rating. Source: docs/rating.md, "What the report says".
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

/// The answers on one scale. What is of a participant stands in the order of RatingReport::people.
struct ScaleReport {
  study::Scale scale;
  RatingMeans means;
  std::vector<std::vector<double>> own_means;  ///< of each of means.items: the participants' own
  std::vector<MethodDifference> differences;
  Agreement agreement;
  /// Of each participant who rated all items: the standard deviation of what is left of the own
  /// means of items when those of the participant and of the items are taken away.
  std::vector<std::optional<double>> scatter;
  RetestReliability retest;
  ScaleUses use;
  CatchComparison catches;
};

struct RatingReport : StudyHead {
  std::vector<std::string> methods;  ///< labels
  std::vector<std::string> people;   ///< whose session counts, in the order of sessions
  int without_answer = 0;            ///< trials that count and have no rating
  std::vector<ScaleReport> scales;
};

/// A session's trials that have ratings: those that count, and catch trials of sessions that count.
/// The pointers refer to the outcomes.
struct RatedTrials {
  std::string participant;
  std::vector<const TrialOutcome*> trials;  ///< by session and trial
};

/// \param outcomes  must outlive the result
/// \return in the order of sessions; also those without a trial
[[nodiscard]] std::vector<RatedTrials> rated_trials(const Outcomes& outcomes);

[[nodiscard]] RatingReport make_report(const Outcomes& outcomes);

[[nodiscard]] Interval ends_of(const study::Scale& scale);

/// How a reader could misread the numbers, the gravest first.
/// \param report  complete except for its warnings
[[nodiscard]] std::vector<std::string> rating_warnings(const RatingReport& report);

[[nodiscard]] std::string report_json(const RatingReport& report);

}  // namespace touchtrial::analysis::rating
