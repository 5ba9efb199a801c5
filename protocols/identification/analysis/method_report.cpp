#include "protocols/identification/analysis/method_report.hpp"

#include "analysis/statistics/cluster_bootstrap.hpp"
#include "core/parallel.hpp"
#include "protocols/identification/analysis/chance.hpp"
#include "protocols/identification/analysis/order.hpp"

#include <algorithm>
#include <cstddef>
#include <functional>
#include <initializer_list>

namespace touchtrial::analysis::identification {
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

/// The number of deals for the null mean. With many trials the mean varies little from deal to deal
/// and each deal takes longer, so fewer suffice.
int null_deals(int trials) {
  return std::clamp(kMostNullTrials / std::max(1, trials), kFewestNullDeals, kNullDeals);
}

/// The participants' own accuracies with a class.
std::vector<double> shares_of_class(const std::vector<OwnTrials>& by_participant, int class_index) {
  std::vector<double> shares;
  for (const OwnTrials& trials : by_participant) {
    const auto share = accuracy_of(of_class(trials, class_index)).share();
    if (share) shares.push_back(*share);
  }
  return shares;
}

void add_class_accuracies(const std::vector<OwnTrials>& by_participant, MethodReport& report) {
  for (int i = 0; i < report.confusion.classes(); ++i) {
    const Proportion accuracy = report.confusion.accuracy(i);
    report.accuracy.push_back({accuracy, wilson_interval(accuracy),
                               clopper_pearson_interval(accuracy), jeffreys_interval(accuracy),
                               participant_mean(shares_of_class(by_participant, i))});
  }
}

/// What each participant answered.
std::vector<ConfusionMatrix> own_confusions(int classes,
                                            const std::vector<OwnTrials>& by_participant) {
  std::vector<ConfusionMatrix> own;
  for (const OwnTrials& trials : by_participant) {
    if (!trials.empty()) own.emplace_back(classes, choices_of(trials));
  }
  return own;
}

/// Of participants' means over the classes from `first` to `last`.
UnbiasedHits unbiased_hits(const std::vector<ConfusionMatrix>& participants, int first, int last) {
  std::vector<double> rates;
  double by_chance = 0.0;
  for (const ConfusionMatrix& own : participants) {
    double rate = 0.0;
    double chance = 0.0;
    int presented = 0;
    for (int i = first; i <= last; ++i) {
      const auto one = unbiased_hit_rate(own, i);
      if (!one) continue;
      ++presented;
      rate += *one;
      chance += unbiased_hit_rate_by_chance(own, i).value_or(0.0);
    }
    if (presented == 0) continue;
    rates.push_back(rate / presented);
    by_chance += chance / presented;
  }
  UnbiasedHits hits{participant_mean(rates)};
  if (!rates.empty()) hits.by_chance = by_chance / static_cast<double>(rates.size());
  return hits;
}

void add_unbiased_hits(int classes, const std::vector<OwnTrials>& by_participant,
                       MethodReport& report) {
  const std::vector<ConfusionMatrix> own = own_confusions(classes, by_participant);
  for (int i = 0; i < classes; ++i) report.unbiased.push_back(unbiased_hits(own, i, i));
  report.unbiased.push_back(unbiased_hits(own, 0, classes - 1));
}

ParticipantAccuracy participant_accuracy(int classes, const std::string& name,
                                         const OwnTrials& trials) {
  const ConfusionMatrix own(classes, choices_of(trials));
  const LabelMatching matching = best_label_matching(own);
  return {name, accuracy_of(trials), matching, raw_information_transfer(own),
          label_swap_p(own, matching)};
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
  report.bootstrap = bootstrap_mean(shares, static_cast<std::uint64_t>(method));
  report.spread = spread_of(accuracies);
  if (accuracies.size() < kFewestForBootstrap) return;
  const auto pooled = cluster_bootstrap(accuracies, static_cast<std::uint64_t>(method));
  if (pooled && pooled->low < pooled->high) {
    report.d_prime_over_participants = d_prime(report.overall, classes, *pooled);
  }
}

/// Adds the p of the fit by drawn tables: fewer of them where each has many trials.
void judge(ChoiceModel& model, int trials, int method) {
  constexpr int kMostDrawnTrials = 5'000'000;
  constexpr int kFewestDraws = 199;
  constexpr int kMostDraws = 999;
  if (!model.converged) return;
  model.draws = std::clamp(kMostDrawnTrials / std::max(1, trials), kFewestDraws, kMostDraws);
  model.drawn_p = choice_model_p(model, model.draws, static_cast<std::uint64_t>(method));
}

InformationTransfer information_of(int classes, const std::vector<OwnTrials>& by_participant,
                                   int trials, int method) {
  std::vector<Choices> choices;
  for (const OwnTrials& own : by_participant) choices.push_back(choices_of(own));
  return information_transfer(classes, choices, static_cast<std::uint64_t>(method),
                              null_deals(trials));
}

/// Calls functions at once where a study is so large that threads pay.
void in_parts(int trials, std::initializer_list<std::function<void()>> parts) {
  constexpr int kFewTrials = 2'000;
  const auto take = [&](std::size_t i) { parts.begin()[i](); };
  if (trials >= kFewTrials) return all_in_parallel(parts.size(), take);
  for (std::size_t i = 0; i < parts.size(); ++i) take(i);
}

}  // namespace

MethodReport method_report(const Outcomes& outcomes, int method, const CountedTrials& counted) {
  const auto classes = static_cast<int>(outcomes.classes.size());
  const std::vector<OwnTrials>& trials = counted.trials[method];
  MethodReport report;
  report.method = outcomes.methods[method];
  report.confusion = confusion_of(outcomes, method);
  report.overall = report.confusion.accuracy();
  const int all = report.overall.n;
  // Each part has its own members of the report, and its own random numbers.
  in_parts(all, {[&] {
                   report.choice = choice_model(report.confusion);
                   if (report.choice) judge(*report.choice, all, method);
                 },
                 [&] { report.order = order_of(outcomes, method); },
                 [&] { report.information = information_of(classes, trials, all, method); },
                 [&] { add_participants(classes, counted, method, report); },
                 [&] {
                   KnownMatches known;
                   report.chance = chance_of(outcomes, method, kMostChanceDeals, &known);
                   report.prevalence = own_prevalence(outcomes, method, &known);
                 },
                 [&] {
                   report.matching = best_label_matching(report.confusion);
                   report.d_prime = d_prime(report.overall, classes);
                   add_class_accuracies(trials, report);
                   add_unbiased_hits(classes, trials, report);
                   report.reaction = reaction_times(outcomes, method);
                   report.breakdowns = breakdowns(outcomes, method);
                   report.confidence = confidence_of(outcomes, method);
                   report.robustness = robustness(outcomes, method);
                 }});
  return report;
}

}  // namespace touchtrial::analysis::identification
