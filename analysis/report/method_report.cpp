#include "analysis/report/method_report.hpp"

#include "analysis/report/chance_of_study.hpp"
#include "analysis/statistics/cluster_bootstrap.hpp"

#include <algorithm>

namespace touchtrial::analysis {
namespace {

using Choices = std::vector<Choice>;

constexpr int kNullDeals = 500;
constexpr int kFewestNullDeals = 50;
constexpr int kMostNullTrials = 1'000'000;

Choices choices_of(const OwnTrials& trials) {
  Choices choices;
  for (const TrialOutcome* trial : trials) choices.push_back(choice_of(*trial));
  return choices;
}

ConfusionMatrix confusion_of(int classes, const OwnTrials& trials) {
  ConfusionMatrix confusion(classes);
  for (const TrialOutcome* trial : trials) confusion.add(choice_of(*trial));
  return confusion;
}

/// The null mean of many trials varies little from deal to deal, and each deal takes longer.
int null_deals(int trials) {
  return std::clamp(kMostNullTrials / std::max(1, trials), kFewestNullDeals, kNullDeals);
}

void add_class_accuracies(MethodReport& report) {
  for (int i = 0; i < report.confusion.classes(); ++i) {
    const Proportion accuracy = report.confusion.accuracy(i);
    report.accuracy.push_back({accuracy, wilson_interval(accuracy),
                               clopper_pearson_interval(accuracy), jeffreys_interval(accuracy)});
  }
}

ParticipantAccuracy participant_accuracy(int classes, const std::string& name,
                                         const OwnTrials& trials) {
  const ConfusionMatrix own = confusion_of(classes, trials);
  return {name, accuracy_of(trials), best_label_matching(own), raw_information_transfer(own)};
}

void add_participants(int classes, const CountedTrials& counted, int method, MethodReport& report) {
  std::vector<double> shares;
  std::vector<Proportion> accuracies;
  for (std::size_t i = 0; i < counted.participants.size(); ++i) {
    const OwnTrials& trials = counted.trials[method][i];
    if (trials.empty()) continue;
    report.per_participant.push_back(
        participant_accuracy(classes, counted.participants[i], trials));
    accuracies.push_back(report.per_participant.back().accuracy);
    shares.push_back(accuracies.back().share().value_or(0.0));
  }
  report.mean = participant_mean(shares);
  report.bootstrap = cluster_bootstrap(accuracies, static_cast<std::uint64_t>(method));
}

void add_confusions(int classes, const CountedTrials& counted, int method, MethodReport& report) {
  std::vector<Choices> choices;
  report.confusion = ConfusionMatrix(classes);
  for (const OwnTrials& trials : counted.trials[method]) {
    choices.push_back(choices_of(trials));
    for (const Choice& choice : choices.back()) report.confusion.add(choice);
  }
  report.overall = report.confusion.accuracy();
  report.information = information_transfer(classes, choices, static_cast<std::uint64_t>(method),
                                            null_deals(report.overall.n));
  report.choice = choice_model(report.confusion);
  report.matching = best_label_matching(report.confusion);
  report.d_prime = d_prime(report.overall, classes);
}

}  // namespace

MethodReport method_report(const Outcomes& outcomes, int method, const CountedTrials& counted) {
  const auto classes = static_cast<int>(outcomes.classes.size());
  MethodReport report;
  report.method = outcomes.methods[method];
  add_confusions(classes, counted, method, report);
  add_class_accuracies(report);
  add_participants(classes, counted, method, report);
  report.chance = chance_of(outcomes, method);
  report.reaction = reaction_times(outcomes, method);
  report.breakdowns = breakdowns(outcomes, method);
  report.robustness = robustness(outcomes, method);
  return report;
}

}  // namespace touchtrial::analysis
