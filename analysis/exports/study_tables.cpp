#include "analysis/exports/study_tables.hpp"

#include "analysis/exports/column_meanings.hpp"
#include "analysis/outcomes/collection.hpp"
#include "core/strict_json.hpp"
#include "core/utc.hpp"

#include <algorithm>
#include <array>
#include <iterator>
#include <map>
#include <set>
#include <utility>

#include <fmt/ranges.h>

namespace touchtrial::analysis {
namespace {

struct RecordColumn {
  const char* name;
  DataCell (*value)(const SessionRecord&);
  bool after_unblinding = false;  ///< the column exists only after unblinding
};

template <int PracticeRecord::*kNumber>
DataCell practice_number(const SessionRecord& record) {
  if (!record.practice) return std::monostate{};
  return std::int64_t{(*record.practice).*kNumber};
}

template <int SessionRecord::*kNumber>
DataCell record_number(const SessionRecord& record) {
  return std::int64_t{record.*kNumber};
}

template <std::string record::StationRecord::*kText>
DataCell station_text(const SessionRecord& record) {
  if (!record.station) return std::monostate{};
  return (*record.station).*kText;
}

template <double record::StationRecord::*kNumber>
DataCell station_number(const SessionRecord& record) {
  if (!record.station) return std::monostate{};
  return (*record.station).*kNumber;
}

template <std::array<double, 3> record::StationRecord::*kAxes>
DataCell station_axes(const SessionRecord& record) {
  if (!record.station) return std::monostate{};
  const std::array<double, 3>& axes = (*record.station).*kAxes;
  return number_text(axes[0]) + ' ' + number_text(axes[1]) + ' ' + number_text(axes[2]);
}

/// How a session was collected. Deviations are in a separate table, because a session may have
/// several.
constexpr RecordColumn kRecordColumns[] = {
    {"practice_rounds", practice_number<&PracticeRecord::rounds>},
    {"practice_presentations", practice_number<&PracticeRecord::presentations>},
    {"practice_correct",
     [](const SessionRecord& record) -> DataCell {
       if (!record.practice || !record.practice->correct) return std::monostate{};
       return std::int64_t{*record.practice->correct};
     },
     true},
    {"order_block", [](const SessionRecord& record) { return optional_cell(record.order_block); },
     true},
    {"practice_passed",
     [](const SessionRecord& record) -> DataCell {
       if (!record.practice) return std::monostate{};
       return flag(record.practice->passed);
     }},
    {"resumed", record_number<&SessionRecord::resumed>},
    {"stop_reason", [](const SessionRecord& record) -> DataCell { return record.stop_reason; }},
    {"exclusion_reason",
     [](const SessionRecord& record) -> DataCell { return exclusion_words(record); }},
    {"replacement_reason",
     [](const SessionRecord& record) -> DataCell { return record.replacement_reason; }},
    {"withdrawal_reason",
     [](const SessionRecord& record) -> DataCell { return record.withdrawal_reason; }},
    {"largest_force_n",
     [](const SessionRecord& record) { return optional_cell(record.largest_force_n); }},
    {"station",
     [](const SessionRecord& record) -> DataCell {
       if (record.row.station == 0) return std::monostate{};
       return std::int64_t{record.row.station};
     }},
    {"device_serial", [](const SessionRecord& record) -> DataCell { return record.device_serial; }},
    {"device_model", station_text<&record::StationRecord::model>},
    {"device_firmware", station_text<&record::StationRecord::firmware>},
    {"device_max_force_n", station_number<&record::StationRecord::max_force_n>},
    {"device_force_scale", station_axes<&record::StationRecord::force_scale>},
    {"device_length_scale", station_axes<&record::StationRecord::length_scale>},
    {"certificate", station_text<&record::StationRecord::calibration>},
    {"servo_hz", station_number<&record::StationRecord::rate_hz>},
    {"scheduling", station_text<&record::StationRecord::scheduling>},
    {"visual",
     [](const SessionRecord& record) -> DataCell {
       if (!record.station) return std::monostate{};
       return flag(record.station->visual);
     }},
    {"interruptions", record_number<&SessionRecord::interruptions>},
    {"pauses", record_number<&SessionRecord::pauses>},
    {"notes", record_number<&SessionRecord::notes>},
    {"answers", [](const SessionRecord& record) { return optional_cell(record.answers); }},
    {"one_key",
     [](const SessionRecord& record) -> DataCell {
       if (!record.answers) return std::monostate{};
       return flag(record.one_key);
     }},
    {"handedness_score",
     [](const SessionRecord& record) { return optional_cell(record.handedness_score); }, true},
};

void add_record(std::vector<DataCell>& row, const SessionRecord& record, bool unblinded) {
  for (const RecordColumn& column : kRecordColumns) {
    if (column.after_unblinding && !unblinded) continue;
    if (record.row.erased) {
      row.emplace_back(std::monostate{});
    } else {
      row.push_back(column.value(record));
    }
  }
}

/// The decisions about a session after a look at its outcomes, separated by "; ".
std::string decisions_after_look(const LookRecord& looks, int session) {
  std::vector<std::string> decisions;
  if (looks.excluded_afterwards.contains(session)) decisions.emplace_back("excluded");
  if (looks.replaced_afterwards.contains(session)) decisions.emplace_back("replaced");
  if (looks.erased_afterwards.contains(session)) decisions.emplace_back("erased");
  return fmt::format("{}", fmt::join(decisions, "; "));
}

std::vector<DataCell> session_cells(const record::SessionRow& row, const record::StudyState& state,
                                    const LookRecord& looks, const std::set<int>& counted) {
  const bool is_shown = !state.unblinded || state.reports(row.session);
  return {row.participant,
          std::int64_t{row.session},
          std::int64_t{row.enrolment},
          std::string(name_of(row.state)),
          flag(row.excluded),
          flag(row.withdrawn),
          flag(row.erased),
          flag(row.pilot),
          flag(row.simulated),
          flag(counted.contains(row.session)),
          row.device,
          row.replaced_by,
          decisions_after_look(looks, row.session),
          flag(is_shown)};
}

void add_prescription(DataTable& study, const Prescription& prescription) {
  const auto add = [&](const char* key, DataCell value) {
    study.rows.push_back({std::string(key), std::monostate{}, std::move(value)});
  };
  add("explore_limit_s", prescription.explore_limit_s);
  add("on_timeout", prescription.on_timeout);
  add("order", prescription.order);
  add("repeats", std::int64_t{prescription.repeats});
  add("method_orders", std::int64_t{prescription.method_orders});
  add("sight", prescription.sight);
  add("masking_wanted", flag(prescription.masking_wanted));
  add("masking_dbfs", prescription.masking_dbfs);
  if (prescription.visits > 1) add("visits", std::int64_t{prescription.visits});
  for (const std::string& group : prescription.groups) add("group", group);
}

void add_labels(DataTable& table, const Outcomes& outcomes) {
  for (std::size_t i = 0; i < outcomes.classes.size(); ++i) {
    table.rows.push_back({std::string("class"), std::monostate{}, outcomes.classes[i]});
    for (const std::string& exemplar : outcomes.exemplars[i]) {
      table.rows.push_back({std::string("exemplar"), outcomes.classes[i], exemplar});
    }
  }
  for (const std::string& method : outcomes.methods) {
    table.rows.push_back({std::string("method"), std::monostate{}, method});
  }
}

}  // namespace

DataTable study_table(const record::StudyStore& store, const std::optional<Outcomes>& outcomes,
                      const Collection& collection) {
  const record::StudyCommitment& commitment = store.commitment();
  const record::StudyState state = store.state();
  DataTable table{{"key", "of", "value"}, {}};
  const auto add = [&](const char* key, DataCell value) {
    table.rows.push_back({std::string(key), std::monostate{}, std::move(value)});
  };
  add("study", commitment.study);
  add("study_id", commitment.study_id);
  add("protocol", commitment.protocol);
  add("simulated", flag(commitment.simulated));
  add("pilot", flag(commitment.pilot));
  add("closed", flag(state.closed));
  add("unblinded", flag(state.unblinded));
  add("interim", flag(state.interim.has_value()));
  add("program_version", commitment.program_version);
  add_prescription(table, collection.prescription);
  if (!outcomes) return table;
  add("unblinding_reason", state.unblinding_reason);
  add("visual", flag(outcomes->visual));
  add_labels(table, *outcomes);
  return table;
}

std::vector<std::string> participant_columns(bool unblinded) {
  std::vector<std::string> columns{
      "participant", "session",   "enrolment", "state",  "excluded",    "withdrawn",  "erased",
      "pilot",       "simulated", "counted",   "device", "replaced_by", "after_look", "shown"};
  for (const RecordColumn& column : kRecordColumns) {
    if (unblinded || !column.after_unblinding) columns.emplace_back(column.name);
  }
  return columns;
}

DataTable participants_table(const record::StudyStore& store, const Collection& collection) {
  std::map<int, const SessionRecord*> records;
  for (const SessionRecord& record : collection.sessions) records[record.row.session] = &record;
  const record::StudyState state = store.state();
  const LookRecord looks = look_record(store, {});
  DataTable table{participant_columns(state.unblinded), {}};
  const std::vector<record::SessionRow> rows = store.sessions();
  std::vector<record::SessionRow> shown_rows;
  std::ranges::copy_if(rows, std::back_inserter(shown_rows), [&](const record::SessionRow& row) {
    return !state.unblinded || state.reports(row.session);
  });
  const std::set<int> counted = counted_sessions(shown_rows, store.commitment());
  for (const record::SessionRow& row : rows) {
    table.rows.push_back(session_cells(row, state, looks, counted));
    add_record(table.rows.back(), *records.at(row.session), state.unblinded);
  }
  add_visit_and_group(table, collection);
  return table;
}

void add_visit_and_group(DataTable& table, const Collection& collection) {
  const bool has_visits = collection.prescription.visits > 1;
  const bool has_groups = !collection.prescription.groups.empty();
  if (has_visits) table.columns.emplace_back("visit");
  if (has_groups) table.columns.emplace_back("group");
  if (!has_visits && !has_groups) return;
  std::map<std::int64_t, const SessionRecord*> records;
  for (const SessionRecord& record : collection.sessions) records[record.row.session] = &record;
  const auto column = std::ranges::find(table.columns, "session") - table.columns.begin();
  for (std::vector<DataCell>& row : table.rows) {
    const SessionRecord& record =
        *records.at(std::get<std::int64_t>(row[static_cast<std::size_t>(column)]));
    const auto add = [&](DataCell cell) {
      row.push_back(record.row.erased ? DataCell() : std::move(cell));
    };
    if (has_visits) add(std::int64_t{record.row.visit});
    if (has_groups) add(record.group.empty() ? DataCell() : DataCell(record.group));
  }
}

DataTable deviations_table(const Collection& collection, bool simulated) {
  DataTable table{columns_of("deviations.csv"), {}};
  for (const SessionRecord& record : collection.sessions) {
    for (const auto& [code, text] : record.deviations) {
      table.rows.push_back(
          {record.row.participant, std::int64_t{record.row.session}, code, text, flag(simulated)});
    }
  }
  return table;
}

DataTable servo_table(const Collection& collection, bool simulated) {
  DataTable table{columns_of("servo.csv"), {}};
  for (const auto& [session, trial, health, overruns] : collection.servo_trials) {
    table.rows.push_back({std::int64_t{session}, std::int64_t{trial}, health.rate_hz,
                          health.lateness_p50_us, health.lateness_p99_us, health.lateness_p999_us,
                          health.lateness_worst_us, health.lost, health.held, overruns,
                          flag(simulated)});
  }
  return table;
}

DataTable looks_table(const Outcomes& outcomes) {
  DataTable table{columns_of("looks.csv"), {}};
  for (const Look& look : outcomes.look_record.looks) {
    table.rows.push_back({utc_text(look.at), name_of(look.kind), std::int64_t{look.participants},
                          look.participant, std::int64_t{look.station}, look.reason,
                          flag(outcomes.simulated)});
  }
  return table;
}

Collection collection_of(const record::StudyStore& store, const std::optional<Outcomes>& outcomes) {
  return outcomes ? outcomes->collection : load_collection(store);
}

}  // namespace touchtrial::analysis
