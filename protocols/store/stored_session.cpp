#include "protocols/store/stored_session.hpp"

#include "protocols/store/payload_json.hpp"
#include "protocols/store/rows.hpp"

#include <utility>

namespace touchtrial::store {
namespace {

void require_link(const ChainLink& chain, const Event& event) {
  if (const auto fault = chain.broken_by(event)) {
    throw EventFault(event.session, event.sequence, *fault);
  }
}

/// A trace comes with the event that names it, and with no other.
void require_match(const Event& event, const SealedTrace* trace) {
  if (event.kind != EventKind::trace_stored) {
    if (trace == nullptr) return;
    throw EventFault(event.session, event.sequence, "an event of this kind has no trace");
  }
  const int trial = body_of(event, trace_body_from_json).trial;
  if (trace == nullptr || trace->session != event.session || trace->trial != trial) {
    throw EventFault(event.session, event.sequence,
                     "the trace of trial " + std::to_string(trial) + " is missing");
  }
}

}  // namespace

StoredSession::StoredSession(StoredStudy& study, int session, Bytes wrapped_key, UtcClock utc)
    : StoredSession(study, ChainLink(session), std::move(wrapped_key), std::move(utc)) {}

StoredSession::StoredSession(StoredStudy& study, const Event& last, UtcClock utc)
    : StoredSession(study, ChainLink::after(last), {}, std::move(utc)) {}

StoredSession::StoredSession(StoredStudy& study, ChainLink chain, Bytes wrapped_key, UtcClock utc)
    : study_(study), chain_(chain), wrapped_key_(std::move(wrapped_key)), utc_(std::move(utc)) {
  if (!utc_) {
    utc_ = [] {
      return std::chrono::nanoseconds(std::chrono::system_clock::now().time_since_epoch());
    };
  }
}

void StoredSession::accept(const Event& event, const std::optional<SealedTrace>& trace) {
  const RecordedEvent recorded{event, trace};
  accept_together(std::span(&recorded, 1));
}

void StoredSession::accept_together(std::span<const RecordedEvent> events) {
  ChainLink chain = chain_;
  study_.database().run([&] {
    SQLite::Transaction transaction = study_.database().write_transaction();
    if (chain_.length() > 0) refuse_if_others_wrote(events.front().event.session);
    for (const auto& [event, trace] : events) {
      require_link(chain, event);
      require_match(event, trace ? &*trace : nullptr);
      store(event, trace, chain.length() == 0);
      chain.extend(event);
    }
    transaction.commit();
  });
  chain_ = chain;
}

/// Two programs in one session would each lose what the other recorded.
void StoredSession::refuse_if_others_wrote(int session) const {
  const ChainHead stored = study_.head(session);
  if (stored.length == chain_.length() && stored.hash == chain_.head()) return;
  study_.refuse("session " + std::to_string(session) +
                " was continued by another program, which has it now; end this one");
}

void StoredSession::store(const Event& event, const std::optional<SealedTrace>& trace, bool first) {
  if (first) study_.admit(event, wrapped_key_, utc_());
  study_.append(event, trace);
  if (event.kind == EventKind::closed) study_.conclude(event, utc_());
}

void check_whole_session(const StoredStudy& study, const BufferedEvents& session) {
  if (session.events.empty() || session.events.back().kind != EventKind::closed) {
    study.refuse("the session to be added has no end; record its closing first");
  }
  ChainLink chain(session.events.front().session);
  auto trace = session.traces.begin();
  for (const Event& event : session.events) {
    require_link(chain, event);
    chain.extend(event);
    if (event.kind != EventKind::trace_stored) continue;
    require_match(event, trace == session.traces.end() ? nullptr : &*trace);
    ++trace;
  }
  if (trace != session.traces.end()) {
    study.refuse("the session to be added has a trace without an event; record it anew");
  }
}

void store_whole_session(StoredStudy& study, const BufferedEvents& session,
                         const Bytes& wrapped_key, std::chrono::nanoseconds at) {
  const Database& database = study.database();
  study.admit(session.events.front(), wrapped_key, at);
  DerivedRows rows;
  for (const Event& event : session.events) {
    fold(rows, event);
    insert_event(database, event);
  }
  for (const SealedTrace& trace : session.traces) insert_trace(database, trace);
  write_rows(database, rows);
  study.conclude(session.events.back(), at);
}

}  // namespace touchtrial::store
