/// \file Builds one file chain from several stations' file chains. The result depends only on their
/// content, so that anybody who has the stations' chains can rebuild it and compare. Source:
/// docs/data-dictionary.md, "Collected studies"; docs/decisions/0041.
#pragma once

#include "record/event.hpp"

#include <compare>
#include <optional>
#include <span>
#include <string>
#include <vector>

namespace touchtrial::record {

/// A station's file chain as stored at the station.
struct StationChain {
  std::string name;  ///< of the station, for messages
  std::vector<Event> events;
};

/// The origin of a collected study's session.
struct SessionPlace {
  int station = 0;      ///< from 1
  int own_session = 0;  ///< its number at that station

  friend auto operator<=>(const SessionPlace&, const SessionPlace&) = default;
};

/// The chain collected from stations' chains.
struct CollectedChain {
  std::vector<Event> events;           ///< the file's chain (session 0), with hashes
  std::vector<SessionPlace> sessions;  ///< sessions that have ended, by their new numbers, from 1
  std::vector<SessionPlace> left_out;  ///< sessions that have not ended
};

/// A station's identity: the hash of the event that opened its first session; nothing if there is
/// none.
[[nodiscard]] std::optional<Digest> station_identity(std::span<const Event> chain);

/// The order of stations: by the time at which their first sessions were opened (by those sessions'
/// enrolment numbers in simulated studies, whose times are meaningless), then by identity.
/// \pre both have an identity
[[nodiscard]] bool comes_before(const StationChain& a, const StationChain& b);

/// Builds the collected chain:
/// - First comes the commitment of the first station, without the station.
/// - Then come the stations' events about sessions that have ended. Each station's events keep
///   their order. Of the stations' next events, the earliest comes first; in simulated studies,
///   whose times are meaningless, the one about the smallest enrolment number. As long as another
///   event is possible, the opening of a session waits until the former holder of its participant
///   id or enrolment number has been replaced. Sessions are numbered in the order in which they are
///   opened here.
/// - Then come the stations' unblindings of single participants, with the sessions that they show.
/// - Last come the closing of the study, if it is closed at all stations, and its unblinding, if it
///   is unblinded at all stations with sessions.
/// \param stations  in the order of comes_before, each chain valid by itself (checked_file_chain)
/// \throws StoreError if they do not belong to one study, or two of them used one participant id or
///   enrolment number for sessions that were never replaced
/// \throws EventFault if an event's body cannot be read
[[nodiscard]] CollectedChain collected_chain(std::span<const StationChain> stations);

}  // namespace touchtrial::record
