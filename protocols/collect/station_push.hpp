/// \file Pushing a station's finished sessions into a PostgreSQL database. Source:
/// docs/several-stations.md, docs/decisions/0042.
#pragma once

#include "core/cipher.hpp"
#include "protocols/collect/enrolment_balance.hpp"
#include "protocols/collect/server_address.hpp"
#include "protocols/collect/stations.hpp"

#include <chrono>
#include <cstdint>
#include <functional>
#include <optional>
#include <string>
#include <vector>

namespace touchtrial::collect {

/// A session of the station, as a report names it.
struct PushedSession {
  int session = 0;  ///< its own number
  std::string participant;
  int enrolment = 0;

  friend bool operator==(const PushedSession&, const PushedSession&) = default;
};

struct PushReport {
  int station = 0;                       ///< its number on the server; 0: it has none yet
  std::vector<PushedSession> pushed;     ///< by this push, in the order of their ends
  std::vector<PushedSession> left_open;  ///< not finished, and left for later
  /// Replaced or withdrawn before they ended: they cannot go on, and stay at the station.
  std::vector<PushedSession> cut_short;
  int already_there = 0;          ///< finished sessions that the server had before
  std::int64_t chain_events = 0;  ///< events of the file chain that this push added
  std::int64_t ahead = 0;         ///< events that the server has beyond this file, an older copy
  int reconnections = 0;          ///< attempts after the connection was lost
  int keys_destroyed = 0;         ///< keys of participants who withdrew
  bool keys_wiped = false;  ///< whether the destroyed keys are no longer in the table's file either
  int keys_restored = 0;    ///< keys of earlier sessions that were deleted or changed on the server
};

struct PushOptions {
  /// Finds out what would be pushed and whether anything prevents it, and changes nothing.
  bool dry_run = false;
  /// The investigator's keys. If given, the sealed ends of sessions are held against their chains.
  std::optional<BoxKeys> investigator{};
  /// Called with the number of sessions pushed so far and the number of sessions to push.
  std::function<void(int, int)> progress{};
  /// Waits before another attempt; empty: this thread sleeps.
  std::function<void(std::chrono::milliseconds)> wait{};
};

/// Pushes what the server does not have, each session in a transaction of its own that also checks
/// what arrived. It can be broken off anywhere and run again; any number of stations may push at
/// once. The first push makes the tables.
/// \param station  StudyStore::first_fault found no fault in it
/// \param report  says what has been done, also if this throws
/// \throws StoreError, naming the server and the reason: another study there, a participant id or
///   enrolment number that another session has (which), a chain that differs from the server's
///   copy, missing rights, or a connection that stayed lost
void push_station(StationFile& station, const ServerAddress& server, const PushOptions& options,
                  PushReport& report);

/// All sessions on a server, of every station.
/// \throws StoreError if they cannot be read
[[nodiscard]] std::vector<EnrolledSession> sessions_on_server(const ServerAddress& server);

}  // namespace touchtrial::collect
