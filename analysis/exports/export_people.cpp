#include "analysis/exports/export_people.hpp"

#include "analysis/exports/column_meanings.hpp"
#include "analysis/exports/export_folder.hpp"
#include "analysis/exports/export_tables.hpp"
#include "analysis/exports/people_tables.hpp"
#include "analysis/exports/study_tables.hpp"
#include "analysis/exports/trial_tables.hpp"
#include "analysis/outcomes/incidents.hpp"
#include "analysis/outcomes/sealed_sessions.hpp"
#include "core/errors.hpp"
#include "record/payload_json.hpp"

#include <algorithm>
#include <array>
#include <map>
#include <set>
#include <utility>

namespace touchtrial::analysis {
namespace {

using record::EventKind;

/// The rows with one of the values in a column.
DataTable rows_matching(DataTable table, const std::string& column,
                        const std::set<DataCell>& values) {
  const auto found = std::ranges::find(table.columns, column);
  const auto index = static_cast<std::size_t>(found - table.columns.begin());
  std::erase_if(table.rows, [&](const auto& row) { return !values.contains(row[index]); });
  return table;
}

DataTable session_times(const record::StudyStore& store,
                        const std::vector<record::SessionRow>& rows) {
  DataTable table{columns_of("sessions.csv"), {}};
  std::map<int, std::chrono::nanoseconds> opening_times;
  std::map<int, std::chrono::nanoseconds> closing_times;
  for (const record::Event& event : store.events(0)) {
    if (event.kind == EventKind::session_opened)
      opening_times[record::session_about(event)] = event.at;
    if (event.kind == EventKind::session_closed)
      closing_times[record::session_about(event)] = event.at;
  }
  for (const record::SessionRow& row : rows) {
    const auto end = closing_times.find(row.session);
    table.rows.push_back(
        {row.participant, std::int64_t{row.session},
         utc_cell(opening_times.at(row.session), row.simulated),
         end == closing_times.end() ? DataCell() : utc_cell(end->second, row.simulated),
         flag(row.simulated)});
  }
  return table;
}

/// One row per consent, with the personal data from that consent.
DataTable personal_table(const std::vector<record::PersonalRecord>& consents) {
  DataTable table{columns_of("personal.csv"), {}};
  for (const record::PersonalRecord& one : consents) {
    table.rows.push_back({one.participant, one.consent_version, one.consented_utc,
                          one.age ? DataCell(std::int64_t{*one.age}) : DataCell(), one.gender,
                          one.contact});
  }
  return table;
}

// The safety record.

constexpr std::array kSafetyRecordKinds = {EventKind::interrupted, EventKind::stopped,
                                           EventKind::deviated};

/// A remark without a code is not part of the safety record.
bool is_safety_incident(const Incident& incident) {
  return incident.kind != EventKind::participant_noted || !incident.code.empty();
}

/// The presentations that a session's largest force covers.
enum class ForceCoverage { none, session, so_far, unknown };

DataCell coverage_cell(ForceCoverage source) {
  switch (source) {
    case ForceCoverage::none:
      return "none";
    case ForceCoverage::session:
      return "session";
    case ForceCoverage::so_far:
      return "so-far";
    case ForceCoverage::unknown:
      break;
  }
  return "not-known";
}

/// Collects the tables of safety_sessions.csv and safety_events.csv.
class SafetyRecord {
 public:
  SafetyRecord(const record::StudyStore& store, const study::StudyKey* key) {
    if (key != nullptr) {
      require_key_of(store, *key);
      keys_ = person_keys(store, *key);
    }
    for (const record::SessionRow& row : store.sessions()) sessions_[row.session].row = row;
    store.for_each(EventKind::closed, [&](const record::Event& stored) {
      Session& session = sessions_.at(stored.session);
      const record::Event event = with_open_text(stored, session.row);
      if (!event.sealed.empty()) return;
      session.largest_force_n = record::from_json<record::ClosedBody>(event.body).largest_force_n;
      session.force_coverage =
          session.largest_force_n ? ForceCoverage::session : ForceCoverage::none;
    });
    for (auto& [number, session] : sessions_) {
      if (session.force_coverage == ForceCoverage::unknown) open_forces(store, session);
    }
    store.for_each_of(kSafetyRecordKinds, [&](const record::Event& event) { add(event); });
    for (const record::Event& event : store.events(0)) add(event);
  }

  [[nodiscard]] DataTable sessions() const {
    DataTable table{columns_of("safety_sessions.csv"), {}};
    for (const auto& [number, one] : sessions_) {
      table.rows.push_back({one.row.participant, std::int64_t{number},
                            std::string(name_of(one.row.state)), flag(one.row.excluded),
                            flag(one.row.withdrawn), flag(one.row.erased), one.row.device,
                            one.interruptions, one.stops, one.deviations,
                            one.largest_force_n ? DataCell(*one.largest_force_n) : DataCell(),
                            coverage_cell(one.force_coverage), flag(one.row.simulated)});
    }
    return table;
  }
  [[nodiscard]] const DataTable& events() const noexcept { return events_; }

 private:
  struct Session {
    record::SessionRow row;
    std::optional<double> largest_force_n{};
    ForceCoverage force_coverage = ForceCoverage::unknown;
    std::int64_t interruptions = 0;
    std::int64_t stops = 0;
    std::int64_t deviations = 0;
  };

