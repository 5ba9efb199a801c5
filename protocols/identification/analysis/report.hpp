/// \file The report of an identification study: how well participants distinguished the textures.
/// Format of the JSON: docs/data-dictionary.md, "Report".
#pragma once

#include "analysis/choices/preferences.hpp"
#include "analysis/choices/subsets.hpp"
#include "analysis/outcomes/outcomes.hpp"
#include "analysis/outcomes/study_head.hpp"
#include "analysis/statistics/chance_test.hpp"
#include "analysis/statistics/choice_model.hpp"
#include "analysis/statistics/confusion.hpp"
#include "analysis/statistics/d_prime.hpp"
#include "analysis/statistics/descriptive.hpp"
#include "analysis/statistics/information_transfer.hpp"
#include "analysis/statistics/order_effects.hpp"
#include "analysis/statistics/paired_tests.hpp"
#include "analysis/statistics/prevalence.hpp"
#include "analysis/statistics/proportion.hpp"
#include "analysis/statistics/spread.hpp"
#include "protocols/identification/analysis/accuracy_over_trials.hpp"
#include "protocols/identification/analysis/cues/cue_report.hpp"

#include <optional>
#include <string>
#include <vector>

namespace touchtrial::analysis::identification {

using choices::Breakdown;
using choices::BreakdownKind;
using choices::ConfidenceReport;
using choices::GroupAccuracy;
using choices::RatedAccuracy;
using choices::ReactionTimes;
using choices::SubsetAccuracy;
using choices::TrialSubset;

/// The accuracy with one class.
struct ClassAccuracy {
  Proportion accuracy;  ///< all participants' trials pooled
  Interval wilson;      ///< this and the next two treat pooled trials as independent
  Interval clopper_pearson;
  Interval jeffreys{};
  MeanEstimate mean{};  ///< over participants

  [[nodiscard]] bool has_interval_over_participants() const noexcept {
    return mean.known_interval().has_value();
  }
};

/// The unbiased hit rate of one class.
struct UnbiasedHits {
  MeanEstimate rate;                    ///< mean over participants
  std::optional<double> chance_rate{};  ///< mean of unbiased_hit_rate_by_chance
};

struct ParticipantAccuracy {
  std::string participant;
  Proportion accuracy;
  LabelMatching matching{};             ///< accuracy under the best exchange of labels
  std::optional<double> consistency{};  ///< raw information transfer, bits; never a main result
  double swap_p = 1.0;                  ///< label_swap_p of the matching
  double swap_p_adjusted = 1.0;  ///< benjamini_hochberg_adjusted over all participants and methods
};

/// The numbers of one method. Trials without a response are wrong everywhere except in information
/// transfer.
struct MethodReport {
  std::string method;
  ConfusionMatrix confusion{1};
  std::vector<ClassAccuracy> accuracy;  ///< by class
  Proportion overall;                   ///< all trials pooled
  MeanEstimate mean;                    ///< over participants: the main result
  InformationTransfer information;
  std::vector<ParticipantAccuracy> per_participant;  ///< in the order of sessions
  std::optional<Interval> bootstrap{};               ///< bootstrap_mean over participants
  std::optional<Spread> spread{};                    ///< between participants' probabilities
  std::optional<ChanceTest> chance{};      ///< test that at least one participant is above chance
  std::optional<Prevalence> prevalence{};  ///< prevalence_above_chance
  DPrime d_prime{};  ///< nominal, from pooled trials, with the limits of independent trials
  /// d_prime with bootstrap limits over participants; nothing unless six or more of them differ.
  std::optional<DPrime> d_prime_over_participants{};
  std::optional<ChoiceModel> choice{};
  LabelMatching matching{};                   ///< of the pooled trials
  std::vector<ReactionTimes> reaction_times;  ///< by class, then for all classes
  std::vector<UnbiasedHits> unbiased_hits;    ///< by class, then for the mean over classes
  std::vector<Breakdown> breakdowns;
  AccuracyOverTrials accuracy_over_trials{};
  std::optional<OrderEffects> order{};
  std::optional<ConfidenceReport> confidence{};
  std::vector<SubsetAccuracy> robustness;
};

/// Two methods with one class (Fig. 7 of the source paper).
struct ClassComparison {
  Proportion first;
  Proportion second;
  MethodComparison comparison;            ///< over participants; p is not adjusted
  std::optional<double> mcnemar_mid_p{};  ///< only with one pair per participant
};

/// The difference between two of the study's methods, first minus second.
struct MethodPair {
  int first = 0;  ///< indices into StudyReport::methods
  int second = 1;
  MethodComparison overall;
  std::optional<double> p_holm{};  ///< adjusted over all pairs; only with three or more methods
  std::optional<OddsRatio> odds_ratio{};  ///< stratified by participant
  std::optional<double> mcnemar_mid_p{};  ///< only with one pair per participant
  std::vector<ClassComparison> classes;
};

/// The comparison of three or more methods at once.
struct AllMethodsTest {
  CochranQ cochran;
  std::optional<double> permuted_p;  ///< methods permuted within participants
};

struct StudyReport : StudyHead {
  std::vector<MethodReport> methods;
  std::optional<MethodComparison> comparison;  ///< if there are exactly two methods
  std::vector<MethodPair> pairs;               ///< every pair, if there are two or more methods
  std::optional<AllMethodsTest> all_methods;   ///< if there are three or more methods
  std::optional<CueReport> cues{};             ///< only if the traces were read
  /// Answers by place over all methods; nothing without a counted answer.
  std::optional<choices::AnswersByPlace> places{};
};

[[nodiscard]] StudyReport make_report(const Outcomes& outcomes);

/// The answers of all participants.
[[nodiscard]] ConfusionMatrix confusion_of(const Outcomes& outcomes, int method);

/// Warnings against misreading the report, of one or two sentences each, the most serious first.
/// \param report  complete except for its warnings
[[nodiscard]] std::vector<std::string> report_warnings(const Outcomes& outcomes,
                                                       const StudyReport& report);

/// One JSON object, indented, with a line feed at the end. Missing numbers are null.
[[nodiscard]] std::string report_json(const StudyReport& report);

}  // namespace touchtrial::analysis::identification
