// StoredStudy's functions for sessions and participants: admission, continuation, end, withdrawal
// and replacement.
#include "core/text.hpp"
#include "core/utc.hpp"
#include "record/payload_json.hpp"
#include "record/rows.hpp"
#include "record/stored_study.hpp"

#include <algorithm>
#include <utility>

namespace touchtrial::record {
namespace {

constexpr std::size_t kMaxParticipantBytes = 32;

/// Whether a session is the visit after the participant's last one.
bool is_next_visit(const SessionOpening& opening, const SessionRow& last_visit) {
  return opening.visit == last_visit.visit + 1 && opening.enrolment == last_visit.enrolment &&
         last_visit.state == SessionState::completed && !last_visit.withdrawn;
}

/// No session is opened after the study was closed, so the newest event of the two kinds decides.
/// This reads one event, however many sessions there are.
bool is_closed(const Database& database) {
  Query query = database.query(
      "SELECT kind = 'study-closed' FROM events WHERE session = 0 AND "
      "kind IN ('study-closed', 'session-opened') ORDER BY sequence DESC LIMIT 1");
  return query.step() && query.integer(0) != 0;
}

std::string session_title(const SessionRow& row) {
  return "session " + std::to_string(row.session) + " (participant " + row.participant + ")";
}

/// Whether the session is idle after an event of this kind, so that there is time to empty the log.
bool is_pause(EventKind kind) {
  return kind == EventKind::break_taken || kind == EventKind::paused;
}

/// Whether head files record events of this kind: acknowledged events, and those at which a session
/// may end.
bool updates_heads(EventKind kind) {
  return kind == EventKind::opened || kind == EventKind::answered || kind == EventKind::timed_out ||
         kind == EventKind::stopped || kind == EventKind::closed || is_pause(kind);
}

/// The same day of a later year; 28 February in place of 29 February if that is not a leap year.
std::chrono::nanoseconds years_after(std::chrono::nanoseconds utc, int years) {
  using namespace std::chrono;
  const sys_time<nanoseconds> time(utc);
  const sys_days day = floor<days>(time);
  year_month_day date(day);
  date += std::chrono::years(years);
  if (!date.ok()) date = date.year() / date.month() / last;
  return (sys_days(date) + (time - day)).time_since_epoch();
}

/// Requires that a trace comes with the event that names it, and with no other.
void require_match(const Event& event, const SealedTrace* trace) {
  if (event.kind != EventKind::trace_stored) {
    if (trace == nullptr) return;
    throw EventFault(event, "an event of this kind has no trace");
  }
  const int trial = body_of<TraceBody>(event).trial;
  if (trace == nullptr || trace->session != event.session || trace->trial != trial) {
    throw EventFault(event,
                     "the trace of trial " + std::to_string(trial) + " is missing [missing-trace]");
  }
}

}  // namespace

bool is_participant_id(const std::string& id) {
  const auto is_allowed = [](char c) {
    return (c >= '0' && c <= '9') || (c >= 'A' && c <= 'Z') || (c >= 'a' && c <= 'z') || c == '+' ||
           c == '-' || c == '_';
  };
  return !id.empty() && id.size() <= kMaxParticipantBytes && !is_read_as_missing(id) &&
         !begins_like_formula(id) && std::all_of(id.begin(), id.end(), is_allowed);
}

void StoredStudy::require_open_study() const {
  if (stations() > 0) {
    refuse(
        "was collected from several stations and accepts no new sessions; record them in a "
        "station's database, and merge again");
  }
  if (is_closed(database_)) refuse("the study is closed; it accepts no more sessions");
}

void StoredStudy::require_participant_id(const std::string& id) const {
  if (is_participant_id(id)) return;
  refuse("'" + id + "' is not a participant id; " + std::string(kParticipantIdRule));
}

void StoredStudy::admit(const Event& opening_event, const SessionKeys& keys,
                        std::chrono::nanoseconds at) {
  require_open_study();
  if (opening_event.session != next_session()) {
    refuse("session " + std::to_string(opening_event.session) + " is not the next one (" +
           std::to_string(next_session()) + "); another program may have used it, start again");
  }
  if (opening_event.kind != EventKind::opened) {
    throw EventFault(opening_event, "a session must begin with 'opened'");
  }
  const SessionOpening opening = body_of<SessionOpening>(opening_event);
  check_opening(opening);
  append_to_file(EventKind::session_opened, at,
                 to_json(SessionOpenedBody{.session = opening_event.session,
                                           .participant = opening.participant,
                                           .enrolment = opening.enrolment,
                                           .visit = opening.visit,
                                           .first = opening_event.hash,
                                           .key = sha256(keys.wrapped.participant),
                                           .safety_key = sha256(keys.wrapped.safety),
                                           .kept = keys.station_copy.empty()
                                                       ? std::nullopt
                                                       : std::optional(sha256(keys.station_copy)),
                                           .remarks = keys.wrapped.remarks,
                                           .reasons = keys.wrapped.reasons}));
  insert_keys(database_, opening_event.session,
              {.participant = keys.wrapped.participant, .safety = keys.wrapped.safety});
  if (!keys.station_copy.empty())
    insert_station_key(database_, opening_event.session, keys.station_copy);
}

bool StoredStudy::conclude(const Event& closing_event, std::chrono::nanoseconds at) {
  Query query = database_.query("DELETE FROM station_keys WHERE session = ? RETURNING session");
  const bool erased = query.bind(closing_event.session).step();
  append_to_file(
      EventKind::session_closed, at,
      to_json(SessionClosedBody{.session = closing_event.session,
                                .length = closing_event.sequence + 1,
                                .head = closing_event.hash,
                                .complete = body_of<ClosedBody>(closing_event).complete}));
  return erased;
}

void StoredStudy::empty_log() const {
  try {
    database_.checkpoint();
  } catch (const SQLite::Exception&) {
    // Everything has been stored. SQLite empties the log when the last program leaves the
    // file.
  }
}

void StoredStudy::check_opening(const SessionOpening& opening) const {
  if (opening.study_id != commitment().study_id || opening.seal != commitment().seal) {
    refuse("is the database of another study, or of an earlier version of this one (" +
           commitment().study + ", id " + commitment().study_id +
           "); use that study's file and key, or another database");
  }
  require_participant_id(opening.participant);
  refuse_mixture(opening);
  refuse_if_taken(opening);
  refuse_if_reserved(opening);
}

void StoredStudy::refuse_mixture(const SessionOpening& opening) const {
  if (opening.pilot != commitment().pilot) {
    refuse(commitment().pilot
               ? "is a pilot's database; use another database for the study's sessions"
               : "is not a pilot's database; use another database for pilot sessions");
  }
  const bool is_visual = opening.is_visual();
  if (is_visual && !opening.pilot) {
    refuse("device '" + opening.device +
           "' shows textures on a screen, which is not blind; use it in a pilot's database, "
           "or choose a device that is felt");
  }
  const std::optional<Event> earlier = read_event(database_, 1, 0);
  if (earlier && body_of<SessionOpening>(*earlier).is_visual() != is_visual) {
    refuse(std::string("its sessions are ") + (is_visual ? "felt" : "shown on a screen") +
           ", and those with device '" + opening.device + "' " +
           (is_visual ? "would be shown on a screen" : "would be felt") +
           ": they are never pooled; use another database");
  }
}

void StoredStudy::refuse_if_taken(const SessionOpening& opening) const {
  // The session with this id or number; preferably one of the participant.
  const SessionRow* holder = nullptr;
  const auto rank = [&](const SessionRow& row) {
    return std::pair(row.participant == opening.participant, row.visit);
  };
  for (const auto& [session, row] : sessions()) {
    const bool is_own = row.participant == opening.participant;
    if (!row.replaced_by.empty() || (!is_own && row.enrolment != opening.enrolment)) continue;
    if (holder == nullptr || rank(row) > rank(*holder)) holder = &row;
  }
  if (holder == nullptr) {
    if (opening.visit == 1) return;
    refuse("participant " + opening.participant + " has no visit before visit " +
           std::to_string(opening.visit) + "; begin with the first");
  }
  const std::string session = "session " + std::to_string(holder->session);
  if (holder->participant == opening.participant) {
    if (is_next_visit(opening, *holder)) return;
    if (opening.visit > 1) {
      refuse("visit " + std::to_string(opening.visit) + " of participant " + opening.participant +
             " does not follow " + session + ", which is visit " + std::to_string(holder->visit) +
             "; the previous visit must be complete and have the same enrolment number");
    }
    refuse("participant " + opening.participant + " already has " + session +
           "; give another participant id");
  }
  refuse("enrolment " + std::to_string(opening.enrolment) + ", requested for participant " +
         opening.participant + ", belongs to participant " + holder->participant + " (" + session +
         "); use the next free number");
}

void StoredStudy::refuse_if_reserved(const SessionOpening& opening) const {
  const std::map<int, std::string> reserved = reserved_enrolments();
  const auto reservation = reserved.find(opening.enrolment);
  if (reservation != reserved.end() && reservation->second != opening.participant) {
    refuse("enrolment " + std::to_string(opening.enrolment) + " is reserved for participant " +
           reservation->second + ", who replaces another; give participant " + opening.participant +
           " number " + std::to_string(next_enrolment()));
  }
  const auto own_reservation = std::ranges::find_if(
      reserved, [&](const auto& entry) { return entry.second == opening.participant; });
  if (own_reservation != reserved.end() && own_reservation->first != opening.enrolment) {
    refuse("participant " + opening.participant +
           " replaces another participant and inherits enrolment " +
           std::to_string(own_reservation->first) + "; omit the number, or give that one");
  }
  if (own_reservation != reserved.end()) return;
  const SessionRow* last_session = nullptr;
  for (const auto& [session, row] : sessions()) {
    if (row.participant == opening.participant) last_session = &row;
  }
  if (last_session == nullptr || last_session->replaced_by.empty())
    return;  // a new participant, or one with other visits
  refuse("participant " + opening.participant + " was replaced by participant " +
         last_session->replaced_by + " (session " + std::to_string(last_session->session) +
         "); give another participant id");
}

Event StoredStudy::last_event_of_open(int session) const {
  const SessionRow row = this->session(session);
  const std::string name = session_title(row);
  if (row.state != SessionState::open) {
    refuse(name + " has ended and cannot continue; use another participant id, or restart it");
  }
  if (row.withdrawn) refuse(name + " cannot continue: the participant has withdrawn");
  if (!row.replaced_by.empty()) {
    refuse(name + " cannot continue: it was replaced by participant " + row.replaced_by);
  }
  if (is_closed(database_)) refuse(name + " cannot continue: the study is closed");
  return last_event(session).value();
}

void StoredStudy::check_complete(const BufferedEvents& session) const {
  if (session.events.empty() || session.events.back().kind != EventKind::closed) {
    refuse("the session is not closed; record its closing before adding it");
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
    refuse("the session has a trace without an event; record the session again");
  }
}

void StoredStudy::store_complete(const BufferedEvents& session, const NewKeys& keys,
                                 std::chrono::nanoseconds at) {
  admit(session.events.front(), {.wrapped = keys, .station_copy = {}}, at);
  DerivedRows rows;
  for (const Event& event : session.events) {
    fold(rows, event);
    append(event, std::nullopt);
  }
  for (const SealedTrace& trace : session.traces) insert_trace(database_, trace);
  conclude(session.events.back(), at);
}

void StoredStudy::withdraw(const WithdrawalBody& withdrawal, std::chrono::nanoseconds at) {
  const int session = withdrawal.session;
  const SessionRow row = this->session(session);
  const std::string participant = "the participant of session " + std::to_string(session);
  if (withdrawal.kept == Retention::data && row.withdrawn) {
    refuse(participant + " has already withdrawn" +
           (row.erased ? ", and the data are erased" : ""));
  }
  if (withdrawal.kept == Retention::safety_record && row.erased) {
    refuse(participant + " has already withdrawn, and the data are erased");
  }
  if (withdrawal.kept == Retention::nothing) require_retention_over(session, at);
  const auto destroy = [&](const char* sql) { database_.query(sql).bind(session).run(); };
  destroy("DELETE FROM station_keys WHERE session = ?");  // the session cannot continue
  if (withdrawal.kept != Retention::data) destroy("DELETE FROM participant_keys WHERE session = ?");
  if (withdrawal.kept == Retention::nothing) destroy("DELETE FROM safety_keys WHERE session = ?");
  append_about(session, EventKind::participant_withdrawn, at, to_json(withdrawal));
}

/// The safety record is erased last, and only when the study's years have passed.
void StoredStudy::require_retention_over(int session, std::chrono::nanoseconds at) const {
  const std::string record = "the safety record of session " + std::to_string(session);
  if (!this->session(session).erased) {
    refuse(record + " is retained as long as the data; erase those first (withdraw --erase)");
  }
  Query key = database_.query("SELECT 1 FROM safety_keys WHERE session = ?");
  key.bind(session);
  if (!key.step()) refuse(record + " is already erased");
  const auto until = years_after(opening_on_file(session).at, commitment().safety_record_years);
  if (at >= until) return;
  refuse(record + " must be retained until " + utc_day(until) + ", for " +
         std::to_string(commitment().safety_record_years) +
         " years, as the study states; erase it after that");
}

void StoredStudy::replace(const ReplacementBody& replacement, std::chrono::nanoseconds at) {
  require_open_study();
  const SessionRow row = session(replacement.session);
  check_replaced(row);
  check_replacement(row, replacement.by);
  if (replacement.by != row.participant) {
    // A copy, because append_about changes the rows.
    for (const auto& [session, other] : std::map(sessions())) {
      const bool is_other_visit = other.participant == row.participant &&
                                  other.session != row.session && other.replaced_by.empty();
      if (!is_other_visit) continue;
      ReplacementBody body = replacement;
      body.session = other.session;
      append_about(other.session, EventKind::participant_replaced, at, to_json(body));
    }
  }
  append_about(replacement.session, EventKind::participant_replaced, at, to_json(replacement));
}

void StoredStudy::check_replaced(const SessionRow& row) const {
  const std::string name = session_title(row);
  if (!row.replaced_by.empty()) {
    refuse(name + " was already replaced by participant " + row.replaced_by);
  }
  // A complete session whose data are retained is analysed and cannot be replaced.
  const bool withdrew_early = row.withdrawn && row.state != SessionState::completed;
  if (row.excluded || row.erased || withdrew_early || row.state == SessionState::stopped) return;
  if (row.withdrawn) {
    refuse(name +
           " is complete, and its data are retained and analysed; exclude it before replacing "
           "it");
  }
  refuse(name + (row.state == SessionState::open ? " is still open" : " is complete") +
         "; stop, exclude or withdraw it before replacing it");
}

void StoredStudy::check_replacement(const SessionRow& row, const std::string& by) const {
  require_participant_id(by);
  if (by == row.participant) return;
  for (const auto& [session, other] : sessions()) {
    if (other.participant != by) continue;
    refuse("participant " + by + " already has session " + std::to_string(session) +
           "; only a new participant can replace another");
  }
  for (const auto& [enrolment, reserved] : reserved_enrolments()) {
    if (reserved != by) continue;
    refuse("participant " + by + " already replaces another participant, with enrolment " +
           std::to_string(enrolment) + "; name another participant");
  }
}

StoredSession::StoredSession(StoredStudy& study, int session, SessionKeys keys, UtcClock utc)
    : StoredSession(study, ChainLink(session), std::move(keys), std::move(utc)) {}

StoredSession::StoredSession(StoredStudy& study, const Event& last, UtcClock utc)
    : StoredSession(study, ChainLink::after(last), {}, std::move(utc)) {
  for_each_event(study.database(), last.session, [&](const Event& event) { fold(rows_, event); });
}

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
  DerivedRows rows = rows_;
  bool erased_key = false;
  study_.change([&] {
    if (chain_.length() > 0) refuse_if_others_wrote(events.front().event.session);
    for (const RecordedEvent& recorded : events) {
      const bool is_first = chain.length() == 0;
      chain.extend(recorded.event);
      require_match(recorded.event, recorded.trace ? &*recorded.trace : nullptr);
      erased_key = store(recorded, is_first, rows);
    }
  });
  chain_ = chain;
  rows_ = std::move(rows);
  const EventKind last_kind = events.back().event.kind;
  if (updates_heads(last_kind)) {
    study_.update_heads({.session = events.back().event.session,
                         .ended = last_kind == EventKind::closed,
                         .answers = last_kind == EventKind::answered ? 1 : 0});
  }
  if (erased_key || is_pause(last_kind)) study_.empty_log();
}

/// If two programs recorded one session, each would lose the other's events.
void StoredSession::refuse_if_others_wrote(int session) const {
  const ChainHead stored = study_.head(session);
  if (stored.length == chain_.length() && stored.hash == chain_.head()) return;
  study_.refuse("session " + std::to_string(session) +
                " was continued by another program; end this one");
}

bool StoredSession::store(const RecordedEvent& recorded, bool is_first, DerivedRows& rows) {
  const Event& event = recorded.event;
  if (is_first) study_.admit(event, keys_, utc_());
  study_.refuse_after_withdrawal(event);
  fold(rows, event);
  study_.append(event, recorded.trace);
  return event.kind == EventKind::closed && study_.conclude(event, utc_());
}

}  // namespace touchtrial::record
