/// \file Events, traces and keys in the tables of an SQLite file. Private to
/// record. All functions throw SQLite::Exception; call them inside Database::run.
#pragma once

#include "record/database.hpp"
#include "record/fold.hpp"
#include "record/sealing.hpp"

#include <cstdint>
#include <exception>
#include <functional>
#include <map>
#include <optional>
#include <span>
#include <vector>

namespace touchtrial::record {

using EventVisitor = std::function<void(const Event&)>;

void insert_event(const Database& database, const Event& event);
void insert_trace(const Database& database, const SealedTrace& trace);
/// Inserts the two keys, except a missing one.
void insert_keys(const Database& database, int session, const WrappedKeys& keys);
void insert_station_key(const Database& database, int session, const Bytes& stored_key);

[[nodiscard]] WrappedKeys read_keys(const Database& database, int session);

/// Selects events that match all given members.
struct EventFilter {
  std::optional<std::int64_t> session{};
  std::span<const EventKind> kinds{};  ///< any of these; empty: all
};

/// Calls `visit` for the selected events, by session and sequence. `visit` may use the database.
/// \throws EventFault if a row is not a valid event: unknown kind, impossible number, wrong length
///   of a hash
void for_each_event(const Database& database, const EventFilter& filter, const EventVisitor& visit);
/// The same for all events of one chain.
void for_each_event(const Database& database, std::int64_t session, const EventVisitor& visit);
/// The events of one chain, in order, as far as they can be read.
/// \param fault  set to the exception that for_each_event would throw at the first unreadable event
[[nodiscard]] std::vector<Event> read_events(const Database& database, int session,
                                             std::exception_ptr& fault);
/// One event, if it exists.
/// \throws as for_each_event
[[nodiscard]] std::optional<Event> read_event(const Database& database, int session,
                                              std::int64_t sequence);

/// The last event of one chain, if any; earlier events are not read.
/// \throws as for_each_event
[[nodiscard]] std::optional<Event> read_last_event(const Database& database, int session);

/// The number of every session that has events, except 0, ascending.
[[nodiscard]] std::vector<std::int64_t> sessions_with_events(const Database& database);

/// Every session's row, from its events and the file's chain; by number.
/// \throws EventFault if an event cannot be read, or cannot follow the earlier ones
[[nodiscard]] std::map<int, SessionRow> read_sessions(const Database& database);
/// Every trial's row, by session and trial.
/// \throws as read_sessions
[[nodiscard]] std::vector<TrialRow> read_trials(const Database& database);

}  // namespace touchtrial::record
