#include "analysis/cues/ideal_observer.hpp"

#include "core/random.hpp"
#include "engine/perception/felt_classifier.hpp"

#include <algorithm>
#include <cmath>
#include <limits>
#include <map>
#include <optional>
#include <stdexcept>
#include <utility>

namespace touchtrial::analysis {
namespace {

/// Log likelihoods nearer than this are equal: no compiler's rounding decides an answer.
constexpr double kTie = 1e-9;

/// Logarithm of the intensity of five bands together.
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
  if (classes < 1) throw std::invalid_argument("Observer: there must be a class");
  for (const ObservedTrial& trial : trials) {
    if (trial.class_index < 0 || trial.class_index >= classes || trial.exemplar < 0) {
      throw std::invalid_argument("Observer: a trial's class or exemplar is out of range");
    }
  }
}

}  // namespace

/// Trials as a classifier learns them: stimuli are its labels.
struct Observer::Lessons {
  Lessons(Cue cue, std::span<const ObservedTrial> trials, int classes);

  /// Whether another trial tells what this one's class feels like.
  [[nodiscard]] bool can_judge(std::size_t trial) const {
    return trials_of_class[class_of_label[label[trial]]] >= 2;
  }
  [[nodiscard]] engine::FeltClassifier without(std::size_t trial, double noise) const;
  /// The class of the stimulus that a percept is likeliest of.
  [[nodiscard]] AnswerShares answer(const engine::FeltClassifier& classifier,
                                    std::span<const double> percept) const;

  std::vector<int> label;                     ///< by trial
  std::vector<std::vector<double>> features;  ///< by trial
  std::vector<int> class_of_label;
  std::vector<int> trials_of_class;
  std::optional<engine::FeltStatistics> statistics;  ///< of all trials; nothing without any
};

Observer::Lessons::Lessons(Cue cue, std::span<const ObservedTrial> trials, int classes)
    : trials_of_class(static_cast<std::size_t>(classes), 0) {
  std::map<std::pair<int, int>, int> label_of;
  for (const ObservedTrial& trial : trials) {
    const auto [known, is_new] = label_of.try_emplace({trial.class_index, trial.exemplar},
                                                      static_cast<int>(class_of_label.size()));
    if (is_new) class_of_label.push_back(trial.class_index);
    label.push_back(known->second);
    features.push_back(cue_features(cue, trial.felt));
    ++trials_of_class[trial.class_index];
  }
  if (trials.empty()) return;
  statistics.emplace(static_cast<int>(class_of_label.size()), features.front().size());
  for (std::size_t i = 0; i < label.size(); ++i) statistics->learn(label[i], features[i]);
}

engine::FeltClassifier Observer::Lessons::without(std::size_t trial, double noise) const {
  engine::FeltStatistics others = *statistics;
  others.forget(label[trial], features[trial]);
  return {others, noise};
}

AnswerShares Observer::Lessons::answer(const engine::FeltClassifier& classifier,
                                       std::span<const double> percept) const {
  const std::vector<double> logs = classifier.log_likelihoods(percept);
  std::vector<double> support(trials_of_class.size(), -std::numeric_limits<double>::infinity());
  for (std::size_t i = 0; i < logs.size(); ++i) {
    double& best = support[class_of_label[i]];
    best = std::max(best, logs[i]);
  }
  return shares_of(support);
}

Observer::Observer(Cue cue, std::span<const ObservedTrial> trials, int classes) {
  check(trials, classes);
  lessons_ = std::make_unique<const Lessons>(cue, trials, classes);
}

Observer::~Observer() = default;
Observer::Observer(Observer&&) noexcept = default;
Observer& Observer::operator=(Observer&&) noexcept = default;

std::size_t Observer::trials() const noexcept {
  return lessons_->label.size();
}

AnswerShares Observer::ideal_answer(std::size_t trial) const {
  if (!lessons_->can_judge(trial)) return {};
  return lessons_->answer(lessons_->without(trial, 0.0), lessons_->features[trial]);
}

AnswerShares Observer::noisy_answer(std::size_t trial, double noise) const {
  if (!lessons_->can_judge(trial)) return {};
  const engine::FeltClassifier classifier = lessons_->without(trial, noise);
  RandomStream random(0, "cues: noise of the sense", trial);
  AnswerShares mean(lessons_->trials_of_class.size(), 0.0);
  for (int draw = 0; draw < kNoisyPercepts; ++draw) {
    std::vector<double> percept = lessons_->features[trial];
    for (double& feature : percept) feature += noise * random.normal();
    const AnswerShares shares = lessons_->answer(classifier, percept);
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

}  // namespace touchtrial::analysis
