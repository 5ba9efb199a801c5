/// \file Which class was taken for which.
#pragma once

#include "analysis/statistics/proportion.hpp"
#include "core/plane.hpp"

#include <optional>
#include <vector>

namespace touchtrial::analysis {

/// One trial: the class that was presented and the class that was answered, if any.
struct Choice {
  int presented = 0;
  std::optional<int> answered;
};

/// Counts of trials: rows are the presented class, columns the answer, and beside them the trials
/// without a response.
class ConfusionMatrix {
 public:
  /// \throws std::invalid_argument if there is no class
  explicit ConfusionMatrix(int classes);

  /// \throws std::invalid_argument if a class is out of range
  void add(const Choice& choice);

  [[nodiscard]] int classes() const noexcept { return counts_.height(); }
  [[nodiscard]] int count(int presented, int answered) const noexcept {
    return counts_.at(presented, answered);
  }
  [[nodiscard]] int no_response(int presented) const noexcept { return no_response_[presented]; }

  /// Trials of a class, those without a response included.
  [[nodiscard]] int presented(int presented) const noexcept;
  /// All trials with a response.
  [[nodiscard]] int answered() const noexcept;
  /// Of a class: the trials, those without a response as wrong.
  [[nodiscard]] Proportion accuracy(int presented) const noexcept;
  /// Of all classes.
  [[nodiscard]] Proportion accuracy() const noexcept;

  friend bool operator==(const ConfusionMatrix&, const ConfusionMatrix&) = default;

 private:
  Plane<int> counts_;
  std::vector<int> no_response_;
};

/// \return 100 * part / whole, or nothing if the whole is 0
[[nodiscard]] std::optional<double> percentage(int part, int whole) noexcept;

}  // namespace touchtrial::analysis
