/// \file What trials.csv and its kin hold of a trial, column by column.
/// Columns: docs/data-dictionary.md, "Exports".
#pragma once

#include "analysis/exports/data_table.hpp"
#include "analysis/outcomes.hpp"

#include <span>
#include <string>

namespace touchtrial::analysis {

/// What a cell is made from; before unblinding the last two are missing.
struct TrialView {
  const std::string& participant;
  const store::TrialRow& row;
  bool simulated = false;
  const Outcomes* study = nullptr;
  const TrialOutcome* outcome = nullptr;
};

struct TrialColumn {
  const char* name;
  bool after_unblinding;  ///< exists only then
  DataCell (*value)(const TrialView&);
};

/// In the order in which they stand in trials.csv.
[[nodiscard]] std::span<const TrialColumn> trial_columns();

/// The file name, as the study calls it, of a trial's image.
[[nodiscard]] const std::string& image_of(const Outcomes& study, const TrialOutcome& trial);

[[nodiscard]] DataCell flag(bool value);

}  // namespace touchtrial::analysis
