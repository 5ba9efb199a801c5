/// \file How collection goes, without a word on outcomes: what may be seen before a study is
/// unblinded. Made from what the database holds in clear; it takes no key.
#pragma once

#include "analysis/collection.hpp"
#include "protocols/store/study_store.hpp"

#include <cstdint>
#include <optional>
#include <string>
#include <vector>

namespace touchtrial::analysis {

/// Sessions by how they stand, each counted once: withdrawn, else replaced, else excluded, else by
/// its state.
struct SessionCounts {
  int completed = 0;
  int open = 0;
  int stopped = 0;
  int excluded = 0;
  int replaced = 0;  ///< somebody took the place, or the session was restarted
  int withdrawn = 0;
  int pilot = 0;  ///< of all these, in a study that is no pilot
};

/// Of all sessions' trials but the withdrawn ones'.
struct TrialQuality {
  int presented = 0;
  int answered = 0;
  int no_response = 0;           ///< time ran out
  int interrupted = 0;           ///< and not repeated yet
  int changed = 0;               ///< answers changed before they were given
  std::vector<int> by_position;  ///< answers, by the picture's place in the layout: bias of hand
  int with_trace = 0;
  int valid = 0;              ///< of those with a trace, by the study's rule
  std::int64_t overruns = 0;  ///< servo ticks that came late
  int with_overruns = 0;
  std::optional<double> lowest_rate_hz;  ///< of a trace: as it was asked of the servo
};

/// How the servo kept its time, of all trials in real time whose participant has not withdrawn.
struct ServoQuality {
  int trials = 0;
  double median_p99_us = 0.0;  ///< of the trials' 99th percentiles of lateness
  double highest_p99_us = 0.0;
  double worst_us = 0.0;                ///< the latest tick of all
  double lowest_rate_hz = 0.0;          ///< that the servo had, over a trial
  std::int64_t lost = 0;                ///< samples that did not reach their trace
  std::vector<std::string> scheduling;  ///< what sessions' servo threads obtained, each kind once
};

struct QualityReport {
  std::string study;
  std::string protocol;
  store::StudyState state;
  bool simulated = false;
  bool pilot = false;
  int participants = 0;  ///< whose session is completed, not excluded, not withdrawn
  int trials = 0;        ///< their scored trials
  SessionCounts sessions;
  TrialQuality quality;
  std::optional<ServoQuality> servo;  ///< nothing if no session was in real time
  bool visual = false;                ///< sessions were seen on a screen, not felt
  Collection collection;              ///< participant flow, deviations, stations
};

/// "collecting", "closed" or "unblinded"
[[nodiscard]] std::string name_of(const store::StudyState& state);

[[nodiscard]] QualityReport make_quality(const store::StudyStore& store);

/// One JSON object, indented, ending with a line feed.
[[nodiscard]] std::string quality_json(const QualityReport& report);

/// A page for a terminal, ending with a line feed.
[[nodiscard]] std::string quality_text(const QualityReport& report);

/// One line: how many enrolled, and where those went who are not analysed. Empty if nobody did.
[[nodiscard]] std::string flow_text(const ParticipantFlow& flow);

}  // namespace touchtrial::analysis
