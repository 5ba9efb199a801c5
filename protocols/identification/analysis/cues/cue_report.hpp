/// \file Tests which cue participants used: compares their answers with those of ideal observers that
/// get the same traces. Source: docs/statistics.md. Format of the JSON: docs/data-dictionary.md,
/// "Cues".
#pragma once

#include "analysis/outcomes/outcomes.hpp"
#include "analysis/statistics/descriptive.hpp"
#include "analysis/statistics/proportion.hpp"

#include <array>
#include <cmath>
#include <filesystem>
#include <functional>
#include <optional>
#include <string>
#include <string_view>
#include <vector>

namespace touchtrial::analysis::identification {

/// The part of a trial that an ideal observer may use: only the strength of the force, only the
/// shape of its spectrum, or all felt features.
enum class Cue { rms, spectrum, everything };
inline constexpr std::array<Cue, 3> kCues{Cue::rms, Cue::spectrum, Cue::everything};

/// "rms", "spectrum" or "everything".
[[nodiscard]] std::string_view name_of(Cue cue) noexcept;
/// The name in tables and legends: "force strength (rms)", "spectrum's shape" or "everything felt".
[[nodiscard]] std::string_view title_of(Cue cue) noexcept;

struct CueFigure {
  std::optional<double> value;
  std::optional<Interval> interval;  ///< none with fewer than two participants
};

/// Answers: rows are the presented class, columns the answered class. Ties are split, so counts
/// need not be whole numbers.
using AnswerCounts = std::vector<std::vector<double>>;

/// The noise that makes an observer as accurate as the participants.
struct MatchingNoise {
  /// SD on each felt log intensity; 0 if the observer is no more accurate without noise.
  double matched_noise = 0.0;
  double matched_accuracy = 0.0;  ///< of the observer, on the trials that determine the noise
  double target_accuracy = 0.0;   ///< of the participants on these trials
};

/// One observer's answers to one method's trials.
struct ObserverFigures : MatchingNoise {
  Cue cue = Cue::rms;
  AnswerCounts confusion;          ///< from all judged trials
  std::vector<double> accuracy;    ///< in the order of MethodCues::participants
  MeanEstimate mean;               ///< mean of `accuracy`: the attainable accuracy
  CueFigure efficiency;            ///< participants' mean accuracy divided by this observer's
  CueFigure corrected_efficiency;  ///< the ratio of the accuracies above chance
  /// Mean over presented classes of the Jensen-Shannon divergence between participants' and
  /// observer's answers, bits: 0 if confusions are the same, at most 1. By the jackknife.
  CueFigure divergence;
  AnswerCounts matched_confusion;  ///< with matching noise
  CueFigure matched_divergence;    ///< with matching noise

  /// Whether noise makes the observer as accurate as the participants, within one percentage point.
  [[nodiscard]] bool is_as_uncertain() const noexcept {
    return std::abs(matched_accuracy - target_accuracy) <= 0.01;
  }
};

/// The minimum number of participants for a verdict on the best observer: with fewer, intervals are
/// too narrow.
inline constexpr int kMinForVerdict = 6;

/// The observer whose confusions are nearest to the participants'. Noise makes each observer as
/// uncertain as the participants if possible, because an observer without errors has no confusions
/// to compare.
struct CueMatch {
  Cue best = Cue::rms;    ///< with the smallest matched divergence
  Cue second = Cue::rms;  ///< with the second smallest matched divergence
  CueFigure difference;   ///< matched divergence of second minus that of best, bits
  /// The difference's interval excludes 0, with kMinForVerdict participants or more, and the
  /// best observer can be as uncertain as the participants.
  bool is_distinct = false;
};

/// One method: the counted trials that every observer could judge, and the participants' answers.
struct MethodCues {
  std::string method;
  int trials = 0;         ///< number of judged trials
  int without_trace = 0;  ///< counted trials left out because they have no trace
  int unjudged = 0;       ///< trials left out because no other trial has the same class
  std::vector<std::string> participants;  ///< with a judged trial, in the order of sessions
  std::vector<int> participant_trials;    ///< number of judged trials, by participant
  std::vector<double> human_accuracy;     ///< by participant, on the same trials
  int min_per_class = 0;                  ///< judged trials, minimum over classes and participants
  MeanEstimate human_mean;
  AnswerCounts human_confusion;  ///< of judged trials with a response
  /// By presented class. Trials without a response are wrong in accuracy, and left out of
  /// confusions and divergence.
  std::vector<int> no_response;
  std::vector<ObserverFigures> observers;  ///< in the order of kCues; empty without judged trials
  std::optional<CueMatch> match;           ///< nothing without a trial with a response
};

/// CueReport::plane_source if the plane's size comes from traces only.
inline constexpr const char* kPlaneFromTraces = "the farthest contact of all hands";

struct CueReport {
  bool simulated = false;
  double chance = 0.0;                ///< 1 / classes
  std::vector<std::string> classes;   ///< labels
  std::vector<MethodCues> methods;    ///< the methods that the study presents
  std::string plane_source;           ///< source of the plane's size
  std::vector<std::string> warnings;  ///< sentences that warn against misreading the numbers
};

struct CueOptions {
  int jobs = 0;                  ///< threads; 0: one for each core
  std::filesystem::path pack{};  ///< gives the plane's size; empty: the path in the key
  /// Called on the calling thread with the number of traces read so far.
  std::function<void(int done, int total)> progress{};
};

/// The number of traces that make_cues reads: one for each counted trial.
[[nodiscard]] int traces_to_read(const Outcomes& outcomes);

/// Computes the felt features of all counted trials from their traces; observers judge each trial
/// from the others. The result does not depend on the number of threads. Only the calling
/// thread uses the store. Memory: features of all trials, 200 bytes each, and 64 traces.
/// \throws VerificationError if a participant's key or a trace's seal does not open
/// \throws StoreError if the database cannot be read
[[nodiscard]] CueReport make_cues(const record::StudyStore& store, const study::StudyKey& key,
                                  const Outcomes& outcomes, const CueOptions& options = {});

}  // namespace touchtrial::analysis::identification
