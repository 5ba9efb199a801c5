#include "protocols/store/session_check.hpp"

#include "protocols/store/event_fault.hpp"
#include "protocols/store/payload_json.hpp"

#include <algorithm>
#include <string>

namespace touchtrial::store {
namespace {

[[noreturn]] void fault_of_session(std::int64_t session, std::int64_t sequence,
                                   const std::string& what) {
  throw EventFault(session, sequence, what);
}

}  // namespace

SessionCheck::SessionCheck(int session, const SessionOnFile& on_file,
                           const StudyCommitment& commitment)
    : session_(session),
      on_file_(on_file),
      commitment_(commitment),
      chain_(session, own_session_of(on_file.opened)) {}

void SessionCheck::add(const Event& event, DerivedRows& rows) {
  if (const auto broken = chain_.broken_by(event)) {
    fault_of_session(session_, std::min(event.sequence, chain_.length()), *broken);
  }
  chain_.extend(event);
  if (event.sequence == 0) check_opening(event);
  fold(rows, event);
  if (event.kind == EventKind::trace_stored) note_trace(event);
}

void SessionCheck::check_opening(const Event& event) const {
  if (event.hash != on_file_.opened.first) {
    fault_of_session(session_, 0, "the session's first event is not the one on the file's chain");
  }
  const SessionOpening opening = body_of(event, opening_from_json);
  if (opening.study_id != commitment_.study_id || opening.seal != commitment_.seal) {
    fault_of_session(session_, 0, "the session belongs to another study");
  }
  if (opening.participant != on_file_.opened.participant ||
      opening.enrolment != on_file_.opened.enrolment) {
    fault_of_session(session_, 0, "participant or enrolment differs from the file's chain");
  }
}

void SessionCheck::note_trace(const Event& event) {
  const TraceBody body = body_of(event, trace_body_from_json);
  if (claims_.emplace(body.trial, TraceClaim{event.sequence, body.trace}).second) return;
  fault_of_session(session_, event.sequence,
                   "trace of trial " + std::to_string(body.trial) + " is stored twice");
}

void SessionCheck::finish(const DerivedRows& rows) const {
  const std::string name = "session " + std::to_string(own_session_of(on_file_.opened));
  const std::int64_t last = chain_.length() - 1;
  if (last < 0) fault_of_session(0, on_file_.opened_at, name + " has no events");
  const SessionState state = rows.sessions.at(session_).state;
  if (!on_file_.closed) {
    if (state == SessionState::open) return;
    fault_of_session(session_, last, "the session is closed, but not on the file's chain");
  }
  const SessionClosedBody& closed = *on_file_.closed;
  if (closed.length != chain_.length()) {
    fault_of_session(session_, last,
                     name + " ends at event " + std::to_string(last) + ", the file's chain says " +
                         std::to_string(closed.length - 1));
  }
  if (closed.head != chain_.head()) {
    fault_of_session(session_, last, "the session's last event is not the one on the file's chain");
  }
  if (state != (closed.complete ? SessionState::completed : SessionState::stopped)) {
    fault_of_session(session_, last, "the session's end differs from the file's chain");
  }
}

void SessionCheck::check_key(const std::optional<Digest>& wrapped) const {
  if (!wrapped && !on_file_.withdrawn) {
    fault_of_session(session_, kNoEvent, "the participant's key is missing without a withdrawal");
  }
  if (!wrapped) return;
  if (on_file_.withdrawn) {
    fault_of_session(session_, kNoEvent, "the participant withdrew, but the key is still there");
  }
  if (*wrapped != on_file_.opened.key) {
    fault_of_session(session_, kNoEvent, "the participant's key was altered");
  }
}

}  // namespace touchtrial::store
