/// \file The numbers of a threshold study, from the outcomes that count. A trial without an answer
/// belongs to no track: the procedure did not hear of it. Source: docs/thresholds.md, "What the
/// report says".
#pragma once

#include "analysis/choices/answers.hpp"
#include "analysis/choices/preferences.hpp"
#include "analysis/outcomes/outcomes.hpp"
#include "analysis/outcomes/study_head.hpp"
#include "analysis/statistics/censored_mean.hpp"
#include "analysis/statistics/descriptive.hpp"
#include "analysis/statistics/mean_test.hpp"
#include "analysis/statistics/same_different_d_prime.hpp"
#include "protocols/procedures/estimates.hpp"
#include "protocols/threshold/analysis/person_threshold.hpp"
#include "protocols/threshold/study/threshold.hpp"

#include <cstddef>
#include <optional>
#include <span>
#include <string>
#include <string_view>
#include <vector>

namespace touchtrial::analysis::threshold {

using choices::AgainstGuessing;
using choices::ChoiceUse;
using choices::GroupTest;
using choices::Repetition;
using choices::RightAnswers;

/// A threshold in the quantity that a reader knows.
struct Quantity {
  std::optional<double> value{};
  std::optional<double> low{};
  std::optional<double> high{};
};

struct TrackReport {
  std::string participant;
  int track = 0;                               ///< from 1
  std::size_t standard = 0;                    ///< index into ThresholdReport::standards
  std::vector<procedures::TrackTrial> trials;  ///< that the procedure chose, as they were felt
  Proportion answers;                          ///< in these
  Proportion catches;                          ///< at the highest level, without the procedure
  /// Of both; nothing for same or different.
  std::optional<procedures::ThresholdEstimate> estimate{};
  std::optional<procedures::Threshold> reversals{};  ///< of a staircase
  std::optional<procedures::GoodnessOfFit> fit{};    ///< with constant stimuli
  /// The change of the threshold from the first to the last trial, in dB. Below 0: the participant
  /// became better. Nothing for a track without a threshold, and for one that tells too little.
  std::optional<double> learning_db{};

  /// Nothing: the answers tell no number.
  [[nodiscard]] std::optional<double> threshold() const {
    return estimate ? estimate->threshold.level : std::nullopt;
  }
};

/// One class and standard: what the thresholds of all participants with a track have in common.
struct StandardReport {
  study::threshold::Standard of;
  std::string words;                        ///< study::threshold::words_of
  std::vector<double> levels;               ///< of its tracks
  int tracks = 0;                           ///< with a trial
  std::vector<std::string> people;          ///< those with a track
  std::vector<PersonThreshold> thresholds;  ///< theirs
  CensoredMean mean;                        ///< in units of the level

  /// How many of `people` are censored so, or (no) have tracks with a number.
  [[nodiscard]] int number_of(procedures::Censored censored) const;
};

/// The thresholds of two standards, first minus second, of participants with a track of both.
struct DifferenceReport {
  std::size_t first = 0;  ///< indices into ThresholdReport::standards
  std::size_t second = 1;
  CensoredMean difference;
  int known = 0;                          ///< people both of whose thresholds are known
  std::optional<double> p{};              ///< two-sided
  std::optional<double> p_holm{};         ///< over all pairs
  std::optional<TStatistic> statistic{};  ///< if every difference is known
};

/// d' of "same" or "different" at one level. Hits are of the level, false alarms of all trials of
/// the standard with two alike: the participant has one criterion for all.
struct SameDifferentLevel {
  std::string participant;  ///< empty: all pooled
  std::size_t standard = 0;
  double level = 0.0;
  Proportion different;    ///< hits: "different" where they differ
  Proportion same;         ///< false alarms: "different" where they are alike, at this level
  Proportion same_at_all;  ///< false alarms at all levels
  std::optional<double> d_differencing{};  ///< 0 with fewer hits than false alarms
  std::optional<double> d_independent{};
};

struct PooledDPrime {
  std::optional<double> d_prime{};
  /// Bootstrap over participants; nothing with fewer than kMinForBootstrap.
  std::optional<Interval> interval{};
};

/// d' of all participants' answers at one level. Their own d' have no mean: d' grows as the root of
/// hits less false alarms, so that the mean of a weak d' is far too small with any number of trials
/// that a session has.
struct SameDifferentGroup {
  std::size_t standard = 0;
  double level = 0.0;
  int participants = 0;  ///< with trials of both kinds
  PooledDPrime differencing;
  PooledDPrime independent;
};

/// The control block with the hand off the device.
struct SoundReport : AgainstGuessing {
  choices::GlobalNullResult anybody;  ///< whether anybody could hear it
  choices::Detectable detectable;     ///< what so few trials could have shown
  std::vector<std::string> hearers;   ///< whose own p is within the level, if anybody could
  std::vector<CensoredMean> without;  ///< means of standards without the hearers, if there are some
};

struct ThresholdReport : StudyHead {
  study::Study design;
  std::vector<std::string> choices;
  /// The proportion right at the threshold, of an observer without lapses; nothing without
  /// thresholds.
  std::optional<double> criterion{};
  double guess = 0.5;      ///< right by guessing
  int without_answer = 0;  ///< trials of tracks that were left out for this
  std::vector<TrackReport> tracks;
  std::vector<StandardReport> standards;
  std::vector<DifferenceReport> differences;
  std::optional<SoundReport> control{};  ///< nothing without a trial of it
  std::optional<AgainstGuessing> catches{};
  std::vector<choices::Attention> attention;  ///< of the people in `catches`, in their order
  std::vector<ChoiceUse> choice_use;
  choices::Preferences preferences;  ///< nobody with same or different, which has no right interval
  Repetition after_right;
  Repetition after_wrong;
  GroupTest learning_db;
  std::vector<SameDifferentLevel> same_different;  ///< by participant, then pooled
  std::vector<SameDifferentGroup> same_different_groups;

