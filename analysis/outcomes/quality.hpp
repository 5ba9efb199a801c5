/// \file The report on the quality of data collection. It uses only the unencrypted data and needs
/// no key. It reveals nothing about outcomes, so it may be seen before a study is unblinded.
#pragma once

#include "analysis/outcomes/collection.hpp"
#include "record/study_store.hpp"

#include <cstdint>
#include <optional>
#include <string>
#include <vector>

namespace touchtrial::analysis {

/// The numbers of sessions by status. Each session is counted once: as erased, else as replaced,
/// else as excluded, else by its state.
struct SessionCounts {
  int completed = 0;
  int open = 0;
  int stopped = 0;
  int excluded = 0;
  int replaced = 0;   ///< replaced by another participant, or restarted
  int erased = 0;     ///< withdrew and requested erasure
  int withdrawn = 0;  ///< of participants who withdrew, among all of these, erased or not
  int pilot = 0;      ///< pilot sessions among all of these, if the study itself is not a pilot
};

/// Quality of the trials of all sessions that are not erased.
struct TrialQuality {
  int presented = 0;
  int answered = 0;
  int no_response = 0;   ///< timed out
  int paused = 0;        ///< answered after a pause, so without a reaction time
  int interrupted = 0;   ///< interrupted presentations, repeated or not, except for pauses
  int not_repeated = 0;  ///< trials that were interrupted and not presented again yet
  int with_trace = 0;
  int valid = 0;              ///< trials with a trace that are valid by the study's rule
  std::int64_t overruns = 0;  ///< servo ticks that came late
  int with_overruns = 0;
  std::optional<double> lowest_rate_hz;  ///< lowest requested rate of a trace
};

/// The timing of the servo in all trials in real time of sessions that are not erased.
struct ServoQuality {
  int trials = 0;
  double median_p99_us = 0.0;  ///< median of the trials' 99th percentiles of lateness
  double highest_p99_us = 0.0;
  double worst_us = 0.0;                ///< lateness of the latest tick of all trials
  double lowest_rate_hz = 0.0;          ///< lowest rate that the servo reached over a trial
  std::int64_t lost = 0;                ///< samples that did not reach their trace
  std::vector<std::string> scheduling;  ///< scheduling that servo threads obtained, each kind once
};

struct QualityReport {
  std::string study;
  std::string protocol;
  record::StudyState state;
  bool simulated = false;
  bool pilot = false;
  int participants = 0;  ///< participants whose last visit's session counts, see session_counts
  int trials = 0;        ///< their scored trials
  SessionCounts sessions;
  TrialQuality quality;
  std::optional<ServoQuality> servo;  ///< empty if no session was in real time
  bool visual = false;                ///< textures were seen on a screen, not felt
  Collection collection;              ///< participant flow, deviations, stations
  std::vector<std::string> notes{};   ///< clocks that went back (chain_notes) and draft texts
};

/// "collecting", "closed" or "unblinded"
[[nodiscard]] std::string name_of(const record::StudyState& state);

[[nodiscard]] QualityReport make_quality(const record::StudyStore& store);

/// One JSON object, indented, ending with a line feed.
[[nodiscard]] std::string quality_json(const QualityReport& report);

}  // namespace touchtrial::analysis
