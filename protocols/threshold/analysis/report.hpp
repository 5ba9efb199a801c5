/// \file The numbers of a threshold study, from counted outcomes. A trial without an answer belongs to
/// no track, because the procedure ignores it. Source: docs/thresholds.md, "What the report
/// contains".
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

using choices::ChoiceUse;
using choices::GroupTest;
using choices::GuessingTests;
using choices::Repetition;
using choices::RightAnswers;

/// A threshold in a familiar quantity, such as a Weber fraction.
struct Quantity {
  std::optional<double> value{};
  std::optional<double> low{};
  std::optional<double> high{};
};

struct TrackReport {
  std::string participant;
  int track = 0;                               ///< from 1
  std::size_t standard = 0;                    ///< index into ThresholdReport::standards
  std::vector<procedures::TrackTrial> trials;  ///< of the procedure, in felt order
  Proportion answers;                          ///< in `trials`
  Proportion catches;                          ///< in catch trials, at the highest level
  /// The threshold from answers and catches; nothing for same or different.
  std::optional<procedures::ThresholdEstimate> estimate{};
  std::optional<procedures::Threshold> reversals{};  ///< of a staircase
  std::optional<procedures::GoodnessOfFit> fit{};    ///< with constant stimuli
  /// The change of the threshold from the first to the last trial, in dB; negative: improvement.
  /// Nothing for a track without a threshold or with too little information.
  std::optional<double> learning_db{};

  [[nodiscard]] std::optional<double> threshold() const {
    return estimate ? estimate->threshold.level : std::nullopt;
  }
};

/// The thresholds of all participants at one class and standard.
struct StandardReport {
  study::threshold::Standard definition;
  std::string words;                        ///< study::threshold::words_of
  std::vector<double> levels;               ///< of its tracks
  int tracks = 0;                           ///< with a trial
  std::vector<std::string> people;          ///< with a track
  std::vector<PersonThreshold> thresholds;  ///< of `people`
  CensoredMean mean;                        ///< in units of the level

  /// The number of `people` with this state; Censored::no: with a known threshold.
  [[nodiscard]] int number_of(procedures::Censored censored) const;
};

/// The thresholds of two standards, first minus second, of participants with tracks of both.
struct DifferenceReport {
  std::size_t first = 0;  ///< indices into ThresholdReport::standards
  std::size_t second = 1;
  CensoredMean difference;
  int known = 0;                          ///< people with two known thresholds
  std::optional<double> p{};              ///< two-sided
  std::optional<double> p_holm{};         ///< over all pairs
  std::optional<TStatistic> statistic{};  ///< if every difference is known
};

/// d' of "same" or "different" at one level. Hits are of the level, false alarms of all trials of
/// the standard with equal planes, because participants use one criterion.
struct SameDifferentLevel {
  std::string participant;  ///< empty: all pooled
  std::size_t standard = 0;
  double level = 0.0;
  Proportion different;           ///< hits: "different" for different planes
  Proportion same;                ///< false alarms: "different" for equal planes, at this level
  Proportion same_at_all_levels;  ///< false alarms at all levels
  std::optional<double> d_differencing{};  ///< 0 with fewer hits than false alarms
  std::optional<double> d_independent{};
};

struct PooledDPrime {
  std::optional<double> d_prime{};
  /// Bootstrap over participants; nothing with fewer than kMinBootstrapParticipants.
  std::optional<Interval> interval{};
};

/// d' of all participants' answers at one level. There is no mean of participants' d': d' grows as
/// the root of hits minus false alarms, so the mean of small d' is far too small with realistic
/// numbers of trials.
struct SameDifferentGroup {
  std::size_t standard = 0;
  double level = 0.0;
  int participants = 0;  ///< with trials of both kinds
  PooledDPrime differencing;
  PooledDPrime independent;
};

/// Answers in the control block, with the hand off the device.
struct SoundReport : GuessingTests {
  choices::GlobalNullResult global_null;      ///< whether anybody is above chance
  choices::DetectableAccuracy detectable;     ///< with these numbers of trials
  std::vector<std::string> hearers;           ///< people_above_chance
  std::vector<CensoredMean> without_hearers;  ///< by standard; empty without hearers
};

