#include "protocols/store/file_chain.hpp"

#include "protocols/store/damage.hpp"
#include "protocols/store/payload_json.hpp"

#include <string>

namespace touchtrial::store {

StudyState state_of_chain(std::span<const Event> chain) {
  StudyState state;
  std::set<int> ended;
  for (const Event& event : chain) {
    if (event.kind == EventKind::study_closed) state.closed = true;
    if (event.kind == EventKind::session_closed) ended.insert(session_about(event));
    if (event.kind != EventKind::study_unblinded) continue;
    const UnblindingBody body = body_of(event, unblinding_from_json);
    state.unblinded = true;
    state.unblinding_reason = body.reason;
    state.interim = body.interim ? std::optional(ended) : std::nullopt;
    if (body.interim && body.sessions) {
      state.interim = std::set<int>(body.sessions->begin(), body.sessions->end());
    }
  }
  return state;
}

void FileChain::add(const Event& event) {
  if ((event.kind == EventKind::study_committed) != !commitment_) {
    throw EventFault(event, commitment_ ? "the study is committed twice"
                                        : "the first event does not commit the study");
  }
  switch (event.kind) {
    case EventKind::study_committed:
      commitment_ = body_of(event, commitment_from_json);
      return;
    case EventKind::session_opened:
      return open_session(event);
    case EventKind::session_closed:
      return close_session(event);
    case EventKind::participant_excluded:
      static_cast<void>(body_of(event, participant_from_json));
      known(event).excluded_at = event.sequence;
      return;
    case EventKind::participant_withdrawn:
      static_cast<void>(body_of(event, participant_from_json));
      known(event).withdrawn_at = event.sequence;
      return;
    case EventKind::participant_replaced:
      return replace(event);
    case EventKind::participant_noted:
      static_cast<void>(body_of(event, note_from_json));
      static_cast<void>(known(event));
      return;
    case EventKind::study_closed:
      if (closed_) throw EventFault(event, "the study is closed twice");
      closed_ = true;
      return;
    case EventKind::study_unblinded:
      static_cast<void>(body_of(event, unblinding_from_json));
      return;
    default:
      throw EventFault(event, "an event of this kind belongs to a session");
  }
}

void FileChain::open_session(const Event& event) {
  const SessionOpenedBody body = body_of(event, session_opened_from_json);
  if (closed_) throw EventFault(event, "a session is opened after the study was closed");
  if (body.session != static_cast<int>(sessions_.size()) + 1) {
    throw EventFault(event,
                     "session " + std::to_string(body.session) + " is not opened in its turn");
  }
  if (unique_ == UniquePlaces::always) take_place(event, body);
  SessionOnFile& session = sessions_[body.session];
  session.opened = body;
  session.opened_at = event.sequence;
}

void FileChain::take_place(const Event& event, const SessionOpenedBody& body) {
  if (!participants_.insert(body.participant).second) {
    throw EventFault(event, "participant " + body.participant + " has a session already");
  }
  if (!enrolments_.insert(body.enrolment).second) {
    throw EventFault(event, "enrolment " + std::to_string(body.enrolment) + " is taken already");
  }
}

void FileChain::close_session(const Event& event) {
  const SessionClosedBody body = body_of(event, session_closed_from_json);
  SessionOnFile& session = known(event);
  if (session.closed) {
    throw EventFault(event, "session " + std::to_string(body.session) + " is closed twice");
  }
  session.closed = body;
  session.closed_at = event.sequence;
}

void FileChain::replace(const Event& event) {
  const ReplacementBody body = body_of(event, replacement_from_json);
  SessionOnFile& session = known(event);
  if (!session.replaced_by.empty()) {
    throw EventFault(event, "session " + std::to_string(body.session) + " is replaced twice");
  }
  session.replaced_by = body.by;
  session.replaced_at = event.sequence;
  participants_.erase(session.opened.participant);
  enrolments_.erase(session.opened.enrolment);
}

/// The session that an event is about.
SessionOnFile& FileChain::known(const Event& event) {
  const int session = session_about(event);
  const auto found = sessions_.find(session);
  if (found == sessions_.end()) {
    throw EventFault(event, "session " + std::to_string(session) + " has not been opened");
  }
  return found->second;
}

FileChain checked_file_chain(std::span<const Event> chain) {
  ChainLink link(0);
  FileChain file;
  for (const Event& event : chain) {
    link.extend(event);
    file.add(event);
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
  fold(rows, event);
  if (event.kind == EventKind::trace_stored) note_trace(event);
}

void SessionCheck::check_opening(const Event& event) const {
  if (event.hash != on_file_.opened.first) {
    throw EventFault(session_, 0, "the session's first event is not the one on the file's chain");
  }
  const SessionOpening opening = body_of(event, opening_from_json);
  if (opening.study_id != commitment_.study_id || opening.seal != commitment_.seal) {
    throw EventFault(session_, 0, "the session belongs to another study");
  }
  if (opening.participant != on_file_.opened.participant ||
      opening.enrolment != on_file_.opened.enrolment) {
    throw EventFault(session_, 0, "participant or enrolment differs from the file's chain");
  }
}

void SessionCheck::note_trace(const Event& event) {
  const TraceBody body = body_of(event, trace_body_from_json);
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
    throw EventFault(session_, last, "the session is closed, but not on the file's chain");
  }
  const SessionClosedBody& closed = *on_file_.closed;
  if (closed.length != chain_.length()) {
    throw EventFault(session_, last,
                     name + " ends at event " + std::to_string(last) + ", the file's chain says " +
                         std::to_string(closed.length - 1));
  }
  if (closed.head != chain_.head()) {
    throw EventFault(session_, last, "the session's last event is not the one on the file's chain");
  }
  if (state != (closed.complete ? SessionState::completed : SessionState::stopped)) {
    throw EventFault(session_, last, "the session's end differs from the file's chain");
  }
}

void SessionCheck::check_key(const std::optional<Digest>& wrapped) const {
  if (!wrapped && !on_file_.withdrawn_at) {
    throw EventFault(session_, kNoEvent, "the participant's key is missing without a withdrawal");
  }
  if (!wrapped) return;
  if (on_file_.withdrawn_at) {
    throw EventFault(session_, kNoEvent, "the participant withdrew, but the key is still there");
  }
  if (*wrapped != on_file_.opened.key) {
    throw EventFault(session_, kNoEvent, "the participant's key was altered");
  }
}

}  // namespace touchtrial::store
