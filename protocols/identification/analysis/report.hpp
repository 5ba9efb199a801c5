/// \file How well participants told the textures apart: the study's tables.
/// Format of the JSON: docs/data-dictionary.md, "Report".
#pragma once

#include "analysis/statistics/chance_test.hpp"
#include "analysis/statistics/choice_model.hpp"
#include "analysis/statistics/confusion.hpp"
#include "analysis/statistics/d_prime.hpp"
#include "analysis/statistics/descriptive.hpp"
#include "analysis/statistics/information_transfer.hpp"
#include "analysis/statistics/paired_tests.hpp"
#include "analysis/statistics/proportion.hpp"
#include "analysis/study_head.hpp"
#include "protocols/identification/analysis/cues/cue_report.hpp"
#include "protocols/identification/analysis/subsets.hpp"

#include <optional>
#include <string>
#include <vector>

namespace touchtrial::analysis::identification {

/// Accuracy with a class, all participants' trials pooled.
struct ClassAccuracy {
  Proportion accuracy;
  Interval wilson;
  Interval clopper_pearson;
  Interval jeffreys{};
};

struct ParticipantAccuracy {
  std::string participant;
  Proportion accuracy;
  LabelMatching matching{};             ///< what the best exchange of labels would give
  std::optional<double> consistency{};  ///< raw information transfer, bits; never to be headlined
};

/// One method's figures; trials without a response are wrong in all but information transfer.
struct MethodReport {
  std::string method;
  ConfusionMatrix confusion{1};
  std::vector<ClassAccuracy> accuracy;  ///< by class
  Proportion overall;                   ///< all trials pooled
  MeanEstimate mean;                    ///< over participants' own accuracies: the headline
  InformationTransfer information;
  std::vector<ParticipantAccuracy> per_participant;  ///< by session
  std::optional<Interval> bootstrap{};               ///< cluster_bootstrap of the headline
  std::optional<ChanceTest> chance{};
  DPrime d_prime{};  ///< of the pooled trials, nominal
  std::optional<ChoiceModel> choice{};
  LabelMatching matching{};             ///< of the pooled trials
  std::vector<ReactionTimes> reaction;  ///< by class, then all
  std::vector<Breakdown> breakdowns;
  std::vector<SubsetAccuracy> robustness;
};

/// Two methods with one class (Fig. 7).
struct ClassComparison {
  Proportion first;
  Proportion second;
  MethodComparison paired;                ///< over participants; its p is not adjusted
  std::optional<double> mcnemar_mid_p{};  ///< only with one pair a participant
};

/// Two of the study's methods, first minus second.
struct MethodPair {
  int first = 0;  ///< indices into StudyReport::methods
  int second = 1;
  MethodComparison overall;
  std::optional<double> p_holm{};         ///< adjusted over all pairs, with three methods or more
  std::optional<OddsRatio> odds_ratio{};  ///< stratified by participant
  std::optional<double> mcnemar_mid_p{};  ///< only with one pair a participant
  std::vector<ClassComparison> classes;
};

/// Three methods or more at once.
struct MethodsTogether {
  CochranQ cochran;
  std::optional<double> permuted_p;  ///< methods exchanged within participants
};

struct StudyReport : StudyHead {
  std::vector<MethodReport> methods;
  std::optional<MethodComparison> comparison;  ///< of exactly two methods
  std::vector<MethodPair> pairs;               ///< of two methods or more: every pair
  std::optional<MethodsTogether> together;     ///< of three methods or more
  std::optional<CueReport> cues{};             ///< if asked for: it takes reading every trace
};

/// Counts the outcomes that count.
[[nodiscard]] StudyReport make_report(const Outcomes& outcomes);

/// One JSON object, indented, ending with a line feed. Figures that do not exist are null.
[[nodiscard]] std::string report_json(const StudyReport& report);

/// Tables for a terminal of 100 columns or more, ending with a line feed.
[[nodiscard]] std::string report_text(const StudyReport& report);

}  // namespace touchtrial::analysis::identification
