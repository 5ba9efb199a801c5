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

/// Log likelihoods that differ by less than this are equal, so that rounding never decides an
/// answer.
constexpr double kTie = 1e-9;

/// The logarithm of the intensity of five bands together.
double whole(const engine::FeltFeatures& felt, int first_band) {
  double power = 0.0;
  for (int band = 0; band < engine::kFeltBands; ++band)
    power += std::exp(2.0 * felt[first_band + band]);
  return 0.5 * std::log(power);
}

void append_shape(std::vector<double>& features, const engine::FeltFeatures& felt, int first_band) {
  const double level = whole(felt, first_band);
  for (int band = 0; band < engine::kFeltBands; ++band) {
    features.push_back(felt[first_band + band] - level);
  }
}

AnswerShares shares_of(const std::vector<double>& support) {
  const double most = *std::ranges::max_element(support);
  AnswerShares shares(support.size(), 0.0);
  const auto ties = std::ranges::count_if(support, [&](double s) { return s >= most - kTie; });
  for (std::size_t i = 0; i < support.size(); ++i) {
    if (support[i] >= most - kTie) shares[i] = 1.0 / static_cast<double>(ties);
  }
  return shares;
}

void check(std::span<const ObservedTrial> trials, int classes) {
  if (classes < 1) throw std::invalid_argument("Observer: there must be at least one class");
  for (const ObservedTrial& trial : trials) {
    if (trial.class_index < 0 || trial.class_index >= classes || trial.exemplar < 0) {
      throw std::invalid_argument("Observer: a trial's class or exemplar is out of range");
    }
  }
}

constexpr std::size_t kMaxForNoise = 2000;
/// The upper bound of the search for the noise. Features are logarithms, and a factor of e^4 is far
/// more than the difference between any two textures.
constexpr double kMaxNoise = 4.0;
constexpr int kHalvings = 12;

/// The places of the trials that determine the noise: judged, with a response, and evenly chosen.
std::vector<std::size_t> places_for_noise(const std::vector<AnswerShares>& ideal,
                                          std::span<const std::optional<int>> responses) {
  std::vector<std::size_t> all;
  for (std::size_t i = 0; i < ideal.size(); ++i) {
    if (!ideal[i].empty() && responses[i]) all.push_back(i);
  }
  if (all.size() <= kMaxForNoise) return all;
  std::vector<std::size_t> some;
  for (std::size_t i = 0; i < kMaxForNoise; ++i) {
    some.push_back(all[i * all.size() / kMaxForNoise]);
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
  const double wanted = static_cast<double>(right) / static_cast<double>(places.size());
  const auto share_with = [&](double noise) {
    return share_of_right(answers_at(observer, places, noise, jobs), trials, places);
  };
  const double without_noise = share_with(0.0);
  if (without_noise <= wanted) return {0.0, without_noise, wanted};
  double low = 0.0;
  double high = kMaxNoise;
  for (int i = 0; i < kHalvings; ++i) {
    const double middle = 0.5 * (low + high);
    (share_with(middle) > wanted ? low : high) = middle;
  }
  return {high, share_with(high), wanted};
}

}  // namespace

Observer::Observer(Cue cue, std::span<const ObservedTrial> trials, int classes) {
  check(trials, classes);
  trials_of_class_.assign(static_cast<std::size_t>(classes), 0);
  std::map<std::pair<int, int>, int> label_of;
  for (const ObservedTrial& trial : trials) {
    const auto [known, is_new] = label_of.try_emplace({trial.class_index, trial.exemplar},
                                                      static_cast<int>(class_of_label_.size()));
    if (is_new) class_of_label_.push_back(trial.class_index);
    label_.push_back(known->second);
    features_.push_back(cue_features(cue, trial.felt));
    ++trials_of_class_[trial.class_index];
  }
  if (trials.empty()) return;
  statistics_.emplace(static_cast<int>(class_of_label_.size()), features_.front().size());
  for (std::size_t i = 0; i < label_.size(); ++i) statistics_->learn(label_[i], features_[i]);
}

engine::FeltClassifier Observer::without(std::size_t trial, double noise) const {
  engine::FeltStatistics others = *statistics_;
  others.forget(label_[trial], features_[trial]);
  return {others, noise};
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
  return answer(without(trial, 0.0), features_[trial]);
}

AnswerShares Observer::noisy_answer(std::size_t trial, double noise) const {
  if (!can_judge(trial)) return {};
  const engine::FeltClassifier classifier = without(trial, noise);
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
  if (cue == Cue::rms) return {whole(felt, engine::kLateralBandsAt)};
  std::vector<double> shape;
  append_shape(shape, felt, engine::kLateralBandsAt);
  append_shape(shape, felt, engine::kNormalBandsAt);
  return shape;
}

ObserverAnswers observer_answers(Cue cue, std::span<const ObservedTrial> trials,
                                 std::span<const std::optional<int>> responses, int classes,
                                 int jobs) {
  if (responses.size() != trials.size()) {
    throw std::invalid_argument("observer_answers: every trial needs a response, or an empty one");
  }
  const Observer observer(cue, trials, classes);
  std::vector<std::size_t> all(trials.size());
  for (std::size_t i = 0; i < all.size(); ++i) all[i] = i;
  ObserverAnswers answers;
  answers.ideal = answers_at(observer, all, 0.0, jobs);
  static_cast<MatchingNoise&>(answers) =
      matching_noise(observer, trials, responses, places_for_noise(answers.ideal, responses), jobs);
  answers.matched = answers.matched_noise > 0.0
                        ? answers_at(observer, all, answers.matched_noise, jobs)
                        : answers.ideal;
  return answers;
}

}  // namespace touchtrial::analysis::identification
