/// \file What a study gives to others, as tables. Columns: docs/data-dictionary.md, "Exports".
#pragma once

#include "analysis/exports/data_table.hpp"
#include "analysis/outcomes.hpp"

#include <optional>

namespace touchtrial {

/// One row a trial, by session and trial, of all sessions but withdrawn ones. With outcomes: the
/// scored trials, whether or not their session counts (participants_table tells). Without: every
/// presented trial, as practice and lead-ins are sealed; the columns class, exemplar, method,
/// response and correct are missing, and those that would tell stimuli apart by how they felt
/// (contact_s, path_mm, force_rms_n, saturated_share) are empty.
[[nodiscard]] DataTable trials_table(const StudyStore& store,
                                     const std::optional<Outcomes>& outcomes);

/// One row a session; `counted` is 1 if its trials enter the report.
[[nodiscard]] DataTable participants_table(const StudyStore& store);

/// Counts of one method's counted trials: a row a presented class, a column an answer, and last
/// the trials without a response.
[[nodiscard]] DataTable confusion_table(const Outcomes& outcomes, int method);

}  // namespace touchtrial
