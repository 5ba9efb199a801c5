#include "analysis/collection_records.hpp"

#include "analysis/text_figures.hpp"
#include "protocols/store/payload_json.hpp"

#include <algorithm>
#include <array>

namespace touchtrial::analysis {
namespace {

constexpr std::array kKinds = {store::EventKind::opened,   store::EventKind::practised,
                               store::EventKind::deviated, store::EventKind::stopped,
                               store::EventKind::resumed,  store::EventKind::interrupted,
                               store::EventKind::paused,   store::EventKind::trace_stored,
                               store::EventKind::noted,    store::EventKind::closed};

void add_opening(const store::Event& event, SessionRecord& session) {
  store::SessionOpening opening = store::opening_from_json(event.body);
  session.device_serial = std::move(opening.device_serial);
  session.opened_utc = std::move(opening.opened_utc);
  session.station = std::move(opening.station);
  session.group = std::move(opening.group);
}

/// What a person wrote, if the event is opened.
std::string words_of(const store::Event& event, const std::string& text) {
  return event.sealed.empty() ? text : "(sealed)";
}

void add_exclusion(const store::Event& event, SessionRecord& session) {
  const store::ParticipantBody body = store::participant_from_json(event.body);
  session.exclusion_reason = words_of(event, body.reason);
  session.after_outcomes = body.after_outcomes;
}

std::string stop_in(const store::Event& event) {
  const store::StopBody body = store::stop_from_json(event.body);
  return body.code.empty() ? words_of(event, body.text) : body.code;
}

void add_end(const store::ClosedBody& closed, SessionRecord& session) {
  session.answers = closed.answers;
  session.one_key = closed.one_key;
  session.largest_force_n = closed.largest_force_n;
}

void add_practice(const store::PracticeBody& practised, SessionRecord& session) {
  if (!session.practice) session.practice.emplace();
  PracticeRecord& practice = *session.practice;
  practice.rounds = std::max(practice.rounds, practised.round);
  ++practice.presentations;
  if (practised.correct)
    practice.correct = practice.correct.value_or(0) + (*practised.correct ? 1 : 0);
}

void add_deviation(const std::string& code, const std::string& text, SessionRecord& session) {
  const bool known = std::ranges::any_of(session.deviations, [&](const Deviation& one) {
    return one.code == code && one.text == text;
  });
  if (!known) session.deviations.push_back({code, text});
}

}  // namespace

std::span<const store::EventKind> kinds_in_sessions() {
  return kKinds;
}

bool is_partly_sealed(store::EventKind kind) {
  switch (kind) {
    case store::EventKind::practised:
    case store::EventKind::deviated:
    case store::EventKind::stopped:
    case store::EventKind::closed:
    case store::EventKind::participant_excluded:
    case store::EventKind::participant_withdrawn:
    case store::EventKind::participant_replaced:
    case store::EventKind::participant_noted:
      return true;
    default:
      return false;
  }
}

void add_to_record(const store::Event& event, SessionRecord& session) {
  switch (event.kind) {
    case store::EventKind::opened:
      return add_opening(event, session);
    case store::EventKind::practised:
      return add_practice(store::practice_from_json(event.body), session);
    case store::EventKind::deviated: {
      const store::DeviationBody body = store::deviation_from_json(event.body);
      return add_deviation(body.code, body.text, session);
    }
    case store::EventKind::participant_noted: {
      const store::NoteBody body = store::note_from_json(event.body);
      if (!body.code.empty()) add_deviation(body.code, body.text, session);
      return;
    }
    case store::EventKind::participant_excluded:
      return add_exclusion(event, session);
    case store::EventKind::participant_replaced:
      session.replacement_reason = words_of(event, store::replacement_from_json(event.body).reason);
      return;
    case store::EventKind::stopped:
      session.stop_reason = stop_in(event);
      return;
    case store::EventKind::participant_withdrawn:
      session.withdrawal_reason = words_of(event, store::withdrawal_from_json(event.body).reason);
      return;
    case store::EventKind::resumed:
      // A session that was only paused does not count as resumed.
      if (store::resumed_from_json(event.body).after == "program-ended") ++session.resumed;
      return;
    case store::EventKind::interrupted:
      // A pause takes a presentation off and counts against nobody.
      if (store::trial_from_json(event.body).reason != store::kPauseReason) ++session.interruptions;
      return;
    case store::EventKind::paused:
      ++session.pauses;
      return;
    case store::EventKind::noted:
      ++session.notes;
      return;
    case store::EventKind::closed:
      return add_end(store::closed_from_json(event.body), session);
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
  const int kept = collection.flow.withdrawn - collection.flow.erased;
  if (kept > 0) {
    notes.push_back(counted(kept, "participant") +
                    " withdrew and let the data be used: counted like the others.");
  }
  for (const store::PersonLook& look : collection.looks) {
    notes.push_back(collection.is_public ? "Outcomes of one participant alone were looked at."
                                         : "Outcomes of participant " + look.participant +
                                               " alone were looked at: " + look.reason + ".");
  }
  return notes;
}

std::optional<ServoTrial> servo_trial_of(const store::Event& trace_stored) {
  if (!StudyEvents::names_servo(trace_stored)) return std::nullopt;
  const store::TraceBody body = store::trace_body_from_json(trace_stored.body);
  if (!body.servo) return std::nullopt;
  return ServoTrial{trace_stored.session, body.trial, *body.servo, body.overruns};
}

}  // namespace touchtrial::analysis
