#include "record/fold.hpp"

#include "record/damage.hpp"
#include "record/event_kinds.hpp"
#include "record/opened_parts.hpp"
#include "record/payload_json.hpp"

#include <algorithm>
#include <string>
#include <vector>

namespace touchtrial::record {
namespace {

[[noreturn]] void refuse_trial(const Event& event, int trial, const char* reason) {
  throw EventFault(event, "trial " + std::to_string(trial) + " " + reason);
}

void open_session(DerivedRows& rows, const Event& event) {
  if (event.sequence != 0) throw EventFault(event, "a session is opened by its first event only");
  const SessionOpening opening = body_of<SessionOpening>(event);
  rows.sessions[event.session] = {.session = event.session,
                                  .participant = opening.participant,
                                  .enrolment = opening.enrolment,
                                  .state = SessionState::open,
                                  .simulated = opening.simulated,
                                  .pilot = opening.pilot,
                                  .excluded = false,
                                  .withdrawn = false,
                                  .erased = false,
                                  .device = opening.device,
                                  .replaced_by = {},
                                  .own_session = event.own_session(),
                                  .station = 0,
                                  .visit = opening.visit};
}

SessionRow& open_row(DerivedRows& rows, const Event& event) {
  const auto found = rows.sessions.find(event.session);
  if (found == rows.sessions.end()) throw EventFault(event, "the session has not been opened");
  if (found->second.state != SessionState::open)
    throw EventFault(event, "the session is already closed");
  return found->second;
}

/// A trial that was presented before its block was restarted accepts no further events.
void refuse_if_voided(const TrialRow& row, const Event& event) {
  if (row.state == TrialState::voided) {
    refuse_trial(event, row.trial, "is void: its block was restarted");
  }
}

void present_trial(DerivedRows& rows, const Event& event) {
  const PresentedBody body = body_of<PresentedBody>(event);
  const TrialId id(event.session, body.trial);
  const auto earlier = rows.trials.find(id);
  if (earlier != rows.trials.end()) {
    // After an interruption a trial may be presented again; a response or a trace makes it final.
    const TrialRow& row = earlier->second;
    refuse_if_voided(row, event);
    if (row.state == TrialState::answered) {
      refuse_trial(event, body.trial, "is presented again after it was answered");
    }
    if (row.has_trace())
      refuse_trial(event, body.trial, "is presented again after its trace was stored");
  }
  TrialRow row;
  row.session = event.session;
  row.trial = body.trial;
  row.block = body.block;
  row.state = TrialState::presented;
  row.presented_at = event.time().value_or(row.presented_at);
  rows.trials[id] = row;
}

TrialRow& presented_row(DerivedRows& rows, const Event& event, int trial) {
  const auto found = rows.trials.find({event.session, trial});
  if (found == rows.trials.end()) refuse_trial(event, trial, "has not been presented");
  refuse_if_voided(found->second, event);
  return found->second;
}

/// A trial that may still be answered, also after a timeout.
TrialRow& unanswered_row(DerivedRows& rows, const Event& event, int trial) {
  TrialRow& row = presented_row(rows, event, trial);
  if (row.state == TrialState::answered) refuse_trial(event, trial, "is already answered");
  if (row.state == TrialState::interrupted) refuse_trial(event, trial, "was interrupted");
  return row;
}

void note_contact(DerivedRows& rows, const Event& event) {
  const int trial = body_of<TrialBody>(event).trial;
  TrialRow& row = unanswered_row(rows, event, trial);
  if (!row.contact_at) row.contact_at = event.time();
}

void pause_trial(DerivedRows& rows, const Event& event) {
  const PauseBody body = body_of<PauseBody>(event);
  if (body.trial) unanswered_row(rows, event, *body.trial).paused = true;
}

void answer_trial(DerivedRows& rows, const Event& event, const AnswerBody& body) {
  TrialRow& row = unanswered_row(rows, event, body.trial);
  row.state = TrialState::answered;
  row.answered_at = event.time();
  row.answer = body.answer;
  row.confidence = body.confidence;
  row.kind = body.kind;
  row.track = body.track;
  row.level = body.level;
  row.target = body.target;
}

void end_trial(DerivedRows& rows, const Event& event, TrialState state) {
  const int trial = body_of<TrialBody>(event).trial;
  unanswered_row(rows, event, trial).state = state;
}

void set_measures(DerivedRows& rows, const Event& event, const TraceBody& body) {
  TrialRow& row = presented_row(rows, event, body.trial);
  row.valid = body.valid;
  row.hand = body.hand;
  row.overruns = body.overruns;
  row.samples = body.samples;
  row.rate_hz = body.rate_hz;
}

void explore_again(DerivedRows& rows, const Event& event) {
  const int trial = body_of<TrialBody>(event).trial;
  ++unanswered_row(rows, event, trial).explorations;
}

/// Every presented trial of the block becomes void. Its new trials have new numbers, so that
/// nothing links them to the old ones.
void restart_block(DerivedRows& rows, const Event& event) {
  const BlockBody body = body_of<BlockBody>(event);
  std::vector<TrialRow*> block;
  for (auto entry = rows.trials.lower_bound({event.session, 0});
       entry != rows.trials.end() && entry->first.first == event.session; ++entry) {
    TrialRow& row = entry->second;
    if (row.block != body.block) continue;
    if (row.trial >= body.first_trial) {
      refuse_trial(event, row.trial, "was presented before its block was restarted");
    }
    block.push_back(&row);
  }
  for (TrialRow* row : block) row->state = TrialState::voided;
}

void close_session(DerivedRows& rows, const Event& event) {
  const bool complete = body_of<ClosedBody>(event).complete;
  open_row(rows, event).state = complete ? SessionState::completed : SessionState::stopped;
}

/// The row of the session that an event of the file's chain names.
SessionRow& named_row(DerivedRows& rows, const Event& event) {
  const int session = session_about(event);
  const auto found = rows.sessions.find(session);
  if (found == rows.sessions.end()) {
    throw EventFault(event, "there is no session " + std::to_string(session));
  }
  return found->second;
}

void replace_participant(DerivedRows& rows, const Event& event) {
  const ReplacementBody body = body_of<ReplacementBody>(event);
  SessionRow& row = named_row(rows, event);
  if (!row.replaced_by.empty()) {
    throw EventFault(event, "session " + std::to_string(body.session) + " is replaced twice");
  }
  row.replaced_by = body.by;
}

void withdraw_participant(DerivedRows& rows, const Event& event) {
  const WithdrawalBody body = body_of<WithdrawalBody>(event);
  SessionRow& row = named_row(rows, event);
  row.withdrawn = true;
  row.erased = row.erased || body.kept != Retention::data;
}

/// In a collected study the file's chain states the station of a session.
void set_station(DerivedRows& rows, const Event& event) {
  const SessionOpenedBody body = body_of<SessionOpenedBody>(event);
  if (body.station > 0) named_row(rows, event).station = body.station;
}

void fold_session_event(DerivedRows& rows, const Event& event) {
  open_row(rows, event);
  switch (event.kind) {
    case EventKind::presented:
      return present_trial(rows, event);
    case EventKind::first_contact:
      return note_contact(rows, event);
    case EventKind::answered:
      return answer_trial(rows, event, body_of<AnswerBody>(event));
    case EventKind::interrupted:
      return end_trial(rows, event, TrialState::interrupted);
    case EventKind::timed_out:
      return end_trial(rows, event, TrialState::timed_out);
    case EventKind::trace_stored:
      return set_measures(rows, event, body_of<TraceBody>(event));
    case EventKind::explored_again:
      return explore_again(rows, event);
    case EventKind::paused:
      return pause_trial(rows, event);
    case EventKind::block_restarted:
      return restart_block(rows, event);
    case EventKind::closed:
      return close_session(rows, event);
    default:
      return;  // remarks change no row
  }
}

}  // namespace

std::optional<std::chrono::nanoseconds> TrialRow::reaction_time() const {
  if (paused || !answered_at) return std::nullopt;
  return *answered_at - presented_at;
}

std::optional<std::chrono::nanoseconds> TrialRow::from_contact() const {
  if (paused || !answered_at || !contact_at) return std::nullopt;
  return *answered_at - *contact_at;
}

int session_about(const Event& event) {
  if (!belongs_to_file_chain(event.kind)) return event.session;
  const bool names_session = std::ranges::any_of(
      members_of(event.kind),
      [](const ListedMember& listed) { return listed.member.key == "session"; });
  return names_session ? body_of(event, session_from_json) : 0;
}

void fold(DerivedRows& rows, const Event& event) {
  switch (event.kind) {
    case EventKind::opened:
      return open_session(rows, event);
    case EventKind::session_opened:
      return set_station(rows, event);
    case EventKind::participant_excluded:
      named_row(rows, event).excluded = true;
      return;
    case EventKind::participant_withdrawn:
      return withdraw_participant(rows, event);
    case EventKind::participant_replaced:
      return replace_participant(rows, event);
    default:
      if (!belongs_to_file_chain(event.kind)) fold_session_event(rows, event);
  }
}

void fold(DerivedRows& rows, const Event& event, const TraceBody& body) {
  open_row(rows, event);
  set_measures(rows, event, body);
}

void fold(DerivedRows& rows, const Event& event, const BodyParts& body) {
  if (body.hidden.empty() && body.clear == event.body) return fold(rows, event);
  if (event.kind == EventKind::answered) {
    open_row(rows, event);
    return answer_trial(rows, event, body_of(event, [&](const std::string&) {
                          return from_parts<AnswerBody>(body);
                        }));
  }
  Event opened = event;
  opened.body = join_body(body);
  fold(rows, opened);
}

}  // namespace touchtrial::record
