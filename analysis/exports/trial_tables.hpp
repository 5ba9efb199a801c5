/// \file The columns of trials.csv and the tables of trials that exports write. Columns:
/// docs/data-dictionary.md, "Exports".
#pragma once

#include "analysis/exports/data_table.hpp"
#include "analysis/outcomes/outcomes.hpp"

#include <functional>
#include <optional>
#include <span>
#include <string>
#include <vector>

namespace touchtrial::analysis {

/// The data behind a trial's cells. `study` and `outcome` are null before unblinding.
struct TrialView {
  const std::string& participant;
  const record::TrialRow& row;
  bool simulated = false;
  const Outcomes* study = nullptr;
  const TrialOutcome* outcome = nullptr;
};

struct TrialColumn {
  std::string name;
  bool after_unblinding = false;  ///< the column exists only after unblinding
  std::function<DataCell(const TrialView&)> value;
};

/// The columns common to all protocols, in the order of trials.csv.
[[nodiscard]] std::span<const TrialColumn> trial_columns();

/// trial_columns(), "gain_db" if gains are roved, and the columns of the protocol's analysis.
/// \param outcomes  null before unblinding
/// \throws StudyError if the study's protocol has no analysis
[[nodiscard]] std::vector<TrialColumn> trial_columns_of(const Outcomes* outcomes);

/// The file name of a trial's image, as in the study.
[[nodiscard]] const std::string& image_of(const Outcomes& study, const TrialOutcome& trial);

/// One row per trial, ordered by session and trial, without participants whose data were erased.
/// With outcomes, the rows are the scored trials, whether their session counts or not (see
/// participants_table). Without outcomes, the rows are all presented trials, because practice and
/// lead-ins cannot be distinguished. The table then has no columns about stimuli, answers and
/// times, and the columns that could reveal stimuli (contact_s, path_mm, force_rms_n,
/// saturated_share) are empty. add_visit_and_group adds the last columns.
[[nodiscard]] DataTable trials_table(const record::StudyStore& store,
                                     const std::optional<Outcomes>& outcomes);

/// The unscored trials, lead-ins and catch trials, with the columns of trials_table. Both tables
/// together give the order of all presentations. A catch trial has neither class nor method.
[[nodiscard]] DataTable unscored_table(const Outcomes& outcomes);

}  // namespace touchtrial::analysis
