#include "analysis/exports/export_tables.hpp"

#include "analysis/exports/column_meanings.hpp"
#include "analysis/exports/export_folder.hpp"
#include "analysis/exports/people_tables.hpp"
#include "analysis/exports/study_tables.hpp"
#include "analysis/exports/trial_tables.hpp"
#include "analysis/outcomes/collection.hpp"
#include "analysis/outcomes/sealed_sessions.hpp"
#include "analysis/report/json_figures.hpp"
#include "analysis/report/results.hpp"
#include "core/strict_json.hpp"
#include "record/event_kinds.hpp"
#include "record/payload_json.hpp"

#include <algorithm>
#include <array>
#include <cstdint>
#include <iterator>
#include <map>
#include <string>
#include <utility>
#include <vector>

#include <fmt/format.h>
#include <nlohmann/json.hpp>

namespace touchtrial::analysis {
namespace {

using Json = nlohmann::ordered_json;

/// export.json, which describes the folder to readers who do not know the program.
std::string contents_json(const record::StudyStore& store, bool blinded,
                          const std::vector<ExportFile>& files) {
  const record::StudyCommitment& commitment = store.commitment();
  Json contents{{"study", commitment.study}, {"protocol", commitment.protocol}};
  put_stamp(contents, commitment.simulated, simulated_devices(store.sessions()));
  contents["study_id"] = commitment.study_id;
  contents["pilot"] = commitment.pilot;
  contents["blinded"] = blinded;
  contents["program_version"] = commitment.program_version;
  contents["files"] = Json::array();
  for (const ExportFile& file : files) contents["files"].push_back(file.name.string());
  return json_text(contents);
}

/// The detail of an interruption; empty for other events and in virtual time.
record::InterruptionDetail detail_of(const record::OpenedEvent& opened) {
  if (opened.event.kind != record::EventKind::interrupted || opened.secret.empty()) return {};
  return record::from_json<record::InterruptionDetail>(opened.secret);
}

record::OpenedEvent opened_event(const record::Event& event, const record::SessionRow& row,
                                 const record::PersonKeys& keys) {
  if (!belongs_to_file_chain(event.kind)) return open_event(event, *keys.participant);
  return {.event = readable_event(event, row, keys), .secret = {}};
}

/// Removes carriage returns, because all files of an export end their lines with single line feeds.
ExportFile flight_file(const std::string& name, std::string flight) {
  std::erase(flight, '\r');
  return text_file(name, std::move(flight));
}

struct JsonValue {
  Json operator()(std::monostate) const { return nullptr; }
  Json operator()(const std::string& text) const { return text; }
  Json operator()(std::int64_t number) const { return number; }
  Json operator()(double number) const { return number; }
  Json operator()(std::chrono::nanoseconds time) const {
    return std::chrono::duration<double>(time).count();
  }
};

/// The rows as an array of objects whose keys are the columns.
Json rows_json(const DataTable& table) {
  Json rows = Json::array();
  for (const std::vector<DataCell>& cells : table.rows) {
    Json row = Json::object();
    for (std::size_t i = 0; i < cells.size(); ++i) {
      row[table.columns[i]] = std::visit(JsonValue{}, cells[i]);
    }
    rows.push_back(std::move(row));
  }
  return rows;
}

std::vector<ExportFile> csv_files(const std::vector<ResultTable>& tables,
                                  const std::string& file_start = {}) {
  std::vector<ExportFile> files;
  for (const ResultTable& one : tables) {
    files.push_back(text_table_file(one.file, one.table, one.has_free_text, file_start));
  }
  return files;
}

}  // namespace

std::vector<record::EventKind> kinds_in_events_csv() {
  using record::EventKind;
  constexpr std::array kInOtherExports = {
      EventKind::opened,    EventKind::presented,    EventKind::first_contact, EventKind::answered,
      EventKind::timed_out, EventKind::trace_stored, EventKind::marked,        EventKind::closed};
  std::vector<EventKind> kinds = {EventKind::participant_noted};
  for (const record::EventKindRow& row : record::event_kinds()) {
    if (!belongs_to_file_chain(row.kind) && !std::ranges::count(kInOtherExports, row.kind)) {
      kinds.push_back(row.kind);
    }
  }
  return kinds;
}

std::vector<ResultTable> exported_tables(const record::StudyStore& store,
                                         const std::optional<Outcomes>& outcomes,
                                         const std::vector<record::PersonalRecord>& consents) {
  const bool simulated = store.commitment().simulated;
  const Collection collection = collection_of(store, outcomes);
  std::vector<ResultTable> tables = {{"trials.csv", trials_table(store, outcomes)},
                                     {"participants.csv", participants_table(store, collection)},
                                     {"deviations.csv", deviations_table(collection, simulated)},
                                     {"servo.csv", servo_table(collection, simulated)}};
  std::ranges::move(people_tables(store, outcomes, consents), std::back_inserter(tables));
  if (outcomes) {
    std::ranges::move(analysis_of(outcomes->design).tables(*outcomes), std::back_inserter(tables));
    tables.push_back({"unscored_trials.csv", unscored_table(*outcomes)});
    tables.push_back({"looks.csv", looks_table(*outcomes)});
  }
  tables.push_back({"study.csv", study_table(store, outcomes, collection)});
  return tables;
}

std::vector<std::filesystem::path> export_csv(const record::StudyStore& store,
                                              const std::optional<Outcomes>& outcomes,
                                              const std::filesystem::path& folder,
                                              const std::vector<record::PersonalRecord>& consents,
                                              const std::string& start) {
  const record::StudyCommitment& commitment = store.commitment();
  std::vector<ExportFile> files = csv_files(exported_tables(store, outcomes, consents), start);
  if (outcomes)
    files.push_back(text_file("study_file.json", without_comments(outcomes->design.text)));
  files.push_back(text_file("export.json", contents_json(store, !outcomes, files)));
  return write_export(folder, {commitment.study, commitment.study_id, "csv"}, files);
}

std::vector<std::filesystem::path> export_typed_text(
    const record::StudyStore& store, const Outcomes& outcomes, const std::filesystem::path& folder,
    const std::vector<record::PersonalRecord>& consents) {
  const record::StudyCommitment& commitment = store.commitment();
  return write_export(folder, {commitment.study, commitment.study_id, "r, typed text"},
                      csv_files(people_tables(store, outcomes, consents)));
}

std::vector<ExportFile> event_files(const record::StudyStore& store, const study::StudyKey& key,
                                    const Outcomes& outcomes, const std::string& prefix) {
  std::map<int, const record::SessionRow*> shown_rows;
  for (const SessionOutcome& session : outcomes.sessions)
    shown_rows[session.row.session] = &session.row;
  const std::map<int, record::PersonKeys> keys = person_keys(store, key);
  DataTable table{columns_of("events.csv"), {}};
  std::vector<ExportFile> files;
  store.for_each_of(kinds_in_events_csv(), [&](const record::Event& stored) {
    const auto session = shown_rows.find(record::session_about(stored));
    if (session == shown_rows.end()) return;
    const record::SessionRow& row = *session->second;
    const record::PersonKeys& session_keys = keys.at(row.session);
    if (!session_keys.participant) return;
    const record::OpenedEvent opened = opened_event(stored, row, session_keys);
    const record::Event& event = opened.event;
    record::InterruptionDetail detail = detail_of(opened);
    const bool in_session = event.session > 0;
    std::string flight;
    if (detail.ticks > 0) {
      flight = fmt::format("{}{}flight_{}_{}.csv", prefix, row.simulated ? "SIMULATED_" : "",
                           row.session, event.sequence);
      files.push_back(flight_file(flight, std::move(detail.flight)));
    }
    table.rows.push_back(
        {row.participant, std::int64_t{row.session}, event.sequence,
         std::string(name_of(event.kind)), in_session ? DataCell(event.at) : DataCell(),
         in_session ? DataCell() : utc_cell(event.at, row.simulated), event.body,
         detail.safety_fault, detail.device_fault, flight, std::int64_t{row.simulated}});
  });
  files.insert(files.begin(), text_file(prefix + "events.csv", csv_text(table)));
  return files;
}

std::vector<std::filesystem::path> export_events(const record::StudyStore& store,
                                                 const study::StudyKey& key,
                                                 const Outcomes& outcomes,
                                                 const std::filesystem::path& folder) {
  const std::vector<ExportFile> files = event_files(store, key, outcomes);
  const record::StudyCommitment& commitment = store.commitment();
  return write_export(folder, {commitment.study, commitment.study_id, "events"}, files);
}

std::filesystem::path export_json(const record::StudyStore& store,
                                  const std::optional<Outcomes>& outcomes,
                                  const std::filesystem::path& folder,
                                  const std::vector<record::PersonalRecord>& consents) {
  const record::StudyCommitment& commitment = store.commitment();
  Json document{{"study", commitment.study}, {"protocol", commitment.protocol}};
  put_stamp(document, commitment.simulated, simulated_devices(store.sessions()));
  document["study_id"] = commitment.study_id;
  if (outcomes) {
    document["report"] = Json::parse(analysis_of(outcomes->design).results(*outcomes, {})->json());
  } else {
    document["quality"] = quality_object(make_quality(store));
  }
  const Collection collection = collection_of(store, outcomes);
  document["participants"] = rows_json(participants_table(store, collection));
  document["deviations"] = rows_json(deviations_table(collection, commitment.simulated));
  document["servo"] = rows_json(servo_table(collection, commitment.simulated));
  document["trials"] = rows_json(trials_table(store, outcomes));
  if (outcomes) document["unscored_trials"] = rows_json(unscored_table(*outcomes));
  if (outcomes) document["answers"] = rows_json(answers_table(*outcomes));
  if (outcomes && !outcomes->marks.empty()) document["marks"] = rows_json(marks_table(*outcomes));
  document["incidents"] = rows_json(incidents_table(store, outcomes));
  if (!consents.empty()) document["consents"] = rows_json(consents_table(store, consents));
  const FileMode mode = outcomes ? FileMode::owner_only : FileMode::everyone;
  return write_export(folder, {commitment.study, commitment.study_id, "json"},
                      {text_file("study.json", json_text(document), mode)})
      .front();
}

}  // namespace touchtrial::analysis
