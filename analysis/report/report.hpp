/// \file How well participants told the textures apart: the study's tables.
/// Format of the JSON: docs/data-dictionary.md, "Report".
#pragma once

#include "analysis/outcomes.hpp"
#include "analysis/statistics/confusion.hpp"
#include "analysis/statistics/information_transfer.hpp"
#include "analysis/statistics/method_comparison.hpp"
#include "analysis/statistics/participant_mean.hpp"
#include "analysis/statistics/proportion.hpp"

#include <optional>
#include <string>
#include <vector>

namespace touchtrial {

/// Accuracy with a class, all participants' trials pooled.
struct ClassAccuracy {
  Proportion accuracy;
  Interval wilson;
  Interval clopper_pearson;
};

struct ParticipantAccuracy {
  std::string participant;
  Proportion accuracy;
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
};

struct StudyReport {
  std::string study;
  std::string protocol;
  bool simulated = false;
  bool pilot = false;
  int participants = 0;  ///< whose session counts
  int trials = 0;        ///< that count
  std::vector<std::string> classes;
  std::vector<MethodReport> methods;
  std::optional<MethodComparison> comparison;  ///< of exactly two methods
  std::vector<std::string> warnings;           ///< what a reader could take a figure for, wrongly
};

/// Counts the outcomes that count.
[[nodiscard]] StudyReport make_report(const Outcomes& outcomes);

/// One JSON object, indented, ending with a line feed. Figures that do not exist are null.
[[nodiscard]] std::string report_json(const StudyReport& report);

/// Tables for a terminal of 100 columns or more, ending with a line feed.
[[nodiscard]] std::string report_text(const StudyReport& report);

}  // namespace touchtrial
