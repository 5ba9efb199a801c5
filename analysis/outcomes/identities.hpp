/// \file Outcomes without what could tell who took part: for reports that everybody may read.
#pragma once

#include "analysis/outcomes/outcomes.hpp"

namespace touchtrial::analysis {

/// Takes out participants' ids, serial numbers, times of day, and every text that a person wrote
/// while the study ran: reasons, notes, answers in words, and the words of deviations. Participants
/// are named by the rank of their accuracy, from "1" (padded with zeros to equal length), so that a
/// name tells neither who nor when. Codes of deviations that neither the program nor the
/// registration has become "other". The study's own texts (labels, registration) stay: they were
/// deposited.
///
/// Everything that is computed stays the same. Sets `collection.is_public`.
[[nodiscard]] Outcomes without_identities(Outcomes outcomes);

}  // namespace touchtrial::analysis
