/// \file What sessions had besides their trials: interruptions, pauses, breaks, stops, notes,
/// deviations, and what was decided about them later.
#pragma once

#include "analysis/outcomes/study_events.hpp"
#include "record/person_texts.hpp"
#include "record/study_store.hpp"

#include <chrono>
#include <cstdint>
#include <map>
#include <optional>
#include <string>
#include <vector>

namespace touchtrial::analysis {

/// One event. It says nothing about stimuli and answers.
struct Incident {
  std::string participant;
  int session = 0;
  std::int64_t event = 0;  ///< its place in its chain
  record::EventKind kind{};
  std::optional<std::chrono::nanoseconds> at{};   ///< since the session's opening; empty: sealed
  std::optional<std::chrono::nanoseconds> utc{};  ///< since 1970, of an event on the file's chain
  std::optional<int> trial{};                     ///< that was interrupted
  /// Why: the reason of an interruption, the program's reason for a stop, the code of a deviation,
  /// what a session was resumed after, "after-outcomes" for an exclusion after they had been seen.
  std::string code{};
  std::string safety_fault{};
  std::string device_fault{};
  std::string text{};  ///< what was typed; empty: nothing, or it is sealed
};

/// One event code that other instruments were told of.
struct InstrumentMark {
  std::string participant;
  int session = 0;
  int trial = 0;                  ///< 0 outside trials
  int code = 0;                   ///< record::Mark
  std::chrono::nanoseconds at{};  ///< since the session's opening
  /// To the end of the write on the serial line; empty: no line, or it took nothing.
  std::optional<std::chrono::nanoseconds> latency{};
  std::optional<double> lsl_s{};  ///< time of the event on the Lab Streaming Layer's clock
  std::optional<double> lsl_uncertainty_s{};
};

/// \param event  stored or opened, of a session's or the file's chain
/// \param row  of the session that it is about
/// \return nothing if an event of this kind is no incident
[[nodiscard]] std::optional<Incident> incident_of(const record::Event& event,
                                                  const record::SessionRow& row);

/// The incidents of all sessions that are not erased, by session; those on the file's chain follow
/// the session's own.
/// \param keys  of the sessions whose texts and times are opened
/// \throws VerificationError, naming the event, if one does not open
[[nodiscard]] std::vector<Incident> load_incidents(
    const StudyEvents& study, const std::map<int, record::PersonKeys>& keys = {});

/// The marks of all sessions whose key is given, by session and time: what instruments were told,
/// and when, is sealed.
/// \throws VerificationError, naming the event, if one does not open
[[nodiscard]] std::vector<InstrumentMark> load_marks(const StudyEvents& study,
                                                     const std::map<int, record::PersonKeys>& keys);

}  // namespace touchtrial::analysis
