#include "record/file_chain.hpp"

#include "record/damage.hpp"
#include "record/payload_json.hpp"

#include <algorithm>
#include <string>

namespace touchtrial::record {

namespace {

/// The sessions that ended in this part of the chain.
std::set<int> ended_in(std::span<const Event> chain) {
  std::set<int> ended;
  for (const Event& event : chain) {
    if (event.kind == EventKind::session_closed) ended.insert(session_about(event));
  }
  return ended;
}

/// The participant's sessions that were opened in this part of the chain.
std::set<int> sessions_in(std::span<const Event> chain, const std::string& participant) {
  std::set<int> sessions;
  for (const Event& event : chain) {
    if (event.kind != EventKind::session_opened) continue;
    const SessionOpenedBody body = body_of<SessionOpenedBody>(event);
    if (body.participant == participant) sessions.insert(body.session);
  }
  return sessions;
}

}  // namespace

StudyState state_of_chain(std::span<const Event> chain) {
  StudyState state;
  for (std::size_t i = 0; i < chain.size(); ++i) {
    const Event& event = chain[i];
    if (event.kind == EventKind::study_closed) state.closed = true;
    if (event.kind != EventKind::study_unblinded) continue;
    const std::span<const Event> earlier_events = chain.first(i);
    const UnblindingBody body = body_of<UnblindingBody>(event);
    std::optional<std::set<int>> named_sessions;
    if (body.sessions) named_sessions.emplace(body.sessions->begin(), body.sessions->end());
    if (!body.participant.empty()) {
      state.looks.push_back({body.participant, body.reason, event.at});
      state.looked_at.merge(named_sessions ? *named_sessions
                                           : sessions_in(earlier_events, body.participant));
      continue;
    }
    state.unblinded = !body.question_alone;
    state.unblinding_reason = body.reason;
    state.interim.reset();
    state.question.reset();
    if (body.question_alone) state.question = ended_in(earlier_events);
    if (body.interim && state.unblinded)
      state.interim = named_sessions ? *named_sessions : ended_in(earlier_events);
  }
  return state;
}

void FileChain::add(const Event& event) {
  if (event.kind == EventKind::session_closed || event.kind == EventKind::study_unblinded) {
    ends_and_looks_.push_back(event);
  }
  if ((event.kind == EventKind::study_committed) != !commitment_) {
    throw EventFault(event, commitment_ ? "the study is already committed"
                                        : "the first event does not commit the study");
  }
  switch (event.kind) {
    case EventKind::study_committed:
      commitment_ = body_of<StudyCommitment>(event);
      return;
    case EventKind::session_opened:
      return open_session(event);
    case EventKind::session_closed:
      return close_session(event);
    case EventKind::participant_excluded:
      return exclude(event);
    case EventKind::participant_withdrawn:
      return withdraw(event);
    case EventKind::participant_replaced:
      return replace(event);
    case EventKind::study_closed:
      if (closed_) throw EventFault(event, "the study is closed twice");
      closed_ = true;
      return;
    default:
      if (!belongs_to_file_chain(event.kind)) {
        throw EventFault(event, "an event of this kind belongs to a session");
      }
      require_members(event);
      if (session_about(event) > 0) static_cast<void>(named_session(event));
  }
}

void FileChain::open_session(const Event& event) {
  const SessionOpenedBody body = body_of<SessionOpenedBody>(event);
  if (closed_) throw EventFault(event, "a session is opened after the study was closed");
  if (body.session != static_cast<int>(sessions_.size()) + 1) {
    throw EventFault(event, "session " + std::to_string(body.session) +
                                " is not opened in its turn [session-order]");
  }
  if (unique_ == UniquePlaces::always) reserve_place(event, body);
  SessionOnFile& session = sessions_[body.session];
  session.opened = body;
  session.opened_at = event.sequence;
}

void FileChain::reserve_place(const Event& event, const SessionOpenedBody& body) {
  if (!participants_.emplace(body.participant, body.visit).second) {
    throw EventFault(event, "participant " + body.participant + " already has a session");
  }
  if (!enrolments_.emplace(body.enrolment, body.visit).second) {
    throw EventFault(event, "enrolment " + std::to_string(body.enrolment) + " is already taken");
  }
  if (body.visit > 1) require_previous_visit(event, body);
}

/// A later visit follows a complete one of the same participant.
void FileChain::require_previous_visit(const Event& event, const SessionOpenedBody& body) const {
  const bool has_previous_visit = std::ranges::any_of(sessions_, [&](const auto& entry) {
    const SessionOnFile& session = entry.second;
    return session.opened.participant == body.participant &&
           session.opened.visit == body.visit - 1 && session.opened.enrolment == body.enrolment &&
           session.closed && session.closed->complete && !session.replaced_at;
  });
  if (has_previous_visit) return;
  throw EventFault(event, "visit " + std::to_string(body.visit) + " of participant " +
                              body.participant + " follows no complete visit");
}

void FileChain::close_session(const Event& event) {
  const SessionClosedBody body = body_of<SessionClosedBody>(event);
  SessionOnFile& session = named_session(event);
  if (session.closed) {
    throw EventFault(event, "session " + std::to_string(body.session) + " is closed twice");
  }
  session.closed = body;
  session.closed_at = event.sequence;
}

/// An exclusion after a look must state that the outcomes had been seen.
void FileChain::exclude(const Event& event) {
  const ParticipantBody body = body_of<ParticipantBody>(event);
  named_session(event).excluded_at = event.sequence;
  if (body.after_outcomes || !state_of_chain(ends_and_looks_).shows(body.session)) return;
  throw EventFault(event, "conceals that the outcomes of session " + std::to_string(body.session) +
                              " had been seen before it was excluded");
}

void FileChain::withdraw(const Event& event) {
  const WithdrawalBody body = body_of<WithdrawalBody>(event);
  SessionOnFile& session = named_session(event);
  const auto refuse = [&](const std::string& reason) {
    throw EventFault(event, "session " + std::to_string(body.session) + " " + reason);
  };
  if (body.kept == Retention::data && session.erased_at)
    refuse("retains data that were already erased");
  if (body.kept == Retention::safety_record && session.erased_at) refuse("is erased twice");
  if (body.kept == Retention::nothing && !session.erased_at) {
    refuse("loses its safety record before its outcomes");
  }
  if (body.kept == Retention::nothing && session.safety_erased_at)
    refuse("loses its safety record twice");
  session.withdrawn_at = event.sequence;
  if (body.kept == Retention::nothing && !commitment_->simulated &&
      event.at < session.erased_time + std::chrono::hours(24) * 365 *
                                           std::int64_t{commitment_->safety_record_years}) {
    refuse("loses its safety record before its time");
  }
  if (body.kept == Retention::safety_record) {
    session.erased_at = event.sequence;
    session.erased_time = event.at;
  }
  if (body.kept == Retention::nothing) session.safety_erased_at = event.sequence;
}

void FileChain::replace(const Event& event) {
  const ReplacementBody body = body_of<ReplacementBody>(event);
  SessionOnFile& session = named_session(event);
  if (!session.replaced_by.empty()) {
    throw EventFault(event, "session " + std::to_string(body.session) + " is replaced twice");
  }
  session.replaced_by = body.by;
  session.replaced_at = event.sequence;
  participants_.erase({session.opened.participant, session.opened.visit});
  enrolments_.erase({session.opened.enrolment, session.opened.visit});
}

/// The session that an event is about.
SessionOnFile& FileChain::named_session(const Event& event) {
  const int session = session_about(event);
  const auto found = sessions_.find(session);
  if (found == sessions_.end()) {
    throw EventFault(event, "session " + std::to_string(session) + " has not been opened");
  }
  return found->second;
}

Signatories::Signatories(const Event& committed) {
  const StudyCommitment commitment = body_of<StudyCommitment>(committed);
  investigator_ = commitment.investigator;
  if (!commitment.station) return;
  const StationIdentity& station = *commitment.station;
  if (!is_signed_by(investigator_,
                    station_statement(commitment.study_id, station.name, station.key),
                    station.certificate)) {
    throw EventFault(
        committed, "the investigator did not sign for station " + station.name + " [uncertified]");
  }
  station_ = station.key;
}

void Signatories::require(const Event& event) const {
  const bool is_by_station =
      station_ && event.kind != EventKind::study_unblinded && is_event_signed_by(*station_, event);
  if (is_by_station || is_event_signed_by(investigator_, event)) return;
  throw EventFault(event,
                   event.kind == EventKind::study_unblinded
                       ? "the investigator did not sign the event [unsigned-look]"
                       : "neither the station nor the investigator signed the event [unsigned]");
}

FileChain checked_file_chain(std::span<const Event> chain) {
  ChainLink link(0);
  FileChain file;
  std::optional<Signatories> signatories;
  for (const Event& event : chain) {
    link.extend(event);
    file.add(event);
    if (!signatories) signatories.emplace(event);
    signatories->require(event);
  }
  if (!file.commitment()) throw EventFault(0, kNoEvent, "the file's chain is empty");
  return file;
}

SessionCheck::SessionCheck(int session, const SessionOnFile& on_file,
                           const StudyCommitment& commitment)
    : session_(session),
      on_file_(on_file),
      commitment_(commitment),
      chain_(session, on_file.own_session()) {}

void SessionCheck::add(const Event& event, DerivedRows& rows) {
  chain_.extend(event);
  if (event.sequence == 0) check_opening(event);
  if (event.kind != EventKind::trace_stored) return fold(rows, event);
  const TraceBody body = body_of<TraceBody>(event);
  fold(rows, event, body);
  note_trace(event, body);
}

void SessionCheck::check_opening(const Event& event) const {
  if (event.hash != on_file_.opened.first) {
    throw EventFault(
        session_, 0,
        "the session's first event is not the one on the file's chain [other-session]");
  }
  const SessionOpening opening = body_of<SessionOpening>(event);
  if (opening.study_id != commitment_.study_id || opening.seal != commitment_.seal) {
    throw EventFault(session_, 0, "the session belongs to another study");
  }
  if (opening.participant != on_file_.opened.participant ||
      opening.enrolment != on_file_.opened.enrolment || opening.visit != on_file_.opened.visit) {
    throw EventFault(session_, 0, "participant, enrolment or visit differs from the file's chain");
  }
}

void SessionCheck::note_trace(const Event& event, const TraceBody& body) {
  if (claims_.emplace(body.trial, TraceClaim{event.sequence, body.trace}).second) return;
  throw EventFault(session_, event.sequence,
                   "trace of trial " + std::to_string(body.trial) + " is stored twice");
}

void SessionCheck::finish(const DerivedRows& rows) const {
  const std::string name = "session " + std::to_string(on_file_.own_session());
  const std::int64_t last = chain_.length() - 1;
  if (last < 0) throw EventFault(0, on_file_.opened_at, name + " has no events");
  const SessionState state = rows.sessions.at(session_).state;
  if (!on_file_.closed) {
    if (state == SessionState::open) return;
    throw EventFault(session_, last,
                     "the session is closed, but not on the file's chain [unrecorded-end]");
  }
  const SessionClosedBody& closed = *on_file_.closed;
  if (closed.length != chain_.length()) {
    throw EventFault(session_, last,
                     name + " ends at event " + std::to_string(last) +
                         ", the file's chain states " + std::to_string(closed.length - 1));
  }
  if (closed.head != chain_.head()) {
    throw EventFault(session_, last, "the session's last event is not the one on the file's chain");
  }
  if (state != (closed.complete ? SessionState::completed : SessionState::stopped)) {
    throw EventFault(session_, last, "the session's end differs from the file's chain");
  }
}

void SessionCheck::check_keys(const WrappedKeys& stored) const {
  const auto check = [&](const std::optional<Bytes>& key, const Digest& digest, bool is_erased,
                         const std::string& name, const std::string& short_name) {
    const auto refuse = [&](const std::string& reason) {
      throw EventFault(session_, kNoEvent, reason);
    };
    if (!key && !is_erased) refuse(name + " is missing without a withdrawal [missing-key]");
    if (key && is_erased)
      refuse("the participant withdrew, but " + short_name + " is still there [kept-key]");
    if (key && sha256(*key) != digest) refuse(name + " was altered [altered-key]");
  };
  check(stored.participant, on_file_.opened.key, on_file_.erased_at.has_value(),
        "the participant's key", "the key");
  check(stored.safety, on_file_.opened.safety_key, on_file_.safety_erased_at.has_value(),
        "the safety key", "the safety key");
}

}  // namespace touchtrial::record
