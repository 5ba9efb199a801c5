#include "protocols/identification/analysis/cues/ideal_observer.hpp"

#include "core/parallel.hpp"
#include "core/random.hpp"

#include <algorithm>
#include <cmath>
#include <limits>
#include <map>
#include <stdexcept>
#include <utility>

namespace touchtrial::analysis::identification {
namespace {

/// Log likelihoods that differ by less than this are tied, so that rounding never decides an
/// answer.
constexpr double kTie = 1e-9;

/// The logarithm of the intensity over five bands.
double total_level(const engine::FeltFeatures& felt, int first_band) {
  double power = 0.0;
  for (int band = 0; band < engine::kFeltBands; ++band)
    power += std::exp(2.0 * felt[first_band + band]);
  return 0.5 * std::log(power);
}

void append_shape(std::vector<double>& features, const engine::FeltFeatures& felt, int first_band) {
  const double level = total_level(felt, first_band);
  for (int band = 0; band < engine::kFeltBands; ++band) {
    features.push_back(felt[first_band + band] - level);
  }
}

AnswerShares shares_of(const std::vector<double>& support) {
  const double best = *std::ranges::max_element(support);
  AnswerShares shares(support.size(), 0.0);
  const auto ties = std::ranges::count_if(support, [&](double s) { return s >= best - kTie; });
  for (std::size_t i = 0; i < support.size(); ++i) {
    if (support[i] >= best - kTie) shares[i] = 1.0 / static_cast<double>(ties);
  }
  return shares;
}

void check_trials(std::span<const ObservedTrial> trials, int classes) {
  if (classes < 1) throw std::invalid_argument("Observer: needs at least one class");
  for (const ObservedTrial& trial : trials) {
    if (trial.class_index < 0 || trial.class_index >= classes || trial.exemplar < 0) {
      throw std::invalid_argument("Observer: a trial's class or exemplar is out of range");
    }
  }
}

constexpr std::size_t kMaxNoiseTrials = 2000;
/// Features are logarithms; a factor of e^4 exceeds the difference between any two textures.
constexpr double kMaxNoise = 4.0;
constexpr int kHalvings = 12;

/// The trials that determine the noise: judged, with a response, and evenly chosen.
std::vector<std::size_t> noise_trials(const std::vector<AnswerShares>& ideal,
                                      std::span<const std::optional<int>> responses) {
  std::vector<std::size_t> all;
  for (std::size_t i = 0; i < ideal.size(); ++i) {
    if (!ideal[i].empty() && responses[i]) all.push_back(i);
  }
  if (all.size() <= kMaxNoiseTrials) return all;
  std::vector<std::size_t> selected;
  for (std::size_t i = 0; i < kMaxNoiseTrials; ++i) {
    selected.push_back(all[i * all.size() / kMaxNoiseTrials]);
  }
  return selected;
}

double accuracy_at(const std::vector<AnswerShares>& answers, std::span<const ObservedTrial> trials,
                   const std::vector<std::size_t>& places) {
  double right = 0.0;
  for (std::size_t i = 0; i < places.size(); ++i) {
    right += answers[i][trials[places[i]].class_index];
  }
  return right / static_cast<double>(places.size());
}

/// The answers in the order of `places`. Without noise they are the ideal answers.
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

MatchingNoise matching_noise(const Observer& observer, std::span<const ObservedTrial> trials,
                             std::span<const std::optional<int>> responses,
                             const std::vector<std::size_t>& places, int jobs) {
  if (places.empty()) return {};
  const auto right = std::ranges::count_if(
      places, [&](std::size_t i) { return responses[i] == trials[i].class_index; });
  const double target = static_cast<double>(right) / static_cast<double>(places.size());
  const auto accuracy_with = [&](double noise) {
    return accuracy_at(answers_at(observer, places, noise, jobs), trials, places);
  };
  const double ideal_accuracy = accuracy_with(0.0);
  if (ideal_accuracy <= target) return {0.0, ideal_accuracy, target};
  double low = 0.0;
  double high = kMaxNoise;
  for (int i = 0; i < kHalvings; ++i) {
    const double middle = 0.5 * (low + high);
    (accuracy_with(middle) > target ? low : high) = middle;
  }
  return {high, accuracy_with(high), target};
}

}  // namespace

Observer::Observer(Cue cue, std::span<const ObservedTrial> trials, int classes) {
  check_trials(trials, classes);
  trials_of_class_.assign(static_cast<std::size_t>(classes), 0);
  std::map<std::pair<int, int>, int> label_of;
  for (const ObservedTrial& trial : trials) {
    const auto [label, is_new] = label_of.try_emplace({trial.class_index, trial.exemplar},
                                                      static_cast<int>(class_of_label_.size()));
    if (is_new) class_of_label_.push_back(trial.class_index);
    label_.push_back(label->second);
    features_.push_back(cue_features(cue, trial.felt));
    ++trials_of_class_[trial.class_index];
  }
  if (trials.empty()) return;
  statistics_.emplace(static_cast<int>(class_of_label_.size()), features_.front().size());
  for (std::size_t i = 0; i < label_.size(); ++i) statistics_->learn(label_[i], features_[i]);
}

engine::FeltClassifier Observer::classifier_without(std::size_t trial, double noise) const {
  engine::FeltStatistics other_trials = *statistics_;
  other_trials.forget(label_[trial], features_[trial]);
  return {other_trials, noise};
}

AnswerShares Observer::answer(const engine::FeltClassifier& classifier,
                              std::span<const double> percept) const {
  const std::vector<double> logs = classifier.log_likelihoods(percept);
  std::vector<double> support(trials_of_class_.size(), -std::numeric_limits<double>::infinity());
  for (std::size_t i = 0; i < logs.size(); ++i) {
    double& best = support[class_of_label_[i]];
    best = std::max(best, logs[i]);
  }
  return shares_of(support);
}

AnswerShares Observer::ideal_answer(std::size_t trial) const {
  if (!can_judge(trial)) return {};
  return answer(classifier_without(trial, 0.0), features_[trial]);
}

AnswerShares Observer::noisy_answer(std::size_t trial, double noise) const {
  if (!can_judge(trial)) return {};
  const engine::FeltClassifier classifier = classifier_without(trial, noise);
  RandomStream random(0, "cues: noise of the sense", trial);
  AnswerShares mean(trials_of_class_.size(), 0.0);
  for (int draw = 0; draw < kNoisyPercepts; ++draw) {
    std::vector<double> percept = features_[trial];
    for (double& feature : percept) feature += noise * random.normal();
    const AnswerShares shares = answer(classifier, percept);
    for (std::size_t i = 0; i < mean.size(); ++i) mean[i] += shares[i] / kNoisyPercepts;
  }
  return mean;
}

std::vector<double> cue_features(Cue cue, const engine::FeltFeatures& felt) {
  if (cue == Cue::everything) return {felt.begin(), felt.end()};
  if (cue == Cue::rms) return {total_level(felt, engine::kLateralBandsAt)};
  std::vector<double> shape;
  append_shape(shape, felt, engine::kLateralBandsAt);
  append_shape(shape, felt, engine::kNormalBandsAt);
  return shape;
}

ObserverAnswers observer_answers(Cue cue, std::span<const ObservedTrial> trials,
                                 std::span<const std::optional<int>> responses, int classes,
                                 int jobs) {
  if (responses.size() != trials.size()) {
    throw std::invalid_argument(
        "observer_answers: needs a response, possibly empty, for every trial");
  }
  const Observer observer(cue, trials, classes);
  std::vector<std::size_t> all(trials.size());
  for (std::size_t i = 0; i < all.size(); ++i) all[i] = i;
  ObserverAnswers answers;
  answers.ideal = answers_at(observer, all, 0.0, jobs);
  static_cast<MatchingNoise&>(answers) =
      matching_noise(observer, trials, responses, noise_trials(answers.ideal, responses), jobs);
  answers.matched = answers.matched_noise > 0.0
                        ? answers_at(observer, all, answers.matched_noise, jobs)
                        : answers.ideal;
  return answers;
}

}  // namespace touchtrial::analysis::identification
