#include "analysis/outcomes/incidents.hpp"

#include "analysis/outcomes/sealed_sessions.hpp"
#include "record/marks.hpp"
#include "record/payload_json.hpp"

#include <algorithm>
#include <array>
#include <utility>

namespace touchtrial::analysis {
namespace {

using record::EventKind;

constexpr std::array kIncidents = {
    EventKind::interrupted, EventKind::break_taken, EventKind::paused,  EventKind::stopped,
    EventKind::noted,       EventKind::deviated,    EventKind::resumed, EventKind::block_restarted};

/// A remark's text, if it is not sealed.
std::string remark_in(const record::Event& event) {
  return event.sealed.empty() || event.kind == EventKind::break_taken
             ? record::remark_from_json(event.body)
             : "";
}

/// Fills in what the body says.
/// \return whether an event of this kind is an incident
bool take_body(const record::Event& event, Incident& incident) {
  switch (event.kind) {
    case EventKind::interrupted: {
      record::TrialBody body = record::trial_from_json(event.body);
      incident.trial = body.trial;
      incident.code = std::move(body.reason);
      incident.safety_fault = std::move(body.safety_fault);
      incident.device_fault = std::move(body.device_fault);
      return true;
    }
    case EventKind::paused:
      incident.text = remark_in(event);
      incident.trial = record::pause_from_json(event.body).trial;
      return true;
    case EventKind::break_taken:
    case EventKind::noted:
      incident.text = remark_in(event);
      return true;
    case EventKind::resumed: {
      record::ResumedBody body = record::resumed_from_json(event.body);
      incident.trial = body.trial;
      incident.code = std::move(body.after);
      return true;
    }
    case EventKind::block_restarted:
      return true;
    case EventKind::stopped: {
      record::StopBody body = record::stop_from_json(event.body);
      incident.code = std::move(body.code);
      incident.text = std::move(body.text);
      return true;
    }
    case EventKind::deviated: {
      record::DeviationBody body = record::deviation_from_json(event.body);
      incident.code = std::move(body.code);
      incident.text = std::move(body.text);
      return true;
    }
    case EventKind::participant_noted: {
      record::NoteBody body = record::note_from_json(event.body);
      incident.code = std::move(body.code);
      incident.text = std::move(body.text);
      return true;
    }
    case EventKind::participant_excluded: {
      record::ParticipantBody body = record::participant_from_json(event.body);
      incident.code = body.after_outcomes ? "after-outcomes" : "";
      incident.text = std::move(body.reason);
      return true;
    }
    case EventKind::participant_replaced:
      incident.text = record::replacement_from_json(event.body).reason;
      return true;
    case EventKind::participant_withdrawn:
      incident.text = record::withdrawal_from_json(event.body).reason;
      return true;
    default:
      return false;
  }
}

}  // namespace

std::optional<Incident> incident_of(const record::Event& event, const record::SessionRow& row) {
  Incident incident{row.participant, row.session, event.sequence, event.kind};
  if (!take_body(event, incident)) return std::nullopt;
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
    const auto own = keys.find(row->first);
    auto incident = incident_of(
        own == keys.end() ? event : readable_event(event, row->second, own->second), row->second);
    if (incident) incidents.push_back(*std::move(incident));
  };
  study.for_each_of(kIncidents, add);
  for (const record::Event& event : store.events(0)) add(event);
  std::ranges::stable_sort(incidents, {}, &Incident::session);
  return incidents;
}

std::vector<InstrumentMark> load_marks(const StudyEvents& study,
                                       const std::map<int, record::PersonKeys>& keys) {
  constexpr std::array kMarked = {EventKind::marked};
  std::map<int, std::string> participants;
  for (const record::SessionRow& row : study.store().sessions()) {
    participants[row.session] = row.participant;
  }
  std::vector<InstrumentMark> marks;
  study.for_each_of(kMarked, [&](const record::Event& event) {
    const auto own = keys.find(event.session);
    if (own == keys.end() || !own->second.participant) return;
    const record::MarksBody body =
        record::marks_from_json(whole_event(event, *own->second.participant).secret);
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