struct ThresholdReport : StudyHead {
  study::Study design;
  std::vector<std::string> choices;
  /// The share right at the threshold for an observer without lapses; nothing without thresholds.
  std::optional<double> criterion{};
  double guess = 0.5;      ///< share right by guessing
  int without_answer = 0;  ///< omitted trials of tracks
  std::vector<TrackReport> tracks;
  std::vector<StandardReport> standards;
  std::vector<DifferenceReport> differences;
  std::optional<SoundReport> control{};  ///< nothing without control trials
  std::optional<GuessingTests> catches{};
  std::vector<choices::Attention> attention;  ///< by catches->people
  std::vector<ChoiceUse> choice_use;
  choices::Preferences preferences;  ///< empty for same or different
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

/// Computes the report. Cost: 0.1 s per track; with constant stimuli 1 s.
/// \param jobs  threads for fits; 0: one for each core
[[nodiscard]] ThresholdReport make_report(const Outcomes& outcomes, int jobs = 0);

/// The quantity at a level of discrimination: the Weber fraction of gain and pitch (0.1 for 10%),
/// the change of an order, the share of the second texture of a blend.
/// \return nothing for detection
[[nodiscard]] std::optional<double> quantity_at(const study::threshold::ThresholdOptions& options,
                                                const study::threshold::Standard& standard,
                                                const std::optional<double>& level);
[[nodiscard]] Quantity quantity_of(const study::threshold::ThresholdOptions& options,
                                   const study::threshold::Standard& standard,
                                   const procedures::Threshold& threshold);

/// "below", "above" or "undetermined", for files; empty for a threshold with a number.
[[nodiscard]] std::string_view word_of(procedures::Censored censored);

[[nodiscard]] procedures::Threshold mean_threshold(const CensoredMean& mean);

[[nodiscard]] std::string report_json(const ThresholdReport& report);

/// Whether a trial was chosen by a track's procedure, is a catch trial of a track, or is in the
/// control block, respectively.
[[nodiscard]] bool is_track_trial(const TrialOutcome& trial) noexcept;
[[nodiscard]] bool is_catch(const TrialOutcome& trial) noexcept;
[[nodiscard]] bool is_control_trial(const TrialOutcome& trial) noexcept;
/// Whether a trial was answered, and so is right or wrong.
[[nodiscard]] bool is_answer(const TrialOutcome& trial) noexcept;

/// People with their answered trials of tracks, catch trials and the control block, in felt order.
/// \param outcomes  must outlive the result
[[nodiscard]] std::vector<choices::Person> people_of(const Outcomes& outcomes);

/// \param standards  for SoundReport::without_hearers
/// \return nothing without control trials
[[nodiscard]] std::optional<SoundReport> sound_report(std::span<const choices::Person> people,
                                                      double guess,
                                                      std::span<const StandardReport> standards);

/// The hearers with their right answers: "3 of 12 participants have an individual p of ...: P3 (20
/// of 20)"; may be empty
[[nodiscard]] std::string hearers_words(const SoundReport& control);

/// The tracks with a trial, by participant, then by track.
[[nodiscard]] std::vector<TrackReport> track_reports(const study::Study& study,
                                                     std::span<const choices::Person> people,
                                                     int jobs);

/// Counts and d' of same or different, by participant, then pooled; empty for other questions.
[[nodiscard]] std::vector<SameDifferentLevel> same_different_levels(
    const study::Study& study, std::span<const choices::Person> people);
/// \param levels  of same_different_levels
[[nodiscard]] std::vector<SameDifferentGroup> same_different_groups(
    std::span<const SameDifferentLevel> levels);

/// Warnings against misreading the report, the most serious first.
/// \param report  complete except for its warnings
[[nodiscard]] std::vector<std::string> threshold_warnings(const ThresholdReport& report);

}  // namespace touchtrial::analysis::threshold
