#include "analysis/planning/fit_search.hpp"

#include <algorithm>
#include <array>
#include <cmath>
#include <limits>

namespace touchtrial::planning {
namespace {

constexpr std::array<double, 4> kCoarseNoise{0.1, 0.3, 0.8, 2.0};
constexpr std::array<double, 2> kCoarseLapse{0.02, 0.2};
/// The number of best pairs that are refitted.
constexpr std::size_t kRefittedPairs = 2;

/// A subject and its log likelihood.
struct ScoredSubject {
  simulation::SubjectModel subject;
  double value = 0.0;
};

/// The best of a few combinations of noise and lapse, with the subject's values of everything else.
Optimum best_of_grid(const FitProblem& problem, simulation::SubjectModel subject) {
  Optimum best{{}, -std::numeric_limits<double>::infinity()};
  for (const double feature_noise : kCoarseNoise) {
    for (const double lapse : kCoarseLapse) {
      subject.feature_noise = feature_noise;
      subject.lapse = lapse;
      const std::vector<double> point = problem.numbers_of(subject);
      const double value = problem.value(point, {});
      if (value > best.value) best = {point, value};
    }
  }
  return best;
}

/// Ignores free preferences: all layouts are then equivalent, which makes the grid cheap.
ScoredSubject search_coarsely(const AnswerModel& model, const FitEvidence& evidence,
                              simulation::SubjectModel subject, const FreeParameters& free) {
  const FitProblem problem(model, evidence, subject, free);
  if (free.position) subject.position_bias = 0.0;
  if (free.classes) subject.class_bias.clear();
  const Optimum best = best_of_grid(problem, subject);
  return {problem.subject_at(best.point), best.value};
}

bool is_swapped(const simulation::SubjectModel& subject, const std::string& label) {
  return std::ranges::any_of(subject.label_swap, [&](const auto& pair) {
    return pair.first == label || pair.second == label;
  });
}

std::vector<std::pair<std::string, std::string>> unswapped_pairs(
    const simulation::SubjectModel& subject, const std::vector<std::string>& all) {
  std::vector<std::pair<std::string, std::string>> pairs;
  for (std::size_t i = 0; i < all.size(); ++i) {
    for (std::size_t j = i + 1; j < all.size(); ++j) {
      if (!is_swapped(subject, all[i]) && !is_swapped(subject, all[j])) {
        pairs.emplace_back(all[i], all[j]);
      }
    }
  }
  return pairs;
}

ScoredSubject fit_from(const AnswerModel& model, const FitEvidence& evidence,
                       const simulation::SubjectModel& start, const FreeParameters& free) {
  const FitProblem problem(model, evidence, start, free);
  const Optimum best = best_of_starts(problem, start);
  return {problem.subject_at(best.point), best.value};
}

/// The fit with one more swapped pair.
struct FittedSwap {
  SwapCandidate candidate;
  ScoredSubject fit;
};

std::vector<FittedSwap> best_pairs(const AnswerModel& model, const FitEvidence& evidence,
                                   const ScoredSubject& base_fit, const FreeParameters& free) {
  std::vector<std::pair<ScoredSubject, std::pair<std::string, std::string>>> coarse_fits;
  for (const auto& pair : unswapped_pairs(base_fit.subject, model.classes())) {
    simulation::SubjectModel subject = base_fit.subject;
    subject.label_swap.push_back(pair);
    coarse_fits.emplace_back(search_coarsely(model, evidence, subject, free), pair);
  }
  std::ranges::stable_sort(coarse_fits, std::ranges::greater{},
                           [](const auto& start) { return start.first.value; });
  if (coarse_fits.size() > kRefittedPairs) coarse_fits.resize(kRefittedPairs);
  std::vector<FittedSwap> fitted_swaps;
  for (const auto& [start, pair] : coarse_fits) {
    ScoredSubject fit = fit_from(model, evidence, start.subject, free);
    fitted_swaps.push_back({{pair, fit.value - base_fit.value, false}, std::move(fit)});
  }
  std::ranges::stable_sort(fitted_swaps, std::ranges::greater{},
                           [](const FittedSwap& swap) { return swap.candidate.gain; });
  return fitted_swaps;
}

}  // namespace

Optimum best_of_starts(const FitProblem& problem, const simulation::SubjectModel& subject) {
  const OptimiserOptions coarse{.tolerance = 1e-6, .scales = problem.scales()};
  Optimum best = problem.maximise_from(problem.numbers_of(subject), problem.bounds(), coarse);
  Optimum from_grid =
      problem.maximise_from(best_of_grid(problem, subject).point, problem.bounds(), coarse);
  return from_grid.value > best.value ? from_grid : best;
}

double swap_threshold(int pairs) noexcept {
  constexpr double kTimesLikelier = 20.0;
  return std::log(kTimesLikelier * std::max(1, pairs));
}

SwapSearch search_swaps(const AnswerModel& model, const FitEvidence& evidence,
                        simulation::SubjectModel subject, const FreeParameters& free) {
  SwapSearch search;
  const auto classes = static_cast<int>(model.classes().size());
  search.threshold = swap_threshold(classes * (classes - 1) / 2);
  if (free.swaps) subject.label_swap.clear();
  ScoredSubject best = fit_from(model, evidence, subject, free);
  while (free.swaps) {
    std::vector<FittedSwap> fitted_swaps = best_pairs(model, evidence, best, free);
    const bool is_accepted =
        !fitted_swaps.empty() && fitted_swaps.front().candidate.gain > search.threshold;
    if (is_accepted) {
      fitted_swaps.front().candidate.accepted = true;
      best = std::move(fitted_swaps.front().fit);
    }
    for (const FittedSwap& swap : fitted_swaps) search.candidates.push_back(swap.candidate);
    if (!is_accepted) break;
  }
  search.subject = std::move(best.subject);
  return search;
}

}  // namespace touchtrial::planning
