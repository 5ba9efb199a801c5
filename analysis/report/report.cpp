#include "analysis/report/report.hpp"

#include "analysis/report/report_warnings.hpp"

#include <algorithm>
#include <map>
#include <set>

namespace touchtrial {
namespace {

/// One participant's counted trials with one method.
using Choices = std::vector<Choice>;

/// By participant, in the order of sessions; participants without a trial have an empty list.
std::vector<Choices> choices_of_method(const Outcomes& outcomes, int method,
                                       const std::vector<std::string>& participants) {
  std::map<std::string, std::size_t> place;
  for (std::size_t i = 0; i < participants.size(); ++i) place[participants[i]] = i;
  std::vector<Choices> choices(participants.size());
  for (const TrialOutcome& trial : outcomes.trials) {
    if (!trial.counted || trial.stimulus.method != method) continue;
    choices[place.at(trial.participant)].push_back({trial.stimulus.class_index, trial.response});
  }
  return choices;
}

std::vector<std::string> counted_participants(const Outcomes& outcomes) {
  std::vector<std::string> participants;
  std::set<std::string> known;
  for (const SessionOutcome& session : outcomes.sessions) {
    const std::string& name = session.row.participant;
    if (session.counted && known.insert(name).second) participants.push_back(name);
  }
  return participants;
}

void add_class_accuracies(MethodReport& report) {
  for (int i = 0; i < report.confusion.classes(); ++i) {
    const Proportion accuracy = report.confusion.accuracy(i);
    report.accuracy.push_back(
        {accuracy, wilson_interval(accuracy), clopper_pearson_interval(accuracy)});
  }
}

Proportion accuracy_of(const Choices& choices) {
  const auto correct = std::count_if(choices.begin(), choices.end(), [](const Choice& choice) {
    return choice.answered == choice.presented;
  });
  return {static_cast<int>(choices.size()), static_cast<int>(correct)};
}

void add_participants(MethodReport& report, const std::vector<Choices>& choices,
                      const std::vector<std::string>& participants) {
  std::vector<double> shares;
  for (std::size_t i = 0; i < participants.size(); ++i) {
    const Proportion accuracy = accuracy_of(choices[i]);
    if (accuracy.n == 0) continue;
    report.per_participant.push_back({participants[i], accuracy});
    shares.push_back(accuracy.share().value_or(0.0));
  }
  report.mean = participant_mean(shares);
}

MethodReport method_report(const Outcomes& outcomes, int method,
                           const std::vector<std::string>& participants) {
  const auto classes = static_cast<int>(outcomes.classes.size());
  const std::vector<Choices> choices = choices_of_method(outcomes, method, participants);
  MethodReport report;
  report.method = outcomes.methods[method];
  report.confusion = ConfusionMatrix(classes);
  for (const Choices& mine : choices) {
    for (const Choice& choice : mine) report.confusion.add(choice);
  }
  report.overall = report.confusion.accuracy();
  report.information = information_transfer(classes, choices, static_cast<std::uint64_t>(method));
  add_class_accuracies(report);
  add_participants(report, choices, participants);
  return report;
}

/// Of the participants who felt both methods.
MethodComparison comparison_of(const MethodReport& first, const MethodReport& second) {
  std::map<std::string, double> of_second;
  for (const ParticipantAccuracy& one : second.per_participant) {
    of_second[one.participant] = one.accuracy.share().value_or(0.0);
  }
  std::vector<PairedAccuracy> pairs;
  for (const ParticipantAccuracy& one : first.per_participant) {
    const auto other = of_second.find(one.participant);
    if (other == of_second.end()) continue;
    pairs.push_back({one.accuracy.share().value_or(0.0), other->second});
  }
  return compare_methods(pairs);
}

}  // namespace

StudyReport make_report(const Outcomes& outcomes) {
  StudyReport report;
  report.study = outcomes.study;
  report.protocol = name_of(outcomes.protocol);
  report.simulated = outcomes.simulated;
  report.pilot = outcomes.pilot;
  report.classes = outcomes.classes;
  const std::vector<std::string> participants = counted_participants(outcomes);
  report.participants = static_cast<int>(participants.size());
  for (int i = 0; i < static_cast<int>(outcomes.methods.size()); ++i) {
    report.methods.push_back(method_report(outcomes, i, participants));
    report.trials += report.methods.back().overall.n;
  }
  if (report.methods.size() == 2) {
    report.comparison = comparison_of(report.methods[0], report.methods[1]);
  }
  report.warnings = report_warnings(outcomes, report);
  return report;
}

}  // namespace touchtrial