  /// Reads the largest force of open sessions from their events, which are sealed under the
  /// participant's key, and nothing else.
  void open_forces(const record::StudyStore& store, Session& session) const {
    const auto keys = keys_.find(session.row.session);
    if (keys == keys_.end() || !keys->second.participant) return;
    session.force_coverage = ForceCoverage::none;
    for (const record::Event& stored : store.events(session.row.session)) {
      const bool is_trace = stored.kind == EventKind::trace_stored;
      if (!is_trace && stored.kind != EventKind::interrupted) continue;
      const record::Event event = open_event(stored, *keys->second.participant).event;
      const double force_n = is_trace
                                 ? record::from_json<record::TraceBody>(event.body).largest_force_n
                                 : record::from_json<record::InterruptedBody>(event.body)
                                       .largest_force_n.value_or(0.0);
      session.largest_force_n =
          std::max(session.largest_force_n.value_or(0.0), record::in_tenths(force_n));
      session.force_coverage = ForceCoverage::so_far;
    }
  }

  void add(const record::Event& stored) {
    const auto found = sessions_.find(record::session_about(stored));
    if (found == sessions_.end()) return;
    Session& session = found->second;
    const record::Event event = with_open_text(stored, session.row);
    const std::optional<Incident> incident = incident_of(event, session.row);
    if (!incident || !is_safety_incident(*incident) || incident->code == record::kPauseReason)
      return;
    session.interruptions += event.kind == EventKind::interrupted ? 1 : 0;
    session.stops += event.kind == EventKind::stopped ? 1 : 0;
    session.deviations +=
        event.kind == EventKind::deviated || event.kind == EventKind::participant_noted ? 1 : 0;
    std::vector<DataCell>& row = events_.rows.emplace_back(incident_cells(*incident));
    const DataCell utc =
        incident->utc ? utc_cell(*incident->utc, session.row.simulated) : DataCell();
    row.insert(row.begin() + 5, utc);
    row.push_back(flag(session.row.simulated));
  }

  /// The event with its text, if the safety key opens it. Interruptions stay sealed, because their
  /// sealed part records the presented texture.
  [[nodiscard]] record::Event with_open_text(const record::Event& event,
                                             const record::SessionRow& row) const {
    const auto keys = keys_.find(row.session);
    if (keys == keys_.end() || event.kind == EventKind::interrupted) return event;
    return readable_event(event, row, {.participant = {}, .safety = keys->second.safety});
  }

  std::map<int, record::PersonKeys> keys_;
  std::map<int, Session> sessions_;
  DataTable events_{columns_of("safety_events.csv"), {}};
};

}  // namespace

std::vector<std::filesystem::path> export_participant(
    const DatasetSource& study, const std::string& participant,
    const std::vector<record::PersonalRecord>& consents, const std::filesystem::path& folder) {
  const record::StudyStore& store = study.store;
  const record::StudyCommitment& commitment = store.commitment();
  const std::vector<record::SessionRow> rows = store.sessions_of(participant);
  if (rows.empty() && consents.empty()) {
    throw StoreError(one_line("participant " + participant +
                              " has no session and no personal data; check the participant id"));
  }
  const std::string prefix = participant_label(participant) + "_";
  std::vector<ExportFile> files;
  const auto add = [&](const std::string& name, const DataTable& table) {
    files.push_back(text_file(prefix + name, csv_text(table)));
  };
  const std::set<DataCell> id = {participant};
  std::set<DataCell> sessions;
  for (const record::SessionRow& row : rows) sessions.insert(std::int64_t{row.session});
  const std::optional<Outcomes> outcomes =
      study.outcomes != nullptr ? std::optional(*study.outcomes) : std::nullopt;
  const Collection collection = collection_of(store, outcomes);
  add("sessions.csv", session_times(store, rows));
  add("participants.csv", rows_matching(participants_table(store, collection), "participant", id));
  add("trials.csv", rows_matching(trials_table(store, outcomes), "participant", id));
  add("deviations.csv",
      rows_matching(deviations_table(collection, commitment.simulated), "participant", id));
  add("servo.csv",
      rows_matching(servo_table(collection, commitment.simulated), "session", sessions));
  const DataTable incidents = rows_matching(incidents_table(store, outcomes), "participant", id);
  files.push_back(text_table_file(prefix + "incidents.csv", incidents, outcomes.has_value()));
  if (!consents.empty()) {
    files.push_back(text_table_file(prefix + "personal.csv", personal_table(consents), true));
  }
  if (outcomes) {
    files.push_back(text_table_file(prefix + "answers.csv", answers_table(*outcomes), true));
    add("unscored_trials.csv", unscored_table(*outcomes));
    for (ExportFile& file : event_files(store, *study.key, *outcomes, prefix)) {
      files.push_back(std::move(file));
    }
  }
  return write_export(folder, {commitment.study, commitment.study_id, prefix + "participant"},
                      files);
}

std::vector<std::filesystem::path> export_safety(const record::StudyStore& store,
                                                 const study::StudyKey* key,
                                                 const std::filesystem::path& folder) {
  const record::StudyCommitment& commitment = store.commitment();
  const SafetyRecord record(store, key);
  return write_export(folder, {commitment.study, commitment.study_id, "safety"},
                      {text_file("safety_sessions.csv", csv_text(record.sessions())),
                       text_file("safety_events.csv", csv_text(record.events()),
                                 key != nullptr ? FileMode::owner_only : FileMode::everyone)});
}

}  // namespace touchtrial::analysis
