/// \file Several stations' file chains made one: a function of what they hold and of nothing else,
/// so that whoever has the stations' chains can make the collected one again and compare.
/// Source: docs/data-dictionary.md, "Collected studies"; docs/decisions/0041.
#pragma once

#include "protocols/store/event.hpp"
#include "protocols/store/study_store.hpp"

#include <compare>
#include <optional>
#include <span>
#include <string>
#include <vector>

namespace touchtrial::store {

/// A station's file chain as it stands in its own file, and what messages call the station.
struct StationChain {
  std::string name;
  std::vector<Event> events;
};

/// Where a session of a collected study comes from.
struct SessionPlace {
  int station = 0;  ///< from 1
  int own_session = 0;

  friend auto operator<=>(const SessionPlace&, const SessionPlace&) = default;
};

/// The chain that stations' chains come to.
struct CollectedChain {
  std::vector<Event> events;           ///< of session 0, hashed
  std::vector<SessionPlace> sessions;  ///< by number, from 1; those that have ended
  std::vector<SessionPlace> left_out;  ///< those that have not
};

/// What tells stations apart: the hash of the event with which the first session was opened, which
/// is the second of the chain. Nothing: no session was ever opened there.
[[nodiscard]] std::optional<Digest> station_identity(std::span<const Event> chain);

/// The order of stations: by their first sessions' openings (in simulated studies, whose times mean
/// nothing, by those sessions' enrolment numbers), and where those are the same, by identity.
/// \pre both have an identity
[[nodiscard]] bool comes_before(const StationChain& a, const StationChain& b);

/// The collected chain. It begins with the commitment of the first station. Then come the events of
/// the stations about sessions that have ended, each station's in their order: of those that are
/// next, the one at the earliest time, and in simulated studies, whose times mean nothing, the one
/// about the smallest enrolment number; a session waits for the replacement of whoever had its
/// participant id or enrolment number before, as long as anything else can come. Sessions are
/// numbered as they are opened here. At last, if it is so at all stations, that the study is
/// closed, and that it is unblinded. \param stations  in the order of comes_before, each chain
/// valid by itself (FileChain) \throws StoreError if they are not of one study, or a participant id
/// or enrolment number is
///   taken in two of them by sessions that nobody replaced, at whatever moment
/// \throws EventFault if an event's body is no such
[[nodiscard]] CollectedChain collected_chain(std::span<const StationChain> stations);

/// What `state` of a chain (the events of session 0) is: see StudyStore::state.
[[nodiscard]] StudyState state_of_chain(std::span<const Event> chain);

}  // namespace touchtrial::store
