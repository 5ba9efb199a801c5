#include "protocols/store/stored_study.hpp"

#include "protocols/store/chain_link.hpp"
#include "protocols/store/collected_chain.hpp"
#include "protocols/store/payload_json.hpp"
#include "protocols/store/rows.hpp"

#include <algorithm>
#include <limits>
#include <optional>
#include <set>
#include <vector>

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

}  // namespace

void StoredStudy::refuse(const std::string& text) const {
  throw StoreError(database_.refusal(text));
}

void StoredStudy::require_reason(const std::string& reason, const std::string& what) const {
  if (reason.empty()) refuse(what + " needs a reason, which is recorded; give one");
}

void StoredStudy::refuse_if_collected() const {
  if (stations() == 0) return;
  refuse(
      "was collected from several stations and takes no sessions of its own; record them in a "
      "station's database, and merge again");
}

const StudyCommitment& StoredStudy::commitment() const {
  if (!commitment_) {
    const std::optional<Event> first = read_event(database_, 0, 0);
    if (!first) refuse("its first event is missing; restore it from a backup");
    commitment_ = body_of(*first, commitment_from_json);
  }
  return *commitment_;
}

StudyState StoredStudy::state() const {
  std::vector<Event> chain;
  for_each_event(database_, 0, [&](const Event& event) { chain.push_back(event); });
  return state_of_chain(chain);
}

int StoredStudy::stations() const {
  Query query = database_.query("SELECT min(session) FROM events");
  const std::int64_t lowest = query.step() ? query.integer(0) : 0;
  if (lowest > 0 || lowest < -std::int64_t{std::numeric_limits<int>::max()}) return 0;
  return static_cast<int>(-lowest);
}

int StoredStudy::next_session() const {
  Query query = database_.query("SELECT max(session) FROM events");
  const std::int64_t last = query.step() ? query.integer(0) : 0;
  if (last >= std::numeric_limits<int>::max()) {
    refuse("has events of session " + std::to_string(last) + "; restore it from a backup");
  }
  return static_cast<int>(std::max(last, std::int64_t{0})) + 1;
}

SessionRow StoredStudy::session(int session) const {
  const DerivedRows rows = read_rows(database_, {.session = session, .trial = {}});
  if (rows.sessions.empty()) {
    refuse("there is no session " + std::to_string(session) +
           "; see the sessions with `touchtrial report`");
  }
  return rows.sessions.begin()->second;
}

std::optional<SessionRow> StoredStudy::session_of(const std::string& participant) const {
  Query query =
      database_.query("SELECT session FROM sessions WHERE participant = ? AND replaced_by IS NULL");
  query.bind(participant);
  if (!query.step()) return std::nullopt;
  return session(static_cast<int>(query.integer(0)));
}

int StoredStudy::next_enrolment() const {
  const std::map<int, std::string> promised = promised_enrolments();
  Query query = database_.query(
      "SELECT enrolment FROM sessions WHERE replaced_by IS NULL ORDER BY enrolment");
  std::set<std::int64_t> taken;
  while (query.step()) taken.insert(query.integer(0));
  int number = 1;
  while (taken.contains(number) || promised.contains(number)) ++number;
  return number;
}

int StoredStudy::enrolment_for(const std::string& participant) const {
  for (const auto& [enrolment, by] : promised_enrolments()) {
    if (by == participant) return enrolment;
  }
  return next_enrolment();
}

std::map<int, std::string> StoredStudy::promised_enrolments() const {
  // Who has a number is in its last session; if that was replaced, it waits for who comes.
  Query query = database_.query(
      "SELECT enrolment, replaced_by, max(session) FROM sessions GROUP BY enrolment "
      "HAVING replaced_by IS NOT NULL");
  std::map<int, std::string> promised;
  while (query.step()) promised[static_cast<int>(query.integer(0))] = query.text(1);
  return promised;
}

std::optional<Event> StoredStudy::last_event(int session) const {
  Query query = database_.query("SELECT max(sequence) FROM events WHERE session = ?");
  query.bind(session);
  if (!query.step() || query.is_null(0)) return std::nullopt;
  return read_event(database_, session, query.integer(0));
}

ChainHead StoredStudy::head(int session) const {
  const std::optional<Event> last = last_event(session);
  if (!last) return {};
  return {.length = last->sequence + 1, .hash = last->hash};
}

void StoredStudy::append_to_file(EventKind kind, std::chrono::nanoseconds at,
                                 const std::string& body) {
  const std::optional<Event> last = last_event(0);
  Event event{.session = 0,
              .sequence = last ? last->sequence + 1 : 0,
              .kind = kind,
              .at = at,
              .body = body,
              .sealed = {},
              .previous = last ? last->hash : Digest{},
              .hash = {}};
  event.hash = event_hash(event);
  append(event, std::nullopt);
}

