/// \file How a study was collected, as tables. Columns: docs/data-dictionary.md, "Exports".
#pragma once

#include "analysis/collection.hpp"
#include "analysis/exports/data_table.hpp"

namespace touchtrial::analysis {

/// One row a session; `counted` is 1 if its trials enter the report. Of who has withdrawn nothing
/// is told of practice, reasons and device.
[[nodiscard]] DataTable participants_table(const store::StudyStore& store,
                                           const Collection& collection);

/// One row for each deviation from the protocol, by session, in the order in which they were noted.
[[nodiscard]] DataTable deviations_table(const Collection& collection, bool simulated);

/// One row for each trial in real time: how the servo kept its time. None for simulated sessions.
[[nodiscard]] DataTable servo_table(const Collection& collection, bool simulated);

/// What the study prescribes of every session: rows of study.csv.
void add_prescription(DataTable& study, const Prescription& prescription);

}  // namespace touchtrial::analysis
