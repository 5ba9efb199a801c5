#include "analysis/exports/export_tables.hpp"

#include "analysis/session_rules.hpp"
#include "analysis/statistics/confusion.hpp"

#include <array>
#include <map>

namespace touchtrial {
namespace {

/// What a cell of trials.csv is made from; before unblinding the last two are missing.
struct TrialView {
  const std::string& participant;
  const TrialRow& row;
  const Outcomes* study = nullptr;
  const TrialOutcome* outcome = nullptr;
};

Cell flag(bool value) {
  return std::int64_t{value ? 1 : 0};
}

/// From one moment of a trial to another, if both came.
Cell time_between(const std::optional<std::chrono::nanoseconds>& from,
                  const std::optional<std::chrono::nanoseconds>& to) {
  if (!from || !to) return std::monostate{};
  return *to - *from;
}

Cell response_of(const TrialView& trial) {
  if (!trial.outcome->response) return std::monostate{};
  return trial.study->classes[*trial.outcome->response];
}

/// Empty for a trial that never ended, so that a mean over the column is an accuracy.
Cell correctness_of(const TrialView& trial) {
  const TrialState state = trial.row.state;
  if (state != TrialState::answered && state != TrialState::timed_out) return std::monostate{};
  return flag(trial.outcome->correct());
}

Cell exemplar_of(const TrialView& trial) {
  const StimulusIndex& shown = trial.outcome->stimulus;
  return trial.study->exemplars[shown.class_index][shown.exemplar];
}

Cell confidence_of(const TrialView& trial) {
  if (!trial.row.confidence) return std::monostate{};
  return std::int64_t{*trial.row.confidence};
}

template <double TrialMeasures::*kMeasure>
Cell measured(const TrialView& trial) {
  if (trial.outcome == nullptr || !trial.outcome->measures) return std::monostate{};
  return (*trial.outcome->measures).*kMeasure;
}

/// The rule judges traces; without one there is no verdict. Before unblinding, that of its part in
/// clear.
Cell validity_of(const TrialView& trial) {
  if (trial.row.samples == 0) return std::monostate{};
  return flag(trial.outcome != nullptr ? trial.outcome->valid() : trial.row.valid);
}

struct TrialColumn {
  const char* name;
  bool after_unblinding;
  Cell (*value)(const TrialView&);
};

constexpr std::array<TrialColumn, 18> kTrialColumns{{
    {"participant", false, [](const TrialView& t) -> Cell { return t.participant; }},
    {"session", false, [](const TrialView& t) -> Cell { return std::int64_t{t.row.session}; }},
    {"trial", false, [](const TrialView& t) -> Cell { return std::int64_t{t.row.trial}; }},
    {"block", false, [](const TrialView& t) -> Cell { return std::int64_t{t.row.block}; }},
    {"method", true,
     [](const TrialView& t) -> Cell { return t.study->methods[t.outcome->stimulus.method]; }},
    {"class", true,
     [](const TrialView& t) -> Cell { return t.study->classes[t.outcome->stimulus.class_index]; }},
    {"exemplar", true, exemplar_of},
    {"response", true, response_of},
    {"correct", true, correctness_of},
    {"confidence", false, confidence_of},
    {"reaction_time_s", false,
     [](const TrialView& t) { return time_between(t.row.presented_at, t.row.answered_at); }},
    {"from_contact_s", false,
     [](const TrialView& t) { return time_between(t.row.contact_at, t.row.answered_at); }},
    {"contact_s", false, measured<&TrialMeasures::contact_s>},
    {"path_mm", false, measured<&TrialMeasures::path_mm>},
    {"force_rms_n", false, measured<&TrialMeasures::force_rms_n>},
    {"saturated_share", false, measured<&TrialMeasures::saturated_share>},
    {"valid", false, validity_of},
    {"presented_at_s", false, [](const TrialView& t) -> Cell { return t.row.presented_at; }},
}};

void add_trial(DataTable& table, const TrialView& trial) {
  std::vector<Cell>& row = table.rows.emplace_back();
  row.reserve(table.columns.size());
  for (const TrialColumn& column : kTrialColumns) {
    if (trial.study != nullptr || !column.after_unblinding) row.push_back(column.value(trial));
  }
}

void add_blinded_trials(DataTable& table, const StudyStore& store) {
  std::map<int, std::string> participants;
  for (const SessionRow& session : store.sessions()) {
    if (!session.withdrawn) participants[session.session] = session.participant;
  }
  for (const TrialRow& row : store.trials()) {
    const auto participant = participants.find(row.session);
    if (participant != participants.end()) add_trial(table, {participant->second, row});
  }
}

const char* text_of(SessionState state) {
  switch (state) {
    case SessionState::completed:
      return "completed";
    case SessionState::stopped:
      return "stopped";
    case SessionState::open:
      break;
  }
  return "open";
}

}  // namespace

DataTable trials_table(const StudyStore& store, const std::optional<Outcomes>& outcomes) {
  DataTable table;
  for (const TrialColumn& column : kTrialColumns) {
    if (outcomes || !column.after_unblinding) table.columns.emplace_back(column.name);
  }
  if (!outcomes) {
    add_blinded_trials(table, store);
    return table;
  }
  for (const TrialOutcome& trial : outcomes->trials) {
    if (trial.scored) add_trial(table, {trial.participant, trial.row, &*outcomes, &trial});
  }
  return table;
}

DataTable participants_table(const StudyStore& store) {
  DataTable table{{"participant", "session", "enrolment", "state", "excluded", "withdrawn", "pilot",
                   "simulated", "counted", "device"},
                  {}};
  const StudyState state = store.state();
  for (const SessionRow& row : store.sessions()) {
    const bool shown = !state.unblinded || state.shows(row.session);
    table.rows.push_back({row.participant, std::int64_t{row.session}, std::int64_t{row.enrolment},
                          text_of(row.state), flag(row.excluded), flag(row.withdrawn),
                          flag(row.pilot), flag(row.simulated),
                          flag(shown && session_counts(row, store.commitment())), row.device});
  }
  return table;
}

DataTable confusion_table(const Outcomes& outcomes, int method) {
  const auto classes = static_cast<int>(outcomes.classes.size());
  ConfusionMatrix confusion(classes);
  for (const TrialOutcome& trial : outcomes.trials) {
    if (!trial.counted || trial.stimulus.method != method) continue;
    confusion.add({trial.stimulus.class_index, trial.response});
  }
  DataTable table{{"presented"}, {}};
  table.columns.insert(table.columns.end(), outcomes.classes.begin(), outcomes.classes.end());
  table.columns.emplace_back("no_response");
  for (int i = 0; i < classes; ++i) {
    std::vector<Cell> row{outcomes.classes[i]};
    for (int j = 0; j < classes; ++j) row.emplace_back(std::int64_t{confusion.count(i, j)});
    row.emplace_back(std::int64_t{confusion.no_response(i)});
    table.rows.push_back(std::move(row));
  }
  return table;
}

}  // namespace touchtrial