void StoredStudy::append(const Event& event, const std::optional<SealedTrace>& trace) {
  DerivedRows rows = read_rows(database_, scope_of(event));
  if (event.session != 0) refuse_after_withdrawal(rows, event);
  fold(rows, event);
  insert_event(database_, event);
  if (trace) insert_trace(database_, *trace);
  write_rows(database_, rows);
}

/// Nothing more is recorded of somebody who withdrew or was replaced during the session, but that
/// it ended.
void StoredStudy::refuse_after_withdrawal(const DerivedRows& rows, const Event& event) const {
  if (event.kind == EventKind::stopped || event.kind == EventKind::closed) return;
  const auto found = rows.sessions.find(event.session);
  if (found == rows.sessions.end()) return;
  const SessionRow& row = found->second;
  if (!row.withdrawn && row.replaced_by.empty()) return;
  refuse("participant " + row.participant +
         (row.withdrawn ? " has withdrawn" : " was replaced by participant " + row.replaced_by) +
         "; end session " + std::to_string(event.session));
}

Event StoredStudy::last_of_open(int session) const {
  const SessionRow row = this->session(session);
  const std::string name =
      "session " + std::to_string(session) + " (participant " + row.participant + ")";
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

void StoredStudy::admit(const Event& opened, const Bytes& wrapped_key,
                        std::chrono::nanoseconds at) {
  refuse_if_collected();
  if (is_closed(database_)) refuse("the study is closed; it takes no more sessions");
  if (opened.session != next_session()) {
    refuse("session " + std::to_string(opened.session) + " is not the next one (" +
           std::to_string(next_session()) + "); another program may have taken it, start again");
  }
  if (opened.kind != EventKind::opened) {
    throw EventFault(opened.session, opened.sequence, "a session begins with 'opened'");
  }
  const SessionOpening opening = body_of(opened, opening_from_json);
  check_opening(opening);
  append_to_file(EventKind::session_opened, at,
                 to_json(SessionOpenedBody{.session = opened.session,
                                           .participant = opening.participant,
                                           .enrolment = opening.enrolment,
                                           .first = opened.hash,
                                           .key = sha256(wrapped_key)}));
  database_.query("INSERT INTO participant_keys(session, wrapped) VALUES(?,?)")
      .bind(opened.session)
      .bind(wrapped_key)
      .run();
}

void StoredStudy::conclude(const Event& closed, std::chrono::nanoseconds at) {
  append_to_file(EventKind::session_closed, at,
                 to_json(SessionClosedBody{.session = closed.session,
                                           .length = closed.sequence + 1,
                                           .head = closed.hash,
                                           .complete = body_of(closed, completion_from_json)}));
}

void StoredStudy::check_opening(const SessionOpening& opening) const {
  if (opening.study_id != commitment().study_id || opening.seal != commitment().seal) {
    refuse("is the database of another study, or of this one before it was changed (" +
           commitment().study + ", id " + commitment().study_id +
           "); use that study's file and key, or another database");
  }
  if (!is_participant_id(opening.participant)) {
    refuse("'" + opening.participant +
           "' is no participant id; use 1 to 32 of 0-9, A-Z, a-z, '+', '-', '_'");
  }
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

void StoredStudy::withdraw(int session, std::chrono::nanoseconds at, const std::string& reason) {
  if (this->session(session).withdrawn) {
    refuse("the participant of session " + std::to_string(session) + " has already withdrawn");
  }
  database_.query("DELETE FROM participant_keys WHERE session = ?").bind(session).run();
  append_to_file(EventKind::participant_withdrawn, at,
                 to_json(ParticipantBody{.session = session, .reason = reason}));
}

void StoredStudy::replace(const ReplacementBody& replacement, std::chrono::nanoseconds at) {
  refuse_if_collected();
  if (is_closed(database_)) refuse("the study is closed; it takes no more sessions");
  const SessionRow row = session(replacement.session);
  check_replaced(row);
  check_replacement(row, replacement.by);
  append_to_file(EventKind::participant_replaced, at, to_json(replacement));
}

void StoredStudy::check_replaced(const SessionRow& row) const {
  const std::string name =
      "session " + std::to_string(row.session) + " (participant " + row.participant + ")";
  if (!row.replaced_by.empty()) {
    refuse(name + " was already replaced by participant " + row.replaced_by);
  }
  if (row.excluded || row.withdrawn || row.state == SessionState::stopped) return;
  refuse(name + (row.state == SessionState::open ? " is still open" : " is complete") +
         "; who is replaced must have been stopped, excluded or withdrawn first");
}

void StoredStudy::check_replacement(const SessionRow& row, const std::string& by) const {
  if (!is_participant_id(by)) {
    refuse("'" + by + "' is no participant id; use 1 to 32 of 0-9, A-Z, a-z, '+', '-', '_'");
  }
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

}  // namespace touchtrial::store
