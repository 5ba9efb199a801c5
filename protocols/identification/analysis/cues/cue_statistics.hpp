/// \file Efficiencies of participants and divergences from observers in one method's trials, with
/// intervals over participants. Sources: docs/statistics.md, "Cues" and "Participants as clusters";
/// Lin 1991, IEEE Transactions on Information Theory 37(1) (divergence).
#pragma once

#include "protocols/identification/analysis/cues/cue_report.hpp"
#include "protocols/identification/analysis/cues/ideal_observer.hpp"

#include <array>
#include <cstdint>
#include <optional>
#include <span>
#include <string>
#include <vector>

namespace touchtrial::analysis::identification {

/// Counts of answers, classes x classes, row-major; rows are the presented class.
using FlatCounts = std::vector<double>;

/// One trial, judged by all observers.
struct JudgedTrial {
  int presented = 0;
  std::optional<int> response;
  std::array<AnswerShares, kCues.size()> ideal;    ///< in the order of kCues, none empty
  std::array<AnswerShares, kCues.size()> matched;  ///< with matching noise
};

/// The answers of one participant, and of the observers to the same trials. Arrays are in the order
/// of kCues.
struct ParticipantAnswers {
  ParticipantAnswers(std::string name, int class_count);

  void add(const JudgedTrial& trial);

  /// The participant's accuracy; trials without a response are wrong.
  /// \pre trials > 0
  [[nodiscard]] double human_accuracy() const noexcept { return human_right / trials; }
  /// The observer's accuracy.
  [[nodiscard]] double observer_accuracy(std::size_t observer) const noexcept {
    return right[observer] / trials;
  }

  std::string participant;
  int classes;
  int trials = 0;
  std::vector<int> presented;    ///< trials, by class
  std::vector<int> no_response;  ///< trials without a response, by class
  double human_right = 0.0;
  std::array<double, kCues.size()> right{};
  FlatCounts human;                                       ///< in the trials with a response
  std::array<FlatCounts, kCues.size()> ideal;             ///< in all trials
  std::array<FlatCounts, kCues.size()> matched;           ///< in all trials
  std::array<FlatCounts, kCues.size()> answered_ideal;    ///< in the trials with a response
  std::array<FlatCounts, kCues.size()> answered_matched;  ///< in the trials with a response
};

/// The Jensen-Shannon divergence of two distributions.
/// \param a,b  counts >= 0 of equal length, each with a sum > 0
/// \return bits: 0 if the shares are equal, 1 if they do not overlap
[[nodiscard]] double jensen_shannon_bits(std::span<const double> a,
                                         std::span<const double> b) noexcept;

/// The mean over presented classes of the divergence between two observers' answers. A class counts
/// only if it was presented to both.
/// \param a,b  counts, classes x classes, row-major; rows are the presented class
/// \return bits; nothing if no class counts
[[nodiscard]] std::optional<double> answer_divergence(std::span<const double> a,
                                                      std::span<const double> b,
                                                      int classes) noexcept;

/// The numbers of the observers, in the order of kCues.
struct CueStatistics {
  std::array<CueFigure, kCues.size()> efficiency;
  std::array<CueFigure, kCues.size()> corrected_efficiency;
  std::array<CueFigure, kCues.size()> divergence;
  std::array<CueFigure, kCues.size()> matched_divergence;
  std::optional<CueMatch> match;
};

/// Computes the numbers with 95% intervals over participants. Efficiencies have
/// expanded_percentiles of 9,999 bootstrap samples of participants, the same samples for all.
/// Divergences and their differences are jackknife estimates, because few answers bias a divergence
/// upward and resampling increases the bias. A number that is undefined in any sample has no
/// interval, such as a corrected efficiency if the observer is at chance. With one participant,
/// divergences are not corrected.
/// \param participants  with the same number of classes, and at least one trial each
/// \param index  selects the random stream
/// \param jobs  threads; 0: one for each core. The result does not depend on it.
[[nodiscard]] CueStatistics cue_statistics(std::span<const ParticipantAnswers> participants,
                                           std::uint64_t index, int jobs = 0);

/// The divergences and the match of cue_statistics, without efficiencies.
[[nodiscard]] CueStatistics cue_divergences(std::span<const ParticipantAnswers> participants);

}  // namespace touchtrial::analysis::identification
