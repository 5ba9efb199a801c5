#include "protocols/identification/analysis/report.hpp"

#include "analysis/outcomes/departures.hpp"
#include "analysis/statistics/paired_tests.hpp"
#include "protocols/identification/analysis/counted_trials.hpp"
#include "protocols/identification/analysis/method_pairs.hpp"
#include "protocols/identification/analysis/method_report.hpp"
#include "protocols/identification/analysis/primary.hpp"
#include "protocols/identification/analysis/warnings.hpp"

#include <algorithm>

namespace touchtrial::analysis::identification {
namespace {

/// Adjusts the p of label swaps over all participants and methods of the study.
void adjust_swaps(std::vector<MethodReport>& methods) {
  std::vector<double> p_values;
  for (const MethodReport& method : methods) {
    for (const ParticipantAccuracy& one : method.per_participant) p_values.push_back(one.swap_p);
  }
  const std::vector<double> adjusted = discovery_adjusted(p_values);
  auto next = adjusted.begin();
  for (MethodReport& method : methods) {
    for (ParticipantAccuracy& one : method.per_participant) one.swap_adjusted = *next++;
  }
}

/// A public report lists participants by their names, which are ranks, and so not in the order of
/// sessions.
void order_by_name(std::vector<MethodReport>& methods) {
  for (MethodReport& method : methods) {
    std::ranges::sort(method.per_participant, {}, &ParticipantAccuracy::participant);
  }
}

}  // namespace

StudyReport make_report(const Outcomes& outcomes) {
  const auto classes = static_cast<int>(outcomes.classes.size());
  const CountedTrials counted = counted_by_method(outcomes);
  StudyReport report;
  static_cast<StudyHead&>(report) = head_of(outcomes);
  for (int i = 0; i < static_cast<int>(outcomes.methods.size()); ++i) {
    report.methods.push_back(method_report(outcomes, i, counted));
  }
  adjust_swaps(report.methods);
  if (outcomes.collection.is_public) order_by_name(report.methods);
  report.pairs = method_pairs(classes, counted);
  if (report.methods.size() == 2) report.comparison = report.pairs.front().overall;
  report.together = methods_together(classes, counted);
  report.primary = primary_result(outcomes);
  if (report.primary && report.primary->ended_at_look) {
    report.departures = departures_of(outcomes, true);
  }
  if (report.methods.size() == 1) report.prevalence = report.methods.front().prevalence;
  report.warnings = report_warnings(outcomes, report);
  return report;
}

}  // namespace touchtrial::analysis::identification
