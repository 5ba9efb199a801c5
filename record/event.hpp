/// \file The append-only events of a study, each of which commits to the previous one. Source:
/// docs/data-dictionary.md, "Events".
#pragma once

#include "core/bytes.hpp"
#include "core/hash.hpp"
#include "core/public_keys.hpp"

#include <algorithm>
#include <chrono>
#include <cstdint>
#include <optional>
#include <string>
#include <string_view>

namespace touchtrial::record {

/// The kind of an event; event_kinds.cpp has a row for each. The first group belongs to the file's
/// chain, the second to a session's.
enum class EventKind {
  study_committed,
  session_opened,
  session_closed,
  participant_excluded,
  participant_withdrawn,
  study_closed,
  study_unblinded,
  participant_replaced,
  participant_noted,
  heads_kept,
  loss_accepted,

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
  ticked,
  deviated,
  questioned,
  explored_again,
  block_restarted,
  resumed,
  marked,
  closed,
};

/// The name stored in the database, for instance "first-contact".
[[nodiscard]] std::string_view name_of(EventKind kind);
[[nodiscard]] std::optional<EventKind> event_kind_from_name(std::string_view name);
/// Whether events of this kind belong to the file's chain; all others belong to a session's.
[[nodiscard]] bool belongs_to_file_chain(EventKind kind);

/// One event. `body` is unencrypted and reveals nothing about stimuli and answers. `sealed` is
/// ciphertext: in a session's event its time and the private part of its body (sealing.hpp), in an
/// event of the file's chain the texts about a person (person_texts.hpp). An opened event is
/// decrypted.
struct Event {
  int session = 0;            ///< 0: the file's chain; from 1: a session;
                              ///< -1, -2, ...: the file chain of a collected station
  std::int64_t sequence = 0;  ///< place in its chain, from 0
  EventKind kind{};
  /// File's chain: UTC since 1970. Session: 0 as stored; time since the session opened if opened.
  std::chrono::nanoseconds at{};
  std::string body;   ///< compact JSON object with sorted keys
  Bytes sealed;       ///< empty if the event is opened, or not about a person
  Digest previous{};  ///< hash of the previous event; zeros for the first
  Digest hash{};      ///< event_hash of this event
  /// File's chain: the station's or the investigator's Ed25519 signature, see signed_event. Empty
  /// in sessions, and in the part of a collected study's chain that follows from its stations'
  /// chains.
  Bytes signature{};
  /// In a collected database, the session's number in the station's file; empty if it is the same.
  std::optional<int> renumbered_from{};

  /// The session's number in the file that it was recorded in, to which hash and sealed part are
  /// bound.
  [[nodiscard]] int own_session() const noexcept { return renumbered_from.value_or(session); }
  /// The event's time, unless it is sealed.
  [[nodiscard]] std::optional<std::chrono::nanoseconds> time() const {
    return session <= 0 || sealed.empty() ? std::optional(at) : std::nullopt;
  }
};

/// BLAKE2b over own_session() and all other members except the signature.
[[nodiscard]] Digest event_hash(const Event& event);

/// The event that follows `last` on a file's chain, with its hash.
/// \param last  null: the event is the first
[[nodiscard]] Event next_on_file(const Event* last, EventKind kind, std::chrono::nanoseconds at,
                                 std::string body, Bytes sealed = {});

/// The event with its signature, which vouches for the whole chain up to here.
[[nodiscard]] Event signed_event(Event event, const Signer& signer);
[[nodiscard]] bool is_event_signed_by(const PublicKey& signer, const Event& event);

/// The end of a chain.
struct ChainHead {
  std::int64_t length = 0;  ///< number of events
  Digest hash{};            ///< of the last event; zeros if there is none

  friend bool operator==(const ChainHead&, const ChainHead&) = default;
};

/// The growing end of one chain. It checks only links; `fold` checks what events mean.
class ChainLink {
 public:
  /// \param session  as Event::session
  explicit ChainLink(int session) : ChainLink(session, std::max(session, 0)) {}
  /// \param own_session  Event::own_session of its events
  ChainLink(int session, int own_session) : session_(session), own_session_(own_session) {}

  /// The end of a stored chain.
  /// \param last  its last event
  [[nodiscard]] static ChainLink after(const Event& last);

  /// \return why `next` cannot follow; nothing if it can
  [[nodiscard]] std::optional<std::string> link_fault(const Event& next) const;

  /// Adds the next event.
  /// \throws EventFault if it cannot follow; the chain is then as it was
  void extend(const Event& next);

  [[nodiscard]] std::int64_t length() const noexcept { return length_; }
  /// Hash of the last event; zeros before the first.
  [[nodiscard]] const Digest& head() const noexcept { return head_; }

 private:
  int session_;
  int own_session_;
  std::int64_t length_ = 0;
  Digest head_{};
};

}  // namespace touchtrial::record
