/// \file Tables about the study and its collection. Columns: docs/data-dictionary.md, "Exports".
#pragma once

#include "analysis/exports/data_table.hpp"
#include "analysis/outcomes/collection.hpp"
#include "analysis/outcomes/outcomes.hpp"

#include <optional>
#include <string>
#include <vector>

namespace touchtrial::analysis {

/// The study as rows of key, item (such as the class of an exemplar) and value. Classes, exemplars
/// and methods are in the study's order, and included only with outcomes.
[[nodiscard]] DataTable study_table(const record::StudyStore& store,
                                    const std::optional<Outcomes>& outcomes,
                                    const Collection& collection);

/// The columns of participants.csv, without the columns of add_visit_and_group.
[[nodiscard]] std::vector<std::string> participant_columns(bool unblinded);

/// One row per session; `counted` is 1 if the session's trials enter the report. If the data were
/// erased, the cells about practice, resumptions, reasons and equipment are empty.
[[nodiscard]] DataTable participants_table(const record::StudyStore& store,
                                           const Collection& collection);

/// Adds `visit` if the study has several visits, and `group` if it has groups, to a table with a
/// column `session`. The cell of a hidden group is empty.
void add_visit_and_group(DataTable& table, const Collection& collection);

/// One row per deviation from the protocol, ordered by session and time of recording.
[[nodiscard]] DataTable deviations_table(const Collection& collection, bool simulated);

/// The servo's timing: one row per trial that ran in real time; none for simulated sessions.
[[nodiscard]] DataTable servo_table(const Collection& collection, bool simulated);

/// The looks at outcomes, in chronological order.
[[nodiscard]] DataTable looks_table(const Outcomes& outcomes);

/// The outcomes' collection; without outcomes, the store's unencrypted collection.
[[nodiscard]] Collection collection_of(const record::StudyStore& store,
                                       const std::optional<Outcomes>& outcomes);

}  // namespace touchtrial::analysis
