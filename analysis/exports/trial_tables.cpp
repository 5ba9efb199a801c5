#include "analysis/exports/trial_tables.hpp"

#include "analysis/exports/study_tables.hpp"
#include "analysis/report/results.hpp"

#include <algorithm>
#include <iterator>
#include <map>

namespace touchtrial::analysis {
namespace {

bool has_stimulus(const TrialView& trial) {
  return trial.outcome->has_stimulus;
}

DataCell response_of(const TrialView& trial) {
  if (!trial.outcome->response) return std::monostate{};
  return trial.study->choices[*trial.outcome->response];
}

/// Empty if the trial did not end, so that the column's mean is an accuracy, or if no response is
/// right.
DataCell correctness_of(const TrialView& trial) {
  if (!trial.outcome->right) return std::monostate{};
  if (!has_stimulus(trial) && !trial.outcome->chosen) return std::monostate{};
  const record::TrialState state = trial.row.state;
  if (state != record::TrialState::answered && state != record::TrialState::timed_out)
    return std::monostate{};
  return flag(trial.outcome->correct());
}

/// Whether the trial has several planes and belongs to a track, which determines its class and
/// method.
bool belongs_to_track(const TrialView& trial) {
  return trial.outcome->chosen && trial.outcome->chosen->track > 0;
}

DataCell method_of(const TrialView& trial) {
  if (!has_stimulus(trial) && !belongs_to_track(trial)) return std::monostate{};
  return trial.study->methods[trial.outcome->stimulus.method];
}

DataCell class_of(const TrialView& trial) {
  if (!has_stimulus(trial) && !belongs_to_track(trial)) return std::monostate{};
  return trial.study->classes[trial.outcome->stimulus.class_index];
}

DataCell exemplar_of(const TrialView& trial) {
  if (!has_stimulus(trial)) return std::monostate{};
  return image_of(*trial.study, *trial.outcome);
}

DataCell gain_of(const TrialView& trial) {
  if (!has_stimulus(trial)) return std::monostate{};
  return trial.outcome->gain_db;
}

DataCell kind_of(const TrialView& trial) {
  return std::string(name_of(trial.outcome->role));
}

DataCell state_of(const TrialView& trial) {
  return std::string(name_of(trial.row.state));
}

template <double record::TrialMeasures::*kMeasure>
DataCell measure_cell(const TrialView& trial) {
  if (trial.outcome == nullptr || !trial.outcome->measures) return std::monostate{};
  return (*trial.outcome->measures).*kMeasure;
}

DataCell limits_of(const TrialView& trial) {
  if (!trial.outcome->measures) return std::monostate{};
  return flag(trial.outcome->measures->within_limits);
}

DataCell limited_ticks_of(const TrialView& trial) {
  if (!trial.outcome->measures || !trial.outcome->measures->limited_ticks) return std::monostate{};
  return *trial.outcome->measures->limited_ticks;
}

/// Whether the hand stayed within one of its windows; missing without a trace.
template <bool record::HandWindows::*kWindow>
DataCell window_cell(const TrialView& trial) {
  if (!trial.row.has_trace()) return std::monostate{};
  return flag(trial.row.hand.*kWindow);
}

/// The verdict of the validity rule; missing without a trace. Before unblinding, only the rule's
/// unencrypted part.
DataCell validity_of(const TrialView& trial) {
  if (!trial.row.has_trace()) return std::monostate{};
  return flag(trial.outcome != nullptr ? trial.outcome->valid() : trial.row.valid);
}

const std::vector<TrialColumn>& common_trial_columns() {
  static const std::vector<TrialColumn> columns{
      {"participant", false, [](const TrialView& t) -> DataCell { return t.participant; }},
      {"session", false,
       [](const TrialView& t) -> DataCell { return std::int64_t{t.row.session}; }},
      {"trial", false, [](const TrialView& t) -> DataCell { return std::int64_t{t.row.trial}; }},
      {"block", false, [](const TrialView& t) -> DataCell { return std::int64_t{t.row.block}; }},
      {"method", true, method_of},
      {"class", true, class_of},
      {"exemplar", true, exemplar_of},
      {"response", true, response_of},
      {"correct", true, correctness_of},
      {"confidence", true, [](const TrialView& t) { return optional_cell(t.row.confidence); }},
      {"reaction_time_s", true,
       [](const TrialView& t) { return optional_cell(t.row.reaction_time()); }},
      {"from_contact_s", true,
       [](const TrialView& t) { return optional_cell(t.row.from_contact()); }},
      {"contact_s", false, measure_cell<&record::TrialMeasures::contact_s>},
      {"path_mm", false, measure_cell<&record::TrialMeasures::path_mm>},
      {"force_rms_n", false, measure_cell<&record::TrialMeasures::force_rms_n>},
      {"saturated_share", false, measure_cell<&record::TrialMeasures::saturated_share>},
      {"valid", false, validity_of},
      {"presented_at_s", true, [](const TrialView& t) -> DataCell { return t.row.presented_at; }},
      {"simulated", false, [](const TrialView& t) { return flag(t.simulated); }},
      {"counted", true, [](const TrialView& t) { return flag(t.outcome->counted); }},
      {"kind", true, kind_of},
      {"state", false, state_of},
      {"explorations", false,
       [](const TrialView& t) -> DataCell { return std::int64_t{t.row.explorations}; }},
      {"first_contact_s", true,
       [](const TrialView& t) -> DataCell {
         if (!t.row.contact_at) return std::monostate{};
         return *t.row.contact_at - t.row.presented_at;
       }},
      {"position", true,
       [](const TrialView& t) { return optional_cell(position_of(t.row.answer)); }},
      {"first_position", true,
       [](const TrialView& t) { return optional_cell(first_position_of(t.row.answer)); }},
      {"valid_in_clear", false, [](const TrialView& t) { return flag(t.row.valid); }},
      {"contact_ok", false, window_cell<&record::HandWindows::contact>},
      {"path_ok", false, window_cell<&record::HandWindows::path>},
      {"force_ok", false, window_cell<&record::HandWindows::force>},
      {"speed_ok", false, window_cell<&record::HandWindows::speed>},
      {"within_limits", true, limits_of},
      {"limited_ticks", true, limited_ticks_of},
      {"samples", true, [](const TrialView& t) -> DataCell { return t.row.samples; }},
      {"sampling_hz", false, [](const TrialView& t) -> DataCell { return t.row.rate_hz; }},
      {"overruns", false, [](const TrialView& t) -> DataCell { return t.row.overruns; }},
      {"paused", false, [](const TrialView& t) { return flag(t.row.paused); }},
  };
  return columns;
}

void add_trial(DataTable& table, const std::vector<TrialColumn>& columns, const TrialView& trial) {
  std::vector<DataCell>& row = table.rows.emplace_back();
  row.reserve(table.columns.size());
  for (const TrialColumn& column : columns) {
    if (trial.study != nullptr || !column.after_unblinding) row.push_back(column.value(trial));
  }
}

DataTable trials_header(const std::vector<TrialColumn>& columns, bool unblinded) {
  DataTable table;
  for (const TrialColumn& column : columns) {
    if (unblinded || !column.after_unblinding) table.columns.push_back(column.name);
  }
  return table;
}

DataTable blinded_trials(const record::StudyStore& store) {
  const std::vector<TrialColumn> columns = trial_columns_of(nullptr);
  DataTable table = trials_header(columns, false);
  std::map<int, record::SessionRow> shown_sessions;
  for (const record::SessionRow& session : store.sessions()) {
    if (!session.erased) shown_sessions[session.session] = session;
  }
  for (const record::TrialRow& row : store.trials()) {
    const auto session = shown_sessions.find(row.session);
    if (session == shown_sessions.end()) continue;
    add_trial(table, columns, {session->second.participant, row, session->second.simulated});
  }
  return table;
}

DataTable trials_by_scoring(bool scored, const Outcomes& outcomes) {
  const std::vector<TrialColumn> columns = trial_columns_of(&outcomes);
  DataTable table = trials_header(columns, true);
  for (const TrialOutcome& trial : outcomes.trials) {
    if (trial.scored != scored) continue;
    add_trial(table, columns,
              {trial.participant, trial.row, outcomes.simulated, &outcomes, &trial});
  }
  add_visit_and_group(table, outcomes.collection);
  return table;
}

}  // namespace

std::span<const TrialColumn> trial_columns() {
  return common_trial_columns();
}

std::vector<TrialColumn> trial_columns_of(const Outcomes* outcomes) {
  std::vector<TrialColumn> columns = common_trial_columns();
  if (outcomes == nullptr) return columns;
  if (outcomes->design.trials.rove_db > 0.0) columns.push_back({"gain_db", true, gain_of});
  std::ranges::move(analysis_of(outcomes->design).trial_columns(*outcomes),
                    std::back_inserter(columns));
  return columns;
}

const std::string& image_of(const Outcomes& study, const TrialOutcome& trial) {
  return study.exemplars[trial.stimulus.class_index][trial.stimulus.exemplar];
}

DataTable trials_table(const record::StudyStore& store, const std::optional<Outcomes>& outcomes) {
  if (outcomes) return trials_by_scoring(true, *outcomes);
  DataTable table = blinded_trials(store);
  const Prescription study = prescription_from_json(store.commitment().configuration);
  const bool has_extra_columns = study.visits > 1 || !study.groups.empty();
  if (has_extra_columns) add_visit_and_group(table, load_collection(store));
  return table;
}

DataTable unscored_table(const Outcomes& outcomes) {
  return trials_by_scoring(false, outcomes);
}

}  // namespace touchtrial::analysis
