/// \file The append-only events of a study, and how each commits to the one before.
/// Source: docs/data-dictionary.md, "Events".
#pragma once

#include "core/bytes.hpp"
#include "core/hash.hpp"

#include <chrono>
#include <cstdint>
#include <optional>
#include <string>
#include <string_view>

namespace touchtrial::store {

/// What happened. The first group belongs to the file's chain, the second to a session's.
enum class EventKind {
  study_committed,
  session_opened,
  session_closed,
  participant_excluded,
  participant_withdrawn,
  study_closed,
  study_unblinded,
  participant_replaced,  ///< somebody takes a participant's place in the order of enrolment
  participant_noted,     ///< a remark or deviation, after a session or beside it

  opened,
  calibrated,
  instructed,
  practised,
  presented,
  first_contact,
  answered,
  interrupted,
  timed_out,
  trace_stored,
  break_taken,
  paused,
  stopped,
  noted,
  ticked,           ///< an item of the day sheet is done
  deviated,         ///< something was not as the study asks
  questioned,       ///< a questionnaire was filled in
  explored_again,   ///< the participant went back to the plane before answering
  block_restarted,  ///< a block's trials are void and come anew, in another order
  resumed,          ///< after a pause, or after the program ended
  closed,
};

/// The name stored in the database: the enumerator with hyphens, for instance "first-contact".
[[nodiscard]] std::string_view name_of(EventKind kind);
[[nodiscard]] std::optional<EventKind> event_kind_from_name(std::string_view name);
/// Whether this kind stands on the file's chain; all others stand on a session's.
[[nodiscard]] bool belongs_to_file_chain(EventKind kind);

/// One event. `body` is readable by anyone and says nothing of stimuli; `sealed` is ciphertext
/// under the participant's key.
struct Event {
  int session = 0;            ///< 0 for the file's chain, else the session's number, from 1
                              ///< (-1, -2, ...: a collected station's file chain)
  std::int64_t sequence = 0;  ///< place in its chain, from 0
  EventKind kind{};
  std::chrono::nanoseconds at{};  ///< session: since its opening, monotonic; file: UTC since 1970
  std::string body;               ///< compact JSON object with sorted keys
  Bytes sealed;                   ///< empty if the event has no secret part
  Digest previous{};              ///< hash of the event before; zeros for the first
  Digest hash{};                  ///< event_hash of this one
  /// In a collected database, where sessions have other numbers than in the station's file that
  /// they come from: the number there. Empty: the same.
  std::optional<int> renumbered_from{};

  /// The session's number in the file that it was recorded in. Hash and sealed part are bound to
  /// it.
  [[nodiscard]] int own_session() const noexcept { return renumbered_from.value_or(session); }
};

/// SHA-256 over own_session() and all other members, ciphertext included.
[[nodiscard]] Digest event_hash(const Event& event);

}  // namespace touchtrial::store
