/// \file Exports of thresholds: tables (columns: docs/thresholds.md), and the R script that fits the
/// study's psychometric function to a table of trials, with guess and lapse rates and random
/// effects of participants and their standards. Source: Moscatelli, Mezzetti, Lacquaniti 2012,
/// Journal of Vision 12(11):26.
#pragma once

#include "analysis/exports/trial_tables.hpp"
#include "analysis/report/results.hpp"
#include "protocols/threshold/analysis/report.hpp"

#include <string_view>
#include <vector>

namespace touchtrial::analysis::threshold {

/// tracks.csv: one row per answered trial of counted sessions, in felt order. The track of trials
/// in the control block is empty.
[[nodiscard]] DataTable track_trials_table(const Outcomes& outcomes);

/// Additional columns of trial tables: track, standard and level_db.
[[nodiscard]] std::vector<TrialColumn> threshold_trial_columns();

/// The constant part of the script: threshold_model_functions.R.
[[nodiscard]] std::string_view threshold_model_functions() noexcept;

/// \throws UsageError for the task "same or different", which has no guess rate
[[nodiscard]] RModel threshold_model(const Outcomes& outcomes);

}  // namespace touchtrial::analysis::threshold
