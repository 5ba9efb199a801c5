/// \file The tables that `export --format csv` writes for thresholds. Columns: docs/thresholds.md.
#pragma once

#include "analysis/exports/trial_tables.hpp"
#include "protocols/threshold/analysis/report.hpp"

#include <vector>

namespace touchtrial::analysis::threshold {

/// thresholds.csv: one row for each participant and track.
[[nodiscard]] DataTable thresholds_table(const ThresholdReport& report, bool simulated);

/// tracks.csv: one row for each answered trial, as it was felt, of sessions that count. The track
/// of a catch trial and of a trial of the control block is empty.
[[nodiscard]] DataTable track_trials_table(const Outcomes& outcomes);

/// What trials.csv and its like have in addition: track, standard and level_db.
[[nodiscard]] std::vector<TrialColumn> threshold_trial_columns();

}  // namespace touchtrial::analysis::threshold
