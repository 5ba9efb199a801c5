/// \file Events, traces and derived rows in the tables of an SQLite file. Private to
/// protocols/store. All functions throw SQLite::Exception; call them inside Database::run.
#pragma once

#include "protocols/store/database.hpp"
#include "protocols/store/event.hpp"
#include "protocols/store/fold.hpp"
#include "protocols/store/session_recorder.hpp"

#include <cstdint>
#include <functional>
#include <optional>
#include <span>
#include <vector>

namespace touchtrial::store {

using EventVisitor = std::function<void(const Event&)>;

void insert_event(const Database& database, const Event& event);
void insert_trace(const Database& database, const SealedTrace& trace);

/// Which events are asked for; what is not given may be anything.
struct EventFilter {
  std::optional<std::int64_t> session;
  std::optional<std::int64_t> sequence;
  std::optional<EventKind> kind;
  std::span<const EventKind> kinds{};  ///< any of these; empty: as `kind` says
};

/// Calls `visit` for the events that the filter names, by session and sequence; it may ask anything
/// of the database.
/// \throws EventFault if a row is no event: unknown kind, or a hash of another length
void for_each_event(const Database& database, const EventFilter& filter, const EventVisitor& visit);
/// All of one chain.
void for_each_event(const Database& database, std::int64_t session, const EventVisitor& visit);
/// One event, if it exists. \throws the same
[[nodiscard]] std::optional<Event> read_event(const Database& database, int session,
                                              std::int64_t sequence);

/// Every number but 0 that an event gives as its session, ascending.
[[nodiscard]] std::vector<std::int64_t> sessions_with_events(const Database& database);

/// By session. \throws EventFault if a row holds what no event gives rise to
[[nodiscard]] std::vector<SessionRow> read_sessions(const Database& database);
/// By session and trial. \throws the same
[[nodiscard]] std::vector<TrialRow> read_trials(const Database& database);

/// The rows that `scope` names, as far as they exist. \throws the same
[[nodiscard]] DerivedRows read_rows(const Database& database, const FoldScope& scope);
/// Adds or changes every row of `rows`.
void write_rows(const Database& database, const DerivedRows& rows);
void delete_all_rows(const Database& database);

}  // namespace touchtrial::store
