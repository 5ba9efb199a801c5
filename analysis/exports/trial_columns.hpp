/// \file The columns of trials.csv and of the tables like it. Columns: docs/data-dictionary.md,
/// "Exports".
#pragma once

#include "analysis/exports/data_table.hpp"
#include "analysis/outcomes.hpp"

#include <span>
#include <string>

namespace touchtrial::analysis {

/// The source of a cell. `study` and `outcome` are null before unblinding.
struct TrialView {
  const std::string& participant;
  const store::TrialRow& row;
  bool simulated = false;
  const Outcomes* study = nullptr;
  const TrialOutcome* outcome = nullptr;
};

struct TrialColumn {
  const char* name;
  bool after_unblinding;  ///< the column exists only after unblinding
  DataCell (*value)(const TrialView&);
};

/// The columns in the order of trials.csv.
[[nodiscard]] std::span<const TrialColumn> trial_columns();

/// The file name of a trial's image, as the study gives it.
[[nodiscard]] const std::string& image_of(const Outcomes& study, const TrialOutcome& trial);

[[nodiscard]] DataCell flag(bool value);

}  // namespace touchtrial::analysis
