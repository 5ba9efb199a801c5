/// \file Which cue was it? What ideal observers, who feel what each participant's hand felt, would
/// have answered, beside what participants answered. Source: docs/cues.md. Format of the JSON:
/// docs/data-dictionary.md, "Cues".
#pragma once

#include "analysis/statistics/participant_mean.hpp"
#include "analysis/statistics/proportion.hpp"

#include <array>
#include <filesystem>
#include <functional>
#include <optional>
#include <string>
#include <string_view>
#include <vector>

namespace touchtrial::design {
struct StudyKey;
}

namespace touchtrial::store {
class StudyStore;
}

namespace touchtrial::analysis {

struct Outcomes;

/// What an ideal observer may use of a trial: the strength of the force alone, the shape of its
/// spectrum alone, or all felt features.
enum class Cue { rms, spectrum, everything };
inline constexpr std::array<Cue, 3> kCues{Cue::rms, Cue::spectrum, Cue::everything};

/// "rms", "spectrum", "everything"
[[nodiscard]] std::string_view name_of(Cue cue) noexcept;
/// For tables and legends: "force strength (rms)", "spectrum's shape", "everything felt"
[[nodiscard]] std::string_view title_of(Cue cue) noexcept;

/// A figure with its interval from a bootstrap over participants.
struct CueFigure {
  std::optional<double> value;
  std::optional<Interval> interval;  ///< none with fewer than two participants
};

/// Answers: rows are the presented class, columns the answered one. Ties are split, so
/// counts need not be whole.
using AnswerCounts = std::vector<std::vector<double>>;

/// One observer's answers to one method's trials.
struct ObserverFigures {
  Cue cue = Cue::rms;
  AnswerCounts confusion;          ///< of all judged trials
  std::vector<double> accuracy;    ///< by participant, as in MethodCues::participants
  MeanEstimate mean;               ///< of `accuracy`: what was available
  CueFigure efficiency;            ///< participants' mean accuracy over this observer's
  CueFigure corrected_efficiency;  ///< the same of what both have above chance
  /// Mean over presented classes of the Jensen-Shannon divergence between participants' and
  /// observer's answers, bits: 0 if they confuse alike, at most 1.
  CueFigure divergence;
  /// Noise of the sense (a Weber fraction) with which the observer is right as often as the
  /// participants; 0 if it is not right more often without.
  double matched_noise = 0.0;
  AnswerCounts matched_confusion;  ///< with that noise
  CueFigure matched_divergence;    ///< the divergence from these
};

/// Fewer participants leave open which observer confuses as they do, whatever the interval says: a
/// bootstrap of so few is too narrow.
inline constexpr int kFewestForVerdict = 6;

/// Which observer confuses as participants do, each made as uncertain as they are: an observer that
/// is never wrong has no confusions to be compared.
struct CueMatch {
  Cue best = Cue::rms;  ///< of the least matched divergence
  Cue second = Cue::rms;
  CueFigure difference;     ///< second's matched divergence less best's, bits
  bool told_apart = false;  ///< its interval does not hold 0, of kFewestForVerdict
};

/// One method: the counted trials that every observer could judge, and who felt them.
struct MethodCues {
  std::string method;
  int trials = 0;         ///< judged
  int without_trace = 0;  ///< counted, but left out here for want of a readable trace
  int unjudged = 0;       ///< left out because no other trial had their class
  std::vector<std::string> participants;  ///< with a judged trial, in the order of sessions
  std::vector<int> participant_trials;    ///< judged, by participant
  std::vector<double> human_accuracy;     ///< by participant, on the same trials
  int fewest_of_a_class = 0;  ///< judged trials of one class by one participant, at least
  MeanEstimate human_mean;
  AnswerCounts human_confusion;  ///< of judged trials with a response
  /// By presented class; wrong in accuracy, left out of confusions and divergence.
  std::vector<int> no_response;
  std::vector<ObserverFigures> observers;  ///< in the order of kCues; empty without judged trials
  std::optional<CueMatch> match;           ///< none without a trial with a response
};

struct CueReport {
  bool simulated = false;
  double chance = 0.0;                ///< 1 / classes
  std::vector<std::string> classes;   ///< labels
  std::vector<MethodCues> methods;    ///< those that the study presents
  std::string plane_source;           ///< where the plane's size came from
  std::vector<std::string> warnings;  ///< what a reader could take a figure for, wrongly
};

struct CueOptions {
  int jobs = 0;                  ///< threads; 0: as many as there are
  std::filesystem::path pack{};  ///< for the plane's size; empty: where the key says
  /// Told on the calling thread how many traces are read.
  std::function<void(int done, int of)> progress{};
};

/// Traces that make_cues would read: one for each counted trial.
[[nodiscard]] int traces_to_read(const Outcomes& outcomes);

/// Reads and feels the traces of all counted trials and lets the observers judge each by the
/// others. The result does not depend on the number of threads; all are used, and only the calling
/// one uses the store. Memory: features of all trials, 200 bytes each, and 64 traces.
/// \throws VerificationError if a participant's key or a trace's seal does not open
/// \throws StoreError if the database cannot be read
[[nodiscard]] CueReport make_cues(const store::StudyStore& store, const design::StudyKey& key,
                                  const Outcomes& outcomes, const CueOptions& options = {});

}  // namespace touchtrial::analysis
