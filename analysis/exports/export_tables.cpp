#include "analysis/exports/export_tables.hpp"

#include "analysis/exports/collection_tables.hpp"
#include "analysis/exports/trial_columns.hpp"

#include <map>

namespace touchtrial::analysis {
namespace {

void add_trial(DataTable& table, const TrialView& trial) {
  std::vector<DataCell>& row = table.rows.emplace_back();
  row.reserve(table.columns.size());
  for (const TrialColumn& column : trial_columns()) {
    if (trial.study != nullptr || !column.after_unblinding) row.push_back(column.value(trial));
  }
}

DataTable trials_header(bool unblinded) {
  DataTable table;
  for (const TrialColumn& column : trial_columns()) {
    if (unblinded || !column.after_unblinding) table.columns.emplace_back(column.name);
  }
  return table;
}

DataTable blinded_trials(const store::StudyStore& store) {
  DataTable table = trials_header(false);
  std::map<int, store::SessionRow> shown;
  for (const store::SessionRow& session : store.sessions()) {
    if (!session.withdrawn) shown[session.session] = session;
  }
  for (const store::TrialRow& row : store.trials()) {
    const auto session = shown.find(row.session);
    if (session == shown.end()) continue;
    add_trial(table, {session->second.participant, row, session->second.simulated});
  }
  return table;
}

DataTable trials_that_are(bool scored, const Outcomes& outcomes) {
  DataTable table = trials_header(true);
  for (const TrialOutcome& trial : outcomes.trials) {
    if (trial.scored != scored) continue;
    add_trial(table, {trial.participant, trial.row, outcomes.simulated, &outcomes, &trial});
  }
  return table;
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

DataTable trials_table(const store::StudyStore& store, const std::optional<Outcomes>& outcomes) {
  return outcomes ? trials_that_are(true, *outcomes) : blinded_trials(store);
}

DataTable unscored_table(const Outcomes& outcomes) {
  return trials_that_are(false, outcomes);
}

DataTable study_table(const store::StudyStore& store, const std::optional<Outcomes>& outcomes,
                      const Collection& collection) {
  const store::StudyCommitment& commitment = store.commitment();
  const store::StudyState state = store.state();
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

Collection collection_of(const store::StudyStore& store, const std::optional<Outcomes>& outcomes) {
  return outcomes ? outcomes->collection : load_collection(store);
}

}  // namespace touchtrial::analysis
