#include "analysis/report/report.hpp"

#include "analysis/report/counted_trials.hpp"
#include "analysis/report/method_pairs.hpp"
#include "analysis/report/method_report.hpp"
#include "analysis/report/report_warnings.hpp"

namespace touchtrial::analysis {
namespace {

StudyReport titled(const Outcomes& outcomes) {
  StudyReport report;
  report.study = outcomes.study;
  report.protocol = name_of(outcomes.protocol);
  report.simulated = outcomes.simulated;
  report.pilot = outcomes.pilot;
  report.state = outcomes.state;
  report.classes = outcomes.classes;
  report.collection = outcomes.collection;
  report.registration = outcomes.design.registration;
  return report;
}

}  // namespace

StudyReport make_report(const Outcomes& outcomes) {
  const auto classes = static_cast<int>(outcomes.classes.size());
  const CountedTrials counted = counted_by_method(outcomes);
  StudyReport report = titled(outcomes);
  report.participants = static_cast<int>(counted.participants.size());
  for (int i = 0; i < static_cast<int>(outcomes.methods.size()); ++i) {
    report.methods.push_back(method_report(outcomes, i, counted));
    report.trials += report.methods.back().overall.n;
  }
  report.pairs = method_pairs(classes, counted);
  if (report.methods.size() == 2) report.comparison = report.pairs.front().overall;
  report.together = methods_together(classes, counted);
  report.warnings = report_warnings(outcomes, report);
  return report;
}

}  // namespace touchtrial::analysis
