/// \file Incidents of sessions: interruptions, pauses, breaks, stops, notes, deviations, and later
/// decisions about them.
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

/// One event. It reveals nothing about stimuli and answers.
struct Incident {
  std::string participant;
  int session = 0;
  std::int64_t event = 0;  ///< its place in its chain
  record::EventKind kind{};
  std::optional<std::chrono::nanoseconds> at{};   ///< since the session's opening; empty: sealed
  std::optional<std::chrono::nanoseconds> utc{};  ///< since 1970, of an event on the file's chain
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
  /// To the end of the write on the serial line; empty if there is no line or it accepted nothing.
  std::optional<std::chrono::nanoseconds> latency{};
  std::optional<double> lsl_s{};  ///< time of the event on the Lab Streaming Layer's clock
  std::optional<double> lsl_uncertainty_s{};
};

/// The kinds of events that are incidents, those of a session first.
[[nodiscard]] std::span<const record::EventKind> incident_kinds();

/// \param event  stored or opened, of a session's or the file's chain
/// \param row  of the session that it is about
/// \return nothing if events of this kind are not incidents
[[nodiscard]] std::optional<Incident> incident_of(const record::Event& event,
                                                  const record::SessionRow& row);

/// The incidents of all sessions that are not erased, by session; those on the file's chain follow
/// the session's own.
/// \param keys  of the sessions whose texts and times are opened
/// \throws VerificationError, naming the event, if one does not open
[[nodiscard]] std::vector<Incident> load_incidents(
    const StudyEvents& study, const std::map<int, record::PersonKeys>& keys = {});

/// The marks of all sessions whose key is given, by session and time. Marks are sealed.
/// \throws VerificationError, naming the event, if one does not open
[[nodiscard]] std::vector<InstrumentMark> load_marks(const StudyEvents& study,
                                                     const std::map<int, record::PersonKeys>& keys);

}  // namespace touchtrial::analysis
