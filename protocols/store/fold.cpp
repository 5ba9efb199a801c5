#include "protocols/store/fold.hpp"

#include "protocols/store/event_fault.hpp"
#include "protocols/store/payload_json.hpp"

#include <string>
#include <vector>

namespace touchtrial::store {
namespace {

[[noreturn]] void refuse_event(const Event& event, const std::string& why) {
  throw EventFault(event.session, event.sequence, why);
}

[[noreturn]] void refuse_trial(const Event& event, int trial, const char* why) {
  refuse_event(event, "trial " + std::to_string(trial) + " " + why);
}

void open_session(DerivedRows& rows, const Event& event) {
  if (event.sequence != 0) refuse_event(event, "a session is opened by its first event only");
  const SessionOpening opening = body_of(event, opening_from_json);
  rows.sessions[event.session] = {.session = event.session,
                                  .participant = opening.participant,
                                  .enrolment = opening.enrolment,
                                  .state = SessionState::open,
                                  .simulated = opening.simulated,
                                  .pilot = opening.pilot,
                                  .excluded = false,
                                  .withdrawn = false,
                                  .device = opening.device,
                                  .replaced_by = {},
                                  .own_session = event.own_session(),
                                  .station = 0};
}

SessionRow& open_row(DerivedRows& rows, const Event& event) {
  const auto found = rows.sessions.find(event.session);
  if (found == rows.sessions.end()) refuse_event(event, "the session has not been opened");
  if (found->second.state != SessionState::open)
    refuse_event(event, "the session is already closed");
  return found->second;
}

/// What was presented before its block was restarted is done with.
void refuse_if_voided(const TrialRow& row, const Event& event) {
  if (row.state == TrialState::voided) {
    refuse_trial(event, row.trial, "is void: its block was restarted");
  }
}

void present_trial(DerivedRows& rows, const Event& event) {
  const TrialBody body = body_of(event, trial_from_json);
  const TrialId id(event.session, body.trial);
  const auto before = rows.trials.find(id);
  if (before != rows.trials.end()) {
    // After an interruption a trial may be presented anew; a response or a trace settles it.
    const TrialRow& row = before->second;
    refuse_if_voided(row, event);
    if (row.position) refuse_trial(event, body.trial, "is presented again after its answer");
    if (row.samples > 0) refuse_trial(event, body.trial, "is presented again after its trace");
  }
  TrialRow row;
  row.session = event.session;
  row.trial = body.trial;
  row.block = body.block;
  row.state = TrialState::presented;
  row.presented_at = event.at;
  rows.trials[id] = row;
}

TrialRow& presented_row(DerivedRows& rows, const Event& event, int trial) {
  const auto found = rows.trials.find({event.session, trial});
  if (found == rows.trials.end()) refuse_trial(event, trial, "has not been presented");
  refuse_if_voided(found->second, event);
  return found->second;
}

/// A trial that still waits for its answer; after a timeout it may still come.
TrialRow& waiting_row(DerivedRows& rows, const Event& event, int trial) {
  TrialRow& row = presented_row(rows, event, trial);
  if (row.state == TrialState::answered) refuse_trial(event, trial, "is already answered");
  if (row.state == TrialState::interrupted) refuse_trial(event, trial, "was interrupted");
  return row;
}

void touch_plane(DerivedRows& rows, const Event& event) {
  const int trial = body_of(event, trial_from_json).trial;
  TrialRow& row = waiting_row(rows, event, trial);
  if (!row.contact_at) row.contact_at = event.at;
}

void answer_trial(DerivedRows& rows, const Event& event) {
  const AnswerBody body = body_of(event, answer_from_json);
  TrialRow& row = waiting_row(rows, event, body.trial);
  row.state = TrialState::answered;
  row.answered_at = event.at;
  row.position = body.position;
  row.first_position = body.first_position;
  row.confidence = body.confidence;
}

void end_trial(DerivedRows& rows, const Event& event, TrialState state) {
  const int trial = body_of(event, trial_from_json).trial;
  waiting_row(rows, event, trial).state = state;
}

void measure_trial(DerivedRows& rows, const Event& event) {
  const TraceBody body = body_of(event, trace_body_from_json);
  TrialRow& row = presented_row(rows, event, body.trial);
  row.valid = body.valid;
  row.overruns = body.overruns;
  row.samples = body.samples;
  row.rate_hz = body.rate_hz;
}

void explore_again(DerivedRows& rows, const Event& event) {
  const int trial = body_of(event, trial_from_json).trial;
  ++waiting_row(rows, event, trial).explorations;
}

/// All that was presented of the block is void; what comes anew has numbers of its own, so that
/// nothing links the two.
void restart_block(DerivedRows& rows, const Event& event) {
  const BlockBody body = body_of(event, block_from_json);
  std::vector<TrialRow*> block;
  for (auto entry = rows.trials.lower_bound({event.session, 0});
       entry != rows.trials.end() && entry->first.first == event.session; ++entry) {
    if (entry->second.block == body.block) block.push_back(&entry->second);
  }
  for (const TrialRow* row : block) {
    if (row->trial >= body.first_trial) {
      refuse_trial(event, row->trial, "was presented before its block was restarted");
    }
  }
  for (TrialRow* row : block) row->state = TrialState::voided;
}

void close_session(DerivedRows& rows, const Event& event) {
  const bool complete = body_of(event, completion_from_json);
  open_row(rows, event).state = complete ? SessionState::completed : SessionState::stopped;
}

SessionRow& named_row(DerivedRows& rows, const Event& event, int session) {
  const auto found = rows.sessions.find(session);
  if (found == rows.sessions.end())
    refuse_event(event, "there is no session " + std::to_string(session));
  return found->second;
}

void mark_participant(DerivedRows& rows, const Event& event, bool SessionRow::*mark) {
  named_row(rows, event, body_of(event, participant_from_json).session).*mark = true;
}

void replace_participant(DerivedRows& rows, const Event& event) {
  const ReplacementBody body = body_of(event, replacement_from_json);
  SessionRow& row = named_row(rows, event, body.session);
  if (!row.replaced_by.empty()) {
    refuse_event(event, "session " + std::to_string(body.session) + " is replaced twice");
  }
  row.replaced_by = body.by;
}

/// The file's chain says where a session was collected from; in a station's own file, nothing.
void place_session(DerivedRows& rows, const Event& event) {
  const SessionOpenedBody body = body_of(event, session_opened_from_json);
  if (body.station > 0) named_row(rows, event, body.session).station = body.station;
}

void fold_session_event(DerivedRows& rows, const Event& event) {
  open_row(rows, event);
  switch (event.kind) {
    case EventKind::presented:
      return present_trial(rows, event);
    case EventKind::first_contact:
      return touch_plane(rows, event);
    case EventKind::answered:
      return answer_trial(rows, event);
    case EventKind::interrupted:
      return end_trial(rows, event, TrialState::interrupted);
    case EventKind::timed_out:
      return end_trial(rows, event, TrialState::timed_out);
    case EventKind::trace_stored:
      return measure_trial(rows, event);
    case EventKind::explored_again:
      return explore_again(rows, event);
    case EventKind::block_restarted:
      return restart_block(rows, event);
    case EventKind::closed:
      return close_session(rows, event);
    default:
      return;  // remarks change no row
  }
}

bool is_about_a_trial(EventKind kind) {
  return (kind >= EventKind::presented && kind <= EventKind::trace_stored) ||
         kind == EventKind::explored_again;
}

bool is_about_a_participant(EventKind kind) {
  return kind == EventKind::participant_excluded || kind == EventKind::participant_withdrawn;
}

}  // namespace

FoldScope scope_of(const Event& event) {
  if (is_about_a_participant(event.kind)) {
    return {.session = body_of(event, participant_from_json).session, .trial = {}};
  }
  if (event.kind == EventKind::participant_replaced) {
    return {.session = body_of(event, replacement_from_json).session, .trial = {}};
  }
  if (event.kind == EventKind::session_opened) {
    return {.session = body_of(event, session_opened_from_json).session, .trial = {}};
  }
  if (belongs_to_file_chain(event.kind)) return {};
  FoldScope scope{.session = event.session, .trial = {}};
  if (is_about_a_trial(event.kind)) {
    scope.trial = TrialId(event.session, body_of(event, trial_from_json).trial);
  }
  if (event.kind == EventKind::block_restarted) {
    scope.block = {event.session, body_of(event, block_from_json).block};
  }
  return scope;
}

void fold(DerivedRows& rows, const Event& event) {
  if (event.kind == EventKind::opened) return open_session(rows, event);
  if (event.kind == EventKind::participant_excluded) {
    return mark_participant(rows, event, &SessionRow::excluded);
  }
  if (event.kind == EventKind::participant_withdrawn) {
    return mark_participant(rows, event, &SessionRow::withdrawn);
  }
  if (event.kind == EventKind::participant_replaced) return replace_participant(rows, event);
  if (event.kind == EventKind::session_opened) return place_session(rows, event);
  if (!belongs_to_file_chain(event.kind)) fold_session_event(rows, event);
}

}  // namespace touchtrial::store
