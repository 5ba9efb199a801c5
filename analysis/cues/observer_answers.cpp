#include "analysis/cues/observer_answers.hpp"

#include "analysis/cues/jobs.hpp"

#include <algorithm>
#include <stdexcept>

namespace touchtrial::analysis {
namespace {

constexpr std::size_t kMostForNoise = 2000;
/// Features are logarithms: e^4 is far more than any two textures differ by.
constexpr double kMostNoise = 4.0;
constexpr int kHalvings = 12;

/// Places of trials by which the noise is found: judged, with a response, evenly chosen.
std::vector<std::size_t> places_for_noise(const std::vector<AnswerShares>& ideal,
                                          std::span<const std::optional<int>> responses) {
  std::vector<std::size_t> all;
  for (std::size_t i = 0; i < ideal.size(); ++i) {
    if (!ideal[i].empty() && responses[i]) all.push_back(i);
  }
  if (all.size() <= kMostForNoise) return all;
  std::vector<std::size_t> some;
  for (std::size_t i = 0; i < kMostForNoise; ++i) {
    some.push_back(all[i * all.size() / kMostForNoise]);
  }
  return some;
}

double share_of_right(const std::vector<AnswerShares>& answers,
                      std::span<const ObservedTrial> trials,
                      const std::vector<std::size_t>& places) {
  double right = 0.0;
  for (std::size_t i = 0; i < places.size(); ++i) {
    right += answers[i][trials[places[i]].class_index];
  }
  return right / static_cast<double>(places.size());
}

/// In the order of `places`. No noise: the ideal answers.
std::vector<AnswerShares> answers_at(const Observer& observer,
                                     const std::vector<std::size_t>& places, double noise,
                                     int jobs) {
  std::vector<AnswerShares> answers(places.size());
  in_parallel(jobs, places.size(), [&](std::size_t i) {
    answers[i] =
        noise > 0.0 ? observer.noisy_answer(places[i], noise) : observer.ideal_answer(places[i]);
  });
  return answers;
}

double matching_noise(const Observer& observer, std::span<const ObservedTrial> trials,
                      std::span<const std::optional<int>> responses,
                      const std::vector<std::size_t>& places, int jobs) {
  if (places.empty()) return 0.0;
  const auto right = std::ranges::count_if(
      places, [&](std::size_t i) { return responses[i] == trials[i].class_index; });
  const double wanted = static_cast<double>(right) / static_cast<double>(places.size());
  const auto share_with = [&](double noise) {
    return share_of_right(answers_at(observer, places, noise, jobs), trials, places);
  };
  if (share_with(0.0) <= wanted) return 0.0;
  double low = 0.0;
  double high = kMostNoise;
  for (int i = 0; i < kHalvings; ++i) {
    const double middle = 0.5 * (low + high);
    (share_with(middle) > wanted ? low : high) = middle;
  }
  return high;
}

}  // namespace

ObserverAnswers observer_answers(Cue cue, std::span<const ObservedTrial> trials,
                                 std::span<const std::optional<int>> responses, int classes,
                                 int jobs) {
  if (responses.size() != trials.size()) {
    throw std::invalid_argument("observer_answers: every trial needs a response or none");
  }
  const Observer observer(cue, trials, classes);
  std::vector<std::size_t> all(trials.size());
  for (std::size_t i = 0; i < all.size(); ++i) all[i] = i;
  ObserverAnswers answers;
  answers.ideal = answers_at(observer, all, 0.0, jobs);
  answers.matched_noise =
      matching_noise(observer, trials, responses, places_for_noise(answers.ideal, responses), jobs);
  answers.matched = answers.matched_noise > 0.0
                        ? answers_at(observer, all, answers.matched_noise, jobs)
                        : answers.ideal;
  return answers;
}

}  // namespace touchtrial::analysis
