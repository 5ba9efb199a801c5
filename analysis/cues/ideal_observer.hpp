/// \file Observers who feel what a hand felt, use a part of it as well as it can be used, and
/// answer. Source: docs/cues.md.
#pragma once

#include "analysis/cues/cue_report.hpp"
#include "engine/perception/felt_features.hpp"

#include <cstddef>
#include <memory>
#include <span>
#include <vector>

namespace touchtrial::analysis {

/// A trial as an observer meets it.
struct ObservedTrial {
  int class_index = 0;
  int exemplar = 0;
  engine::FeltFeatures felt{};
};

/// What an observer may use. `rms`: the logarithm of the lateral force's intensity in all five
/// bands together. `spectrum`: the five lateral and the five normal bands, each relative to all
/// five of its kind; adding a constant to all features, which is what a stronger force does,
/// changes nothing. `everything`: the features as they are.
[[nodiscard]] std::vector<double> cue_features(Cue cue, const engine::FeltFeatures& felt);

/// How far each class is the answer, summing to 1; empty if the trial cannot be
/// judged.
using AnswerShares = std::vector<double>;

/// Judges every trial by all others: each stimulus (class and exemplar) has the mean of the others'
/// features, all have one covariance, and the answer is the class of the likeliest stimulus, ties
/// (within 1e-9 in logarithm) split evenly. A trial that is its exemplar's only one is judged by
/// its class's other exemplars; if it is its class's only one it is not judged. Thread-safe once
/// made.
class Observer {
 public:
  /// \param classes  how many there are, >= 1
  /// \throws std::invalid_argument if a class or exemplar is out of range, or a feature not finite
  Observer(Cue cue, std::span<const ObservedTrial> trials, int classes);
  ~Observer();
  Observer(Observer&&) noexcept;
  Observer& operator=(Observer&&) noexcept;

  [[nodiscard]] std::size_t trials() const noexcept;

  /// Cost: some 10 us with 23 features and 5 stimuli.
  [[nodiscard]] AnswerShares ideal_answer(std::size_t trial) const;

  /// The mean over kNoisyPercepts draws of the noise with which every feature is perceived, and
  /// which the observer knows of, as a simulated participant does. The draws are the trial's own
  /// and the same for any noise. \param noise  standard deviation, > 0 Cost: some 50 us.
  [[nodiscard]] AnswerShares noisy_answer(std::size_t trial, double noise) const;

 private:
  struct Lessons;
  std::unique_ptr<const Lessons> lessons_;
};

inline constexpr int kNoisyPercepts = 32;

}  // namespace touchtrial::analysis
