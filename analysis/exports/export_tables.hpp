/// \file The tables of trials and of the study that exports write. Columns:
/// docs/data-dictionary.md, "Exports".
#pragma once

#include "analysis/exports/data_table.hpp"
#include "analysis/outcomes.hpp"

#include <optional>

namespace touchtrial::analysis {

/// One row for each trial, ordered by session and trial, without participants who withdrew. With
/// outcomes, the rows are the scored trials, whether or not their session counts
/// (participants_table tells). Without outcomes, the rows are all presented trials, because the
/// seal also covers which of them were practice or lead-ins. The table then has no columns about
/// stimuli and answers, and the columns that could tell stimuli apart by how they felt (contact_s,
/// path_mm, force_rms_n, saturated_share) are empty.
[[nodiscard]] DataTable trials_table(const store::StudyStore& store,
                                     const std::optional<Outcomes>& outcomes);

/// The trials that are not scored: lead-ins and catch trials, with the columns of trials_table.
/// They show what came before each scored trial. A catch trial has neither class nor method.
[[nodiscard]] DataTable unscored_table(const Outcomes& outcomes);

/// The study as a whole. Each row has a key, the item that it belongs to (the class of an
/// exemplar), and a value. Classes, exemplars and methods appear in their order, and only with
/// outcomes.
[[nodiscard]] DataTable study_table(const store::StudyStore& store,
                                    const std::optional<Outcomes>& outcomes,
                                    const Collection& collection);

/// The collection of the outcomes; without outcomes, the collection that the store holds in clear.
[[nodiscard]] Collection collection_of(const store::StudyStore& store,
                                       const std::optional<Outcomes>& outcomes);

}  // namespace touchtrial::analysis
