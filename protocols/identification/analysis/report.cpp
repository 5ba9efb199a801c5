#include "protocols/identification/analysis/report.hpp"

#include "analysis/choices/orders.hpp"
#include "analysis/choices/primary.hpp"
#include "analysis/outcomes/departures.hpp"
#include "analysis/statistics/cluster_bootstrap.hpp"
#include "analysis/statistics/paired_tests.hpp"
#include "core/parallel.hpp"

#include <algorithm>
#include <cstddef>
#include <functional>
#include <initializer_list>
#include <utility>

namespace touchtrial::analysis::identification {
namespace {

using Choices = std::vector<Choice>;
using choices::Person;
using choices::PersonTrials;

/// Counted trials by method and participant; every method has all participants, in the order of
/// sessions.
using CountedTrials = std::vector<std::vector<Person>>;

constexpr int kNullDeals = 500;
constexpr int kMinNullDeals = 50;
constexpr int kMaxNullTrials = 1'000'000;

Choice choice_of(const TrialOutcome& trial) {
  return {trial.stimulus.class_index, trial.response};
}

Choices choices_of(const PersonTrials& trials) {
  Choices choices;
  for (const TrialOutcome* trial : trials) choices.push_back(choice_of(*trial));
  return choices;
}

PersonTrials trials_of_class(const PersonTrials& trials, int class_index) {
  PersonTrials selected;
  std::ranges::copy_if(trials, std::back_inserter(selected),
                       [class_index](const TrialOutcome* trial) {
                         return trial->stimulus.class_index == class_index;
                       });
  return selected;
}

std::vector<double> shares_of_class(const std::vector<Person>& people, int class_index) {
  std::vector<double> shares;
  for (const Person& person : people) {
    const auto share = choices::accuracy_of(trials_of_class(person.trials, class_index)).share();
    if (share) shares.push_back(*share);
  }
  return shares;
}

void add_class_accuracies(const std::vector<Person>& people, MethodReport& report) {
  for (int i = 0; i < report.confusion.classes(); ++i) {
    const Proportion accuracy = report.confusion.accuracy(i);
    report.accuracy.push_back({accuracy, wilson_interval(accuracy),
                               clopper_pearson_interval(accuracy), jeffreys_interval(accuracy),
                               participant_mean(shares_of_class(people, i))});
  }
}

/// The confusion matrices of participants with a trial.
std::vector<ConfusionMatrix> participant_confusions(int classes,
                                                    const std::vector<Person>& people) {
  std::vector<ConfusionMatrix> confusions;
  for (const Person& person : people) {
    if (!person.trials.empty()) confusions.emplace_back(classes, choices_of(person.trials));
  }
  return confusions;
}

/// The unbiased hit rates of participants, each averaged over the classes from `first` to `last`.
UnbiasedHits unbiased_hits(const std::vector<ConfusionMatrix>& participants, int first, int last) {
  std::vector<double> rates;
  double chance_rate = 0.0;
  for (const ConfusionMatrix& confusion : participants) {
    double rate = 0.0;
    double chance = 0.0;
    int presented = 0;
    for (int i = first; i <= last; ++i) {
      const auto class_rate = unbiased_hit_rate(confusion, i);
      if (!class_rate) continue;
      ++presented;
      rate += *class_rate;
      chance += unbiased_hit_rate_by_chance(confusion, i).value_or(0.0);
    }
    if (presented == 0) continue;
    rates.push_back(rate / presented);
    chance_rate += chance / presented;
  }
  UnbiasedHits hits{participant_mean(rates)};
  if (!rates.empty()) hits.chance_rate = chance_rate / static_cast<double>(rates.size());
  return hits;
}

void add_unbiased_hits(int classes, const std::vector<Person>& people, MethodReport& report) {
  const std::vector<ConfusionMatrix> confusions = participant_confusions(classes, people);
  for (int i = 0; i < classes; ++i) report.unbiased_hits.push_back(unbiased_hits(confusions, i, i));
  report.unbiased_hits.push_back(unbiased_hits(confusions, 0, classes - 1));
}

ParticipantAccuracy participant_accuracy(int classes, const Person& person) {
  const ConfusionMatrix confusion(classes, choices_of(person.trials));
  const LabelMatching matching = best_label_matching(confusion);
  return {person.name, choices::accuracy_of(person.trials), matching,
          raw_information_transfer(confusion), label_swap_p(confusion, matching)};
}

void add_participants(int classes, const std::vector<Person>& people, int method,
                      MethodReport& report) {
  std::vector<double> shares;
  std::vector<Proportion> accuracies;
  for (const Person& person : people) {
    if (person.trials.empty()) continue;
    report.per_participant.push_back(participant_accuracy(classes, person));
    accuracies.push_back(report.per_participant.back().accuracy);
    shares.push_back(accuracies.back().share().value_or(0.0));
  }
  report.mean = participant_mean(shares);
  report.bootstrap = bootstrap_mean(shares, static_cast<std::uint64_t>(method));
  report.spread = spread_of(accuracies);
  if (accuracies.size() < kMinBootstrapParticipants) return;
  const auto pooled = cluster_bootstrap(accuracies, static_cast<std::uint64_t>(method));
  if (pooled && pooled->low < pooled->high) {
    report.d_prime_over_participants = d_prime(report.overall, classes, *pooled);
  }
}

/// Computes the p of the fit from drawn tables; large studies need fewer of them.
void set_drawn_p(ChoiceModel& model, int trials, int method) {
  constexpr int kMaxDrawnTrials = 5'000'000;
  constexpr int kMinDraws = 199;
  constexpr int kMaxDraws = 999;
  if (!model.converged) return;
  model.draws = std::clamp(kMaxDrawnTrials / std::max(1, trials), kMinDraws, kMaxDraws);
  model.drawn_p = choice_model_p(model, model.draws, static_cast<std::uint64_t>(method));
}

InformationTransfer information_of(int classes, const std::vector<Person>& people, int trials,
                                   int method) {
  std::vector<Choices> answers;
  for (const Person& person : people) answers.push_back(choices_of(person.trials));
  // With many trials the null mean varies little, so fewer deals suffice.
  const int deals = std::clamp(kMaxNullTrials / std::max(1, trials), kMinNullDeals, kNullDeals);
  return information_transfer(classes, answers, static_cast<std::uint64_t>(method), deals);
}

/// Calls functions, in parallel if the study is large.
void run_parts(int trials, std::initializer_list<std::function<void()>> parts) {
  constexpr int kMinParallelTrials = 2'000;
  const auto run = [&](std::size_t i) { parts.begin()[i](); };
  if (trials >= kMinParallelTrials) return run_all_in_parallel(parts.size(), run);
  for (std::size_t i = 0; i < parts.size(); ++i) run(i);
}

MethodReport method_report(const Outcomes& outcomes, int method,
                           const std::vector<Person>& people) {
  const auto classes = static_cast<int>(outcomes.classes.size());
  MethodReport report;
  report.method = outcomes.methods[method];
  report.confusion = confusion_of(outcomes, method);
  report.overall = report.confusion.accuracy();
  const int trials = report.overall.n;
  // Parts set different members, and have separate random streams.
  run_parts(trials, {[&] {
                       report.choice = choice_model(report.confusion);
                       if (report.choice) set_drawn_p(*report.choice, trials, method);
                     },
                     [&] { report.order = choices::order_effects_of(outcomes, method); },
                     [&] { report.information = information_of(classes, people, trials, method); },
                     [&] { add_participants(classes, people, method, report); },
                     [&] {
                       MatchCache cache;
                       report.chance = choices::chance_test_of(outcomes, method,
                                                               choices::kMaxChanceDeals, &cache);
                       report.prevalence =
                           choices::prevalence_above_chance(outcomes, method, &cache);
                     },
                     [&] {
                       report.matching = best_label_matching(report.confusion);
                       report.d_prime = d_prime(report.overall, classes);
                       add_class_accuracies(people, report);
                       add_unbiased_hits(classes, people, report);
                       report.reaction_times = choices::reaction_times(outcomes, method);
                       report.breakdowns = choices::breakdowns(outcomes, method);
                       report.accuracy_over_trials = accuracy_over_trials(people);
                       report.confidence = choices::confidence_of(outcomes, method);
                       report.robustness = choices::robustness(outcomes, method);
                     }});
  return report;
}

/// One participant's trials with two methods.
using PairedTrials = std::pair<PersonTrials, PersonTrials>;
using PairedProportions = std::pair<Proportion, Proportion>;

/// The trials of participants with both methods.
std::vector<PairedTrials> paired_trials(const CountedTrials& counted, int first, int second) {
  std::vector<PairedTrials> pairs;
  for (std::size_t i = 0; i < counted[first].size(); ++i) {
    const PersonTrials& a = counted[first][i].trials;
    const PersonTrials& b = counted[second][i].trials;
    if (!a.empty() && !b.empty()) pairs.emplace_back(a, b);
  }
  return pairs;
}

std::vector<PairedTrials> pairs_of_class(const std::vector<PairedTrials>& pairs, int class_index) {
  std::vector<PairedTrials> selected;
  for (const auto& [first, second] : pairs) {
    PairedTrials pair(trials_of_class(first, class_index), trials_of_class(second, class_index));
    if (!pair.first.empty() && !pair.second.empty()) selected.push_back(std::move(pair));
  }
  return selected;
}

std::vector<PairedProportions> proportions_of(const std::vector<PairedTrials>& pairs) {
  std::vector<PairedProportions> proportions;
  for (const auto& [first, second] : pairs) {
    proportions.emplace_back(choices::accuracy_of(first), choices::accuracy_of(second));
  }
  return proportions;
}

MethodComparison method_comparison(const std::vector<PairedProportions>& pairs) {
  std::vector<PairedAccuracy> accuracies;
  for (const auto& [first, second] : pairs) {
    accuracies.push_back({first.share().value_or(0.0), second.share().value_or(0.0)});
  }
  return compare_methods(accuracies);
}

/// McNemar's mid-p; only if every participant has one trial with each method, so that the pairs are
/// independent.
std::optional<double> mcnemar_of(const std::vector<PairedProportions>& pairs) {
  int first_only = 0;
  int second_only = 0;
  for (const auto& [first, second] : pairs) {
    if (first.n != 1 || second.n != 1) return std::nullopt;
    if (first.correct > second.correct) ++first_only;
    if (second.correct > first.correct) ++second_only;
  }
  if (pairs.empty()) return std::nullopt;
  return mcnemar_mid_p(first_only, second_only);
}

Proportion pooled_accuracy(const std::vector<Person>& people, int class_index) {
  Proportion all;
  for (const Person& person : people)
    all += choices::accuracy_of(trials_of_class(person.trials, class_index));
  return all;
}

ClassComparison class_comparison(const CountedTrials& counted, int first, int second,
                                 const std::vector<PairedTrials>& pairs, int class_index) {
  const auto proportions = proportions_of(pairs_of_class(pairs, class_index));
  return {pooled_accuracy(counted[first], class_index),
          pooled_accuracy(counted[second], class_index), method_comparison(proportions),
          mcnemar_of(proportions)};
}

MethodPair method_pair(int classes, const CountedTrials& counted, int first, int second) {
  const std::vector<PairedTrials> pairs = paired_trials(counted, first, second);
  const std::vector<PairedProportions> proportions = proportions_of(pairs);
  MethodPair pair;
  pair.first = first;
  pair.second = second;
  pair.overall = method_comparison(proportions);
  pair.odds_ratio = mantel_haenszel(proportions);
  if (pair.odds_ratio && proportions.size() >= kMinBootstrapParticipants) {
    pair.odds_ratio->bootstrap = odds_ratio_bootstrap(proportions);
  }
  pair.mcnemar_mid_p = mcnemar_of(proportions);
  for (int i = 0; i < classes; ++i) {
    pair.classes.push_back(class_comparison(counted, first, second, pairs, i));
  }
  return pair;
}

/// Adjusts p by Holm, except for pairs without p, because nobody felt both methods.
void adjust_by_holm(std::vector<MethodPair>& pairs) {
  std::vector<MethodPair*> family;
  std::vector<double> p_values;
  for (MethodPair& pair : pairs) {
    if (!pair.overall.p) continue;
    family.push_back(&pair);
    p_values.push_back(*pair.overall.p);
  }
  const std::vector<double> adjusted = holm_adjusted(p_values);
  for (std::size_t i = 0; i < family.size(); ++i) family[i]->p_holm = adjusted[i];
}

/// Adds one participant's occasions with a class. The n-th occasion contains, by method, whether
/// the answer to the n-th presentation of the class was right.
void add_occasions(int class_index, const std::vector<const PersonTrials*>& methods,
                   std::vector<std::vector<bool>>& occasions) {
  std::vector<PersonTrials> selected;
  std::size_t common = methods.front()->size();
  for (const PersonTrials* trials : methods) {
    selected.push_back(trials_of_class(*trials, class_index));
    common = std::min(common, selected.back().size());
  }
  for (std::size_t n = 0; n < common; ++n) {
    std::vector<bool>& occasion = occasions.emplace_back();
    for (const PersonTrials& trials : selected) occasion.push_back(trials[n]->correct());
  }
}

std::vector<std::vector<std::vector<bool>>> occasions_by_participant(int classes,
                                                                     const CountedTrials& counted) {
  std::vector<std::vector<std::vector<bool>>> all;
  for (std::size_t i = 0; i < counted.front().size(); ++i) {
    std::vector<const PersonTrials*> methods;
    for (const auto& people : counted) methods.push_back(&people[i].trials);
    std::vector<std::vector<bool>> occasions;
    for (int c = 0; c < classes; ++c) add_occasions(c, methods, occasions);
    if (!occasions.empty()) all.push_back(std::move(occasions));
  }
  return all;
}

/// Every pair of methods, in the order of methods; p is adjusted for three or more methods.
std::vector<MethodPair> method_pairs(int classes, const CountedTrials& counted) {
  const auto methods = static_cast<int>(counted.size());
  std::vector<MethodPair> pairs;
  for (int first = 0; first < methods; ++first) {
    for (int second = first + 1; second < methods; ++second) {
      pairs.push_back(method_pair(classes, counted, first, second));
    }
  }
  if (methods > 2) adjust_by_holm(pairs);
  return pairs;
}

/// \return nothing if there are fewer than three methods, or no occasion on which they differ
std::optional<AllMethodsTest> all_methods_test(int classes, const CountedTrials& counted) {
  if (counted.size() < 3) return std::nullopt;
  const auto by_participant = occasions_by_participant(classes, counted);
  std::vector<std::vector<bool>> occasions;
  for (const auto& participant_occasions : by_participant) {
    occasions.insert(occasions.end(), participant_occasions.begin(), participant_occasions.end());
  }
  const std::optional<CochranQ> cochran = cochran_q(occasions);
  if (!cochran) return std::nullopt;
  return AllMethodsTest{*cochran, cochran_q_permuted_p(by_participant)};
}

/// Adjusts the p of label swaps over all participants and methods of the study.
void adjust_swaps(std::vector<MethodReport>& methods) {
  std::vector<double> p_values;
  for (const MethodReport& method : methods) {
    for (const ParticipantAccuracy& participant : method.per_participant)
      p_values.push_back(participant.swap_p);
  }
  const std::vector<double> adjusted = benjamini_hochberg_adjusted(p_values);
  auto next = adjusted.begin();
  for (MethodReport& method : methods) {
    for (ParticipantAccuracy& participant : method.per_participant)
      participant.swap_p_adjusted = *next++;
  }
}

/// Sorts participants by name, because public reports must not show the order of sessions.
void order_by_name(StudyReport& report) {
  for (MethodReport& method : report.methods) {
    std::ranges::sort(method.per_participant, {}, &ParticipantAccuracy::participant);
  }
  if (!report.places) return;
  std::ranges::sort(report.places->preferences.people, {}, &choices::Preference::participant);
}

}  // namespace

StudyReport make_report(const Outcomes& outcomes) {
  const auto classes = static_cast<int>(outcomes.classes.size());
  CountedTrials counted;
  StudyReport report;
  static_cast<StudyHead&>(report) = head_of(outcomes);
  for (int i = 0; i < static_cast<int>(outcomes.methods.size()); ++i) {
    counted.push_back(choices::people_with_trials(outcomes, [i](const TrialOutcome& trial) {
      return trial.counted && trial.stimulus.method == i;
    }));
    report.methods.push_back(method_report(outcomes, i, counted.back()));
  }
  adjust_swaps(report.methods);
  report.places = choices::answers_by_place(
      choices::people_with_trials(outcomes,
                                  [](const TrialOutcome& trial) { return trial.counted; }),
      classes);
  if (outcomes.collection.is_public) order_by_name(report);
  report.pairs = method_pairs(classes, counted);
  if (report.methods.size() == 2) report.comparison = report.pairs.front().overall;
  report.all_methods = all_methods_test(classes, counted);
  report.primary = choices::primary_result(outcomes);
  if (report.primary && report.primary->ended_at_look) {
    report.departures = departures_of(outcomes, true);
  }
  if (report.methods.size() == 1) report.prevalence = report.methods.front().prevalence;
  report.warnings = report_warnings(outcomes, report);
  return report;
}

ConfusionMatrix confusion_of(const Outcomes& outcomes, int method) {
  ConfusionMatrix confusion(static_cast<int>(outcomes.classes.size()));
  for (const TrialOutcome& trial : outcomes.trials) {
    if (trial.counted && trial.stimulus.method == method) confusion.add(choice_of(trial));
  }
  return confusion;
}

}  // namespace touchtrial::analysis::identification
