/// \file The confusion matrix, and the accuracy under the best matching of labels. Sources:
/// docs/statistics.md, "Swapped labels"; Kuhn 1955.
#pragma once

#include "analysis/statistics/proportion.hpp"
#include "core/plane.hpp"

#include <optional>
#include <span>
#include <vector>

namespace touchtrial::analysis {

/// One trial: the class that was presented and the class that was answered, if any.
struct Choice {
  int presented = 0;
  std::optional<int> answered;
};

/// Counts of trials: rows are the presented class, columns the answer. Trials without a response
/// are counted separately.
class ConfusionMatrix {
 public:
  /// \throws std::invalid_argument if there is no class, or a choice's class is out of range
  explicit ConfusionMatrix(int classes, std::span<const Choice> choices = {});

  /// \param times  the number of such trials
  /// \throws std::invalid_argument if a class is out of range
  void add(const Choice& choice, int times = 1);

  [[nodiscard]] int classes() const noexcept { return counts_.height(); }
  [[nodiscard]] int count(int presented, int answered) const noexcept {
    return counts_.at(presented, answered);
  }
  [[nodiscard]] int no_response(int presented) const noexcept { return no_response_[presented]; }

  /// Trials that presented a class, including those without a response.
  [[nodiscard]] int presented(int presented) const noexcept;
  /// Trials with this answer, regardless of the presented class.
  [[nodiscard]] int answered(int answered) const noexcept;
  /// All trials with a response.
  [[nodiscard]] int answered() const noexcept;
  /// Accuracy for one class; a trial without a response is wrong.
  [[nodiscard]] Proportion accuracy(int presented) const noexcept;
  /// Accuracy over all trials; a trial without a response is wrong.
  [[nodiscard]] Proportion accuracy() const noexcept;

  friend bool operator==(const ConfusionMatrix&, const ConfusionMatrix&) = default;

 private:
  Plane<int> counts_;
  std::vector<int> no_response_;
};

/// \return 100 * part / whole, or nothing if the whole is 0
[[nodiscard]] std::optional<double> percentage(int part, int whole) noexcept;

/// The share of a class's presentations that were answered right, times the share of its answers
/// that were right. Always giving the same answer scores no more than that class's share of the
/// presentations. Source: docs/statistics.md, "Unbiased hit rate"; Wagner 1993.
/// \return 0 if the class was never answered right; nothing if it was never presented
[[nodiscard]] std::optional<double> unbiased_hit_rate(const ConfusionMatrix& confusion,
                                                      int class_index);

/// The mean of unbiased_hit_rate over all orders of the same presentations, with the same answers.
/// \return nothing if the class was never presented
[[nodiscard]] std::optional<double> unbiased_hit_rate_by_chance(const ConfusionMatrix& confusion,
                                                                int class_index);

/// The one-to-one matching of classes and answers that agrees with the most trials.
struct LabelMatching {
  Proportion accuracy;         ///< trials with the matched answer
  std::vector<int> answer_of;  ///< by presented class; its own label where matchings tie
};

/// Shows whether a participant distinguishes the classes but mixes up their labels. Choosing the
/// best matching biases the accuracy upward: with few trials it is above chance even for random
/// answers. Cost: O(K^3) for K classes.
[[nodiscard]] LabelMatching best_label_matching(const ConfusionMatrix& confusion);

/// Tests the null hypothesis that a participant gives classes their own labels at least as often as
/// the labels of the best matching. Only answers to relabelled classes that agree with either
/// labelling count; under the null hypothesis each is a fair coin. The p is the binomial tail times
/// the number of ways to exchange that number of labels, which corrects for choosing the best way.
/// \param best  best_label_matching of the same counts
/// \return in (0, 1]; 1 if the best matching changes no label
[[nodiscard]] double label_swap_p(const ConfusionMatrix& confusion, const LabelMatching& best);

}  // namespace touchtrial::analysis
