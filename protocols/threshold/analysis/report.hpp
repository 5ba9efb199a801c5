/// \file The numbers of a threshold study, from the outcomes that count. A trial without an answer
/// belongs to no track: the procedure did not hear of it. Source: docs/thresholds.md, "What the
/// report says".
#pragma once

#include "analysis/choices/answers.hpp"
#include "analysis/outcomes/outcomes.hpp"
#include "analysis/outcomes/study_head.hpp"
#include "analysis/statistics/descriptive.hpp"
#include "analysis/statistics/same_different_d_prime.hpp"
#include "protocols/procedures/estimates.hpp"
#include "protocols/threshold/study/threshold.hpp"

#include <cstddef>
#include <optional>
#include <span>
#include <string>
#include <vector>

namespace touchtrial::analysis::threshold {

using choices::AgainstGuessing;
using choices::ChoiceUse;
using choices::GroupTest;
using choices::Repetition;
using choices::RightAnswers;

/// What one estimator says about a track. A censored one has neither slope nor lapse rate.
struct TrackEstimate {
  procedures::Threshold threshold;  ///< in units of the level
  std::optional<double> slope{};    ///< procedures::Observer::slope
  std::optional<double> lapse{};
};

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
  std::vector<procedures::TrackTrial> trials;  ///< in the order in which they were felt
  Proportion answers;
  std::optional<TrackEstimate> posterior{};          ///< mean, 95 % credible interval
  std::optional<TrackEstimate> likelihood{};         ///< most likely, 95 % profile interval
  std::optional<procedures::Threshold> reversals{};  ///< of a staircase
  std::optional<procedures::GoodnessOfFit> fit{};    ///< with constant stimuli
  /// The observer of the quoted estimate; nothing for a censored track.
  std::optional<procedures::Observer> observer{};
  /// The change of the threshold from the first to the last trial, in dB. Below 0: the participant
  /// became better. Nothing for a censored track, and for one that tells too little.
  std::optional<double> learning_db{};
};

/// One class and standard: what participants' thresholds have in common. A participant's threshold
/// is the mean of the own tracks that are not censored.
struct StandardReport {
  study::threshold::Standard of;
  std::string words;           ///< study::threshold::words_of
  std::vector<double> levels;  ///< of its tracks
  int tracks = 0;              ///< with a trial
  int censored_below = 0;      ///< tracks
  int censored_above = 0;
  std::vector<std::string> people;  ///< those with a threshold
  std::vector<double> thresholds;   ///< theirs
  MeanEstimate mean;                ///< in units of the level
};

/// The thresholds of two standards, first minus second, of participants who have both.
struct DifferenceReport {
  std::size_t first = 0;  ///< indices into ThresholdReport::standards
  std::size_t second = 1;
  GroupTest difference;
  std::optional<double> p_holm{};  ///< over all pairs
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
  /// For means: with fewer hits than false alarms, minus the d' of the exchanged shares, so that
  /// guessing gives 0 on average.
  std::optional<double> signed_differencing{};
  std::optional<double> signed_independent{};
};

/// Means over participants at one level, of the signed values.
struct SameDifferentGroup {
  std::size_t standard = 0;
  double level = 0.0;
  MeanEstimate differencing;
  MeanEstimate independent;
};

struct ThresholdReport : StudyHead {
  study::Study design;
  std::vector<std::string> choices;
  /// The proportion right at the threshold, of an observer without lapses; nothing without
  /// thresholds.
  std::optional<double> criterion{};
  double guess = 0.5;        ///< right by guessing
  bool by_posterior = true;  ///< the estimate that is quoted; otherwise maximum likelihood
  int without_answer = 0;    ///< trials of tracks that were left out for this
  std::vector<TrackReport> tracks;
  std::vector<StandardReport> standards;
  std::vector<DifferenceReport> differences;
  std::optional<AgainstGuessing> control{};  ///< nothing without a trial of it
  std::optional<AgainstGuessing> catches{};
  std::vector<ChoiceUse> choice_use;
  Repetition after_right;
  Repetition after_wrong;
  GroupTest learning_db;
  std::vector<SameDifferentLevel> same_different;  ///< by participant, then pooled
  std::vector<SameDifferentGroup> same_different_groups;

  [[nodiscard]] const study::threshold::ThresholdOptions& options() const {
    return study::threshold::options_of(design);
  }
  [[nodiscard]] bool has_thresholds() const { return criterion.has_value(); }
  /// The estimate of a track that is quoted.
  [[nodiscard]] const std::optional<TrackEstimate>& quoted(const TrackReport& track) const {
    return by_posterior ? track.posterior : track.likelihood;
  }
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

/// A mean over participants and its t interval, as a threshold.
[[nodiscard]] procedures::Threshold mean_threshold(const MeanEstimate& mean);

[[nodiscard]] std::string report_json(const ThresholdReport& report);

/// Whether a trial belongs to a track of the study, or to the control block.
[[nodiscard]] bool in_track(const TrialOutcome& trial) noexcept;
[[nodiscard]] bool in_control(const TrialOutcome& trial) noexcept;

/// People with their trials that have an answer, of tracks, catch trials and the control block, in
/// the order in which they were felt.
/// \param outcomes  must outlive the result
[[nodiscard]] std::vector<choices::Person> people_of(const Outcomes& outcomes);

/// The tracks with a trial and their estimates, by participant, then by track.
[[nodiscard]] std::vector<TrackReport> track_reports(const study::Study& study,
                                                     std::span<const choices::Person> people,
                                                     bool by_posterior, int jobs);

/// How a reader could misread the numbers, the gravest first.
/// \param report  complete except for its warnings
[[nodiscard]] std::vector<std::string> threshold_warnings(const ThresholdReport& report);

}  // namespace touchtrial::analysis::threshold
