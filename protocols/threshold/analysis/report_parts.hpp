/// \file The parts of a threshold report. Private to protocols/threshold/analysis.
#pragma once

#include "protocols/threshold/analysis/report.hpp"

#include <span>
#include <string>
#include <vector>

namespace touchtrial::analysis::threshold {

/// A participant whose session counts, with the own trials that have an answer, in the order in
/// which they were felt. The pointers refer to the outcomes.
struct Person {
  std::string name;
  std::vector<const TrialOutcome*> trials;  ///< of tracks, catch trials and the control block
};

/// Whether a trial belongs to a track of the study, or to the control block.
[[nodiscard]] bool in_track(const TrialOutcome& trial) noexcept;
[[nodiscard]] bool in_control(const TrialOutcome& trial) noexcept;

/// \param outcomes  must outlive the result
/// \return in the order of sessions; also those without a trial
[[nodiscard]] std::vector<Person> people_of(const Outcomes& outcomes);

/// The tracks with a trial and their estimates, by participant, then by track.
[[nodiscard]] std::vector<TrackReport> track_reports(const study::Study& study,
                                                     std::span<const Person> people,
                                                     bool by_posterior, int jobs);

/// \param report  with its tracks
[[nodiscard]] std::vector<StandardReport> standard_reports(const ThresholdReport& report);
[[nodiscard]] std::vector<DifferenceReport> difference_reports(
    std::span<const StandardReport> standards);
[[nodiscard]] GroupTest group_learning(const ThresholdReport& report);

/// A mean of any numbers over participants, tested against 0.
[[nodiscard]] GroupTest group_test(std::span<const double> values);
[[nodiscard]] MeanEstimate unbounded_mean(std::span<const double> values);

[[nodiscard]] std::optional<OutsideTracks> control_of(std::span<const Person> people, double guess);
[[nodiscard]] std::optional<OutsideTracks> catches_of(std::span<const Person> people, double guess);
[[nodiscard]] std::vector<ChoiceUse> choice_use_of(std::span<const Person> people,
                                                   const std::vector<std::string>& choices);
/// \param after  whether the answer before was right
[[nodiscard]] Repetition repetition_of(std::span<const Person> people, bool after);

/// Counts and d', by participant, then pooled.
[[nodiscard]] std::vector<SameDifferentLevel> same_different_levels(const study::Study& study,
                                                                    std::span<const Person> people);
[[nodiscard]] std::vector<SameDifferentGroup> same_different_groups(
    std::span<const SameDifferentLevel> levels);

/// How a reader could misread the numbers, the gravest first.
/// \param report  complete except for its warnings
[[nodiscard]] std::vector<std::string> threshold_warnings(const ThresholdReport& report);

}  // namespace touchtrial::analysis::threshold
