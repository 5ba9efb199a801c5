#include "analysis/planning/fit_search.hpp"

#include <algorithm>
#include <array>
#include <cmath>
#include <limits>

namespace touchtrial::planning {
namespace {

constexpr std::array<double, 4> kCoarseNoise{0.1, 0.3, 0.8, 2.0};
constexpr std::array<double, 2> kCoarseLapse{0.02, 0.2};
/// How many of the best pairs are fitted.
constexpr std::size_t kFitted = 2;

/// A fitted or tried subject, and its log likelihood.
struct Start {
  simulation::SubjectModel subject;
  double value = 0.0;
};

/// The best of a few combinations of noise and lapse, everything else being the subject's.
Optimum best_of_grid(const FitProblem& problem, simulation::SubjectModel subject) {
  Optimum best{{}, -std::numeric_limits<double>::infinity()};
  for (const double feature_noise : kCoarseNoise) {
    for (const double lapse : kCoarseLapse) {
      subject.feature_noise = feature_noise;
      subject.lapse = lapse;
      const std::vector<double> at = problem.numbers_of(subject);
      const double value = problem.value(at, {});
      if (value > best.value) best = {at, value};
    }
  }
  return best;
}

/// Ignores free preferences: all layouts are then equivalent, which makes the grid cheap.
Start search_coarsely(const AnswerModel& model, const FitEvidence& evidence,
                      simulation::SubjectModel subject, const FreeParameters& free) {
  const FitProblem problem(model, evidence, subject, free);
  if (free.position) subject.position_bias = 0.0;
  if (free.classes) subject.class_bias.clear();
  const Optimum best = best_of_grid(problem, subject);
  return {problem.subject_at(best.at), best.value};
}

bool is_swapped(const simulation::SubjectModel& subject, const std::string& label) {
  return std::ranges::any_of(subject.label_swap, [&](const auto& pair) {
    return pair.first == label || pair.second == label;
  });
}

std::vector<std::pair<std::string, std::string>> pairs_left(const simulation::SubjectModel& subject,
                                                            const std::vector<std::string>& all) {
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

Start fitted(const AnswerModel& model, const FitEvidence& evidence,
             const simulation::SubjectModel& start, const FreeParameters& free) {
  const FitProblem problem(model, evidence, start, free);
  const Optimum best = best_of_starts(problem, start);
  return {problem.subject_at(best.at), best.value};
}

/// A swap of one more pair, fitted.
struct TriedSwap {
  SwapCandidate candidate;
  Start fit;
};

std::vector<TriedSwap> best_pairs(const AnswerModel& model, const FitEvidence& evidence,
                                  const Start& without, const FreeParameters& free) {
  std::vector<std::pair<Start, std::pair<std::string, std::string>>> looks;
  for (const auto& pair : pairs_left(without.subject, model.classes())) {
    simulation::SubjectModel subject = without.subject;
    subject.label_swap.push_back(pair);
    looks.emplace_back(search_coarsely(model, evidence, subject, free), pair);
  }
  std::ranges::stable_sort(looks, std::ranges::greater{},
                           [](const auto& look) { return look.first.value; });
  if (looks.size() > kFitted) looks.resize(kFitted);
  std::vector<TriedSwap> tried;
  for (const auto& [look, pair] : looks) {
    Start fit = fitted(model, evidence, look.subject, free);
    tried.push_back({{pair, fit.value - without.value, false}, std::move(fit)});
  }
  std::ranges::stable_sort(tried, std::ranges::greater{},
                           [](const TriedSwap& one) { return one.candidate.gain; });
  return tried;
}

}  // namespace

Optimum best_of_starts(const FitProblem& problem, const simulation::SubjectModel& subject) {
  const OptimiserOptions coarse{.tolerance = 1e-6, .scales = problem.scales()};
  Optimum best = problem.maximised(problem.numbers_of(subject), problem.bounds(), coarse);
  Optimum from_grid =
      problem.maximised(best_of_grid(problem, subject).at, problem.bounds(), coarse);
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
  Start now = fitted(model, evidence, subject, free);
  while (free.swaps) {
    std::vector<TriedSwap> tried = best_pairs(model, evidence, now, free);
    const bool take = !tried.empty() && tried.front().candidate.gain > search.threshold;
    if (take) {
      tried.front().candidate.taken = true;
      now = std::move(tried.front().fit);
    }
    for (const TriedSwap& one : tried) search.candidates.push_back(one.candidate);
    if (!take) break;
  }
  search.subject = std::move(now.subject);
  return search;
}

}  // namespace touchtrial::planning
