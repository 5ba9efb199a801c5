/// \file Tables on how a study was collected. Columns: docs/data-dictionary.md, "Exports".
#pragma once

#include "analysis/collection.hpp"
#include "analysis/exports/data_table.hpp"

namespace touchtrial::analysis {

/// One row for each session; `counted` is 1 if the session's trials enter the report. For
/// participants who withdrew, the cells about practice, resumptions, reasons and equipment are
/// empty.
[[nodiscard]] DataTable participants_table(const store::StudyStore& store,
                                           const Collection& collection);

/// One row for each deviation from the protocol, ordered by session and then by when it was noted.
[[nodiscard]] DataTable deviations_table(const Collection& collection, bool simulated);

/// The servo's timing: one row for each trial that ran in real time, none for simulated sessions.
[[nodiscard]] DataTable servo_table(const Collection& collection, bool simulated);

/// Adds the study's prescriptions for every session to the rows of study.csv.
void add_prescription(DataTable& study, const Prescription& prescription);

}  // namespace touchtrial::analysis
