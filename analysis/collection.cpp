#include "analysis/collection.hpp"

#include "analysis/collection_records.hpp"
#include "analysis/sealed_sessions.hpp"
#include "protocols/store/payload_json.hpp"

#include <algorithm>
#include <map>

namespace touchtrial::analysis {
namespace {

/// The row of a withdrawn session, without any data of the participant.
store::SessionRow without_participant(const store::SessionRow& row) {
  store::SessionRow bare;
  bare.session = row.session;
  bare.state = row.state;
  bare.withdrawn = true;
  return bare;
}

std::map<int, SessionRecord> empty_records(const std::vector<store::SessionRow>& rows) {
  std::map<int, SessionRecord> records;
  for (const store::SessionRow& row : rows) {
    records[row.session].row = row.withdrawn ? without_participant(row) : row;
  }
  return records;
}

/// The session that an event is about, on whichever chain the event is.
int session_named_by(const store::Event& event) {
  switch (event.kind) {
    case store::EventKind::participant_excluded:
      return store::participant_from_json(event.body).session;
    case store::EventKind::participant_replaced:
      return store::replacement_from_json(event.body).session;
    case store::EventKind::participant_noted:
      return store::note_from_json(event.body).session;
    default:
      return event.session;
  }
}

bool is_practice_failure(const Deviation& deviation) {
  return deviation.code == "practice-not-passed";
}

/// Sets the values that follow from all of a session's events together.
void finish(SessionRecord& record) {
  if (record.practice) {
    record.practice->passed = std::ranges::none_of(record.deviations, is_practice_failure);
  }
  // A stop does not count if the session was resumed after it.
  if (record.row.state != store::SessionState::stopped) record.stop_reason.clear();
}

}  // namespace

Collection load_collection(const store::StudyStore& store, const design::StudyKey* key) {
  const std::vector<store::SessionRow> rows = store.sessions();
  std::map<int, SessionRecord> records = empty_records(rows);
  Collection collection;
  collection.prescription = prescription_from_json(store.commitment().configuration);
  std::map<int, SecretKey> keys;
  if (key != nullptr) keys = participant_keys(store, *key);
  const auto add = [&](const store::Event& event) {
    const auto record = records.find(session_named_by(event));
    if (record == records.end() || record->second.row.withdrawn) return;
    const auto own = keys.find(event.session);
    const bool has_more = own != keys.end() && is_partly_sealed(event.kind);
    add_to_record(has_more ? whole_event(event, own->second).event : event, record->second);
    if (event.kind != store::EventKind::trace_stored) return;
    if (const auto servo = servo_trial_of(event)) collection.servo_trials.push_back(*servo);
  };
  store.for_each_of(kinds_in_sessions(), add);
  for (const store::Event& event : store.events(0)) add(event);  // later notes come last
  for (auto& [session, record] : records) {
    finish(record);
    collection.visual = collection.visual || (record.station && record.station->visual);
    collection.sessions.push_back(std::move(record));
  }
  collection.flow = participant_flow(rows, collection.sessions, store.commitment(), store.state());
  return collection;
}

}  // namespace touchtrial::analysis
