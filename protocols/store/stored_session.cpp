// Sessions and participants of a StoredStudy: who is let in, goes on, ends, withdraws or is
// replaced.
#include "protocols/store/payload_json.hpp"
#include "protocols/store/rows.hpp"
#include "protocols/store/stored_study.hpp"

#include <algorithm>
#include <utility>

namespace touchtrial::store {
namespace {

constexpr std::size_t kLongestParticipant = 32;

bool is_participant_id(const std::string& id) {
  const auto allowed = [](char c) {
    return (c >= '0' && c <= '9') || (c >= 'A' && c <= 'Z') || (c >= 'a' && c <= 'z') || c == '+' ||
           c == '-' || c == '_';
  };
  return !id.empty() && id.size() <= kLongestParticipant &&
         std::all_of(id.begin(), id.end(), allowed);
}

bool is_visual(const SessionOpening& opening) {
  return opening.station && opening.station->visual;
}

bool is_closed(const Database& database) {
  return database.query("SELECT 1 FROM events WHERE session = 0 AND kind = 'study-closed'").step();
}

std::string title_of(const SessionRow& row) {
  return "session " + std::to_string(row.session) + " (participant " + row.participant + ")";
}

/// A trace comes with the event that names it, and with no other.
void require_match(const Event& event, const SealedTrace* trace) {
  if (event.kind != EventKind::trace_stored) {
    if (trace == nullptr) return;
    throw EventFault(event, "an event of this kind has no trace");
  }
  const int trial = body_of(event, trace_body_from_json).trial;
  if (trace == nullptr || trace->session != event.session || trace->trial != trial) {
    throw EventFault(event, "the trace of trial " + std::to_string(trial) + " is missing");
  }
}

}  // namespace

void StoredStudy::refuse_if_over() const {
  if (stations() > 0) {
    refuse(
        "was collected from several stations and takes no sessions of its own; record them in a "
        "station's database, and merge again");
  }
  if (is_closed(database_)) refuse("the study is closed; it takes no more sessions");
}

void StoredStudy::require_participant_id(const std::string& id) const {
  if (is_participant_id(id)) return;
  refuse("'" + id + "' is no participant id; use 1 to 32 of 0-9, A-Z, a-z, '+', '-', '_'");
}

void StoredStudy::admit(const Event& opened, const SessionKeys& keys, std::chrono::nanoseconds at) {
  refuse_if_over();
  if (opened.session != next_session()) {
    refuse("session " + std::to_string(opened.session) + " is not the next one (" +
           std::to_string(next_session()) + "); another program may have taken it, start again");
  }
  if (opened.kind != EventKind::opened) {
    throw EventFault(opened, "a session begins with 'opened'");
  }
  const SessionOpening opening = body_of(opened, opening_from_json);
  check_opening(opening);
  append_to_file(EventKind::session_opened, at,
                 to_json(SessionOpenedBody{.session = opened.session,
                                           .participant = opening.participant,
                                           .enrolment = opening.enrolment,
                                           .first = opened.hash,
                                           .key = sha256(keys.wrapped)}));
  insert_key(database_, opened.session, keys.wrapped);
  if (!keys.kept.empty()) insert_station_key(database_, opened.session, keys.kept);
}

void StoredStudy::conclude(const Event& closed, std::chrono::nanoseconds at) {
  database_.query("DELETE FROM station_keys WHERE session = ?").bind(closed.session).run();
  append_to_file(
      EventKind::session_closed, at,
      to_json(SessionClosedBody{.session = closed.session,
                                .length = closed.sequence + 1,
                                .head = closed.hash,
                                .complete = body_of(closed, closed_from_json).complete}));
}

bool StoredStudy::keeps_key(int session) const {
  Query query = database_.query("SELECT 1 FROM station_keys WHERE session = ?");
  query.bind(session);
  return query.step();
}

void StoredStudy::forget_erased_keys() const {
  try {
    database_.checkpoint();
  } catch (const SQLite::Exception&) {
    // What was to be stored is stored. SQLite empties the log when the last program leaves the
    // file.
  }
}

void StoredStudy::check_opening(const SessionOpening& opening) const {
  if (opening.study_id != commitment().study_id || opening.seal != commitment().seal) {
    refuse("is the database of another study, or of this one before it was changed (" +
           commitment().study + ", id " + commitment().study_id +
           "); use that study's file and key, or another database");
  }
  require_participant_id(opening.participant);
  refuse_mixture(opening);
  refuse_if_taken(opening);
  refuse_if_promised(opening);
}

void StoredStudy::refuse_mixture(const SessionOpening& opening) const {
  if (opening.pilot != commitment().pilot) {
    refuse(commitment().pilot ? "is the database of a pilot; give the study's own sessions another"
                              : "is no pilot's database; give pilot sessions another");
  }
  const bool visual = is_visual(opening);
  if (visual && !opening.pilot) {
    refuse("device '" + opening.device +
           "' is seen on a screen and not felt, which is not blind; use it in a pilot's database, "
           "or choose a device that is felt");
  }
  const std::optional<Event> earlier = read_event(database_, 1, 0);
  if (earlier && is_visual(body_of(*earlier, opening_from_json)) != visual) {
    refuse(std::string("its sessions are ") + (visual ? "felt" : "seen on a screen") +
           ", and device '" + opening.device + "' is " + (visual ? "seen" : "felt") +
           ": they are never pooled; use another database");
  }
}

void StoredStudy::refuse_if_taken(const SessionOpening& opening) const {
  Query query = database_.query(
      "SELECT session, participant FROM sessions WHERE (participant = ?1 OR enrolment = ?2) "
      "AND replaced_by IS NULL ORDER BY participant = ?1 DESC");
  query.bind(opening.participant).bind(opening.enrolment);
  if (!query.step()) return;
  const std::string session = "session " + std::to_string(query.integer(0));
  if (query.text(1) == opening.participant) {
    refuse("participant " + opening.participant + " already has " + session +
           "; give another participant id");
  }
  refuse("enrolment " + std::to_string(opening.enrolment) + ", asked for participant " +
         opening.participant + ", belongs to participant " + query.text(1) + " (" + session +
         "); give the next free number");
}

void StoredStudy::refuse_if_promised(const SessionOpening& opening) const {
  const std::map<int, std::string> promised = promised_enrolments();
  const auto kept = promised.find(opening.enrolment);
  if (kept != promised.end() && kept->second != opening.participant) {
    refuse("enrolment " + std::to_string(opening.enrolment) + " is kept for participant " +
           kept->second + ", who replaces somebody; give participant " + opening.participant +
           " number " + std::to_string(next_enrolment()));
  }
  const int inherited = enrolment_for(opening.participant);
  const auto own = promised.find(inherited);
  if (own != promised.end() && inherited != opening.enrolment) {
    refuse("participant " + opening.participant + " replaces somebody and inherits enrolment " +
           std::to_string(inherited) + "; leave the number out, or give that one");
  }
  if (own != promised.end()) return;
  Query query = database_.query(
      "SELECT session, replaced_by FROM sessions WHERE participant = ? ORDER BY session DESC");
  query.bind(opening.participant);
  if (!query.step()) return;
  refuse("participant " + opening.participant + " was replaced by participant " + query.text(1) +
         " (session " + std::to_string(query.integer(0)) + "); give another participant id");
}

Event StoredStudy::last_of_open(int session) const {
  const SessionRow row = this->session(session);
  const std::string name = title_of(row);
  if (row.state != SessionState::open) {
    refuse(name + " has ended and cannot go on; use another participant id, or restart it");
  }
  if (row.withdrawn) refuse(name + " cannot go on: the participant has withdrawn");
  if (!row.replaced_by.empty()) {
    refuse(name + " cannot go on: it was replaced by participant " + row.replaced_by);
  }
  if (is_closed(database_)) refuse(name + " cannot go on: the study is closed");
  return last_event(session).value();
}

void StoredStudy::check_whole(const BufferedEvents& session) const {
  if (session.events.empty() || session.events.back().kind != EventKind::closed) {
    refuse("the session to be added has no end; record its closing first");
  }
  ChainLink chain(session.events.front().session);
  auto trace = session.traces.begin();
  for (const Event& event : session.events) {
    chain.extend(event);
    if (event.kind != EventKind::trace_stored) continue;
    require_match(event, trace == session.traces.end() ? nullptr : &*trace);
    ++trace;
  }
  if (trace != session.traces.end()) {
    refuse("the session to be added has a trace without an event; record it anew");
  }
}

void StoredStudy::store_whole(const BufferedEvents& session, const Bytes& wrapped_key,
                              std::chrono::nanoseconds at) {
  admit(session.events.front(), {.wrapped = wrapped_key, .kept = {}}, at);
  DerivedRows rows;
  for (const Event& event : session.events) {
    fold(rows, event);
    insert_event(database_, event);
  }
  for (const SealedTrace& trace : session.traces) insert_trace(database_, trace);
  write_rows(database_, rows);
  conclude(session.events.back(), at);
}

void StoredStudy::withdraw(int session, std::chrono::nanoseconds at, const std::string& reason) {
  if (this->session(session).withdrawn) {
    refuse("the participant of session " + std::to_string(session) + " has already withdrawn");
  }
  database_.query("DELETE FROM participant_keys WHERE session = ?").bind(session).run();
  database_.query("DELETE FROM station_keys WHERE session = ?").bind(session).run();
  append_to_file(EventKind::participant_withdrawn, at,
                 to_json(ParticipantBody{.session = session, .reason = reason}));
}

void StoredStudy::replace(const ReplacementBody& replacement, std::chrono::nanoseconds at) {
  refuse_if_over();
  const SessionRow row = session(replacement.session);
  check_replaced(row);
  check_replacement(row, replacement.by);
  append_to_file(EventKind::participant_replaced, at, to_json(replacement));
}

void StoredStudy::check_replaced(const SessionRow& row) const {
  const std::string name = title_of(row);
  if (!row.replaced_by.empty()) {
    refuse(name + " was already replaced by participant " + row.replaced_by);
  }
  if (row.excluded || row.withdrawn || row.state == SessionState::stopped) return;
  refuse(name + (row.state == SessionState::open ? " is still open" : " is complete") +
         "; who is replaced must have been stopped, excluded or withdrawn first");
}

void StoredStudy::check_replacement(const SessionRow& row, const std::string& by) const {
  require_participant_id(by);
  if (by == row.participant) return;
  Query query = database_.query("SELECT session FROM sessions WHERE participant = ?");
  query.bind(by);
  if (query.step()) {
    refuse("participant " + by + " already has session " + std::to_string(query.integer(0)) +
           "; only somebody new can take a place");
  }
  for (const auto& [enrolment, promised] : promised_enrolments()) {
    if (promised != by) continue;
    refuse("participant " + by + " already replaces somebody, with enrolment " +
           std::to_string(enrolment) + "; name another participant");
  }
}

StoredSession::StoredSession(StoredStudy& study, int session, SessionKeys keys, UtcClock utc)
    : StoredSession(study, ChainLink(session), std::move(keys), std::move(utc)) {}

StoredSession::StoredSession(StoredStudy& study, const Event& last, UtcClock utc)
    : StoredSession(study, ChainLink::after(last), {}, std::move(utc)) {}

StoredSession::StoredSession(StoredStudy& study, ChainLink chain, SessionKeys keys, UtcClock utc)
    : study_(study), chain_(chain), keys_(std::move(keys)), utc_(std::move(utc)) {
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
  bool erases_key = false;
  study_.database().change([&] {
    if (chain_.length() > 0) refuse_if_others_wrote(events.front().event.session);
    erases_key = events.back().event.kind == EventKind::closed &&
                 study_.keeps_key(events.back().event.session);
    for (const auto& [event, trace] : events) {
      const bool first = chain.length() == 0;
      chain.extend(event);
      require_match(event, trace ? &*trace : nullptr);
      store(event, trace, first);
    }
  });
  chain_ = chain;
  if (erases_key) study_.forget_erased_keys();
}

/// If two programs recorded one session, each would lose what the other records.
void StoredSession::refuse_if_others_wrote(int session) const {
  const ChainHead stored = study_.head(session);
  if (stored.length == chain_.length() && stored.hash == chain_.head()) return;
  study_.refuse("session " + std::to_string(session) +
                " was continued by another program, which has it now; end this one");
}

void StoredSession::store(const Event& event, const std::optional<SealedTrace>& trace, bool first) {
  if (first) study_.admit(event, keys_, utc_());
  study_.append(event, trace);
  if (event.kind == EventKind::closed) study_.conclude(event, utc_());
}

}  // namespace touchtrial::store
