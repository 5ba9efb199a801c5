/// \file Derives the rows of sessions and trials from stored or opened events. Only opened events
///   yield answers and times.
#pragma once

#include "record/event.hpp"
#include "record/session_bodies.hpp"

#include <array>
#include <chrono>
#include <cstddef>
#include <cstdint>
#include <map>
#include <optional>
#include <string>
#include <string_view>
#include <utility>

namespace touchtrial::record {

enum class SessionState { open, completed, stopped };
/// Names in files, in the order of the enumerators.
inline constexpr std::array<std::string_view, 3> kSessionStates = {"open", "completed", "stopped"};
[[nodiscard]] constexpr std::string_view name_of(SessionState state) {
  return kSessionStates[static_cast<std::size_t>(state)];
}

struct SessionRow {
  int session = 0;  ///< from 1
  std::string participant;
  int enrolment = 0;
  SessionState state{};
  bool simulated = false;
  bool pilot = false;
  bool excluded = false;
  bool withdrawn = false;  ///< the participant has withdrawn
  bool erased = false;     ///< the participant's key is destroyed
  std::string device;
  /// The participant who inherited the enrolment number; the same participant if the session was
  /// restarted; empty: not replaced.
  std::string replaced_by{};
  /// The number in the file that it was recorded in (Event::own_session): participant keys and
  /// sealed boxes are bound to it.
  int own_session = 0;
  int station = 0;  ///< the station that it was collected from, from 1; 0: recorded in this file
  int visit = 1;    ///< of the participant, from 1

  /// Whether the session's own state allows it to continue.
  [[nodiscard]] bool can_resume() const noexcept {
    return state == SessionState::open && !withdrawn && replaced_by.empty();
  }
  friend bool operator==(const SessionRow&, const SessionRow&) = default;
};

/// The state of a trial. `voided`: its block was restarted, so that it no longer counts and is
/// never presented again.
enum class TrialState { presented, answered, timed_out, interrupted, voided };
inline constexpr std::array<std::string_view, 5> kTrialStates = {
    "presented", "answered", "timed-out", "interrupted", "voided"};
[[nodiscard]] constexpr std::string_view name_of(TrialState state) {
  return kTrialStates[static_cast<std::size_t>(state)];
}

struct TrialRow {
  int session = 0;
  int trial = 0;  ///< from 1
  int block = 0;
  TrialState state{};
  bool valid = true;
  HandWindows hand{};
  std::int64_t overruns = 0;
  double rate_hz = 0.0;  ///< of the trace; 0: no trace
  int explorations = 1;  ///< of the last presentation

  // These members are set only from opened events; otherwise they are 0 or empty, as in the tables.
  std::chrono::nanoseconds presented_at{};
  std::optional<std::chrono::nanoseconds> contact_at;
  std::optional<std::chrono::nanoseconds> answered_at;
  std::optional<Answer> answer;  ///< empty: no response
  std::optional<int> confidence;
  std::optional<std::string> kind;  ///< the trial's kind in an adaptive order, as in the schedule
  std::optional<int> track;         ///< from 1; 0: none
  std::optional<int> level;         ///< index into the track's levels
  std::optional<int> target;        ///< index of the right choice
  std::int64_t samples = 0;

  /// Whether the session was paused between the end of the exploration and the answer.
  bool paused = false;

  /// Time from plane-on to the answer; empty if there is no answer, or if `paused`.
  [[nodiscard]] std::optional<std::chrono::nanoseconds> reaction_time() const;
  /// Time from the first contact to the answer; empty in the same cases and without contact.
  [[nodiscard]] std::optional<std::chrono::nanoseconds> from_contact() const;

  [[nodiscard]] bool has_trace() const noexcept { return rate_hz > 0.0; }
  friend bool operator==(const TrialRow&, const TrialRow&) = default;
};

using TrialId = std::pair<int, int>;  ///< numbers of session and trial

/// Some or all derived rows.
struct DerivedRows {
  std::map<int, SessionRow> sessions;
  std::map<TrialId, TrialRow> trials;
};

/// The session that an event is about: its own, or the one that an event of a file's chain names.
/// \return 0 if events of this kind name no session
/// \throws EventFault if the event's body lacks its session
[[nodiscard]] int session_about(const Event& event);

/// Updates `rows` with one more stored or opened event. Sessions may be folded in any order, the
/// events of each session in order, and the file's chain after the sessions that it names.
/// \throws EventFault if the event's body cannot be read, or the event cannot follow the earlier
///   ones; `rows` is then unchanged
void fold(DerivedRows& rows, const Event& event);
/// The same for a trace-stored event whose body was read already.
void fold(DerivedRows& rows, const Event& event, const TraceBody& body);

}  // namespace touchtrial::record
