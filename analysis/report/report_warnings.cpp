#include "analysis/report/report_warnings.hpp"

#include "analysis/report/figure_warnings.hpp"
#include "analysis/text_figures.hpp"

#include <algorithm>
#include <set>

#include <fmt/format.h>

namespace touchtrial::analysis {
namespace {

using Warnings = std::vector<std::string>;

template <typename Which>
void warn_of_sessions(const Outcomes& outcomes, const std::string& why, Which which,
                      Warnings& warnings) {
  const auto n = std::count_if(outcomes.sessions.begin(), outcomes.sessions.end(),
                               [&](const SessionOutcome& one) { return which(one.row); });
  if (n > 0) warnings.push_back(fmt::format("Left out: {}, {}.", counted(n, "session"), why));
}

void warn_of_state(const Outcomes& outcomes, Warnings& warnings) {
  if (outcomes.pilot) warnings.emplace_back("A pilot: not to be pooled with the study's data.");
  if (outcomes.visual) {
    warnings.emplace_back(
        "Seen on a screen, not felt, and so not blind: never to be pooled with what was felt.");
  }
  if (!outcomes.state.closed) {
    warnings.emplace_back(
        "An interim look: the study is still open, and what is seen here may not decide when it "
        "ends.");
  }
  if (outcomes.sessions_unseen > 0) {
    warnings.push_back(
        fmt::format("Left out: {}, not ended before the interim look; `touchtrial unblind` again "
                    "to see more.",
                    counted(outcomes.sessions_unseen, "session")));
  }
  warn_of_sessions(
      outcomes, "withdrawn by the participant",
      [](const store::SessionRow& row) { return row.withdrawn; }, warnings);
  warn_of_sessions(
      outcomes, "excluded",
      [](const store::SessionRow& row) { return row.excluded && !row.withdrawn; }, warnings);
  warn_of_sessions(
      outcomes, "not completed",
      [](const store::SessionRow& row) {
        return row.state != store::SessionState::completed && !row.excluded && !row.withdrawn;
      },
      warnings);
  warn_of_sessions(
      outcomes, "a pilot or simulation among others",
      [&](const store::SessionRow& row) {
        return row.state == store::SessionState::completed && !row.excluded && !row.withdrawn &&
               (row.pilot != outcomes.pilot || row.simulated != outcomes.simulated);
      },
      warnings);
}

void warn_of_trials(const Outcomes& outcomes, Warnings& warnings) {
  std::set<int> counted_sessions;
  for (const SessionOutcome& session : outcomes.sessions) {
    if (session.counted) counted_sessions.insert(session.row.session);
  }
  const auto unfinished = [&](const TrialOutcome& trial) {
    return trial.scored && !trial.counted && counted_sessions.contains(trial.row.session);
  };
  const auto interrupted =
      std::count_if(outcomes.trials.begin(), outcomes.trials.end(), unfinished);
  if (interrupted > 0) {
    warnings.push_back(fmt::format("Left out: {}, interrupted and never repeated.",
                                   counted(interrupted, "trial")));
  }
  const auto invalid =
      std::count_if(outcomes.trials.begin(), outcomes.trials.end(),
                    [](const TrialOutcome& trial) { return trial.counted && !trial.valid(); });
  if (invalid > 0) {
    warnings.push_back(fmt::format("Counted although not valid by the study's rule: {}.",
                                   counted(invalid, "trial")));
  }
}

void warn_of_time_outs(const StudyReport& report, Warnings& warnings) {
  for (const MethodReport& method : report.methods) {
    const int answered = method.confusion.answered();
    const int missed = method.overall.n - answered;
    if (missed == 0) continue;
    warnings.push_back(fmt::format(
        "{}: {} without a response, counted as wrong; with them excluded {} of {} are correct.",
        method.method, counted(missed, "trial"), method.overall.correct, answered));
  }
}

void warn_of_participants(const StudyReport& report, Warnings& warnings) {
  if (report.participants == 0) {
    warnings.emplace_back("No participant's session counts: there is nothing to report yet.");
  } else if (report.participants == 1) {
    warnings.emplace_back(
        "One participant: intervals over participants do not exist, and those of a class say "
        "next to nothing.");
  } else {
    warnings.emplace_back(
        "Intervals of a class pool all participants' trials as if they were independent, so they "
        "are too narrow; the interval to quote is that of the mean over participants.");
  }
  for (const MethodReport& method : report.methods) {
    if (method.mean.participants > 1 && method.mean.interval.low == method.mean.interval.high) {
      warnings.push_back(
          method.method +
          ": all participants have the same accuracy; the interval's zero width is no certainty.");
    }
  }
}

void warn_of_information(const StudyReport& report, Warnings& warnings) {
  const int wanted = trials_for_information_transfer(static_cast<int>(report.classes.size()));
  for (const MethodReport& method : report.methods) {
    const int answered = method.confusion.answered();
    if (answered == 0 || answered >= wanted) continue;
    warnings.push_back(fmt::format(
        "{}: information transfer from {} is biased upward; {} are the usual minimum for {} "
        "classes.",
        method.method, counted(answered, "trial"), wanted, report.classes.size()));
  }
}

}  // namespace

std::vector<std::string> report_warnings(const Outcomes& outcomes, const StudyReport& report) {
  Warnings warnings;
  warn_of_state(outcomes, warnings);
  warn_of_trials(outcomes, warnings);
  warn_of_time_outs(report, warnings);
  warn_of_participants(report, warnings);
  warn_of_information(report, warnings);
  for (const Warnings& more :
       {figure_warnings(outcomes, report), comparison_warnings(outcomes, report)}) {
    warnings.insert(warnings.end(), more.begin(), more.end());
  }
  return warnings;
}

}  // namespace touchtrial::analysis
