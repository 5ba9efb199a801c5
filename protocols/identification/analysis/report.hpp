/// \file The report of a study: how well participants told the textures apart. Format of the JSON:
/// docs/data-dictionary.md, "Report".
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

/// Accuracy with a class.
struct ClassAccuracy {
  Proportion accuracy;  ///< all participants' trials pooled
  Interval wilson;      ///< this and the next two treat pooled trials as independent
  Interval clopper_pearson;
  Interval jeffreys{};
  MeanEstimate mean{};  ///< mean of the participants' own accuracies with the class

  [[nodiscard]] bool has_interval_over_participants() const noexcept {
    return mean.known_interval().has_value();
  }
};

/// unbiased_hit_rate of each participant's own answers.
struct UnbiasedHits {
  MeanEstimate rate;                  ///< mean over participants
  std::optional<double> by_chance{};  ///< mean of unbiased_hit_rate_by_chance
};

struct ParticipantAccuracy {
  std::string participant;
  Proportion accuracy;
  LabelMatching matching{};             ///< accuracy under the best exchange of labels
  std::optional<double> consistency{};  ///< raw information transfer, bits; never a headline
  double swap_p = 1.0;                  ///< label_swap_p of the matching
  double swap_adjusted = 1.0;  ///< benjamini_hochberg_adjusted over all participants and methods
};

/// The numbers of one method. Trials without a response are wrong everywhere except in information
/// transfer.
struct MethodReport {
  std::string method;
  ConfusionMatrix confusion{1};
  std::vector<ClassAccuracy> accuracy;  ///< by class
  Proportion overall;                   ///< all trials pooled
  MeanEstimate mean;                    ///< mean of the participants' accuracies: the headline
  InformationTransfer information;
  std::vector<ParticipantAccuracy> per_participant;  ///< in the order of sessions
  std::optional<Interval> bootstrap{};               ///< bootstrap_mean of the same accuracies
  std::optional<Spread> spread{};                    ///< of participants' own probabilities
  std::optional<ChanceTest> chance{};                ///< that at least one participant can
  std::optional<Prevalence> prevalence{};            ///< own_prevalence
  DPrime d_prime{};  ///< nominal, from the pooled trials, with the limits of independent trials
  /// The same, with limits by drawing participants; nothing unless six or more of them differ.
  std::optional<DPrime> d_prime_over_participants{};
  std::optional<ChoiceModel> choice{};
  LabelMatching matching{};             ///< of the pooled trials
  std::vector<ReactionTimes> reaction;  ///< by class, then of all classes together
  std::vector<UnbiasedHits> unbiased;   ///< by class, then of participants' means over classes
  std::vector<Breakdown> breakdowns;
  AccuracyOverTrials over_trials{};
  std::optional<OrderEffects> order{};
  std::optional<ConfidenceReport> confidence{};
  std::vector<SubsetAccuracy> robustness;
};

/// Two methods with one class (Fig. 7 of the source paper).
struct ClassComparison {
  Proportion first;
  Proportion second;
  MethodComparison paired;                ///< over participants; p is not adjusted
  std::optional<double> mcnemar_mid_p{};  ///< only with one pair for each participant
};

/// The difference between two of the study's methods, first minus second.
struct MethodPair {
  int first = 0;  ///< indices into StudyReport::methods
  int second = 1;
  MethodComparison overall;
  std::optional<double> p_holm{};  ///< adjusted over all pairs; only with three or more methods
  std::optional<OddsRatio> odds_ratio{};  ///< stratified by participant
  std::optional<double> mcnemar_mid_p{};  ///< only with one pair for each participant
  std::vector<ClassComparison> classes;
};

/// Three or more methods, compared at once.
struct MethodsTogether {
  CochranQ cochran;
  std::optional<double> permuted_p;  ///< p when methods are exchanged within participants
};

struct StudyReport : StudyHead {
  std::vector<MethodReport> methods;
  std::optional<MethodComparison> comparison;  ///< if there are exactly two methods
  std::vector<MethodPair> pairs;               ///< every pair, if there are two or more methods
  std::optional<MethodsTogether> together;     ///< if there are three or more methods
  std::optional<CueReport> cues{};             ///< only if the traces were read
  /// All methods together; nothing without an answer that counts.
  std::optional<choices::AnswersByPlace> places{};
};

/// Makes the report from the outcomes that count.
[[nodiscard]] StudyReport make_report(const Outcomes& outcomes);

/// All participants' trials with one method.
[[nodiscard]] ConfusionMatrix confusion_of(const Outcomes& outcomes, int method);

/// The warnings against misreading the report, of one or two sentences each, the gravest first.
/// \param report  complete except for its warnings
[[nodiscard]] std::vector<std::string> report_warnings(const Outcomes& outcomes,
                                                       const StudyReport& report);

/// The report as one JSON object, indented, with a line feed at the end. Numbers that do not exist
/// are null.
[[nodiscard]] std::string report_json(const StudyReport& report);

}  // namespace touchtrial::analysis::identification
