/// \file Incidents in sessions: interruptions, pauses, breaks, stops, notes, deviations, and later
/// decisions about the sessions.
#pragma once

#include "analysis/outcomes/study_events.hpp"
#include "record/person_texts.hpp"
#include "record/study_store.hpp"

#include <chrono>
#include <cstdint>
#include <map>
#include <optional>
#include <span>
#include <string>
#include <vector>

namespace touchtrial::analysis {

/// One event, which reveals nothing about stimuli and answers.
struct Incident {
  std::string participant;
  int session = 0;
  std::int64_t event = 0;  ///< sequence number in its chain
  record::EventKind kind{};
  std::optional<std::chrono::nanoseconds> at{};   ///< since the session's opening; empty: sealed
  std::optional<std::chrono::nanoseconds> utc{};  ///< since 1970; only on the file's chain
  std::optional<int> trial{};                     ///< the interrupted trial
  /// The reason of an interruption, the program's reason for a stop, the code of a deviation, the
  /// cause of a resumption, or "after-outcomes" for an exclusion after outcomes had been seen.
  std::string code{};
  std::string safety_fault{};
  std::string device_fault{};
  std::string text{};  ///< free text; empty if there is none or it is sealed
};

/// One event code that was sent to other instruments.
struct InstrumentMark {
  std::string participant;
  int session = 0;
  int trial = 0;                  ///< 0 outside trials
  int code = 0;                   ///< record::Mark
  std::chrono::nanoseconds at{};  ///< since the session's opening
  /// From the event to the end of the write on the serial line; empty without a line or if the
  /// write failed.
  std::optional<std::chrono::nanoseconds> latency{};
  std::optional<double> lsl_s{};  ///< time of the event on the Lab Streaming Layer's clock
  std::optional<double> lsl_uncertainty_s{};
};

/// The kinds of events that are incidents; kinds on sessions' chains come first.
[[nodiscard]] std::span<const record::EventKind> incident_kinds();

/// \param event  a stored or opened event of a session's or the file's chain
/// \param row  the session that the event is about
/// \return nothing if events of this kind are not incidents
[[nodiscard]] std::optional<Incident> incident_of(const record::Event& event,
                                                  const record::SessionRow& row);

/// The incidents of all unerased sessions, by session; incidents on the file's chain follow the
/// incidents on the session's chain.
/// \param keys  of the sessions whose texts and times are to be opened
/// \throws VerificationError, naming the event, if an event does not open
[[nodiscard]] std::vector<Incident> load_incidents(
    const StudyEvents& study, const std::map<int, record::PersonKeys>& keys = {});

/// The marks of all sessions in `keys`, by session and time. Marks are sealed.
/// \throws VerificationError, naming the event, if an event does not open
[[nodiscard]] std::vector<InstrumentMark> load_marks(const StudyEvents& study,
                                                     const std::map<int, record::PersonKeys>& keys);

}  // namespace touchtrial::analysis
