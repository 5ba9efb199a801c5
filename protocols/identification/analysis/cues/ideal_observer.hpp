/// \file Ideal observers: make optimal use of one cue in the felt features, without noise or with
/// noise that matches the participants' accuracy. Source: docs/statistics.md.
#pragma once

#include "engine/perception/felt_classifier.hpp"
#include "engine/perception/felt_features.hpp"
#include "protocols/identification/analysis/cues/cue_report.hpp"

#include <cstddef>
#include <optional>
#include <span>
#include <vector>

namespace touchtrial::analysis::identification {

struct ObservedTrial {
  int class_index = 0;
  int exemplar = 0;
  engine::FeltFeatures felt{};
};

/// The features that an observer may use. `rms`: the logarithm of the lateral force's intensity
/// over all five bands. `spectrum`: the five lateral and the five normal bands, each relative to
/// all five bands of its direction, so that the strength of the force has no effect. `everything`:
/// all features.
[[nodiscard]] std::vector<double> cue_features(Cue cue, const engine::FeltFeatures& felt);

/// The share of each class in an observer's answer; the sum is 1. Empty if the trial cannot be
/// judged.
using AnswerShares = std::vector<double>;

/// The number of draws of noise over which noisy_answer() averages.
inline constexpr int kNoisyPercepts = 32;

/// Judges every trial from all other trials. Each stimulus (class and exemplar) has the mean of the
/// other trials' features; all stimuli share one covariance. The answer is the class of the
/// likeliest stimulus; ties (within 1e-9 in logarithm) are split evenly. The only trial of an
/// exemplar is judged from the other exemplars of its class. The only trial of a class is not
/// judged. Thread-safe after construction.
class Observer {
 public:
  /// \param classes  number of classes, >= 1
  /// \throws std::invalid_argument if a class or exemplar is out of range, or a feature not finite
  Observer(Cue cue, std::span<const ObservedTrial> trials, int classes);

  /// Cost: about 10 us with 23 features and 5 stimuli.
  [[nodiscard]] AnswerShares ideal_answer(std::size_t trial) const;

  /// The mean answer over kNoisyPercepts draws of noise, which is added to every feature. The
  /// observer knows the size of the noise, as simulated participants do. Each trial has separate
  /// draws, which are scaled by the noise. Cost: about 50 us.
  /// \param noise  standard deviation, > 0
  [[nodiscard]] AnswerShares noisy_answer(std::size_t trial, double noise) const;

 private:
  /// Whether another trial has this trial's class.
  [[nodiscard]] bool can_judge(std::size_t trial) const {
    return trials_of_class_[class_of_label_[label_[trial]]] >= 2;
  }
  [[nodiscard]] engine::FeltClassifier classifier_without(std::size_t trial, double noise) const;
  /// The class of the stimulus that most likely caused a percept.
  [[nodiscard]] AnswerShares answer(const engine::FeltClassifier& classifier,
                                    std::span<const double> percept) const;

  // The training data of the classifier, with stimuli as labels.
  std::vector<int> label_;                     ///< by trial
  std::vector<std::vector<double>> features_;  ///< by trial
  std::vector<int> class_of_label_;
  std::vector<int> trials_of_class_;
  std::optional<engine::FeltStatistics> statistics_;  ///< of all trials; nothing without trials
};

/// One observer's answers by trial. The shares are empty where a trial cannot be judged.
struct ObserverAnswers : MatchingNoise {
  std::vector<AnswerShares> ideal;
  std::vector<AnswerShares> matched;  ///< answers with matching noise
};

/// The answers of an ideal observer, and of one with the noise that makes it as accurate as the
/// participants. Bisection finds the noise to 1e-3, from up to 2,000 evenly chosen trials with a
/// response.
/// \param responses  by trial; nothing: no response
/// \param jobs  threads; 0: one for each core. The result does not depend on it.
/// \throws std::invalid_argument as Observer, or if the numbers of responses and trials differ
[[nodiscard]] ObserverAnswers observer_answers(Cue cue, std::span<const ObservedTrial> trials,
                                               std::span<const std::optional<int>> responses,
                                               int classes, int jobs = 0);

}  // namespace touchtrial::analysis::identification
