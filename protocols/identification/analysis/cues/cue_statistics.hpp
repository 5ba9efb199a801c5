/// \file Answers of participants and observers to one method's trials, and efficiencies and
/// divergences with intervals over participants. Sources: docs/statistics.md, "Cues"
/// and "Participants as clusters"; Lin 1991, IEEE Transactions on Information Theory 37(1)
/// (divergence).
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
  std::array<AnswerShares, kCues.size()> matched;  ///< the same, as uncertain as participants
};

/// The answers of one participant, and of the observers in the participant's place, whose members
/// are in the order of kCues.
struct ParticipantAnswers {
  ParticipantAnswers(std::string name, int class_count);

  void add(const JudgedTrial& trial);

  /// The participant's accuracy in all trials; trials without a response are wrong.
  /// \pre trials > 0
  [[nodiscard]] double human_accuracy() const noexcept { return human_right / trials; }
  /// The observer's accuracy in all trials.
  [[nodiscard]] double available(std::size_t observer) const noexcept {
    return right[observer] / trials;
  }

  std::string participant;
  int classes;
  int trials = 0;
  std::vector<int> presented;    ///< trials of each class
  std::vector<int> no_response;  ///< of them, trials without a response
  double human_right = 0.0;
  std::array<double, kCues.size()> right{};
  FlatCounts human;                              ///< in the trials with a response
  std::array<FlatCounts, kCues.size()> ideal;    ///< in all trials
  std::array<FlatCounts, kCues.size()> matched;  ///< in all trials
  std::array<FlatCounts, kCues.size()>
      ideal_of_answered;  ///< in the trials with a response, for comparison
  std::array<FlatCounts, kCues.size()> matched_of_answered;
};

/// The Jensen-Shannon divergence of two distributions that are given as counts.
/// \param a,b  equally many counts, >= 0, the sum of each > 0
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
  std::array<CueFigure, kCues.size()> corrected;
  std::array<CueFigure, kCues.size()> divergence;
  std::array<CueFigure, kCues.size()> matched_divergence;
  std::optional<CueMatch> match;
};

/// Computes the numbers and their 95 % intervals over participants. Efficiencies have
/// expanded_percentiles of 9,999 draws of whole participants with replacement, the same draws for
/// all. Divergences, and differences of two, are jackknife estimates, because few answers bias a
/// divergence upward and resampling adds to the bias. A number that is undefined in a draw, or
/// without a participant, has no interval (for example, a corrected efficiency when the observer is
/// at chance or below). With one participant, divergences are not corrected for bias.
/// \param participants  of the same number of classes, each with at least one trial
/// \param index  chooses the stream of random numbers
/// \param jobs  threads; 0: one for each core. The result does not depend on it.
[[nodiscard]] CueStatistics cue_statistics(std::span<const ParticipantAnswers> participants,
                                           std::uint64_t index, int jobs = 0);

/// The divergences and the match of cue_statistics, without efficiencies and without draws.
[[nodiscard]] CueStatistics cue_divergences(std::span<const ParticipantAnswers> participants);

}  // namespace touchtrial::analysis::identification
