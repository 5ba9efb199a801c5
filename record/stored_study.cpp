#include "record/stored_study.hpp"

#include "record/payload_json.hpp"
#include "record/person_texts.hpp"
#include "record/rows.hpp"

#include <algorithm>
#include <array>
#include <limits>
#include <set>
#include <vector>

namespace touchtrial::record {

void StoredStudy::refuse(const std::string& text) const {
  throw StoreError(database_.refusal(text));
}

void StoredStudy::require_reason(const std::string& reason, const std::string& what) const {
  if (reason.empty()) refuse(what + " requires a reason, which is recorded; give one");
}

const StudyCommitment& StoredStudy::commitment() const {
  if (!commitment_) {
    const std::optional<Event> first = read_event(database_, 0, 0);
    if (!first) refuse("its first event is missing; restore it from a backup");
    commitment_ = body_of<StudyCommitment>(*first);
  }
  return *commitment_;
}

StudyState StoredStudy::state() const {
  constexpr std::array kDecisions = {EventKind::study_closed, EventKind::study_unblinded};
  const auto read_chain = [&](std::span<const EventKind> kinds) {
    std::vector<Event> chain;
    for_each_event(database_, {.session = 0, .kinds = kinds},
                   [&](const Event& event) { chain.push_back(event); });
    return chain;
  };
  const std::vector<Event> decisions = read_chain(kDecisions);
  // Only a look before the study ended depends on the sessions up to then.
  const bool is_final = std::ranges::all_of(decisions, [](const Event& event) {
    if (event.kind == EventKind::study_closed) return true;
    const UnblindingBody body = body_of<UnblindingBody>(event);
    return !body.interim && !body.question_alone && body.participant.empty();
  });
  return state_of_chain(is_final ? decisions : read_chain({}));
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

void StoredStudy::drop_cache() const {
  sessions_.reset();
  trials_.reset();
}

void StoredStudy::refresh() const {
  Query query = database_.query("PRAGMA data_version");
  const std::int64_t version = query.step() ? query.integer(0) : 0;
  if (version != read_version_) drop_cache();
  read_version_ = version;
}

const std::map<int, SessionRow>& StoredStudy::sessions() const {
  refresh();
  if (!sessions_) sessions_ = DerivedRows{.sessions = read_sessions(database_), .trials = {}};
  return sessions_->sessions;
}

const std::vector<TrialRow>& StoredStudy::trials() const {
  refresh();
  if (!trials_) trials_ = read_trials(database_);
  return *trials_;
}

SessionRow StoredStudy::session(int session) const {
  const auto found = sessions().find(session);
  if (found == sessions().end()) {
    refuse("there is no session " + std::to_string(session) +
           "; see the sessions with `touchtrial report`");
  }
  return found->second;
}

std::optional<SessionRow> StoredStudy::session_of(const std::string& participant) const {
  std::optional<SessionRow> latest;
  for (const auto& [session, row] : sessions()) {
    if (row.participant != participant || !row.replaced_by.empty()) continue;
    if (!latest || row.visit > latest->visit) latest = row;
  }
  return latest;
}

int StoredStudy::next_enrolment() const {
  const std::map<int, std::string> reserved = reserved_enrolments();
  std::set<int> taken;
  for (const auto& [session, row] : sessions()) {
    if (row.replaced_by.empty()) taken.insert(row.enrolment);
  }
  int number = 1;
  while (taken.contains(number) || reserved.contains(number)) ++number;
  return number;
}

int StoredStudy::enrolment_for(const std::string& participant) const {
  for (const auto& [enrolment, by] : reserved_enrolments()) {
    if (by == participant) return enrolment;
  }
  return next_enrolment();
}

std::map<int, std::string> StoredStudy::reserved_enrolments() const {
  // A number belongs to its last session; if that was replaced, it is reserved for the successor.
  std::map<int, std::string> reserved;
  for (const auto& [session, row] : sessions()) {
    if (row.replaced_by.empty()) {
      reserved.erase(row.enrolment);
    } else {
      reserved[row.enrolment] = row.replaced_by;
    }
  }
  return reserved;
}

std::optional<Event> StoredStudy::last_event(int session) const {
  return read_last_event(database_, session);
}

ChainHead StoredStudy::head(int session) const {
  const std::optional<Event> last = last_event(session);
  if (!last) return {};
  return {.length = last->sequence + 1, .hash = last->hash};
}

void StoredStudy::sign_with(const Signer& signer) {
  const StudyCommitment& commitment = this->commitment();
  const bool is_station = commitment.station && commitment.station->key == signer.public_half();
  if (!is_station && commitment.investigator != signer.public_half()) {
    refuse(commitment.station
               ? "is the database of station " + commitment.station->name +
                     "; give that station's file, or the study's key [other-station]"
               : "was merged from several stations' databases; recording in it requires "
                 "the investigator's key, name it with --key");
  }
  signer_ = signer;
}

void StoredStudy::set_head_writer(HeadWriter writer, HeadRecord record) {
  head_writer_ = std::move(writer);
  head_record_ = std::move(record);
}

void StoredStudy::update_heads(const HeadUpdate& update) {
  if (!head_writer_) return;
  head_record_.acknowledged += update.answers;
  const std::pair heads = database_.run(
      [&] { return std::pair(head(0), update.session == 0 ? ChainHead{} : head(update.session)); });
  head_writer_([&](HeadRecord& record) {
    if (record.count == 0) record = head_record_;
    record.advance_answers(head_record_.acknowledged);
    record.advance_file(heads.first);
    if (update.ended) {
      record.sessions.erase(update.session);
    } else if (update.session != 0) {
      record.advance_session(update.session, heads.second);
    }
  });
}

void StoredStudy::append_to_file(EventKind kind, std::chrono::nanoseconds at,
                                 const std::string& body, Bytes sealed) {
  if (!signer_) {
    refuse("recording requires a signature; give this station's file, or the investigator's key");
  }
  const std::optional<Event> last = last_event(0);
  if (last) require_signed(*last);
  const bool is_investigator = signer_->public_half() == commitment().investigator;
  if (kind == EventKind::study_unblinded && !is_investigator) {
    refuse("unblinding requires the investigator's key; name it with --key [needs-key]");
  }
  append(signed_event(next_on_file(last ? &*last : nullptr, kind, at, body, std::move(sealed)),
                      *signer_),
         std::nullopt);
}

void StoredStudy::append_about(int session, EventKind kind, std::chrono::nanoseconds at,
                               const std::string& body) {
  const SessionOpenedBody opening = body_of<SessionOpenedBody>(opening_on_file(session));
  PersonText text = sealed_person_text(kind, at, body, opening);
  append_to_file(kind, at, text.clear, std::move(text.sealed));
}

Event StoredStudy::opening_on_file(int session) const {
  constexpr EventKind kKind = EventKind::session_opened;
  std::optional<Event> found;
  for_each_event(database_, {.session = 0, .kinds = std::span(&kKind, 1)}, [&](const Event& event) {
    if (session_about(event) == session) found = event;
  });
  if (!found) throw EventFault(session, kNoEvent, "the file's chain has no such session");
  return *std::move(found);
}

/// A signature vouches for all events before it, so a forged chain must not be signed.
void StoredStudy::require_signed(const Event& last) const {
  if (last.signature.empty() && stations() > 0) return;  // it follows from the stations' chains
  const std::optional<Event> committed = read_event(database_, 0, 0);
  if (!committed) refuse("its first event is missing; restore it from a backup");
  Signatories(*committed).require(last);
}

void StoredStudy::append(const Event& event, const std::optional<SealedTrace>& trace) {
  static_cast<void>(sessions());  // reads the rows before this event
  if (event.session == 0 || event.kind == EventKind::opened || event.kind == EventKind::closed) {
    fold(*sessions_, event);
  }
  if (event.session != 0) trials_.reset();
  insert_event(database_, event);
  if (trace) insert_trace(database_, *trace);
}

void StoredStudy::refuse_after_withdrawal(const Event& event) const {
  if (event.kind == EventKind::stopped || event.kind == EventKind::closed) return;
  const auto found = sessions().find(event.session);
  if (found == sessions().end()) return;
  const SessionRow& row = found->second;
  if (!row.withdrawn && row.replaced_by.empty()) return;
  refuse("participant " + row.participant +
         (row.withdrawn ? " has withdrawn" : " was replaced by participant " + row.replaced_by) +
         "; end session " + std::to_string(event.session));
}

}  // namespace touchtrial::record
