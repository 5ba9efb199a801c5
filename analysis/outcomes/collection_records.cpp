#include "analysis/outcomes/collection_records.hpp"

#include "analysis/report/text_figures.hpp"
#include "record/payload_json.hpp"

#include <algorithm>
#include <array>

namespace touchtrial::analysis {
namespace {

constexpr std::array kCollectionKinds = {
    record::EventKind::opened,  record::EventKind::practised,    record::EventKind::deviated,
    record::EventKind::stopped, record::EventKind::resumed,      record::EventKind::interrupted,
    record::EventKind::paused,  record::EventKind::trace_stored, record::EventKind::noted,
    record::EventKind::closed};

void add_opening(const record::Event& event, SessionRecord& session) {
  record::SessionOpening opening = record::from_json<record::SessionOpening>(event.body);
  session.device_serial = std::move(opening.device_serial);
  session.opened_utc = std::move(opening.opened_utc);
  session.station = std::move(opening.station);
  session.group = std::move(opening.group);
}

/// The free text of an event, if it is opened.
std::string text_if_opened(const record::Event& event, const std::string& text) {
  return event.sealed.empty() ? text : "(sealed)";
}

void add_exclusion(const record::Event& event, SessionRecord& session) {
  const record::ParticipantBody body = record::from_json<record::ParticipantBody>(event.body);
  session.exclusion_reason = text_if_opened(event, body.reason);
  session.after_outcomes = body.after_outcomes;
}

std::string stop_reason_of(const record::Event& event) {
  const record::StopBody body = record::from_json<record::StopBody>(event.body);
  return body.code.empty() ? text_if_opened(event, body.text) : body.code;
}

void add_closing(const record::ClosedBody& body, SessionRecord& session) {
  session.answers = body.answers;
  session.one_key = body.one_key;
  session.largest_force_n = body.largest_force_n;
}

void add_practice(const record::PracticeBody& body, SessionRecord& session) {
  if (!session.practice) session.practice.emplace();
  PracticeRecord& practice = *session.practice;
  practice.rounds = std::max(practice.rounds, body.round);
  ++practice.presentations;
  if (body.correct) practice.correct = practice.correct.value_or(0) + (*body.correct ? 1 : 0);
}

void add_deviation(const std::string& code, const std::string& text, SessionRecord& session) {
  const bool is_duplicate = std::ranges::any_of(session.deviations, [&](const Deviation& one) {
    return one.code == code && one.text == text;
  });
  if (!is_duplicate) session.deviations.push_back({code, text});
}

}  // namespace

std::span<const record::EventKind> collection_event_kinds() {
  return kCollectionKinds;
}

bool is_partly_sealed(record::EventKind kind) {
  switch (kind) {
    case record::EventKind::practised:
    case record::EventKind::deviated:
    case record::EventKind::stopped:
    case record::EventKind::closed:
    case record::EventKind::participant_excluded:
    case record::EventKind::participant_withdrawn:
    case record::EventKind::participant_replaced:
    case record::EventKind::participant_noted:
      return true;
    default:
      return false;
  }
}

void add_to_record(const record::Event& event, SessionRecord& session) {
  switch (event.kind) {
    case record::EventKind::opened:
      return add_opening(event, session);
    case record::EventKind::practised:
      return add_practice(record::from_json<record::PracticeBody>(event.body), session);
    case record::EventKind::deviated: {
      const record::DeviationBody body = record::from_json<record::DeviationBody>(event.body);
      return add_deviation(body.code, body.text, session);
    }
    case record::EventKind::participant_noted: {
      const record::NoteBody body = record::from_json<record::NoteBody>(event.body);
      if (!body.code.empty()) add_deviation(body.code, body.text, session);
      return;
    }
    case record::EventKind::participant_excluded:
      return add_exclusion(event, session);
    case record::EventKind::participant_replaced:
      session.replacement_reason =
          text_if_opened(event, record::from_json<record::ReplacementBody>(event.body).reason);
      return;
    case record::EventKind::stopped:
      session.stop_reason = stop_reason_of(event);
      return;
    case record::EventKind::participant_withdrawn:
      session.withdrawal_reason =
          text_if_opened(event, record::from_json<record::WithdrawalBody>(event.body).reason);
      return;
    case record::EventKind::resumed:
      // Continuing after a pause does not count as resuming.
      if (record::from_json<record::ResumedBody>(event.body).after == "program-ended")
        ++session.resumed;
      return;
    case record::EventKind::interrupted:
      // A pause interrupts a presentation, but is not counted as an interruption.
      if (record::from_json<record::InterruptedBody>(event.body).reason != record::kPauseReason)
        ++session.interruptions;
      return;
    case record::EventKind::paused:
      ++session.pauses;
      return;
    case record::EventKind::noted:
      ++session.notes;
      return;
    case record::EventKind::closed:
      return add_closing(record::from_json<record::ClosedBody>(event.body), session);
    default:
      return;
  }
}

std::string exclusion_words(const SessionRecord& session) {
  const bool is_late = session.after_outcomes && !session.exclusion_reason.empty();
  return (is_late ? "after outcomes were seen: " : "") + session.exclusion_reason;
}

std::vector<std::string> people_notes(const Collection& collection) {
  std::vector<std::string> notes;
  const int not_erased = collection.flow.withdrawn - collection.flow.erased;
  if (not_erased > 0) {
    notes.push_back(counted(not_erased, "participant") +
                    " withdrew but let the data be used; they are counted like the others.");
  }
  for (const record::PersonLook& look : collection.looks) {
    notes.push_back(collection.is_public ? "The outcomes of one participant were viewed separately."
                                         : "The outcomes of participant " + look.participant +
                                               " were viewed separately: " + look.reason + ".");
  }
  return notes;
}

std::optional<ServoTrial> servo_trial_of(const record::Event& trace_stored) {
  if (!StudyEvents::has_servo(trace_stored)) return std::nullopt;
  const record::TraceBody body = record::from_json<record::TraceBody>(trace_stored.body);
  if (!body.servo) return std::nullopt;
  return ServoTrial{trace_stored.session, body.trial, *body.servo, body.overruns};
}

}  // namespace touchtrial::analysis
