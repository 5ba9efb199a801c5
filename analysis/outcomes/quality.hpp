/// \file The report on the quality of data collection. It uses only unencrypted data, needs no key
/// and reveals nothing about outcomes, so it may be read before a study is unblinded.
#pragma once

#include "analysis/outcomes/collection.hpp"
#include "record/study_store.hpp"

#include <cstdint>
#include <optional>
#include <string>
#include <vector>

namespace touchtrial::analysis {

/// The numbers of sessions by status. Each session is counted once: as erased, replaced or
/// excluded, in this order of precedence, otherwise by its state.
struct SessionCounts {
  int completed = 0;
  int open = 0;
  int stopped = 0;
  int excluded = 0;
  int replaced = 0;   ///< replaced by another participant, or restarted
  int erased = 0;     ///< withdrew and requested erasure
  int withdrawn = 0;  ///< among all of these: sessions of participants who withdrew, erased or not
  int pilot = 0;      ///< among all of these: pilot sessions of a study that is not a pilot
};

/// Quality of the trials of all unerased sessions.
struct TrialQuality {
  int presented = 0;
  int answered = 0;
  int no_response = 0;   ///< timed out
  int paused = 0;        ///< answered after a pause, without a reaction time
  int interrupted = 0;   ///< presentations interrupted other than by a pause, repeated or not
  int not_repeated = 0;  ///< interrupted trials that have not been repeated
  int with_trace = 0;
  int valid = 0;                         ///< trials with a trace that are valid by the study's rule
  std::int64_t overruns = 0;             ///< late servo ticks
  int with_overruns = 0;                 ///< trials with late servo ticks
  std::optional<double> lowest_rate_hz;  ///< lowest requested rate of a trace
};

/// The servo's timing in all real-time trials of unerased sessions.
struct ServoQuality {
  int trials = 0;
  double median_p99_us = 0.0;  ///< median of the trials' 99th percentiles of lateness
  double highest_p99_us = 0.0;
  double worst_us = 0.0;                ///< lateness of the latest tick of all trials
  double lowest_rate_hz = 0.0;          ///< lowest rate that the servo reached over a trial
  std::int64_t lost = 0;                ///< samples that did not reach their trace
  std::vector<std::string> scheduling;  ///< kinds of scheduling that servo threads obtained
};

struct QualityReport {
  std::string study;
  std::string protocol;
  record::StudyState state;
  bool simulated = false;
  bool pilot = false;
  int participants = 0;  ///< participants whose last visit counts, see session_counts
  int trials = 0;        ///< scored trials of these participants
  SessionCounts sessions;
  TrialQuality quality;
  std::optional<ServoQuality> servo;  ///< empty if no session was in real time
  bool visual = false;                ///< textures were seen on a screen, not felt
  Collection collection;              ///< participant flow, deviations, stations
  std::vector<std::string> notes{};   ///< chain_notes, and a notice about draft texts
};

/// "collecting", "closed" or "unblinded"
[[nodiscard]] std::string name_of(const record::StudyState& state);

[[nodiscard]] QualityReport make_quality(const record::StudyStore& store);

/// One JSON object, indented, ending with a line feed.
[[nodiscard]] std::string quality_json(const QualityReport& report);

}  // namespace touchtrial::analysis
