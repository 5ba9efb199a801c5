#include "analysis/collection_records.hpp"

#include "protocols/store/payload_json.hpp"

#include <algorithm>
#include <array>

namespace touchtrial {
namespace {

constexpr std::array kKinds = {EventKind::opened,  EventKind::practised, EventKind::deviated,
                               EventKind::stopped, EventKind::resumed,   EventKind::trace_stored};

void add_opening(const Event& event, SessionRecord& session) {
  SessionOpening opening = opening_from_json(event.body);
  session.device_serial = std::move(opening.device_serial);
  session.opened_utc = std::move(opening.opened_utc);
  session.station = std::move(opening.station);
}

void add_practice(const PracticeBody& practised, SessionRecord& session) {
  if (!session.practice) session.practice.emplace();
  PracticeRecord& practice = *session.practice;
  practice.rounds = std::max(practice.rounds, practised.round);
  ++practice.presentations;
  if (practised.correct) ++practice.correct;
}

void add_deviation(const std::string& code, const std::string& text, SessionRecord& session) {
  const bool known = std::ranges::any_of(session.deviations, [&](const Deviation& one) {
    return one.code == code && one.text == text;
  });
  if (!known) session.deviations.push_back({code, text});
}

}  // namespace

std::span<const EventKind> kinds_in_sessions() {
  return kKinds;
}

void add_to_record(const Event& event, SessionRecord& session) {
  switch (event.kind) {
    case EventKind::opened:
      return add_opening(event, session);
    case EventKind::practised:
      return add_practice(practice_from_json(event.body), session);
    case EventKind::deviated: {
      const DeviationBody body = deviation_from_json(event.body);
      return add_deviation(body.code, body.text, session);
    }
    case EventKind::participant_noted: {
      const NoteBody body = note_from_json(event.body);
      if (!body.code.empty()) add_deviation(body.code, body.text, session);
      return;
    }
    case EventKind::participant_excluded:
      session.exclusion_reason = participant_from_json(event.body).reason;
      return;
    case EventKind::participant_replaced:
      session.replacement_reason = replacement_from_json(event.body).reason;
      return;
    case EventKind::stopped:
      session.stop_reason = remark_from_json(event.body);
      return;
    case EventKind::resumed:
      // After a pause the program was there all the time.
      if (resumed_from_json(event.body).after == "program-ended") ++session.resumed;
      return;
    default:
      return;
  }
}

std::optional<ServoTrial> servo_trial_of(const Event& trace_stored) {
  // Most traces are of simulated sessions: what does not name a servo need not be parsed.
  if (trace_stored.body.find("\"servo\"") == std::string::npos) return std::nullopt;
  const TraceBody body = trace_body_from_json(trace_stored.body);
  if (!body.servo) return std::nullopt;
  return ServoTrial{trace_stored.session, body.trial, *body.servo, body.overruns};
}

}  // namespace touchtrial
