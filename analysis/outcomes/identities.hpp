/// \file De-identified outcomes for public reports.
#pragma once

#include "analysis/outcomes/outcomes.hpp"

namespace touchtrial::analysis {

/// Removes participants' ids, serial numbers, times of day, and every text that a person wrote
/// while the study ran: reasons, notes, free-text answers, and descriptions of deviations.
/// Participants are named by the rank of their accuracy, from "1" (zero-padded), so a name reveals
/// neither identity nor session order. Codes of deviations that are neither the program's nor
/// registered become "other". The study's texts (labels, registration) stay, because they were
/// deposited. Computed results do not change. Sets `collection.is_public`.
[[nodiscard]] Outcomes without_identities(Outcomes outcomes);

}  // namespace touchtrial::analysis
