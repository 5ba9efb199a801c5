#include "analysis/report/primary_figures.hpp"

#include "analysis/report/chance_of_study.hpp"
#include "analysis/report/counted_trials.hpp"
#include "analysis/report/method_pairs.hpp"
#include "analysis/statistics/rounding_noise.hpp"
#include "analysis/statistics/sign_flip.hpp"

#include <vector>

namespace touchtrial::analysis {

ChanceFigures chance_figures(const Outcomes& outcomes, int method, int most_deals) {
  const CountedTrials counted = counted_by_method(outcomes);
  std::vector<double> shares;
  for (const OwnTrials& trials : counted.trials[method]) {
    if (!trials.empty()) shares.push_back(accuracy_of(trials).share().value_or(0.0));
  }
  return {participant_mean(shares), chance_of(outcomes, method, most_deals)};
}

PairFigures pair_figures(const Outcomes& outcomes, int first, int second, bool with_attainable) {
  std::vector<PairedAccuracy> accuracies;
  std::vector<double> differences;
  for (const auto& [a, b] : paired_proportions(counted_by_method(outcomes), first, second)) {
    accuracies.push_back({a.share().value_or(0.0), b.share().value_or(0.0)});
    differences.push_back(without_noise(accuracies.back().first - accuracies.back().second));
  }
  PairFigures figures;
  figures.overall = compare_methods(accuracies, 0, 1);
  figures.overall.bootstrap.reset();
  if (with_attainable) {
    figures.attainable = sign_flip_attainable(differences, kSignificanceLevel);
  }
  return figures;
}

}  // namespace touchtrial::analysis
