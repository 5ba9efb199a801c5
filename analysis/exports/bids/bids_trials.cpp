#include "analysis/exports/bids/bids_trials.hpp"

#include "analysis/exports/bids/bids_stimuli.hpp"
#include "analysis/exports/trial_columns.hpp"

#include <algorithm>
#include <string_view>

namespace touchtrial::analysis {
namespace {

/// The name that BIDS gives to a column, or its own name.
std::string bids_name(std::string_view column) {
  if (column == "class") return "trial_type";
  if (column == "reaction_time_s") return "response_time";
  return std::string(column);
}

bool is_shown(const TrialColumn& column, bool unblinded) {
  const std::string_view name = column.name;
  return name != "participant" && name != "session" && (unblinded || !column.after_unblinding);
}

DataCell stimulus_file(const TrialView& trial) {
  if (trial.outcome->kind == design::PresentationKind::catch_trial) return std::monostate{};
  const design::StimulusIndex& shown = trial.outcome->stimulus;
  return stimulus_name(trial.study->design, shown.class_index, shown.exemplar);
}

/// What each row may show. Leaves out trials that an interim look does not show.
std::vector<TrialView> views_of(const DatasetSource& study,
                                const std::vector<store::TrialRow>& rows) {
  static const std::string kNobody;
  const bool simulated = study.store.commitment().simulated;
  std::map<std::pair<int, int>, const TrialOutcome*> meanings;
  if (study.outcomes != nullptr) {
    for (const TrialOutcome& trial : study.outcomes->trials) {
      meanings[{trial.row.session, trial.row.trial}] = &trial;
    }
  }
  std::vector<TrialView> views;
  for (const store::TrialRow& row : rows) {
    const auto meaning = meanings.find({row.session, row.trial});
    if (meaning != meanings.end()) {
      views.push_back({kNobody, row, simulated, study.outcomes, meaning->second});
    } else if (study.outcomes == nullptr) {
      views.push_back({kNobody, row, simulated});
    }
  }
  return views;
}

/// Sorts by session, then by time.
void sort_by_presentation(std::vector<store::TrialRow>& rows) {
  std::sort(rows.begin(), rows.end(), [](const store::TrialRow& a, const store::TrialRow& b) {
    return std::pair(a.session, a.presented_at) < std::pair(b.session, b.presented_at);
  });
}

}  // namespace

BidsTrials bids_trials(const DatasetSource& study, bool stimuli) {
  const bool unblinded = study.outcomes != nullptr;
  BidsTrials trials;
  for (const TrialColumn& column : trial_columns()) {
    if (is_shown(column, unblinded)) trials.columns.push_back(bids_name(column.name));
  }
  if (stimuli) trials.columns.emplace_back("stim_file");
  for (const store::SessionRow& session : study.store.sessions()) {
    if (!session.withdrawn) trials.by_session[session.session].columns = trials.columns;
  }
  std::vector<store::TrialRow> rows = study.store.trials();
  sort_by_presentation(rows);
  for (const TrialView& trial : views_of(study, rows)) {
    const auto table = trials.by_session.find(trial.row.session);
    if (table == trials.by_session.end()) continue;
    std::vector<DataCell>& row = table->second.rows.emplace_back();
    for (const TrialColumn& column : trial_columns()) {
      if (is_shown(column, unblinded)) row.push_back(column.value(trial));
    }
    if (stimuli) row.push_back(stimulus_file(trial));
  }
  return trials;
}

}  // namespace touchtrial::analysis
