#include "protocols/identification/analysis/method_pairs.hpp"

#include "analysis/statistics/cluster_bootstrap.hpp"

#include <algorithm>
#include <cstddef>
#include <utility>

namespace touchtrial::analysis::identification {
namespace {

/// One participant's trials with two methods.
using PairedTrials = std::pair<OwnTrials, OwnTrials>;
using PairedProportions = std::pair<Proportion, Proportion>;

/// The trials of the participants who felt both methods.
std::vector<PairedTrials> paired_trials(const CountedTrials& counted, int first, int second) {
  std::vector<PairedTrials> pairs;
  for (std::size_t i = 0; i < counted.participants.size(); ++i) {
    const OwnTrials& a = counted.trials[first][i];
    const OwnTrials& b = counted.trials[second][i];
    if (!a.empty() && !b.empty()) pairs.emplace_back(a, b);
  }
  return pairs;
}

std::vector<PairedTrials> pairs_of_class(const std::vector<PairedTrials>& pairs, int class_index) {
  std::vector<PairedTrials> own;
  for (const auto& [first, second] : pairs) {
    PairedTrials one(of_class(first, class_index), of_class(second, class_index));
    if (!one.first.empty() && !one.second.empty()) own.push_back(std::move(one));
  }
  return own;
}

std::vector<PairedProportions> proportions_of(const std::vector<PairedTrials>& pairs) {
  std::vector<PairedProportions> proportions;
  for (const auto& [first, second] : pairs) {
    proportions.emplace_back(accuracy_of(first), accuracy_of(second));
  }
  return proportions;
}

MethodComparison compared(const std::vector<PairedProportions>& pairs) {
  std::vector<PairedAccuracy> accuracies;
  for (const auto& [first, second] : pairs) {
    accuracies.push_back({first.share().value_or(0.0), second.share().value_or(0.0)});
  }
  return compare_methods(accuracies);
}

/// McNemar's mid-p. Exists only if every participant has one trial with each method, because then
/// the pairs are independent.
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

Proportion pooled(const std::vector<OwnTrials>& by_participant, int class_index) {
  Proportion all;
  for (const OwnTrials& trials : by_participant) {
    const Proportion own = accuracy_of(of_class(trials, class_index));
    all.n += own.n;
    all.correct += own.correct;
  }
  return all;
}

ClassComparison class_comparison(const CountedTrials& counted, int first, int second,
                                 const std::vector<PairedTrials>& pairs, int class_index) {
  const auto proportions = proportions_of(pairs_of_class(pairs, class_index));
  return {pooled(counted.trials[first], class_index), pooled(counted.trials[second], class_index),
          compared(proportions), mcnemar_of(proportions)};
}

MethodPair method_pair(int classes, const CountedTrials& counted, int first, int second) {
  const std::vector<PairedTrials> pairs = paired_trials(counted, first, second);
  const std::vector<PairedProportions> proportions = proportions_of(pairs);
  MethodPair pair;
  pair.first = first;
  pair.second = second;
  pair.overall = compared(proportions);
  pair.odds_ratio = mantel_haenszel(proportions);
  if (pair.odds_ratio && proportions.size() >= kFewestForBootstrap) {
    pair.odds_ratio->bootstrap = odds_ratio_bootstrap(proportions);
  }
  pair.mcnemar_mid_p = mcnemar_of(proportions);
  for (int i = 0; i < classes; ++i) {
    pair.classes.push_back(class_comparison(counted, first, second, pairs, i));
  }
  return pair;
}

/// Adjusts the p values by Holm. A pair has no p if nobody felt both methods; such pairs are left
/// out.
void adjust(std::vector<MethodPair>& pairs) {
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

/// Adds one participant's occasions with a class. The n-th occasion is the n-th presentation of the
/// class with every method; it says whether each of these answers was right.
void add_occasions(int class_index, const std::vector<const OwnTrials*>& methods,
                   std::vector<std::vector<bool>>& occasions) {
  std::vector<OwnTrials> own;
  std::size_t common = methods.front()->size();
  for (const OwnTrials* trials : methods) {
    own.push_back(of_class(*trials, class_index));
    common = std::min(common, own.back().size());
  }
  for (std::size_t n = 0; n < common; ++n) {
    std::vector<bool>& occasion = occasions.emplace_back();
    for (const OwnTrials& trials : own) occasion.push_back(trials[n]->correct());
  }
}

std::vector<std::vector<std::vector<bool>>> occasions_by_participant(int classes,
                                                                     const CountedTrials& counted) {
  std::vector<std::vector<std::vector<bool>>> all;
  for (std::size_t i = 0; i < counted.participants.size(); ++i) {
    std::vector<const OwnTrials*> methods;
    for (const auto& by_participant : counted.trials) methods.push_back(&by_participant[i]);
    std::vector<std::vector<bool>> own;
    for (int c = 0; c < classes; ++c) add_occasions(c, methods, own);
    if (!own.empty()) all.push_back(std::move(own));
  }
  return all;
}

}  // namespace

std::vector<MethodPair> method_pairs(int classes, const CountedTrials& counted) {
  const auto methods = static_cast<int>(counted.trials.size());
  std::vector<MethodPair> pairs;
  for (int first = 0; first < methods; ++first) {
    for (int second = first + 1; second < methods; ++second) {
      pairs.push_back(method_pair(classes, counted, first, second));
    }
  }
  if (methods > 2) adjust(pairs);
  return pairs;
}

std::optional<MethodsTogether> methods_together(int classes, const CountedTrials& counted) {
  if (counted.trials.size() < 3) return std::nullopt;
  const auto by_participant = occasions_by_participant(classes, counted);
  std::vector<std::vector<bool>> occasions;
  for (const auto& own : by_participant) occasions.insert(occasions.end(), own.begin(), own.end());
  const std::optional<CochranQ> cochran = cochran_q(occasions);
  if (!cochran) return std::nullopt;
  return MethodsTogether{*cochran, cochran_q_permuted_p(by_participant)};
}

}  // namespace touchtrial::analysis::identification
