/// \file What one participant, and the observers in their place, answered to one method's trials.
#pragma once

#include "analysis/cues/cue_report.hpp"
#include "analysis/cues/ideal_observer.hpp"

#include <array>
#include <optional>
#include <string>
#include <vector>

namespace touchtrial::analysis {

/// Counts of answers, classes x classes, row-major, rows are the presented class.
using FlatCounts = std::vector<double>;

/// One trial, judged by all observers.
struct JudgedTrial {
  int presented = 0;
  std::optional<int> response;
  std::array<AnswerShares, kCues.size()> ideal;    ///< in the order of kCues, none empty
  std::array<AnswerShares, kCues.size()> matched;  ///< the same, as unsure as participants
};

class ParticipantAnswers {
 public:
  ParticipantAnswers(std::string participant, int classes);

  void add(const JudgedTrial& trial);

  [[nodiscard]] const std::string& participant() const noexcept { return participant_; }
  [[nodiscard]] int classes() const noexcept { return classes_; }
  [[nodiscard]] int trials() const noexcept { return trials_; }
  /// Trials of a class.
  [[nodiscard]] int presented(int class_index) const noexcept { return presented_[class_index]; }
  /// Trials of a class without a response.
  [[nodiscard]] int no_response(int class_index) const noexcept {
    return no_response_[class_index];
  }

  /// Of all trials, those without a response as wrong. \pre trials() > 0
  [[nodiscard]] double human_accuracy() const noexcept { return human_right_ / trials_; }
  /// Of all trials. \param observer  in the order of kCues
  [[nodiscard]] double available(std::size_t observer) const noexcept {
    return right_[observer] / trials_;
  }

  /// Of the trials with a response.
  [[nodiscard]] const FlatCounts& human() const noexcept { return human_; }
  /// Of all trials.
  [[nodiscard]] const FlatCounts& ideal(std::size_t observer) const noexcept {
    return ideal_[observer];
  }
  [[nodiscard]] const FlatCounts& matched(std::size_t observer) const noexcept {
    return matched_[observer];
  }
  /// Of the trials with a response: to be held against human().
  [[nodiscard]] const FlatCounts& ideal_of_answered(std::size_t observer) const noexcept {
    return ideal_of_answered_[observer];
  }
  [[nodiscard]] const FlatCounts& matched_of_answered(std::size_t observer) const noexcept {
    return matched_of_answered_[observer];
  }

 private:
  std::string participant_;
  int classes_;
  int trials_ = 0;
  double human_right_ = 0.0;
  std::array<double, kCues.size()> right_{};
  std::vector<int> presented_;
  std::vector<int> no_response_;
  FlatCounts human_;
  std::array<FlatCounts, kCues.size()> ideal_;
  std::array<FlatCounts, kCues.size()> matched_;
  std::array<FlatCounts, kCues.size()> ideal_of_answered_;
  std::array<FlatCounts, kCues.size()> matched_of_answered_;
};

}  // namespace touchtrial::analysis