  [[nodiscard]] const study::threshold::ThresholdOptions& options() const {
    return study::threshold::options_of(design);
  }
  [[nodiscard]] bool has_thresholds() const { return criterion.has_value(); }
};

/// \param jobs  threads for fits, 0: one for each core
/// Cost: a tenth of a second a track; with constant stimuli a second.
[[nodiscard]] ThresholdReport make_report(const Outcomes& outcomes, int jobs = 0);

/// What a level of discrimination is: the Weber fraction of gain and pitch (0.1 for 10 %), the
/// change of an order, the share of the second texture of a blend.
/// \return nothing for detection
[[nodiscard]] std::optional<double> quantity_at(const study::threshold::ThresholdOptions& options,
                                                const study::threshold::Standard& standard,
                                                const std::optional<double>& level);
/// The same for a threshold and its interval.
[[nodiscard]] Quantity quantity_of(const study::threshold::ThresholdOptions& options,
                                   const study::threshold::Standard& standard,
                                   const procedures::Threshold& threshold);

/// "below", "above" or "undetermined", for files; empty for a threshold with a number.
[[nodiscard]] std::string_view word_of(procedures::Censored censored);

/// A mean over participants and its interval, as a threshold.
[[nodiscard]] procedures::Threshold mean_threshold(const CensoredMean& mean);

[[nodiscard]] std::string report_json(const ThresholdReport& report);

/// Whether a track's procedure chose a trial, whether it is at a track's highest level without the
/// procedure, or belongs to the control block.
[[nodiscard]] bool in_track(const TrialOutcome& trial) noexcept;
[[nodiscard]] bool is_catch(const TrialOutcome& trial) noexcept;
[[nodiscard]] bool in_control(const TrialOutcome& trial) noexcept;
/// Whether a trial was answered, so that it is right or wrong.
[[nodiscard]] bool is_answer(const TrialOutcome& trial) noexcept;

/// People with their trials that have an answer, of tracks, catch trials and the control block, in
/// the order in which they were felt.
/// \param outcomes  must outlive the result
[[nodiscard]] std::vector<choices::Person> people_of(const Outcomes& outcomes);

/// \param standards  whose means are also given without those who could hear
/// \return nothing without a trial with the hand off the device
[[nodiscard]] std::optional<SoundReport> sound_report(std::span<const choices::Person> people,
                                                      double guess,
                                                      std::span<const StandardReport> standards);

/// Who could hear it, with their right answers: "3 of 12 participants have an own p of ...: P3 (20
/// of 20)"; empty if nobody stands out.
[[nodiscard]] std::string hearers_words(const SoundReport& control);

/// The tracks with a trial and their estimates, by participant, then by track.
[[nodiscard]] std::vector<TrackReport> track_reports(const study::Study& study,
                                                     std::span<const choices::Person> people,
                                                     int jobs);

/// Counts and d' of same or different, by participant, then pooled; nothing for another question.
[[nodiscard]] std::vector<SameDifferentLevel> same_different_levels(
    const study::Study& study, std::span<const choices::Person> people);
/// \param levels  of same_different_levels
[[nodiscard]] std::vector<SameDifferentGroup> same_different_groups(
    std::span<const SameDifferentLevel> levels);

/// How a reader could misread the numbers, the gravest first.
/// \param report  complete except for its warnings
[[nodiscard]] std::vector<std::string> threshold_warnings(const ThresholdReport& report);

}  // namespace touchtrial::analysis::threshold
