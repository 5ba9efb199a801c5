/// \file What a study gives to others, as tables. Columns: docs/data-dictionary.md, "Exports".
#pragma once

#include "analysis/exports/data_table.hpp"
#include "analysis/outcomes.hpp"

#include <optional>

namespace touchtrial::analysis {

/// One row a trial, by session and trial, of all sessions but withdrawn ones. With outcomes: the
/// scored trials, whether or not their session counts (participants_table tells). Without: every
/// presented trial, as practice and lead-ins are sealed; the columns that tell of what was
/// presented or answered are missing, and those that would tell stimuli apart by how they felt
/// (contact_s, path_mm, force_rms_n, saturated_share) are empty.
[[nodiscard]] DataTable trials_table(const store::StudyStore& store,
                                     const std::optional<Outcomes>& outcomes);

/// The trials that are not scored, lead-ins and catch trials, with the columns of trials_table:
/// what came before a scored trial is found here. A catch trial has neither class nor method.
[[nodiscard]] DataTable unscored_table(const Outcomes& outcomes);

/// What holds for the study as a whole: rows of a key, what it is of (of an exemplar: its class),
/// and a value. Classes, exemplars and methods, in their order, only with outcomes.
[[nodiscard]] DataTable study_table(const store::StudyStore& store,
                                    const std::optional<Outcomes>& outcomes,
                                    const Collection& collection);

/// That of the outcomes, or, without them, as the store tells it in clear.
[[nodiscard]] Collection collection_of(const store::StudyStore& store,
                                       const std::optional<Outcomes>& outcomes);

}  // namespace touchtrial::analysis
