#include "analysis/outcomes/incidents.hpp"

#include "analysis/outcomes/sealed_sessions.hpp"
#include "record/marks.hpp"
#include "record/payload_json.hpp"

#include <algorithm>
#include <array>
#include <cstddef>
#include <span>
#include <utility>

namespace touchtrial::analysis {
namespace {

using record::EventKind;

constexpr std::size_t kSessionKinds = 8;  ///< kinds on sessions' chains, first in kIncidentKinds
constexpr std::array kIncidentKinds = {EventKind::interrupted,
                                       EventKind::break_taken,
                                       EventKind::paused,
                                       EventKind::resumed,
                                       EventKind::stopped,
                                       EventKind::noted,
                                       EventKind::deviated,
                                       EventKind::block_restarted,
                                       EventKind::participant_noted,
                                       EventKind::participant_excluded,
                                       EventKind::participant_replaced,
                                       EventKind::participant_withdrawn};

/// Reads the event's body into the incident.
/// \return whether an event of this kind is an incident
bool read_body(const record::Event& event, Incident& incident) {
  switch (event.kind) {
    case EventKind::interrupted: {
      auto body = record::from_json<record::InterruptedBody>(event.body);
      incident.trial = body.trial;
      incident.code = std::move(body.reason);
      incident.safety_fault = body.safety_fault.value_or("");
      incident.device_fault = body.device_fault.value_or("");
      return true;
    }
    case EventKind::paused: {
      auto body = record::from_json<record::PauseBody>(event.body);
      incident.text = std::move(body.text);
      incident.trial = body.trial;
      return true;
    }
    case EventKind::break_taken:
      incident.text = record::from_json<record::TextBody>(event.body).text;
      return true;
    case EventKind::noted:
      incident.text = record::from_json<record::RemarkBody>(event.body).text;
      return true;
    case EventKind::resumed: {
      record::ResumedBody body = record::from_json<record::ResumedBody>(event.body);
      incident.trial = body.trial;
      incident.code = std::move(body.after);
      return true;
    }
    case EventKind::block_restarted:
      return true;
    case EventKind::stopped: {
      record::StopBody body = record::from_json<record::StopBody>(event.body);
      incident.code = std::move(body.code);
      incident.text = std::move(body.text);
      return true;
    }
    case EventKind::deviated: {
      record::DeviationBody body = record::from_json<record::DeviationBody>(event.body);
      incident.code = std::move(body.code);
      incident.text = std::move(body.text);
      return true;
    }
    case EventKind::participant_noted: {
      record::NoteBody body = record::from_json<record::NoteBody>(event.body);
      incident.code = std::move(body.code);
      incident.text = std::move(body.text);
      return true;
    }
    case EventKind::participant_excluded: {
      record::ParticipantBody body = record::from_json<record::ParticipantBody>(event.body);
      incident.code = body.after_outcomes ? "after-outcomes" : "";
      incident.text = std::move(body.reason);
      return true;
    }
    case EventKind::participant_replaced:
      incident.text = record::from_json<record::ReplacementBody>(event.body).reason;
      return true;
    case EventKind::participant_withdrawn:
      incident.text = record::from_json<record::WithdrawalBody>(event.body).reason;
      return true;
    default:
      return false;
  }
}

}  // namespace

std::span<const EventKind> incident_kinds() {
  return kIncidentKinds;
}

std::optional<Incident> incident_of(const record::Event& event, const record::SessionRow& row) {
  Incident incident{row.participant, row.session, event.sequence, event.kind};
  if (!read_body(event, incident)) return std::nullopt;
  if (event.session == 0) {
    incident.utc = event.at;
  } else if (event.sealed.empty()) {
    incident.at = event.at;
  }
  return incident;
}

std::vector<Incident> load_incidents(const StudyEvents& study,
                                     const std::map<int, record::PersonKeys>& keys) {
  const record::StudyStore& store = study.store();
  std::map<int, record::SessionRow> rows;
  for (const record::SessionRow& row : store.sessions()) {
    if (!row.erased) rows[row.session] = row;
  }
  std::vector<Incident> incidents;
  const auto add = [&](const record::Event& event) {
    const auto row = rows.find(record::session_about(event));
    if (row == rows.end()) return;
    const auto key = keys.find(row->first);
    auto incident = incident_of(
        key == keys.end() ? event : readable_event(event, row->second, key->second), row->second);
    if (incident) incidents.push_back(*std::move(incident));
  };
  study.for_each_of(std::span(kIncidentKinds).first(kSessionKinds), add);
  for (const record::Event& event : store.events(0)) add(event);
  std::ranges::stable_sort(incidents, {}, &Incident::session);
  return incidents;
}

std::vector<InstrumentMark> load_marks(const StudyEvents& study,
                                       const std::map<int, record::PersonKeys>& keys) {
  constexpr std::array kMarkKinds = {EventKind::marked};
  std::map<int, std::string> participants;
  for (const record::SessionRow& row : study.store().sessions()) {
    participants[row.session] = row.participant;
  }
  std::vector<InstrumentMark> marks;
  study.for_each_of(kMarkKinds, [&](const record::Event& event) {
    const auto key = keys.find(event.session);
    if (key == keys.end() || !key->second.participant) return;
    const record::MarksBody body =
        record::from_json<record::MarksBody>(open_event(event, *key->second.participant).secret);
    for (std::size_t i = 0; i < body.codes.size(); ++i) {
      InstrumentMark mark{.participant = participants[event.session],
                          .session = event.session,
                          .trial = static_cast<int>(body.trials[i]),
                          .code = static_cast<int>(body.codes[i]),
                          .at = std::chrono::nanoseconds(body.at_ns[i])};
      if (body.latency_ns[i] > 0) mark.latency = std::chrono::nanoseconds(body.latency_ns[i]);
      if (body.lsl_zero_s) {
        mark.lsl_s = *body.lsl_zero_s + std::chrono::duration<double>(mark.at).count();
        mark.lsl_uncertainty_s = body.lsl_uncertainty_s;
      }
      marks.push_back(std::move(mark));
    }
  });
  std::ranges::stable_sort(marks, {}, &InstrumentMark::session);
  return marks;
}

}  // namespace touchtrial::analysis
