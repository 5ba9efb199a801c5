/// \file Ideal observers: they feel what a hand felt, use a part of it as well as possible, and
/// answer, either with certainty or as uncertain as the participants were. Source: docs/cues.md.
#pragma once

#include "engine/perception/felt_features.hpp"
#include "protocols/identification/analysis/cues/cue_report.hpp"

#include <cstddef>
#include <memory>
#include <optional>
#include <span>
#include <vector>

namespace touchtrial::analysis::identification {

/// A trial as an observer meets it.
struct ObservedTrial {
  int class_index = 0;
  int exemplar = 0;
  engine::FeltFeatures felt{};
};

/// What an observer may use. `rms`: the logarithm of the lateral force's intensity in all five
/// bands together. `spectrum`: the five lateral and the five normal bands, each relative to all
/// five of its kind; a stronger force, which adds a constant to all features, changes nothing.
/// `everything`: the features as they are.
[[nodiscard]] std::vector<double> cue_features(Cue cue, const engine::FeltFeatures& felt);

/// The share of each class in an observer's answer; sums to 1; empty if the trial cannot be judged.
using AnswerShares = std::vector<double>;

/// The draws of noise over which noisy_answer() averages.
inline constexpr int kNoisyPercepts = 32;

/// Judges every trial by all others. Each stimulus (class and exemplar) has the mean of the others'
/// features, and all have one covariance; the answer is the class of the likeliest stimulus, ties
/// (within 1e-9 in logarithm) split evenly. The only trial of an exemplar is judged by the other
/// exemplars of its class; the only trial of a class is not judged. Thread-safe once constructed.
class Observer {
 public:
  /// \param classes  number of classes, >= 1
  /// \throws std::invalid_argument if a class or exemplar is out of range, or a feature not finite
  Observer(Cue cue, std::span<const ObservedTrial> trials, int classes);
  ~Observer();
  Observer(Observer&&) noexcept;
  Observer& operator=(Observer&&) noexcept;

  /// Cost: about 10 us with 23 features and 5 stimuli.
  [[nodiscard]] AnswerShares ideal_answer(std::size_t trial) const;

  /// The mean answer over kNoisyPercepts draws of noise that is added to every feature. As a
  /// simulated participant does, the observer knows the noise's size. Each trial has its own draws,
  /// the same for any noise. Cost: about 50 us.
  /// \param noise  standard deviation, > 0
  [[nodiscard]] AnswerShares noisy_answer(std::size_t trial, double noise) const;

 private:
  struct Lessons;
  std::unique_ptr<const Lessons> lessons_;
};

/// One observer's answers by trial; empty shares where a trial cannot be judged.
struct ObserverAnswers {
  std::vector<AnswerShares> ideal;
  double matched_noise = 0.0;  ///< 0: the ideal answers are right no more often than people's
  std::vector<AnswerShares> matched;  ///< with that noise
};

/// Answers as an ideal observer, and as one whose noise makes it right as often as the participants
/// were. Bisection finds that noise, to within 1e-3, on at most 2,000 evenly chosen trials with a
/// response.
/// \param responses  by trial; nothing: no response
/// \param jobs  threads, on which the result does not depend; 0: one for each core
/// \throws std::invalid_argument as Observer, or if there are not as many responses as trials
[[nodiscard]] ObserverAnswers observer_answers(Cue cue, std::span<const ObservedTrial> trials,
                                               std::span<const std::optional<int>> responses,
                                               int classes, int jobs = 0);

}  // namespace touchtrial::analysis::identification
