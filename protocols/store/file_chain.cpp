#include "protocols/store/file_chain.hpp"

#include "protocols/store/event_fault.hpp"

#include <string>

namespace touchtrial::store {
namespace {

[[noreturn]] void refuse_link(const Event& event, const std::string& why) {
  throw EventFault(event.session, event.sequence, why);
}

}  // namespace

void FileChain::add(const Event& event) {
  if ((event.kind == EventKind::study_committed) != !commitment_) {
    refuse_link(event, commitment_ ? "the study is committed twice"
                                   : "the first event does not commit the study");
  }
  switch (event.kind) {
    case EventKind::study_committed:
      return commit(event);
    case EventKind::session_opened:
      return open_session(event);
    case EventKind::session_closed:
      return close_session(event);
    case EventKind::participant_excluded:
      static_cast<void>(known(event, body_of(event, participant_from_json).session));
      return;
    case EventKind::participant_withdrawn:
      return withdraw(event);
    case EventKind::participant_replaced:
      return replace(event);
    case EventKind::participant_noted:
      static_cast<void>(known(event, body_of(event, note_from_json).session));
      return;
    case EventKind::study_closed:
      if (closed_) refuse_link(event, "the study is closed twice");
      closed_ = true;
      return;
    case EventKind::study_unblinded:
      static_cast<void>(body_of(event, unblinding_from_json));
      return;
    default:
      refuse_link(event, "an event of this kind belongs to a session");
  }
}

void FileChain::commit(const Event& event) {
  commitment_ = body_of(event, commitment_from_json);
}

void FileChain::open_session(const Event& event) {
  const SessionOpenedBody body = body_of(event, session_opened_from_json);
  if (closed_) refuse_link(event, "a session is opened after the study was closed");
  if (body.session != static_cast<int>(sessions_.size()) + 1) {
    refuse_link(event, "session " + std::to_string(body.session) + " is not opened in its turn");
  }
  if (unique_ == UniquePlaces::always) take_place(event, body);
  sessions_[body.session] = {.opened = body,
                             .opened_at = event.sequence,
                             .closed = {},
                             .withdrawn = false,
                             .replaced_by = {}};
}

void FileChain::take_place(const Event& event, const SessionOpenedBody& body) {
  if (!participants_.insert(body.participant).second) {
    refuse_link(event, "participant " + body.participant + " has a session already");
  }
  if (!enrolments_.insert(body.enrolment).second) {
    refuse_link(event, "enrolment " + std::to_string(body.enrolment) + " is taken already");
  }
}

void FileChain::close_session(const Event& event) {
  const SessionClosedBody body = body_of(event, session_closed_from_json);
  SessionOnFile& session = known(event, body.session);
  if (session.closed) {
    refuse_link(event, "session " + std::to_string(body.session) + " is closed twice");
  }
  session.closed = body;
}

void FileChain::withdraw(const Event& event) {
  known(event, body_of(event, participant_from_json).session).withdrawn = true;
}

void FileChain::replace(const Event& event) {
  const ReplacementBody body = body_of(event, replacement_from_json);
  SessionOnFile& session = known(event, body.session);
  if (!session.replaced_by.empty()) {
    refuse_link(event, "session " + std::to_string(body.session) + " is replaced twice");
  }
  session.replaced_by = body.by;
  participants_.erase(session.opened.participant);
  enrolments_.erase(session.opened.enrolment);
}

SessionOnFile& FileChain::known(const Event& event, int session) {
  const auto found = sessions_.find(session);
  if (found == sessions_.end()) {
    refuse_link(event, "session " + std::to_string(session) + " has not been opened");
  }
  return found->second;
}

}  // namespace touchtrial::store
